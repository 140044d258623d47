"""What a shot calls for."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import Any, NamedTuple

from . import _core
from ._core import Camera, NothingToPlan, Plan, Scene
from .effect_names import effect_list


def plan(
    scene: Scene,
    camera: Camera,
    *,
    device: str = "auto",
    seed: int = 0,
    max_bounces: int = 1,
    threads: int = 0,
    effects: str | Iterable[str] = "auto",
    quality: str = "photo",
    threshold_px: float | None = None,
    threshold_codes: float | None = None,
    times: bool = False,
) -> Plan:
    """Says which effects and which camera model a picture needs, and which it may do without, each with its size.

    Sizes come from the lens's rays, from closed forms and from a small picture of the scene: in pixels of the film, or
    in 8-bit codes of the developed picture. What is smaller than its threshold is left out. quality: "draft" (2 pixels,
    4 codes), "photo" (0.5, 1) or "reference" (0.1, 0.25); threshold_px and threshold_codes go before it.
    effects: what is named is kept, with a "-" before it left out. A camera whose model is not "full" keeps it.
    times: also measure what each effect adds to the picture's time on this device, which takes some tenths of a second
    each.

    Raises InputError; NothingToPlan, one of these, where the camera sees neither an object nor light;
    SceneFileError, DeviceError; KeyboardInterrupt on Ctrl-C.
    """
    return _core._plan(
        scene,
        camera,
        device,
        seed,
        max_bounces,
        threads,
        effect_list(effects),
        quality,
        threshold_px,
        threshold_codes,
        times,
    )


class Settled(NamedTuple):
    """What a picture is taken with once "auto" is decided."""

    camera: Camera
    effects: list[str]
    illuminant: str
    summary: str  # Plan.summary; empty: nothing was left to decide


def settled(
    scene: Scene, camera: Camera, effects: list[str], illuminant: str, stacklevel: int, **settings: Any
) -> Settled:
    """Decides where "auto" is among the effects. `settings`: of plan.

    Warns, `stacklevel` calls up, where there is nothing to plan; raises what plan raises else.
    """
    if "auto" not in effects:
        return Settled(camera, effects, illuminant, "")
    summary = ""
    try:
        choice = plan(scene, camera, effects=effects, **settings)
        camera, effects, summary = camera.replace(model=choice.model), choice.effects, choice.summary
    except NothingToPlan as nothing:
        warnings.warn(f"{nothing}; the picture has the effects that are named", stacklevel=stacklevel + 1)
        effects = [name for name in effects if name != "auto"]
    if not {"dispersion", "diffraction"} & set(effects):
        illuminant = ""
    return Settled(camera, effects, illuminant, summary)
