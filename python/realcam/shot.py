"""Shot files: a scene, a camera and their light in one small TOML file."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import image_file
from ._core import Camera, Film, InputError, Lens, Scene

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FORMAT = 1
NUMBERS = {
    "focus_m": 1,
    "f_number": 1,
    "exposure_time_s": 1,
    "iso": 1,
    "scale": 1,
    "position_m": 3,
    "look_at_m": 3,
    "up": 3,
}
NUMBERS |= {"film_mm": 2, "resolution": 2}
TEXTS = {"scene", "lens", "model", "environment", "texture"}
KEYS = {"format", "environment_cd_m2", *TEXTS, *NUMBERS}


@dataclass(frozen=True)
class Shot:
    """What a shot file describes: ready for render(shot.scene, shot.camera)."""

    scene: Scene
    camera: Camera


def read_shot(path: str | os.PathLike[str]) -> Shot:
    """Reads a shot file. Paths in it are relative to it.

    Keys: format = 1, scene; optional: scale (metres per unit), texture (a picture for all materials without one),
    environment_cd_m2 (a number or [r, g, b]) or environment (a latitude-longitude picture), lens, model, focus_m,
    f_number, exposure_time_s, iso, position_m, look_at_m, up, film_mm, resolution. What is left out is chosen as
    `realcam render` chooses it. Raises InputError naming file and key, and what the scene and the lens raise.
    """
    values = _read(Path(path))
    folder = Path(path).parent
    scene = Scene.load(folder / values["scene"], scale=values.get("scale", 1.0))
    if "texture" in values:
        scene = _textured(scene, folder / values["texture"])
    if "environment" in values:
        scene = scene.with_environment(image_file.read_environment(folder / values["environment"]))
    elif "environment_cd_m2" in values:
        scene = scene.with_environment(values["environment_cd_m2"])
    return _shot(scene, values)


def _read(path: Path) -> dict[str, Any]:
    try:
        values: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not valid TOML: {error}") from None
    if values.get("format") != FORMAT:
        raise InputError(f"{path}: format = {FORMAT} is wanted")
    for key, value in values.items():
        _check(path, key, value)
    if not isinstance(values.get("scene"), str):
        raise InputError(f"{path}: scene is missing: the file to photograph")
    if "/" in values.get("lens", "") or "." in values.get("lens", ""):
        values["lens"] = str(path.parent / values["lens"])
    return values


def _check(path: Path, key: str, value: object) -> None:
    if key not in KEYS:
        raise InputError(f'{path}: unknown key "{key}"; one of {", ".join(sorted(KEYS))} is wanted')
    if key in TEXTS and not isinstance(value, str):
        raise InputError(f"{path}: {key} must be a text in quotes")
    if key == "environment_cd_m2" and not (_is_number(value) or (isinstance(value, list) and len(value) == 3)):
        raise InputError(f"{path}: {key} must be a number or [r, g, b]")
    count = NUMBERS.get(key)
    if count is None:
        return
    items: list[Any] = [value] if count == 1 else value if isinstance(value, list) else []
    if len(items) != count or not all(_is_number(v) for v in items):
        wanted = "a number" if count == 1 else f"an array of {count} numbers"
        raise InputError(f"{path}: {key} must be {wanted}")
    if key == "resolution" and not all(float(v).is_integer() and abs(v) < 2**31 for v in items):
        raise InputError(f"{path}: resolution must be two whole numbers of pixels")


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and not math.isnan(value)


def _textured(scene: Scene, path: Path) -> Scene:
    pixels = image_file.read_texture(str(path), b"")
    if pixels is None:
        raise InputError(f"{path}: cannot be read as a texture")
    for material in range(scene.material_count):
        scene = scene.with_texture(material, pixels)
    return scene


def _shot(scene: Scene, values: Mapping[str, Any]) -> Shot:
    lens = Lens.load(values.get("lens", "double-gauss-50mm"))
    if "f_number" in values:
        lens = lens.stopped_down(values["f_number"])
    resolution = values.get("resolution")
    camera = Camera(
        lens,
        film=Film.for_lens(lens, values.get("film_mm"), resolution and tuple(int(v) for v in resolution)),
        iso=values.get("iso", 100),
        model=values.get("model", "full"),
        exposure_time_s=values.get("exposure_time_s", 1.0),
    )
    camera = camera.framing(
        scene,
        position=values.get("position_m"),
        look_at=values.get("look_at_m"),
        up=values.get("up", (0, 1, 0)),
        focus_distance_m=values.get("focus_m"),
    )
    if not scene.has_light:
        scene = scene.with_daylight(camera)
    if "exposure_time_s" not in values:
        camera = camera.metered(scene)
    return Shot(scene, camera)
