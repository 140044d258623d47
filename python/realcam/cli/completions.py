"""Shell completion of arguments and options whose values are names. Other values are completed as files."""

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
    """Returns a function from an incomplete word to the names that begin with it, for values with this placeholder.

    Returns None if values of this kind have no names.
    """
    names = _NAMES.get(metavar or "")
    return names and (lambda incomplete: [name for name in names() if name.startswith(incomplete)])
