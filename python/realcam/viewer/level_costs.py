"""Costs of the levels of simulation for the current camera; see docs/accuracy.md."""

from __future__ import annotations

import math
from typing import Any

from .._core import Camera, RealcamError, Scene
from ..accuracy import accuracy_cost

# Arguments of accuracy_cost for a quick measurement: some seconds on two cores.
_QUICK_SETTINGS: dict[str, Any] = {"size": 120, "max_spp": 16, "reference_spp": 256}


def measured_levels(scene: Scene, camera: Camera, device: str) -> tuple[list[dict[str, Any]], str]:
    """Returns each level's "name" and "points", and a note for the user.

    Points are pairs of the render time in seconds, extrapolated to the full resolution, and the RMS error in 8-bit
    codes.
    """
    try:
        cost = accuracy_cost(scene, camera, **_QUICK_SETTINGS, device=device, samplings=False)
    except RealcamError as error:
        return [], str(error)
    pixels = math.prod(camera.film.resolution) / math.prod(cost.size)
    levels = [
        {"name": level.name, "points": [[pixels * p.seconds, p.rmse] for p in level.pictures]} for level in cost.levels
    ]
    return levels, f"against a reference with noise of {cost.reference_noise_codes:.2g} grey levels"
