"""Analysis results as JSON or CSV."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import os
from typing import Any

import numpy as np

from .. import files
from ..json_values import json_value

FORMATS = (".json", ".csv")


def as_json(data: Any) -> str:
    """Returns a JSON object with all fields of a result, a dataclass, by their names; arrays become lists. nan becomes
    null and infinities become strings, because JSON has neither."""
    return json.dumps(json_value(data, has_infinity=True), indent=1)


def as_csv(data: Any) -> str:
    """Returns a CSV table with one number of the result per line: field name, index along each axis, and value."""
    fields = {f.name: getattr(data, f.name) for f in dataclasses.fields(data)}
    numbers = {name: np.asarray(v) for name, v in fields.items() if _is_numeric(v)}
    depth = max((array.ndim for array in numbers.values()), default=0)
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["name", *(f"index_{k}" for k in range(depth)), "value"])
    for name, array in numbers.items():
        for index, value in np.ndenumerate(array):
            table.writerow([name, *index, *[""] * (depth - array.ndim), repr(value.item())])
    return text.getvalue()


def save_numbers(data: Any, path: str | os.PathLike[str]) -> None:
    """Writes a result as .json or .csv, completely or not at all.

    Raises ImageFileError for another suffix or a file that cannot be written.
    """
    target = files.check_target(path, FORMATS)
    text = as_json(data) + "\n" if target.suffix.lower() == ".json" else as_csv(data)
    files.write_whole(target, text.encode())


def _is_numeric(value: Any) -> bool:
    try:
        return np.asarray(value).dtype.kind in "fiu"
    except ValueError:  # arrays of different lengths
        return False
