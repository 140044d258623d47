"""Exposure meter and rangefinder, evaluated on a picture."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...rec709 import LUMINANCE
from .picture_request import Point

_METERED_PIXELS = 96  # width of the subsampled picture for metering, as in Camera.metered


def middle_grey_lx_s(iso: float, compensation_ev: float) -> float:
    """Film exposure that develops to middle grey (see realcam.develop), shifted by compensation_ev stops."""
    return 10 * 2**compensation_ev / iso


def metered_exposure_lx_s(exposure_lx_s: NDArray[np.float32]) -> float:
    """Metered exposure of a picture (height, width, 3); not positive or not finite if there is nothing to meter."""
    step = max(1, exposure_lx_s.shape[1] // _METERED_PIXELS)
    return float(_core._metered_exposure(exposure_lx_s[::step, ::step]))


def point_at(
    u: float,
    v: float,
    exposure_lx_s: NDArray[np.float32],
    depth_m: NDArray[np.float32],
    exposure_time_s: float,
    spot: float = 0.03,
) -> Point:
    """Distance and illuminance at u, v (0 to 1, from the upper left corner). spot: width of the metering spot, relative
    to the picture's."""
    height, width = depth_m.shape
    row, column = min(int(v * height), height - 1), min(int(u * width), width - 1)
    radius = max(1, round(0.5 * spot * width))
    spot_pixels = np.s_[max(0, row - radius) : row + radius + 1, max(0, column - radius) : column + radius + 1]
    depths_m = depth_m[max(0, row - 1) : row + 2, max(0, column - 1) : column + 2]
    hits_m = depths_m[np.isfinite(depths_m)]
    return Point(
        distance_m=float(np.median(hits_m)) if hits_m.size else math.inf,
        illuminance_lx=float(np.mean(exposure_lx_s[spot_pixels] @ LUMINANCE)) / exposure_time_s,
    )
