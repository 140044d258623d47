"""Pictures, shot files and lens files that a window writes."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import tomlkit

from .._core import InputError, Lens, Sensor, lens_names
from ..files import write_whole
from ..image import Image
from .camera_controls import CameraControls, opened

PICTURE_SUFFIXES = (".png", ".exr", ".dng")
_FILES_OF_A_SHOT = ("scene", "environment", "texture")  # keys that name files beside it


def save_picture(image: Image, path: Path, tone: str) -> None:
    """Writes .png, .exr, or .dng as an ideal sensor records it. Raises InputError and ImageFileError."""
    if path.suffix.lower() not in PICTURE_SUFFIXES:
        raise InputError(f'"{path.name}": {", ".join(PICTURE_SUFFIXES)} is wanted')
    if path.suffix.lower() == ".dng":
        from .. import dng

        dng.write(Sensor.load("ideal").expose(image), path)
    else:
        image.save(path, tone)


def save_lens(lens: Lens, path: Path) -> list[str]:
    """Writes .toml, .zmx or .seq; returns what such a file cannot say. Raises InputError and ImageFileError."""
    if path.suffix.lower() not in (".toml", ".zmx", ".seq"):
        raise InputError(f'"{path.name}": .toml, .zmx or .seq is wanted')
    content, left_out = lens._file_content(path)
    write_whole(path, content)
    return left_out


def save_shot(source: Path, controls: CameraControls, effects: list[str], path: Path) -> list[Path]:
    """Writes the shot as it stands, from the file that it was read from; returns all files that were written.

    A lens that is none of the bundled ones is written beside it. Raises InputError and ImageFileError.
    """
    if path.suffix.lower() != ".toml":
        raise InputError(f'"{path.name}": a shot file is a .toml')
    shot: Any = tomlkit.parse(source.read_text(encoding="utf-8"))
    for key in _FILES_OF_A_SHOT:
        if key in shot:
            shot[key] = os.path.relpath(source.parent / str(shot[key]), path.parent)
    written = [path]
    lens = controls.lens
    if lens.name in lens_names() and _is_bundled(lens):
        shot["lens"] = lens.name
    else:
        beside = path.with_name(f"{path.stem}-lens.toml")
        lens.save(beside)
        written.insert(0, beside)
        shot["lens"] = f"./{beside.name}"
    for key in ("blades", "blade_rounding", "blade_rotation_deg", "zoom", "f_number"):
        shot.pop(key, None)  # the lens has them
    if controls.zoom is not None:
        shot["zoom"] = controls.zoom
    widest = controls.body.first_order().f_number
    if controls.f_number is not None and controls.f_number > widest:
        shot["f_number"] = controls.f_number
    film, pose = controls.film, controls.pose
    shot["model"] = controls.model
    shot["focus_m"] = controls.focus_m
    shot["film_mm"] = [film.width_mm, film.height_mm]
    shot["resolution"] = list(film.resolution)
    shot["position_m"], shot["look_at_m"], shot["up"] = list(pose.position_m), list(pose.look_at_m), list(pose.up)
    shot["exposure_time_s"] = controls.exposure_time_s
    shot["iso"] = controls.iso
    shot["effects"] = effects
    write_whole(path, tomlkit.dumps(shot).encode())
    return written


def _is_bundled(lens: Lens) -> bool:
    """Not one that was edited under its old name; nor one with another diaphragm, which the shot file had."""
    bundled = opened(Lens.load(lens.name))
    if bundled == lens:
        return True
    # One that a shot has focused has come back to infinity: there to the last digits, and its file may say a place
    # beside that.
    bundled, lens = bundled.focused(math.inf), lens.focused(math.inf)
    if len(lens.surfaces) != len(bundled.surfaces):
        return False
    pairs = zip(lens.surfaces, bundled.surfaces, strict=True)
    if not all(math.isclose(a.thickness_mm, b.thickness_mm, rel_tol=1e-9, abs_tol=1e-9) for a, b in pairs):
        return False
    same = {
        index: mine.replace(thickness_mm=bundled.surfaces[index].thickness_mm)
        for index, mine in enumerate(lens.surfaces)
    }
    return lens.with_surfaces(same) == bundled
