"""Where a function of one number changes its sign."""

from __future__ import annotations

import math
from collections.abc import Callable


def root_between(
    function: Callable[[float], float], low: float, high: float, at_low: float, at_high: float, tolerance: float
) -> float:
    """A root between two places whose values have opposite signs, to `tolerance` in the argument.

    Regula falsi in the Illinois form (M. Dowell and P. Jarratt, BIT 11, 168, 1971): the value of an end that stays
    twice is halved, so that the bracket shrinks from both sides. `at_high` may be nan, and so may values on that side,
    where the function has none: then the bracket is halved, and what is found may be the place where it ends. What is
    returned is a place at which the function has a value.
    """
    stayed = 0  # 1: low has stayed, -1: high
    for _ in range(200):
        if abs(high - low) <= tolerance or at_low == 0:
            return low
        share = 0.5 if math.isnan(at_high) else at_low / (at_low - at_high)
        middle = low + share * (high - low)
        if middle in (low, high):  # the root is an end, to the last digit
            return high if abs(at_high) < abs(at_low) else low
        value = function(middle)
        if value == 0:
            return middle
        if (value > 0) == (at_low > 0) and not math.isnan(value):
            low, at_low = middle, value
            at_high *= 0.5 if stayed == -1 else 1
            stayed = -1
        else:
            high, at_high = middle, value
            at_low *= 0.5 if stayed == 1 else 1
            stayed = 1
    return low
