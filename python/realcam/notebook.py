"""Notebook representations of pictures and plans."""

from __future__ import annotations

import html
import io

import numpy as np
from numpy.typing import NDArray

from ._core import Plan
from .html_tables import html_table
from .number_text import number_text, percent_text
from .ocio import OcioView, develop

LONGEST_SIDE_PX = 1200


def picture_png(exposure: NDArray[np.float32], iso: float, tone: str | OcioView) -> bytes:
    """Returns a PNG file of an exposure, (H, W, 3) lux seconds, developed and reduced to at most LONGEST_SIDE_PX."""
    import matplotlib.image

    step = -(-max(exposure.shape) // LONGEST_SIDE_PX)
    height, width = exposure.shape[0] // step * step, exposure.shape[1] // step * step
    blocks = exposure[:height, :width].reshape(height // step, step, width // step, step, 3)
    file = io.BytesIO()
    matplotlib.image.imsave(file, develop(blocks.mean(axis=(1, 3)), iso, tone), format="png")
    return file.getvalue()


def plan_html(plan: Plan) -> str:
    """Returns a plan as HTML, with a table of its decisions."""
    rows = [
        (
            decision.effect,
            "kept" if decision.is_kept else "left out",
            f"{number_text(decision.size, 3)} {decision.unit}",
            f"{number_text(decision.threshold, 3)} {decision.unit}",
            "" if decision.time_share is None else percent_text(decision.time_share, signed=True),
            decision.reason,
        )
        for decision in plan.decisions
    ]
    table = html_table(rows, ("effect", "", "size", "threshold", "time", "because"), align="left")
    return f"<p>camera model {html.escape(plan.model)}, {html.escape(plan.summary)}</p>{table}"


# setattr because the class belongs to the extension.
setattr(Plan, "_repr_html_", plan_html)  # noqa: B010
