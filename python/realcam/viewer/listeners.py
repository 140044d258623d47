"""Callbacks from a bench to its window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .._core import Plan
from ..photography import SharpRange
from .pictures.picture_request import Frame


@dataclass(frozen=True)
class Problem:
    """Reason why the last request had no effect.

    surface: index of the lens surface that is the cause; None: no single surface. view: "lens" or "picture", the view
    beside which the message is shown.
    """

    message: str
    surface: int | None = None
    view: str = "lens"


@dataclass
class Listeners:
    """Callbacks, called on any thread. Each call replaces the values of the previous call of the same kind."""

    #: A frame of the picture in slot "a", or of the compared one in slot "b".
    frame: Callable[[str, Frame], None] = lambda slot, frame: None
    controls: Callable[[], None] = lambda: None  #: the camera's settings have changed
    lens: Callable[[dict[str, Any]], None] = lambda view: None  #: lens_view.lens_view()
    rays: Callable[[dict[str, Any]], None] = lambda view: None  #: lens_view.ray_view()
    problem: Callable[[Problem | None], None] = lambda problem: None  #: None: the last problem has ended
    plan: Callable[[Plan | None, str], None] = lambda plan, note: None  #: None: no plan; the note may have the reason
    #: level_costs.measured_levels(): levels of simulation and a note.
    levels: Callable[[list[dict[str, Any]], str], None] = lambda levels, note: None
    state: Callable[[dict[str, Any]], None] = lambda state: None  #: bench_state.state_of()
    sharp_range: Callable[[SharpRange], None] = lambda sharp: None  #: depth of field; nan if nothing is sharp

    def leave(self) -> None:
        """Replaces all callbacks by functions that do nothing."""
        self.__dict__.update(vars(Listeners()))
