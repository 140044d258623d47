"""Intel's Open Image Denoise, from the extra realcam[denoise]."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ._core import InputError


def denoised(pixels: np.ndarray, layers: Mapping[str, np.ndarray]) -> tuple[np.ndarray, str]:
    """(H, W, 3) float32 exposure without noise, and the denoiser's name and version. Raises InputError."""
    missing = [name for name in ("albedo", "normal") if name not in layers]
    if missing:
        raise InputError(
            f"the denoiser wants the layers albedo and normal; render(..., layers={['albedo', 'normal']}) brings them"
        )
    try:
        import pyoidn
    except ImportError as error:
        raise InputError(f"Open Image Denoise is not here ({error}); pip install realcam[denoise] brings it") from None
    # Both layers are means over the samples of the picture, with their noise in them: they are no clean guides.
    result: np.ndarray = pyoidn.denoise(
        np.asarray(pixels, np.float32),
        albedo=np.asarray(layers["albedo"], np.float32),
        normal=np.asarray(layers["normal"], np.float32),
        hdr=True,
    )
    return np.maximum(result, 0), f"Open Image Denoise {pyoidn.version.oidn_version}"
