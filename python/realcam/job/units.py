"""How a job divides its pictures: rounds of samples, and units of a round."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .._core import _SAMPLES_PER_SUM, _SHARING_TILE_SIDE, InputError

if TYPE_CHECKING:
    from .._core import _Region

Digest = str
Size = tuple[int, int]

MOST_UNITS = 1 << 20  # of a shot
LONGEST_SIDE = 1 << 15  # of a film, pixels
_SAMPLES_PER_UNIT = 1 << 22  # takes one core about a second
_MOST_SPLATS_PER_SUM = 8  # a film of light that is traced from lamps is as large as the picture


@dataclass(frozen=True)
class Unit:
    """Samples that are exposed and written together.

    shot, round: indices in the job, and in the shot. kind: "pixels", "layers", or "light" that is traced from lamps.
    """

    shot: int
    round: int
    kind: str
    region: _Region | None
    first: int
    spp: int

    def __str__(self) -> str:
        return f"{self.shot:05d}/{self.file_name}"

    @property
    def file_name(self) -> str:
        at = "" if self.region is None else f"-{self.region[0]:05d}-{self.region[1]:05d}"
        return f"{self.round:03d}-{self.kind}-{self.first:08d}{at}.npz"


@dataclass(frozen=True)
class Round:
    """Samples whose number is known before they are taken: all of a shot, or those that its noise called for.

    samples: taken before. spp: the most that a pixel takes. counts: (H, W) uint32, samples of each pixel; None: spp.
    traces_lights: whether light is traced from the lamps for spp samples. taken, left: estimates for all pixels.
    """

    number: int
    samples: int
    spp: int
    counts: np.ndarray | None = None
    is_of_layers: bool = False  # follows the last samples of a shot whose number of samples follows its noise
    traces_lights: bool = True
    taken: float = 0
    left: float = 0

    def counts_of(self, unit: Unit) -> np.ndarray | None:
        """(height, width) uint32: how many of the unit's samples each of its pixels takes; None: all of them."""
        if self.counts is None or unit.region is None:
            return None
        column, row, width, height = unit.region
        counts = self.counts[row : row + height, column : column + width].astype(np.int64)
        return np.clip(counts - (unit.first - self.samples), 0, _SAMPLES_PER_SUM).astype(np.uint32)


@dataclass(frozen=True)
class ShotRecord:
    """A shot's entry in job.json.

    digest, scene: SHA-256 of its file and of its scene's. tile: width and height of a unit in pixels, multiples of 32.
    spp: None if the noise decides.
    """

    name: str
    digest: Digest
    scene: Digest
    resolution: Size
    tile: Size
    spp: int | None
    has_layers: bool
    has_traced_light: bool

    def units(self, shot: int, round_: Round) -> Iterator[Unit]:
        """The units of a round, in the order in which their sums are added."""
        kind = "layers" if round_.is_of_layers else "pixels"
        for first in range(round_.samples, round_.samples + round_.spp, _SAMPLES_PER_SUM):
            spp = min(_SAMPLES_PER_SUM, round_.samples + round_.spp - first)
            if self.has_traced_light and round_.traces_lights and not round_.is_of_layers:
                for begin, end in self._ranges_of_light(first, spp):
                    yield Unit(shot, round_.number, "light", None, begin, end - begin)
            for region in self._tiles():
                unit = Unit(shot, round_.number, kind, region, first, spp)
                counts = round_.counts_of(unit)
                if counts is None or counts.any():
                    yield unit

    def check_count(self) -> None:
        """Raises InputError if the shot has more units than a folder of files can hold."""
        (width, height), (across, down) = self.resolution, self.tile
        count = -(-width // across) * -(-height // down) * -(-(self.spp or 1) // _SAMPLES_PER_SUM)
        if count > MOST_UNITS:
            raise InputError(f'shot "{self.name:.40}" has {count} units; at most {MOST_UNITS} are expected')

    def _tiles(self) -> Iterator[_Region]:
        (width, height), (across, down) = self.resolution, self.tile
        for row in range(0, height, down):
            for column in range(0, width, across):
                yield (column, row, min(across, width - column), min(down, height - row))

    def _ranges_of_light(self, first: int, spp: int) -> Iterator[tuple[int, int]]:
        """Ranges of samples for light that is traced from lamps. Its sums are integers, so any division is exact."""
        width, height = self.resolution
        count = min(_MOST_SPLATS_PER_SUM, spp, max(1, width * height * spp // (4 * _SAMPLES_PER_UNIT)))
        yield from pairwise(first + spp * i // count for i in range(count + 1))


def tile_for(resolution: tuple[int, int], spp: int | None, is_cpu: bool) -> tuple[int, int]:
    """The default size of a unit: about a second of one core, or complete rows for a GPU."""
    samples = min(spp or _SAMPLES_PER_SUM, _SAMPLES_PER_SUM)
    width, height = resolution
    if not is_cpu:
        return checked_tile((width, min(height, max(1, 16 * _SAMPLES_PER_UNIT // (samples * width)))))
    side = min(512, max(64, int((_SAMPLES_PER_UNIT / samples) ** 0.5)))
    return checked_tile((min(width, side), min(height, side)))


def checked_tile(tile: tuple[int, int]) -> tuple[int, int]:
    """A size of units, rounded up to the tiles in which pixels share samples. Raises InputError."""
    if not all(1 <= side <= LONGEST_SIDE for side in tile):
        raise InputError(f"a tile must have 1 to {LONGEST_SIDE} pixels along each side")
    width, height = (-(-side // _SHARING_TILE_SIDE) * _SHARING_TILE_SIDE for side in tile)
    return width, height
