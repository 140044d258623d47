"""A lens of realcam as a sensor of Mitsuba 3, traced surface by surface with Dr.Jit.

Spherical refracting surfaces and a round stop only. mitsuba's variant is to be set before this is imported.
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi
import numpy as np
import realcam as rc
from mitsuba_scene import film

ROWS = 33  # of the pupil's table, from the film's middle to its corner
GRID = 129  # rays each way, with which a row is found


def pupil_table(camera: rc.Camera, plane_mm: float, radius_mm: float) -> np.ndarray:
    """(ROWS, 3): centre and semi-axes, mm, of ellipses in the plane of the exit pupil that hold all light on its way to
    points of the film at growing distances from the axis, along +x."""
    lens = camera.lens
    side = np.linspace(-1.5 * radius_mm, 1.5 * radius_mm, GRID)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    cell = side[1] - side[0]
    rows = []
    for distance in np.linspace(0, 0.5 * np.hypot(camera.film.width_mm, camera.film.height_mm), ROWS):
        origins = np.array([distance, 0, lens.film_position_mm]) + np.zeros((len(x), 1))
        directions = np.stack([x, y, np.full_like(x, plane_mm)], axis=1) - origins
        passed = lens.trace(origins, directions, start="film").status == 0
        px, py = x[passed], y[passed]
        centre, a, b = 0.5 * (px.min() + px.max()), 0.5 * np.ptp(px) + cell, py.max() + cell
        # Where the outline has corners, the ellipse of its bounds would cut them.
        grown = max(1.0, np.max(np.hypot((np.abs(px - centre) + cell) / a, (np.abs(py) + cell) / b)))
        rows.append((centre, a * grown, b * grown))
    return np.array(rows)


class LensSensor(mi.Sensor):
    """Weights are irradiance on the film over radiance, so that pictures agree with realcam's without a factor."""

    def __init__(self, properties: mi.Properties) -> None:
        super().__init__(properties)
        camera: rc.Camera = LensSensor.camera
        lens, data = camera.lens, camera.lens.first_order()
        self.m_needs_sample_3 = True
        self.film_mm = (camera.film.width_mm, camera.film.height_mm)
        self.film_position_mm = lens.film_position_mm
        self.plane_mm = data.exit_pupil_position_mm
        table = pupil_table(camera, self.plane_mm, 0.5 * data.exit_pupil_diameter_mm)
        self.table = [mi.Float(np.ascontiguousarray(column)) for column in table.T.astype(np.float32)]
        self.rows_per_mm = (ROWS - 1) / (0.5 * float(np.hypot(*self.film_mm)))
        self.surfaces = surfaces_from_the_film(lens)
        backward = np.array(camera.position) - np.array(camera.look_at)
        backward /= np.linalg.norm(backward)
        right = np.cross(camera.up, backward)
        right /= np.linalg.norm(right)
        self.axes = [mi.ScalarVector3f(axis.tolist()) for axis in (right, np.cross(backward, right), backward)]
        self.position = mi.ScalarPoint3f(camera.position)

    def sample_ray(self, time, wavelength_sample, position_sample, aperture_sample, active=True):
        del wavelength_sample
        fx = (1 - 2 * position_sample.x) * (0.5 * self.film_mm[0])
        fy = (2 * position_sample.y - 1) * (0.5 * self.film_mm[1])
        target, area = self.pupil_point(fx, fy, aperture_sample)
        origin = mi.Point3f(fx, fy, self.film_position_mm)
        direction = dr.normalize(target - origin)
        cosine = -direction.z
        weight = area * dr.square(dr.square(cosine)) / (self.film_position_mm - self.plane_mm) ** 2
        origin, direction, passed = trace(self.surfaces, origin, direction)
        right, up, backward = self.axes
        ray = mi.Ray3f()
        ray.time = time
        z = 0.001 * (origin.z - self.film_position_mm)
        ray.o = self.position + 0.001 * origin.x * right + 0.001 * origin.y * up + z * backward
        ray.d = direction.x * right + direction.y * up + direction.z * backward
        # A lost ray goes nowhere.
        ray.maxt = dr.select(passed, dr.largest(mi.Float), 0)
        return ray, mi.Spectrum(dr.select(passed & active, weight, 0))

    def sample_ray_differential(self, time, wavelength_sample, position_sample, aperture_sample, active=True):
        ray, weight = self.sample_ray(time, wavelength_sample, position_sample, aperture_sample, active)
        return mi.RayDifferential3f(ray), weight

    def pupil_point(self, fx: mi.Float, fy: mi.Float, u: mi.Point2f) -> tuple[mi.Point3f, mi.Float]:
        """A point of the ellipse that belongs to a film point, mm, and the ellipse's area, mm^2."""
        distance = dr.hypot(fx, fy)
        place = dr.minimum(distance * self.rows_per_mm, ROWS - 1.001)
        row = mi.UInt32(place)
        centre, a, b = (
            dr.lerp(dr.gather(mi.Float, column, row), dr.gather(mi.Float, column, row + 1), place - row)
            for column in self.table
        )
        disc = mi.warp.square_to_uniform_disk_concentric(u)
        x, y = centre + a * disc.x, b * disc.y
        cos = dr.select(distance > 0, fx / distance, 1)
        sin = dr.select(distance > 0, fy / distance, 0)
        return mi.Point3f(x * cos - y * sin, x * sin + y * cos, self.plane_mm), dr.pi * a * b


def surfaces_from_the_film(lens: rc.Lens) -> list[tuple[float, float, float, float]]:
    """Vertex (mm), curvature (1/mm), semi-diameter (mm) and n before over n behind, in the order of a ray from the
    film."""
    found, before = [], 1.0
    for index, (surface, vertex) in enumerate(zip(lens.surfaces, lens.vertices_mm, strict=True)):
        bends = surface.type == "refracting"
        if surface.conic or surface.aspheric_coefficients or (not bends and index != lens.stop_index):
            raise SystemExit(f"surface {index + 1}: spheres and a stop are all that this sensor knows")
        behind = surface.material.index(lens.wavelength_nm) if bends else before
        rim = lens.stop_semi_diameter_mm if index == lens.stop_index else surface.clear_semi_diameter_mm
        found.append((vertex, surface.curvature_per_mm, rim, behind / before))
        before = behind
    return found[::-1]


def trace(surfaces, o: mi.Point3f, d: mi.Vector3f) -> tuple[mi.Point3f, mi.Vector3f, mi.Bool]:
    """A ray (mm, relative to the front vertex) from the film through every surface."""
    passed = mi.Bool(True)
    for vertex, c, rim, ratio in surfaces:
        p = mi.Vector3f(o.x, o.y, o.z - vertex)
        if c == 0:
            p = dr.fma(d, -p.z / d.z, p)
        else:
            b = c * dr.dot(p, d) - d.z
            gap = c * dr.dot(p, p) - 2 * p.z
            root = dr.square(b) - c * gap
            passed &= root > 0
            # The meeting point that is near the vertex, without a difference of like numbers; d.z < 0.
            p = dr.fma(d, -gap / (b + dr.safe_sqrt(root)), p)
        passed &= dr.square(p.x) + dr.square(p.y) <= rim * rim
        if ratio != 1:
            normal = mi.Vector3f(-c * p.x, -c * p.y, 1 - c * p.z)
            cosine = -dr.dot(d, normal)
            root = 1 - ratio * ratio * (1 - dr.square(cosine))
            passed &= root > 0
            d = ratio * d + (ratio * cosine - dr.safe_sqrt(root)) * normal
        o = mi.Point3f(p.x, p.y, p.z + vertex)
    return o, d, passed


def load_lens_sensor(camera: rc.Camera, sampler: str = "independent", spp: int = 1) -> mi.Sensor:
    LensSensor.camera = camera
    mi.register_sensor("realcam_lens", LensSensor)
    return mi.load_dict(
        {
            "type": "realcam_lens",
            "film": film(*camera.film.resolution),
            "sampler": {"type": sampler, "sample_count": spp},
        }
    )
