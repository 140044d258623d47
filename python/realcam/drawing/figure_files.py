"""Writing of matplotlib figures as vector and bitmap files, with reproducible bytes, completely or not at all."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from .. import files

NOTEBOOK_DPI = 100
_SETTINGS: Any = {"svg.fonttype": "none", "pdf.fonttype": 42}  # writes text as text, not as outlines
# Keyed by suffix, for Figure.savefig. Vector files have no date, so that their bytes are reproducible; bitmaps are
# lossless, and JPEG is visually so.
_OPTIONS: dict[str, dict[str, Any]] = {
    ".svg": {"metadata": {"Date": None}},
    ".png": {},
    ".pdf": {"metadata": {"CreationDate": None}},
    ".jpg": {"pil_kwargs": {"quality": 95, "subsampling": 0}},
    ".tif": {"pil_kwargs": {"compression": "tiff_lzw"}},
    ".webp": {"pil_kwargs": {"lossless": True}},
}
_OPTIONS |= {".jpeg": _OPTIONS[".jpg"], ".tiff": _OPTIONS[".tif"]}
FORMATS = tuple(_OPTIONS)


class ShownFigure(Figure):
    """A figure that a notebook shows as the result of a cell, even without matplotlib's inline display."""

    def _repr_png_(self) -> bytes:
        return figure_bytes(self, ".png", NOTEBOOK_DPI)


def check_figure_target(path: str | os.PathLike[str]) -> Path:
    """Returns the path. Raises ImageFileError if no figure can be written to this name."""
    return files.check_target(path, FORMATS)


def figure_bytes(
    figure: Figure, suffix: str, dpi: float = 160, salt: str = "realcam", crop: Bbox | None = None
) -> bytes:
    """Returns the content of a file with this suffix.

    dpi: resolution of bitmaps. salt: seed of the SVG ids, which must differ between drawings on one page. crop: part of
    the figure to write, in inches; None: all.
    """
    kind = suffix.lower()
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        text.set_text(_without_controls(text.get_text()))
    drawing = io.BytesIO()
    with matplotlib.rc_context({**_SETTINGS, "svg.hashsalt": salt}):
        figure.savefig(
            drawing,
            format=kind[1:],
            dpi=dpi,
            bbox_inches=crop,
            facecolor=figure.get_facecolor(),
            **_OPTIONS[kind],
        )
    return drawing.getvalue()


def _without_controls(text: str) -> str:
    """Replaces unprintable characters by spaces: XML, and so SVG, cannot represent most of them."""
    return text if text.isprintable() else "".join(c if c.isprintable() or c == "\n" else " " for c in text)


def save_figure(figure: Figure, path: str | os.PathLike[str], dpi: float = 160) -> None:
    """Writes a figure in the format of the path's suffix. Raises ImageFileError."""
    target = check_figure_target(path)
    # Rendered in memory first: matplotlib takes long, and a program that is killed meanwhile leaves no file behind.
    files.write_whole(target, figure_bytes(figure, target.suffix, dpi))
