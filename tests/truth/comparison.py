"""How far one program's figures are from another's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .prescription import Rays, Traced


@dataclass(frozen=True)
class Differences:
    """Differences of each ray that passes in both programs: lengths in mm, directions as the length of a difference."""

    position: np.ndarray
    direction: np.ndarray
    optical_path: np.ndarray


def between(a: Traced, b: Traced) -> Differences:
    both = a.ok & b.ok
    return Differences(
        np.linalg.norm(a.positions - b.positions, axis=1)[both],
        np.linalg.norm(a.directions - b.directions, axis=1)[both],
        np.abs(a.optical_paths - b.optical_paths)[both],
    )


def of_return(start: Rays, back: Traced) -> Differences:
    """Differences of rays traced back through the lens from the straight lines on which they came in.

    `start`: without the rays that failed. `back`: its optical paths are those of the return minus those of the forward
    trace; the remainder is the distance from the first surface to the start, in air.
    """
    home = start.origins - back.positions
    along = (home * back.directions).sum(axis=1)
    return Differences(
        np.linalg.norm(home - along[:, None] * back.directions, axis=1),
        np.linalg.norm(start.directions + back.directions, axis=1),
        np.abs(back.optical_paths + along),
    )


def worst(differences: list[Differences]) -> Differences:
    """The largest of all, nan if there is one."""
    fields = ("position", "direction", "optical_path")
    return Differences(*(np.concatenate([getattr(d, name) for d in differences]).max() for name in fields))


def contradictions(a: Traced, b: Traced) -> np.ndarray:
    """Rays that pass in one program and not in the other, or that end at different surfaces.

    Why they end is no contradiction: a surface that a ray meets beyond its rim is missed or vignettes, as a program
    likes to call it.
    """
    return np.flatnonzero((a.ok != b.ok) | (~a.ok & ~b.ok & (a.ended_at != b.ended_at)))


def relative(a: dict[str, float], b: dict[str, float]) -> dict[str, float]:
    """Relative differences of first-order figures; a figure of 0 (a pupil at the first vertex) must match exactly."""
    return {name: abs(a[name] - value) / abs(value) if a[name] != value else 0.0 for name, value in b.items()}
