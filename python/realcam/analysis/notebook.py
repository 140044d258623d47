"""Notebook representations of analysis results: their plots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..drawing.figure_files import NOTEBOOK_DPI, figure_bytes
from .kinds import KINDS, plot_figure
from .mtf import Mtf

KIND_OF: dict[type, str] = {}
for _name, _kind in KINDS.items():
    KIND_OF.setdefault(_kind.data, _name)  # a type's first plot is its default


def kind_of(data: Any) -> str:
    """Name of the plot of a result. MTF is plotted through focus, over the field or over frequency, by its shape."""
    if isinstance(data, Mtf):
        planes, fields, frequencies = data.tangential.shape
        if planes > 1:
            return "mtf-focus"
        return "mtf-field" if fields > frequencies else "mtf"
    return KIND_OF[type(data)]


def png(data: Any) -> bytes:
    """PNG of the plot of a result."""
    return figure_bytes(plot_figure(kind_of(data), data, size="small"), ".png", NOTEBOOK_DPI)


_repr: Callable[[Any], bytes] = png
for _type in KIND_OF:
    _type._repr_png_ = _repr  # type: ignore[attr-defined]
