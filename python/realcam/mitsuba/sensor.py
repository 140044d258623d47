"""The sensor `realcam`, a class of the Mitsuba variant that is active when this module is loaded."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .._core import Film, InputError, Lens
from .crossings import VARIABLE, WAVELENGTHS_NM, check_expressible, crossings_to_film, crossings_to_scene
from .entries import Entries
from .pupil import Pupil
from .trace import LensTrace, opaque

#: Properties that can be changed by mi.traverse.
PARAMETERS = ("focus_distance_m", "f_number", "film_width_mm", "film_height_mm", "exposure_time_s")
FARTHEST = float(np.finfo(np.float32).max)  # maximum length of a ray that passes the lens


# Without Mitsuba, which is optional, its classes have no types.
class RealcamSensor(mi.Sensor):  # type: ignore[misc, unused-ignore]
    """Sensor plugin; see docs/mitsuba.md. Frames: lens, in mm; camera, in Mitsuba's convention with x to the left and z
    forwards from the film centre; scene."""

    def __init__(self, properties: Any) -> None:
        lens = lens_of(properties)
        set_shutter(properties)
        super().__init__(properties)
        self.m_needs_sample_2 = True
        self.m_needs_sample_3 = True
        self.mm_per_unit = 1000 * properties.get("scene_unit_m", 1.0)
        if not 0 < self.mm_per_unit < np.inf:
            raise InputError(f"scene_unit_m must be a positive number; it is {self.mm_per_unit / 1000:g}")
        self.to_world = mi.Transform4f(self.world_transform())
        if not np.allclose(np.linalg.svd(matrix_of(self.to_world)[:3, :3], compute_uv=False), 1, atol=1e-4):
            raise InputError(
                "to_world of the sensor realcam must not have a scale; use scene_unit_m for the length of a scene unit"
            )
        width, height = film_sides(lens, properties, self.film().size())
        lens = lens.with_rings(f_number=properties.get("f_number"), focus_m=properties.get("focus_distance_m"))
        self.focus_distance_m = mi.Float(lens.focus_distance_m)
        self.f_number = mi.Float(lens.f_number)
        self.film_width_mm, self.film_height_mm = mi.Float(width), mi.Float(height)
        self.exposure_time_s = mi.Float(self.shutter_open_time())
        self.is_dispersive = bool(mi.is_spectral)
        self.set_lens(lens)

    def set_lens(self, lens: Lens) -> None:
        """Sets the focused and stopped-down lens, and computes its tables for the current film."""
        self.lens = lens
        columns, rows = self.film().size()
        film = Film(number(self.film_width_mm), number(self.film_height_mm), (int(columns), int(rows)))
        design = lens.wavelength_nm
        wavelengths = [design, *WAVELENGTHS_NM] if self.is_dispersive else [design]
        # The pupil table comes first: it rejects lenses without rotational symmetry with its own error message.
        self.pupil = Pupil(lens, float(np.hypot(film.width_mm, film.height_mm)) / 2, wavelengths)
        to_film = crossings_to_film(lens, self.is_dispersive)
        self.to_film = LensTrace(to_film)
        self.to_scene = LensTrace(crossings_to_scene(to_film))
        self.entries = Entries(lens, film, WAVELENGTHS_NM if self.is_dispersive else None)
        self.film_position_mm = opaque(lens.film_position_mm)
        self.film_distance_mm = opaque(lens.film_position_mm - lens.vertices_mm[-1])

    def traverse(self, callback: Any) -> None:
        super().traverse(callback)
        for name in PARAMETERS:
            callback.put(name, getattr(self, name), mi.ParamFlags.NonDifferentiable)
        callback.put("to_world", self.to_world, mi.ParamFlags.Differentiable | mi.ParamFlags.Discontinuous)

    def parameters_changed(self, keys: Any = ()) -> None:
        super().parameters_changed(keys)
        lens = self.lens.with_rings(
            f_number=number(self.f_number) if "f_number" in keys else None,
            focus_m=number(self.focus_distance_m) if "focus_distance_m" in keys else None,
        )
        if set(keys) & {"focus_distance_m", "f_number", "film_width_mm", "film_height_mm"}:
            self.set_lens(lens)
        if "to_world" in keys:
            self.m_to_world = self.to_world

    def sample_ray(
        self, time: Any, wavelength_sample: Any, position_sample: Any, aperture_sample: Any, active: Any = True
    ) -> tuple[Any, Any]:
        ray = mi.Ray3f()
        weight, _, _ = self.set_ray(ray, time, wavelength_sample, position_sample, aperture_sample, active)
        return ray, weight

    def sample_ray_differential(
        self, time: Any, wavelength_sample: Any, position_sample: Any, aperture_sample: Any, active: Any = True
    ) -> tuple[Any, Any]:
        """Samples a ray with differentials: rays of the same pupil sample one pixel to the right and one down, which
        rims do not block."""
        ray = mi.RayDifferential3f()
        weight, passed, variable = self.set_ray(ray, time, wavelength_sample, position_sample, aperture_sample, active)
        columns, rows = self.film().crop_size()
        differentials = []
        for step in (mi.Vector2f(1 / columns, 0), mi.Vector2f(0, 1 / rows)):
            o, d, _, _, exists = self.leave_lens(position_sample + step, aperture_sample, variable)
            differentials.append(dr.select(passed & exists, self.point_in_scene(o), ray.o))
            differentials.append(dr.select(passed & exists, self.direction_in_scene(d), ray.d))
        ray.o_x, ray.d_x, ray.o_y, ray.d_y = differentials
        ray.has_differentials = True
        return ray, weight

    def sample_direction(self, it: Any, sample: Any, active: Any = True) -> tuple[Any, Any]:
        """Connects a scene point to the film: samples where a ray enters the lens, and returns the pixel that it
        reaches.

        In spectral variants the path through the lens depends on the wavelength; that of the first wavelength is
        traced, and the first wavelength counts for all. Mitsuba requests direct light from emitters before it samples a
        wavelength; that light is traced at the design wavelength.
        """
        x = self.point_in_lens(it.p)
        vertex = mi.Vector3f(0, 0, self.lens.vertices_mm[0])
        entry, solid_angle = self.entries.sample(x - vertex, sample)
        d = dr.normalize(entry - (x - vertex))
        spectral_weight, variable = self.wavelength_of(it)
        o, p, first, passed, _ = self.to_film(entry, d, variable)
        film_point = dr.fma(p, (self.film_distance_mm - o.z) / p.z, o)
        uv, is_inside = self.pixel_of(film_point)
        active = passed & is_inside & (solid_angle > 0) & active

        result: Any = mi.DirectionSample3f()  # Mitsuba's stubs have the types of one variant
        result.p = self.point_in_scene(mi.Point3f(first + vertex))
        connection = result.p - it.p
        result.dist = dr.norm(connection)
        result.d = connection / result.dist
        result.n = self.direction_in_scene(mi.Vector3f(0, 0, -1))
        result.uv = uv
        result.time = it.time
        result.pdf = dr.select(active, 1.0, 0.0)
        result.delta = mi.Bool(False)
        # Etendue of the connection in scene units, over the area of the crop window on the film.
        weight = solid_angle * self.exposure_time_s * self.mm_per_unit**2 / self.crop_area_mm2()
        return result, spectral_weight * dr.select(active, weight, 0.0)

    def leave_lens(self, position_sample: Any, aperture_sample: Any, variable: Any) -> tuple[Any, Any, Any, Any, Any]:
        """Traces a ray from the film to the front of the lens. Returns point (mm) and unit direction in the lens frame,
        irradiance on the film under unit radiance, whether it passes, and whether it would pass without rims."""
        x, y = self.film_point(position_sample)
        p, weight = self.pupil.sample(x, y, aperture_sample)
        o, p, _, passed, exists = self.to_scene(mi.Point3f(x, y, self.film_distance_mm), p, variable)
        o.z += self.lens.vertices_mm[0]
        return o, dr.normalize(p), weight, passed & (weight > 0), exists & (weight > 0)

    def set_ray(
        self, ray: Any, time: Any, wavelength_sample: Any, position_sample: Any, aperture_sample: Any, active: Any
    ) -> tuple[Any, Any, Any]:
        """Fills in the ray. Returns its weight, whether it passes the lens, and its value of VARIABLE. A ray that the
        lens blocks gets a maximum length of 0."""
        ray.wavelengths, spectral_weight, variable = self.sampled_wavelengths(wavelength_sample, active)
        o, d, weight, passed, _ = self.leave_lens(position_sample, aperture_sample, variable)
        ray.o = self.point_in_scene(dr.select(passed, o, mi.Point3f(0)))
        ray.d = self.direction_in_scene(dr.select(passed, d, mi.Vector3f(0, 0, -1)))
        ray.maxt = dr.select(passed, FARTHEST, 0.0)
        ray.time = time
        return spectral_weight * dr.select(passed & active, weight * self.exposure_time_s, 0.0), passed, variable

    def sampled_wavelengths(self, sample: Any, active: Any) -> tuple[Any, Any, Any]:
        """Samples the wavelengths of a ray. Returns them, the weight of each, and the ray's value of VARIABLE. A ray
        has a single path, so that all of its wavelengths equal the first one sampled."""
        if not self.is_dispersive:
            return type(mi.Ray3f().wavelengths)(), mi.Spectrum(1), None
        sampled, weights = self.sample_wavelengths(dr.zeros(mi.SurfaceInteraction3f), sample, active)
        return type(sampled)(sampled[0]), mi.Spectrum(weights[0]), VARIABLE.at(sampled[0])

    def wavelength_of(self, it: Any) -> tuple[Any, Any]:
        """Returns the weight of each wavelength of light that arrives at the sensor, and its value of VARIABLE."""
        if not self.is_dispersive:
            return mi.Spectrum(1), None
        first = it.wavelengths[0]
        is_known = first > 0
        weight = mi.Spectrum(dr.select(is_known, 0.0, 1.0))
        weight[0] = dr.select(is_known, float(len(it.wavelengths)), 1.0)
        return weight, VARIABLE.at(dr.select(is_known, first, self.lens.wavelength_nm))

    def film_point(self, sample: Any) -> tuple[Any, Any]:
        """Returns the film point in mm, lens frame, of a point of the crop window; the image on the film is upside
        down."""
        size, crop, offset = self.film().size(), self.film().crop_size(), self.film().crop_offset()
        x = 0.5 - (offset[0] + sample.x * crop[0]) / size[0]
        y = (offset[1] + sample.y * crop[1]) / size[1] - 0.5
        return x * self.film_width_mm, y * self.film_height_mm

    def pixel_of(self, film_point: Any) -> tuple[Any, Any]:
        """Returns the pixel coordinates of a film point from the corner of the crop window, and whether it lies
        inside."""
        size, crop, offset = self.film().size(), self.film().crop_size(), self.film().crop_offset()
        u = (0.5 - film_point.x / self.film_width_mm) * size[0] - offset[0]
        v = (0.5 + film_point.y / self.film_height_mm) * size[1] - offset[1]
        return mi.Point2f(u, v), (u >= 0) & (u < crop[0]) & (v >= 0) & (v < crop[1])

    def crop_area_mm2(self) -> Any:
        """Area of the crop window on the film."""
        fraction = dr.prod(self.film().crop_size()) / dr.prod(self.film().size())
        return self.film_width_mm * self.film_height_mm * fraction

    def point_in_scene(self, p: Any) -> Any:
        """Scene coordinates of a point of the lens frame, mm."""
        local = mi.Point3f(-p.x, p.y, self.film_position_mm - p.z) / self.mm_per_unit
        return self.to_world @ local

    def direction_in_scene(self, d: Any) -> Any:
        """Scene coordinates of a direction of the lens frame."""
        return self.to_world @ mi.Vector3f(-d.x, d.y, -d.z)

    def point_in_lens(self, p: Any) -> Any:
        """Lens coordinates, mm, of a point of the scene."""
        local = self.mm_per_unit * (self.to_world.inverse() @ p)
        return mi.Point3f(-local.x, local.y, self.film_position_mm - local.z)

    def bbox(self) -> Any:
        position = matrix_of(self.to_world)[:3, 3].tolist()
        return mi.ScalarBoundingBox3f(position, position)

    def to_string(self) -> str:
        return (
            f"RealcamSensor[\n  lens = {self.lens!r},\n  film = {number(self.film_width_mm):g} x "
            f"{number(self.film_height_mm):g} mm,\n  exposure_time_s = {number(self.exposure_time_s):g}\n]"
        )


def lens_of(properties: Any) -> Lens:
    """The lens of the properties `lens` and `zoom`. Raises InputError and LensFileError."""
    if "lens" not in properties:
        raise InputError('the sensor realcam needs a lens: the name of a bundled one ("double-gauss-50mm"), or a file')
    lens = Lens.load(properties["lens"])
    if "zoom" in properties:
        lens = lens.zoomed(properties["zoom"])
    check_expressible(lens)
    return lens


def set_shutter(properties: Any) -> None:
    """Sets Mitsuba's shutter_close from exposure_time_s (default 1/125 s). Raises InputError if both are specified."""
    if "exposure_time_s" in properties:
        if "shutter_close" in properties:
            raise InputError("the sensor realcam accepts exposure_time_s or shutter_close, not both")
        time = properties["exposure_time_s"]
        if not 0 < time < np.inf:
            raise InputError(f"exposure_time_s must be a positive number; it is {time:g}")
    elif "shutter_close" in properties:
        return
    else:
        time = 1 / 125
    properties["shutter_close"] = properties.get("shutter_open", 0.0) + time


def film_sides(lens: Lens, properties: Any, size: Any) -> tuple[float, float]:
    """Returns width and height of the film in mm. A missing side follows from the other and the picture's aspect ratio;
    if both are missing, they follow from the lens's own format."""
    width, height = (properties.get(f"film_{side}_mm", 0.0) for side in ("width", "height"))
    if width and height:
        return width, height
    ratio = float(size[0]) / float(size[1])
    if width or height:
        return width or height * ratio, height or width / ratio
    film = Film.for_lens(lens, resolution=(int(size[0]), int(size[1])))
    return film.width_mm, film.height_mm


def matrix_of(transform: Any) -> np.ndarray:
    """(4, 4): matrix of a Transform4f of any variant."""
    matrix = np.array(transform.matrix, dtype=float)
    return matrix[..., 0] if matrix.ndim == 3 else matrix


def number(value: Any) -> float:
    """A mi.Float of size 1 as a Python number."""
    return float(value[0]) if dr.is_jit_v(mi.Float) else float(value)
