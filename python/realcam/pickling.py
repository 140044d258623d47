"""What pickles of realcam's objects name: how they are read again."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _core

FORMAT = _core._STATE_FORMAT


def restored(kind: str, state_format: int, version: str, state: Any) -> Any:
    """The object that was pickled. Raises InputError where another version of realcam wrote it in another way."""
    if state_format != FORMAT:
        raise _core.InputError(
            f"this {kind} was pickled by realcam {version} in format {state_format}; realcam {_core.__version__} "
            f"reads format {FORMAT} only"
        )
    try:
        return getattr(_core, kind)._restored(state)
    except (RuntimeError, TypeError, AttributeError) as error:
        raise _core.InputError(f"this {kind} was pickled by realcam {version} and cannot be read: {error}") from None


def same_arrays(one: Any, other: Any) -> bool:
    """Whether two arrays have the same type, shape and numbers, NaN included."""
    a, b = np.asarray(one), np.asarray(other)
    return a.dtype == b.dtype and a.shape == b.shape and bool(np.array_equal(a, b, equal_nan=a.dtype.kind == "f"))
