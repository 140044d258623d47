"""Nodes LD_3DE4_* of 3DEqualizer for Nuke (.nk). Edges of the picture are at 0 and its width; y is up in the file.

Source: Science-D-Visions' Lens Distortion Plugin Kit: radial_decentered_distortion, cylindric_extender and
generic_anamorphic_distortion. Polynomials map distorted to undistorted points, in halves of the filmback's diagonal.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import number
from ..models.central import CentralModel
from ..models.projections import Perspective
from ..models.terms import Inexpressible, is_undistorted, terms_of
from ..models.undistortion import Undistortion
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, stated_size

NODE = re.compile(r"^\s*LD_(3DE4?_\w+) \{\s*\n(.*?)^\}", re.MULTILINE | re.DOTALL)
KNOB = re.compile(r"^\s*(\w+)[ \t]+([^\n]*?)\s*$", re.MULTILINE)
# Knobs whose effect is not verified by another program, with the only value that is read.
REQUIRED = {"tde4_pixel_aspect": 1.0, "Lens_Rotation": 0.0, "Squeeze_X": 1.0, "Squeeze_Y": 1.0}


def _radial(entries: Entries) -> Callable[[Array], Array]:
    c2, u2, v2 = (entries.number(key, 0.0) for key in ("Distortion_Degree_2", "U_Degree_2", "V_Degree_2"))
    c4, u4, v4 = (entries.number(key, 0.0) for key in ("Quartic_Distortion_Degree_4", "U_Degree_4", "V_Degree_4"))
    phi = np.radians(entries.number("Phi_Cylindric_Direction", 0.0))
    if entries.number("B_Cylindric_Bending", 0.0) <= -1:
        entries.fail("B_Cylindric_Bending", "a number above -1")
    q = np.sqrt(1 + entries.number("B_Cylindric_Bending", 0.0))
    turn = np.array([[np.cos(phi), -np.sin(phi)], [np.sin(phi), np.cos(phi)]])
    bend = turn @ np.diag([q, 1 / q]) @ turn.T

    def undistorted(points: Array) -> Array:
        x, y = points.T
        square = x * x + y * y
        factor, u, v = 1 + square * (c2 + c4 * square), u2 + u4 * square, v2 + v4 * square
        straight = [
            x * factor + (square + 2 * x * x) * u + 2 * x * y * v,
            y * factor + (square + 2 * y * y) * v + 2 * x * y * u,
        ]
        bent: Array = np.stack(straight, axis=1) @ bend
        return bent

    return undistorted


def _anamorphic(entries: Entries) -> Callable[[Array], Array]:
    terms = ("02_Degree_2", "22_Degree_2", "04_Degree_4", "24_Degree_4", "44_Degree_4")
    c = np.array([[entries.number(f"C{axis}{term}", 0.0) for term in terms] for axis in "xy"])

    def undistorted(points: Array) -> Array:
        x, y = points.T
        # r^2, r^2 cos 2 phi, r^4, r^4 cos 2 phi, r^4 cos 4 phi.
        square, difference = x * x + y * y, x * x - y * y
        basis = [square, difference, square**2, square * difference, 2 * difference**2 - square**2]
        factors: Array = 1 + np.stack(basis, axis=1) @ c.T
        return points * factors

    return undistorted


MODELS = {
    "3DE4_Radial_Standard_Degree_4": _radial,
    "3DE4_Anamorphic_Standard_Degree_4": _anamorphic,
}


def _camera(entries: Entries, model: str, name: str, options: Options) -> StatedCamera:
    size = stated_size(entries.document, options)
    for key, value in REQUIRED.items():
        if entries.number(key, value) != value:
            entries.fail(key, f"{value:g}, the only value that is read")
    focal = entries.positive("tde4_focal_length_cm")
    width, height = entries.positive("tde4_filmback_width_cm"), entries.positive("tde4_filmback_height_cm")
    unit = float(np.hypot(width, height)) / 2
    x, y = (entries.number(f"tde4_lens_center_offset_{axis}_cm", 0.0) for axis in "xy")
    upward = MODELS[model](entries)
    flip = np.array([1.0, -1.0])  # rows of realcam's plane increase downwards
    matrix = np.array(
        [
            [unit / width * size[0], 0, (0.5 + x / width) * size[0]],
            [0, unit / height * size[1], (0.5 - y / height) * size[1]],
            [0, 0, 1],
        ]
    )
    stated = {"node": model, **entries.values}
    distortion = Undistortion(lambda points: upward(points * flip) * flip, focal / unit, stated)
    return StatedCamera(
        CentralModel(Perspective(), distortion, matrix),
        size,
        model,
        name=name,
        format="3de4",
        file_values=stated,
        film_mm=(10 * width, 10 * height),
    )


def cameras(document: Document, options: Options) -> Cameras:
    found: dict[str, Callable[[], StatedCamera]] = {}
    for model, body in NODE.findall(document.text):
        if model not in MODELS:
            document.fail(f'unknown node "LD_{model:.60}"; expected one of {", ".join(f"LD_{m}" for m in MODELS)}')
        values = dict(KNOB.findall(body))
        name = values.get("name", f"{model} {len(found)}")
        entries = Entries(document, values, f"{name}.")
        found[name] = lambda e=entries, m=model, name=name: _camera(e, m, name, options)  # type: ignore[misc]
    return found


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    """Returns the knobs of a node. Coefficients do not depend on the resolution, but on the filmback's diagonal."""
    model = camera.camera_model
    if not isinstance(model, CentralModel) or not isinstance(model.projection, Perspective):
        raise Inexpressible("has only distortions of a pinhole camera's picture")
    (a, skew, u0), (shear, b, v0) = model.matrix[:2].tolist()
    if skew or shear:
        raise Inexpressible("has no skew of the pixels")
    width, height = camera.size
    filmback = np.array(camera.film_mm or (36.0, 36.0 * height / width)) / 10
    if isinstance(model.distortion, Undistortion):
        unit = float(np.hypot(*filmback)) / 2
        if max(abs(unit / filmback[0] * width / a - 1), abs(unit / filmback[1] * height / b - 1)) > 1e-12:
            raise Inexpressible("has no cropped pictures")
        knobs = {**model.distortion.stated, "tde4_focal_length_cm": model.distortion.ratio * unit}
    else:
        if not is_undistorted(terms_of(camera)):
            raise Inexpressible("has no polynomial from undistorted to distorted points")
        # Pixels of the file are square.
        filmback[1] = filmback[0] * height / width * a / b
        knobs = {"node": "3DE4_Radial_Standard_Degree_4", "tde4_focal_length_cm": a / width * filmback[0]}
    centre = {"x": (u0 / width - 0.5) * filmback[0], "y": (0.5 - v0 / height) * filmback[1]}
    return {
        **knobs,
        "tde4_filmback_width_cm": filmback[0],
        "tde4_filmback_height_cm": filmback[1],
        **{f"tde4_lens_center_offset_{axis}_cm": value for axis, value in centre.items()},
    }


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    nodes = []
    for name, values, _ in cameras:
        word = re.sub(r"\W", "_", name, flags=re.ASCII) or "Lens"
        knobs = {"direction": "distort", **values, "name": word}
        lines = [f" {k} {v if isinstance(v, str) else number(v)}\n" for k, v in knobs.items() if k != "node"]
        nodes.append(f"LD_{values['node']} {{\n{''.join(lines)}}}\n")
    return {path: "".join(nodes).encode()}


FORMAT: Format = Format(
    "3de4",
    lambda d: d.syntax == "text" and bool(NODE.search(d.text)),
    cameras,
    Writer(("*.nk",), _values, _content),
)
