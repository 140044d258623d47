"""KITTI: calib_cam_to_cam.txt of raw data, and calibrations with P0 to P3. First pixel: 0.

Source: A. Geiger, P. Lenz, C. Stiller and R. Urtasun, IJRR 32 (2013) 1231, and the readmes of the development kits.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import numbers
from ..models.central import camera_matrix, shift
from ..models.opencv_models import opencv_coefficients, pinhole_model
from ..models.terms import is_undistorted, terms_of
from ..rig import transforms_from
from ..stated_camera import StatedCamera
from ..transforms import inverse_of, turned
from .format import Cameras, Format, Options, Saved, Writer, stated_size

LINE = re.compile(r"^([A-Za-z]\w*):[ \t]*(.*)$", re.MULTILINE)
PROJECTION = re.compile(r"P(\d+)|P_rect_(\d+)")


def _entries(document: Document) -> Entries:
    return Entries(document, dict(LINE.findall(document.text)))


def _raw(entries: Entries, number: str) -> StatedCamera:
    """Returns the camera before rectification."""
    matrix = entries.matrix(f"K_{number}", 3, 3)
    D = entries.numbers(f"D_{number}", 5)
    extrinsics = {}
    if f"R_{number}" in entries and f"T_{number}" in entries:
        pose = turned(entries.matrix(f"R_{number}", 3, 3), entries.matrix(f"T_{number}", 3, 1)[:, 0])
        extrinsics["camera_from_camera0"] = pose
    if f"R_rect_{number}" in entries:
        extrinsics["rectified_from_camera"] = turned(entries.matrix(f"R_rect_{number}", 3, 3), np.zeros(3))
    return StatedCamera(
        pinhole_model(shift(0.5, 0.5) @ matrix, D),
        entries.size(f"S_{number}"),
        "opencv5",
        name=number,
        format="kitti",
        pixel_origin=0.0,
        extrinsics=extrinsics,
        file_values={"K": matrix.ravel().tolist(), "D": D},
    )


def _rectified(entries: Entries, key: str, options: Options) -> StatedCamera:
    """Returns a rectified camera. The last column of P is K times the position of rectified camera 0 in its axes."""
    P = entries.matrix(key, 3, 4)
    K = P[:, :3]
    if K[2].tolist() != [0, 0, 1] or K[0, 0] <= 0 or K[1, 1] <= 0:
        entries.fail(key, "a projection matrix with positive focal lengths and the last row 0 0 1 tz")
    size_key = f"S_{key[2:]}"  # S_rect_02 of P_rect_02
    size = entries.size(size_key) if size_key in entries else stated_size(entries.document, options)
    return StatedCamera(
        pinhole_model(shift(0.5, 0.5) @ K),
        size,
        "pinhole",
        name=key,
        format="kitti",
        pixel_origin=0.0,
        extrinsics={"camera_from_rectified_camera0": turned(np.eye(3), np.linalg.solve(K, P[:, 3]))},
        file_values={"P": P.ravel().tolist()},
    )


def cameras(document: Document, options: Options) -> Cameras:
    entries = _entries(document)
    raw = {key[2:]: lambda key=key: _raw(entries, key[2:]) for key in entries.values if re.fullmatch(r"K_\d+", key)}
    rectified = {
        key: lambda key=key: _rectified(entries, key, options) for key in entries.values if PROJECTION.fullmatch(key)
    }
    return {**raw, **rectified}


def _matches(document: Document) -> bool:
    if document.syntax not in ("yaml", "text"):
        return False
    return any(re.fullmatch(r"K_\d+|P\d+|P_rect_\d+", key) for key, _ in LINE.findall(document.text))


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    D = opencv_coefficients(terms, (5,))
    K = camera_matrix(*terms.pixel_matrix(0.0))
    if is_undistorted(terms) and "camera_from_rectified_camera0" in camera.extrinsics:
        return {"P": np.column_stack([K, K @ camera.extrinsics["camera_from_rectified_camera0"][:3, 3]])}
    return {"K": K, "D": D}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    raw = [saved for saved in cameras if "K" in saved.values]
    lines: dict[str, str] = {}
    poses = _poses([saved.camera for saved in raw]) if raw else []
    for index, ((name, values, camera), pose) in enumerate(zip(raw, poses, strict=True)):
        number = name if name.isascii() and name.isdigit() else f"{index:02}"
        lines |= {f"S_{number}": numbers(camera.size), f"K_{number}": numbers(values["K"])}
        lines |= {f"D_{number}": numbers(values["D"]), f"R_{number}": numbers(pose[:3, :3])}
        lines |= {f"T_{number}": numbers(pose[:3, 3])}
        if "rectified_from_camera" in camera.extrinsics:
            lines[f"R_rect_{number}"] = numbers(camera.extrinsics["rectified_from_camera"][:3, :3])
    for index, (name, values, camera) in enumerate(saved for saved in cameras if "P" in saved.values):
        key = name if PROJECTION.fullmatch(name) else f"P{index}"
        if key.startswith("P_"):
            lines[f"S_{key[2:]}"] = numbers(camera.size)
        lines[key] = numbers(values["P"])
    return {path: "".join(f"{key}: {text}\n" for key, text in lines.items()).encode()}


def _poses(cameras: Sequence[StatedCamera]) -> list[Array]:
    """Returns the transforms from camera 0, or from the first of the cameras if they state another frame."""
    found = transforms_from("camera0", cameras)
    if "camera_from_camera0" in cameras[0].extrinsics:
        return found
    back = inverse_of(found[0])
    return [pose @ back for pose in found]


FORMAT: Format = Format("kitti", _matches, cameras, Writer(("calib*.txt", "*.txt"), _values, _content))
