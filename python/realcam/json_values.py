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


def json_value(value: Any) -> Any:
    """Converts a value for json.dumps. Non-finite numbers become None, as in the executable; lenses become names."""
    if isinstance(value, Lens):
        return value.name
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: json_value(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, FieldOfView):
        return json_value(value._asdict())
    if isinstance(value, dict):
        return {key: json_value(entry) for key, entry in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [json_value(item) for item in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value
