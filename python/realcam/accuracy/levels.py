"""Levels of simulation and sampling strategies to compare."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from .._core import Camera, Scene, effects
from ..image import Image
from ..planning import plan
from ..render import render
from .image_space_blur import Picture, diffused, gathered

Blur = Callable[[Image], Picture]


@dataclass(frozen=True)
class Level:
    """A level of simulation, or a sampling strategy.

    model, effects, pupil_sampling, light_tracing: as for render. blur: post-process of the picture. is_stratified:
    False uses independent random numbers for each sample of a pixel. group: title of the plot that levels with the
    same group share. is_recommended: True for the default of render.
    """

    name: str
    model: str = "full"
    effects: tuple[str, ...] = ()
    pupil_sampling: str = "outline"
    light_tracing: str = "weighted"
    is_stratified: bool = True
    blur: Blur | None = field(default=None, compare=False)
    group: str = "lens, surface by surface"
    is_recommended: bool = False

    def image(self, scene: Scene, camera: Camera, spp: int, seed: int, **settings: object) -> tuple[Image, float]:
        """Returns the picture, and the seconds of sampling and post-processing, without setup."""
        image = self._rendered(scene, camera, spp, seed, settings)
        seconds = image.stats.seconds - image.stats.setup_seconds
        if not self.is_stratified:
            # The first samples of different seeds are independent. The seconds are those of the first picture, whose
            # number of samples is the same.
            total = sum(self._rendered(scene, camera, 1, seed * spp + k, settings).pixels for k in range(spp))
            image = replace(image, pixels=np.asarray(total / spp, np.float32))
        if self.blur:
            begin = time.perf_counter()
            image = replace(image, pixels=self.blur(image))
            seconds += time.perf_counter() - begin
        return image, seconds

    def _rendered(self, scene: Scene, camera: Camera, spp: int, seed: int, settings: dict[str, object]) -> Image:
        return render(
            scene,
            camera.replace(model=self.model),
            spp=spp,
            seed=seed,
            effects=self.effects,
            pupil_sampling=self.pupil_sampling,
            light_tracing=self.light_tracing,
            layers=("circle_of_confusion_mm",) if self.blur else (),
            **settings,  # type: ignore[arg-type]
        )


def _diameters_px(image: Image) -> Picture:
    film = image.camera.film
    diameters: Picture = np.nan_to_num(image.layers["circle_of_confusion_mm"]) * (film.resolution[0] / film.width_mm)
    return diameters


def _gather(image: Image) -> Picture:
    return gathered(image.pixels, _diameters_px(image), image.depth)


def _diffuse(image: Image) -> Picture:
    return diffused(image.pixels, _diameters_px(image))


def known_effects(camera: Camera) -> tuple[str, ...]:
    """Returns the names of the optional effects whose data the lens file has; effects that need coatings come last.

    Film reflection is excluded, because no lens file states the film's reflectance.
    """
    optional = [effect for effect in effects() if not effect.is_on and effect.name != "film_reflection"]
    optional.sort(key=lambda effect: effect.needs_coatings)
    return tuple(effect.name for effect in optional if not (effect.needs_coatings and camera.lens.unknown_coatings))


def sampling_strategies() -> list[Level]:
    """Returns sampling strategies of the full lens, which all converge to the same picture."""
    random, others, outline = "random samples", "other pupils", "fitted outline"
    by_pixels = [
        Level("rear element, random", pupil_sampling="rear_element", is_stratified=False, group=random),
        Level("rear element", pupil_sampling="rear_element", group=others),
        Level("exit pupil", pupil_sampling="exit_pupil", group=others),
        Level("pixel pupil", pupil_sampling="pixel", group=others),
        Level("fitted outline, random", is_stratified=False, group=random),
        Level("fitted outline", group=outline),
    ]
    traced = Level("fitted outline, lights traced", group=outline, is_recommended=True)
    return [*(replace(level, light_tracing="off") for level in by_pixels), traced]


def levels_of(scene: Scene, camera: Camera, effects: tuple[str, ...], **settings: object) -> list[Level]:
    """Returns the levels from the simplest to the full lens with all `effects` of the reference, then the planned
    level.
    """
    levels = [
        Level("pinhole, gather filter", "pinhole", blur=_gather, group="blur of a sharp picture"),
        Level("pinhole, heat diffusion", "pinhole", blur=_diffuse, group="blur of a sharp picture"),
        Level("pinhole", "pinhole", group="ideal lens"),
        Level("thin lens", "thin", group="ideal lens"),
        Level("thin lens, distortion and vignetting", "mapped", group="ideal lens"),
        Level("thick lens", "thick", group="ideal lens"),
        Level("polynomial lens", "polynomial"),
        Level("full lens"),
        Level("full lens, double precision", "full_double"),
    ]
    for count in range(1, len(effects) + 1):
        levels.append(Level(f"+ {effects[count - 1]}", effects=effects[:count], group="with effects"))
    planned = plan(scene, camera, **settings)  # type: ignore[arg-type]
    levels.append(Level("planned", planned.model, tuple(planned.effects), group="with effects", is_recommended=True))
    return levels
