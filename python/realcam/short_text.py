"""Short reprs of values that hold arrays, for terminals and notebooks."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np


class ShortText:
    """Base of dataclasses declared with repr=False. The repr shows the shapes of arrays in place of their elements."""

    def __repr__(self) -> str:
        fields = dataclasses.fields(self)  # type: ignore[arg-type]  # subclasses are dataclasses
        words = ", ".join(f"{field.name} {_short(getattr(self, field.name))}" for field in fields)
        package = ".".join(type(self).__module__.split(".")[:2]) if "." in type(self).__module__ else "realcam"
        return f"<{package}.{type(self).__name__} {words}>"


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"{value.item():.6g}" if value.ndim == 0 and value.dtype.kind == "f" else str(value.shape)
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, (tuple, list, Mapping)):
        return f"of {len(value)}"
    return f"{value!r:.60}"
