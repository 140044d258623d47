"""Contact sheets of labelled pictures, with matplotlib."""

from __future__ import annotations

import math
import os
import re
import textwrap
from collections.abc import Sequence
from typing import Any

from numpy.typing import NDArray

from .._core import InputError
from ..analysis.style import new_figure, themed
from ..drawing.figure_files import check_figure_target, save_figure
from ..image import Image
from ..ocio import OcioView

DPI = 160  # pixels of a picture per inch of the sheet
FONT_PT = 7.0  # size of the labels


def save_sheet(
    pictures: Sequence[tuple[str, Image]],
    path: str | os.PathLike[str],
    columns: int = 3,
    *,
    tone: str | OcioView = "film",
    theme: str = "light",
) -> None:
    """Writes (label, image) pairs as .png, .jpg, .tif, .webp, .svg or .pdf, without resampling if all images have the
    same width.

    Raises ImageFileError, and InputError for no pictures, no columns or an unknown theme.
    """
    save_labelled([(label, image.developed(tone)) for label, image in pictures], path, columns, theme=theme)


def save_labelled(
    pictures: Sequence[tuple[str, NDArray[Any]]],
    path: str | os.PathLike[str],
    columns: int,
    *,
    theme: str = "light",
) -> None:
    """Writes a sheet of labelled pictures that are developed already, arrays (rows, columns, 3); see save_sheet()."""
    target = check_figure_target(path)
    if not pictures or columns < 1:
        raise InputError("a sheet needs at least one picture and one column")
    columns = min(columns, len(pictures))
    rows = math.ceil(len(pictures) / columns)
    width, height = (max(size) / DPI for size in zip(*(pixels.shape[1::-1] for _, pixels in pictures), strict=True))
    # Letters per line: the average width of a letter is 0.6 times the font size. Lengths in inches, 72 points each.
    letters = max(8, int(width * 72 / (0.6 * FONT_PT)))
    labels = [_wrapped(label, letters) for label, _ in pictures]
    gap, line = 0.12, 0.1 + 1.3 * FONT_PT / 72 * (1 + max(label.count("\n") for label in labels))
    size = columns * (width + gap) + gap, rows * (height + line + gap) + gap
    with themed(theme, FONT_PT):
        figure = new_figure(*size)
        figure.set_layout_engine("none")
        for index, (label, (_, pixels)) in enumerate(zip(labels, pictures, strict=True)):
            row, column = divmod(index, columns)
            left, bottom = gap + column * (width + gap), size[1] - (row + 1) * (height + line + gap) + line
            axes = figure.add_axes((left / size[0], bottom / size[1], width / size[0], height / size[1]))
            axes.imshow(pixels, interpolation="nearest")
            axes.set_axis_off()
            # A dollar sign in a lens name must not begin a formula.
            figure.text(left / size[0], (bottom - 0.06) / size[1], label, va="top", parse_math=False)
    save_figure(figure, target, dpi=DPI)


def _wrapped(label: str, letters: int) -> str:
    """Wraps a label after commas; breaks within a phrase only if the phrase is longer than a line."""
    phrases = re.sub("(?<!,) ", "\N{NO-BREAK SPACE}", label)
    return "\n".join(textwrap.wrap(phrases, letters, break_on_hyphens=False))
