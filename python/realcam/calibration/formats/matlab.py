"""MATLAB's cameraParameters, cameraIntrinsics and fisheyeIntrinsics as jsonencode writes them. First pixel: 1.

Sources: MathWorks documentation of cameraParameters, fisheyeIntrinsics and "Fisheye StatedCamera Basics";
D. Scaramuzza, A. Martinelli and R. Siegwart, ICVS 2006.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..._core import InputError
from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import json_content
from ..models.central import CentralModel, camera_matrix, shift
from ..models.distortion import BrownConrady
from ..models.opencv_models import opencv_coefficients, pinhole_model
from ..models.ray_polynomials import RayPolynomial
from ..models.terms import Inexpressible, Terms, is_undistorted, terms_of
from ..rig import transforms_from_previous
from ..stated_camera import StatedCamera
from ..transforms import turned
from .format import Cameras, Format, Options, Saved, Writer, sole, stated_size

TO_REALCAM = shift(-0.5, -0.5)
# The fisheye polynomial is fitted inside the picture; it is used up to this multiple of the farthest corner's distance.
CORNER_MARGIN = 1.1


def _size(entries: Entries, options: Options) -> tuple[int, int]:
    """Returns the size, which MATLAB states as [rows, columns]; empty in a cameraParameters object without pictures."""
    if entries.values.get("ImageSize", []) == []:
        return stated_size(entries.document, options)
    rows, columns = entries.numbers("ImageSize", 2)
    pair = Entries(entries.document, {"ImageSize": [columns, rows]}, entries.where)
    return pair.size("ImageSize")


def _matrix(entries: Entries) -> Array:
    """Returns K. IntrinsicMatrix, of releases before R2022b, is its transpose."""
    if "K" in entries:
        matrix = entries.matrix("K", 3, 3)
    elif "IntrinsicMatrix" in entries:
        matrix = entries.matrix("IntrinsicMatrix", 3, 3).T
    else:
        (fx, fy), (cx, cy) = entries.numbers("FocalLength", 2), entries.numbers("PrincipalPoint", 2)
        matrix = camera_matrix(fx, fy, cx, cy, entries.number("Skew", 0.0))
    if matrix[2].tolist() != [0, 0, 1] or matrix[0, 0] <= 0 or matrix[1, 1] <= 0:
        key = next((k for k in ("K", "IntrinsicMatrix") if k in entries), "FocalLength")
        entries.fail(key, "a camera matrix with positive focal lengths (IntrinsicMatrix is transposed)")
    return matrix


def _pinhole(entries: Entries, options: Options) -> StatedCamera:
    matrix = _matrix(entries)
    radial = [*entries.numbers("RadialDistortion", 2, 3), 0.0][:3]
    tangential = entries.numbers("TangentialDistortion", 2) if "TangentialDistortion" in entries else [0.0, 0.0]
    D = [radial[0], radial[1], *tangential, radial[2]]
    return StatedCamera(
        pinhole_model(TO_REALCAM @ matrix, D),
        _size(entries, options),
        "cameraParameters",
        format="matlab",
        pixel_origin=1.0,
        file_values=dict(entries.values),
    )


def _fisheye(entries: Entries, options: Options) -> StatedCamera:
    a0, a2, a3, a4 = entries.numbers("MappingCoefficients", 4)
    if a0 <= 0:
        entries.fail("MappingCoefficients", "a positive coefficient first")
    cx, cy = entries.numbers("DistortionCenter", 2)
    stretch = entries.matrix("StretchMatrix", 2, 2) if "StretchMatrix" in entries else np.eye(2)
    if np.linalg.det(stretch) <= 0:
        entries.fail("StretchMatrix", "a matrix [c d; e 1] with a positive determinant")
    matrix, size = np.eye(3), _size(entries, options)
    matrix[:2, :2], matrix[:2, 2] = stretch, (cx - 0.5, cy - 0.5)
    corners = np.linalg.solve(
        stretch, np.array([[x - cx + 0.5, y - cy + 0.5] for x in (0, size[0]) for y in (0, size[1])]).T
    )
    longest = CORNER_MARGIN * float(np.hypot(*corners).max())
    return StatedCamera(
        CentralModel(RayPolynomial((a0, 0.0, a2, a3, a4), longest=longest), BrownConrady(), matrix),
        size,
        "fisheyeIntrinsics",
        format="matlab",
        pixel_origin=1.0,
        file_values=dict(entries.values),
    )


UNITS = {"m": 1.0, "meters": 1.0, "metres": 1.0, "cm": 0.01, "mm": 0.001, "millimeters": 0.001, "in": 0.0254}


def _pose_of_second(entries: Entries) -> dict[str, Array]:
    """Returns the transform from the first camera's axes to the second's, in metres.

    RotationOfCamera2, of releases before R2022b, is the transpose, as it multiplies rows.
    """
    if "PoseCamera2" in entries:
        pose = entries.child("PoseCamera2")
        rotation, translation = pose.matrix("R", 3, 3), pose.numbers("Translation", 3)
    elif "RotationOfCamera2" in entries:
        rotation = entries.matrix("RotationOfCamera2", 3, 3).T
        translation = entries.numbers("TranslationOfCamera2", 3)
    else:
        return {}
    first = entries.child(STEREO[0])
    unit = (entries if "WorldUnits" in entries else first).text("WorldUnits", "mm")
    if unit not in UNITS:
        entries.fail("WorldUnits", f"one of {', '.join(UNITS)}")
    return {"camera_from_previous": turned(rotation, np.array(translation) * UNITS[unit])}


def _camera(entries: Entries, options: Options) -> StatedCamera:
    if "Intrinsics" in entries:
        entries = entries.child("Intrinsics")
    return _fisheye(entries, options) if "MappingCoefficients" in entries else _pinhole(entries, options)


KEYS = ("RadialDistortion", "MappingCoefficients", "IntrinsicMatrix", "Intrinsics")
STEREO = ("CameraParameters1", "CameraParameters2")


def cameras(document: Document, options: Options) -> Cameras:
    entries = Entries(document, document.mapping())
    if STEREO[0] in entries:
        return {
            STEREO[0]: lambda: replace(_camera(entries.child(STEREO[0]), options), name=STEREO[0]),
            STEREO[1]: lambda: replace(
                _camera(entries.child(STEREO[1]), options), name=STEREO[1], extrinsics=_pose_of_second(entries)
            ),
        }
    return sole(lambda: _camera(entries, options))


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    rows_and_columns = {"ImageSize": [camera.size[1], camera.size[0]]}
    if isinstance(terms.projection, RayPolynomial):
        return {**_fisheye_values(terms, terms.projection), **rows_and_columns}
    terms.without("bottom", "prism", "tilt")
    k1, k2, p1, p2, k3 = opencv_coefficients(terms, (5,))
    (fx, skew, cx), (shear, fy, cy) = terms.matrix[:2].tolist()
    if shear or fx <= 0 or fy <= 0:
        raise Inexpressible("has no shear of the rows")
    K = camera_matrix(fx, fy, cx + 0.5, cy + 0.5, skew)
    return {"RadialDistortion": [k1, k2, k3], "TangentialDistortion": [p1, p2], **rows_and_columns, "K": K}


def _fisheye_values(terms: Terms, projection: RayPolynomial) -> dict[str, Any]:
    """The stretch matrix [c d; e 1] has no scale of its own: the polynomial is stated for pixels of the rows."""
    (c, d, cx), (e, scale, cy) = terms.matrix[:2].tolist()
    coefficients = [*projection.coefficients, *[0.0] * 5]
    if not is_undistorted(terms) or coefficients[1] or any(coefficients[5:]) or scale <= 0:
        raise Inexpressible("has only the powers 0, 2, 3 and 4 of the fisheye polynomial")
    powers = (0, 2, 3, 4)
    return {
        "MappingCoefficients": [coefficients[power] * scale ** (1 - power) for power in powers],
        "DistortionCenter": [cx + 0.5, cy + 0.5],
        "StretchMatrix": [[c / scale, d / scale], [e / scale, 1.0]],
    }


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    if not cameras[1:]:
        return {path: json_content(cameras[0].values)}
    if len(cameras) > 2:
        raise InputError(f"MATLAB's files hold one camera or a stereo pair, not {len(cameras)}; kalibr holds more")
    (pose,) = transforms_from_previous([saved.camera for saved in cameras])
    pair = {key: saved.values for key, saved in zip(STEREO, cameras, strict=True)}
    rotation = {"R": pose[:3, :3], "Translation": pose[:3, 3], "Dimensionality": 3}
    return {path: json_content({**pair, "PoseCamera2": rotation, "WorldUnits": "m"})}


FORMAT: Format = Format(
    "matlab",
    lambda d: any(key in d.mapping() for key in (*KEYS, *STEREO)),
    cameras,
    Writer(("*cameraparam*.json", "*stereoparam*.json", "*intrinsics*.json", "*.json"), _values, _content),
)
