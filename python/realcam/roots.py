"""One-dimensional root finding."""

from __future__ import annotations

import math
from collections.abc import Callable


def root_between(
    function: Callable[[float], float], low: float, high: float, at_low: float, at_high: float, tolerance: float
) -> float:
    """Returns a root between two arguments whose values have opposite signs, to `tolerance` in the argument.

    at_low, at_high: values of the function at low and high. Method: regula falsi in the Illinois form (M. Dowell and
    P. Jarratt, BIT 11, 168, 1971): the value of an end that is retained twice is halved, so that the bracket shrinks
    from both sides. `at_high`, and values on that side, may be nan outside the function's domain: then the bracket is
    bisected, and the result may be the end of the domain. The function is defined at the returned argument.
    """
    retained_end = 0  # in the last step: 1 for low, -1 for high
    for _ in range(200):
        if abs(high - low) <= tolerance or at_low == 0:
            return low
        fraction = 0.5 if math.isnan(at_high) else at_low / (at_low - at_high)
        x = low + fraction * (high - low)
        if x in (low, high):  # an end is the root to machine precision
            return high if abs(at_high) < abs(at_low) else low
        value = function(x)
        if value == 0:
            return x
        if (value > 0) == (at_low > 0) and not math.isnan(value):
            low, at_low = x, value
            at_high *= 0.5 if retained_end == -1 else 1
            retained_end = -1
        else:
            high, at_high = x, value
            at_low *= 0.5 if retained_end == 1 else 1
            retained_end = 1
    return low
