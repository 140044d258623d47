"""Outcome of the projection of a point, and of the ray of a pixel."""

from __future__ import annotations

from enum import IntEnum


class PointStatus(IntEnum):
    """Outcome for one point or pixel.

    OK: projected into the picture. OUTSIDE_PICTURE: projected beside it, where the model is still one to one. BEHIND:
    z <= 0, for a model that is a function of x / z. BEYOND_FOLD: the distortion has folded over between the axis and
    the point, so that the formula would yield a pixel of another direction. NO_PROJECTION: outside the domain of the
    model. Points with the last three have no pixel.
    """

    OK = 0
    OUTSIDE_PICTURE = 1
    BEHIND = 2
    BEYOND_FOLD = 3
    NO_PROJECTION = 4
