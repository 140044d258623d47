"""The parts of the page that are our own components."""

from __future__ import annotations

from typing import Any

from nicegui.element import Element

from .._core import effects, glass_names
from .effect_switches import EFFECTS


class PictureCanvas(Element, component="static/picture_canvas.js"):
    """The streamed picture. Emits "picked" with u and v where the user has clicked."""

    def __init__(self, path: str) -> None:
        super().__init__()
        self._props["path"] = path


class LensDrawing(Element, component="static/lens_drawing.js"):
    """The section of the lens and the table of its surfaces."""

    def __init__(self, path: str) -> None:
        super().__init__()
        self._props["path"] = path
        self._props["glasses"] = glass_names()


class CostPanel(Element, component="static/cost_panel.js"):
    """Effects with their switches, and where the time goes."""

    def __init__(self, path: str) -> None:
        super().__init__()
        self._props["path"] = path
        self._props["effects"] = _switchable()


def _switchable() -> list[dict[str, Any]]:
    helps = dict(line.split(": ", 1) for line in effects())
    return [{"name": name, "help": helps[name]} for name in EFFECTS]
