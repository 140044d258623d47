"""Settings of a picture, as one value and as keywords."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter
from typing import Any

from ._core import ArgumentError, RenderSettings


def settings_of(
    settings: RenderSettings | None, changes: Mapping[str, Any], initial: RenderSettings | None = None
) -> RenderSettings:
    """What a call means by `settings` (None: `initial`, or all as it is by default) and by keywords that change them.

    Raises InputError.
    """
    if settings is None:
        settings = initial or RenderSettings()
    if not isinstance(settings, RenderSettings):
        raise ArgumentError(f"settings must be RenderSettings or None; it is {settings!r:.60}")
    return settings.with_(**changes) if changes else settings


def setting(name: str) -> Any:
    """A property of a class: what its `settings` say."""
    return property(attrgetter(f"settings.{name}"), doc=f"settings.{name}")
