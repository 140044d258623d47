"""Costs of the levels of simulation for the current camera; see docs/accuracy.md."""

from __future__ import annotations

import math
from typing import Any

from .._core import Camera, RealcamError, Scene
from ..accuracy import accuracy_cost

_FEW: dict[str, Any] = {"size": 120, "max_spp": 16, "reference_spp": 256}  # some seconds on two cores


def measured_levels(scene: Scene, camera: Camera, device: str) -> tuple[list[dict[str, Any]], str]:
    """Returns each level's name and points (seconds, error), with times extrapolated to the full resolution; and a
    note."""
    try:
        cost = accuracy_cost(scene, camera, **_FEW, device=device, samplings=False)
    except RealcamError as error:
        return [], str(error)
    pixels = math.prod(camera.film.resolution) / math.prod(cost.size)
    levels = [
        {"name": rung.name, "points": [[pixels * p.seconds, p.rmse] for p in rung.pictures]} for rung in cost.rungs
    ]
    return levels, f"against a reference with noise of {cost.reference_noise_codes:.2g} grey levels"
