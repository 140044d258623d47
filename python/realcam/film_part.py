"""Parts of a picture as sums of samples, rendered by sessions on any number of machines, and their accumulation."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._core import InputError
from .archive import packed, read_archive, write_archive
from .pickling import PickledByFields, same_arrays

if TYPE_CHECKING:
    from ._core import RenderSettings, _Region, _Splats

FORMAT = 3  # of the files of parts


@dataclass(frozen=True, eq=False)
class FilmPart(PickledByFields):
    """Sums over some samples of a region of the film: Session.expose returns them, Session.image_of adds them up.

    region: column and row of its first pixel, width and height; None: the whole film, for splatted light.
    first: index of the first sample. spp: number of samples per pixel from there on.
    pixels, layers: (height, width) structured arrays of sums over the samples; None: not collected.
    splats: fixed-point sums of each kind of splatted light (ghosts, starbursts, lamps by light tracing).
    stats: seconds, and numbers of rays, by the names of RenderStats.
    """

    region: _Region | None
    first: int
    spp: int
    pixels: np.ndarray | None = None
    layers: np.ndarray | None = None
    splats: list[_Splats] = field(default_factory=list)
    stats: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.region is not None and not (
            len(self.region) == 4 and all(isinstance(n, int | np.integer) and n >= 0 for n in self.region)
        ):
            raise InputError("the region of a part must be (column, row, width, height), whole numbers of 0 or more")
        shape = None if self.region is None else (self.region[3], self.region[2])
        for name, dtype in (("pixels", _core._PIXEL_SUM), ("layers", _core._LAYER_SUM)):
            sums = getattr(self, name)
            if sums is not None and (shape is None or sums.shape != shape or sums.dtype != dtype):
                raise InputError(f"the {name} of a part must be sums of its region's pixels")
        for number in (self.first, self.spp):
            if isinstance(number, bool) or not isinstance(number, int | np.integer) or not 0 <= number < 1 << 32:
                raise InputError("first and spp of a part must be whole numbers of 0 or more")
        if not all(
            isinstance(name, str) and isinstance(n, float | int) and 0 <= n < math.inf for name, n in self.stats.items()
        ):
            raise InputError("the stats of a part must be finite numbers of 0 or more")
        if not all(_is_splat(light) for light in self.splats):
            raise InputError("the splats of a part must be arrays (films, H, W, 3) of int64 for each kind of light")

    def __eq__(self, other: object) -> bool:
        """Returns True if regions, samples and sums are equal; stats are not compared."""
        if not isinstance(other, FilmPart):
            return NotImplemented
        about, others = self._about(), other._about()
        about.pop("stats"), others.pop("stats")
        mine, theirs = self._arrays(), other._arrays()
        return about == others and mine.keys() == theirs.keys() and all(same_arrays(mine[k], theirs[k]) for k in mine)

    __hash__ = None  # type: ignore[assignment]  # its arrays may be written to

    def __repr__(self) -> str:
        where = "light traced apart" if self.region is None else "{2} x {3} pixels at {0}, {1}".format(*self.region)
        return f"<realcam.FilmPart {where}, samples {self.first} to {self.first + self.spp}>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the part completely or not at all, even on a power failure. Raises ImageFileError."""
        write_archive(path, self.packed())

    def packed(self, owner: str = "") -> bytes:
        """Returns the content of its file. owner: identity of the job that the part belongs to, if any."""
        # Splats compress well: they leave most pixels 0.
        return packed(self._about(), self._arrays(), owner=owner, is_compressed=bool(self.splats))

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, owner: str = "", limit_bytes: int = 1 << 34) -> FilmPart:
        """Reads a part that belongs to `owner` and whose unpacked size is at most limit_bytes.

        Raises InputError if it is missing, damaged or not a part of a film.
        """
        about, arrays = read_archive(Path(path), owner=owner, limit_bytes=limit_bytes)
        try:
            if about["format"] != FORMAT:
                raise InputError(f"its format is {about['format']!r:.20}, and this realcam reads {FORMAT}")
            region = about["region"]
            splats: list[Any] = [{**light, "sums": arrays[f"splats{i}"]} for i, light in enumerate(about["splats"])]
            return cls(
                region=None if region is None else tuple(region),
                first=about["first"],
                spp=about["spp"],
                pixels=_joined(arrays, "pixels", _core._PIXEL_SUM),
                layers=_joined(arrays, "layers", _core._LAYER_SUM),
                splats=splats,
                stats=about["stats"],
            )
        except InputError as error:
            raise InputError(f"{os.fspath(path)}: {error}") from None
        except (KeyError, ValueError, TypeError, AttributeError, OverflowError):
            raise InputError(f"{os.fspath(path)}: is not a part of a film, or is damaged") from None

    def _about(self) -> dict[str, Any]:
        """Returns the description in the archive: everything but the arrays."""
        return {
            "format": FORMAT,
            "region": None if self.region is None else list(self.region),
            "first": self.first,
            "spp": self.spp,
            "splats": [{k: v for k, v in light.items() if k != "sums"} for light in self.splats],
            "stats": self.stats,
        }

    def _arrays(self) -> dict[str, np.ndarray]:
        """Arrays of the archive. Structured sums are stored field by field; the optional sums of PixelSum (variance,
        dual pixels, control variates) are left out if all are 0."""
        arrays = {f"splats{i}": light["sums"] for i, light in enumerate(self.splats)}
        for name in ("pixels", "layers"):
            sums = getattr(self, name)
            for key in () if sums is None else sums.dtype.names:
                if key != "auxiliary" or sums[key].any():
                    arrays[f"{name}.{key}"] = sums[key]
        return arrays


def _joined(arrays: Mapping[str, np.ndarray], name: str, dtype: np.dtype[np.void]) -> np.ndarray | None:
    """Returns the structured array that _arrays has separated into fields; None if there is none.

    Raises ValueError if a field is missing or has another shape or dtype.
    """
    found = {key.removeprefix(f"{name}."): array for key, array in arrays.items() if key.startswith(f"{name}.")}
    if not found:
        return None
    if found.keys() | {"auxiliary"} != set(dtype.names or ()) | {"auxiliary"}:
        raise ValueError
    shape = next(iter(found.values())).shape[:2]
    sums = np.zeros(shape, dtype)
    for key, array in found.items():
        if array.shape != sums[key].shape or array.dtype != sums[key].dtype:
            raise ValueError
        sums[key] = array
    return sums


def _is_splat(light: Any) -> bool:
    """Returns True for a valid dict of splatted light (_Splats)."""
    if not isinstance(light, dict) or light.keys() != {"light", "sums", "blocks", "units_per_lux"}:
        return False
    sums, blocks, units = light["sums"], light["blocks"], light["units_per_lux"]
    return (
        type(light["light"]) is int
        and 0 <= light["light"] < _core._TRACED_LIGHTS
        and isinstance(sums, np.ndarray)
        and sums.dtype == np.int64
        and sums.ndim == 4
        and sums.shape[3] == 3
        and isinstance(blocks, list)
        and len(blocks) == sums.shape[0]
        and all(type(block) is int and 0 <= block < 1 << 63 for block in blocks)
        and isinstance(units, float)
        and math.isfinite(units)
        and units > 0
    )


class AccumulatedFilm:
    """Sum of the parts of one film. Add parts in the order of their samples: floating-point sums depend on it."""

    def __init__(self, width: int, height: int) -> None:
        self.pixels = np.zeros((height, width), _core._PIXEL_SUM)
        self.layers: np.ndarray | None = None
        self.splats: list[_Splats] = []
        self.stats: dict[str, float] = {}

    def add(self, part: FilmPart) -> None:
        """Adds a part. Raises InputError for a part of another film."""
        if part.region is not None:
            column, row, width, height = part.region
            where = np.s_[row : row + height, column : column + width]
            if self.pixels[where].shape != (height, width):
                raise InputError(f"{part!r} does not lie on the film")
            if part.pixels is not None:
                _add_fields(self.pixels[where], part.pixels)
            if part.layers is not None:
                if self.layers is None:
                    self.layers = np.zeros(self.pixels.shape, _core._LAYER_SUM)
                _add_fields(self.layers[where], part.layers)
        self._add_splats(part)
        for name, value in part.stats.items():
            self.stats[name] = self.stats.get(name, 0) + value

    def exposure(self, settings: RenderSettings, exposure_time_s: float) -> np.ndarray:
        """Returns the exposure, (H, W, 3) float32, in lux seconds. settings: those of the samples."""
        return _core._developed_exposure(self.pixels, self.splats, settings, exposure_time_s)

    def traced_exposure(self, exposure_time_s: float) -> np.ndarray:
        """Returns the exposure of the splatted light, (H, W, 3) in lux seconds; (0, W, 3) if there are no splats."""
        return _core._traced_exposure(self.splats, exposure_time_s)

    def _add_splats(self, part: FilmPart) -> None:
        if not self.splats:
            self.splats = [{**light, "sums": light["sums"].copy()} for light in part.splats]
            return
        if not part.splats:
            return

        def kinds(splats: list[_Splats]) -> list[tuple[int, float, tuple[int, ...]]]:
            return [(light["light"], light["units_per_lux"], light["sums"].shape) for light in splats]

        if kinds(self.splats) != kinds(part.splats):
            raise InputError(f"{part!r} has other lights than the film")
        for sum_, light in zip(self.splats, part.splats, strict=True):
            sum_["sums"] += light["sums"]
            sum_["blocks"] = [a + b for a, b in zip(sum_["blocks"], light["blocks"], strict=True)]


def _add_fields(sums: np.ndarray, more: np.ndarray) -> None:
    for name in sums.dtype.names or ():
        sums[name] += more[name]


# Stats of a film without samples, with all names.
NO_STATS = dict.fromkeys(
    ("seconds", "lens_seconds", "scene_seconds", "other_seconds", "sampled_rays", "passed_rays", "scene_rays"), 0.0
)
