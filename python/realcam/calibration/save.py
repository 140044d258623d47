"""Saving of calibrations: the format is chosen, the model stated in its terms, and the files written."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, NamedTuple

from .._core import InputError
from ..files import check_target, write_whole
from .formats import FORMATS
from .formats.format import Saved, Writer
from .models.terms import Inexpressible
from .stated_camera import StatedCamera


class _Written(NamedTuple):
    format: str
    writer: Writer


# Formats of suffixes that several formats share.
USUAL = {".yaml": "ros", ".yml": "opencv", ".xml": "opencv", ".json": "opencv", ".txt": "colmap", ".exr": "stmap"}
WRITERS = {f.name: _Written(f.name, f.writer) for f in FORMATS if f.writer is not None}


def save(cameras: Mapping[str, StatedCamera], path: str | os.PathLike[str], format: str | None) -> None:
    """See Calibration.save and Calibration.save_all; the keys are the names of the cameras in the file."""
    if not cameras:
        raise InputError("a calibration file needs at least one camera")
    target = check_target(path)
    chosen = _named(format) if format is not None else _of_path(target, list(cameras.values()))
    if chosen.writer.is_single and len(cameras) > 1:
        several = [name for name, written in WRITERS.items() if not written.writer.is_single]
        raise InputError(f"a file of format {chosen.format} holds one camera; those of {', '.join(several)} hold more")
    saved = [Saved(name, _values(camera, chosen), camera) for name, camera in cameras.items()]
    contents = chosen.writer.content(saved, target)
    for file in contents:
        check_target(file)
    for file, content in contents.items():
        write_whole(file, content)


def _named(name: str) -> _Written:
    if name not in WRITERS:
        reason = "is only read" if any(known.name == name for known in FORMATS) else "is unknown"
        raise InputError(f'the format "{name!s:.40}" {reason}; expected one of {", ".join(WRITERS)}')
    return WRITERS[name]


def _of_path(path: Path, cameras: Sequence[StatedCamera]) -> _Written:
    """Chooses by the whole name of the file, the format that the cameras were loaded from, or the suffix."""
    name = path.name.lower()
    matching = [(pattern, w) for w in WRITERS.values() for pattern in w.writer.patterns if fnmatch(name, pattern)]
    whole = [w for pattern, w in matching if not pattern.startswith("*.")]
    usual = [WRITERS[USUAL[path.suffix.lower()]]] if path.suffix.lower() in USUAL else [w for _, w in matching]
    own = [
        WRITERS[camera.format]
        for camera in cameras[:1]
        if camera.format in WRITERS and path.suffix.lower() in _suffixes(WRITERS[camera.format])
    ]
    found = [*whole, *own, *usual]
    if not found:
        raise InputError(
            f"{path}: no format has such names; expected a suffix such as .yaml, .json or .xml, or format= with one of "
            f"{', '.join(WRITERS)}"
        )
    return found[0]


def _suffixes(written: _Written) -> set[str]:
    return {Path(pattern).suffix for pattern in written.writer.patterns}


def _values(camera: StatedCamera, chosen: _Written) -> Mapping[str, Any]:
    """Returns a camera's parameters: those of its file if it is unchanged, so that they keep their last bit."""
    own = WRITERS.get(camera.format)
    if own is not None and own.writer.values is chosen.writer.values and camera.file_values:
        return camera.file_values
    try:
        return chosen.writer.values(camera)
    except Inexpressible as error:
        able = [name for name, written in WRITERS.items() if _is_expressible(camera, written)]
        raise InputError(
            f"the format {chosen.format} {error}, which {camera.model} needs; formats that hold this camera: "
            f"{', '.join(able) or 'none'}"
        ) from None


def _is_expressible(camera: StatedCamera, written: _Written) -> bool:
    try:
        written.writer.values(camera)
    except Inexpressible:
        return False
    return True
