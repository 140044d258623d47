"""A lens of realcam as a sensor of Mitsuba 3, traced surface by surface with Dr.Jit.

Supports spherical refracting surfaces and a circular stop. Mitsuba's variant must be set before this module is
imported.
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi
import numpy as np
import realcam as rc
from mitsuba_scene import film

ROWS = 33  # rows of the pupil table, for film points from the centre to the corner
GRID = 129  # rays along each side of the grid from which a row is computed


def pupil_table(camera: rc.Camera, plane_mm: float, radius_mm: float) -> np.ndarray:
    """(ROWS, 3): ellipses in the plane of the exit pupil that contain all rays to film points on the +x axis.

    Each row has the ellipse's centre on x and its semi-axes along x and y, mm; the distance of the film point from the
    axis rises from 0 to the film's corner. plane_mm: position of the plane. radius_mm: of the exit pupil.
    """
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
        # The ellipse within the bounding box would cut corners of the outline, and is scaled to contain all rays.
        scale = max(1.0, np.max(np.hypot((np.abs(px - centre) + cell) / a, (np.abs(py) + cell) / b)))
        rows.append((centre, a * scale, b * scale))
    return np.array(rows)


class LensSensor(mi.Sensor):
    """Sensor of a realcam camera, which is passed in the class attribute `camera`.

    Ray weights are irradiance on the film over radiance, so that pictures agree with realcam's without a factor.
    """

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
        # A blocked ray has no length.
        ray.maxt = dr.select(passed, dr.largest(mi.Float), 0)
        return ray, mi.Spectrum(dr.select(passed & active, weight, 0))

    def sample_ray_differential(self, time, wavelength_sample, position_sample, aperture_sample, active=True):
        ray, weight = self.sample_ray(time, wavelength_sample, position_sample, aperture_sample, active)
        return mi.RayDifferential3f(ray), weight

    def pupil_point(self, fx: mi.Float, fy: mi.Float, u: mi.Point2f) -> tuple[mi.Point3f, mi.Float]:
        """Samples the ellipse of a film point (fx, fy), mm. Returns the point, mm, and the ellipse's area, mm^2."""
        distance = dr.hypot(fx, fy)
        position = dr.minimum(distance * self.rows_per_mm, ROWS - 1.001)
        row = mi.UInt32(position)
        centre, a, b = (
            dr.lerp(dr.gather(mi.Float, column, row), dr.gather(mi.Float, column, row + 1), position - row)
            for column in self.table
        )
        disc = mi.warp.square_to_uniform_disk_concentric(u)
        x, y = centre + a * disc.x, b * disc.y
        cos = dr.select(distance > 0, fx / distance, 1)
        sin = dr.select(distance > 0, fy / distance, 0)
        return mi.Point3f(x * cos - y * sin, x * sin + y * cos, self.plane_mm), dr.pi * a * b


def surfaces_from_the_film(lens: rc.Lens) -> list[tuple[float, float, float, float]]:
    """Surfaces in the order of a ray from the film: vertex, mm; curvature, 1/mm; semi-diameter, mm; and the index on
    the film's side over that on the object's side."""
    rows, index_in_front = [], 1.0
    for number, (surface, vertex) in enumerate(zip(lens.surfaces, lens.vertices_mm, strict=True)):
        refracts = surface.type == "refracting"
        if surface.conic or surface.aspheric_coefficients or (not refracts and number != lens.stop_index):
            raise SystemExit(f"surface {number + 1}: this sensor supports only spherical surfaces and a stop")
        index_behind = surface.material.index(lens.wavelength_nm) if refracts else index_in_front
        rim = lens.stop_semi_diameter_mm if number == lens.stop_index else surface.clear_semi_diameter_mm
        rows.append((vertex, surface.curvature_per_mm, rim, index_behind / index_in_front))
        index_in_front = index_behind
    return rows[::-1]


def trace(surfaces, o: mi.Point3f, d: mi.Vector3f) -> tuple[mi.Point3f, mi.Vector3f, mi.Bool]:
    """Traces rays from the film through all surfaces, as from surfaces_from_the_film().

    o, d: origin, mm, relative to the front vertex, and unit direction. Returns those in front of the lens, and true for
    rays that pass.
    """
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
            # The intersection near the vertex, in a form without cancellation; d.z < 0.
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
    """Loads the sensor of a camera; see LensSensor."""
    LensSensor.camera = camera
    mi.register_sensor("realcam_lens", LensSensor)
    return mi.load_dict(
        {
            "type": "realcam_lens",
            "film": film(*camera.film.resolution),
            "sampler": {"type": sampler, "sample_count": spp},
        }
    )
