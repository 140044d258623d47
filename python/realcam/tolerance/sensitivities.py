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
from .tolerances import MAX_LIMITS, MAX_TILT_ARCMIN, Tolerance, errors_of

TOLERANCE = 1e-3  # of the loss, relative; limits are shown with three digits
MAX_STEPS = 20  # of the root search


@dataclass(frozen=True)
class Sensitivity:
    """Effect of one tolerance at its lower and upper limit.

    A directed tolerance is evaluated along x and y, and the direction with the larger loss counts. All values are
    pairs: changes against the nominal lens at the lower and at the upper limit. mtf: mean MTF at the middle
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
        """The fields as plain values, for JSON."""
        t = self.tolerance
        return {"tolerance": t.label, "limit": t.limit, "unit": t.unit, **dataclasses.asdict(self), "loss": self.loss}


def sensitivities(
    evaluator: _ToleranceEvaluator, items: list[Tolerance], nominal: CopyFigures, frequency: int
) -> list[Sensitivity]:
    """Sensitivities in descending order of loss. nominal: figures of the nominal lens. frequency: index."""
    rows = _rows(items, np.array([item.limit for item in items]))
    figures = CopyFigures.joined([evaluator.judge(errors_of(items), rows)])
    nominal_mtf = nominal.mean_mtf(frequency)[0]
    # Each error of a tolerance has two rows: its lower limit and its upper limit.
    mtf = figures.mean_mtf(frequency) - nominal_mtf
    others = (
        figures.lowest_mtf(frequency) - nominal.lowest_mtf(frequency)[0],
        figures.rms_spot_mm.max(1) - nominal.rms_spot_mm.max(),
        figures.focal_length_mm - nominal.focal_length_mm[0],
    )
    result, row = [], 0
    for item in items:
        ends = range(row, row + 2 * len(item.errors), 2)
        worse = min(ends, key=lambda k: min(mtf[k], mtf[k + 1]))
        changes = ((float(change[worse]), float(change[worse + 1])) for change in (mtf, *others))
        result.append(Sensitivity(item, *changes))
        row += 2 * len(item.errors)
    return sorted(result, key=lambda s: -s.loss)


def inverse_sensitivities(
    evaluator: _ToleranceEvaluator, items: list[Tolerance], nominal: CopyFigures, frequency: int, loss: float
) -> list[Tolerance]:
    """Returns the tolerances with the limits at which each alone costs `loss` of the mean MTF; inf if it never does.

    The limits of all tolerances are found simultaneously by the Illinois method (Dowell and Jarratt 1971). Raises
    InputError if the loss is not between 0 and the nominal MTF.
    """
    nominal_mtf = float(nominal.mean_mtf(frequency)[0])
    if not 0 < loss < nominal_mtf:
        raise InputError(
            f"loss is {loss!r:.40}; expected more than 0 and less than the nominal mean MTF, {nominal_mtf:.3g}"
        )

    def excess(which: NDArray[np.intp], limits: Doubles) -> Doubles:
        """Loss of mean MTF of each of these tolerances at its worse limit, minus the target loss."""
        chosen = [items[k] for k in which]
        mtf = CopyFigures.joined([evaluator.judge(errors_of(chosen), _rows(chosen, limits))]).mean_mtf(frequency)
        worst, row = [], 0
        for item in chosen:
            worst.append(nominal_mtf - mtf[row : row + 2 * len(item.errors)].min() - loss)
            row += 2 * len(item.errors)
        return np.array(worst)

    largest = np.array([_largest_limit(item) for item in items])
    # Brackets of the limits, and the excess at their ends.
    low, high = np.zeros(len(items)), np.minimum([item.limit for item in items], largest)
    below, above = np.full(len(items), -loss), np.zeros(len(items))
    which = np.arange(len(items))  # indices of the tolerances whose upper bound is still too small
    for _ in range(13):
        above[which] = excess(which, high[which])
        which = which[(above[which] < 0) & (high[which] < largest[which])]
        if not len(which):
            break
        low[which], below[which] = high[which], above[which]
        high[which] = np.minimum(4 * high[which], largest[which])
    limits = np.where(above < 0, math.inf, high)
    which = np.flatnonzero(above > TOLERANCE * loss)  # indices of those that have not converged
    last = np.zeros(len(items))
    for _ in range(MAX_STEPS):
        if not len(which):
            break
        fraction = below[which] / (below[which] - above[which])
        limits[which] = low[which] + fraction * (high[which] - low[which])
        excesses = excess(which, limits[which])
        side = np.where(excesses < 0, -1, 1)
        # Illinois rule: halves the value at an end that is retained twice, so that it does not remain for ever.
        stays = side == last[which]
        last[which] = side
        for is_side, value, other_value, end in ((side < 0, below, above, low), (side > 0, above, below, high)):
            moved = which[is_side]
            value[moved], end[moved] = excesses[is_side], limits[moved]
            other_value[which[is_side & stays]] /= 2
        which = which[np.abs(excesses) > TOLERANCE * loss]
    return [dataclasses.replace(item, limit=float(limit)) for item, limit in zip(items, limits, strict=True)]


def _largest_limit(item: Tolerance) -> float:
    """Largest limit that is tried; beyond it the lens would be a different one."""
    return MAX_TILT_ARCMIN if item.kind.endswith("arcmin") else MAX_LIMITS.get(item.kind, 1000 * item.limit)


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
