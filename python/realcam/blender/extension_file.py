"""Writes the Blender extension: the files of its folder, and a shader and a preset for each lens."""

from __future__ import annotations

import io
import json
import math
import os
import re
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from .._core import InputError, Lens, lens_names
from ..files import check_target, write_whole
from ..osl import focus_range, shader_text
from ..osl.expressible import check_expressible

_FOLDER = Path(__file__).with_name("extension")
# The earliest date of the zip format, so that the same lenses give the same bytes.
_DATE = (1980, 1, 1, 0, 0, 0)


def write_extension(
    path: str | os.PathLike[str],
    lenses: Sequence[Lens] | None = None,
    *,
    left_out: Callable[[str], None] | None = None,
) -> list[str]:
    """Writes the extension as a .zip for Blender's "Install from Disk", and returns the keys of its lenses.

    lenses: None: all bundled lenses. Each position of a zoom becomes a lens. A lens that OSL cannot express is skipped,
    and left_out is called with the reason. Raises InputError if no lens can be written, and ImageFileError.
    """
    check_target(path, (".zip",))
    expressible = []
    for lens in lenses if lenses is not None else [Lens.load(name) for name in lens_names()]:
        try:
            check_expressible(lens)
        except InputError as error:
            if left_out:
                left_out(str(error))
            continue
        expressible += [lens.zoomed(position) for position in lens.zoom_positions] or [lens]
    if not expressible:
        raise InputError("none of the lenses can be written as OSL")
    shaders = [shader_text(lens) for lens in expressible]  # not in threads, which Ctrl-C would wait for
    figures = {_key(lens): _figures(lens, text) for lens, text in zip(expressible, shaders, strict=True)}
    if len(figures) < len(expressible):
        raise InputError("two of the lenses have the same name")
    files = {
        str(file.relative_to(_FOLDER)): file.read_text(encoding="utf-8")
        for file in sorted(_FOLDER.rglob("*"))
        if file.suffix in (".py", ".toml")
    }
    files["lenses/lenses.json"] = json.dumps(figures, indent=1, ensure_ascii=False)
    for (key, about), text in zip(figures.items(), shaders, strict=True):
        files[f"lenses/{key}.osl"] = text
        files[f"presets/camera/{_file_name(about['title'])}.py"] = _PRESET.format(key=key)
    write_whole(path, _zipped(files))
    return list(figures)


# Camera preset of a lens.
_PRESET = """\
import bpy
bpy.context.camera.realcam.film = 'lens'
bpy.context.camera.realcam.lens = {key!r}
"""


def _key(lens: Lens) -> str:
    """Key of a lens, which is also its file name in the extension: a valid path component on any system."""
    name = f"{lens.name}-at-{lens.zoom_position}" if lens.zoom_position else lens.name
    return re.sub(r"[^\w. -]", "_", name)[:80].strip(". ") or "lens"


def _figures(lens: Lens, text: str) -> dict[str, Any]:
    """Data of a lens for lenses.json. text: its shader."""
    zoom = f", at {lens.zoom_position}" if lens.zoom_position else ""
    return {
        "title": (lens.title or lens.name) + zoom,
        "source": lens.source,
        "name": lens.name,
        "zoom": lens.zoom_position,
        "f_number": round(lens.wide_open().f_number, 4),
        "focal_length_mm": round(lens.focused(math.inf).first_order().effective_focal_length_mm, 3),
        "nearest_m": focus_range(lens).nearest_m,
        "film_mm": lens.film_mm,
        "disperses": "int dispersion = 1" in text,
    }


def _file_name(title: str) -> str:
    """Name of a lens's preset, which Blender shows without underscores."""
    return "realcam_" + "".join(c if c.isalnum() or c in "-." else "_" for c in title[:80])


def _zipped(files: dict[str, str]) -> bytes:
    """Zip archive of texts by file name."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name, _DATE), text, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()
