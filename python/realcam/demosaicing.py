"""Demosaicing, by colour-demosaicing from the extra realcam[raw]."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ._core import InputError

METHODS = ("menon", "malvar", "bilinear")
# Pixels by which a mosaic is extended beyond its edges, mirrored about its last pixels so that the filter pattern
# continues. The library itself repeats the last pixels, which puts values of one filter where another's belong.
MARGIN = 8


def demosaiced(mosaic: np.ndarray, pattern: str, method: str) -> np.ndarray:
    """Demosaics a (H, W) mosaic, best white-balanced beforehand, to (H, W, 3) float32. Raises InputError."""
    if method not in METHODS:
        raise InputError(f"unknown demosaicing {method!r:.60}; expected one of {', '.join(METHODS)}")
    if min(mosaic.shape) < 2:
        raise InputError("the mosaic must have at least 2 x 2 pixels")
    functions = _functions()
    continued = np.pad(mosaic, MARGIN, mode="reflect")
    colors = functions[method](continued, pattern)[MARGIN:-MARGIN, MARGIN:-MARGIN]
    return np.array(colors, np.float32)


def check_is_installed() -> None:
    """Raises InputError if colour-demosaicing is not installed."""
    _functions()


def _functions() -> dict[str, Any]:
    """Returns the library's functions, keyed by METHODS. Raises InputError if it is not installed."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # colour-science warns of missing optional packages
            from colour_demosaicing.bayer import (
                demosaicing_CFA_Bayer_bilinear,
                demosaicing_CFA_Bayer_Malvar2004,
                demosaicing_CFA_Bayer_Menon2007,
            )
    except ImportError as error:
        raise InputError(
            f"colour-demosaicing is not installed ({error}); pip install realcam[raw] installs it"
        ) from None
    return {
        "menon": demosaicing_CFA_Bayer_Menon2007,
        "malvar": demosaicing_CFA_Bayer_Malvar2004,
        "bilinear": demosaicing_CFA_Bayer_bilinear,
    }
