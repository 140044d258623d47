"""Experiments as the page shows them: text, figures, and a table of the paper's numbers beside the measured ones."""

from __future__ import annotations

import base64
import html
import io
from dataclasses import dataclass

import matplotlib
import matplotlib.figure
import numpy as np
from realcam._core import develop
from realcam.drawing.figure_files import figure_bytes
from realcam.image import Image


@dataclass(frozen=True)
class Row:
    """A number beside a number; paper: empty where the paper has none."""

    quantity: str
    paper: str
    here: str


@dataclass(frozen=True)
class Figure:
    """A piece of HTML: an SVG drawing or a picture; caption in plain text."""

    caption: str
    markup: str


@dataclass(frozen=True)
class Experiment:
    """title: with the number of the paper's figure or equation. text: paragraphs in plain text."""

    title: str
    text: tuple[str, ...]
    figures: tuple[Figure, ...] = ()
    rows: tuple[Row, ...] = ()


def drawn(caption: str, figure: matplotlib.figure.Figure) -> Figure:
    svg = figure_bytes(figure, ".svg", salt=caption).decode()
    return Figure(caption, svg[svg.index("<svg") :])


def photographed(caption: str, image: Image, *, scale: int = 1, iso: float | None = None) -> Figure:
    """A developed picture; scale: times enlarged, each pixel a square. iso: the camera's, if not given."""
    codes = develop(image.pixels, image.camera.iso if iso is None else iso, "linear")
    return pixels(caption, codes, scale=scale)


def pixels(caption: str, codes: np.ndarray, *, scale: int = 1) -> Figure:
    """(H, W, 3) 8-bit codes as a picture."""
    import matplotlib.image

    data = io.BytesIO()
    matplotlib.image.imsave(data, codes, format="png")
    text = base64.b64encode(data.getvalue()).decode("ascii")
    height, width = (scale * length for length in codes.shape[:2])
    return Figure(
        caption,
        f'<img width="{width}" height="{height}" style="image-rendering: pixelated" alt="{html.escape(caption)}" '
        f'src="data:image/png;base64,{text}">',
    )
