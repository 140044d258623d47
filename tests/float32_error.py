"""How far float32 image points are off, for rays over the whole film and pupil of a lens.

A ray starts at a film point, is traced to the scene in float32, and back from there in float64. The distance from
where it meets the film to where it started is the error of the picture: the image is displaced by it. The start of the
ray is exact, because all its numbers are float32.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import realcam as rc

LIMIT_UM = 0.08  # 1/50 of a pixel of 4 um, on films up to 24 mm x 36 mm; larger films have larger pixels (limit_um)
SMALL_FILM_MM = 21.7  # half the diagonal of 24 mm x 36 mm

# The intended image circle of lenses with a larger film. Beyond 110 degrees the image of the 220 degree fisheye
# is very sensitive: it moves by 0.2 mm on the film for 1e-3 in direction and by 25 um for 1 um in position, so that the
# rounding of a few steps, in coordinates of up to 36 mm (half a unit is 0.002 um), causes some tenths of a micrometre.
IMAGE_RADIUS_MM = {"fisheye-6mm-220deg": 10.47}
BEYOND_UM = 0.25

FILM_RADII = 33
RAYS_PER_RADIUS = 4_000


def limit_um(lens: rc.Lens) -> float:
    """Largest error of an image point allowed in float32, um: rounding grows with the lens, as pixels with the film."""
    return LIMIT_UM * max(1.0, 0.5 * float(np.hypot(*lens.film_mm)) / SMALL_FILM_MM)


@dataclass(frozen=True)
class PupilBoxes:
    """Boxes of direction cosines (l, m) that contain the pupil as seen from film points at these radii.

    The film point lies on the +x axis; low and high are (N, 2).
    """

    film_radii_mm: np.ndarray
    low: np.ndarray
    high: np.ndarray


@dataclass(frozen=True)
class Rays:
    """Rays from the film: lens frame, unit directions. `device`: the one that traces them, as in Lens.trace."""

    origins_mm: np.ndarray
    directions: np.ndarray
    film_radius_mm: np.ndarray
    device: str = "cpu"

    def trace(self, lens: rc.Lens, dtype: str, surface_count: int | None = None) -> rc.TraceResult:
        how = {"start": "film", "dtype": dtype, "surface_count": surface_count, "device": self.device}
        return lens.trace(self.origins_mm, self.directions, **how)

    def __getitem__(self, chosen: np.ndarray) -> Rays:
        return Rays(self.origins_mm[chosen], self.directions[chosen], self.film_radius_mm[chosen], self.device)


@dataclass(frozen=True)
class ImagePointErrors:
    """One entry for each ray that passes the lens."""

    film_radius_mm: np.ndarray
    stop_height: np.ndarray  # 1 at the rim of the wide open stop
    error_um: np.ndarray
    lost: int  # number of other rays, which a rim blocks on their return


def passes(result: rc.TraceResult) -> np.ndarray:
    return result.status == int(rc.RayStatus.OK)


def _float32(values: np.ndarray) -> np.ndarray:
    return values.astype(np.float32).astype(np.float64)


def film_z_mm(lens: rc.Lens) -> float:
    """The film, moved by less than an ulp to where float32 has a number for its distance."""
    return lens.vertices_mm[-1] + float(np.float32(lens.film_distance_mm))


def pupil_boxes(lens: rc.Lens) -> PupilBoxes:
    """For radii from the middle of the film to its corner, or to the end of the image circle where that is nearer."""
    corner = 0.5 * float(np.hypot(*lens.film_mm))
    lit, dark = 0.0, corner
    if not len(_boxes(lens, np.array([corner])).film_radii_mm):
        for _ in range(12):
            middle = 0.5 * (lit + dark)
            lit, dark = (middle, dark) if len(_boxes(lens, np.array([middle])).film_radii_mm) else (lit, middle)
    else:
        lit = corner
    return _boxes(lens, _float32(np.linspace(0, lit, FILM_RADII)))


def sample_boxes(boxes: PupilBoxes, per_radius: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Film radii (N,) and cosines (N, 2), uniform over the boxes: some rays beside the pupil are among them."""
    share = random.random((len(boxes.film_radii_mm), per_radius, 2))
    cosines = boxes.low[:, None] + (boxes.high - boxes.low)[:, None] * share
    return np.repeat(boxes.film_radii_mm, per_radius), cosines.reshape(-1, 2)


def exact_rays(lens: rc.Lens, film_radius_mm: np.ndarray, cosines: np.ndarray) -> Rays:
    """From points on the +x axis of the film, unrounded. Cosines of more than 1 give rays along the film."""
    depth = np.sqrt(np.maximum(1 - (cosines**2).sum(axis=1), 1e-12))
    origins = np.zeros((len(cosines), 3))
    origins[:, 0], origins[:, 2] = film_radius_mm, film_z_mm(lens)
    return Rays(origins, np.column_stack([cosines, -depth]), film_radius_mm)


def rounded_rays(rays: Rays, azimuth: np.ndarray) -> Rays:
    """Turned around the axis and rounded to float32. Rays that tracing would round again, because their length is not
    quite 1 any more, are left out: one in a hundred at most."""
    c, s = np.cos(azimuth), np.sin(azimuth)

    def turned(v: np.ndarray) -> np.ndarray:
        return _float32(np.column_stack([c * v[:, 0] - s * v[:, 1], s * v[:, 0] + c * v[:, 1]]))

    origins = np.column_stack([turned(rays.origins_mm), rays.origins_mm[:, 2]])
    directions = np.column_stack([turned(rays.directions), _float32(rays.directions[:, 2])])
    unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return Rays(origins, directions, rays.film_radius_mm)[(_float32(unit) == directions).all(axis=1)]


def rays_over_film_and_pupil(lens: rc.Lens, seed: int = 1) -> Rays:
    random = np.random.default_rng(seed)
    radii, cosines = sample_boxes(pupil_boxes(lens), RAYS_PER_RADIUS, random)
    return rounded_rays(exact_rays(lens, radii, cosines), random.uniform(0, 2 * np.pi, len(radii)))


def back_to_film(lens: rc.Lens, out: rc.TraceResult) -> tuple[np.ndarray, np.ndarray]:
    """Traces rays from the scene back in float64. Returns their film points (N, 2) and which rays reach the film."""
    back = lens.trace(out.origins_mm, -out.directions, start="scene", dtype="float64")
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = back.directions[:, :2] / back.directions[:, 2:]
    return back.origins_mm[:, :2] + slope * (film_z_mm(lens) - back.origins_mm[:, 2:]), passes(back)


def image_point_errors(lens: rc.Lens, rays: Rays) -> ImagePointErrors:
    out = rays.trace(lens, "float32")
    points, returned = back_to_film(lens, out)
    measured = passes(out) & returned
    error = 1e3 * np.linalg.norm(points - rays.origins_mm[:, :2], axis=1)
    at_stop = rays.trace(lens, "float32", surface_count=len(lens.surfaces) - lens.stop_index).origins_mm
    height = np.hypot(at_stop[:, 0], at_stop[:, 1]) / lens.stop_semi_diameter_mm
    lost = int((passes(out) & ~returned).sum())
    return ImagePointErrors(rays.film_radius_mm[measured], height[measured], error[measured], lost)


def _boxes(lens: rc.Lens, radii: np.ndarray) -> PupilBoxes:
    """Boxes of those film points that light reaches: first in all that the rear rim lets in, then closer."""
    rim = lens.surfaces[-1].clear_semi_diameter_mm
    distance = lens.film_distance_mm - max(0.0, lens.surfaces[-1].sag_mm(rim))
    away = np.stack([np.stack([side * rim - radii, np.full_like(radii, side * rim)], axis=1) for side in (-1, 1)])
    low, high = away / np.hypot(away, distance)
    # Most pupils fill a tenth of that width or more. Some of wide lenses lie between the rays of the coarse grid.
    lit = _closer(lens, radii, low, high, 40)
    if len(lit[0]) < len(radii):
        lit = _closer(lens, radii, low, high, 120)
    return PupilBoxes(*_closer(lens, *lit, 60))


def _closer(
    lens: rc.Lens, radii: np.ndarray, low: np.ndarray, high: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The part of the boxes in which rays of a grid pass, and a little more than a cell around it."""
    cell = (high - low) / count
    index = np.stack(np.meshgrid(*[np.arange(count) + 0.5] * 2), axis=-1).reshape(-1, 2)
    cosines = low[:, None] + cell[:, None] * index
    rays = exact_rays(lens, np.repeat(radii, len(index)), cosines.reshape(-1, 2))
    passing = passes(rays.trace(lens, "float64")).reshape(*cosines.shape[:2], 1)
    lit = passing.any(axis=(1, 2))
    inside = [np.where(passing, cosines, fill)[lit] for fill in (np.inf, -np.inf)]
    margin = 1.1 * cell[lit]
    return radii[lit], inside[0].min(axis=1) - margin, inside[1].max(axis=1) + margin
