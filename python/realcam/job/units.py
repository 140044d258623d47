"""Division of a job's pictures into rounds of samples, and of rounds into units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .._core import _SAMPLES_PER_SUM, _SHARING_TILE_SIDE, InputError

if TYPE_CHECKING:
    from .._core import _Region

Digest = str  # SHA-256 in hexadecimal
Size = tuple[int, int]  # width, height

MAX_UNITS = 1 << 20  # per shot
MAX_SIDE = 1 << 15  # of a film or tile, in pixels
_SAMPLES_PER_UNIT = 1 << 22  # takes one core about a second
_MAX_LIGHT_UNITS = 8  # each unit of light tracing writes a film as large as the picture


@dataclass(frozen=True)
class Unit:
    """Samples that are rendered and written together.

    shot, round: index of the shot in the job, of the round in the shot. kind: "pixels", "layers", or "light" (light
    tracing). region: column, row, width, height; None: the whole film. first: index of the first sample.
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
        """Name of the unit's file within the folder of its shot."""
        at = "" if self.region is None else f"-{self.region[0]:05d}-{self.region[1]:05d}"
        return f"{self.round:03d}-{self.kind}-{self.first:08d}{at}.npz"


@dataclass(frozen=True)
class Round:
    """Samples whose number is fixed in advance: all of a shot, or one pass of adaptive sampling.

    number: index of the round. samples: number per pixel in earlier rounds. spp: largest number of samples of a pixel.
    counts: (H, W) uint32, samples of each pixel; None: spp. traces_lights: True if the round includes spp samples of
    light tracing. taken, left: samples of all pixels taken so far, and estimate of those still needed.
    """

    number: int
    samples: int
    spp: int
    counts: np.ndarray | None = None
    is_of_layers: bool = False  # the layers' round, which follows the last adaptive round of a shot
    traces_lights: bool = True
    taken: float = 0
    left: float = 0

    def counts_of(self, unit: Unit) -> np.ndarray | None:
        """(height, width) uint32: number of the unit's samples that each of its pixels takes; None: all of them."""
        if self.counts is None or unit.region is None:
            return None
        column, row, width, height = unit.region
        counts = self.counts[row : row + height, column : column + width].astype(np.int64)
        return np.clip(counts - (unit.first - self.samples), 0, _SAMPLES_PER_SUM).astype(np.uint32)


@dataclass(frozen=True)
class ShotRecord:
    """A shot's entry in job.json.

    digest, scene: SHA-256 of the shot's file and of its scene's file. tile: width and height of a unit in pixels,
    multiples of 32. spp: None if a noise goal decides.
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
        """Yields the units of a round, in the order in which their sums are added."""
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
        if count > MAX_UNITS:
            raise InputError(f'shot "{self.name:.40}" has {count} units; expected at most {MAX_UNITS}')

    def _tiles(self) -> Iterator[_Region]:
        """Yields the regions of the tiles, row by row."""
        (width, height), (across, down) = self.resolution, self.tile
        for row in range(0, height, down):
            for column in range(0, width, across):
                yield (column, row, min(across, width - column), min(down, height - row))

    def _ranges_of_light(self, first: int, spp: int) -> Iterator[tuple[int, int]]:
        """Yields ranges of samples for light tracing. Its sums are integers, so that any division gives the same
        result."""
        width, height = self.resolution
        count = min(_MAX_LIGHT_UNITS, spp, max(1, width * height * spp // (4 * _SAMPLES_PER_UNIT)))
        yield from pairwise(first + spp * i // count for i in range(count + 1))


def tile_for(resolution: tuple[int, int], spp: int | None, is_cpu: bool) -> tuple[int, int]:
    """Default width and height of a unit in pixels: about a second of work for one core, or complete rows for a GPU."""
    samples = min(spp or _SAMPLES_PER_SUM, _SAMPLES_PER_SUM)
    width, height = resolution
    if not is_cpu:
        return checked_tile((width, min(height, max(1, 16 * _SAMPLES_PER_UNIT // (samples * width)))))
    side = min(512, max(64, int((_SAMPLES_PER_UNIT / samples) ** 0.5)))
    return checked_tile((min(width, side), min(height, side)))


def checked_tile(tile: tuple[int, int]) -> tuple[int, int]:
    """Rounds a unit's size up to whole tiles in which pixels share samples. Raises InputError if it is out of range."""
    if not all(1 <= side <= MAX_SIDE for side in tile):
        raise InputError(f"a tile must have 1 to {MAX_SIDE} pixels along each side")
    width, height = (-(-side // _SHARING_TILE_SIDE) * _SHARING_TILE_SIDE for side in tile)
    return width, height
