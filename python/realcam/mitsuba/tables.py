"""Tables that rays look up, for every kind of Mitsuba variant."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np


class Table:
    """Rows of numbers. (N, C) -> C values for a row."""

    def __init__(self, rows: np.ndarray) -> None:
        columns = np.ascontiguousarray(rows.reshape(-1, rows.shape[-1]).T, dtype=np.float32)
        # Scalar variants have no gather: there a row is one of a list.
        self.columns = [mi.Float(column) for column in columns] if dr.is_jit_v(mi.Float) else columns.tolist()

    def __call__(self, row: Any) -> list[Any]:
        if dr.is_jit_v(mi.Float):
            return [dr.gather(mi.Float, column, row) for column in self.columns]
        return [column[row] for column in self.columns]
