"""Scales of a camera's rings and dials: steps of a third of a stop, except for the zoom ring.

Engraved numbers are nominal. A ring sets the exact power of two: f/5.6 is f/5.657, 1/60 s is 1/64 s.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .._core import Lens

_ZOOM_STEPS = 300  # steps of the zoom ring over its range

# Engravings as text, because numbers would be shown as 1.0 or 0.0167.
_APERTURES = (
    *("1", "1.1", "1.2", "1.4", "1.6", "1.8", "2", "2.2", "2.5", "2.8", "3.2", "3.5"),
    *("4", "4.5", "5", "5.6", "6.3", "7.1", "8", "9", "10", "11", "13", "14"),
    *("16", "18", "20", "22", "25", "29", "32", "36", "40", "45", "51", "57", "64"),
)
_SHUTTER = (
    *("1/8000", "1/6400", "1/5000", "1/4000", "1/3200", "1/2500", "1/2000", "1/1600", "1/1250", "1/1000", "1/800"),
    *("1/640", "1/500", "1/400", "1/320", "1/250", "1/200", "1/160", "1/125", "1/100", "1/80", "1/60", "1/50", "1/40"),
    *("1/30", "1/25", "1/20", "1/15", "1/13", "1/10", "1/8", "1/6", "1/5", "1/4", "0.3", "0.4", "0.5", "0.6", "0.8"),
    *("1", "1.3", "1.6", "2", "2.5", "3.2", "4", "5", "6", "8", "10", "13", "15", "20", "25", "30"),
)
_ISO = (
    *("50", "64", "80", "100", "125", "160", "200", "250", "320", "400", "500", "640", "800", "1000", "1250", "1600"),
    *("2000", "2500", "3200", "4000", "5000", "6400", "8000", "10000", "12800", "16000", "20000", "25600"),
)


@dataclass(frozen=True)
class Ring:
    """A scale of steps. values: exact value of each step. engraved: its label."""

    values: tuple[float, ...]
    engraved: tuple[str, ...]

    def step_of(self, value: float) -> int:
        """Nearest step, by ratio."""
        return min(range(len(self.values)), key=lambda step: abs(math.log(self.values[step] / value)))

    def turned(self, value: float, steps: int) -> float:
        """Value `steps` after the step nearest to `value`, clamped to the scale."""
        step = min(max(self.step_of(value) + steps, 0), len(self.values) - 1)
        return self.values[step]

    def text_of(self, value: float) -> str:
        """Label of a value: the engraving if it lies on a step, otherwise three digits."""
        step = self.step_of(value)
        return self.engraved[step] if abs(math.log2(self.values[step] / value)) < 0.02 else f"{value:.3g}"


def _ring(engraved: Sequence[str], first: float, per_doubling: int) -> Ring:
    """Scale of geometric steps. first: value of the first one. per_doubling: number of steps to twice the value."""
    return Ring(tuple(first * 2 ** (k / per_doubling) for k in range(len(engraved))), tuple(engraved))


_ALL_APERTURES = _ring(_APERTURES, 1.0, 6)
SHUTTER_S = _ring(_SHUTTER, 2.0**-13, 3)
ISO = _ring(_ISO, 50.0, 3)


def aperture_ring(widest: float) -> Ring:
    """f-numbers from `widest`, the lens's smallest, which usually lies between two steps, to f/64.

    An infinite one, of an afocal lens, gives a ring of one step.
    """
    if not math.isfinite(widest):
        return Ring((1.0,), ("-",))
    steps = [step for step, value in enumerate(_ALL_APERTURES.values) if value > widest * 1.02]
    return Ring(
        (widest, *(_ALL_APERTURES.values[step] for step in steps)),
        (f"{widest:.3g}", *(_ALL_APERTURES.engraved[step] for step in steps)),
    )


def zoom_ring(lens: Lens) -> Ring | None:
    """Geometrically spaced focal lengths over the zoom range, with exact values at the lens's positions.

    None: the lens has no continuous zoom (see Lens.zoomed).
    """
    focal_lengths = lens.zoom_focal_lengths_mm
    if len(focal_lengths) < 2 or focal_lengths not in (sorted(focal_lengths), sorted(focal_lengths, reverse=True)):
        return None
    if not 0 < min(focal_lengths) < max(focal_lengths):
        return None
    ratio = (max(focal_lengths) / min(focal_lengths)) ** (1 / _ZOOM_STEPS)
    values = [min(focal_lengths) * ratio**step for step in range(_ZOOM_STEPS + 1)]
    for focal_length_mm in focal_lengths:
        values[round(math.log(focal_length_mm / min(focal_lengths), ratio))] = focal_length_mm
    return Ring(tuple(values), tuple(f"{value:.4g}" for value in values))
