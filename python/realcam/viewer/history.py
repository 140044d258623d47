"""Undo and redo."""

from __future__ import annotations

from typing import Generic, TypeVar

T = TypeVar("T")
_MOST_STEPS = 200


class History(Generic[T]):
    """Undo history: a sequence of states with a current one."""

    def __init__(self, first: T) -> None:
        self._states, self._at = [first], 0
        self._gesture: object = None

    @property
    def now(self) -> T:
        return self._states[self._at]

    @property
    def can_undo(self) -> bool:
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        return self._at + 1 < len(self._states)

    def push(self, state: T, gesture: object = None) -> None:
        """Adds a state. States of one `gesture`, such as a drag, replace each other and are undone in one step."""
        if gesture is not None and gesture == self._gesture:
            self._states[self._at] = state
            return
        self._gesture = gesture
        self._states[self._at + 1 :] = [state]
        del self._states[:-_MOST_STEPS]
        self._at = len(self._states) - 1

    def undo(self) -> T:
        self._gesture = None
        self._at = max(0, self._at - 1)
        return self.now

    def redo(self) -> T:
        self._gesture = None
        self._at = min(len(self._states) - 1, self._at + 1)
        return self.now
