"""Calibrations of Basalt (calibration.json). First pixel: 0.

Sources: basalt-headers, include/basalt/camera; V. Usenko, N. Demmel and D. Cremers, arXiv 1807.08957.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import json_content
from ..models.central import CentralModel, camera_matrix
from ..models.distortion import BrownConrady
from ..models.opencv_models import distortion_of, fisheye_coefficients, fisheye_distortion, opencv_coefficients
from ..models.projections import DoubleSphere, Equidistant, ExtendedUnified, FieldOfViewAngle, Perspective, Projection
from ..models.terms import Inexpressible, Terms, is_undistorted, terms_of
from ..rig import transforms_from
from ..stated_camera import StatedCamera
from ..transforms import inverse_of, quaternion, rigid
from .format import Cameras, Format, Options, Saved, Writer

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


OWN_KEYS = ("intrinsics", "T_imu_cam", "resolution", "vignette")  # with an element for each camera
# Basalt does not read a file without these; values of an ideal IMU for cameras of other formats.
IMU = {
    "calib_accel_bias": [0.0] * 9,
    "calib_gyro_bias": [0.0] * 12,
    "imu_update_rate": 200.0,
    "accel_noise_std": [0.016] * 3,
    "gyro_noise_std": [0.000282] * 3,
    "accel_bias_std": [0.001] * 3,
    "gyro_bias_std": [0.0001] * 3,
    "cam_time_offset_ns": 0,
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
        file_values=_stated(body, entries, index),
    )


def _stated(body: Entries, entries: Entries, index: int) -> dict[str, Any]:
    """Returns the values of one camera, and in "others" those that belong to no camera, such as the IMU's noise."""
    vignettes = body.values.get("vignette")
    others = {key: value for key, value in body.values.items() if key not in OWN_KEYS}
    if isinstance(vignettes, list) and len(vignettes) > index:
        others["vignette"] = [vignettes[index]]
    poses = body.values.get("T_imu_cam")
    pose = {"T_imu_cam": poses[index]} if isinstance(poses, list) else {}
    return {"intrinsics": dict(entries.values), **pose, "others": others}


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


def _model(terms: Terms) -> tuple[str, list[float]]:
    """Returns the model and its parameters behind the principal point."""
    projection = terms.projection
    if isinstance(projection, Equidistant):
        return "kb4", fisheye_coefficients(terms)
    if isinstance(projection, Perspective) and not is_undistorted(terms):
        return "pinhole-radtan8", opencv_coefficients(terms, (8,))
    if not is_undistorted(terms):
        raise Inexpressible("has no distortion of its sphere models")
    if isinstance(projection, ExtendedUnified) and projection.beta == 1:
        return "ucm", [projection.alpha]
    names = {Perspective: "pinhole", DoubleSphere: "ds", ExtendedUnified: "eucm", FieldOfViewAngle: "fov"}
    parameters = {"pinhole": (), "ds": ("xi", "alpha"), "eucm": ("alpha", "beta"), "fov": ("omega",)}
    if type(projection) not in names:
        raise Inexpressible(f"has no model of the kind {type(projection).__name__}")
    name = names[type(projection)]
    return name, [getattr(projection, key) for key in parameters[name]]


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    model, parameters = _model(terms)
    names = ("fx", "fy", "cx", "cy", *MODELS[model][0].split())
    named = dict(zip(names, [*terms.pixel_matrix(0.0), *parameters], strict=True))
    return {"intrinsics": {"camera_type": model, "intrinsics": named}}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    transforms = transforms_from("imu", [saved.camera for saved in cameras])
    others = cameras[0].values.get("others", {})
    vignettes = [v for saved in cameras for v in saved.values.get("others", {}).get("vignette", [])]
    body = {
        "T_imu_cam": [
            saved.values.get("T_imu_cam") or _pose(inverse_of(transform))
            for saved, transform in zip(cameras, transforms, strict=True)
        ],
        "intrinsics": [saved.values["intrinsics"] for saved in cameras],
        "resolution": [list(saved.camera.size) for saved in cameras],
        **IMU,
        **others,
        "vignette": vignettes if len(vignettes) == len(cameras) else [],
    }
    return {path: json_content({"value0": body})}


def _pose(transform: Array) -> dict[str, float]:
    w, x, y, z = quaternion(transform)
    px, py, pz = transform[:3, 3].tolist()
    return {"px": px, "py": py, "pz": pz, "qx": x, "qy": y, "qz": z, "qw": w}


FORMAT: Format = Format("basalt", _matches, cameras, Writer(("calibration.json", "*.json"), _values, _content))
