"""The function render(), which renders one picture."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING

from . import _core
from ._core import Camera, InputError, RenderSettings, Scene
from .image import Image
from .planning import resolved
from .settings import settings_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._core import _SettingsKwargs

ProgressCallback = Callable[[float], bool | None]


def warn_of_no_light(scene: Scene) -> None:
    """Warns of a scene without light. The warning names the line of the caller's caller."""
    if isinstance(scene, Scene) and not scene.has_light:
        warnings.warn(
            "the scene has no light, so that its picture is black; scene.with_daylight(camera), with_environment, "
            "with_sun or with_point_light adds some",
            stacklevel=3,
        )


def warn_of_effects(camera: Camera, settings: RenderSettings) -> None:
    """Warns of effects that the lens cannot show. The warning names the line of the caller's caller."""
    if isinstance(camera, Camera):
        for notice in _core._effect_notices(camera.lens, settings):
            warnings.warn(notice, stacklevel=3)


def render(
    scene: Scene,
    camera: Camera,
    settings: RenderSettings | None = None,
    *,
    device: str = "auto",
    progress: bool | ProgressCallback = False,
    on_stop: str = "raise",
    **changes: Unpack[_SettingsKwargs],
) -> Image:
    """Photographs a scene: every sample is a path from the film, through the lens, to the scene and its lights.

    settings: samples, bounces, layers, effects, ...; keywords override them, as in
    render(scene, camera, spp=256, max_bounces=4). help(rc.RenderSettings) explains each.
    device: "auto" (a GPU if there is one), "cpu", "cuda" (all GPUs), "cuda:1" or "cuda:0,1".
    progress: True for a bar on stderr, or a function that is called about 20 times a second with the fraction done,
    0 to 1, and stops the render by returning False. Warns of a scene without light.
    on_stop: handling of a render that progress has stopped: "raise" discards it and raises Cancelled; "keep" returns
    the samples taken so far, if every pixel has at least one, and sets Image.shortfall.

    Raises InputError, SceneFileError, DeviceError; Cancelled if progress stopped it; KeyboardInterrupt on Ctrl-C.
    """
    if on_stop not in ("raise", "keep"):
        raise InputError(f'on_stop must be "raise" or "keep"; it is {on_stop!r:.60}')
    warn_of_no_light(scene)
    camera, final_settings, plan = resolved(scene, camera, settings_of(settings, changes), device, stacklevel=2)
    warn_of_effects(camera, final_settings)

    def take_image(callback: ProgressCallback | None) -> Image:
        return _core._render(scene, camera, final_settings, device, callback, on_stop == "keep", plan)

    if progress is True:
        from .progress import progress_bar

        with progress_bar("photographing") as bar:
            image = take_image(bar)
    else:
        image = take_image(progress or None)
    if image.shortfall:
        warnings.warn(image.shortfall, stacklevel=2)
    return image
