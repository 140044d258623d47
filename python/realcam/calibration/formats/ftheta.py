"""NVIDIA's f-theta model in NCore's JSON and in DriveWorks's rig.json. First pixel: 0.

Sources: documentation of NCore (FThetaCameraModelParameters) and of DriveWorks ("Camera Modeling"). Only the
polynomial that the file calls its reference is used; the other one is an approximation of its inverse.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..models.central import CentralModel
from ..models.distortion import BrownConrady
from ..models.projections import Equidistant
from ..models.radial import RationalRadius
from ..models.ray_polynomials import AnglePolynomial
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, sole, unknown_model

# Margin about the angle of the farthest corner, for a file without a largest angle.
CORNER_MARGIN = 1.02


def pixel_matrix(centre: Sequence[float], c: float, d: float, e: float) -> Array:
    """Returns the map [c d; e 1] of the distorted plane, with a centre in realcam's pixels."""
    return np.array([[c, d, centre[0]], [e, 1.0, centre[1]], [0.0, 0.0, 1.0]])


def backward_model(coefficients: Sequence[float], matrix: Array, largest_angle: float) -> CentralModel:
    """theta = a1 d + a2 d^2 + ..., d in pixels."""
    return CentralModel(AnglePolynomial(tuple(coefficients), largest_angle), BrownConrady(), matrix)


def forward_model(coefficients: Sequence[float], matrix: Array, largest_angle: float) -> CentralModel:
    """d = b1 theta + b2 theta^2 + ..., d in pixels."""
    return CentralModel(Equidistant(largest_angle), BrownConrady(RationalRadius(tuple(coefficients))), matrix)


MAKERS = {"PIXELDIST_TO_ANGLE": backward_model, "ANGLE_TO_PIXELDIST": forward_model}
POLYNOMIALS = {"PIXELDIST_TO_ANGLE": "pixeldist_to_angle_poly", "ANGLE_TO_PIXELDIST": "angle_to_pixeldist_poly"}
RIG_POLYNOMIALS = {"pixeldistance-to-angle": "PIXELDIST_TO_ANGLE", "angle-to-pixeldistance": "ANGLE_TO_PIXELDIST"}


def polynomial(entries: Entries, key: str) -> list[float]:
    """Returns the coefficients from that of the first power on; that of the power 0 must be 0."""
    constant, *rest = [*entries.numbers(key), 0.0, 0.0][:64]
    if constant or rest[0] <= 0:
        entries.fail(key, "a polynomial with the constant 0 and a positive coefficient after it")
    return rest


def angle_limit(value: float) -> float:
    """Returns an angle of at most 180 degrees."""
    return min(value, np.pi)


def _ncore_camera(entries: Entries) -> StatedCamera:
    reference = entries.choice("reference_poly", MAKERS)
    if entries.values.get("external_distortion_parameters") is not None:
        entries.fail("external_distortion_parameters", "null; distortions by a windshield are not read")
    x, y = entries.numbers("principal_point", 2)
    c, d, e = entries.numbers("linear_cde", 3) if "linear_cde" in entries else (1.0, 0.0, 0.0)
    coefficients = polynomial(entries, POLYNOMIALS[reference])
    limit = angle_limit(entries.positive("max_angle"))
    model = MAKERS[reference](coefficients, pixel_matrix((x + 0.5, y + 0.5), c, d, e), limit)
    return StatedCamera(
        model,
        entries.size("resolution"),
        "ftheta",
        format="ncore",
        pixel_origin=0.0,
        file_values=dict(entries.values),
    )


def _rig_camera(entries: Entries, name: str) -> StatedCamera:
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
    make = MAKERS[RIG_POLYNOMIALS[direction]]
    limit = _corner_angle(make(coefficients, matrix, np.pi), size) * CORNER_MARGIN
    model = make(coefficients, matrix, angle_limit(limit))
    return StatedCamera(
        model, size, "ftheta", name=name, format="rig", pixel_origin=0.0, file_values=dict(properties.values)
    )


def _corner_angle(model: CentralModel, size: tuple[int, int]) -> float:
    """Returns the angle of the farthest corner of the picture in radians; 180 degrees if one has no ray."""
    width, height = size
    rays, _ = model.ray(np.array([[0, 0], [width, 0], [0, height], [width, height]], dtype=float))
    angles = np.arctan2(np.hypot(rays[:, 0], rays[:, 1]), rays[:, 2])
    return float(angles.max()) if np.isfinite(angles).all() else np.pi


def _is_ncore(document: Document) -> bool:
    return "reference_poly" in document.mapping()


def rig_cameras(document: Document, options: Options) -> Cameras:
    sensors = Entries(document, document.mapping()).child("rig").children("sensors")
    lenses = [s for s in sensors if "camera" in str(s.values.get("protocol", s.values.get("name", "")))]
    return {s.text("name"): lambda s=s: _rig_camera(s, s.text("name")) for s in lenses}  # type: ignore[misc]


def _is_rig(document: Document) -> bool:
    rig = document.mapping().get("rig")
    return isinstance(rig, dict) and "sensors" in rig


def ncore_cameras(document: Document, options: Options) -> Cameras:
    return sole("camera", lambda: _ncore_camera(Entries(document, document.mapping())))


NCORE = Format("ncore", _is_ncore, ncore_cameras)
RIG = Format("rig", _is_rig, rig_cameras)
