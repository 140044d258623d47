"""The levels of simulation that are compared."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from .._core import Camera, InputError, Scene
from ..image import Image
from ..planning import plan
from ..render import render
from .image_space_blur import Picture, diffused, gathered

Blur = Callable[[Image], Picture]


@dataclass(frozen=True)
class Level:
    """One way to take the picture. model, effects: of render; blur: what is done to it afterwards."""

    name: str
    model: str = "full"
    effects: tuple[str, ...] = ()
    blur: Blur | None = field(default=None, compare=False)

    def image(self, scene: Scene, camera: Camera, **settings: object) -> tuple[Image, float]:
        """The picture, and the seconds of its samples and of what is done to them."""
        layers = ("circle_of_confusion_mm",) if self.blur else ()
        image = render(scene, camera.replace(model=self.model), effects=self.effects, layers=layers, **settings)  # type: ignore[arg-type]
        seconds = image.stats.seconds - image.stats.setup_seconds
        if self.blur:
            begin = time.perf_counter()
            image = replace(image, pixels=self.blur(image))
            seconds += time.perf_counter() - begin
        return image, seconds


def _diameters_px(image: Image) -> Picture:
    film = image.camera.film
    diameters: Picture = np.nan_to_num(image.layers["circle_of_confusion_mm"]) * (film.resolution[0] / film.width_mm)
    return diameters


def _gather(image: Image) -> Picture:
    return gathered(image.pixels, _diameters_px(image), image.depth)


def _diffuse(image: Image) -> Picture:
    return diffused(image.pixels, _diameters_px(image))


def known_effects(camera: Camera) -> tuple[str, ...]:
    """Those of which the lens file says what they need: ghosts and coatings want to know what covers the glass."""
    return ("dispersion", "diffraction") + (() if camera.lens.unknown_coatings else ("coatings", "ghosts"))


def levels_of(scene: Scene, camera: Camera, effects: tuple[str, ...], **settings: object) -> list[Level]:
    """From the crudest to the best; the last with `effects`, which are those of the reference."""
    levels = [
        Level("pinhole, gather filter", "pinhole", blur=_gather),
        Level("pinhole, heat diffusion", "pinhole", blur=_diffuse),
        Level("pinhole", "pinhole"),
        Level("thin lens", "thin"),
        Level("thin lens, distortion and vignetting", "mapped"),
        Level("thick lens", "thick"),
        Level("full lens"),
    ]
    for count in range(1, len(effects) + 1):
        levels.append(Level(f"+ {effects[count - 1]}", effects=effects[:count]))
    decided = plan(scene, camera, **settings)  # type: ignore[arg-type]
    levels.append(Level("planned", decided.model, tuple(decided.effects)))
    return levels


def can_be_taken(scene: Scene, camera: Camera, level: Level, **settings: object) -> bool:
    """Whether the camera model can show what the lens sees: an ideal lens sees nothing at 90 degrees to the side."""
    film = camera.film
    small = camera.replace(film=type(film)(film.width_mm, film.height_mm, (4, 4)))
    try:
        level.image(scene, small, spp=1, **settings)
    except InputError:
        return False
    return True
