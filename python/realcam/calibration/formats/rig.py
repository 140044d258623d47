"""NVIDIA's rig.json of DriveWorks: several f-theta cameras and their poses on a vehicle. First pixel: 0.

Source: documentation of DriveWorks, "Rig Configuration" and "Camera Modeling".
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import json_content, number, numbers
from ..models.central import CentralModel
from ..models.terms import terms_of
from ..rig import transforms_from
from ..stated_camera import StatedCamera
from ..transforms import inverse_of, turned
from .format import Cameras, Format, Options, Saved, Writer, unknown_model
from .ftheta import MODEL_OF_DIRECTION, angle_limit, ftheta_of, pixel_matrix, polynomial

# Margin about the angle of the farthest corner, as the file states no largest angle.
CORNER_MARGIN = 1.02
RIG_POLYNOMIALS = {"pixeldistance-to-angle": "PIXELDIST_TO_ANGLE", "angle-to-pixeldistance": "ANGLE_TO_PIXELDIST"}
POSE = "nominalSensor2Rig_FLU"
# From a sensor's axes forward, left, up to a camera's axes right, down, forward.
CAMERA_FROM_FLU = turned(np.array([[0.0, -1, 0], [0, 0, -1], [1, 0, 0]]), np.zeros(3))


def _rotation(entries: Entries, key: str) -> Array:
    """Returns the rotation of roll, pitch and yaw in degrees, about x, then y, then z of the fixed axes."""
    from scipy.spatial.transform import Rotation  # slow to load

    rotation: Array = Rotation.from_euler("xyz", entries.numbers(key, 3), degrees=True).as_matrix()
    return rotation


def _extrinsics(entries: Entries) -> dict[str, Array]:
    """Returns the pose with the corrections that the file states beside it."""
    if POSE not in entries:
        return {}
    pose = entries.child(POSE)
    rotation, translation = _rotation(pose, "roll-pitch-yaw"), np.array(pose.numbers("t", 3))
    if "correction_sensor_R_FLU" in entries:
        rotation = rotation @ _rotation(entries.child("correction_sensor_R_FLU"), "roll-pitch-yaw")
    if "correction_rig_T" in entries:
        translation = translation + entries.numbers("correction_rig_T", 3)
    return {"camera_from_rig": CAMERA_FROM_FLU @ inverse_of(turned(rotation, translation))}


def _camera(entries: Entries, name: str) -> StatedCamera:
    properties = entries.child("properties")
    if properties.text("Model") != "ftheta":
        unknown_model(entries.document, f"{properties.where}Model", properties.text("Model"), {"ftheta": None})
    size = properties.size("width", "height")
    is_old = "polynomial" not in properties and "bw-poly" in properties
    direction = "pixeldistance-to-angle" if is_old else properties.choice("polynomial-type", RIG_POLYNOMIALS)
    coefficients = polynomial(properties, "bw-poly" if is_old else "polynomial")
    matrix = pixel_matrix(
        (properties.number("cx") + 0.5, properties.number("cy") + 0.5),
        properties.number("linear-c", 1.0),
        properties.number("linear-d", 0.0),
        properties.number("linear-e", 0.0),
    )
    make = MODEL_OF_DIRECTION[RIG_POLYNOMIALS[direction]]
    limit = _corner_angle(make(coefficients, matrix, np.pi), size) * CORNER_MARGIN
    model = make(coefficients, matrix, angle_limit(limit))
    return StatedCamera(
        model,
        size,
        "ftheta",
        name=name,
        format="rig",
        pixel_origin=0.0,
        extrinsics=_extrinsics(entries),
        file_values=dict(entries.values),
    )


def _corner_angle(model: CentralModel, size: tuple[int, int]) -> float:
    """Returns the angle of the farthest corner of the picture in radians; 180 degrees if one has no ray."""
    width, height = size
    rays, _ = model.ray(np.array([[0, 0], [width, 0], [0, height], [width, height]], dtype=float))
    angles = np.arctan2(np.hypot(rays[:, 0], rays[:, 1]), rays[:, 2])
    return float(angles.max()) if np.isfinite(angles).all() else np.pi


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    ftheta = ftheta_of(terms_of(camera))
    c, d, e = ftheta.cde
    names = {direction: name for name, direction in RIG_POLYNOMIALS.items()}
    properties = {
        "Model": "ftheta",
        "width": str(camera.size[0]),
        "height": str(camera.size[1]),
        "cx": number(ftheta.centre[0] - 0.5),
        "cy": number(ftheta.centre[1] - 0.5),
        "polynomial": numbers(ftheta.coefficients),
        "polynomial-type": names[ftheta.direction],
        "linear-c": number(c),
        "linear-d": number(d),
        "linear-e": number(e),
    }
    return {"protocol": "camera.virtual", "properties": properties}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    transforms = transforms_from("rig", [saved.camera for saved in cameras])
    if "camera_from_rig" not in cameras[0].camera.extrinsics:
        # The first camera's axes, as forward, left and up, take the place of the vehicle's.
        transforms = [transform @ CAMERA_FROM_FLU for transform in transforms]
    sensors = []
    for (name, values, _), transform in zip(cameras, transforms, strict=True):
        pose = {} if POSE in values else {POSE: _pose(transform)}
        sensors.append({"name": name, **pose, **{key: value for key, value in values.items() if key != "name"}})
    return {path: json_content({"rig": {"sensors": sensors}, "version": 7})}


def _pose(camera_from_rig: Array) -> dict[str, Any]:
    from scipy.spatial.transform import Rotation  # slow to load

    pose = inverse_of(inverse_of(CAMERA_FROM_FLU) @ camera_from_rig)
    with warnings.catch_warnings():
        # A camera that looks straight up or down has many such angles; any of them will do.
        warnings.simplefilter("ignore", UserWarning)
        angles = Rotation.from_matrix(pose[:3, :3]).as_euler("xyz", degrees=True)
    return {"roll-pitch-yaw": angles, "t": pose[:3, 3]}


def cameras(document: Document, options: Options) -> Cameras:
    sensors = Entries(document, document.mapping()).child("rig").children("sensors")
    lenses = [s for s in sensors if "camera" in str(s.values.get("protocol", s.values.get("name", "")))]
    return {s.text("name"): lambda s=s: _camera(s, s.text("name")) for s in lenses}  # type: ignore[misc]


def _matches(document: Document) -> bool:
    rig = document.mapping().get("rig")
    return isinstance(rig, dict) and "sensors" in rig


FORMAT: Format = Format("rig", _matches, cameras, Writer(("*rig*.json", "*.json"), _values, _content))
