"""OpenCV's FileStorage (.yml, .xml, .json), as cv::calibrateCamera's sample programs write it. First pixel: 0."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..models.central import shift
from ..models.opencv_models import LENGTHS, fisheye_model, pinhole_model
from ..stated_camera import StatedCamera
from ..transforms import turned
from .format import Cameras, Format, Options, sole, stated_size
from .opencv_storage import WRITER

MATRICES = ("camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "mtx")
COEFFICIENTS = ("distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "D", "dist")
SIZES = (
    ("image_width", "image_height"),
    ("image_Width", "image_Height"),
    ("width", "height"),
    ("image_size",),
    ("imageSize",),
)
STEREO = ("M1", "M2")  # of the sample program stereo_calib, with D1 and D2


def _storage(document: Document) -> dict[str, Any]:
    """Returns the values of a FileStorage."""
    if document.syntax == "xml":
        return _xml_values(document.xml) if document.xml.tag == "opencv_storage" else {}
    return document.mapping()


def _xml_values(element: ET.Element) -> dict[str, Any]:
    return {child.tag: _xml_values(child) if len(child) else (child.text or "").strip() for child in element}


def _key(entries: Entries, keys: tuple[str, ...]) -> str:
    return next((key for key in keys if key in entries), keys[0])


def _size(entries: Entries, options: Options) -> tuple[int, int]:
    keys = next((keys for keys in SIZES if all(key in entries for key in keys)), None)
    return entries.size(*keys) if keys else stated_size(entries.document, options)


def _pose_of_second(entries: Entries) -> dict[str, Array]:
    """Returns R and T of cv2.stereoCalibrate, from the first camera to the second."""
    if "R" not in entries or "T" not in entries:
        return {}
    return {"camera_from_previous": turned(entries.matrix("R", 3, 3), entries.matrix("T", 3, 1)[:, 0])}


def _camera(entries: Entries, matrix_key: str, coefficient_key: str, options: Options, name: str = "") -> StatedCamera:
    matrix = entries.matrix(matrix_key, 3, 3)
    if matrix[2].tolist() != [0, 0, 1] or matrix[0, 0] <= 0 or matrix[1, 1] <= 0:
        entries.fail(matrix_key, "fx 0 cx, 0 fy cy, 0 0 1 with positive fx and fy")
    is_fisheye = bool(entries.number("fisheye_model", 0.0))
    counts = (4,) if is_fisheye else LENGTHS[1:]
    D = entries.numbers(coefficient_key, *counts) if coefficient_key in entries else []
    model = (fisheye_model if is_fisheye else pinhole_model)(shift(0.5, 0.5) @ matrix, D)
    return StatedCamera(
        model,
        _size(entries, options),
        "opencv_fisheye" if is_fisheye else f"opencv{len(D)}",
        name=name,
        format="opencv",
        pixel_origin=0.0,
        extrinsics=_pose_of_second(entries) if matrix_key == STEREO[1] else {},
        file_values={"camera_matrix": matrix, "distortion_coefficients": D, "is_fisheye": is_fisheye},
    )


def cameras(document: Document, options: Options) -> Cameras:
    entries = Entries(document, _storage(document))
    if any(key in entries for key in STEREO):
        return {
            key[1]: lambda key=key: _camera(entries, key, f"D{key[1]}", options, key[1])  # type: ignore[misc]
            for key in STEREO
            if key in entries
        }
    return sole(lambda: _camera(entries, _key(entries, MATRICES), _key(entries, COEFFICIENTS), options))


FORMAT: Format = Format("opencv", lambda d: any(key in _storage(d) for key in (*MATRICES, *STEREO)), cameras, WRITER)
