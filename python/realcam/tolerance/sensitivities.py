"""Sensitivities and inverse sensitivities of single tolerances."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InputError, _ToleranceEvaluator
from .figures import CopyFigures, Doubles
from .tolerances import MOST, TILTS_MOST_ARCMIN, Tolerance, errors_of

CLOSE = 1e-3  # relative to the loss: limits are shown with three digits
STEPS = 20


@dataclass(frozen=True)
class Sensitivity:
    """Effect of one tolerance at its lower and upper limit; a directed one is tried along x and y, and the worse
    counts.

    All values are changes against the nominal lens, at the lower limit and the upper. mtf: mean MTF at the middle
    frequency. lowest_mtf: MTF of the worst field. spot_mm: largest RMS radius. focal_length_mm: focal length.
    """

    tolerance: Tolerance
    mtf: tuple[float, float]
    lowest_mtf: tuple[float, float]
    spot_mm: tuple[float, float]
    focal_length_mm: tuple[float, float]

    @property
    def loss(self) -> float:
        """Loss of mean MTF at the worse limit."""
        return -min(self.mtf)

    def as_values(self) -> dict[str, Any]:
        t = self.tolerance
        return {"tolerance": t.label, "limit": t.limit, "unit": t.unit, **dataclasses.asdict(self), "loss": self.loss}


def sensitivities(
    judge: _ToleranceEvaluator, items: list[Tolerance], nominal: CopyFigures, frequency: int
) -> list[Sensitivity]:
    rows = _rows(items, np.array([item.limit for item in items]))
    figures = CopyFigures.joined([judge.judge(errors_of(items), rows)])
    before = nominal.mean_mtf(frequency)[0]
    # Each error of a tolerance has two rows: its lower limit and its upper limit.
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
    judge: _ToleranceEvaluator, items: list[Tolerance], nominal: CopyFigures, frequency: int, loss: float
) -> list[Tolerance]:
    """Returns the tolerances with the limits at which each alone costs `loss` of the mean MTF; inf if it never does.

    Solves for all tolerances that have not converged at once, by the Illinois method (Dowell and Jarratt 1971).
    """
    before = float(nominal.mean_mtf(frequency)[0])
    if not 0 < loss < before:
        raise InputError(
            f"loss is {loss!r:.40}; expected more than 0 and less than the mean MTF as drawn, {before:.3g}"
        )

    def excess(which: NDArray[np.intp], limits: Doubles) -> Doubles:
        """Loss of mean MTF of each of these tolerances at its limit, minus the target loss."""
        some = [items[k] for k in which]
        mtf = CopyFigures.joined([judge.judge(errors_of(some), _rows(some, limits))]).mean_mtf(frequency)
        worst, row = [], 0
        for item in some:
            worst.append(before - mtf[row : row + 2 * len(item.errors)].min() - loss)
            row += 2 * len(item.errors)
        return np.array(worst)

    most = np.array([_most(item) for item in items])
    low, high = np.zeros(len(items)), np.minimum([item.limit for item in items], most)
    below, above = np.full(len(items), -loss), np.zeros(len(items))
    which = np.arange(len(items))
    for _ in range(13):
        above[which] = excess(which, high[which])
        which = which[(above[which] < 0) & (high[which] < most[which])]
        if not len(which):
            break
        low[which], below[which] = high[which], above[which]
        high[which] = np.minimum(4 * high[which], most[which])
    limits = np.where(above < 0, math.inf, high)
    which = np.flatnonzero(above > CLOSE * loss)
    last = np.zeros(len(items))
    for _ in range(STEPS):
        if not len(which):
            break
        share = below[which] / (below[which] - above[which])
        limits[which] = low[which] + share * (high[which] - low[which])
        found = excess(which, limits[which])
        side = np.where(found < 0, -1, 1)
        # Illinois rule: halves the value at an end that is retained twice, so that it does not remain for ever.
        stays = side == last[which]
        last[which] = side
        for of, there, other, end in ((side < 0, below, above, low), (side > 0, above, below, high)):
            moved = which[of]
            there[moved], end[moved] = found[of], limits[moved]
            other[which[of & stays]] /= 2
        which = which[np.abs(found) > CLOSE * loss]
    return [dataclasses.replace(item, limit=float(limit)) for item, limit in zip(items, limits, strict=True)]


def _most(item: Tolerance) -> float:
    """Largest limit that is tried; beyond it the lens would be a different one."""
    return TILTS_MOST_ARCMIN if item.kind.endswith("arcmin") else MOST.get(item.kind, 1000 * item.limit)


def _rows(items: list[Tolerance], limits: Doubles) -> Doubles:
    """Errors of copies with a single error each: for every error one copy at the lower limit and one at the upper."""
    count = sum(len(item.errors) for item in items)
    rows = np.zeros((2 * count, count))
    column = 0
    for item, limit in zip(items, limits, strict=True):
        for _ in item.errors:
            rows[2 * column, column] = -limit * item.scale
            rows[2 * column + 1, column] = limit * item.scale
            column += 1
    return rows
