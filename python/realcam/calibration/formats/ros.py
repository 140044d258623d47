"""ROS camera_info files (sensor_msgs/CameraInfo, camera_calibration_parsers). First pixel: 0."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import plain, yaml_content
from ..models.central import CentralModel, camera_matrix, shift
from ..models.opencv_models import fisheye_coefficients, fisheye_model, opencv_coefficients, pinhole_model
from ..models.projections import Equidistant
from ..models.terms import terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, sole

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
    if projection in entries:
        entries.matrix(projection, 3, 4)
    name = entries.values.get("camera_name")
    return StatedCamera(
        _model(entries).transformed(region),
        size,
        entries.text("distortion_model"),
        name=name if isinstance(name, str) else "",
        format="ros",
        pixel_origin=0.0,
        extrinsics=extrinsics,
        file_values=dict(entries.values),
    )


def _matches(document: Document) -> bool:
    data = document.mapping()
    return "distortion_model" in data and any(key in data for key in ("camera_matrix", "K", "k"))


def cameras(document: Document, options: Options) -> Cameras:
    return sole(lambda: _camera(Entries(document, document.mapping())))


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    if isinstance(terms.projection, Equidistant):
        terms.within_90_degrees()
        model, D = "equidistant", fisheye_coefficients(terms)
    else:
        D = opencv_coefficients(terms, (5, 8, 12, 14))
        model = "plumb_bob" if len(D) == 5 else "rational_polynomial"
    K = camera_matrix(*terms.pixel_matrix(0.0))
    R = camera.extrinsics.get("rectified_from_camera", np.eye(4))[:3, :3]
    return {
        "image_width": camera.size[0],
        "image_height": camera.size[1],
        "camera_name": camera.name or "camera",
        "camera_matrix": _matrix(K),
        "distortion_model": model,
        "distortion_coefficients": _matrix(np.array([D])),
        "rectification_matrix": _matrix(R),
        "projection_matrix": _matrix(np.column_stack([K, np.zeros(3)])),
    }


def _matrix(values: Array) -> dict[str, Any]:
    return {"rows": values.shape[0], "cols": values.shape[1], "data": plain(values.ravel())}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    return {path: yaml_content(cameras[0].values)}


FORMAT: Format = Format(
    "ros", _matches, cameras, Writer(("*camera_info*.yaml", "*.yaml"), _values, _content, is_single=True)
)
