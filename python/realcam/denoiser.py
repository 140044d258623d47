"""Denoising by Intel's Open Image Denoise, from the extra realcam[denoise]."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from . import _core
from ._core import InputError
from .installation import denoiser_library

GUIDES = ("albedo", "normal", "traced_light")  #: two guide layers, and the light that is not denoised


def is_installed() -> bool:
    """Returns True if Open Image Denoise is installed."""
    return bool(denoiser_library())


def opened(device: str = "auto") -> _core._Denoiser:
    """Opens a denoiser for use by one thread. device: as in Image.denoised. Raises InputError if not installed."""
    return _core._Denoiser(device, 0, denoiser_library())


def denoised(pixels: np.ndarray, layers: Mapping[str, np.ndarray], device: str) -> tuple[np.ndarray, str]:
    """Returns the denoised (H, W, 3) float32 exposure, and the denoiser's name and version.

    Raises InputError, DeviceError.
    """
    if not all(name in layers for name in GUIDES):
        raise InputError(
            f"the denoiser requires the layers {', '.join(GUIDES)}; render(..., layers={list(GUIDES)}) adds them"
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
    """Returns the denoised (H, W, 3) exposure.

    pixels: exposure; all arrays have the shape (H, W, 3). traced_light (lamps, ghosts, starbursts by light tracing) is
    part of it, and is not denoised: its noise is fine grain on the discs of lamps, which the network takes for detail
    and spreads. fast: lower quality in less time. Raises Cancelled if `progress`, which is called meanwhile with 0,
    returns False.
    """
    sampled_light = np.maximum(pixels - traced_light, np.float32(0))  # light of the pixels' own samples
    result: np.ndarray = denoiser.denoised(sampled_light, albedo, normal, fast, progress)
    # If light-traced lamps dominate a pixel, part of its path-traced light is theirs, too, and its noise is
    # invisible: such pixels keep it undenoised.
    share = traced_light / np.maximum(traced_light + result, np.float32(1e-30))
    result += share * (sampled_light - result) + traced_light
    return result
