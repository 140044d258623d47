"""State of a bench that its page stores, to restore it after a restart of the server."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple, get_type_hints

from .._core import Film, InputError
from .camera_controls import CameraControls
from .lens_reading import lens_from
from .pose import Pose


def state_of(controls: CameraControls, switches: dict[str, str]) -> dict[str, Any]:
    """Returns the state as JSON values. The lens is stored as the text of its file. switches: Switches.states."""
    content, _ = controls.lens._file_content("lens.toml")
    settings = {name: form.write(getattr(controls, name)) for name, form in _FORMS.items()}
    return {"name": controls.lens.name or "lens", "lens": content.decode(), "switches": switches, **settings}


def restored(before: CameraControls, state: dict[str, Any]) -> CameraControls:
    """Returns the controls with a stored state. Raises InputError if the state was not written by state_of."""
    name = "".join(c for c in _text(state, "name") if c.isalnum() or c in "-_. ")[:60] or "lens"
    lens, _ = lens_from(f"{name}.toml", _text(state, "lens").encode(errors="replace"))
    mounted = before.with_lens(lens)
    settings = {name: form.read(state, name) for name, form in _FORMS.items()}
    if not isinstance(settings["zoom"], float) and settings["zoom"] not in lens.zoom_positions:
        settings["zoom"] = mounted.zoom
    return replace(mounted, **settings)


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


def _number_or_none(state: dict[str, Any], key: str) -> float | None:
    return None if state.get(key) is None else _number(state, key)


def _text_number_or_none(state: dict[str, Any], key: str) -> str | float | None:
    value = state.get(key)
    return value if isinstance(value, str | None) else _number(state, key)


def _film(state: dict[str, Any], key: str) -> Film:
    width_mm, height_mm, columns, rows, right_mm, up_mm = _numbers(state, key, 6)
    if not (columns.is_integer() and rows.is_integer()):
        raise InputError("the page's stored state has a film whose size in pixels is not an integer")
    return Film(width_mm, height_mm, (int(columns), int(rows)), shift_mm=(right_mm, up_mm))


def _pose(state: dict[str, Any], key: str) -> Pose:
    at = _numbers(state, key, 9)
    return Pose((at[0], at[1], at[2]), (at[3], at[4], at[5]), (at[6], at[7], at[8]))


class _Form(NamedTuple):
    """JSON form of a value. read: of a key of the state; raises InputError if the state has no such value there."""

    write: Callable[[Any], Any]
    read: Callable[[dict[str, Any], str], Any]


def _unchanged(value: Any) -> Any:
    return value


#: Forms of the fields of CameraControls, by type.
_FORMS_OF_TYPES: dict[Any, _Form] = {
    bool: _Form(_unchanged, lambda state, key: state.get(key) is True),
    float: _Form(_unchanged, _number),
    str: _Form(_unchanged, _text),
    float | None: _Form(_unchanged, _number_or_none),
    str | float | None: _Form(_unchanged, _text_number_or_none),
    Film: _Form(lambda film: [film.width_mm, film.height_mm, *film.resolution, *film.shift_mm], _film),
    Pose: _Form(lambda pose: [*pose.position_m, *pose.look_at_m, *pose.up], _pose),
}
#: Forms of the fields of CameraControls, by name, but for the lens and the geometry, which is that of the shot.
_FORMS = {
    name: _FORMS_OF_TYPES[kind]
    for name, kind in get_type_hints(CameraControls).items()
    if name not in ("lens", "geometry")
}
# An infinite number, which JSON does not have, is stored as null.
_FORMS["focus_m"] = _Form(
    lambda focus_m: None if math.isinf(focus_m) else focus_m,
    lambda state, key: math.inf if state.get(key) is None else _number(state, key),
)
