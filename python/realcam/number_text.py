"""Number formatting for the output of commands."""

from __future__ import annotations

import math

from . import _core


def number_text(value: float, digits: int = 4, infinite: str = "infinity") -> str:
    """Formats a number with significant digits, but never fewer than its integer part: "0.00001", "50.36", "12 346".
    Exponents are used only below a millionth and from 1e15 on."""
    if math.isinf(value):
        return infinite if value > 0 else f"-{infinite}"
    return _core._number_text(value, digits)


def percent_text(share: float, digits: int = 2, *, signed: bool = False) -> str:
    """Formats a fraction as "14%", "140%", or signed "+140%"."""
    plus = "+" if signed and share >= 0 else ""
    return f"{plus}{number_text(100 * share, digits)}%"


def counted(count: int, noun: str) -> str:
    """Formats a count with its noun: "1 sample", "10 000 samples"."""
    return f"{number_text(count)} {noun}{'' if count == 1 else 's'}"


def optics_text(lens: _core.Lens) -> str:
    """Returns the focal length and the f-number of a lens: "f = 50.36 mm, f/2"; of an afocal one only the first."""
    focal_length = f"f = {number_text(lens.first_order().effective_focal_length_mm)} mm"
    return f"{focal_length}, f/{number_text(lens.f_number, 3)}" if math.isfinite(lens.f_number) else focal_length


def duration_text(seconds: float) -> str:
    """Formats a duration in the largest unit that gives at least two: 95 seconds, 36 minutes."""
    for size, name in ((86400.0, "day"), (3600.0, "hour"), (60.0, "minute")):
        if seconds >= 2 * size:
            return counted(round(seconds / size), name)
    return counted(round(seconds), "second")
