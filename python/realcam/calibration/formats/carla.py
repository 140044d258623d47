"""CARLA: attributes of an RGB camera as JSON. First pixel: 0.5.

Source: CARLA's documentation, "Sensors reference". The equation of lens_k and lens_kcube is not published, so only
cameras in which both are 0 are read; CARLA's default of lens_k is -1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..files.entries import Entries
from ..files.output import json_content, number
from ..models.central import camera_matrix
from ..models.opencv_models import pinhole_model
from ..models.projections import Perspective
from ..models.terms import Inexpressible, is_undistorted, terms_of
from ..stated_camera import StatedCamera
from .format import Format, Saved, Writer, sole

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


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    terms.projected_by(Perspective)
    if not is_undistorted(terms):
        raise Inexpressible("has no published distortion")
    width, height = camera.size
    fx, fy, cx, cy = terms.pixel_matrix(0.5)
    # A pixel moves by less than the tolerance if the matrix differs by less.
    if max(abs(fx - fy), abs(cx - width / 2), abs(cy - height / 2)) > 1e-10:
        raise Inexpressible("has square pixels and the principal point in the centre of the picture")
    fov = 2 * float(np.degrees(np.arctan(width / 2 / fx)))
    stated = {"image_size_x": width, "image_size_y": height, "fov": fov, "lens_k": 0.0, "lens_kcube": 0.0}
    return {"type": "sensor.camera.rgb", **{key: number(value) for key, value in stated.items()}}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    return {path: json_content(cameras[0].values)}


FORMAT: Format = Format(
    "carla",
    lambda d: "image_size_x" in d.mapping() and "fov" in d.mapping(),
    lambda document, options: sole(lambda: _camera(Entries(document, document.mapping()))),
    Writer(("*.json",), _values, _content, is_single=True),
)
