"""Loading of calibration files: the format is found, the camera chosen, and the stated size checked."""

from __future__ import annotations

import os

from .._core import InputError
from .errors import CalibrationFileError
from .files.document import Document
from .formats import FORMATS
from .formats.format import Cameras, Format, Options
from .stated_camera import StatedCamera


def load(path: str | os.PathLike[str], camera: str | None, format: str | None, options: Options) -> StatedCamera:
    """See Calibration.load."""
    document = Document(path)
    cameras = _cameras(document, format, options)
    return _with_size(document, cameras[_chosen(document, list(cameras), camera)](), options)


def load_all(path: str | os.PathLike[str], format: str | None, options: Options) -> dict[str, StatedCamera]:
    """See Calibration.load_all."""
    document = Document(path)
    cameras = _cameras(document, format, options)
    if not cameras:
        document.fail("holds no camera")
    return {name: _with_size(document, read(), options) for name, read in cameras.items()}


def _cameras(document: Document, format: str | None, options: Options) -> Cameras:
    found = _format_named(format) if format is not None else _format_of(document)
    return found.cameras(document, options)


def _with_size(document: Document, camera: StatedCamera, options: Options) -> StatedCamera:
    """Returns the camera. Raises InputError if it has another size than the caller states."""
    if options.size is not None and camera.size != options.size:
        raise InputError(
            f"{document.path}: states a picture of {camera.size[0]} x {camera.size[1]} pixels, not "
            f"{options.size[0]} x {options.size[1]}; Calibration.resized converts it"
        )
    return camera


def _format_named(name: str) -> Format:
    for known in FORMATS:
        if known.name == name:
            return known
    raise InputError(f'unknown format "{name!s:.40}"; expected one of {", ".join(f.name for f in FORMATS)}')


def _format_of(document: Document) -> Format:
    matching = [known for known in FORMATS if known.matches(document)]
    if matching:
        return matching[0]
    raise CalibrationFileError(
        f"{document.path}: no known calibration format; expected one of {', '.join(f.name for f in FORMATS)}"
    )


def _chosen(document: Document, names: list[str], camera: str | None) -> str:
    shown = ", ".join(f'"{name:.40}"' for name in names[:12]) + (", ..." if names[12:] else "")
    if not names:
        document.fail("holds no camera")
    if camera is None:
        if len(names) > 1:
            document.fail(f"holds {len(names)} cameras; camera must be one of {shown}")
        return names[0]
    if camera not in names:
        document.fail(f'holds no camera "{camera!s:.40}"; expected {"one of " if names[1:] else ""}{shown}')
    return camera
