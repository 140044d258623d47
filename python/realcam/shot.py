"""Shot files: a scene, a camera and their light in one small TOML file (docs/shot-files.md)."""

from __future__ import annotations

import os
from dataclasses import dataclass, field

from . import _core
from ._core import Camera, RenderSettings, Scene
from .image import Image
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

    def render(self, *, device: str = "auto", threads: int = 0, progress: bool | ProgressCallback = False) -> Image:
        """Takes the photograph: realcam.render with the shot's own settings."""
        return render(self.scene, self.camera, self.settings, device=device, threads=threads, progress=progress)
