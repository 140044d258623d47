"""Shot files: a scene, a camera and their light in one small TOML file (docs/shot-files.md)."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from . import _core
from ._core import Camera, InputError, RenderSettings, Scene
from .image import Image
from .planning import settled
from .render import ProgressCallback, render
from .settings import setting


@dataclass(frozen=True)
class Shot:
    """What a shot file describes: `rc.Shot.load("demo.toml").render().save("demo.png")`.

    tone: "film" or "linear", the tone curve for Image.save. What the settings say can be asked of the shot, too:
    shot.spp is shot.settings.spp.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings = field(default_factory=RenderSettings)
    tone: str = "film"

    spp, noise, noise_codes, seconds, max_spp = map(setting, ("spp", "noise", "noise_codes", "seconds", "max_spp"))
    seed, max_bounces, transport = map(setting, ("seed", "max_bounces", "transport"))
    clamp_cd_m2, layers, effects = map(setting, ("clamp_cd_m2", "layers", "effects"))
    illuminant = setting("illuminant")

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, device: str = "auto") -> Shot:
        """Reads a shot file, and its scene; paths in it are relative to it.

        What it leaves out is chosen as the command `realcam render` chooses it: `device` meters the light where the
        file gives no exposure time. Raises InputError naming file, line and key, and what scene and lens raise.
        """
        return cls(**_core._read_shot(path, device, None))

    def frames(
        self, numbers: Sequence[int], *, frames_per_second: float = 24.0, name: str = "frame", device: str = "auto"
    ) -> dict[str, Shot]:
        """Frames of a film by their names, as "frame.0001": what moves is where it is at that time.

        The shutter of frame 1 opens when that of the shot does, and those of the others so many frames later. Each
        frame has random numbers of its own, so that the noise does not stand still. Effects "auto" are planned for the
        first, the middle and the last frame together (on `device`), because one that comes and goes would show.
        Raises InputError for numbers below 0, and what plan raises.
        """
        numbers = list(numbers)
        if not numbers or min(numbers) < 0 or not 0 < frames_per_second < math.inf:
            raise InputError("a film wants frames with numbers from 0 on, and more than 0 of them in a second")

        def at(number: int) -> Shot:
            opens_s = self.camera.shutter_opens_s + (number - 1) / frames_per_second
            settings = self.settings.with_(seed=(self.seed + number) % 2**32)
            return replace(self, camera=self.camera.replace(shutter_opens_s=opens_s), settings=settings)

        made = {f"{name}.{number:04d}": at(number) for number in numbers}
        if "auto" not in self.effects:
            return made
        some = [at(number) for number in dict.fromkeys((numbers[0], numbers[len(numbers) // 2], numbers[-1]))]
        plans = [settled(each.scene, each.camera, each.settings, device, stacklevel=2) for each in some]
        effects = tuple(dict.fromkeys(effect for plan in plans for effect in plan.settings.effects))
        models = {plan.camera.model for plan in plans}
        model = models.pop() if len(models) == 1 else self.camera.model
        return {
            name: replace(
                frame, camera=frame.camera.replace(model=model), settings=frame.settings.with_(effects=effects)
            )
            for name, frame in made.items()
        }

    def render(self, *, device: str = "auto", threads: int = 0, progress: bool | ProgressCallback = False) -> Image:
        """Takes the photograph: realcam.render with the shot's own settings."""
        return render(self.scene, self.camera, self.settings, device=device, threads=threads, progress=progress)
