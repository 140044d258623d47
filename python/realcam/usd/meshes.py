"""Meshes of UsdGeom as surfaces."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from .deformation import PointSamples
from .stage import OpenStage
from .subdivision import INFINITE, SCHEMES, Sharpness, subdivided
from .surface import NORMAL_DELTAS, POINT_DELTAS, Surface, Values, triangulated

_DOMAINS = {"constant": "constant", "uniform": "face", "varying": "point", "vertex": "point", "faceVarying": "corner"}


def mesh_surface(
    opened: OpenStage, prim: Usd.Prim, primvars: Iterable[str], samples: PointSamples | None = None
) -> Surface | None:
    """Returns the surface of a mesh with some of its primvars and, as "normals", its normals; None if it is empty.

    samples: if given, the surface is that of the first one, with the displacements to the others as POINT_DELTAS and
    NORMAL_DELTAS. Raises SceneFileError if its indices are invalid.
    """
    mesh, time = UsdGeom.Mesh(prim), opened.time
    rows = samples.points[0] if samples else mesh.GetPointsAttr().Get(time)
    points = _array(rows, np.float64).reshape(-1, 3)
    counts = _array(mesh.GetFaceVertexCountsAttr().Get(time), np.int64)
    corners = _array(mesh.GetFaceVertexIndicesAttr().Get(time), np.int64)
    _check(opened, prim, points, counts, corners)
    if not len(counts) or not len(points):
        return None
    surface = Surface(points, counts, corners, np.arange(len(counts)))
    if samples:
        deltas = np.hstack([sample - points for sample in samples.points[1:]])
        surface = surface.with_values(**{POINT_DELTAS: Values(deltas, "point")})
    api = UsdGeom.PrimvarsAPI(prim)
    for name in primvars:
        values = _primvar(opened, api.FindPrimvarWithInheritance(name), surface)
        if values:
            surface = surface.with_values(**{name: values})
    scheme = str(mesh.GetSubdivisionSchemeAttr().Get(time))
    if scheme in ("none", "bilinear"):
        surface = _with_normals(opened, mesh, surface, samples)
    if (counts < 3).any():
        opened.notices.add(prim.GetPath(), "faces with fewer than three corners are left out")
        surface = surface.kept(counts >= 3)
    if scheme in SCHEMES:
        surface = _subdivided(opened, mesh, surface, scheme)
    elif scheme not in ("none", "bilinear"):
        opened.notices.add(prim.GetPath(), f"subdivisionScheme {scheme}: the mesh is not subdivided")
    holes = _array(mesh.GetHoleIndicesAttr().Get(time), np.int64)
    if len(holes):
        surface = surface.kept(~np.isin(surface.faces, holes))
    if mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded:
        surface = surface.reversed()
    return surface if len(surface.counts) else None


def shape_with_primvars(opened: OpenStage, prim: Usd.Prim, surface: Surface, primvars: Iterable[str]) -> Surface:
    """Returns a basic shape with its constant primvars; others have no defined positions on it."""
    api = UsdGeom.PrimvarsAPI(prim)
    for name in primvars:
        primvar = api.FindPrimvarWithInheritance(name)
        values = _array(primvar.ComputeFlattened(opened.time), np.float64) if primvar.HasValue() else np.zeros(0)
        if len(values) == 1:
            surface = surface.with_values(**{name: Values(values.reshape(1, -1), "constant")})
        elif len(values):
            opened.notices.add(primvar.GetAttr().GetPath(), "a basic shape has constant primvars only; it is left out")
    return surface


def _array(value: Any, dtype: Any) -> NDArray[Any]:
    return np.zeros(0, dtype) if value is None else np.array(value, dtype)


def _check(
    opened: OpenStage, prim: Usd.Prim, points: NDArray[Any], counts: NDArray[Any], corners: NDArray[Any]
) -> None:
    if (counts < 0).any():
        raise opened.fail(prim, f"faceVertexCounts: expected numbers from 0; found {counts.min()}")
    if counts.sum() != len(corners):
        raise opened.fail(prim, f"faceVertexIndices: expected {counts.sum()} indices; found {len(corners)}")
    if len(corners) and (corners.min() < 0 or corners.max() >= len(points)):
        wrong = corners.min() if corners.min() < 0 else corners.max()
        raise opened.fail(prim, f"faceVertexIndices: expected indices from 0 to {len(points) - 1}; found {wrong}")
    if not np.isfinite(points).all():
        raise opened.fail(prim, "points: expected finite numbers")


def _primvar(
    opened: OpenStage, primvar: UsdGeom.Primvar, surface: Surface, time: Usd.TimeCode | None = None
) -> Values | None:
    """Returns a primvar at a time; None: at the start of the stage, with a notice if it has values over time."""
    if not primvar or not primvar.HasValue():
        return None
    if time is None and primvar.ValueMightBeTimeVarying():
        opened.notices.add(primvar.GetAttr().GetPath(), "its values over time are left out; the first one is used")
    rows = _array(primvar.ComputeFlattened(opened.time if time is None else time), np.float64)
    return _values(opened, primvar.GetAttr(), rows, str(primvar.GetInterpolation()), surface)


def _with_normals(opened: OpenStage, mesh: UsdGeom.Mesh, surface: Surface, samples: PointSamples | None) -> Surface:
    """Returns a surface with the authored normals, and their changes at the samples of the points."""
    if not samples:
        normals = _normals(opened, mesh, surface)
        return surface.with_values(normals=normals) if normals else surface
    first, *others = (_normals(opened, mesh, surface, Usd.TimeCode(time)) for time in samples.times)
    if not first:
        return surface
    deltas = np.hstack([other.rows - first.rows if other else np.zeros_like(first.rows) for other in others])
    surface = surface.with_values(normals=first)
    return surface.with_values(**{NORMAL_DELTAS: Values(deltas, first.domain)}) if deltas.any() else surface


def _normals(
    opened: OpenStage, mesh: UsdGeom.Mesh, surface: Surface, time: Usd.TimeCode | None = None
) -> Values | None:
    """Returns the authored normals, primvars:normals before normals; None if there are none, or they are no vectors.
    time: as for _primvar."""
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    if primvar and primvar.HasValue():
        values = _primvar(opened, primvar, surface, time)
    else:
        rows = _array(mesh.GetNormalsAttr().Get(opened.time if time is None else time), np.float64)
        if not len(rows):
            return None
        values = _values(opened, mesh.GetNormalsAttr(), rows, str(mesh.GetNormalsInterpolation()), surface)
    return values if values and values.rows.shape[1] == 3 else None


def _values(
    opened: OpenStage, attribute: Usd.Attribute, rows: NDArray[Any], interpolation: str, surface: Surface
) -> Values | None:
    domain = _DOMAINS.get(interpolation, "constant")
    expected = {
        "constant": 1,
        "face": len(surface.counts),
        "point": len(surface.points),
        "corner": len(surface.corners),
    }[domain]
    if len(rows) != expected or not np.isfinite(rows).all():
        found = f"found {len(rows)}" if len(rows) != expected else "found numbers that are not finite"
        opened.notices.add(attribute.GetPath(), f"expected {expected} values ({interpolation}); {found}; left out")
        return None
    return Values(rows.reshape(expected, -1), domain)


def _subdivided(opened: OpenStage, mesh: UsdGeom.Mesh, surface: Surface, scheme: str) -> Surface:
    if not len(surface.counts):
        return surface
    if scheme == "loop" and (surface.counts != 3).any():
        opened.notices.add(
            mesh.GetPath(), "subdivisionScheme loop: expected triangles; its faces are cut into triangles"
        )
        surface = _cut(surface)
    boundary = str(mesh.GetInterpolateBoundaryAttr().Get(opened.time))
    if boundary == "none":
        opened.notices.add(mesh.GetPath(), "interpolateBoundary none: its boundary faces are shown")
    if str(mesh.GetTriangleSubdivisionRuleAttr().Get(opened.time)) == "smooth":
        opened.notices.add(mesh.GetPath(), "triangleSubdivisionRule smooth is left out")
    edges, values = _creases(opened, mesh)
    points = _array(mesh.GetCornerIndicesAttr().Get(opened.time), np.int64)
    sharpness = _array(mesh.GetCornerSharpnessesAttr().Get(opened.time), np.float64)
    is_valid = len(points) == len(sharpness) and ((points >= 0) & (points < len(surface.points))).all()
    if not is_valid:
        raise opened.fail(mesh.GetPrim(), "cornerIndices: expected indices of points, with one sharpness for each")
    corner_values = np.clip(np.nan_to_num(sharpness), 0, INFINITE)
    return subdivided(surface, scheme, Sharpness(edges, values, points, corner_values, boundary == "edgeAndCorner"))


def _cut(surface: Surface) -> Surface:
    """Returns the surface with triangles for its faces."""
    triangles = triangulated(surface)
    used = triangles.corners.ravel()
    values = {
        name: Values(v.rows[used if v.domain == "corner" else triangles.face_rows], v.domain)
        if v.domain in ("corner", "face")
        else v
        for name, v in surface.values.items()
    }
    count = len(triangles.corners)
    return Surface(surface.points, np.full(count, 3), surface.corners[used], surface.faces[triangles.face_rows], values)


def _creases(opened: OpenStage, mesh: UsdGeom.Mesh) -> tuple[NDArray[Any], NDArray[Any]]:
    """Returns edges (E, 2) and sharpnesses (E,) of the creases, whose sharpnesses are per crease or per edge."""
    time = opened.time
    lengths = _array(mesh.GetCreaseLengthsAttr().Get(time), np.int64)
    indices = _array(mesh.GetCreaseIndicesAttr().Get(time), np.int64)
    sharpness = _array(mesh.GetCreaseSharpnessesAttr().Get(time), np.float64)
    if not len(lengths):
        return np.zeros((0, 2), np.int64), np.zeros(0)
    edge_count = int((lengths - 1).sum())
    if (lengths < 2).any() or lengths.sum() != len(indices) or len(sharpness) not in (len(lengths), edge_count):
        raise opened.fail(mesh.GetPrim(), "creases: expected lengths of 2 or more that fit indices and sharpnesses")
    is_last = np.zeros(len(indices), bool)
    is_last[np.cumsum(lengths) - 1] = True
    begin = np.flatnonzero(~is_last)
    edges = np.stack([indices[begin], indices[begin + 1]], axis=-1)
    values = sharpness if len(sharpness) == edge_count else np.repeat(sharpness, lengths - 1)
    return edges, np.clip(np.nan_to_num(values), 0, INFINITE)
