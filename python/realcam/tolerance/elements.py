"""Glass elements of a lens."""

from __future__ import annotations

from .._core import InputError, Lens
from ..derivatives.variable import check_surface_exists


def has_glass_behind(lens: Lens, surface: int) -> bool:
    """True if the medium behind the surface is not air."""
    return lens.surfaces[surface].material.index(lens.wavelength_nm) != 1


def elements_of(lens: Lens) -> list[tuple[int, int]]:
    """Returns first and last surface of each element, counted from 0. A cemented group is one element."""
    found, first = [], None
    for index, surface in enumerate(lens.surfaces):
        if surface.type in ("stop", "aperture"):
            continue
        if has_glass_behind(lens, index):
            first = index if first is None else first
        elif first is not None:
            found.append((first, index))
            first = None
    return found


def check_surface(lens: Lens, surface: int) -> None:
    """Raises InputError if the surface does not exist."""
    if not isinstance(surface, int) or isinstance(surface, bool):
        raise InputError(f"expected a surface, as an index from 0; found {surface!r:.40}")
    check_surface_exists(lens, surface)


def check_element(lens: Lens, first: int, last: int) -> None:
    """Raises InputError unless both surfaces exist and `last` follows `first`."""
    check_surface(lens, first)
    check_surface(lens, last)
    if last <= first:
        raise InputError(
            f"an element needs a last surface behind its first one, surface {first + 1}; for a single face use a "
            "tolerance of the surface"
        )
