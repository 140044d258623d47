"""CARLA: attributes of an RGB camera as JSON. First pixel: 0.5.

Source: CARLA's documentation, "Sensors reference". The equation of lens_k and lens_kcube is not published, so only
cameras in which both are 0 are read; CARLA's default of lens_k is -1.
"""

from __future__ import annotations

import numpy as np

from ..files.entries import Entries
from ..models.central import camera_matrix
from ..models.opencv_models import pinhole_model
from ..stated_camera import StatedCamera
from .format import Format, sole

DISTORTIONS = {"lens_k": -1.0, "lens_kcube": 0.0}  # with CARLA's defaults


def _camera(entries: Entries) -> StatedCamera:
    width, height = entries.size("image_size_x", "image_size_y")
    for key, default in DISTORTIONS.items():
        if entries.number(key, default):
            entries.fail(key, f"0, as the equation of CARLA's distortion is not published (its default is {default:g})")
    if not 0 < entries.number("fov") < 180:
        entries.fail("fov", "a horizontal angle of view in degrees between 0 and 180")
    f = width / 2 / float(np.tan(np.radians(entries.number("fov")) / 2))
    model = pinhole_model(camera_matrix(f, f, width / 2, height / 2))
    return StatedCamera(model, (width, height), "pinhole", format="carla", file_values=dict(entries.values))


FORMAT = Format(
    "carla",
    lambda d: "image_size_x" in d.mapping() and "fov" in d.mapping(),
    lambda document, options: sole("camera", lambda: _camera(Entries(document, document.mapping()))),
)
