"""Valid and invalid messages of a browser to the lens bench."""

from __future__ import annotations

import json
import math
from unittest.mock import Mock

import pytest
import realcam as rc
from realcam.viewer.camera_controls import CameraControls
from realcam.viewer.lens_bench import LensBench
from realcam.viewer.server.messages import MAX_BYTES, BadMessage, json_text, merged, parsed, perform


def bench() -> Mock:
    made = Mock(spec=LensBench)
    made.controls = CameraControls.of(rc.Camera(rc.Lens.load("double-gauss-50mm")))
    made.turn.side_effect = lambda ring, steps: LensBench.turn(made, ring, steps) if ring == "barrel" else True
    made.switch.side_effect = lambda effect, state: LensBench.switch(made, effect, state)
    return made


MALFORMED = [
    *("", "{", "nonsense", "[]", "3", "null", '"orbit"', "{}", '{"type": "quit"}', '{"type": null}', '{"type": []}'),
    *('{"type": {}}', '{"type": ["orbit"]}', "[" * 100_000, '{"type":' * 5000, "9" * 5000, "\0"),
    '{"type": "orbit", "x": 0, "y": 0' + " " * MAX_BYTES + "}",
]


@pytest.mark.parametrize("text", MALFORMED, ids=lambda text: text[:20])
def test_what_is_no_message(text: str) -> None:
    with pytest.raises(BadMessage):
        parsed(text)


WRONG = [
    {"type": "orbit"},
    {"type": "orbit", "x": "1", "y": 0},
    {"type": "orbit", "x": True, "y": 0},
    {"type": "orbit", "x": None, "y": 0},
    {"type": "orbit", "x": [1], "y": 0},
    {"type": "orbit", "x": float("nan"), "y": 0},
    {"type": "pan", "x": 0, "y": float("inf")},
    {"type": "dolly", "steps": float("-inf")},
    {"type": "focus", "u": 1.5, "v": 0},
    {"type": "focus", "u": 0.5},
    {"type": "meter", "u": -0.1, "v": 0},
    {"type": "hover", "u": float("nan"), "v": 0},
    {"type": "edit", "surface": 0.5, "field": "radius_mm", "value": 1},
    {"type": "edit", "surface": True, "field": "radius_mm", "value": 1},
    {"type": "edit", "surface": 0, "field": 3, "value": 1},
    {"type": "edit", "surface": 0, "field": "x" * 300, "value": 1},
    {"type": "edit", "surface": 0, "field": "radius_mm", "value": {}},
    {"type": "edit", "surface": 0, "field": "radius_mm", "value": True},
    {"type": "edit", "surface": 0, "field": "radius_mm", "value": 1, "gesture": "a"},
    {"type": "insert", "surface": "0"},
    {"type": "remove"},
    {"type": "swap", "surface": 0},
    {"type": "turn", "ring": "barrel", "steps": 1},
    {"type": "turn", "ring": "iso", "steps": 0.5},
    {"type": "switch", "effect": "gravity", "state": "on"},
    {"type": "switch", "effect": "dispersion", "state": "perhaps"},
]


@pytest.mark.parametrize("message", WRONG, ids=str)
def test_a_message_with_wrong_values(message: dict) -> None:
    made = bench()
    with pytest.raises(BadMessage):
        perform(parsed(json.dumps(message)), made)
    assert made._apply.call_count == 0
    for change in ("change", "orbit", "pan", "dolly", "focus_at", "meter_at", "hover", "edit"):
        assert getattr(made, change).call_count == 0


def test_numbers_are_bounded() -> None:
    made = bench()
    perform(parsed('{"type": "orbit", "x": 1e300, "y": -1e300}'), made)
    made.orbit.assert_called_once_with(1e6, -1e6)
    perform({"type": "pan", "x": 0, "y": 10**400}, made)
    made.pan.assert_called_once_with(0, 1e6)
    perform(parsed('{"type": "dolly", "steps": 1e9}'), made)
    made.dolly.assert_called_once_with(20.0)
    perform({"type": "turn", "ring": "iso", "steps": -(10**30)}, made)
    made.turn.assert_called_once_with("iso", -100)


def test_moves_that_wait_become_one() -> None:
    one = merged({"type": "orbit", "x": 0.1, "y": 0.2}, {"type": "orbit", "x": 0.3, "y": -0.1})
    assert one == {"type": "orbit", "x": pytest.approx(0.4), "y": pytest.approx(0.1)}
    assert merged({"type": "orbit", "x": 0.1, "y": 0}, {"type": "pan", "x": 0.1, "y": 0}) is None
    newer = {"type": "hover", "u": 0.9, "v": 0.9}
    assert merged({"type": "hover", "u": 0.1, "v": 0.1}, newer) is newer
    # Each click and each turn counts, so they are not merged.
    assert merged({"type": "focus", "u": 0, "v": 0}, {"type": "focus", "u": 1, "v": 1}) is None
    assert merged({"type": "turn", "ring": "iso", "steps": 1}, {"type": "turn", "ring": "iso", "steps": 1}) is None
    assert merged({"type": "undo"}, {"type": "undo"}) is None


def test_only_the_last_step_of_a_drag_is_done() -> None:
    drag = {"type": "edit", "surface": 2, "field": "radius_mm", "value": 30, "gesture": 7}
    newer = {**drag, "value": 31}
    assert merged(drag, newer) is newer
    assert merged(drag, {**newer, "surface": 3}) is None
    assert merged(drag, {**newer, "gesture": 8}) is None
    typed = {"type": "edit", "surface": 2, "field": "radius_mm", "value": 30}
    assert merged(typed, {**typed, "value": 31}) is None  # each is a step of undo


def test_merging_looks_at_what_it_adds() -> None:
    with pytest.raises(BadMessage):
        merged({"type": "orbit", "x": "1", "y": 0}, {"type": "orbit", "x": 1, "y": 0})


def test_what_the_user_cannot_have_is_no_bad_message() -> None:
    made = bench()
    lens = rc.Lens.load("tessar-50mm")
    made.edit.side_effect = lambda edited, gesture=None: edited(lens)
    made.edit_value.side_effect = lambda *edit: LensBench.edit_value(made, *edit)
    edit = {"type": "edit", "surface": 0, "field": "glass"}
    for message in (
        {"type": "remove", "surface": 99},
        {"type": "insert", "surface": -5},
        {"type": "swap", "surface": 0, "other": 10**9},
        {**edit, "value": "no such glass"},
        {**edit, "value": "\ud800"},
    ):
        with pytest.raises(rc.RealcamError) as refused:
            perform(parsed(json.dumps(message)), made)
        assert not isinstance(refused.value, BadMessage), message


def test_the_browser_gets_json_whatever_the_numbers() -> None:
    content = {"size": math.inf, "rows": [{"a": math.nan, "b": (1.5, -math.inf)}], "text": "Infinity", "none": None}
    expected = {"size": None, "rows": [{"a": None, "b": [1.5, None]}], "text": "Infinity", "none": None}
    assert json.loads(json_text(content), parse_constant=pytest.fail) == expected
    assert json.loads(json_text(expected)) == expected
