"""Arrays of dual numbers: forward-mode differentiation of numpy expressions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DualArray:
    """An array with derivatives. value: of any shape; by: of the same shape with one more axis, for V variables. Shapes
    broadcast as in numpy."""

    value: Doubles
    by: Doubles

    # Makes `array * dual` call __rmul__ instead of numpy's elementwise product with an object.
    __array_ufunc__ = None

    @staticmethod
    def constant(value: Doubles | float, count: int) -> DualArray:
        """A constant, whose derivatives by `count` variables are 0."""
        array = np.asarray(value, float)
        return DualArray(array, np.zeros((*array.shape, count)))

    @property
    def count(self) -> int:
        """Number of variables."""
        return int(self.by.shape[-1])

    def _other(self, other: Operand) -> DualArray:
        return other if isinstance(other, DualArray) else DualArray.constant(other, self.count)

    def mapped(self, value: Doubles, slope: Doubles) -> DualArray:
        """Applies a function, given its value and its slope at this value."""
        return DualArray(np.asarray(value), np.asarray(slope)[..., None] * self.by)

    def __getitem__(self, index: Any) -> DualArray:
        """Indexes the axes of `value`. An Ellipsis is not supported."""
        return DualArray(np.asarray(self.value[index]), self.by[index])

    def __add__(self, other: Operand) -> DualArray:
        b = self._other(other)
        return DualArray(self.value + b.value, self.by + b.by)

    __radd__ = __add__

    def __neg__(self) -> DualArray:
        return DualArray(-self.value, -self.by)

    def __sub__(self, other: Operand) -> DualArray:
        return self + (-self._other(other))

    def __rsub__(self, other: Operand) -> DualArray:
        return self._other(other) + (-self)

    def __mul__(self, other: Operand) -> DualArray:
        if not isinstance(other, DualArray):
            factor = np.asarray(other, float)
            return DualArray(self.value * factor, self.by * factor[..., None])
        return DualArray(self.value * other.value, self.by * other.value[..., None] + self.value[..., None] * other.by)

    __rmul__ = __mul__

    def __truediv__(self, other: Operand) -> DualArray:
        b = self._other(other)
        ratio = self.value / b.value
        return DualArray(ratio, (self.by - ratio[..., None] * b.by) / b.value[..., None])

    def __rtruediv__(self, other: Operand) -> DualArray:
        return self._other(other) / self

    def sqrt(self) -> DualArray:
        """Square root; its derivative at 0 is taken to be 0."""
        root = np.sqrt(self.value)
        with np.errstate(divide="ignore"):
            return self.mapped(root, np.where(root > 0, 0.5 / root, 0.0))

    def sum(self, weights: Doubles) -> DualArray:
        """Weighted sum over the first axis; weights: (N,)."""
        return DualArray(np.tensordot(weights, self.value, 1), np.tensordot(weights, self.by, 1))


Operand = DualArray | Doubles | float
