"""nuScenes: calibrated_sensor.json. Its pictures are undistorted. First pixel: 0 (its documentation does not say).

Source: H. Caesar et al., CVPR 2020, and the schema of nuscenes-devkit. sensor.json beside the file names the cameras.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import CalibrationFileError
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import json_content
from ..models.central import camera_matrix, shift
from ..models.opencv_models import pinhole_model
from ..models.projections import Perspective
from ..models.terms import Inexpressible, is_undistorted, terms_of
from ..rig import transforms_from
from ..stated_camera import StatedCamera
from ..transforms import inverse_of, quaternion, rigid
from .format import Cameras, Format, Options, Saved, Writer, stated_size


def _sensors(document: Document) -> list[dict[str, Any]]:
    """Returns the sensors with a camera matrix; it is empty for the others."""
    data = document.data if document.syntax == "json" and isinstance(document.data, list) else []
    return [sensor for sensor in data if isinstance(sensor, dict) and sensor.get("camera_intrinsic")]


def _channels(document: Document) -> dict[str, str]:
    """Returns the channels of sensors by their tokens; none if there is no readable sensor.json beside the file."""
    try:
        sensors = Document(document.path.with_name("sensor.json")).data
    except CalibrationFileError:
        return {}
    pairs = ((s.get("token"), s.get("channel")) for s in sensors if isinstance(s, dict)) if sensors else ()
    return {token: channel for token, channel in pairs if isinstance(token, str) and isinstance(channel, str)}


def _camera(entries: Entries, name: str, options: Options) -> StatedCamera:
    matrix = entries.matrix("camera_intrinsic", 3, 3)
    if matrix[2].tolist() != [0, 0, 1] or matrix[0, 0] <= 0 or matrix[1, 1] <= 0:
        entries.fail("camera_intrinsic", "fx 0 cx, 0 fy cy, 0 0 1 with positive fx and fy")
    rotation = entries.numbers("rotation", 4)
    if not any(rotation):
        entries.fail("rotation", "a quaternion w, x, y, z that is not 0")
    pose = rigid(rotation, entries.numbers("translation", 3))
    return StatedCamera(
        pinhole_model(shift(0.5, 0.5) @ matrix),
        stated_size(entries.document, options),
        "pinhole",
        name=name,
        format="nuscenes",
        pixel_origin=0.0,
        extrinsics={"camera_from_ego": inverse_of(pose)},
        file_values=dict(entries.values),
    )


def _named(document: Document) -> Iterator[tuple[str, Entries]]:
    """Yields the channel of each camera, with its token if several cameras have the same channel."""
    channels = _channels(document)
    taken: set[str] = set()
    for index, sensor in enumerate(_sensors(document)):
        token = str(sensor.get("token", index))
        name = channels.get(str(sensor.get("sensor_token")), token)
        name = f"{name} {token}" if name in taken else name
        taken.add(name)
        yield name, Entries(document, sensor, f"{token}.")


def cameras(document: Document, options: Options) -> Cameras:
    return {
        name: lambda name=name, entries=entries: _camera(entries, name, options)  # type: ignore[misc]
        for name, entries in _named(document)
    }


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    terms.projected_by(Perspective)
    if not is_undistorted(terms):
        raise Inexpressible("has no distortion, as its pictures are undistorted")
    return {"camera_intrinsic": camera_matrix(*terms.pixel_matrix(0.0))}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    transforms = transforms_from("ego", [saved.camera for saved in cameras])
    sensors = []
    for (name, values, _), transform in zip(cameras, transforms, strict=True):
        pose = inverse_of(transform)
        stated = {"token": name, "sensor_token": name, "translation": pose[:3, 3], "rotation": quaternion(pose)}
        sensors.append({**stated, **values})
    return {path: json_content(sensors)}


FORMAT: Format = Format(
    "nuscenes",
    lambda d: bool(_sensors(d)),
    cameras,
    Writer(("calibrated_sensor*.json", "*.json"), _values, _content),
)
