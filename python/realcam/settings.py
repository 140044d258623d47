"""Arguments of many functions: whole numbers, and render settings both as a RenderSettings and as keywords."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter, index
from typing import Any

from ._core import ArgumentError, InputError, RenderSettings

MAX_SPP = 1 << 24  # samples per pixel that RenderSettings accept
MAX_SEED = (1 << 32) - 1


def settings_of(
    settings: RenderSettings | None, changes: Mapping[str, Any], initial: RenderSettings | None = None
) -> RenderSettings:
    """Merges `settings` (None: `initial`, or the defaults) with the keywords of a call, which override them.

    Raises InputError.
    """
    if settings is None:
        settings = initial or RenderSettings()
    if not isinstance(settings, RenderSettings):
        raise ArgumentError(f"settings must be RenderSettings or None; it is {settings!r:.60}")
    return settings.with_(**changes) if changes else settings


def whole_number(name: str, value: Any, least: int, most: int | None = None) -> int:
    """Returns an argument that is a whole number within limits. Raises InputError with the argument's name."""
    try:
        number = index(value)
    except TypeError:
        number = least - 1
    if isinstance(value, bool) or number < least or (most is not None and number > most):
        limits = f"of {least} or more" if most is None else f"from {least} to {most}"
        raise InputError(f"{name} is {value!r:.40}; expected a whole number {limits}")
    return number


def setting(name: str) -> Any:
    """Returns a property that reads an attribute of `self.settings`."""
    return property(attrgetter(f"settings.{name}"), doc=f"settings.{name}")
