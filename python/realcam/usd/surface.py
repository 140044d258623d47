"""Surfaces as polygons with primvars, and their triangles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

# Names of values that displace a deforming surface, three columns for each time sample after the first. The name of a
# primvar has no blank.
POINT_DELTAS, NORMAL_DELTAS = "point deltas", "normal deltas"

_MAX_EARS = 500  # corners of a concave face; cutting ears takes the third power of their number

Floats = NDArray[np.floating[Any]]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Values:
    """Values of a primvar. rows: (N, C). domain: "point", "corner" or "face"; N is the number of these elements, or 1
    for "constant"."""

    rows: Floats
    domain: str


@dataclass(frozen=True)
class Surface:
    """Polygons in the frame of their prim.

    points: (P, 3). counts: (F,) corners of each face. corners: (K,) indices of points, face after face,
    counterclockwise as seen from outside. faces: (F,) index of the face in the stage's prim. values: primvars by name;
    "normals" are the shading normals, and a surface without them is flat.
    """

    points: Floats
    counts: Indices
    corners: Indices
    faces: Indices
    values: Mapping[str, Values] = field(default_factory=dict)

    def with_values(self, **values: Values) -> Surface:
        return replace(self, values={**self.values, **values})

    def kept(self, keeps: NDArray[np.bool_]) -> Surface:
        """Returns the surface with some of its faces. keeps: (F,)."""
        of_corner = np.repeat(keeps, self.counts)
        values = {
            name: replace(v, rows=v.rows[{"corner": of_corner, "face": keeps}[v.domain]])
            if v.domain in ("corner", "face")
            else v
            for name, v in self.values.items()
        }
        return Surface(self.points, self.counts[keeps], self.corners[of_corner], self.faces[keeps], values)

    def reversed(self) -> Surface:
        """Returns the surface with the opposite orientation: the corners of each face in reverse order."""
        starts = np.cumsum(self.counts) - self.counts
        ends = np.repeat(starts + self.counts - 1, self.counts)
        order = ends - (np.arange(len(self.corners)) - np.repeat(starts, self.counts))
        values = {
            name: replace(v, rows=v.rows[order]) if v.domain == "corner" else v for name, v in self.values.items()
        }
        return replace(self, corners=self.corners[order], values=values)


@dataclass(frozen=True)
class Triangles:
    """Triangles of a surface. corners: (T, 3), indices in Surface.corners. face_rows: (T,), index in Surface.counts."""

    corners: Indices
    face_rows: Indices


def triangulated(surface: Surface) -> Triangles:
    """Returns the triangles of a surface: fans of convex faces, and ears (Meisters 1975) of concave ones with up to 500
    corners."""
    counts = surface.counts
    starts = np.cumsum(counts) - counts
    is_concave = _concave_faces(surface, starts) & (counts <= _MAX_EARS)
    fans = np.where(is_concave, 0, np.maximum(counts - 2, 0))
    rows = np.repeat(np.arange(len(counts)), fans)
    step = np.arange(len(rows)) - np.repeat(np.cumsum(fans) - fans, fans)
    first = starts[rows]
    corners = [np.stack([first, first + step + 1, first + step + 2], axis=-1)]
    face_rows = [rows]
    for row in np.flatnonzero(is_concave):
        polygon = surface.points[surface.corners[starts[row] : starts[row] + counts[row]]]
        ears = _ears(np.asarray(polygon, np.float64))
        corners.append(starts[row] + np.array(ears, np.int64).reshape(-1, 3))
        face_rows.append(np.full(len(ears), row))
    return Triangles(np.concatenate(corners), np.concatenate(face_rows))


def _concave_faces(surface: Surface, starts: Indices) -> NDArray[np.bool_]:
    """Returns, for each face, True if it has a reflex corner."""
    counts = surface.counts
    if (counts <= 3).all():
        return np.zeros(len(counts), bool)
    points = np.asarray(surface.points, np.float64)[surface.corners]
    size, begin = np.repeat(counts, counts), np.repeat(starts, counts)
    local = np.arange(len(points)) - begin
    before, after = begin + (local - 1) % size, begin + (local + 1) % size
    turns = np.cross(points - points[before], points[after] - points)
    normals = np.add.reduceat(np.cross(points - points[begin], points[after] - points[begin]), starts)
    is_reflex = np.einsum("ij,ij->i", turns, np.repeat(normals, counts, axis=0)) < 0
    return np.logical_or.reduceat(is_reflex, starts) & (counts > 3)


def _ears(points: Floats) -> list[tuple[int, int, int]]:
    """Returns the triangles of a simple polygon, (N, 3), by cutting off ears in the plane of its mean normal."""
    normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
    plane = [axis for axis in range(3) if axis != int(np.argmax(np.abs(normal)))]
    flat = points[:, plane]
    area = float(np.sum(flat[:, 0] * np.roll(flat[:, 1], -1) - flat[:, 1] * np.roll(flat[:, 0], -1)))
    flat = flat * np.array([1.0, np.copysign(1.0, area)])

    def turn(a: int, b: int, c: int | NDArray[np.int64]) -> Any:
        (ax, ay), (bx, by) = flat[a], flat[b]
        cx, cy = np.moveaxis(flat[c], -1, 0)
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    left = list(range(len(points)))
    ears: list[tuple[int, int, int]] = []
    while len(left) > 3:
        for i, b in enumerate(left):
            a, c = left[i - 1], left[(i + 1) % len(left)]
            others = np.array([v for v in left if v not in (a, b, c)])
            inside = (turn(a, b, others) >= 0) & (turn(b, c, others) >= 0) & (turn(c, a, others) >= 0)
            if turn(a, b, c) > 0 and not inside.any():
                break
        else:  # the polygon crosses itself
            i, a, b, c = 0, left[-1], left[0], left[1]
        ears.append((a, b, c))
        del left[i]
    return [*ears, (left[0], left[1], left[2])]


def vertex_arrays(surface: Surface, triangles: Triangles) -> tuple[Floats, dict[str, Floats], Indices]:
    """Returns vertices for triangles: positions (V, 3), values (V, C) by name, and indices (T, 3).

    Corners with equal point and values share a vertex.
    """
    used = triangles.corners.ravel()
    points = surface.corners[used]
    by_corner = [name for name, v in surface.values.items() if v.domain in ("corner", "face")]
    elements = {name: _elements(v, surface, triangles, used, points) for name, v in surface.values.items()}
    if by_corner:
        rows = [surface.values[name].rows[elements[name]] for name in by_corner if name != NORMAL_DELTAS]
        keys = [row.astype(np.float64) for row in (points[:, None], *rows)]
        table = np.ascontiguousarray(np.hstack(keys))
        whole = table.view(np.dtype((np.void, table.dtype.itemsize * table.shape[1]))).ravel()
        _, first, inverse = np.unique(whole, return_index=True, return_inverse=True)
        if NORMAL_DELTAS in by_corner:
            deltas = surface.values[NORMAL_DELTAS].rows
            first, inverse = _split(first, inverse.ravel(), deltas, elements[NORMAL_DELTAS])
    else:
        first = np.full(len(surface.points), -1)
        first[points] = np.arange(len(points))
        is_used = first >= 0
        inverse = (np.cumsum(is_used) - 1)[points]
        first = first[is_used]
    values = {name: v.rows[elements[name][first]] for name, v in surface.values.items()}
    return surface.points[points[first]], values, inverse.reshape(-1, 3)


def _split(first: Indices, inverse: Indices, rows: Floats, elements: Indices) -> tuple[Indices, Indices]:
    """Gives corners their own vertices where their rows differ from those of the first corner of their vertex. Returns
    the new `first` and `inverse`.

    A table of the rows of all corners, as keys of vertices, would take gigabytes for the samples of a film.
    """
    shared = elements[first][inverse]
    differs = np.zeros(len(inverse), bool)
    for column in rows.T:
        differs |= column[elements] != column[shared]
    own = np.flatnonzero(differs)
    inverse[own] = len(first) + np.arange(len(own))
    return np.concatenate([first, own]), inverse


def _elements(values: Values, surface: Surface, triangles: Triangles, used: Indices, points: Indices) -> Indices:
    """Returns the row of a primvar for each corner of the triangles."""
    if values.domain == "corner":
        return used
    if values.domain == "face":
        return np.repeat(triangles.face_rows, 3)
    return points if values.domain == "point" else np.zeros_like(points)


def next_corners(counts: Indices) -> Indices:
    """Returns the index of the next corner of the same face, for each corner."""
    following = np.arange(counts.sum()) + 1
    ends = np.cumsum(counts)
    following[ends - 1] = ends - counts
    return following


def sums(index: Indices, rows: Floats, count: int) -> Floats:
    """Returns the sums of rows, (N, C), with equal index, (count, C)."""
    return np.stack([np.bincount(index, column, minlength=count) for column in rows.T], axis=-1)
