"""Shot files: a scene, a camera and their light in one small TOML file (docs/shot-files.md)."""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from . import _core
from ._core import Camera, CameraKey, InputError, RealcamError, RenderSettings, Scene, Shake
from .bundled_scenes import bundled_file
from .image import Image
from .planning import settled_film
from .render import ProgressCallback, render
from .settings import setting


def is_shot_file(path: str | os.PathLike[str]) -> bool:
    """True for a shot file, false for a scene file: the rule of `realcam render`."""
    return Path(os.fsdecode(path)).suffix == ".toml"


def text_of_shot_of(scene: str) -> str:
    """The text of a shot file that names a scene file alone."""
    quoted = json.dumps(scene, ensure_ascii=False).replace("\x7f", "\\u007f")  # JSON's strings are TOML's, but for this
    return f"format = 1\nscene = {quoted}\n"


@dataclass(frozen=True)
class Shot:
    """What a shot file describes: `rc.Shot.load("demo.toml").render().save("demo.png")`.

    tone: "film" or "linear", the tone curve for Image.save. What the settings say can be asked of the shot, too:
    shot.spp is shot.settings.spp.
    keys: of the camera's rings and dials, which then go before what the camera itself says, and of cuts to other
    lenses; `shake`: of a camera in the hand. `camera` is as the keys have it when its shutter opens, and does not
    shake. iso_follows_s: in a film the ISO number follows the meter, smoothed over so many seconds; None: it does not.
    Raises InputError where the camera cannot be as a key says.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings = field(default_factory=RenderSettings)
    tone: str = "film"
    keys: tuple[CameraKey, ...] = ()
    shake: Shake | None = None
    iso_follows_s: float | None = None

    def __post_init__(self) -> None:
        if self.keys:
            _core._check_camera_keys(self.camera, self.keys)
        follows_s = self.iso_follows_s
        if follows_s is not None and not 0 <= follows_s < math.inf:
            raise InputError("iso_follows_s must be a number of seconds, 0 or more, or None")
        if follows_s is not None and any(key.iso is not None for key in self.keys):
            raise InputError("iso_follows_s and the iso of keys exclude each other")

    spp, noise, noise_codes, seconds, max_spp = map(setting, ("spp", "noise", "noise_codes", "seconds", "max_spp"))
    seed, max_bounces, transport = map(setting, ("seed", "max_bounces", "transport"))
    clamp_cd_m2, layers, effects = map(setting, ("clamp_cd_m2", "layers", "effects"))
    illuminant = setting("illuminant")

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, device: str = "auto") -> Shot:
        """Reads a shot file and its scene, a scene file alone, or a bundled shot by its name: Shot.load("demo").

        Paths in a shot file are relative to it. A name is that of a bundled shot if no file or folder here has it.
        What a shot leaves out is chosen as the command `realcam render` chooses it: `device` meters the light where the
        file gives no exposure time. Raises InputError naming file, line and key, and what scene and lens raise.
        """
        path = bundled_file(path, (".toml",))
        named = os.fsdecode(path)
        if is_shot_file(path) or Path(named).is_dir():
            return cls(**_core._read_shot(path, device, None))
        scene = str(Path(named).absolute())
        with tempfile.TemporaryDirectory(prefix="realcam-") as folder:
            file = Path(folder) / "scene.toml"
            file.write_bytes(os.fsencode(text_of_shot_of(scene)))
            try:
                return cls(**_core._read_shot(file, device, None))
            except RealcamError as error:
                told = str(error).replace(f"{file}:2: ", "").replace(str(file), named).replace(scene, named)
                raise type(error)(told) from None

    def frames(
        self, numbers: Sequence[int], *, frames_per_second: float = 24.0, name: str = "frame", device: str = "auto"
    ) -> dict[str, Shot]:
        """Frames of a film by their names, as "frame.0001": what moves is where it is at that time.

        The shutter of frame 1 opens when that of the shot does, and those of the others so many frames later. Each
        frame has a seed of its own, a hash of the shot's and of its number, so that the noise does not stand still.
        Effects "auto" are planned for the first, the middle and the last frame and after each cut to another lens
        together, because one that comes and goes would show. The plan and the meter, where the ISO number follows it,
        work on `device`.
        Raises InputError for numbers below 0 and for what the lens cannot do at a frame, and what plan raises.
        """
        numbers = list(numbers)
        if not numbers or min(numbers) < 0 or not 0 < frames_per_second < math.inf:
            raise InputError("a film wants frames with numbers from 0 on, and more than 0 of them in a second")

        def camera_of(number: int) -> Camera:
            return self.camera_at(self.camera.shutter_opens_s + (number - 1) / frames_per_second)

        cameras = {number: camera_of(number) for number in numbers}
        settings = self.settings
        if "auto" in settings.effects:
            some = _core._frames_to_plan(numbers, self.camera, self.keys, frames_per_second)
            planned = settled_film(self.scene, [cameras[n] for n in some], settings, device, stacklevel=2)
            settings = planned.settings
            cameras = {number: camera.replace(model=planned.camera.model) for number, camera in cameras.items()}
        if self.iso_follows_s is not None:
            isos = _core._followed_isos(
                self.scene, self.camera, self.keys, settings, numbers, frames_per_second, self.iso_follows_s, device
            )
            cameras = {number: cameras[number].replace(iso=iso) for number, iso in zip(numbers, isos, strict=True)}
        return {
            f"{name}.{number:04d}": Shot(
                self.scene, camera, settings.with_(seed=_core._frame_seed(self.seed, number)), self.tone
            )
            for number, camera in cameras.items()
        }

    def camera_at(self, time_s: float) -> Camera:
        """The camera of a picture whose shutter opens at a time: with its rings and dials as the keys have them, and
        with the shake of its exposure. Raises InputError where the lens cannot be so."""
        return _core._camera_at(self.camera, self.keys, self.shake, time_s)

    def render(
        self, *, device: str = "auto", threads: int | None = None, progress: bool | ProgressCallback = False
    ) -> Image:
        """Takes the photograph: realcam.render with the shot's own settings, when its shutter opens.

        threads: None is settings.threads.
        """
        camera = self.camera if self.shake is None else self.camera_at(self.camera.shutter_opens_s)
        settings = self.settings if threads is None else self.settings.with_(threads=threads)
        return render(self.scene, camera, settings, device=device, progress=progress)
