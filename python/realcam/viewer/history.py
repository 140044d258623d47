"""Undo and redo."""

from __future__ import annotations

from typing import Generic, TypeVar

T = TypeVar("T")
_MAX_STEPS = 200


class History(Generic[T]):
    """Undo history: a sequence of states with a current one."""

    def __init__(self, first: T) -> None:
        self._states, self._index = [first], 0
        self._gesture: object = None

    @property
    def now(self) -> T:
        """The current state."""
        return self._states[self._index]

    @property
    def can_undo(self) -> bool:
        return self._index > 0

    @property
    def can_redo(self) -> bool:
        return self._index + 1 < len(self._states)

    def push(self, state: T, gesture: object = None) -> None:
        """Adds a state. States of one `gesture`, such as a drag, replace each other and are undone in one step."""
        if gesture is not None and gesture == self._gesture:
            self._states[self._index] = state
            return
        self._gesture = gesture
        self._states[self._index + 1 :] = [state]
        del self._states[:-_MAX_STEPS]
        self._index = len(self._states) - 1

    def undo(self) -> T:
        """Returns to the previous state, if there is one. Returns the current state."""
        self._gesture = None
        self._index = max(0, self._index - 1)
        return self.now

    def redo(self) -> T:
        """Returns to the next state, if there is one. Returns the current state."""
        self._gesture = None
        self._index = min(len(self._states) - 1, self._index + 1)
        return self.now
