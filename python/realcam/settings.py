"""Render settings that functions accept both as a RenderSettings and as keywords."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter
from typing import Any

from ._core import ArgumentError, RenderSettings


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


def setting(name: str) -> Any:
    """Returns a property that reads an attribute of `self.settings`."""
    return property(attrgetter(f"settings.{name}"), doc=f"settings.{name}")
