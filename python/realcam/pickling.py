"""Pickling of realcam's objects: the arguments of their constructors, which check them.

Pickles are untrusted input: invalid arguments raise InputError, and classes other than realcam's values are refused.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core

if TYPE_CHECKING:
    from typing_extensions import Self

FORMAT = _core._STATE_FORMAT


def restored(kind: str | type, state_format: int, version: str, state: Any) -> Any:
    """Restores a pickled object.

    kind: its class, or the class's name in the extension. state_format, version: of the realcam that pickled it.
    state: arguments of its constructor. Raises InputError if the state is damaged, or if it is in the format of another
    version of realcam.
    """
    made_by = version if isinstance(version, str) and len(version) <= 20 and version.isprintable() else "?"
    type_ = getattr(_core, kind, None) if isinstance(kind, str) else kind
    if not isinstance(type_, type) or not hasattr(type_, "_restored"):
        raise _core.InputError(
            f"realcam {_core.__version__} cannot restore this object, which realcam {made_by} pickled"
        )
    name = type_.__name__
    if not isinstance(state_format, int) or state_format != FORMAT:
        other = f"{state_format:d}" if isinstance(state_format, int) and abs(state_format) < 10**9 else "?"
        raise _core.InputError(
            f"this {name} was pickled by realcam {made_by} in format {other}; realcam {_core.__version__} reads format "
            f"{FORMAT} only"
        )
    why = "it is damaged"
    try:
        return type_._restored(state)
    except _core.RealcamError as error:
        why = " ".join(str(error).split())  # it may quote an array, whose text has several lines
    except (RuntimeError, TypeError, ValueError, AttributeError, OverflowError, LookupError):
        pass  # messages about C++ types or arguments of __init__
    raise _core.InputError(f"this {name} was pickled by realcam {made_by} and cannot be read: {why}")


def described(value: Any, buffers: list[np.ndarray]) -> Any:
    """Describes a value as JSON, by the state of its pickle. Its arrays are appended to `buffers`, as bytes.

    Bytes become {"text": Latin-1}, and an array {"array": [offset, rows, bytes of a row]}, with the offset in the
    concatenated buffers.
    """
    _, (kind, state_format, version, state) = value.__reduce__()
    size = sum(buffer.size for buffer in buffers)

    def plain(item: Any) -> Any:
        nonlocal size
        if isinstance(item, tuple):
            return [plain(each) for each in item]
        if isinstance(item, bytes):
            return {"text": item.decode("latin-1")}
        if isinstance(item, np.ndarray):
            assert item.dtype == np.uint8 and item.ndim == 2
            buffers.append(item.ravel())
            size += item.size
            return {"array": [size - item.size, *item.shape]}
        return item

    return {"kind": kind, "format": state_format, "version": version, "state": plain(state)}


def from_description(description: Any, buffer: np.ndarray, kind: str) -> Any:
    """Returns the value that described() has described; this is its inverse.

    kind: expected kind of the value. buffer: the concatenated buffers, uint8. Raises InputError.
    """

    def state_of(item: Any) -> Any:
        if isinstance(item, list):
            return tuple(state_of(each) for each in item)
        if not isinstance(item, dict):
            return item
        if "text" in item:
            return item["text"].encode("latin-1")
        offset, rows, width = item["array"]
        if min(offset, rows, width) < 0 or offset + rows * width > buffer.size:
            raise ValueError
        return buffer[offset : offset + rows * width].reshape(rows, width)

    try:
        if description["kind"] != kind or buffer.dtype != np.uint8 or buffer.ndim != 1:
            raise ValueError
        state = state_of(description["state"])
        state_format, version = description["format"], description["version"]
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError):
        raise _core.InputError(f"this {kind} cannot be read from its description: it is damaged") from None
    return restored(kind, state_format, version, state)


class PickledByFields:
    """Base class of frozen dataclasses: pickles hold the fields, which __init__ checks when they are read."""

    def __reduce__(self) -> Any:
        state = tuple(getattr(self, field.name) for field in dataclasses.fields(self))  # type: ignore[arg-type]
        return restored, (type(self), FORMAT, _core.__version__, state)

    @classmethod
    def _restored(cls, state: Any) -> Self:
        return cls(*state)


def same_arrays(one: Any, other: Any) -> bool:
    """Returns True if two arrays have the same dtype, shape and values, with NaN equal to NaN."""
    a, b = np.asarray(one), np.asarray(other)
    return a.dtype == b.dtype and a.shape == b.shape and bool(np.array_equal(a, b, equal_nan=a.dtype.kind in "fc"))
