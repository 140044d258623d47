"""Moving prims: keys of translation, rotation and scale for glTF."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom

from .glb import Glb, Json
from .stage import OpenStage

MAX_KEYS = 20_000  # of a prim
_TOLERANCE = 1e-3  # of a matrix between keys, relative to its largest element
_MAX_HALVINGS = 6  # of the time between two samples

Trs = tuple[NDArray[Any], NDArray[Any], NDArray[Any]]


def set_transform(opened: OpenStage, glb: Glb, node: Json, index: int, xformable: UsdGeom.Xformable) -> None:
    """Sets the transform of a node of the document: a matrix, or keys over time. index: of the node."""
    if not xformable.TransformMightBeTimeVarying():
        node["matrix"] = flat(_local(xformable, opened.time))
        return
    is_held = opened.stage.GetInterpolationType() == Usd.InterpolationTypeHeld
    times, rows = _keys(opened, xformable, is_held)
    if not np.isfinite(np.concatenate([np.ravel(r) for row in rows for r in row])).all():
        raise opened.fail(xformable.GetPrim(), "its transform: expected finite numbers")
    at_start = _decomposed(_local(xformable, opened.time))
    node["translation"], node["rotation"], node["scale"] = (list(map(float, part)) for part in at_start)
    if len(times) < 2:
        return
    seconds = glb.floats(np.array([opened.seconds(time) for time in times]))
    for k, path in enumerate(("translation", "rotation", "scale")):
        values = np.array([row[k] for row in rows])
        if np.ptp(values, axis=0).max() > 0:
            glb.animate(index, path, glb.sampler(seconds, values, is_held))


def flat(matrix: Gf.Matrix4d) -> list[float]:
    """Returns a matrix of USD, which acts on row vectors, in the order of glTF's columns."""
    return [float(matrix[row][column]) for row in range(4) for column in range(4)]


def _local(xformable: UsdGeom.Xformable, time: Usd.TimeCode) -> Gf.Matrix4d:
    return xformable.GetLocalTransformation(time)


def _keys(opened: OpenStage, xformable: UsdGeom.Xformable, is_held: bool) -> tuple[list[float], list[Trs]]:
    """Returns the times of keys, as time codes, and the transforms at them. Between two samples of the stage there are
    more keys where the interpolation of glTF would differ from that of USD, as for a whole turn."""
    samples = sorted(xformable.GetTimeSamples())[:MAX_KEYS]
    if len(samples) == MAX_KEYS:
        opened.notices.add(xformable.GetPath(), f"only the first {MAX_KEYS} time samples are read")
    prim = xformable.GetPrim()

    def at(time: float) -> tuple[Gf.Matrix4d, Trs]:
        matrix = _local(xformable, Usd.TimeCode(time))
        return matrix, _decomposed(matrix)

    times: list[float] = []
    rows: list[Trs] = []

    def add_between(begin: float, first: Trs, end: float, last: Trs, halvings: int) -> None:
        middle = (begin + end) / 2
        matrix, trs = at(middle)
        if halvings == 0 or len(times) > MAX_KEYS or _is_near(np.array(matrix), _halfway(first, last)):
            return
        add_between(begin, first, middle, trs, halvings - 1)
        times.append(middle)
        rows.append(trs)
        add_between(middle, trs, end, last, halvings - 1)

    for time in samples:
        matrix, trs = at(time)
        if _has_shear(matrix):  # between samples, matrices that USD interpolates linearly always have some
            opened.notices.add(prim.GetPath(), "the shear of its moving transform is left out")
        if times and not is_held:
            add_between(times[-1], rows[-1], time, trs, _MAX_HALVINGS)
        times.append(time)
        rows.append(trs)
    return times, rows


def _decomposed(matrix: Gf.Matrix4d) -> Trs:
    """Returns translation, rotation (x, y, z, w) and scale of a matrix without shear."""
    rows = np.array(matrix)[:3, :3]
    scale = np.linalg.norm(rows, axis=1)
    if np.linalg.det(rows) < 0:
        scale[0] = -scale[0]
    axes = rows / np.where(scale != 0, scale, 1)[:, None]
    quaternion = Gf.Matrix3d(*map(float, axes.ravel())).GetOrthonormalized(False).ExtractRotation().GetQuat()
    rotation = np.array([*quaternion.GetImaginary(), quaternion.GetReal()])
    return np.array(matrix)[3, :3], rotation, scale


def _has_shear(matrix: Gf.Matrix4d) -> bool:
    rows = np.array(matrix)[:3, :3]
    axes = rows / np.maximum(np.linalg.norm(rows, axis=1), 1e-300)[:, None]
    products = axes @ axes.T
    return bool(np.abs(products - np.diag(np.diag(products))).max() > 1e-4)


def _halfway(first: Trs, last: Trs) -> NDArray[Any]:
    """Returns the matrix halfway between two keys, as glTF interpolates them."""
    a, b = first[1], last[1]
    middle = a + (b if a @ b >= 0 else -b)
    x, y, z, w = map(float, middle / max(float(np.linalg.norm(middle)), 1e-300))
    turned = np.array(Gf.Matrix3d(Gf.Rotation(Gf.Quatd(w, x, y, z))))
    out = np.eye(4)
    out[:3, :3] = ((first[2] + last[2]) / 2)[:, None] * turned
    out[3, :3] = (first[0] + last[0]) / 2
    return out


def _is_near(a: NDArray[Any], b: NDArray[Any]) -> bool:
    return float(np.abs(a - b).max()) <= _TOLERANCE * max(float(np.abs(a).max()), 1e-300)
