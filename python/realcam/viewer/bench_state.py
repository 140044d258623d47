"""State of a bench that its page stores, to restore it after a restart of the server."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from .._core import Film, InputError
from .camera_controls import CameraControls
from .lens_reading import lens_from
from .pose import Pose


def state_of(controls: CameraControls, switches: dict[str, str]) -> dict[str, Any]:
    """Returns the state as JSON values. The lens is stored as the text of its file. switches: Switches.states."""
    content, _ = controls.lens._file_content("lens.toml")
    return {
        "name": controls.lens.name or "lens",
        "lens": content.decode(),
        "zoom": controls.zoom,
        "f_number": controls.f_number,
        "focus_m": None if math.isinf(controls.focus_m) else controls.focus_m,
        "film_shift_mm": list(controls.film.shift_mm),
        "film": [controls.film.width_mm, controls.film.height_mm, *controls.film.resolution],
        "pose": [*controls.pose.position_m, *controls.pose.look_at_m, *controls.pose.up],
        "model": controls.model,
        "is_automatic": controls.is_automatic,
        "switches": switches,
        "exposure_time_s": controls.exposure_time_s,
        "iso": controls.iso,
        "compensation_ev": controls.compensation_ev,
    }


def restored(before: CameraControls, state: dict[str, Any]) -> CameraControls:
    """Returns the controls with a stored state. Raises InputError if the state was not written by state_of."""
    name = "".join(c for c in _text(state, "name") if c.isalnum() or c in "-_. ")[:60] or "lens"
    lens, _ = lens_from(f"{name}.toml", _text(state, "lens").encode(errors="replace"))
    width_mm, height_mm, columns, rows = _numbers(state, "film", 4)
    if not (columns.is_integer() and rows.is_integer()):
        raise InputError("the page's stored state has a film whose size in pixels is not an integer")
    right_mm, up_mm = _numbers(state, "film_shift_mm", 2) if "film_shift_mm" in state else (0.0, 0.0)
    pose = _numbers(state, "pose", 9)
    controls = replace(
        before.with_lens(lens),
        film=Film(width_mm, height_mm, (int(columns), int(rows)), shift_mm=(right_mm, up_mm)),
        pose=Pose((pose[0], pose[1], pose[2]), (pose[3], pose[4], pose[5]), (pose[6], pose[7], pose[8])),
        f_number=None if state.get("f_number") is None else _number(state, "f_number"),
        focus_m=math.inf if state.get("focus_m") is None else _number(state, "focus_m"),
        model=_text(state, "model"),
        is_automatic=state.get("is_automatic") is True,
        exposure_time_s=_number(state, "exposure_time_s"),
        iso=_number(state, "iso"),
        compensation_ev=_number(state, "compensation_ev"),
    )
    zoom = state.get("zoom")
    if isinstance(zoom, str | None):
        return replace(controls, zoom=zoom) if zoom in lens.zoom_positions else controls
    return replace(controls, zoom=_number(state, "zoom"))


def _text(state: dict[str, Any], key: str) -> str:
    value = state.get(key)
    if not isinstance(value, str):
        raise InputError(f'the page\'s stored state has no text "{key}"')
    return value


def _number(state: dict[str, Any], key: str) -> float:
    value = state.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(f'the page\'s stored state has no number "{key}"')
    return float(value)


def _numbers(state: dict[str, Any], key: str, count: int) -> list[float]:
    values = state.get(key)
    if not isinstance(values, list) or len(values) != count:
        raise InputError(f'the page\'s stored state has no list "{key}" of {count} numbers')
    return [_number({key: value}, key) for value in values]
