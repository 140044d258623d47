"""Words about effects: what the core calls what users write."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ._core import InputError

Illuminant = str | float | Sequence[tuple[float, float]]


def effect_list(effects: str | Iterable[str] | None) -> list[str]:
    """Names of effects as users give them: one, some, or none. Raises InputError."""
    try:
        return [effects] if isinstance(effects, str) else sorted(effects or ())
    except TypeError:
        raise InputError(f"effects must be names (rc.effects() lists them); they are {effects!r:.60}") from None


def illuminant_text(illuminant: Illuminant | None) -> str:
    """The text for the core: a name, a wavelength, or the points of a table; empty: none."""
    if illuminant is None:
        return ""
    if isinstance(illuminant, str):
        return illuminant or "?"
    given: Any = illuminant
    try:
        if hasattr(given, "__len__"):
            return ",".join(f"{float(nm)!r}:{float(power)!r}" for nm, power in given)
        return repr(float(given))
    except (TypeError, ValueError):
        raise InputError(
            f"illuminant must be a name, a wavelength in nm or (wavelength_nm, power) pairs; it is {illuminant!r:.60}"
        ) from None
