"""Writer of OpenCV's FileStorage in its three syntaxes, with the keys of cv::calibrateCamera's sample programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..._core import InputError
from ..arrays import Array
from ..files.output import json_content, number, numbers, plain, xml_elements
from ..models.central import camera_matrix
from ..models.opencv_models import fisheye_coefficients, opencv_coefficients
from ..models.projections import Equidistant
from ..models.terms import terms_of
from ..rig import transforms_from_previous
from ..stated_camera import StatedCamera
from .format import Saved, Writer


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    is_fisheye = isinstance(terms.projection, Equidistant)
    if is_fisheye:
        terms.within_90_degrees()
    return {
        "camera_matrix": camera_matrix(*terms.pixel_matrix(0.0)),
        "distortion_coefficients": fisheye_coefficients(terms) if is_fisheye else opencv_coefficients(terms),
        "is_fisheye": is_fisheye,
    }


def _entries(cameras: Sequence[Saved]) -> dict[str, Any]:
    """Returns the entries of a file with one camera, or with the two of a stereo pair."""
    first = cameras[0]
    entries: dict[str, Any] = {"image_width": first.camera.size[0], "image_height": first.camera.size[1]}
    if any(saved.values["is_fisheye"] for saved in cameras):
        entries["fisheye_model"] = 1
    if len(cameras) == 1:
        return {**entries, **_matrices(first, "camera_matrix", "distortion_coefficients")}
    if len(cameras) > 2:
        raise InputError(f"an OpenCV file holds one camera or a stereo pair, not {len(cameras)}; kalibr holds more")
    second = cameras[1]
    if second.camera.size != first.camera.size or second.values["is_fisheye"] != first.values["is_fisheye"]:
        raise InputError("the cameras of a stereo pair in an OpenCV file have one picture size and one kind of model")
    (pose,) = transforms_from_previous([saved.camera for saved in cameras])
    pairs = [_matrices(saved, f"M{i}", f"D{i}") for i, saved in enumerate(cameras, start=1)]
    return {**entries, **pairs[0], **pairs[1], "R": pose[:3, :3], "T": pose[:3, 3:]}


def _matrices(saved: Saved, matrix: str, coefficients: str) -> dict[str, Array]:
    D = np.array(saved.values["distortion_coefficients"], dtype=float).reshape(-1, 1)
    return {matrix: np.asarray(saved.values["camera_matrix"]), coefficients: D}


def _yaml(entries: Mapping[str, Any]) -> str:
    # cv::FileStorage requires the first two lines, and matrices with its tag.
    lines = ["%YAML:1.0", "---"]
    for key, value in entries.items():
        if isinstance(value, np.ndarray):
            data = ", ".join(map(number, value.ravel().tolist()))
            lines += [f"{key}: !!opencv-matrix", f"   rows: {value.shape[0]}", f"   cols: {value.shape[1]}"]
            lines += ["   dt: d", f"   data: [ {data} ]"]
        else:
            lines.append(f"{key}: {number(value)}")
    return "\n".join(lines) + "\n"


def _xml(entries: Mapping[str, Any]) -> str:
    lines = ['<?xml version="1.0"?>\n<opencv_storage>\n']
    for key, value in entries.items():
        if isinstance(value, np.ndarray):
            parts = {"rows": value.shape[0], "cols": value.shape[1], "dt": "d", "data": numbers(value)}
            lines.append(f'<{key} type_id="opencv-matrix">\n{xml_elements(parts, "  ")}</{key}>\n')
        else:
            lines.append(f"<{key}>{number(value)}</{key}>\n")
    return "".join([*lines, "</opencv_storage>\n"])


def _json(entries: Mapping[str, Any]) -> bytes:
    return json_content(
        {
            key: {
                "type_id": "opencv-matrix",
                "rows": value.shape[0],
                "cols": value.shape[1],
                "dt": "d",
                "data": plain(value.ravel()),
            }
            if isinstance(value, np.ndarray)
            else value
            for key, value in entries.items()
        }
    )


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    entries = _entries(cameras)
    if path.suffix.lower() == ".json":
        return {path: _json(entries)}
    return {path: (_xml(entries) if path.suffix.lower() == ".xml" else _yaml(entries)).encode()}


WRITER: Writer = Writer(("*.yml", "*.xml", "*.json"), _values, _content)
