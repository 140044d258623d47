"""What a bench tells its window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .._core import Plan
from ..photography import SharpRange
from .picture_request import Frame


@dataclass(frozen=True)
class Problem:
    """Why what was asked for last is not shown.

    surface: index of the lens's surface that is to blame, if one is. of: what it is told beside, "lens" or "picture".
    """

    message: str
    surface: int | None = None
    of: str = "lens"


@dataclass
class Listeners:
    """What a window is told, on any thread. Each replaces what was told before of the same."""

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
        """Nobody is told anything any more."""
        self.__dict__.update(vars(Listeners()))
