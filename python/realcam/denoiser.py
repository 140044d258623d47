"""Intel's Open Image Denoise, from the extra realcam[denoise]."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from realcam_command import denoiser_library

from . import _core
from ._core import InputError

GUIDES = ("albedo", "normal")  #: the layers that it goes by


def opened(device: str = "auto") -> _core._Denoiser:
    """A denoiser, for one thread. device: as Image.denoised has it. Raises InputError, which says what to install."""
    return _core._Denoiser(device, 0, denoiser_library())


def denoised(pixels: np.ndarray, layers: Mapping[str, np.ndarray], device: str) -> tuple[np.ndarray, str]:
    """(H, W, 3) float32 exposure without noise, and the denoiser's name and version. Raises InputError, DeviceError."""
    if not all(name in layers for name in GUIDES):
        raise InputError(
            f"the denoiser wants the layers albedo and normal; render(..., layers={list(GUIDES)}) brings them"
        )
    denoiser = opened(device)
    return denoiser.denoised(pixels, layers["albedo"], layers["normal"], False), denoiser.name
