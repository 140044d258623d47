"""NVIDIA's NCore: the f-theta model as JSON. First pixel: 0.

Only the polynomial that the file calls its reference is used; the other one is an approximation of its inverse.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..files.document import Document
from ..files.entries import Entries
from ..files.output import json_content
from ..models.terms import terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, sole
from .ftheta import MODEL_OF_DIRECTION, angle_limit, ftheta_of, inverse_coefficients, pixel_matrix, polynomial

POLYNOMIALS = {"PIXELDIST_TO_ANGLE": "pixeldist_to_angle_poly", "ANGLE_TO_PIXELDIST": "angle_to_pixeldist_poly"}


def _camera(entries: Entries) -> StatedCamera:
    reference = entries.choice("reference_poly", MODEL_OF_DIRECTION)
    if entries.values.get("external_distortion_parameters") is not None:
        entries.fail("external_distortion_parameters", "null; distortions by a windshield are not read")
    x, y = entries.numbers("principal_point", 2)
    c, d, e = entries.numbers("linear_cde", 3) if "linear_cde" in entries else (1.0, 0.0, 0.0)
    coefficients = polynomial(entries, POLYNOMIALS[reference])
    limit = angle_limit(entries.positive("max_angle"))
    model = MODEL_OF_DIRECTION[reference](coefficients, pixel_matrix((x + 0.5, y + 0.5), c, d, e), limit)
    return StatedCamera(
        model,
        entries.size("resolution"),
        "ftheta",
        format="ncore",
        pixel_origin=0.0,
        file_values=dict(entries.values),
    )


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    ftheta = ftheta_of(terms_of(camera))
    (other,) = set(MODEL_OF_DIRECTION) - {ftheta.direction}
    return {
        "type": "ftheta",
        "resolution": list(camera.size),
        "shutter_type": "GLOBAL",
        "principal_point": [value - 0.5 for value in ftheta.centre],
        "reference_poly": ftheta.direction,
        POLYNOMIALS[ftheta.direction]: ftheta.coefficients,
        POLYNOMIALS[other]: inverse_coefficients(ftheta),
        "max_angle": ftheta.largest_angle,
        "linear_cde": list(ftheta.cde),
        "external_distortion_parameters": None,
    }


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    return {path: json_content(cameras[0].values)}


def cameras(document: Document, options: Options) -> Cameras:
    return sole(lambda: _camera(Entries(document, document.mapping())))


FORMAT: Format = Format(
    "ncore",
    lambda d: "reference_poly" in d.mapping(),
    cameras,
    Writer(("*ncore*.json", "*ftheta*.json", "*.json"), _values, _content, is_single=True),
)
