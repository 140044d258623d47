"""Aberrations of a lens by ray-optics: Seidel sums, rays through points of the real stop, and their optical paths.

The object is near: over the 1e10 mm of an object at infinity ray-optics' rays are rounded to 1e-6 mm.
"""

from __future__ import annotations

import gzip
import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .prescription import Prescription
from .ray_optics_peer import TOLERANCE, WAVELENGTH_NM, model_of

# tools/make_ray_optics_analysis.py writes it.
FILE = Path(__file__).with_name("ray_optics_analysis.json.gz")
OBJECT_MM = 3000.0
FIELD = 0.6  # of the film's corner
# Stop points of the rays, in units of the stop's radius: the first four are those of a fan of five.
STOP_POINTS = np.array(
    [(0, -0.5), (0, 0.5), (-0.5, 0), (0.5, 0), (0, 0.8), (0, -0.8), (0.8, 0), (-0.4, 0.4), (0.5, -0.6)]
)
# ray-optics starts its search for a ray through the stop at the paraxial entrance pupil; in these lenses that ray
# misses a surface.
ABSENT = {
    "fisheye-10mm",
    "flektogon-20mm",
    "projection-24mm-160deg",
    "projection-28mm-120deg",
    "zoom-11-24mm",
}


@dataclass(frozen=True)
class Opinion:
    """seidel: (surfaces, 5), S_I to S_V in mm, for a marginal ray that meets the stop's edge.
    points: (N, 2), film points in mm from the axis of the rays through PLACES; nan if the search finds no ray.
    chief_point: (2,), film point of the ray through the centre of the stop.
    opd: (N,), mm, against the sphere about chief_point through the point at which that ray crosses the axis.
    """

    seidel: np.ndarray
    points: np.ndarray
    chief_point: np.ndarray
    opd: np.ndarray


def analysed(lens: Prescription, film_distance: float, field_deg: float) -> Opinion:
    """Results for an object point below the axis, at `field_deg` from the centre of the paraxial entrance pupil; mm."""
    from rayoptics.raytr.traceerror import TraceError

    model = model_of(lens, OBJECT_MM, film_distance)
    pupil_z = OBJECT_MM + model["analysis_results"]["parax_data"].fod.enp_dist
    point = np.array([0.0, -pupil_z * math.tan(math.radians(field_deg)), 0.0])
    aim = _Aim(model, lens.stop + 1, point, np.array([0.0, 0.0, pupil_z]))
    chief = aim.ray(np.zeros(2))
    radius = lens.rows[lens.stop].semi_diameter
    points, paths = np.full((len(STOP_POINTS), 2), np.nan), np.full(len(STOP_POINTS), np.nan)
    for i, place in enumerate(STOP_POINTS):
        try:
            ray = aim.ray(radius * place)
        except (ArithmeticError, TraceError):
            continue
        points[i], paths[i] = ray[-1][0][:2], _path_to_sphere(model, ray, chief)
    chief_path = _path_to_sphere(model, chief, chief)
    return Opinion(_seidel(model, lens, field_deg), points, chief[-1][0][:2], chief_path - paths)


def _path_to_sphere(model: Any, ray: Any, chief: Any) -> float:
    """From the object to the sphere about the chief ray's point that passes where that ray crosses the axis.

    By its definition, from the stretches of ray-optics' rays: its own waveabr goes by Hopkins' equally inclined chords,
    whose figure is off by 5e-3 waves where the double Gauss has 20.
    """
    path = sum(index[0] * segment[2] for index, segment in zip(model["seq_model"].rndx, ray[:-1], strict=True))
    centre, ray_direction = chief[-1][0], chief[-2][1]
    radius = centre[1] / ray_direction[1]
    away, direction = ray[-1][0] - centre, ray[-2][1]
    along = away @ direction
    back = along + math.copysign(math.sqrt(along**2 - away @ away + radius**2), radius)
    return float(path - model["seq_model"].rndx[-1][0] * back)


def write(version: str, opinions: dict[str, tuple[float, Opinion]]) -> None:
    """opinions: lens name -> field angle in degrees and results."""
    lenses = {
        name: {"field_deg": field, **{key: value.tolist() for key, value in vars(said).items()}}
        for name, (field, said) in opinions.items()
    }
    text = json.dumps({"version": version, "lenses": lenses}, separators=(",", ":"))
    # Without a time in the header, the same figures make the same file.
    FILE.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def read() -> dict[str, tuple[float, Opinion]]:
    content = json.loads(gzip.decompress(FILE.read_bytes()))
    return {
        name: (said.pop("field_deg"), Opinion(**{key: np.array(value) for key, value in said.items()}))
        for name, said in content["lenses"].items()
    }


class _Aim:
    """Rays of an object point through specified points of the stop. ray-optics' own search stops at 1e-8 mm."""

    def __init__(self, model: Any, stop: int, point: np.ndarray, pupil: np.ndarray) -> None:
        self.sequence, self.stop, self.point, self.pupil = model["seq_model"], stop, point, pupil

    def ray(self, place: np.ndarray) -> Any:
        from scipy.optimize import root

        found = root(lambda at: self._trace(at)[self.stop][0][:2] - place, place, method="hybr", tol=1e-14)
        if np.abs(found.fun).max() > 1e-11:
            raise ArithmeticError(f"no ray through {place}: {found.message}")
        return self._trace(found.x)

    def _trace(self, at: np.ndarray) -> Any:
        from rayoptics.raytr import raytrace

        ray_direction = self.pupil + np.array([*at, 0.0]) - self.point
        return raytrace.trace(
            self.sequence, self.point, ray_direction / np.linalg.norm(ray_direction), WAVELENGTH_NM, eps=TOLERANCE
        )[0]


def _seidel(model: Any, lens: Prescription, field_deg: float) -> np.ndarray:
    """Scaled from ray-optics' own marginal and chief ray: S_I goes with the fourth power of the one, S_V with the first
    of the one and the third of the other."""
    from rayoptics.parax import thirdorder

    parax = model["analysis_results"]["parax_data"]
    table = thirdorder.compute_third_order(model)
    marginal = lens.rows[lens.stop].semi_diameter / abs(parax.ax_ray[lens.stop + 1][0])
    chief = math.tan(math.radians(field_deg)) / parax.pr_ray[0][1]
    sums = np.zeros((len(lens.rows), 5))
    for i in range(len(lens.rows)):
        for row in (str(i + 1), f"{i + 1}.asp"):
            if row in table.index:
                sums[i] += table.loc[row].to_numpy(dtype=float)
    return sums * [
        marginal**4,
        marginal**3 * chief,
        (marginal * chief) ** 2,
        (marginal * chief) ** 2,
        marginal * chief**3,
    ]
