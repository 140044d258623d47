"""Checked access to the values of a file by their keys. Every mistake is reported with file and key."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NoReturn

import numpy as np

from ..arrays import Array, picture_size
from .document import Document

_MISSING = object()


class Entries:
    """A mapping of a file. Numbers may be texts; a list of numbers may be nested, or one text with blanks or commas.

    where: text before the keys in messages, such as "camera0.".
    """

    def __init__(self, document: Document, values: Mapping[str, Any], where: str = "") -> None:
        self.document, self.values, self.where = document, values, where

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def fail(self, key: str, expected: str) -> NoReturn:
        """Raises CalibrationFileError: what is expected under the key, and what is there."""
        value = self.values.get(key, _MISSING)
        found = "it is missing" if value is _MISSING else f"found {str(value)!r:.60}"
        self.document.fail(f"{self.where}{key}: expected {expected}; {found}")

    def number(self, key: str, default: float | None = None) -> float:
        """Returns a finite number."""
        if default is not None and key not in self.values:
            return default
        value = _number(self.values.get(key))
        if value is None:
            self.fail(key, "a finite number")
        return value

    def positive(self, key: str) -> float:
        """Returns a positive number."""
        value = self.number(key)
        if value <= 0:
            self.fail(key, "a positive number")
        return value

    def numbers(self, key: str, *counts: int) -> list[float]:
        """Returns finite numbers. counts: the permitted counts; without them, any number is permitted."""
        found = _numbers(self.values.get(key, _MISSING))
        if found is None or (counts and len(found) not in counts):
            self.fail(key, f"{' or '.join(map(str, counts))} finite numbers".strip())
        return found

    def matrix(self, key: str, rows: int, columns: int) -> Array:
        """Returns a matrix, whose numbers stand in the file row by row. Only their count is checked."""
        return np.array(self.numbers(key, rows * columns)).reshape(rows, columns)

    def size(self, *keys: str) -> tuple[int, int]:
        """Returns (width, height), under one key or under two."""
        values = self.numbers(keys[0], 2) if len(keys) == 1 else [self.number(key) for key in keys]
        try:
            return picture_size(values)
        except ValueError:
            self.fail(keys[0], "whole numbers of pixels from 1 to 1000000")

    def text(self, key: str, default: str | None = None) -> str:
        """Returns a text."""
        value = self.values.get(key, default)
        if not isinstance(value, str) or not value.strip():
            self.fail(key, "a text")
        return value.strip()

    def choice(self, key: str, known: Sequence[str] | Mapping[str, object]) -> str:
        """Returns one of the known texts."""
        value = self.text(key)
        if value not in known:
            self.fail(key, f"one of {', '.join(known)}")
        return value

    def child(self, key: str) -> Entries:
        """Returns a mapping inside this one."""
        value = self.values.get(key)
        if not isinstance(value, Mapping):
            self.fail(key, "a mapping of keys to values")
        return Entries(self.document, value, f"{self.where}{key}.")

    def children(self, key: str) -> Iterator[Entries]:
        """Yields the mappings of a list."""
        values = self.values.get(key)
        if not isinstance(values, Sequence) or isinstance(values, str):
            self.fail(key, "a list")
        for index, value in enumerate(values):
            if not isinstance(value, Mapping):
                self.document.fail(f"{self.where}{key}[{index}]: expected a mapping of keys to values")
            yield Entries(self.document, value, f"{self.where}{key}[{index}].")


def element_entries(document: Document, element: ET.Element) -> Entries:
    """Returns the texts of the children of an XML element by their tags, and its attributes."""
    values: dict[str, Any] = dict(element.attrib)
    for child in element:
        values[child.tag] = (child.text or "").strip()
    return Entries(document, values, f"{element.tag}.")


def _number(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    if isinstance(value, str) and "_" in value:  # float() accepts 1_000
        return None
    try:
        number = float(value)
    except (ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None


def _numbers(value: object, depth: int = 0) -> list[float] | None:
    if isinstance(value, Mapping) and "data" in value:  # OpenCV's and ROS's matrices
        found = _numbers(value["data"])
        shape = [_number(value.get(side, value.get(f"n{side}"))) for side in ("rows", "cols")]
        fits = found is not None and None not in shape and shape[0] * shape[1] == len(found)  # type: ignore[operator]
        return found if fits else None
    if isinstance(value, str):
        value = value.replace(",", " ").split()
    if not isinstance(value, list | tuple) or depth > 3:
        return None
    numbers: list[float] = []
    for item in value:
        if isinstance(item, list | tuple):
            part = _numbers(item, depth + 1)
        else:
            number = _number(item)
            part = None if number is None else [number]
        if part is None:
            return None
        numbers += part
    return numbers
