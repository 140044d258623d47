"""Shell completion of arguments and options. All others are completed as names of files."""

from __future__ import annotations

from collections.abc import Callable

from .._core import devices, lens_names, sensor_names

# Completion candidates by metavar of the help.
_NAMES: dict[str, Callable[[], list[str]]] = {
    "LENS": lens_names,
    "SENSOR": sensor_names,
    "DEVICE": lambda: ["auto", "cpu", *(device.name for device in devices() if device.name != "cpu")],
}


def completion_of(metavar: str | None) -> Callable[[str], list[str]] | None:
    """Names that begin as the word does that is being typed, for values of a kind that has names."""
    names = _NAMES.get(metavar or "")
    return names and (lambda incomplete: [name for name in names() if name.startswith(incomplete)])
