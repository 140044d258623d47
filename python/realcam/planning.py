"""What a shot calls for."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from . import _core
from ._core import Camera, Plan, RenderSettings, Scene
from .settings import settings_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._core import _SettingWords


def plan(
    scene: Scene,
    camera: Camera,
    settings: RenderSettings | None = None,
    *,
    device: str = "auto",
    times: bool = False,
    **changes: Unpack[_SettingWords],
) -> Plan:
    """Says which effects and which camera model a picture needs, and which it may do without, each with its size.

    Sizes come from the lens's rays, from closed forms and from a small picture of the scene: in pixels of the film, or
    in 8-bit codes of the developed picture. What is smaller than its threshold is left out.
    settings, also by their names, as in plan(scene, camera, quality="draft"): those of render. Of the effects, what is
    named is kept, with a "-" before it left out. A camera whose model is not "full" keeps it.
    times: also measure what each effect adds to the picture's time on this device, which takes some tenths of a second
    each.

    Raises InputError; NothingToPlan, one of these, where the camera sees neither an object nor light;
    SceneFileError, DeviceError; KeyboardInterrupt on Ctrl-C.
    """
    if "effects" in changes:
        changes["effects"] = _with_auto(changes["effects"])
    wanted = settings_of(settings, changes)
    if "auto" not in wanted.effects:
        wanted = wanted.with_(effects=_with_auto(wanted.effects))
    return _core._plan(scene, camera, wanted, device, times)


def _with_auto(effects: str | Iterable[str] | None) -> tuple[str, ...]:
    """With all others left to the planner."""
    is_list = isinstance(effects, Iterable) and not isinstance(effects, str)
    return ("auto", *effects) if is_list else ("auto",) if effects is None else ("auto", effects)  # type: ignore


class Settled(NamedTuple):
    """What a picture is taken with once "auto" is decided."""

    camera: Camera
    settings: RenderSettings
    summary: str  # Plan.summary; empty: nothing was left to decide


def settled(scene: Scene, camera: Camera, settings: RenderSettings, device: str, stacklevel: int) -> Settled:
    """Decides what is left to the planner.

    Warns, `stacklevel` calls up, where there is nothing to plan; raises what plan raises else.
    """
    return settled_film(scene, [camera], settings, device, stacklevel + 1)


def settled_film(
    scene: Scene, cameras: Sequence[Camera], settings: RenderSettings, device: str, stacklevel: int
) -> Settled:
    """The same for frames of a film, given by their cameras, together. The camera is the first one."""
    camera, *others = cameras
    model, settings, summary, warning = _core._settle_film(scene, camera, others, settings, device)
    if warning:
        warnings.warn(warning, stacklevel=stacklevel + 1)
    return Settled(camera if model == camera.model else camera.replace(model=model), settings, summary)
