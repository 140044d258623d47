"""Custom Vue components of the page."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments
from nicegui.slot import Slot

from ..._core import effects, glass_names
from ...analysis import style
from ..effect_switches import EFFECTS
from .lens_cards import lens_cards


class PictureCanvas(Element, component="static/picture_canvas.js"):
    """The streamed picture. Emits "picked" with the u and v that the user clicked. path: of the window's WebSocket."""

    def __init__(self, path: str) -> None:
        super().__init__()
        self._props["path"] = path


class LensDrawing(Element, component="static/lens_drawing.js"):
    """Section of the lens, and table of its surfaces. path: of the window's WebSocket."""

    def __init__(self, path: str) -> None:
        super().__init__()
        self._props["path"] = path
        self._props["glasses"] = glass_names()


class LensGallery(Element, component="static/lens_gallery.js"):
    """Button that opens a dialog of the bundled lenses. Emits "chosen" with the name of a lens."""

    def __init__(self) -> None:
        super().__init__()
        self._props["lenses"] = lens_cards()


class TabbedPanels(Element, component="static/tabbed_panels.js"):
    """Row of tabs. panel(name) is the context of a panel's content; other content is placed below the tabs."""

    def __init__(self, *names: str) -> None:
        """names: of the panels; the first one is shown initially."""
        super().__init__()
        self._props["names"] = list(names)
        self.shown = names[0]
        self.on("shown", self._store_shown)

    def panel(self, name: str) -> Slot:
        return self.add_slot(name)

    def _store_shown(self, event: GenericEventArguments) -> None:
        self.shown = event.args


class HelpDialog(Element, component="static/help_dialog.js"):
    """Button that opens a dialog of mouse and keyboard controls."""


class RingSlider(Element, component="static/ring.js"):
    """Slider of integer steps. While it is dragged it shows the user's position, otherwise the one set by set().

    gesture: id of the drag or key press of the last change.
    """

    def __init__(self, label: str, help: str, turned: Callable[[int], Awaitable[None]]) -> None:
        """turned: called with the new step; must have called set() with the resulting position when it returns."""
        super().__init__()
        self._props |= {"label": label, "help": help, "last": 0, "step": 0, "text": "", "answered": 0}
        self.gesture: object = None

        async def on_turned(event: GenericEventArguments) -> None:
            arguments = event.args if isinstance(event.args, dict) else {}
            step, turn, self.gesture = arguments.get("step"), arguments.get("turn"), arguments.get("gesture")
            try:
                if isinstance(step, int) and 0 <= step <= self._props["last"]:
                    await turned(step)
            finally:  # a slider without an answer stays at the user's position
                self._props["answered"] = turn
                self.update()

        self.on("turned", on_turned, throttle=0.09)

    def set(self, step: int, last: int, text: str) -> None:
        """Sets the position. last: the last step. text: label of the position."""
        state = {"step": step, "last": last, "text": text}
        if any(self._props[key] != value for key, value in state.items()):
            self._props |= state
            self.update()


def show_choice(choice: ui.select, options: dict[Any, str] | list[str], value: Any) -> None:
    """Updates a selection. Sends nothing if it is unchanged, because setting a list redraws it."""
    if choice.options != options:
        choice.set_options(options, value=value)
    else:
        choice.set_value(value)


class CostPanel(Element, component="static/cost_panel.js"):
    """Effects with their switches, and the costs of the picture."""

    def __init__(self, path: str) -> None:
        super().__init__()
        self._props["path"] = path
        self._props["effects"] = _switchable()
        self._props["colours"] = style.PALETTE


def _switchable() -> list[dict[str, Any]]:
    """Name and description of each effect with a switch."""
    return [{"name": effect.name, "help": effect.description} for effect in effects() if effect.name in EFFECTS]
