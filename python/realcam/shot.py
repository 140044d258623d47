"""Shot files: a scene, a camera and their light in one small TOML file (docs/shot-files.md)."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from . import _core, denoiser
from ._core import Camera, CameraKey, InputError, Lens, RenderSettings, Scene, Shake
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
    return f"format = 1\nscene = {toml_value('scene', scene)}\n"


def toml_value(name: str, value: Any) -> str:
    """A value of a shot file as TOML. Raises InputError, with the name, for what no shot file holds."""
    if isinstance(value, os.PathLike):
        value = os.fsdecode(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace(
            "\x7f", "\\u007f"
        )  # JSON's strings are TOML's, but for this
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{toml_value(name, str(k))} = {toml_value(name, v)}" for k, v in value.items()) + "}"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(int(value))
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, Sequence) or hasattr(value, "tolist"):
        items = value.tolist() if hasattr(value, "tolist") else value
        if isinstance(items, (list, tuple)):
            return "[" + ", ".join(toml_value(name, item) for item in items) + "]"
        return toml_value(name, items)  # numpy's numbers
    raise InputError(f"{name} must be a value of a shot file (a number, a text or a list); it is {value!r:.60}")


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
    def load(cls, path: str | os.PathLike[str] | Scene, *, device: str = "auto", **values: Any) -> Shot:
        """Reads a shot file and its scene, a scene file alone, or a bundled shot by its name: Shot.load("demo").

        path may also be a Scene. Paths in a shot file are relative to it. A name is that of a bundled shot if no file
        or folder here has it. What a shot leaves out is chosen as the command `realcam render` chooses it: `device`
        meters the light where the file gives no exposure time.
        values: by the names of the keys of shot files (docs/shot-files.md), as in
        Shot.load("demo", lens="tessar-50mm", f_number=5.6, focus_m=2); they take the place of those in the file, and of
        those that they exclude, also in its tables [[key]]. lens may also be a Lens. Paths are relative to the current
        folder. Raises InputError naming file, line and key, and what scene and lens raise.
        """
        return _read_shot(path, device, values, denoises=False)[0]

    def frames(
        self, numbers: Sequence[int], *, frames_per_second: float = 24.0, name: str = "frame", device: str = "auto"
    ) -> dict[str, Shot]:
        """Frames of a film by their names, as "frame.0001": what moves is where it is at that time.

        The shutter of frame 1 opens when that of the shot does, and those of the others so many frames later. Each
        frame has a seed of its own, a hash of the shot's and of its number, so that the noise does not stand still.
        Effects and bounces that are "auto" are planned for the first, the middle and the last frame and after each cut
        to another lens together, because one that comes and goes would show. The plan and the meter, where the ISO
        number follows it, work on `device`.
        Raises InputError for numbers below 0 and for what the lens cannot do at a frame, and what plan raises.
        """
        numbers = list(numbers)
        if not numbers or min(numbers) < 0 or not 0 < frames_per_second < math.inf:
            raise InputError("a film wants frames with numbers from 0 on, and more than 0 of them in a second")

        def camera_of(number: int) -> Camera:
            return self.camera_at(self.camera.shutter_opens_s + (number - 1) / frames_per_second)

        cameras = {number: camera_of(number) for number in numbers}
        some = _core._frames_to_plan(numbers, self.camera, self.keys, frames_per_second)
        planned = settled_film(self.scene, [cameras[n] for n in some], self.settings, device, stacklevel=2)
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
        self,
        *,
        device: str = "auto",
        threads: int | None = None,
        progress: bool | ProgressCallback = False,
        on_stop: str = "raise",
    ) -> Image:
        """Takes the photograph: realcam.render with the shot's own settings, when its shutter opens.

        threads: None is settings.threads.
        """
        camera = self.camera if self.shake is None else self.camera_at(self.camera.shutter_opens_s)
        settings = self.settings if threads is None else self.settings.with_(threads=threads)
        return render(self.scene, camera, settings, device=device, progress=progress, on_stop=on_stop)


def shot_with_words(path: str | os.PathLike[str], words: Mapping[str, str], device: str) -> Shot:
    """Shot.load with values in the words of the command line, by their keys, which messages call by their options."""
    read, _ = _core._read_shot(bundled_file(path, (".toml",)), "", words, None, None, False, device)
    return Shot(**read)


def _read_shot(
    path: str | os.PathLike[str] | Scene, device: str, values: Mapping[str, Any], *, denoises: bool
) -> tuple[Shot, bool]:
    """The shot, and whether nobody has said how many samples it has or how little noise."""
    scene = path if isinstance(path, Scene) else None
    lens = values.get("lens") if isinstance(values.get("lens"), Lens) else None
    changes = {name: value for name, value in values.items() if value is not None}
    if lens is not None:
        changes["lens"] = "in memory"
    text = "".join(f"{toml_value(name, name)} = {toml_value(name, value)}\n" for name, value in changes.items())
    named = "the shot" if isinstance(path, Scene) else bundled_file(path, (".toml",))
    read, is_unsaid = _core._read_shot(named, text, {}, scene, lens, denoises, device)
    return Shot(**read), is_unsaid


def photograph(
    scene: str | os.PathLike[str] | Scene,
    *,
    device: str = "auto",
    denoise: bool | None = None,
    progress: bool | ProgressCallback = False,
    **values: Any,
) -> Image:
    """Takes a picture as the command `realcam render` does, and chooses what is left out:

    rc.photograph("scene.glb", lens="tessar-50mm", f_number=5.6, focus_m=2.5).save("picture.png")

    scene: a scene file, a shot file, the name of a bundled shot, or a Scene. values: as for Shot.load. denoise: True
    takes the noise that is left away; None does so where spp is not given, the picture has missed the goal of its
    noise, and the extra realcam[denoise] is installed; the command does the same for all files but .exr.
    device and progress: those of render. Raises what Shot.load, render and Image.denoised raise.
    """
    shot, is_unsaid = _read_shot(scene, device, values, denoises=bool(denoise))
    may_denoise = denoise or (denoise is None and is_unsaid and denoiser.is_installed())
    wanted = shot.settings.layers
    if may_denoise:
        shot = replace(shot, settings=shot.settings.with_(layers={*wanted, *denoiser.GUIDES}))
    image = shot.render(device=device, progress=progress)
    if denoise or (may_denoise and image.shortfall):
        image = image.denoised(device=device)
    layers = {name: layer for name, layer in image.layers.items() if name in wanted}
    return replace(image, layers=layers, settings=image.settings.with_(layers=wanted))


def _keys_as_text() -> str:
    return "\n".join(
        f"    {name}: {text[0].lower()}{text[1:]}{f' [{initial}]' if initial else ''}"
        for name, _, _, _, text, initial in _core._shot_keys()
    )


for _function in (Shot.load.__func__, photograph):  # type: ignore[attr-defined]
    if _function.__doc__:  # python -OO has none
        _function.__doc__ += f"\n    The keys, with what holds without them:\n\n{_keys_as_text()}\n"
