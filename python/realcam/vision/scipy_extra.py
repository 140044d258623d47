"""scipy, which comes with the extra realcam[vision]."""

from __future__ import annotations

from typing import Any

from .._core import InputError


def scipy_or_error() -> Any:
    """scipy with its submodules. Raises InputError where it is missing."""
    try:
        import scipy
        import scipy.optimize
        import scipy.spatial.transform
    except ImportError:
        raise InputError("scipy is missing, which camera models want; pip install realcam[vision]") from None
    return scipy
