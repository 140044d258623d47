"""What a job consists of: shots, and units of their samples."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import _SAMPLES_PER_SUM, _SHARING_TILE_SIDE, InputError

if TYPE_CHECKING:
    from .._core import _Region

# Samples of a unit, about: a second of one core.
_SAMPLES_PER_UNIT = 1 << 22
# Films of light that is traced apart are as large as the picture.
_MOST_SPLATS_PER_SUM = 8


@dataclass(frozen=True)
class Unit:
    """Samples that are exposed, and written, as a whole or not at all.

    shot, round: their numbers in the job, and in the shot. kind: "pixels", "layers" or "light", which is traced apart.
    """

    shot: int
    round: int
    kind: str
    region: _Region | None
    first: int
    spp: int

    def __str__(self) -> str:
        return self.name

    @property
    def name(self) -> str:
        return f"{self.shot:05d}/{self.file_name}"

    @property
    def file_name(self) -> str:
        where = "" if self.region is None else f"-{self.region[0]:05d}-{self.region[1]:05d}"
        return f"{self.round:03d}-{self.kind}-{self.first:08d}{where}.npz"


@dataclass(frozen=True)
class Round:
    """Samples of which the number is known before they are taken: all of a shot, or as many as its noise called for.

    samples: taken before. spp: the most that a pixel takes. counts: (H, W), how many each takes; None: all.
    traces_lights: whether as much light is traced from the lights as belongs to spp samples. taken, left: samples of
    all pixels before it, and from there on as far as is known.
    """

    number: int
    samples: int
    spp: int
    counts: np.ndarray | None = None
    is_of_layers: bool = False  # after the last samples of a shot whose number of samples follows its noise
    traces_lights: bool = True
    taken: float = 0
    left: float = 0


@dataclass(frozen=True)
class ShotRecord:
    """What a job's file says of a shot. spp: None where its noise decides. tile: width and height of units, pixels."""

    name: str
    file: str
    digest: str
    scene: str
    resolution: tuple[int, int]
    tile: tuple[int, int]
    spp: int | None
    has_layers: bool
    has_traced_light: bool

    @classmethod
    def read(cls, entry: Any) -> ShotRecord:
        """Raises TypeError, KeyError or ValueError for what is no record."""
        width, height = entry.pop("resolution")
        across, down = entry.pop("tile")
        numbers = (width, height, across, down)
        if not all(isinstance(number, int) and 1 <= number <= 1 << 20 for number in numbers):
            raise ValueError
        return cls(**entry, resolution=(width, height), tile=(across, down))

    def units(self, shot: int, round_: Round) -> Iterator[Unit]:
        """Those of a round, in the order in which their sums are added."""
        for first in range(round_.samples, round_.samples + round_.spp, _SAMPLES_PER_SUM):
            spp = min(_SAMPLES_PER_SUM, round_.samples + round_.spp - first)
            kind = "layers" if round_.is_of_layers else "pixels"
            if self.has_traced_light and round_.traces_lights and not round_.is_of_layers:
                for begin, end in self._pieces(first, spp):
                    yield Unit(shot, round_.number, "light", None, begin, end - begin)
            for region in self._tiles():
                if wants_any(round_, region, first):
                    yield Unit(shot, round_.number, kind, region, first, spp)

    def _tiles(self) -> Iterator[_Region]:
        width, height = self.resolution
        across, down = self.tile
        for row in range(0, height, down):
            for column in range(0, width, across):
                yield (column, row, min(across, width - column), min(down, height - row))

    def _pieces(self, first: int, spp: int) -> Iterator[tuple[int, int]]:
        """Ranges of samples for light that is traced apart. As its sums are whole numbers, any would do."""
        width, height = self.resolution
        count = min(_MOST_SPLATS_PER_SUM, spp, max(1, width * height * spp // (4 * _SAMPLES_PER_UNIT)))
        ends = [first + spp * i // count for i in range(count + 1)]
        yield from pairwise(ends)


def counts_of(round_: Round, region: _Region, first: int) -> np.ndarray | None:
    """(height, width) uint32: how many of the samples from number `first` on the pixels of a region take."""
    if round_.counts is None:
        return None
    column, row, width, height = region
    wanted = round_.counts[row : row + height, column : column + width].astype(np.int64)
    return np.clip(wanted - (first - round_.samples), 0, _SAMPLES_PER_SUM).astype(np.uint32)


def wants_any(round_: Round, region: _Region, first: int) -> bool:
    counts = counts_of(round_, region, first)
    return counts is None or bool(counts.any())


def tile_for(resolution: tuple[int, int], spp: int | None, is_cpu: bool) -> tuple[int, int]:
    """Width and height of the units of a picture: about a second of one core, or whole rows for a GPU."""
    samples = min(spp or _SAMPLES_PER_SUM, _SAMPLES_PER_SUM)
    width, height = resolution
    if not is_cpu:
        return width, min(height, _whole_tiles(16 * _SAMPLES_PER_UNIT // (samples * width)))
    side = min(512, max(64, _whole_tiles(int((_SAMPLES_PER_UNIT / samples) ** 0.5))))
    return min(width, side), min(height, side)


def checked_tile(tile: tuple[int, int]) -> tuple[int, int]:
    """In whole tiles. Raises InputError for what is no size of units."""
    width, height = tile
    if not (1 <= width <= 1 << 20 and 1 <= height <= 1 << 20):
        raise InputError("a tile must have 1 to 1048576 pixels along each side")
    return _whole_tiles(width), _whole_tiles(height)


def _whole_tiles(pixels: int) -> int:
    """As many, or some more: pixels of a tile share samples, and would miss those of another unit."""
    return max(1, -(-pixels // _SHARING_TILE_SIDE)) * _SHARING_TILE_SIDE
