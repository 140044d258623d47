"""Interface of the readers of file formats."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, NoReturn

from ..files.document import Document
from ..stated_camera import StatedCamera


class Options(NamedTuple):
    """Values that the caller adds to those of the file. size: (width, height), pixels. crop_factor: of the camera."""

    size: tuple[int, int] | None = None
    crop_factor: float | None = None


Cameras = Mapping[str, Callable[[], StatedCamera]]


class Format(NamedTuple):
    """A file format.

    name: as in StatedCamera.format. matches: True if a document looks like a file of the format. cameras: the cameras
    of a file by name, each as a function that reads it.
    """

    name: str
    matches: Callable[[Document], bool]
    cameras: Callable[[Document, Options], Cameras]


def stated_size(document: Document, options: Options) -> tuple[int, int]:
    """Returns the size that the caller states, for a file that does not. Raises CalibrationFileError without one."""
    if options.size is None:
        document.fail("states no size of the picture; expected size=(width, height)")
    return options.size


def sole(name: str, read: Callable[[], StatedCamera]) -> Cameras:
    """Returns the cameras of a file with one camera."""
    return {name: read}


def unknown_model(document: Document, where: str, model: str, known: Mapping[str, object]) -> NoReturn:
    """Raises CalibrationFileError for a camera model without a reader."""
    document.fail(f'{where}: unknown camera model "{model:.40}"; expected one of {", ".join(known)}')
