"""OCamCalib: calib_results.txt. First pixel: 0.

Source: D. Scaramuzza, A. Martinelli and R. Siegwart, ICVS 2006, and the toolbox's ocam_functions.c. The toolbox's axes
are x down the rows, y along the columns, z backwards. world2cam, the polynomial invpol, is the model; pol is no exact
inverse of it, and states the range of angles for which invpol was fitted.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from ..files.document import Document
from ..files.entries import Entries
from ..files.output import number
from ..models.central import CentralModel
from ..models.distortion import BrownConrady
from ..models.ocam_projection import InversePolynomial
from ..models.terms import Inexpressible, is_undistorted, terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, sole

KEYS = ("pol", "invpol", "centre", "affine", "size")  # in the order of the file
AGREEMENT = 0.1  # pixels, within which invpol is the inverse of pol in the range for which it was fitted


def _entries(document: Document) -> Entries:
    lines = [line.strip() for line in document.text.splitlines()]
    rows = [line for line in lines if line and not line.startswith("#")]
    if len(rows) != len(KEYS):
        document.fail(f"expected {len(KEYS)} lines of numbers ({', '.join(KEYS)}); found {len(rows)}")
    return Entries(document, dict(zip(KEYS, rows, strict=True)))


def _polynomial(entries: Entries, key: str) -> list[float]:
    """Returns the coefficients of a line that starts with their number."""
    count, *coefficients = entries.numbers(key)
    if count != len(coefficients) or not 1 <= count <= 64:
        entries.fail(key, "the number of coefficients (1 to 64) and as many coefficients")
    return coefficients


def _largest_angle(pol: list[float], invpol: list[float]) -> float:
    """Returns the angle up to which invpol agrees with pol, whose z is negative in front, and grows."""
    angles = np.linspace(0, np.pi, 3601)
    distances, slopes = (f(angles - np.pi / 2) for f in (Polynomial(invpol), Polynomial(invpol).deriv()))
    error = (np.arctan2(distances, -Polynomial(pol)(distances)) - angles) * slopes
    is_wrong = (np.abs(error) > AGREEMENT) | (slopes <= 0)
    return float(angles[np.argmax(is_wrong)]) if is_wrong.any() else np.pi


def _camera(document: Document) -> StatedCamera:
    entries = _entries(document)
    pol, invpol = _polynomial(entries, "pol"), _polynomial(entries, "invpol")
    row, column = entries.numbers("centre", 2)
    c, d, e = entries.numbers("affine", 3)
    if c <= d * e:
        entries.fail("affine", "c, d, e with c - d e above 0")
    height, width = entries.numbers("size", 2)
    size = Entries(document, {"size": [width, height]}).size("size")
    # (row, column) = [c d; e 1] (x, y); with columns first, [1 e; d c].
    matrix = np.array([[1.0, e, column + 0.5], [d, c, row + 0.5], [0.0, 0.0, 1.0]])
    limit = _largest_angle(pol, invpol)
    if not limit:
        entries.fail("invpol", "the inverse of pol")
    projection = InversePolynomial(tuple(invpol), limit, forward=tuple(pol))
    return StatedCamera(
        CentralModel(projection, BrownConrady(), matrix),
        size,
        "ocam",
        format="ocam",
        pixel_origin=0.0,
        file_values=dict(entries.values),
    )


def _matches(document: Document) -> bool:
    return document.syntax in ("text", "yaml") and bool(
        re.search(r"^#.*\binvpol\b|ocam_model", document.text, re.MULTILINE)
    )


def cameras(document: Document, options: Options) -> Cameras:
    return sole(lambda: _camera(document))


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    projection = terms.projected_by(InversePolynomial)
    if not is_undistorted(terms):
        raise Inexpressible("has no distortion beside its polynomial")
    (s, e, x), (d, c, y) = terms.matrix[:2].tolist()
    # The affine matrix [c d; e 1] has no scale of its own, so that the polynomials are scaled.
    return {
        "pol": [k * s ** (1 - power) for power, k in enumerate(projection.forward)],
        "invpol": [k * s for k in projection.coefficients],
        "centre": [y - 0.5, x - 0.5],
        "affine": [c / s, d / s, e / s],
        "size": [camera.size[1], camera.size[0]],
    }


HEADS = {
    "pol": "polynomial coefficients for the DIRECT mapping function (ocam_model.ss in MATLAB), used by cam2world",
    "invpol": "polynomial coefficients for the inverse mapping function (ocam_model.invpol), used by world2cam",
    "centre": 'center: "row" and "column", starting from 0 (C convention)',
    "affine": 'affine parameters "c", "d", "e"',
    "size": 'image size: "height" and "width"',
}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    lines = []
    for key, head in HEADS.items():
        values = cameras[0].values[key]
        # Values of a file that was read are texts, with the counts of the polynomials.
        count = f"{len(values)} " if key in ("pol", "invpol") and not isinstance(values, str) else ""
        text = values if isinstance(values, str) else " ".join(map(number, values))
        lines.append(f"#{head}\n\n{count}{text}\n\n")
    return {path: "".join(lines).encode()}


FORMAT: Format = Format(
    "ocam", _matches, cameras, Writer(("calib_results*.txt", "*.txt"), _values, _content, is_single=True)
)
