"""MATLAB's cameraParameters, cameraIntrinsics and fisheyeIntrinsics as jsonencode writes them. First pixel: 1.

Sources: MathWorks documentation of cameraParameters, fisheyeIntrinsics and "Fisheye StatedCamera Basics";
D. Scaramuzza, A. Martinelli and R. Siegwart, ICVS 2006.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..models.central import CentralModel, camera_matrix, shift
from ..models.distortion import BrownConrady
from ..models.opencv_models import pinhole_model
from ..models.ray_polynomials import RayPolynomial
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, sole, stated_size

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
        file_values={"K": matrix, "RadialDistortion": radial, "TangentialDistortion": tangential},
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
        file_values={"MappingCoefficients": [a0, a2, a3, a4], "StretchMatrix": stretch, "DistortionCenter": [cx, cy]},
    )


def _camera(entries: Entries, options: Options) -> StatedCamera:
    if "Intrinsics" in entries:
        entries = entries.child("Intrinsics")
    return _fisheye(entries, options) if "MappingCoefficients" in entries else _pinhole(entries, options)


KEYS = ("RadialDistortion", "MappingCoefficients", "IntrinsicMatrix", "Intrinsics")
STEREO = ("CameraParameters1", "CameraParameters2")


def cameras(document: Document, options: Options) -> Cameras:
    entries = Entries(document, document.mapping())
    if STEREO[0] in entries:
        return {key: lambda key=key: _camera(entries.child(key), options) for key in STEREO if key in entries}  # type: ignore[misc]
    return sole("camera", lambda: _camera(entries, options))


FORMAT = Format("matlab", lambda d: any(key in d.mapping() for key in (*KEYS, *STEREO)), cameras)
