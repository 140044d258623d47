"""Radial functions r(s) = s top(s) / bottom(s): the common form of all polynomial and rational camera models.

s is the tangent of the angle to the axis, or the angle, or another distance from the axis. Sources: OpenCV's
documentation of calib3d ("Camera Calibration and 3D Reconstruction") and of its fisheye namespace; J. Kannala and
S. Brandt, IEEE PAMI 28 (2006) 1335.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.polynomial import polyval

from ..arrays import Array


@dataclass(frozen=True)
class RationalRadius:
    """r(s) = s top(s) / bottom(s). top, bottom: coefficients of ascending powers of s, the constant one first."""

    top: tuple[float, ...] = (1.0,)
    bottom: tuple[float, ...] = (1.0,)

    def factor(self, s: Array) -> Array:
        """Returns r(s) / s."""
        values: Array = polyval(s, self.top)
        if len(self.bottom) > 1:
            values = values / polyval(s, self.bottom)
        return values

    def factor_slope(self, s: Array) -> Array:
        """Returns the derivative of r(s) / s."""
        slope: Array = polyval(s, self._top_slope)
        if len(self.bottom) > 1:
            below = polyval(s, self.bottom)
            slope = (slope * below - polyval(s, self.top) * polyval(s, self._bottom_slope)) / below**2
        return slope

    def value(self, s: Array) -> Array:
        """Returns r(s)."""
        return s * self.factor(s)

    def slope(self, s: Array) -> Array:
        """Returns the derivative of r(s)."""
        slope: Array = self.factor(s) + s * self.factor_slope(s)
        return slope

    @cached_property
    def is_identity(self) -> bool:
        """True if r(s) = s."""
        return self.top[0] == self.bottom[0] and not any(self.top[1:]) and not any(self.bottom[1:])

    @cached_property
    def first_fold(self) -> float:
        """The smallest positive s at which r stops growing or has a pole; inf if there is none."""
        s, top, bottom = Polynomial([0.0, 1.0]), Polynomial(self.top), Polynomial(self.bottom)
        slope = (s * top).deriv() * bottom - s * top * bottom.deriv()
        # Rounding may move a double root slightly off the real axis.
        return min(
            (
                float(root.real)
                for root in [*slope.roots(), *bottom.roots()]
                if root.real > 0 and abs(root.imag) < 1e-9 * abs(root)
            ),
            default=np.inf,
        )

    @cached_property
    def _top_slope(self) -> Array:
        coefficients: Array = Polynomial(self.top).deriv().coef
        return coefficients

    @cached_property
    def _bottom_slope(self) -> Array:
        coefficients: Array = Polynomial(self.bottom).deriv().coef
        return coefficients


def even_powers(coefficients: Sequence[float]) -> tuple[float, ...]:
    """Returns the coefficients of 1 + k1 s^2 + k2 s^4 + ... in ascending powers of s."""
    powers = [1.0]
    for k in coefficients:
        powers += [0.0, float(k)]
    return tuple(powers)


SAMPLES = 512  # samples between the axis and the limit of a function


def spread(upper: float, count: int = SAMPLES) -> Array:
    """Returns `count` increasing values between 0 and `upper`, which may be inf; both ends are excluded."""
    t = (np.arange(count) + 0.5) / count
    return t * upper if np.isfinite(upper) else np.tan(t * (np.pi / 2))


def monotone_inverse(
    function: Callable[[Array], Array], slope: Callable[[Array], Array], values: Array, upper: float
) -> Array:
    """Returns s in [0, upper) with function(s) = values, for a function that grows from 0 on; NaN if there is none.

    Newton's method inside a bracket, which is halved where a step would leave it.
    """
    with np.errstate(all="ignore"):
        if not np.isfinite(upper):
            upper = _bound(function, values)
        knots = np.concatenate([[0.0], spread(upper)])
        cell = np.clip(np.searchsorted(function(knots), values, side="right") - 1, 0, len(knots) - 1)
        low, high = knots[cell], np.append(knots[1:], upper)[cell]
        s = 0.5 * (low + high)
        # Values beyond the end of the function would be halved towards it to the last bit.
        end = float(function(np.array(upper)))
        is_beyond = values > end * (1 + 1e-9) + 1e-9 if end > float(function(knots[-1])) else values > np.inf
        (active,) = np.nonzero(np.isfinite(values) & (values >= 0) & ~is_beyond)
        for _ in range(200):
            if not len(active):
                break
            at = s[active]
            error = function(at) - values[active]
            below = np.where(error <= 0, at, low[active])
            above = np.where(error > 0, at, high[active])
            step = at - error / slope(at)
            following = np.where((step >= below) & (step <= above), step, 0.5 * (below + above))
            low[active], high[active], s[active] = below, above, following
            active = active[~(np.abs(following - at) <= 1e-15 * np.abs(at))]
        is_reached = np.abs(function(s) - values) <= 1e-12 * (1 + np.abs(values))
        return np.where(is_reached & (values >= 0), s, np.nan)


def _bound(function: Callable[[Array], Array], values: Array) -> float:
    """Returns an s at which the function exceeds all finite values, if there is one below 2^60."""
    largest = np.max(values, where=np.isfinite(values), initial=0.0)
    s = 2.0 ** np.arange(61)
    exceeds = function(s) > largest
    return float(s[np.argmax(exceeds)]) if exceeds.any() else float(s[-1])
