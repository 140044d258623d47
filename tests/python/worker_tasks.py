"""What other processes are asked to do: they import it by this name."""

from __future__ import annotations

import realcam as rc


def focal_length(lens: rc.Lens) -> float:
    return lens.first_order().effective_focal_length_mm


def photograph(task: tuple[rc.Scene, rc.Camera]) -> rc.Image:
    return rc.render(*task, spp=1, device="cpu")
