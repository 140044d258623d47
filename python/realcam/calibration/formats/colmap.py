"""Cameras of COLMAP (cameras.txt, cameras.bin). First pixel: 0.5.

Source: COLMAP's src/colmap/sensor/models.h. Models of an angle are refused from 90 degrees on, as COLMAP does.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..files.document import Document
from ..files.entries import Entries
from ..models.central import CentralModel, camera_matrix
from ..models.distortion import BrownConrady
from ..models.opencv_models import distortion_of, fisheye_distortion
from ..models.projections import Equidistant, ExtendedUnified, FieldOfViewAngle, Perspective, Projection
from ..models.radial import RationalRadius, even_powers
from ..models.ray_polynomials import RayPolynomial
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options

Coefficients = Sequence[float]


class _Model(NamedTuple):
    """focal_lengths: 1 or 2 of them. coefficients: the number of parameters behind the principal point."""

    name: str
    focal_lengths: int
    coefficients: int
    make: Callable[[Coefficients], tuple[Projection, BrownConrady]]

    @property
    def parameters(self) -> int:
        return self.focal_lengths + 2 + self.coefficients


def _polynomial(k: Coefficients) -> tuple[Projection, BrownConrady]:
    return Perspective(), BrownConrady(RationalRadius(even_powers(k)))


def _angle_polynomial(k: Coefficients) -> tuple[Projection, BrownConrady]:
    return Equidistant(), fisheye_distortion(k)


def _thin_prism_fisheye(c: Coefficients) -> tuple[Projection, BrownConrady]:
    k1, k2, p1, p2, k3, k4, sx1, sy1 = c
    radius = RationalRadius(even_powers([k1, k2, k3, k4]))
    return Equidistant(), BrownConrady(radius, (p1, p2), (sx1, 0.0, sy1, 0.0))


def fisheye624(c: Coefficients) -> tuple[Projection, BrownConrady]:
    """Project Aria's FISHEYE624 with k0 to k5, p0, p1, s0 to s3; p0 multiplies r^2 + 2 x^2."""
    p0, p1, *prism = c[6:]
    radius = RationalRadius(even_powers(c[:6]))
    return Equidistant(), BrownConrady(radius, (p1, p0), (prism[0], prism[1], prism[2], prism[3]), is_sequential=True)


def _division(c: Coefficients) -> tuple[Projection, BrownConrady]:
    """The ray of a distorted point (x, y) is (x, y, 1 + k r^2) (A. Fitzgibbon, CVPR 2001)."""
    return RayPolynomial((1.0, 0.0, c[0]), np.pi / 2), BrownConrady()


# By model id.
MODELS = {
    0: _Model("SIMPLE_PINHOLE", 1, 0, _polynomial),
    1: _Model("PINHOLE", 2, 0, _polynomial),
    2: _Model("SIMPLE_RADIAL", 1, 1, _polynomial),
    3: _Model("RADIAL", 1, 2, _polynomial),
    4: _Model("OPENCV", 2, 4, lambda c: (Perspective(), distortion_of(c))),
    5: _Model("OPENCV_FISHEYE", 2, 4, _angle_polynomial),
    6: _Model("FULL_OPENCV", 2, 8, lambda c: (Perspective(), distortion_of(c))),
    7: _Model("FOV", 2, 1, lambda c: (FieldOfViewAngle(c[0]), BrownConrady())),
    8: _Model("SIMPLE_RADIAL_FISHEYE", 1, 1, _angle_polynomial),
    9: _Model("RADIAL_FISHEYE", 1, 2, _angle_polynomial),
    10: _Model("THIN_PRISM_FISHEYE", 2, 8, _thin_prism_fisheye),
    11: _Model("RAD_TAN_THIN_PRISM_FISHEYE", 2, 12, fisheye624),
    12: _Model("SIMPLE_DIVISION", 1, 1, _division),
    13: _Model("DIVISION", 2, 1, _division),
    14: _Model("SIMPLE_FISHEYE", 1, 0, _angle_polynomial),
    15: _Model("FISHEYE", 2, 0, _angle_polynomial),
    16: _Model("EUCM", 2, 2, lambda c: (ExtendedUnified(c[0], c[1]), BrownConrady())),
}
BY_NAME = {model.name: model for model in MODELS.values()}


def _camera(entries: Entries, model: _Model, name: str) -> StatedCamera:
    values = entries.numbers("parameters", model.parameters)
    fx, fy = values[0], values[model.focal_lengths - 1]
    if fx <= 0 or fy <= 0:
        entries.fail("parameters", "positive focal lengths first")
    cx, cy, *coefficients = values[model.focal_lengths :]
    projection, distortion = model.make(coefficients)
    return StatedCamera(
        CentralModel(projection, distortion, camera_matrix(fx, fy, cx, cy)),
        entries.size("width", "height"),
        model.name,
        name=name,
        format="colmap",
        file_values={"parameters": values},
    )


def _text_camera(document: Document, number: int, fields: list[str]) -> StatedCamera:
    if len(fields) < 5:
        document.fail(f"line {number}: expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]")
    if fields[1] not in BY_NAME:
        document.fail(f'line {number}: unknown model "{fields[1]:.40}"; expected one of {", ".join(BY_NAME)}')
    values = {"width": fields[2], "height": fields[3], "parameters": fields[4:]}
    return _camera(Entries(document, values, f"line {number}: "), BY_NAME[fields[1]], fields[0])


def text_cameras(document: Document, options: Options) -> Cameras:
    lines = enumerate(document.text.splitlines(), start=1)
    rows = [(i, line.split()) for i, line in lines if line.strip() and not line.lstrip().startswith("#")]
    return {fields[0]: lambda i=i, fields=fields: _text_camera(document, i, fields) for i, fields in rows}  # type: ignore[misc]


def binary_cameras(document: Document, options: Options) -> Cameras:
    content, found = document.content, {}
    try:
        (count,) = struct.unpack_from("<Q", content)
        position = 8
        for index in range(count):
            camera, model_id, width, height = struct.unpack_from("<iiQQ", content, position)
            if model_id not in MODELS:
                document.fail(f"camera {index}: unknown model id {model_id}; expected 0 to {max(MODELS)}")
            model = MODELS[model_id]
            values = struct.unpack_from(f"<{model.parameters}d", content, position + 24)
            position += 24 + 8 * model.parameters
            named = Entries(document, {"width": width, "height": height, "parameters": values}, f"camera {camera}: ")
            found[str(camera)] = lambda named=named, model=model, camera=camera: _camera(named, model, str(camera))
    except struct.error:
        document.fail(f"ends before its last camera, at byte {len(content)}")
    if position != len(content):
        document.fail(f"expected {position} bytes for its cameras; it has {len(content)}")
    return found


def _is_text(document: Document) -> bool:
    if document.syntax not in ("text", "yaml"):
        return False
    rows = [line.split() for line in document.text.splitlines() if line.strip() and not line.startswith("#")]
    return bool(rows) and len(rows[0]) > 1 and (rows[0][1] in BY_NAME or document.path.name == "cameras.txt")


def _is_binary(document: Document) -> bool:
    """True if the number of cameras and the first model id are plausible."""
    if document.syntax != "binary" or len(document.content) < 32:
        return False
    count, _, model_id = struct.unpack_from("<Qii", document.content)
    return document.path.name == "cameras.bin" or (0 < count < 1 << 24 and 0 <= model_id < 64)


TEXT = Format("colmap", _is_text, text_cameras)
BINARY = Format("colmap-binary", _is_binary, binary_cameras)
