"""Taking a picture."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable

from . import _core
from ._core import Camera, Scene
from .effect_names import Illuminant, effect_list, illuminant_text
from .image import Image, image_of, layer_names
from .noise import Samples, noise_request
from .planning import settled

ProgressCallback = Callable[[float], bool | None]


def warn_of_no_light(scene: Scene) -> None:
    """Where the caller's caller stands."""
    if isinstance(scene, Scene) and not scene.has_light:
        warnings.warn(
            "the scene has no light, so that its picture is black; scene.with_daylight(camera), with_environment, "
            "with_sun or with_point_light brings some",
            stacklevel=3,
        )


def warn_of_effects(camera: Camera, effects: list[str]) -> None:
    """Of what the lens cannot give of them; where the caller's caller stands."""
    if isinstance(camera, Camera):
        for notice in _core._effect_notices(camera.lens, effects):
            warnings.warn(notice, stacklevel=3)


def render(
    scene: Scene,
    camera: Camera,
    *,
    spp: Samples = 64,
    noise: float | None = None,
    noise_codes: float | None = None,
    seconds: float | None = None,
    max_spp: int | None = None,
    device: str = "auto",
    seed: int = 0,
    max_bounces: int = 1,
    transport: str = "paths",
    clamp_cd_m2: float = 0.0,
    threads: int = 0,
    layers: str | Iterable[str] = (),
    effects: str | Iterable[str] = "auto",
    quality: str = "photo",
    threshold_px: float | None = None,
    threshold_codes: float | None = None,
    illuminant: Illuminant | None = None,
    pupil_sampling: str = "outline",
    progress: bool | ProgressCallback = False,
) -> Image:
    """Photographs a scene: every sample is a ray from the film, through the lens, to the scene and its lights.

    spp: samples per pixel, or "auto": as many as the noise needs, more where it is noisier, by tiles of 16 pixels
    (docs/sampling.md). noise: what is wanted then, as a share of a tile's light (of a hundredth of white where that is
    more), or noise_codes: in 8-bit codes of the developed picture; 1 code unless said. seconds, max_spp (4096): no more
    samples are taken after so long, and of a pixel no more than so many; warns where the noise is still larger then.
    max_bounces: 0 for direct light only, 1 for one reflection more, ...
    transport: "paths" for all ways of light, "whitted" for direct light and what mirrors and smooth glass show.
    clamp_cd_m2: radiance above which what comes by a bounce is cut off, for fewer bright dots and a picture that is
    too dark; 0: never. threads: 0 for all.
    layers: names of what else Image.layers is to hold, or "all" (docs/layers.md).
    effects: "auto": what the shot calls for, and the cheapest camera model that shows it, by the thresholds of rc.plan,
    whose quality, threshold_px and threshold_codes these are; or names of what is simulated besides (rc.effects() lists
    them; docs/dispersion.md), () for none. Warns of what the lens cannot give of them.
    illuminant: of dispersion and diffraction, the spectrum of all light: "D65", "A", "FL2", a wavelength in nm, or
    (wavelength_nm, power) pairs; None: D65.
    pupil_sampling: where a full lens's rays are sent: "outline", where real rays were found to pass; to compare with it
    (docs/accuracy.md), "rear_element", "exit_pupil", or "pixel", where the pixel's earlier samples have passed.
    progress: True for a bar on stderr, or a function that is called about 20 times a second with the share done,
    0 to 1, and stops the render where it returns False. Warns of a scene without light.

    Raises InputError, SceneFileError, DeviceError; Cancelled where progress stopped it; KeyboardInterrupt on Ctrl-C.
    """
    warn_of_no_light(scene)
    request = noise_request(spp, noise, noise_codes, seconds, max_spp)
    camera, wanted, light, decisions = settled(
        scene,
        camera,
        effect_list(effects),
        illuminant_text(illuminant),
        stacklevel=2,
        device=device,
        seed=seed,
        max_bounces=max_bounces,
        threads=threads,
        quality=quality,
        threshold_px=threshold_px,
        threshold_codes=threshold_codes,
    )
    warn_of_effects(camera, wanted)

    def taken(callback: ProgressCallback | None) -> Image:
        names = layer_names(layers)
        picture = _core._render(
            scene,
            camera,
            1 if spp == "auto" else spp,
            request,
            device,
            seed,
            max_bounces,
            transport,
            clamp_cd_m2,
            threads,
            names,
            wanted,
            light,
            pupil_sampling,
            callback,
        )
        return image_of(picture, camera, seed, transport, clamp_cd_m2, wanted, light, decisions)

    if progress is True:
        from .progress import progress_bar

        with progress_bar("photographing") as bar:
            image = taken(bar)
    else:
        image = taken(progress or None)
    if image.shortfall:
        warnings.warn(image.shortfall, stacklevel=2)
    return image
