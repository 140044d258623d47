"""File contents of saved pictures, shots and lenses."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import simplejpeg
import tomlkit

from .._core import InputError, Lens, RenderSettings, Sensor, lens_names
from .._core import _shot_keys as shot_keys
from ..image import Image
from ..ocio import BUILT_IN, OcioView
from .camera_controls import CameraControls
from .shot_source import CALIBRATION_FILES, CALIBRATION_KEYS, ShotSource

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg", ".exr", ".dng")
#: Suffixes of the files that a picture, a shot or a lens can be saved as.
SUFFIXES = {"picture": PICTURE_SUFFIXES, "shot": (".toml",), "lens": (".toml", ".zmx", ".seq", ".json", ".roa")}
# Keys with paths relative to the shot file, of the shot and of its table [calibration].
_FILES_OF_A_SHOT = ("scene", "environment", "texture", "ocio", *CALIBRATION_FILES)
_FILES_OF_A_CALIBRATION = ("file", "vignetting")
_JPEG_QUALITY = 95


def check_suffix(what: str, name: str) -> None:
    """Checks a file name's suffix. what: a key of SUFFIXES. Raises InputError if the suffix is not valid for it."""
    if Path(name).suffix.lower() not in SUFFIXES[what]:
        *others, last = SUFFIXES[what]
        expected = f"{', '.join(others)} or {last}" if others else last
        raise InputError(f'"{name:.80}": expected a {what} file whose name ends in {expected}')


def picture_content(image: Image, name: str, tone: str | OcioView) -> bytes:
    """Returns the content of a .png, .jpg, .exr, or of a .dng as recorded by an ideal sensor. Raises InputError and
    ImageFileError."""
    check_suffix("picture", name)
    suffix = Path(name).suffix.lower()
    if suffix in (".jpg", ".jpeg"):
        codes = image.developed(tone)
        jpeg = bytes(simplejpeg.encode_jpeg(codes, quality=_JPEG_QUALITY, colorsubsampling="444"))
        return _with_comment(jpeg, f"realcam:denoiser {image.denoiser}") if image.denoiser else jpeg
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"picture{suffix}"
        if suffix == ".dng":
            Sensor.load("ideal").expose(image).save(path)
        else:
            image.save(path, tone)
        return path.read_bytes()


def _with_comment(jpeg: bytes, text: str) -> bytes:
    """Inserts a COM segment (ITU-T T.81) after the JFIF segment, which always comes first."""
    begin = 4 + int.from_bytes(jpeg[4:6], "big")
    comment = text.encode()
    return jpeg[:begin] + b"\xff\xfe" + (len(comment) + 2).to_bytes(2, "big") + comment + jpeg[begin:]


def lens_content(lens: Lens, name: str) -> tuple[bytes, list[str]]:
    """Returns the content of a lens file, by its suffix, and the properties that the format cannot express. Raises
    InputError."""
    check_suffix("lens", name)
    return lens._file_content(name)


def shot_contents(
    source: ShotSource, controls: CameraControls, effects: list[str], path: Path, tone: str | OcioView | None = None
) -> dict[Path, bytes]:
    """Returns the contents of the files to write: the current shot, and its lens unless it is a bundled one.

    effects: in the notation of shot files. path: of the shot file; relative paths in the shot start there. Keys that
    the bench does not change are copied from the source. tone: of the bench; None: the source's. Raises InputError.
    """
    check_suffix("shot", path.name)
    shot: Any = tomlkit.parse(source.text)
    is_table = isinstance(shot.get("calibration"), Mapping)
    tables = [(shot, _FILES_OF_A_SHOT), (shot["calibration"] if is_table else {}, _FILES_OF_A_CALIBRATION)]
    for table, keys in tables:
        for key in keys:
            if isinstance(table.get(key), str) and not table[key].startswith(BUILT_IN):
                table[key] = os.path.relpath(source.folder / str(table[key]), path.absolute().parent)
    contents = {}
    values = {**controls.shot_values(), "effects": effects}
    if isinstance(tone, OcioView):
        config = tone.config
        if not config.startswith(BUILT_IN):
            config = os.path.relpath(config, path.absolute().parent)
        values |= {"ocio": config, "display": tone.display, "view": tone.view}
        shot.pop("tone", None)
    lens = controls.lens
    if lens.name in lens_names() and _is_bundled(lens):
        values["lens"] = lens.name
    else:
        beside = path.with_name(f"{path.stem}-lens.toml")
        contents[beside], _ = lens_content(lens, beside.name)
        values["lens"] = f"./{beside.name}"
    described = {*values, *(CALIBRATION_KEYS if controls.geometry is not None else ())}
    for key in ("key", "pose", *(key.name for key in shot_keys() if key.group == "Camera")):
        if key not in described:
            shot.pop(key, None)  # is described by the lens, has its default, or would override the values
    shot.update(values)
    if RenderSettings(illuminant="D65").with_(effects=effects).illuminant is None:
        shot.pop("illuminant", None)  # applies only to effects that are off now
        if "lens_filter" in shot:  # loses its colour with them
            shot["lens_filter"] = (
                RenderSettings(lens_filter=shot["lens_filter"].unwrap()).with_(effects=effects).lens_filter
            )
    contents[path] = tomlkit.dumps(shot).encode()
    return contents


def _is_bundled(lens: Lens) -> bool:
    """True if the lens equals the bundled lens of its name: neither edited, nor with another diaphragm from a shot."""
    bundled = Lens.load(lens.name).wide_open()
    if lens.zoom_position in bundled.zoom_positions:
        bundled = bundled.zoomed(lens.zoom_position)
    if bundled == lens:
        return True
    # A lens focused by a shot was refocused to infinity, which is exact only up to rounding; and the focus in the lens
    # file may differ from infinity. Compares both at infinity.
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
