"""ROS camera_info files (sensor_msgs/CameraInfo, camera_calibration_parsers). First pixel: 0."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..models.central import CentralModel, shift
from ..models.opencv_models import fisheye_model, pinhole_model
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, sole

# Models by name, with the numbers of coefficients that they may have.
MODELS: dict[str, tuple[Callable[[Array, list[float]], CentralModel], tuple[int, ...]]] = {
    "plumb_bob": (pinhole_model, (0, 4, 5)),
    "rational_polynomial": (pinhole_model, (8, 12, 14)),
    "equidistant": (fisheye_model, (4,)),
    "fisheye": (fisheye_model, (4,)),
}


def _key(entries: Entries, *names: str) -> str:
    return next((name for name in names if name in entries), names[0])


def _model(entries: Entries) -> CentralModel:
    make, counts = MODELS[entries.choice("distortion_model", MODELS)]
    matrix = entries.matrix(_key(entries, "camera_matrix", "K", "k"), 3, 3)
    if matrix[0, 0] <= 0 or matrix[1, 1] <= 0 or matrix[2].tolist() != [0, 0, 1]:
        entries.fail(_key(entries, "camera_matrix", "K", "k"), "fx 0 cx, 0 fy cy, 0 0 1 with positive fx and fy")
    D = entries.numbers(_key(entries, "distortion_coefficients", "D", "d"), *counts)
    return make(shift(0.5, 0.5) @ matrix, D)


def _region(entries: Entries) -> tuple[np.ndarray, tuple[int, int]]:
    """Returns the map from pixels of the full picture to those of a binned part of it, and the part's size."""
    width, height = entries.size(_key(entries, "image_width", "width"), _key(entries, "image_height", "height"))
    steps = [max(1.0, entries.number(f"binning_{axis}", 1.0)) for axis in "xy"]
    left = top = 0.0
    if "roi" in entries:
        roi = entries.child("roi")
        left, top = roi.number("x_offset", 0.0), roi.number("y_offset", 0.0)
        # Both are 0 if the region is the whole picture.
        width, height = int(roi.number("width", 0.0)) or width, int(roi.number("height", 0.0)) or height
    size = max(1, int(width / steps[0])), max(1, int(height / steps[1]))
    return np.diag([1 / steps[0], 1 / steps[1], 1.0]) @ shift(-left, -top), size


def _camera(entries: Entries) -> StatedCamera:
    region, size = _region(entries)
    extrinsics = {}
    rotation = _key(entries, "rectification_matrix", "R", "r")
    if rotation in entries:
        extrinsics["rectified_from_camera"] = np.eye(4)
        extrinsics["rectified_from_camera"][:3, :3] = entries.matrix(rotation, 3, 3)
    projection = _key(entries, "projection_matrix", "P", "p")
    values = {"projection_matrix": entries.matrix(projection, 3, 4)} if projection in entries else {}
    name = entries.values.get("camera_name")
    return StatedCamera(
        _model(entries).transformed(region),
        size,
        entries.text("distortion_model"),
        name=name if isinstance(name, str) else "",
        format="ros",
        pixel_origin=0.0,
        extrinsics=extrinsics,
        file_values=values,
    )


def _matches(document: Document) -> bool:
    data = document.mapping()
    return "distortion_model" in data and any(key in data for key in ("camera_matrix", "K", "k"))


def cameras(document: Document, options: Options) -> Cameras:
    return sole("camera", lambda: _camera(Entries(document, document.mapping())))


FORMAT = Format("ros", _matches, cameras)
