"""Tasks for worker processes, which import them by this module's name."""

from __future__ import annotations

import signal

import realcam as rc


def focal_length(lens: rc.Lens) -> float:
    return lens.first_order().effective_focal_length_mm


def crash(_: object) -> None:
    signal.raise_signal(signal.SIGSEGV)


def compute_for_ever(_: object) -> None:
    """Without letting any other thread run."""
    pow(7, 10**9)


def photograph(task: tuple[rc.Scene, rc.Camera]) -> rc.Image:
    return rc.render(*task, spp=1, device="cpu")
