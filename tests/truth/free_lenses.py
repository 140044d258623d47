"""Lenses that are not centred or not of revolution, as plain rows, and rays through them.

A row has the arguments of realcam.Surface, with "index" or "mirror" for what is behind it.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field

import numpy as np

PLACE = ("decentre_mm", "tilt_deg", "returns")


@dataclass(frozen=True)
class Row:
    radius: float = np.inf  # mm
    thickness: float = 0.0
    index: float = 1.0
    semi: float = 10.0
    mirror: bool = False
    conic: float = 0.0
    decentre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tilt: tuple[float, float, float] = (0.0, 0.0, 0.0)
    returns: bool = False
    form: dict = field(default_factory=dict)  # arguments of realcam.Surface


def rotation(tilt: tuple[float, float, float]) -> np.ndarray:
    """Columns: the turned axes. About x, then the new y, then the new z."""
    (ca, cb, cc), (sa, sb, sc) = np.cos(np.deg2rad(tilt)), np.sin(np.deg2rad(tilt))
    about_x = np.array([[1, 0, 0], [0, ca, -sa], [0, sa, ca]])
    about_y = np.array([[cb, 0, sb], [0, 1, 0], [-sb, 0, cb]])
    about_z = np.array([[cc, -sc, 0], [sc, cc, 0], [0, 0, 1]])
    return about_x @ about_y @ about_z


def frames(rows: list[Row]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Vertex and axes of each surface in the lens frame."""
    origin, axes = np.zeros(3), np.eye(3)
    result = []
    for row in rows:
        at, turned = origin + axes @ np.array(row.decentre), axes @ rotation(row.tilt)
        result.append((at, turned))
        if not row.returns:
            origin, axes = at, turned
        origin = origin + axes[:, 2] * row.thickness
    return result


def rays(count: int, half_width: float, half_angle: float, seed: int) -> np.ndarray:
    """(count, 6): origins 5 mm before the lens frame's origin, and unit directions."""
    rng = np.random.default_rng(seed)
    at = np.column_stack([rng.uniform(-half_width, half_width, (count, 2)), np.full(count, -5.0)])
    slopes = np.tan(np.deg2rad(rng.uniform(-half_angle, half_angle, (count, 2))))
    direction = np.column_stack([slopes, np.ones(count)])
    return np.column_stack([at, direction / np.linalg.norm(direction, axis=1, keepdims=True)])


NOLL = [0, 0.1, -0.05, 0.02, 0.03, -0.01, 0.004, -0.003, 0.002, 0.001, 0.005]
FRINGE = [0, 0.05, 0.02, -0.03, 0.01, 0.02, 0.003, -0.002, 0.004, 0.001, -0.001, 0.002]
DOUBLET = [Row(60, 6, 1.62, 14), Row(-45, 2, 1.7, 14), Row(-150, 8, 1, 14)]


def _tilts() -> dict[str, list[Row]]:
    first, second, third = DOUBLET
    return {
        "one tilted surface": [first, Row(-45, 2, 1.7, 14, tilt=(3, -5, 8), returns=True), third],
        "a decentred lens": [
            Row(60, 6, 1.62, 14, decentre=(0.7, -1.1, 0)),
            second,
            third,
            Row(-40, 2, 1.5, 12, conic=-0.4, tilt=(-6, 4, 20)),
            Row(80, 3, 1, 12),
        ],
        "a fold": [
            first,
            second,
            third,
            Row(mirror=True, semi=25, tilt=(45, 0, 0)),
            Row(-70, -4, 1.5, 14, tilt=(45, 0, 0), decentre=(0, 0, 0)),
            Row(90, -3, 1, 14),
        ],
        "two folds out of plane": [
            first,
            Row(-45, 20, 1, 14),
            Row(mirror=True, semi=30, tilt=(45, 0, 0)),
            Row(mirror=False, semi=30, tilt=(45, 0, 0), thickness=-30),
            Row(mirror=True, semi=40, tilt=(0, 40, 0)),
            Row(semi=40, tilt=(0, 40, 0), thickness=20),
            Row(50, 3, 1.6, 30),
            Row(np.inf, 0, 1, 30),
        ],
        "an off-axis paraboloid": [
            Row(semi=60, thickness=80),
            Row(-160, 0, mirror=True, conic=-1, semi=60, decentre=(0, 12, 0)),
            Row(semi=60, thickness=-40, tilt=(10, 0, 0)),
        ],
    }


def _forms() -> dict[str, list[Row]]:
    def with_form(row: Row, **form) -> list[Row]:
        placed = Row(row.radius, 5, 1.6, 10, conic=row.conic, form=form, decentre=(0.3, -0.2, 0), tilt=(2, 3, 0))
        return [placed, Row(-80, 2, 1, 12)]

    return {
        "a cylinder": with_form(Row(), form="toroid", radius_of_curvature_x_mm=40.0),
        "a cylinder the other way": with_form(Row(35), form="toroid"),
        "a toroid": with_form(
            Row(50, conic=-0.5),
            form="toroid",
            radius_of_curvature_x_mm=-70.0,
            aspheric_coefficients={4: 1e-5, 6: -2e-8},
        ),
        "odd terms": with_form(Row(45, conic=0.3), radial_terms={2: 1e-3, 3: 2e-4, 5: -1e-6}),
        "terms of x and y": with_form(
            Row(60, conic=-1.2), xy_terms={(1, 0): 0.02, (2, 0): 1e-3, (0, 3): -2e-4, (2, 2): 3e-6, (4, 1): 1e-7}
        ),
        "Zernike terms by Noll": with_form(
            Row(55, conic=0.2),
            zernike={
                "order": "noll",
                "radius_mm": 12.0,
                "coefficients_mm": NOLL,
            },
        ),
        "fringe Zernike terms": with_form(
            Row(-65),
            zernike={
                "order": "fringe",
                "radius_mm": 11.0,
                "coefficients_mm": FRINGE,
            },
        ),
        "Forbes terms from a sphere": with_form(
            Row(70), forbes={"kind": "bfs", "radius_mm": 12.0, "coefficients_mm": [0.05, -0.02, 0.01, 0.004]}
        ),
    }


def all_lenses() -> dict[str, list[Row]]:
    return {**_tilts(), **_forms()}


def to_json(rows: list[Row]) -> list[dict]:
    plain = []
    for row in rows:
        values = dict(vars(row))
        if "xy_terms" in row.form:
            values["form"] = {**row.form, "xy_terms": [[*ij, value] for ij, value in row.form["xy_terms"].items()]}
        plain.append(values)
    return json.loads(json.dumps(plain))
