"""Rays for a comparison: few decimals, so that every program gets the same numbers and the file stays small."""

from __future__ import annotations

import math

import numpy as np
import realcam as rc

from ..python.yardsticks import Paraxial
from .backends import realcam_lens
from .prescription import Prescription, Rays

OVERFILL = 1.1  # of the entrance pupil, so that some rays meet a rim
WILD_SHARE, WILD_DEG = 0.1, 70.0  # rays from anywhere, so that some miss a surface or are reflected totally
DECIMALS = 6


def rounded(origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.round(origins, DECIMALS), np.round(directions, DECIMALS)


def unit(origins: np.ndarray, directions: np.ndarray) -> Rays:
    """Normalises the directions of rays from a file. All programs use it, so that they start with the same doubles."""
    return Rays(origins, directions / np.linalg.norm(directions, axis=1, keepdims=True))


def from_the_scene(
    prescription: Prescription, half_field_deg: float, count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Rays from a plane in front of the lens, over the whole field, towards the entrance pupil and a little beyond."""
    pupil = Paraxial(realcam_lens(prescription))
    half_fields = np.where(rng.uniform(0, 1, count) < WILD_SHARE, WILD_DEG, half_field_deg)
    angle = np.radians(half_fields) * np.sqrt(rng.uniform(0, 1, count))
    azimuth = rng.uniform(0, 2 * math.pi, count)
    tangents = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1) * np.tan(angle)[:, None]
    radius = 0.5 * OVERFILL * pupil.entrance_pupil_diameter * np.sqrt(rng.uniform(0, 1, count))
    turn = rng.uniform(0, 2 * math.pi, count)
    at_pupil = radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    z = -2 * max(row.semi_diameter for row in prescription.rows)
    start = at_pupil + tangents * (z - pupil.entrance_pupil)
    origins = np.concatenate([start, np.full((count, 1), z)], axis=1)
    return rounded(origins, np.concatenate([tangents, np.ones((count, 1))], axis=1))


def from_the_film(name: str, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """For a bundled lens, whose field may reach past 90 degrees: where rays from its film come from, disturbed.

    The disturbance of 3% of the pupil pushes some over a rim. realcam only aims here; what is compared are the
    rounded rays.
    """
    lens = rc.Lens.load(name)
    first, film, many = lens.first_order(), lens.film_position_mm, 400 * count
    height = 0.5 * math.hypot(*lens.film_mm)
    radius, azimuth = height * np.sqrt(rng.uniform(0, 1, many)), rng.uniform(0, 2 * math.pi, many)
    origins = np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), np.full(many, film)], axis=1)
    pupil = 0.6 * first.exit_pupil_diameter_mm * rng.uniform(-1, 1, (many, 2))
    target = np.concatenate([pupil, np.full((many, 1), first.exit_pupil_position_mm)], axis=1)
    directions = (target - origins) * np.sign(film - first.exit_pupil_position_mm)
    out = lens.trace(origins, directions, start="film")
    passed = np.flatnonzero(out.status == rc.RayStatus.OK)[:count]
    assert len(passed) == count, name
    ahead = lens.surfaces[0].clear_semi_diameter_mm
    origins = out.origins_mm[passed] + ahead * out.directions[passed]
    origins += 0.03 * first.entrance_pupil_diameter_mm * rng.uniform(-1, 1, (count, 3))
    return rounded(origins, -out.directions[passed])
