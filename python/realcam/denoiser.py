"""Intel's Open Image Denoise, from the extra realcam[denoise]."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from realcam_command import denoiser_library

from . import _core
from ._core import InputError

GUIDES = ("albedo", "normal", "traced_light")  #: the layers that it goes by, and what is kept out of it


def is_installed() -> bool:
    return bool(denoiser_library())


def opened(device: str = "auto") -> _core._Denoiser:
    """A denoiser, for one thread. device: as Image.denoised has it. Raises InputError, which says what to install."""
    return _core._Denoiser(device, 0, denoiser_library())


def denoised(pixels: np.ndarray, layers: Mapping[str, np.ndarray], device: str) -> tuple[np.ndarray, str]:
    """(H, W, 3) float32 exposure without noise, and the denoiser's name and version. Raises InputError, DeviceError."""
    if not all(name in layers for name in GUIDES):
        raise InputError(
            f"the denoiser wants the layers {', '.join(GUIDES)}; render(..., layers={list(GUIDES)}) brings them"
        )
    denoiser = opened(device)
    return without_noise(denoiser, pixels, *(layers[name] for name in GUIDES)), denoiser.name


def without_noise(
    denoiser: _core._Denoiser,
    pixels: np.ndarray,
    albedo: np.ndarray,
    normal: np.ndarray,
    traced_light: np.ndarray,
    *,
    fast: bool = False,
    progress: Callable[[float], bool] | None = None,
) -> np.ndarray:
    """(H, W, 3) exposure. The light that was traced from lights stays as it is: its noise is fine grain on the discs of
    lamps, which the network takes for detail and spreads. Raises Cancelled where progress, which is called
    meanwhile, returns False."""
    rest = np.maximum(pixels - traced_light, np.float32(0))
    result: np.ndarray = denoiser.denoised(rest, albedo, normal, fast, progress)
    # Where lamps outshine the rest, a part of it is their light too, and its noise is not seen.
    share = traced_light / np.maximum(traced_light + result, np.float32(1e-30))
    result += share * (rest - result) + traced_light
    return result
