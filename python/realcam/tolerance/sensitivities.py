"""What single tolerances cost, and what they may be."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._core import InputError, _CopyJudge
from .figures import CopyFigures, Doubles
from .tolerances import MOST, TILTS_MOST_ARCMIN, Tolerance, errors_of


@dataclass(frozen=True)
class Sensitivity:
    """A tolerance alone, at its lower and upper limit; what has a direction, along x and y, at that which costs more.

    mtf: changes of the mean MTF at the middle frequency, lower limit and upper. lowest_mtf: of the worst field's.
    spot_mm: of the largest RMS radius. focal_length_mm: of the focal length.
    """

    tolerance: Tolerance
    mtf: tuple[float, float]
    lowest_mtf: tuple[float, float]
    spot_mm: tuple[float, float]
    focal_length_mm: tuple[float, float]

    @property
    def loss(self) -> float:
        """Of mean MTF at the worse limit."""
        return -min(self.mtf)

    def as_values(self) -> dict[str, Any]:
        t = self.tolerance
        return {"tolerance": t.label, "limit": t.limit, "unit": t.unit, **dataclasses.asdict(self), "loss": self.loss}


def sensitivities(judge: _CopyJudge, items: list[Tolerance], nominal: CopyFigures, frequency: int) -> list[Sensitivity]:
    rows = _rows(items, np.array([item.limit for item in items]))
    figures = CopyFigures.joined([judge.judge(errors_of(items), rows)])
    before = nominal.mean_mtf(frequency)[0]
    # Rows of a tolerance: for each of its errors the lower and the upper limit.
    mtf = figures.mean_mtf(frequency) - before
    others = (
        figures.lowest_mtf(frequency) - nominal.lowest_mtf(frequency)[0],
        figures.rms_spot_mm.max(1) - nominal.rms_spot_mm.max(),
        figures.focal_length_mm - nominal.focal_length_mm[0],
    )
    found, row = [], 0
    for item in items:
        ends = range(row, row + 2 * len(item.errors), 2)
        worse = min(ends, key=lambda k: min(mtf[k], mtf[k + 1]))
        found.append(Sensitivity(item, *((float(of[worse]), float(of[worse + 1])) for of in (mtf, *others))))
        row += 2 * len(item.errors)
    return sorted(found, key=lambda s: -s.loss)


def inverse_sensitivities(
    judge: _CopyJudge, items: list[Tolerance], nominal: CopyFigures, frequency: int, loss: float
) -> list[Tolerance]:
    """In an interval that ends at a limit that costs more, for all tolerances at once."""
    before = float(nominal.mean_mtf(frequency)[0])
    if not 0 < loss < before:
        raise InputError(
            f"loss is {loss!r:.40}; more than 0 and less than the mean MTF as drawn, {before:.3g}, is wanted"
        )

    def losses(limits: Doubles) -> Doubles:
        mtf = CopyFigures.joined([judge.judge(errors_of(items), _rows(items, limits))]).mean_mtf(frequency)
        worst, row = [], 0
        for item in items:
            worst.append(before - mtf[row : row + 2 * len(item.errors)].min())
            row += 2 * len(item.errors)
        return np.array(worst)

    most = np.array([_most(item) for item in items])
    low, high = np.zeros(len(items)), np.minimum([item.limit for item in items], most)
    below, above = np.zeros(len(items)), losses(high)
    for _ in range(12):
        short = (above < loss) & (high < most)
        if not short.any():
            break
        low, below = np.where(short, high, low), np.where(short, above, below)
        high = np.minimum(np.where(short, 4 * high, high), most)
        above = losses(high)
    endless = above < loss
    for step in range(8):
        # Where a straight line reaches the loss, but by turns the middle: one end must not stay for ever.
        share = np.clip((loss - below) / np.maximum(above - below, 1e-300), 0.02, 0.98) if step % 2 else 0.5
        middle = low + share * (high - low)
        found = losses(middle)
        enough = found >= loss
        low, below = np.where(enough, low, middle), np.where(enough, below, found)
        high, above = np.where(enough, middle, high), np.where(enough, found, above)
    limits = np.where(
        endless, math.inf, low + (high - low) * np.clip((loss - below) / np.maximum(above - below, 1e-300), 0, 1)
    )
    return [dataclasses.replace(item, limit=float(limit)) for item, limit in zip(items, limits, strict=True)]


def _most(item: Tolerance) -> float:
    """Beyond this it is another lens."""
    return TILTS_MOST_ARCMIN if item.kind.endswith("arcmin") else MOST.get(item.kind, 1000 * item.limit)


def _rows(items: list[Tolerance], limits: Doubles) -> Doubles:
    """Errors of copies that have one each: its lower and its upper limit."""
    count = sum(len(item.errors) for item in items)
    rows = np.zeros((2 * count, count))
    column = 0
    for item, limit in zip(items, limits, strict=True):
        for _ in item.errors:
            rows[2 * column, column] = -limit * item.scale
            rows[2 * column + 1, column] = limit * item.scale
            column += 1
    return rows
