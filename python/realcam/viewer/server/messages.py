"""JSON messages of the stream. Messages from a browser are validated before they are performed."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from functools import wraps
from typing import Any

from ..._core import InputError
from ...json_values import json_value
from ...tolerance.grades import GRADES
from .. import lens_edits
from ..lens_bench import LensBench

MAX_BYTES = 64 * 1024  # of a message from a browser
_SUMMED = {"orbit": ("x", "y"), "pan": ("x", "y"), "dolly": ("steps",)}  # keys that are summed over pending messages
_REPLACED = ("hover",)  # only the last pending message counts
_PICTURE_MESSAGES = ("orbit", "pan", "dolly", "focus", "meter", "turn", "switch", "levels")

#: A message as parsed from JSON: "type", a key of _ACTIONS, and the arguments of its action.
Message = dict[str, Any]


def json_text(content: dict[str, Any]) -> str:
    """Returns strict JSON for the browser: infinite and undefined numbers become null."""
    try:
        return json.dumps(content, allow_nan=False)
    except ValueError:
        return json.dumps(json_value(content), allow_nan=False)


class BadMessage(Exception):  # noqa: N818
    """A message that our page never sends."""


def parsed(text: str) -> Message:
    """Parses a message. Raises BadMessage if it is malformed or of an unknown type."""
    if len(text) > MAX_BYTES:
        raise BadMessage("the message is too long")
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        raise BadMessage("the message is not valid JSON") from None
    if not isinstance(message, dict) or str(message.get("type")) not in _ACTIONS:
        raise BadMessage("the message has an unknown type")
    return message


def merged(pending: Message, newer: Message) -> Message | None:
    """Returns one message that replaces two consecutive ones, or None if both must be performed."""
    kind = newer["type"]
    if pending["type"] != kind:
        return None
    if kind in _SUMMED:
        return {"type": kind, **{key: _real(pending, key) + _real(newer, key) for key in _SUMMED[kind]}}
    if kind in _REPLACED:
        return newer
    same = ("surface", "field", "gesture")
    if kind == "edit" and newer.get("gesture") and all(pending.get(key) == newer.get(key) for key in same):
        return newer
    return None


def subject(message: Message) -> str:
    """View that a message concerns, "lens" or "picture"; see Problem."""
    return "picture" if message["type"] in _PICTURE_MESSAGES else "lens"


def perform(message: Message, bench: LensBench) -> None:
    """Performs a message. Raises BadMessage if it is malformed, and InputError if the request is invalid."""
    _ACTIONS[message["type"]](message, bench)


def _real(message: Message, key: str) -> float:
    """Returns a finite number of the message, clamped to +-1e6. Raises BadMessage."""
    value = message.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise BadMessage(f'"{key}" must be a number')
    bounded = min(max(value, -1e6), 1e6)  # an integer of JSON may be larger than any float
    if not math.isfinite(value if isinstance(value, float) else bounded):
        raise BadMessage(f'"{key}" must be a number')
    return float(bounded)


def _index(message: Message, key: str = "surface") -> int:
    value = message.get(key)
    if isinstance(value, bool) or not isinstance(value, int):
        raise BadMessage(f'"{key}" must be an integer')
    return value


def _picture_point(message: Message) -> tuple[float, float]:
    u, v = _real(message, "u"), _real(message, "v")
    if not (0 <= u <= 1 and 0 <= v <= 1):
        raise BadMessage("u and v must lie between 0 and 1")
    return u, v


def _text(message: Message, key: str) -> str:
    value = message.get(key)
    if not isinstance(value, str) or len(value) > 200:
        raise BadMessage(f'"{key}" must be a short text')
    return value


def _edit(message: Message, bench: LensBench) -> None:
    surface, field, value = _index(message), _text(message, "field"), message.get("value")
    if not isinstance(value, str | int | float | None) or isinstance(value, bool):
        raise BadMessage('"value" must be a number or a text')
    gesture = message.get("gesture")
    if gesture is not None and not isinstance(gesture, int):
        raise BadMessage('"gesture" must be an integer')
    bench.edit_value(surface, field, value, gesture)


def _insert(message: Message, bench: LensBench) -> None:
    surface = _index(message)
    bench.edit(lambda lens: lens_edits.with_plate(lens, surface))


def _remove(message: Message, bench: LensBench) -> None:
    surface = _index(message)
    bench.edit(lambda lens: lens_edits.without(lens, surface))


def _swap(message: Message, bench: LensBench) -> None:
    surface, other = _index(message), _index(message, "other")
    bench.edit(lambda lens: lens_edits.swapped(lens, surface, other))


def _another_copy(message: Message, bench: LensBench) -> None:
    grade = _text(message, "grade")
    if grade not in GRADES:
        raise BadMessage('"grade" must be one of ' + ", ".join(GRADES))
    bench.another_copy(grade)


def _known(action: Callable[[Message, LensBench], Any]) -> Callable[[Message, LensBench], Any]:
    """Wraps an action whose InputErrors can only be caused by messages that our page never sends."""

    @wraps(action)
    def checked(message: Message, bench: LensBench) -> Any:
        try:
            return action(message, bench)
        except InputError as error:
            raise BadMessage(str(error)) from None

    return checked


@_known
def _turn(message: Message, bench: LensBench) -> None:
    bench.turn(_text(message, "ring"), max(-100, min(100, _index(message, "steps"))))


def _restore(message: Message, bench: LensBench) -> None:
    state = message.get("state")
    if not isinstance(state, dict):
        raise BadMessage('"state" must be an object')
    bench.restore(state)


@_known
def _cut(message: Message, bench: LensBench) -> None:
    bench.cut(_text(message, "plane"))


@_known
def _switch(message: Message, bench: LensBench) -> None:
    bench.switch(_text(message, "effect"), _text(message, "state"))


_ACTIONS: dict[str, Callable[[Message, LensBench], Any]] = {
    "orbit": lambda m, bench: bench.orbit(_real(m, "x"), _real(m, "y")),
    "pan": lambda m, bench: bench.pan(_real(m, "x"), _real(m, "y")),
    "dolly": lambda m, bench: bench.dolly(max(-20.0, min(20.0, _real(m, "steps")))),
    "focus": lambda m, bench: bench.focus_at(*_picture_point(m)),
    "meter": lambda m, bench: bench.meter_at(*_picture_point(m)),
    "hover": lambda m, bench: bench.hover(*_picture_point(m)),
    "edit": _edit,
    "insert": _insert,
    "remove": _remove,
    "swap": _swap,
    "another_copy": _another_copy,
    "undo": lambda m, bench: bench.undo(),
    "redo": lambda m, bench: bench.redo(),
    "turn": _turn,
    "restore": _restore,
    "cut": _cut,
    "levels": lambda m, bench: bench.measure_levels(),
    "switch": _switch,
}
