"""Files of ray pairs (format ray-pairs/1): rays behind a lens, and the same rays in front of it."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InputError, Lens, RayStatus
from ..archive import read_regular, unpacked
from ..files import check_target, write_whole

FORMAT = "ray-pairs/1"
_LIMIT_BYTES = 1 << 30
_MOST_RAYS = 1_000_000
_LONGEST_MM = 1e6
LEAST_NM = 250.0  # above the pole of the wavelength variable (dispersion.POLE_NM)
_COLUMNS = {"wavelength_nm": 0, "film_mm": 2, "film_side_mm": 2, "object_origin_mm": 3, "object_direction": 3, "ok": 0}
_WIDE_COSINE = 0.05  # of the angle to the axis, below which a ray crosses a plane far from the lens

_FIELDS = 33  # film radii at which the light behind the lens is found
_AROUND = 1.4  # size of the discs of points, relative to the light in them
_LEAST_REACH = 0.1  # of their sizes, where rims leave little light

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RayPairs:
    """Ray pairs of a lens in the frame of the file: z along the light, towards the film; mm."""

    name: str
    f_number: float
    focus_distance_m: float
    film_size_mm: tuple[float, float]
    film_z_mm: float
    film_side_z_mm: float  # plane of film_side_mm
    wavelength_nm: Array  # (N,)
    film_mm: Array  # (N, 2)
    film_side_mm: Array  # (N, 2)
    object_origin_mm: Array  # (N, 3), any point of the ray in front of the lens
    object_direction: Array  # (N, 3), unit vectors
    ok: NDArray[np.bool_]  # (N,), True for rays that pass the lens


def read_ray_pairs(source: str | os.PathLike[str] | Mapping[str, Any]) -> RayPairs:
    """Returns the ray pairs of a file, or of its arrays by name. Raises InputError, in one line, for any other content.

    Arrays of N rays: wavelength_nm (N,), film_mm and film_side_mm (N, 2), object_origin_mm and object_direction (N, 3),
    ok (N,), of which those of object space count only where ok is True. meta: the text of a JSON object, or a mapping,
    with the keys that RayPairs names: lens, f_number, focus_distance_m, film_size_mm, film_plane_z_mm and
    film_side_reference_z_mm. Other arrays and keys are not read.
    """
    if isinstance(source, Mapping):
        where, arrays = "ray pairs", {str(name): np.asarray(value) for name, value in source.items() if name != "meta"}
        meta = source.get("meta")
    else:
        path = Path(source)
        where = str(path)
        content = read_regular(path.resolve(), _LIMIT_BYTES)
        arrays = unpacked(path, content, _LIMIT_BYTES, "biufU")
        meta = arrays.pop("meta", None)
    return _checked(where, arrays, _meta(where, meta))


def _meta(where: str, meta: Any) -> Mapping[str, Any]:
    if isinstance(meta, np.ndarray) and meta.dtype.kind == "U" and meta.size == 1:
        meta = str(meta.reshape(()))
    if isinstance(meta, str):
        try:
            meta = json.loads(meta)
        except (ValueError, RecursionError):
            raise InputError(f"{where}: meta is not JSON") from None
    if not isinstance(meta, Mapping) or meta.get("format") != FORMAT:
        raise InputError(f'{where}: meta must be a JSON object whose "format" is "{FORMAT}"')
    return meta


def _checked(where: str, arrays: Mapping[str, np.ndarray], meta: Mapping[str, Any]) -> RayPairs:
    missing = [name for name in _COLUMNS if name not in arrays]
    if missing:
        raise InputError(f"{where}: there is no array {missing[0]}")
    count = arrays["ok"].size
    found: dict[str, Any] = {}
    for name, columns in _COLUMNS.items():
        shape = (count, columns) if columns else (count,)
        array = arrays[name]
        if array.shape != shape or array.dtype.kind not in "biuf":
            raise InputError(f"{where}: {name} must be numbers of the shape {shape}, not {array.dtype} {array.shape}")
        found[name] = array.astype(bool) if name == "ok" else array.astype(float)
    if not 1 <= count <= _MOST_RAYS:
        raise InputError(f"{where}: {count} rays; expected 1 to {_MOST_RAYS}")
    ok = found["ok"]
    for name in found:
        used = found[name][ok] if name.startswith("object") else found[name]
        if not (np.isfinite(used) & (np.abs(used) <= _LONGEST_MM)).all():
            raise InputError(f"{where}: {name} has a number that is not finite or above 1e6")
    lengths = np.linalg.norm(found["object_direction"][ok], axis=1)
    if not (np.abs(lengths - 1) < 1e-4).all():
        raise InputError(f"{where}: object_direction must be unit vectors")
    if not ((found["wavelength_nm"] >= LEAST_NM) & (found["wavelength_nm"] <= 20000)).all():
        raise InputError(f"{where}: wavelength_nm must lie between {LEAST_NM:g} and 20000")
    planes = ("film_plane_z_mm", "film_side_reference_z_mm")
    film_z, side_z = (_number(where, meta, key, -_LONGEST_MM) for key in planes)
    if not film_z > side_z:
        raise InputError(f"{where}: film_plane_z_mm must be larger than film_side_reference_z_mm")
    size = meta.get("film_size_mm")
    if not isinstance(size, Sequence) or isinstance(size, str) or len(size) != 2:
        raise InputError(f"{where}: film_size_mm must be [width, height]")
    width, height = (_number(where, {"film_size_mm": side}, "film_size_mm", 1e-6) for side in size)
    focus = np.inf if meta.get("focus_distance_m") is None else _number(where, meta, "focus_distance_m", 1e-6)
    return RayPairs(
        str(meta.get("lens", ""))[:200],
        _number(where, meta, "f_number", 1e-6),
        focus,
        (width, height),
        film_z,
        side_z,
        **found,
    )


def _number(where: str, meta: Mapping[str, Any], key: str, least: float) -> float:
    value = meta.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= _LONGEST_MM:
        raise InputError(f"{where}: {key} must be a number from {least:g} to 1e6, not {value!r:.40}")
    return float(value)


def save_rays(
    self: Lens,
    path: str | os.PathLike[str],
    *,
    rays: int = 20000,
    wavelengths_nm: ArrayLike | None = None,
    seed: int = 0,
) -> None:
    """Writes rays of a lens, at its current focus and stop, to an .npz file of the format ray-pairs/1.

    Film points are uniform over the circle about the film, and the points in the plane of the last vertex over a disc
    about the light of the film point. Blocked rays are stored, too, because vignetting is fitted to them.
    rays: their number. wavelengths_nm: of which each ray has one, at random; None: the design wavelength. seed: of the
    random numbers.

    Raises InputError for a lens without rotational symmetry or with a curved film, and ImageFileError.
    """
    check_target(path, (".npz",))
    if not 1 <= rays <= _MOST_RAYS:
        raise InputError(f"rays must lie between 1 and {_MOST_RAYS}")
    if not self.is_rotational or np.isfinite(self.film_radius_of_curvature_mm):
        raise InputError("ray pairs need a rotationally symmetric lens with a flat film")
    if abs(self.first_order().image_index - 1) > 1e-3:
        raise InputError("ray pairs need a lens with air in front of the film")
    waves = np.atleast_1d(np.asarray(self.wavelength_nm if wavelengths_nm is None else wavelengths_nm, float))
    if waves.ndim != 1 or not waves.size:
        raise InputError("wavelengths_nm must be a list of wavelengths")
    random = np.random.default_rng(seed)
    film_z, last_z = self.film_position_mm, self.film_position_mm - self.film_distance_mm
    corner = float(np.hypot(*self.film_mm)) / 2
    film = _in_disc(random, rays, corner)
    side = _around_light(self, film, corner, _in_disc(random, rays, 1.0))
    towards = np.column_stack([side - film, np.full(rays, last_z - film_z)])
    towards /= np.linalg.norm(towards, axis=1)[:, None]
    wavelength = random.choice(waves, rays)
    origin, direction = np.full((rays, 3), np.nan), np.full((rays, 3), np.nan)
    transmission, status = np.zeros(rays), np.zeros(rays, np.uint8)
    start = np.column_stack([film, np.full(rays, film_z)])
    for wave in np.unique(wavelength):
        here = wavelength == wave
        traced = self.trace(start[here], towards[here], wavelength_nm=float(wave), transmission=True)
        origin[here], direction[here], status[here] = traced.origins_mm, traced.directions, traced.status
        transmission[here] = traced.transmission
    ok = status == RayStatus.OK
    origin[~ok], direction[~ok] = np.nan, np.nan
    if ok.any() and direction[ok, 2].max() < -_WIDE_COSINE:
        origin[ok] -= (origin[ok, 2] / direction[ok, 2])[:, None] * direction[ok]
    meta = {
        "format": FORMAT,
        "lens": self.name,
        "f_number": self.f_number,
        "focus_distance_m": self.focus_distance_m if np.isfinite(self.focus_distance_m) else None,
        "focal_length_mm": self.first_order().effective_focal_length_mm,
        "film_plane_z_mm": film_z,
        "film_side_reference_z_mm": last_z,
        "object_side_reference_z_mm": 0.0,
        "film_size_mm": list(self.film_mm),
        "wavelengths_nm": waves.tolist(),
        "axes": "z along the light, from the scene to the film, 0 at the front vertex; the image is inverted",
        "status": {item.name: int(item) for item in RayStatus},
    }
    content = io.BytesIO()
    np.savez_compressed(
        content,
        meta=np.array(json.dumps(meta)),
        wavelength_nm=wavelength,
        film_mm=film,
        film_side_mm=side,
        film_direction=towards,
        object_origin_mm=origin,
        object_direction=direction,
        transmission=transmission,
        ok=ok,
        status=status,
    )
    write_whole(path, content.getvalue())


def _in_disc(random: np.random.Generator, count: int, radius: float) -> Array:
    r, angle = radius * np.sqrt(random.random(count)), 2 * np.pi * random.random(count)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle)])


def _around_light(lens: Lens, film: Array, corner: float, disc: Array) -> Array:
    """Returns points of the plane of the last vertex, (N, 2), in discs about the light of film points (N, 2).

    disc: points of the unit disc. Raises InputError if no light reaches the film.
    """
    lit, centres, reaches = [], [], []
    for radius in np.linspace(0, corner, _FIELDS):
        cosines = lens.film_pupil((radius, 0.0)).outline.reshape(-1, 2)
        if not len(cosines):
            continue
        slopes = cosines / np.sqrt(1 - (cosines**2).sum(1))[:, None]
        points = [radius, 0] - lens.film_distance_mm * slopes
        lit.append(radius)
        centres.append((points[:, 0].min() + points[:, 0].max()) / 2)
        reaches.append(np.hypot(points[:, 0] - centres[-1], points[:, 1]).max())
    if not lit:
        raise InputError("no light reaches the film of the lens")
    radii = np.hypot(*film.T)
    outwards = film / np.maximum(radii, 1e-12)[:, None]
    reach = np.maximum(np.interp(radii, lit, reaches), _LEAST_REACH * max(reaches))
    return np.asarray(np.interp(radii, lit, centres)[:, None] * outwards + (_AROUND * reach)[:, None] * disc)
