"""The parts of the page that are our own components."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments
from nicegui.slot import Slot

from .._core import effects, glass_names
from .effect_switches import EFFECTS
from .lens_cards import lens_cards


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


class LensGallery(Element, component="static/lens_gallery.js"):
    """A button, and the bundled lenses in a dialog that it opens. Emits "chosen" with the name of one."""

    def __init__(self) -> None:
        super().__init__()
        self._props["lenses"] = lens_cards()


class TabbedPanels(Element, component="static/tabbed_panels.js"):
    """A row of tabs. panel(name) is the context of a panel's content; what is in none of them stands below the tabs."""

    def __init__(self, *names: str) -> None:
        """The first panel is shown at first."""
        super().__init__()
        self._props["names"] = list(names)
        self.shown = names[0]
        self.on("shown", self._take_shown)

    def panel(self, name: str) -> Slot:
        return self.add_slot(name)

    def _take_shown(self, event: GenericEventArguments) -> None:
        self.shown = event.args


class HelpDialog(Element, component="static/help_dialog.js"):
    """A button, and what mouse and keys do in a dialog that it opens."""


class RingSlider(Element, component="static/ring.js"):
    """A slider of whole steps. What it shows while it is turned is where the hand is; else what set() has said.

    gesture: counts drags and key presses; that of the last turn.
    """

    def __init__(self, label: str, help: str, turned: Callable[[int], Awaitable[None]]) -> None:
        """turned: does what a turn to that step means, after which set() has said how the ring stands."""
        super().__init__()
        self._props |= {"label": label, "help": help, "last": 0, "step": 0, "text": "", "answered": 0}
        self.gesture: object = None

        async def take(event: GenericEventArguments) -> None:
            asked = event.args if isinstance(event.args, dict) else {}
            step, turn, self.gesture = asked.get("step"), asked.get("turn"), asked.get("gesture")
            if isinstance(step, int) and 0 <= step <= self._props["last"]:
                await turned(step)
            self._props["answered"] = turn
            self.update()

        self.on("turned", take, throttle=0.09)

    def set(self, step: int, last: int, text: str) -> None:
        """text: what is engraved there."""
        state = {"step": step, "last": last, "text": text}
        if any(self._props[key] != value for key, value in state.items()):
            self._props |= state
            self.update()


def show_choice(choice: ui.select, options: dict[Any, str] | list[str], value: Any) -> None:
    """Nothing is sent where all is as it was: a list that is set anew is drawn anew."""
    if choice.options != options:
        choice.set_options(options, value=value)
    else:
        choice.set_value(value)


class CostPanel(Element, component="static/cost_panel.js"):
    """Effects with their switches, and where the time goes."""

    def __init__(self, path: str) -> None:
        super().__init__()
        self._props["path"] = path
        self._props["effects"] = _switchable()


def _switchable() -> list[dict[str, Any]]:
    return [{"name": effect.name, "help": effect.description} for effect in effects() if effect.name in EFFECTS]
