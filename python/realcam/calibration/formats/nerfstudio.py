"""transforms.json of nerfstudio and instant-ngp. First pixel: 0.5.

Source: nerfstudio's documentation, "Data conventions", and cameras/camera_utils.py: the factor of OPENCV is
1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8, in which k4 is no coefficient of a denominator.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..._core import InputError
from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import json_content
from ..models.central import CentralModel, camera_matrix
from ..models.distortion import BrownConrady
from ..models.opencv_models import fisheye_coefficients, fisheye_model
from ..models.projections import Equidistant, Perspective
from ..models.radial import RationalRadius, even_powers
from ..models.terms import terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, sole, unknown_model

PERSPECTIVE = ("OPENCV", "PINHOLE", "SIMPLE_PINHOLE")
FISHEYE = "OPENCV_FISHEYE"
FRAME_KEYS = ("frames", "transform_matrix", "file_path")
FOCAL_KEYS = ("fl_x", "camera_angle_x")


def _focal_length(entries: Entries, axis: str, side: int) -> float | None:
    """Returns fl_x or fl_y in pixels, which may be stated by the angle of view; None if neither is stated."""
    if f"fl_{axis}" in entries:
        return entries.positive(f"fl_{axis}")
    key = f"camera_angle_{axis}"
    if key not in entries:
        return None
    if not 0 < entries.number(key) < np.pi:
        entries.fail(key, "an angle in radians between 0 and pi")
    return float(side / 2 / np.tan(entries.number(key) / 2))


def _model(entries: Entries, size: tuple[int, int]) -> tuple[CentralModel, str]:
    fx = _focal_length(entries, "x", size[0])
    if fx is None:
        entries.fail("fl_x", "a focal length in pixels")
    fy = _focal_length(entries, "y", size[1]) or fx
    matrix = camera_matrix(fx, fy, entries.number("cx", size[0] / 2), entries.number("cy", size[1] / 2))
    name = entries.text("camera_model", FISHEYE if entries.values.get("is_fisheye") is True else "OPENCV")
    k = [entries.number(f"k{i}", 0.0) for i in range(1, 5)]
    if name == FISHEYE:
        return fisheye_model(matrix, k), name
    if name not in PERSPECTIVE:
        unknown_model(entries.document, f"{entries.where}camera_model", name, dict.fromkeys((*PERSPECTIVE, FISHEYE)))
    tangential = (entries.number("p1", 0.0), entries.number("p2", 0.0))
    return CentralModel(Perspective(), BrownConrady(RationalRadius(even_powers(k)), tangential), matrix), name


AXES = np.diag([1.0, -1.0, -1.0, 1.0])  # from realcam's camera axes to OpenGL's: x right, y up, z backward


def _poses(frames: Sequence[Entries]) -> dict[str, Array]:
    """Returns the poses of pictures by their paths. A frame may lack its pose."""
    posed = [frame for frame in frames if "transform_matrix" in frame]
    return {frame.text("file_path"): frame.matrix("transform_matrix", 4, 4) @ AXES for frame in posed}


def _camera(entries: Entries, name: str, frames: Sequence[Entries]) -> StatedCamera:
    size = entries.size("w", "h")
    model, model_name = _model(entries, size)
    stated = {key: value for key, value in entries.values.items() if key not in FRAME_KEYS}
    return StatedCamera(
        model, size, model_name, name=name, format="nerfstudio", file_values=stated, poses=_poses(frames)
    )


def _has_focal_length(values: object) -> bool:
    return isinstance(values, dict) and any(key in values for key in FOCAL_KEYS)


def cameras(document: Document, options: Options) -> Cameras:
    data = document.mapping()
    whole = Entries(document, data)
    frames = list(whole.children("frames")) if "frames" in data else []
    own = [frame for frame in frames if _has_focal_length(frame.values)]
    if _has_focal_length(data) or not own:
        return sole(lambda: _camera(whole, "", frames))
    # A frame inherits what it does not state.
    return {
        frame.text("file_path"): lambda frame=frame: _camera(  # type: ignore[misc]
            Entries(document, {**data, **frame.values}, frame.where), frame.text("file_path"), [frame]
        )
        for frame in own
    }


def _matches(document: Document) -> bool:
    data = document.mapping()
    frames = data.get("frames")
    first = frames[0] if isinstance(frames, list) and frames else None
    return _has_focal_length(data) or _has_focal_length(first)


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    values: dict[str, Any] = dict(zip(("fl_x", "fl_y", "cx", "cy"), terms.pixel_matrix(0.5), strict=True))
    values = {**values, "w": camera.size[0], "h": camera.size[1]}
    if isinstance(terms.projection, Equidistant):
        terms.within_90_degrees()
        k = fisheye_coefficients(terms)
        return {"camera_model": FISHEYE, **values, **{f"k{i}": value for i, value in enumerate(k, 1)}}
    terms.projected_by(Perspective)
    terms.without("bottom", "prism", "tilt", "is_sequential")
    k = terms.even(terms.top, 4)
    p1, p2 = terms.tangential
    return {"camera_model": "OPENCV", **values, **{f"k{i}": value for i, value in enumerate(k, 1)}, "p1": p1, "p2": p2}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    if not cameras[1:]:
        return {path: json_content({**cameras[0].values, "frames": _frames(cameras[0].camera)})}
    frames = []
    for saved in cameras:
        if not saved.camera.poses:
            raise InputError(f'camera "{saved.name:.40}" has no poses; nerfstudio has several cameras only by pictures')
        frames += [{**frame, **saved.values} for frame in _frames(saved.camera)]
    return {path: json_content({"frames": frames})}


def _frames(camera: StatedCamera) -> list[dict[str, Any]]:
    return [{"file_path": name, "transform_matrix": pose @ AXES} for name, pose in camera.poses.items()]


FORMAT: Format = Format("nerfstudio", _matches, cameras, Writer(("transforms*.json", "*.json"), _values, _content))
