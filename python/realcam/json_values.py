"""Conversion of results to JSON."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

import numpy as np

from ._core import FieldOfView, Lens


def json_text(value: Any) -> str:
    """Returns a value as indented JSON; see json_value."""
    return json.dumps(json_value(value), indent=2, ensure_ascii=False)


def json_value(value: Any, *, has_infinity: bool = False) -> Any:
    """Converts a value for json.dumps. Non-finite numbers become None, as in the executable; lenses become names.

    has_infinity: infinities become the texts "inf" and "-inf".
    """

    def converted(value: Any) -> Any:
        if isinstance(value, Lens):
            return value.name
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            return {field.name: converted(getattr(value, field.name)) for field in dataclasses.fields(value)}
        if isinstance(value, FieldOfView):
            return converted(value._asdict())
        if isinstance(value, dict):
            return {key: converted(entry) for key, entry in value.items()}
        if isinstance(value, np.ndarray | np.generic):
            return converted(value.tolist())
        if isinstance(value, tuple | list):
            return [converted(item) for item in value]
        if isinstance(value, float) and not math.isfinite(value):
            return str(value) if has_infinity and math.isinf(value) else None
        return value

    return converted(value)
