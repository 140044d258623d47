"""Shot files: a scene, a camera and lighting in one small TOML file (docs/shot-files.md)."""

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
from .ocio import OcioView
from .planning import resolved_film
from .render import ProgressCallback, render
from .settings import setting


def is_shot_file(path: str | os.PathLike[str]) -> bool:
    """Returns True for a shot file and False for a scene file, by the rule of `realcam render`."""
    return Path(os.fsdecode(path)).suffix == ".toml"


def text_of_shot_of(scene: str) -> str:
    """Returns the text of a minimal shot file, which only names a scene file."""
    return f"format = 1\nscene = {toml_value('scene', scene)}\n"


def toml_value(name: str, value: Any) -> str:
    """Formats a value of a shot file as TOML. Raises InputError, with the name, for types without a TOML form."""
    if isinstance(value, os.PathLike):
        value = os.fsdecode(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace(
            "\x7f", "\\u007f"
        )  # the only difference between JSON and TOML strings
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
        return toml_value(name, items)  # a numpy scalar
    raise InputError(f"{name} must be a value of a shot file (a number, a text or a list); it is {value!r:.60}")


@dataclass(frozen=True)
class Shot:
    """The content of a shot file: `rc.Shot.load("demo.toml").render().save("demo.png")`.

    scene, camera: what is photographed. `camera` has the state of the keys when its shutter opens, without shake.
    settings: render settings, which are also attributes of the shot: shot.spp is shot.settings.spp.
    tone: tone curve, "film" or "linear", or view of OpenColorIO with which the picture is developed.
    exr_color_space: of .exr files, "rec709" or "acescg".
    keys: keyframes of focus, f-number and other lens and exposure settings, which override the camera's, and of cuts
      to other lenses. shake: shake of a hand-held camera; None: there is none.
    iso_follows_s: time constant in s with which the automatic ISO of a video is smoothed; None: fixed ISO.
    Raises InputError if the camera cannot be set to the state of a key.
    """

    scene: Scene
    camera: Camera
    settings: RenderSettings = field(default_factory=RenderSettings)
    tone: str | OcioView = "film"
    keys: tuple[CameraKey, ...] = ()
    shake: Shake | None = None
    iso_follows_s: float | None = None
    exr_color_space: str = "rec709"

    def __post_init__(self) -> None:
        if self.keys:
            _core._check_camera_keys(self.camera, self.keys)
        follows_s = self.iso_follows_s
        if follows_s is not None and not 0 <= follows_s < math.inf:
            raise InputError("iso_follows_s must be a number of seconds, 0 or more, or None")
        if follows_s is not None and any(key.iso is not None for key in self.keys):
            raise InputError("iso_follows_s cannot be combined with the iso of keys")

    spp, noise, noise_codes, seconds, max_spp = map(setting, ("spp", "noise", "noise_codes", "seconds", "max_spp"))
    seed, max_bounces, transport = map(setting, ("seed", "max_bounces", "transport"))
    clamp_cd_m2, layers, effects = map(setting, ("clamp_cd_m2", "layers", "effects"))
    illuminant = setting("illuminant")

    @classmethod
    def load(cls, path: str | os.PathLike[str] | Scene, *, device: str = "auto", **values: Any) -> Shot:
        """Reads a shot file and its scene, a scene file alone, or a bundled shot by its name: Shot.load("demo").

        path may also be a Scene. Paths in a shot file are relative to it. A name refers to a bundled shot unless the
        current folder has a file or folder of that name. Defaults are those of the command `realcam render`: without an
        exposure time, `device` meters the light.
        values: by the names of the keys of shot files (docs/shot-files.md), as in
        Shot.load("demo", lens="tessar-50mm", f_number=5.6, focus_m=2); they replace those of the file, and those that
        they exclude, also in its tables [[key]]. lens may also be a Lens. Paths in values are relative to the current
        folder. Raises InputError naming file, line and key, and what scene and lens raise.
        """
        return _read_shot(path, device, values, denoises=False)[0]

    def frames(
        self, numbers: Sequence[int], *, frames_per_second: float = 24.0, name: str = "frame", device: str = "auto"
    ) -> dict[str, Shot]:
        """Returns shots of the frames of a video, by their names such as "frame.0001", each at the time of its frame.

        The shutter of frame 1 opens at the same time as the shot's; frame n opens (n - 1) / frames_per_second later.
        Each frame has its own seed, a hash of the shot's seed and the frame number, so that noise is not static.
        Effects and bounces that are "auto" are planned once, from the first, middle and last frame and the frame after
        each cut to another lens, because an effect that comes and goes would be visible. Planning, and metering for
        automatic ISO, run on `device`.
        Raises InputError for numbers below 0 and for frames at which the lens cannot be set, and what plan raises.
        """
        numbers = list(numbers)
        if not numbers or min(numbers) < 0 or not 0 < frames_per_second < math.inf:
            raise InputError("frame numbers must be 0 or more, at least one of them, and frames_per_second positive")

        def camera_of(number: int) -> Camera:
            return self.camera_at(self.camera.shutter_opens_s + (number - 1) / frames_per_second)

        cameras = {number: camera_of(number) for number in numbers}
        to_plan = _core._frames_to_plan(numbers, self.camera, self.keys, frames_per_second)
        planned = resolved_film(self.scene, [cameras[n] for n in to_plan], self.settings, device, stacklevel=2)
        settings = planned.settings
        cameras = {number: camera.replace(model=planned.camera.model) for number, camera in cameras.items()}
        if self.iso_follows_s is not None:
            isos = _core._followed_isos(
                self.scene, self.camera, self.keys, settings, numbers, frames_per_second, self.iso_follows_s, device
            )
            cameras = {number: cameras[number].replace(iso=iso) for number, iso in zip(numbers, isos, strict=True)}
        return {
            f"{name}.{number:04d}": Shot(
                self.scene,
                camera,
                settings.with_(seed=_core._frame_seed(self.seed, number)),
                self.tone,
                exr_color_space=self.exr_color_space,
            )
            for number, camera in cameras.items()
        }

    def camera_at(self, time_s: float) -> Camera:
        """Returns the camera for a picture whose shutter opens at a time, in s: in the state of the keys, and with the
        shake of that exposure. Raises InputError if the lens cannot be set so."""
        return _core._camera_at(self.camera, self.keys, self.shake, time_s)

    def render(
        self,
        *,
        device: str = "auto",
        threads: int | None = None,
        progress: bool | ProgressCallback = False,
        on_stop: str = "raise",
    ) -> Image:
        """Renders the picture with the shot's settings, at the time when its shutter opens.

        threads: number of CPU threads; None: settings.threads. Other arguments and errors: those of realcam.render.
        """
        camera = self.camera if self.shake is None else self.camera_at(self.camera.shutter_opens_s)
        settings = self.settings if threads is None else self.settings.with_(threads=threads)
        image = render(self.scene, camera, settings, device=device, progress=progress, on_stop=on_stop)
        return replace(image, tone=self.tone, exr_color_space=self.exr_color_space)


def shot_with_words(path: str | os.PathLike[str], words: Mapping[str, str], device: str) -> Shot:
    """Returns Shot.load(path) with values as texts of the command line, by shot key; messages name the options."""
    fields, _ = _core._read_shot(bundled_file(path, (".toml",)), "", words, None, None, False, device)
    return Shot(**fields)


def _read_shot(
    path: str | os.PathLike[str] | Scene, device: str, values: Mapping[str, Any], *, denoises: bool
) -> tuple[Shot, bool]:
    """Returns the shot, and True if neither spp nor a noise limit is specified. denoises: the picture will be
    denoised."""
    scene = path if isinstance(path, Scene) else None
    lens = values.get("lens") if isinstance(values.get("lens"), Lens) else None
    changes = {name: value for name, value in values.items() if value is not None}
    if lens is not None:
        changes["lens"] = "in memory"
    text = "".join(f"{toml_value(name, name)} = {toml_value(name, value)}\n" for name, value in changes.items())
    named = "the shot" if isinstance(path, Scene) else bundled_file(path, (".toml",))
    fields, has_default_sampling = _core._read_shot(named, text, {}, scene, lens, denoises, device)
    return Shot(**fields), has_default_sampling


def photograph(
    scene: str | os.PathLike[str] | Scene,
    *,
    device: str = "auto",
    denoise: bool | None = None,
    progress: bool | ProgressCallback = False,
    **values: Any,
) -> Image:
    """Takes a picture as the command `realcam render` does, with the same defaults:

    rc.photograph("scene.glb", lens="tessar-50mm", f_number=5.6, focus_m=2.5).save("picture.png")

    scene: a scene file, a shot file, the name of a bundled shot, or a Scene. values: as for Shot.load. denoise: True
    denoises the picture; None does so if spp is not specified, the picture has missed its noise limit, and the extra
    realcam[denoise] is installed; the command does the same for all files but .exr.
    device and progress: those of render. Raises what Shot.load, render and Image.denoised raise.
    """
    shot, has_default_sampling = _read_shot(scene, device, values, denoises=bool(denoise))
    may_denoise = denoise or (denoise is None and has_default_sampling and denoiser.is_installed())
    requested_layers = shot.settings.layers
    if may_denoise:
        shot = replace(shot, settings=shot.settings.with_(layers={*requested_layers, *denoiser.GUIDES}))
    image = shot.render(device=device, progress=progress)
    if denoise or (may_denoise and image.shortfall):
        image = image.denoised(device=device)
    layers = {name: layer for name, layer in image.layers.items() if name in requested_layers}
    return replace(image, layers=layers, settings=image.settings.with_(layers=requested_layers))


def _keys_as_text() -> str:
    """Returns the list of all shot keys with their help, for docstrings."""
    return "\n".join(f"    {key.name}: {key.help[0].lower()}{key.help[1:]}" for key in _core._shot_keys())


for _function in (Shot.load.__func__, photograph):  # type: ignore[attr-defined]
    if _function.__doc__:  # python -OO has none
        _function.__doc__ += f"\n    Keys, with their defaults:\n\n{_keys_as_text()}\n"
