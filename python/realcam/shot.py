"""Shot files: a scene, a camera and their light in one small TOML file (docs/shot-files.md)."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from . import _core
from ._core import Camera, Scene
from .image import Image
from .noise import Samples
from .render import ProgressCallback, render


@dataclass(frozen=True)
class Shot:
    """What a shot file describes: `rc.Shot.load("demo.toml").render().save("demo.png")`.

    tone: "film" or "linear", the tone curve for Image.save.
    """

    scene: Scene
    camera: Camera
    spp: Samples = 64
    seed: int = 0
    max_bounces: int = 1
    tone: str = "film"
    layers: tuple[str, ...] = ()
    transport: str = "paths"
    clamp_cd_m2: float = 0.0
    effects: tuple[str, ...] = ("auto",)
    illuminant: str = ""
    noise: float | None = None
    noise_codes: float | None = None
    seconds: float | None = None
    max_spp: int | None = None

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, device: str = "auto") -> Shot:
        """Reads a shot file, and its scene; paths in it are relative to it.

        What it leaves out is chosen as the command `realcam render` chooses it: `device` meters the light where the
        file gives no exposure time. Raises InputError naming file, line and key, and what scene and lens raise.
        """
        return cls(*_core._read_shot(path, device, None))

    def render(self, *, device: str = "auto", threads: int = 0, progress: bool | ProgressCallback = False) -> Image:
        """Takes the photograph: realcam.render with the shot's own settings."""
        settings: dict[str, Any] = {"spp": self.spp, "seed": self.seed, "max_bounces": self.max_bounces}
        settings |= {"layers": self.layers, "transport": self.transport, "clamp_cd_m2": self.clamp_cd_m2}
        settings |= {"effects": self.effects, "illuminant": self.illuminant or None}
        settings |= {"noise": self.noise, "noise_codes": self.noise_codes}
        settings |= {"seconds": self.seconds, "max_spp": self.max_spp}
        return render(self.scene, self.camera, **settings, device=device, threads=threads, progress=progress)
