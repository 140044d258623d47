"""What a shot calls for."""

from __future__ import annotations

from collections.abc import Iterable

from . import _core
from ._core import Camera, Plan, Scene
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
