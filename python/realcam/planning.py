"""Automatic choice of effects and camera model for a picture."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from . import _core
from ._core import Camera, Plan, RenderSettings, Scene
from .settings import settings_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._core import _SettingsKwargs


def plan(
    scene: Scene,
    camera: Camera,
    settings: RenderSettings | None = None,
    *,
    device: str = "auto",
    times: bool = False,
    **changes: Unpack[_SettingsKwargs],
) -> Plan:
    """Decides which effects and which camera model a picture requires, with the magnitude of each effect.

    Magnitudes come from rays through the lens, closed forms and a small picture of the scene: in pixels of the film, or
    in 8-bit values of the developed picture. An effect below its threshold is left out.
    settings, also as keywords, as in plan(scene, camera, quality="draft"): those of render. Effects that are named are
    kept; those named with a "-" in front are left out. A camera model other than "full" is kept.
    times: True: also measures the render time that each effect adds on this device, which takes some tenths of a second
    for each effect.

    Raises InputError; its subclass NothingToPlan if the camera sees neither an object nor light;
    SceneFileError, DeviceError; KeyboardInterrupt on Ctrl-C.
    """
    if "effects" in changes:
        changes["effects"] = _with_auto(changes["effects"])
    requested = settings_of(settings, changes)
    if "auto" not in requested.effects:
        requested = requested.with_(effects=_with_auto(requested.effects))
    return _core._plan(scene, camera, requested, device, times)


def _with_auto(effects: str | Iterable[str] | None) -> tuple[str, ...]:
    """Returns the named effects with "auto" in front, which leaves all others to the planner."""
    is_list = isinstance(effects, Iterable) and not isinstance(effects, str)
    return ("auto", *effects) if is_list else ("auto",) if effects is None else ("auto", effects)  # type: ignore


class Resolved(NamedTuple):
    """Camera and settings of a picture after "auto" is resolved."""

    camera: Camera
    settings: RenderSettings
    summary: str  # Plan.summary; empty if there was nothing to resolve


def resolved(scene: Scene, camera: Camera, settings: RenderSettings, device: str, stacklevel: int) -> Resolved:
    """Resolves the settings "auto" by the planner.

    Warns, `stacklevel` calls up, if the camera sees nothing to plan for. Otherwise raises what plan raises.
    """
    return resolved_film(scene, [camera], settings, device, stacklevel + 1)


def resolved_film(
    scene: Scene, cameras: Sequence[Camera], settings: RenderSettings, device: str, stacklevel: int
) -> Resolved:
    """Resolves "auto" once for all frames of a video. The returned camera is that of the first frame.

    cameras: those of the first frame and of other frames. stacklevel: see resolved().
    """
    camera, *others = cameras
    model, settings, summary, warning = _core._resolve_film(scene, camera, others, settings, device)
    if warning:
        warnings.warn(warning, stacklevel=stacklevel + 1)
    return Resolved(camera if model == camera.model else camera.replace(model=model), settings, summary)
