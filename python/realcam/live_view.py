"""Pictures of a camera that changes with every frame."""

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

    from ._core import _SettingWords


class LiveView:
    """A scene before a camera that changes with every frame, on one device: "auto" (a GPU if there is one), "cpu",
    "cuda" or "cuda:1".

    Only what changed is prepared again; samples are collected for as long as scene, lens, film and pose of the camera
    stay the same. On a GPU they begin once more with the second frame after the lens has changed. Frames are taken one
    behind the other without waiting: up to three are under way on a GPU, one on the CPU. Not for two threads at once,
    but for cancel().

    settings, also by their names, are those of render, but that effects are none and max_bounces is 1 unless they are
    named: planning ("auto") takes longer than a frame, and rc.plan says what it would choose. Layers are image()'s, not
    frames'. Raises InputError; DeviceError where the device is not there.
    """

    def __init__(
        self,
        scene: Scene,
        settings: RenderSettings | None = None,
        *,
        device: str = "auto",
        **changes: Unpack[_SettingWords],
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
        **changes: Unpack[_SettingWords],
    ) -> LiveFrame:
        """Starts to take spp more samples of each pixel, 1 unless it is named here.

        They are developed with the camera's exposure time and ISO and a tone curve (see Image.developed).
        settings, also by their names: of this frame, in place of the view's. Returns a LiveFrame at once, or when the
        oldest of those under way is there. Raises KeyboardInterrupt on Ctrl-C.
        """
        now = settings_of(settings, {"spp": 1, **changes, "layers": ()}, self.settings)
        frame = self._core.shoot(camera, now, tone)
        self._last = camera, now
        return frame

    def show(self, scene: Scene) -> None:
        """Another scene for the frames to come.

        Made for every frame: of one that comes from the last by moved(), only the places are copied. Raises InputError.
        """
        self._core.show(scene)

    def picture(self) -> tuple[DeviceArray | NDArray[np.float32], DeviceArray | NDArray[np.float32]]:
        """All that was collected up to the last frame, as two arrays of float32.

        Exposure (H, W, 3) in lux seconds and depth (H, W) in metres, as Image has them: DeviceArrays in the memory of
        the GPU; of a view on the CPU numpy arrays. Waits for the frames under way. Raises InputError before the first
        frame, Cancelled where another thread stops them meanwhile, and KeyboardInterrupt on Ctrl-C.
        """
        return self._core.picture()

    def image(self, layers: str | Iterable[str] = ()) -> Image:
        """The same as Session.image returns it, with these layers. Raises what picture raises."""
        if self._last is None:
            raise InputError("there is no picture yet; shoot() takes one")
        camera, settings = self._last
        settings = settings.with_(layers=layers)
        picture = self._core.image(camera, settings)
        return Image(**picture, camera=camera, seed=settings.seed, settings=settings)

    def cancel(self) -> None:
        """Gives up all frames under way within some milliseconds, from any thread.

        Their codes raise Cancelled, and the next frame begins a new picture.
        """
        self._core.cancel()
