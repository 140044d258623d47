"""Taking a picture."""

from __future__ import annotations

from collections.abc import Callable

from . import _core
from ._core import Camera, Scene
from .image import Image

ProgressCallback = Callable[[float], bool | None]


def render(
    scene: Scene,
    camera: Camera,
    *,
    spp: int = 64,
    device: str = "auto",
    seed: int = 0,
    max_bounces: int = 1,
    threads: int = 0,
    progress: bool | ProgressCallback = False,
) -> Image:
    """Photographs a scene: every sample is a ray from the film, through the lens, to the scene and its lights.

    spp: samples per pixel. max_bounces: 0 for direct light only, 1 for one reflection more, ...
    threads: 0 for all. progress: True for a bar on stderr, or a function that is called about 20 times a second
    with the share done, 0 to 1, and stops the render where it returns False.

    Raises InputError, SceneFileError, DeviceError; Cancelled where progress stopped it; KeyboardInterrupt on Ctrl-C.
    """
    if progress is True:
        from .progress import progress_bar

        with progress_bar("photographing") as bar:
            return render(
                scene,
                camera,
                spp=spp,
                device=device,
                seed=seed,
                max_bounces=max_bounces,
                threads=threads,
                progress=bar,
            )
    callback = progress or None
    pixels, depth, stats = _core._render(scene, camera, spp, device, seed, max_bounces, threads, callback)
    return Image(pixels=pixels, depth=depth, camera=camera, spp=spp, seed=seed, stats=stats)
