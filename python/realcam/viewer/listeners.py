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

    surface: index of the lens surface that is the cause; None: no single surface. of: view beside which the message is
    shown, "lens" or "picture".
    """

    message: str
    surface: int | None = None
    of: str = "lens"


@dataclass
class Listeners:
    """Callbacks, called on any thread. Each call replaces the values of the previous call of the same kind."""

    frame: Callable[[str, Frame], None] = lambda slot, frame: None
    controls: Callable[[], None] = lambda: None
    lens: Callable[[dict[str, Any]], None] = lambda view: None
    rays: Callable[[dict[str, Any]], None] = lambda view: None
    problem: Callable[[Problem | None], None] = lambda problem: None
    plan: Callable[[Plan | None, str], None] = lambda plan, note: None
    rungs: Callable[[list[dict[str, Any]], str], None] = lambda rungs, note: None
    state: Callable[[dict[str, Any]], None] = lambda state: None
    sharp_range: Callable[[SharpRange], None] = lambda sharp: None

    def leave(self) -> None:
        """Replaces all callbacks by functions that do nothing."""
        self.__dict__.update(vars(Listeners()))
