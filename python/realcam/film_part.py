"""Parts of a picture, which sessions on any number of machines have exposed."""

from __future__ import annotations

import io
import json
import os
import zipfile
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._core import InputError
from .files import write_whole
from .pickling import same_arrays, set_checked_state

if TYPE_CHECKING:
    from ._core import RenderSettings, _Region, _Splats

FORMAT = 2


@dataclass(frozen=True, eq=False)
class FilmPart:
    """What some samples of a part of the film have collected: Session.expose makes it, Session.image_of adds it up.

    region: column and row of its first pixel, width and height; None: the whole film, for light that is traced apart
    from the samples of pixels. first: number of the first sample; spp: samples of each pixel from there on.
    pixels, layers: (height, width), sums over the samples, with named fields; None: there are none. splats: for each
    light that was traced apart, its sums in whole numbers. stats: seconds, and numbers of rays.
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
            raise InputError("the region of a part is (column, row, width, height), whole numbers from 0 on")
        shape = None if self.region is None else (self.region[3], self.region[2])
        for name, dtype in (("pixels", _core._PIXEL_SUM), ("layers", _core._LAYER_SUM)):
            sums = getattr(self, name)
            if sums is not None and (shape is None or sums.shape != shape or sums.dtype != dtype):
                raise InputError(f"the {name} of a part must be sums of its region's pixels")
        if self.first < 0 or self.spp < 0:
            raise InputError("a part has samples from a number on, both of which are 0 or more")

    def __setstate__(self, state: Any) -> None:
        set_checked_state(self, state, lambda made: made._written())

    def __eq__(self, other: object) -> bool:
        """Whether both have collected the same; what it cost does not count."""
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
        """Writes the part, as a whole or not at all, also where the machine stops. Raises ImageFileError."""
        write_whole(path, self._written(), is_durable=True)

    def _written(self) -> bytes:
        content = io.BytesIO()
        about = np.frombuffer(json.dumps(self._about()).encode(), np.uint8)
        # Light that is traced apart leaves most pixels dark.
        write = np.savez_compressed if self.splats else np.savez
        write(content, about=about, **self._arrays())  # type: ignore[arg-type]
        return content.getvalue()

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> FilmPart:
        """Raises InputError for what is no part, or damaged."""
        try:
            with np.load(path, allow_pickle=False) as arrays:
                about = json.loads(arrays["about"].tobytes())
                if about["format"] != FORMAT:
                    raise InputError(f"its format is {about['format']!r:.20}, and this realcam reads {FORMAT}")
                region, splats = about["region"], about["splats"]
                kept = [{**light, "sums": arrays[f"splats{i}"]} for i, light in enumerate(splats)]
                return cls(
                    region=None if region is None else tuple(region),
                    first=about["first"],
                    spp=about["spp"],
                    pixels=_joined(arrays, "pixels", _core._PIXEL_SUM),
                    layers=_joined(arrays, "layers", _core._LAYER_SUM),
                    splats=kept,  # type: ignore[arg-type]
                    stats=about["stats"],
                )
        except FileNotFoundError:
            raise InputError(f"{os.fspath(path)}: there is no such file") from None
        except InputError as error:
            raise InputError(f"{os.fspath(path)}: {error}") from None
        except (OSError, EOFError, KeyError, ValueError, TypeError, zipfile.BadZipFile):
            raise InputError(f"{os.fspath(path)}: this is no part of a film, or damaged") from None

    def _about(self) -> dict[str, Any]:
        return {
            "format": FORMAT,
            "region": None if self.region is None else list(self.region),
            "first": self.first,
            "spp": self.spp,
            "splats": [{k: v for k, v in light.items() if k != "sums"} for light in self.splats],
            "stats": self.stats,
        }

    def _arrays(self) -> dict[str, np.ndarray]:
        """Those of pixels and layers field by field. Squares are all 0 where no variance is wanted."""
        arrays = {f"splats{i}": light["sums"] for i, light in enumerate(self.splats)}
        for name in ("pixels", "layers"):
            sums = getattr(self, name)
            for key in () if sums is None else sums.dtype.names:
                if key != "besides" or sums[key].any():
                    arrays[f"{name}.{key}"] = sums[key]
        return arrays


def _joined(arrays: Any, name: str, dtype: np.dtype[np.void]) -> np.ndarray | None:
    """What _arrays has divided into fields."""
    found = [key for key in arrays.files if key.startswith(f"{name}.")]
    if not found:
        return None
    sums = np.zeros(arrays[found[0]].shape[:2], dtype)
    for key in found:
        sums[key.removeprefix(f"{name}.")] = arrays[key]
    return sums


class CollectedFilm:
    """The sum of parts of one film. Parts of later samples of a pixel are added later: sums depend on their order."""

    def __init__(self, width: int, height: int) -> None:
        self.pixels = np.zeros((height, width), _core._PIXEL_SUM)
        self.layers: np.ndarray | None = None
        self.splats: list[_Splats] = []
        self.stats: dict[str, float] = {}

    def add(self, part: FilmPart) -> None:
        """Raises InputError for a part of another film."""
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
        """(H, W, 3) float32, lux seconds. settings: with which the samples were taken."""
        return _core._developed_exposure(self.pixels, self.splats, settings, exposure_time_s)

    def traced_exposure(self, exposure_time_s: float) -> np.ndarray:
        """What of it was traced from the lights; (0, W, 3) where nothing was."""
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


NO_STATS = dict.fromkeys(
    ("seconds", "lens_seconds", "scene_seconds", "other_seconds", "sampled_rays", "passed_rays", "scene_rays"), 0.0
)
