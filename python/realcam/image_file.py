"""Picture files. What reads and writes them is the C++ code that the executable has; it is loaded when it is needed."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from ._core import ImageFileError, InputError
from .files import system_name

if TYPE_CHECKING:
    from .image import Image


def read_environment(path: str | os.PathLike[str]) -> np.ndarray:
    """A latitude-longitude picture as (H, W, 3) float32, linear, row 0 up: what Scene.with_environment takes.

    Values of EXR and HDR are cd/m^2; 8 and 16 bits are sRGB, with white as 1 cd/m^2. Colours of other primaries, as an
    EXR or HDR names them, become those of Rec. 709. OpenEXR's environment maps (attribute envmap) have its directions,
    and may be cube maps. Negative values become 0, with a warning. Raises ImageFileError, also where they are more than
    a twentieth of the light, or a value is none up to 1e20.
    """
    pixels, messages = _pictures().read_environment(system_name(path))
    for message in messages:
        warnings.warn(message, stacklevel=2)
    return pixels  # type: ignore[no-any-return]


def write_image(image: Image, path: str | os.PathLike[str], tone: str) -> None:
    """Raises ImageFileError, InputError."""
    if tone not in ("film", "linear"):
        raise InputError(f'unknown tone curve "{tone}"; film or linear is wanted')
    entries = image.metadata()
    try:
        _pictures().write_picture(
            system_name(path),
            image.pixels,
            image.depth,
            image.camera,
            image.spp,
            image.seed,
            tone == "film",
            dict(image.layers),
            list(image.object_names),
            list(image.material_names),
            image.transport == "whitted",
            image.clamp_cd_m2,
            image.denoiser,
            entries.get("realcam:effects", ""),
            entries.get("realcam:illuminant", ""),
            entries.get("realcam:coatings", ""),
            entries.get("realcam:plan", ""),
        )
    except TypeError:
        raise InputError(
            "pixels, depth, camera, spp, seed, layers and names of the image must be such as rc.render gives"
        ) from None


def write_codes(codes: np.ndarray, path: str | os.PathLike[str], entries: Mapping[str, str]) -> None:
    """Writes (H, W, 3) uint8 sRGB as .png with metadata. Raises ImageFileError."""
    _pictures().write_codes(system_name(path), codes, list(entries.items()))


def read_film(path: str | os.PathLike[str]) -> tuple[np.ndarray, dict[str, str]]:
    """The film's exposure in an .exr of realcam's, (H, W, 3) float32 lux seconds, and the "realcam:..." entries of its
    metadata. Raises ImageFileError.
    """
    exposure, entries = _pictures().read_film(system_name(path))
    return exposure, dict(entries)


def _pictures() -> ModuleType:
    try:
        from . import _pictures
    except ImportError as error:
        raise ImageFileError(f"this build of realcam cannot read and write pictures: {error}") from None
    return _pictures
