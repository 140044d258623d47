"""Calibrations of Basalt (calibration.json). First pixel: 0.

Sources: basalt-headers, include/basalt/camera; V. Usenko, N. Demmel and D. Cremers, arXiv 1807.08957.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..models.central import CentralModel, camera_matrix
from ..models.distortion import BrownConrady
from ..models.opencv_models import distortion_of, fisheye_distortion
from ..models.projections import DoubleSphere, Equidistant, ExtendedUnified, FieldOfViewAngle, Perspective, Projection
from ..stated_camera import StatedCamera
from ..transforms import inverse_of, rigid
from .format import Cameras, Format, Options

Make = Callable[[Sequence[float]], tuple[Projection, BrownConrady]]

# Names of the parameters behind fx, fy, cx, cy, and the projection and distortion that they describe.
MODELS: dict[str, tuple[str, Make]] = {
    "pinhole": ("", lambda _: (Perspective(), BrownConrady())),
    "pinhole-radtan8": ("k1 k2 p1 p2 k3 k4 k5 k6", lambda p: (Perspective(), distortion_of(p))),
    "kb4": ("k1 k2 k3 k4", lambda p: (Equidistant(np.pi), fisheye_distortion(p))),
    "ds": ("xi alpha", lambda p: (DoubleSphere(p[0], p[1]), BrownConrady())),
    "eucm": ("alpha beta", lambda p: (ExtendedUnified(p[0], p[1]), BrownConrady())),
    "ucm": ("alpha", lambda p: (ExtendedUnified(p[0], 1.0), BrownConrady())),
    "fov": ("w", lambda p: (FieldOfViewAngle(p[0]), BrownConrady())),
}


def _camera(body: Entries, index: int) -> StatedCamera:
    entries = list(body.children("intrinsics"))[index]
    model = entries.choice("camera_type", MODELS)
    names, make = MODELS[model]
    values = entries.child("intrinsics")
    projection, distortion = make([values.number(key) for key in names.split()])
    matrix = camera_matrix(
        values.positive("fx"), values.positive("fy"), values.number("cx") + 0.5, values.number("cy") + 0.5
    )
    return StatedCamera(
        CentralModel(projection, distortion, matrix),
        _size(body, index),
        model,
        name=str(index),
        format="basalt",
        pixel_origin=0.0,
        extrinsics=_extrinsics(body, index),
        file_values=dict(values.values),
    )


def _size(body: Entries, index: int) -> tuple[int, int]:
    sizes = body.numbers("resolution")
    if len(sizes) < 2 * index + 2:
        body.fail("resolution", "[width, height] of each camera")
    pair = Entries(body.document, {"resolution": sizes[2 * index : 2 * index + 2]}, body.where)
    return pair.size("resolution")


def _extrinsics(body: Entries, index: int) -> dict[str, Array]:
    if "T_imu_cam" not in body:
        return {}
    poses = list(body.children("T_imu_cam"))
    if len(poses) <= index:
        body.fail("T_imu_cam", "a pose of each camera")
    pose = poses[index]
    w, x, y, z = (pose.number(key) for key in ("qw", "qx", "qy", "qz"))
    if not w * w + x * x + y * y + z * z:
        pose.fail("qw", "a quaternion that is not 0")
    return {"camera_from_imu": inverse_of(rigid((w, x, y, z), [pose.number(key) for key in ("px", "py", "pz")]))}


def _body(document: Document) -> Entries:
    return Entries(document, document.mapping()).child("value0")


def _matches(document: Document) -> bool:
    value = document.mapping().get("value0")
    return isinstance(value, dict) and "intrinsics" in value


def cameras(document: Document, options: Options) -> Cameras:
    body = _body(document)
    count = len(list(body.children("intrinsics")))
    return {str(i): lambda i=i: _camera(body, i) for i in range(count)}  # type: ignore[misc]


FORMAT = Format("basalt", _matches, cameras)
