"""Lookup tables for rays, for scalar and vectorised Mitsuba variants."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np


class Table:
    """Table of shape (N, C); calling it with a row index returns the C values of the row."""

    def __init__(self, rows: np.ndarray) -> None:
        columns = np.ascontiguousarray(rows.reshape(-1, rows.shape[-1]).T, dtype=np.float32)
        # Scalar variants have no gather: they index lists.
        self.columns = [mi.Float(column) for column in columns] if dr.is_jit_v(mi.Float) else columns.tolist()

    def __call__(self, row: Any) -> list[Any]:
        if dr.is_jit_v(mi.Float):
            return [dr.gather(mi.Float, column, row) for column in self.columns]
        return [column[row] for column in self.columns]
