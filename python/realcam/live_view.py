"""Interactive rendering of a camera that changes with every frame."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Camera, DeviceArray, InputError, LiveFrame, RenderSettings, Scene
from .image import Image
from .settings import settings_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._core import _SettingsKwargs


class LiveView:
    """Renders a scene with a camera that may change with every frame.

    device: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:1".
    settings, also as keywords: those of render, but by default without effects and with max_bounces 1: planning
      ("auto") takes longer than a frame; rc.plan returns what it would choose. Only image() has layers.

    Only changed data is prepared again; samples accumulate while the scene and the camera's lens, film and pose stay
    the same. On a GPU the accumulation restarts again at the second frame after a change of the lens, because the first
    one uses an approximate pupil. Frames are pipelined: up to three are in flight on a GPU, one on the CPU. Not
    thread-safe, except for cancel(). Raises InputError; DeviceError if the device does not exist.
    """

    def __init__(
        self,
        scene: Scene,
        settings: RenderSettings | None = None,
        *,
        device: str = "auto",
        **changes: Unpack[_SettingsKwargs],
    ) -> None:
        self.settings = settings_of(settings, changes, RenderSettings(effects=(), max_bounces=1))
        self._core = _core._LiveView(scene, device)
        self._last: tuple[Camera, RenderSettings] | None = None

    def shoot(
        self,
        camera: Camera,
        settings: RenderSettings | None = None,
        *,
        tone: str = "film",
        **changes: Unpack[_SettingsKwargs],
    ) -> LiveFrame:
        """Starts a frame with spp more samples per pixel, by default 1.

        The frame is developed with the camera's exposure time and ISO and a tone curve (see Image.developed).
        settings, also as keywords: settings of this frame; None: those of the view. Returns a LiveFrame at once, or, if
        too many are in flight, when the oldest is done. Raises KeyboardInterrupt on Ctrl-C.
        """
        frame_settings = settings_of(settings, {"spp": 1, **changes, "layers": ()}, self.settings)
        frame = self._core.shoot(camera, frame_settings, tone)
        self._last = camera, frame_settings
        return frame

    def show(self, scene: Scene) -> None:
        """Sets the scene of the following frames.

        Cheap enough for every frame if the scene is made by moved() from the last one: only the instances' transforms
        are copied. Raises InputError.
        """
        self._core.show(scene)

    def picture(self) -> tuple[DeviceArray | NDArray[np.float32], DeviceArray | NDArray[np.float32]]:
        """Returns the picture accumulated up to the last frame, as two arrays of float32.

        They are the exposure (H, W, 3) in lux seconds and depth (H, W) in metres, as in Image: DeviceArrays in GPU
        memory, or numpy arrays for a view on the CPU. Waits for the frames in flight. Raises InputError before the
        first frame, Cancelled if another thread cancels them meanwhile, and KeyboardInterrupt on Ctrl-C.
        """
        return self._core.picture()

    def image(self, layers: str | Iterable[str] = ()) -> Image:
        """Returns the picture accumulated up to the last frame as an Image with these layers. Raises what picture()
        raises."""
        if self._last is None:
            raise InputError("there is no picture yet; shoot() takes one")
        camera, settings = self._last
        return self._core.image(camera, settings.with_(layers=layers))

    def cancel(self) -> None:
        """Cancels all frames in flight within some milliseconds, from any thread.

        LiveFrame.codes of these frames raises Cancelled, and the next frame begins a new picture.
        """
        self._core.cancel()
