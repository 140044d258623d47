"""Interface of the readers and writers of file formats."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from ..arrays import Array
from ..files.document import Document
from ..stated_camera import StatedCamera


class Options(NamedTuple):
    """Values that the caller adds to those of the file.

    size: (width, height), pixels. crop_factor: of the camera. camera_matrix: (3, 3) K in realcam's pixels, for maps.
    """

    size: tuple[int, int] | None = None
    crop_factor: float | None = None
    camera_matrix: Array | None = None


Cameras = Mapping[str, Callable[[], StatedCamera]]


class Saved(NamedTuple):
    """A camera to be written. name: unique in the file. values: its parameters as the format states them."""

    name: str
    values: Mapping[str, Any]
    camera: StatedCamera


class Writer(NamedTuple):
    """How a format is written.

    patterns: file names of the format, as shell patterns; "*.yaml" makes it the usual format of a suffix. values: the
    parameters of a camera as the format states them; raises Inexpressible. content: the bytes of each file, of which
    the given path is the first. is_single: True if a file has one camera.
    """

    patterns: tuple[str, ...]
    values: Callable[[StatedCamera], Mapping[str, Any]]
    content: Callable[[Sequence[Saved], Path], Mapping[Path, bytes]]
    is_single: bool = False


class Format(NamedTuple):
    """A file format.

    name: as in StatedCamera.format. matches: True if a document looks like a file of the format. cameras: the cameras
    of a file by name, each as a function that reads it. writer: None if the format is only read.
    """

    name: str
    matches: Callable[[Document], bool]
    cameras: Callable[[Document, Options], Cameras]
    writer: Writer | None = None


def stated_size(document: Document, options: Options) -> tuple[int, int]:
    """Returns the size that the caller states, for a file that does not. Raises CalibrationFileError without one."""
    if options.size is None:
        document.fail("states no size of the picture; expected size=(width, height)")
    return options.size


def sole(read: Callable[[], StatedCamera]) -> Cameras:
    """Returns the cameras of a file with one camera, which has no name of its own."""
    return {"camera": read}


def unknown_model(document: Document, where: str, model: str, known: Mapping[str, object]) -> NoReturn:
    """Raises CalibrationFileError for a camera model without a reader."""
    document.fail(f'{where}: unknown camera model "{model:.40}"; expected one of {", ".join(known)}')
