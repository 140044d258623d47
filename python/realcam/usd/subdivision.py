"""Subdivision surfaces: up to two levels of Catmull-Clark or Loop, with the vertices moved to their limit positions.

usd-core has no subdivision. The rules are those of Catmull and Clark (1978) and Loop (1987), with semi-sharp creases
and corners of DeRose, Kass and Truong (1998). Texture coordinates of corners are interpolated linearly.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .smooth_normals import with_smooth_normals
from .surface import POINT_DELTAS, Floats, Indices, Surface, Values, next_corners, sums

SCHEMES = ("catmullClark", "loop")
LEVELS = 2
MAX_FACES = 200_000  # of a mesh after subdivision; a mesh that would have more gets fewer levels
INFINITE = 10.0  # sharpness from which a crease or corner stays sharp at all levels


@dataclass(frozen=True)
class Sharpness:
    """Creases and corners of a control mesh. edges: (E, 2) points, edge_values: (E,). points: (C,), point_values: (C,).
    keeps_corners: points of a single face stay where they are."""

    edges: Indices
    edge_values: Floats
    points: Indices
    point_values: Floats
    keeps_corners: bool = True


@dataclass(frozen=True)
class _Edges:
    """Edges of a mesh. ends: (E, 2) points. of_corner: (K,) edge from each corner to the next one. uses: (E,) number of
    faces. sharpness: (E,), infinite at boundaries."""

    ends: Indices
    of_corner: Indices
    uses: Indices
    sharpness: Floats


def refined_size(corner_count: int) -> int:
    """Returns the number of faces, and about that of points, after the subdivision of a mesh."""
    levels = _levels(corner_count)
    return corner_count * 4 ** (levels - 1) if levels else corner_count


def subdivided(surface: Surface, scheme: str, sharpness: Sharpness) -> Surface:
    """Returns a subdivided surface with smooth normals.

    scheme: "catmullClark", or "loop" for triangles. Primvars of points are subdivided as the points are, those of
    corners linearly.
    """
    levels = _levels(len(surface.corners))
    edge_points = sharpness.edges
    edge_values: Floats = np.asarray(sharpness.edge_values, np.float64)
    corner_values: Floats = np.zeros(len(surface.points))
    np.maximum.at(corner_values, sharpness.points, sharpness.point_values)
    surface = replace(surface, points=np.asarray(surface.points, np.float64))
    refine = _catmull_clark if scheme == "catmullClark" else _loop
    for level in range(levels):
        edges = _edges_of(surface, edge_points, edge_values)
        if level == 0 and sharpness.keeps_corners:
            corner_values[_points_of_one_face(surface)] = INFINITE
        surface, edge_points, edge_values, corner_values = refine(surface, edges, corner_values)
    if levels and scheme == "catmullClark":
        surface = _at_limit(surface, _edges_of(surface, edge_points, edge_values), corner_values)
    return with_smooth_normals(surface)


def _levels(corner_count: int) -> int:
    levels = LEVELS
    while levels > 0 and corner_count * 4 ** (levels - 1) > MAX_FACES:
        levels -= 1
    return levels


def _points_of_one_face(surface: Surface) -> Indices:
    return np.flatnonzero(np.bincount(surface.corners, minlength=len(surface.points)) == 1)


def _edges_of(surface: Surface, crease_ends: Indices, crease_values: Floats) -> _Edges:
    count = len(surface.points)
    pairs = np.stack([surface.corners, surface.corners[next_corners(surface.counts)]], axis=-1)
    pairs.sort(axis=-1)
    keys, of_corner, uses = np.unique(pairs[:, 0] * count + pairs[:, 1], return_inverse=True, return_counts=True)
    sharpness = np.where(uses == 2, 0.0, INFINITE)  # boundaries, and edges of three faces
    if len(crease_ends):
        low, high = crease_ends.min(axis=-1), crease_ends.max(axis=-1)
        wanted = low * count + high
        found = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        exists = keys[found] == wanted
        np.maximum.at(sharpness, found[exists], crease_values[exists])
    return _Edges(np.stack([keys // count, keys % count], axis=-1), of_corner.ravel(), uses, sharpness)


def _channels(surface: Surface) -> tuple[Floats, list[tuple[str, int]]]:
    """Returns points and their primvars side by side, (P, 3 + C), with the names and widths of the primvars."""
    names = [(name, v.rows.shape[1]) for name, v in surface.values.items() if v.domain == "point"]
    return np.hstack([surface.points, *(surface.values[name].rows for name, _ in names)]), names


def _vertex_points(rows: Floats, smooth: Floats, edges: _Edges, corner_values: Floats) -> Floats:
    """Returns the new rows of the old points: smooth, on a crease, or at a corner, or a mixture where the sharpness is
    below 1. smooth: (P, C) rows without creases."""
    count = len(rows)
    is_sharp = edges.sharpness > 0
    ends, values = edges.ends[is_sharp], edges.sharpness[is_sharp]
    number = np.bincount(ends.ravel(), minlength=count)
    others = sums(np.concatenate([ends[:, 0], ends[:, 1]]), rows[np.concatenate([ends[:, 1], ends[:, 0]])], count)
    crease = 0.75 * rows + others / 8
    mean = np.bincount(ends.ravel(), np.repeat(values, 2), minlength=count) / np.maximum(number, 1)
    out: Floats = smooth.copy()
    on_crease = number == 2
    weight: Floats = np.clip(mean, 0, 1)[:, None]
    out[on_crease] = (weight * crease + (1 - weight) * smooth)[on_crease]
    at_corner = number > 2
    out[at_corner] = (weight * rows + (1 - weight) * smooth)[at_corner]
    weight = np.clip(corner_values, 0, 1)[:, None]
    return np.asarray(weight * rows + (1 - weight) * out)


def _weaker(sharpness: Floats) -> Floats:
    return np.where(sharpness >= INFINITE, sharpness, np.maximum(sharpness - 1, 0))


def _edge_points(rows: Floats, smooth: Floats, edges: _Edges) -> Floats:
    """Returns the rows of the new points on edges; `smooth`: without creases."""
    weight = np.clip(edges.sharpness, 0, 1)[:, None]
    return np.asarray(weight * rows[edges.ends].mean(axis=1) + (1 - weight) * smooth)


_Refined = tuple[Surface, Indices, Floats, Floats]


def _catmull_clark(surface: Surface, edges: _Edges, corner_values: Floats) -> _Refined:
    rows, names = _channels(surface)
    counts, corners = surface.counts, surface.corners
    point_count, edge_count, face_count = len(rows), len(edges.ends), len(counts)
    face_of = np.repeat(np.arange(face_count), counts)
    centres = sums(face_of, rows[corners], face_count) / counts[:, None]
    of_edge = sums(edges.of_corner, centres[face_of], edge_count)
    smooth_edges = (rows[edges.ends].sum(axis=1) + of_edge) / 4
    new_edges = _edge_points(rows, smooth_edges, edges)
    valence = np.maximum(np.bincount(corners, minlength=point_count), 1)[:, None]
    face_mean = sums(corners, centres[face_of], point_count) / valence
    neighbours = np.concatenate([edges.ends[:, 0], edges.ends[:, 1]])
    middles = np.tile(rows[edges.ends].mean(axis=1), (2, 1))
    edge_valence = np.maximum(np.bincount(neighbours, minlength=point_count), 1)[:, None]
    edge_mean = sums(neighbours, middles, point_count) / edge_valence
    smooth = (face_mean + 2 * edge_mean + (edge_valence - 3) * rows) / edge_valence
    new_points = _vertex_points(rows, smooth, edges, corner_values)
    new_rows = np.vstack([new_points, new_edges, centres])
    previous = _previous_corners(counts)
    quads = np.stack(
        [
            corners,
            point_count + edges.of_corner,
            point_count + edge_count + face_of,
            point_count + edges.of_corner[previous],
        ],
        axis=-1,
    )
    middle = point_count + np.arange(edge_count)
    creases = np.vstack([np.stack([edges.ends[:, k], middle], axis=-1) for k in (0, 1)])
    values = np.tile(_weaker(edges.sharpness), 2)
    new_corners = np.concatenate([_weaker(corner_values), np.zeros(edge_count + face_count)])
    refined = Surface(
        new_rows[:, :3],
        np.full(len(quads), 4),
        quads.ravel(),
        surface.faces[face_of],
        _refined_values(surface, new_rows, names, face_of, previous, face_of),
    )
    return refined, creases[values > 0], values[values > 0], new_corners


def _previous_corners(counts: Indices) -> Indices:
    following = next_corners(counts)
    previous = np.empty_like(following)
    previous[following] = np.arange(len(following))
    return previous


def _refined_values(
    surface: Surface,
    new_rows: Floats,
    names: list[tuple[str, int]],
    face_of: Indices,
    previous: Indices,
    parents: Indices,
) -> dict[str, Values]:
    """Returns the primvars after a step that splits a face into a quad at each corner. parents: (new faces,)."""
    values: dict[str, Values] = {}
    for name, v in surface.values.items():
        if v.domain == "face":
            values[name] = Values(v.rows[parents], "face")
        elif v.domain == "corner":
            rows = np.asarray(v.rows, np.float64)
            halves = (rows + rows[next_corners(surface.counts)]) / 2
            centres = sums(face_of, rows, len(surface.counts)) / surface.counts[:, None]
            quads = np.stack([rows, halves, centres[face_of], halves[previous]], axis=1)
            values[name] = Values(quads.reshape(-1, rows.shape[1]), "corner")
        elif v.domain == "constant":
            values[name] = v
    return {**values, **_point_values(new_rows, names)}


def _point_values(rows: Floats, names: list[tuple[str, int]]) -> dict[str, Values]:
    values, begin = {}, 3
    for name, width in names:
        values[name] = Values(rows[:, begin : begin + width], "point")
        begin += width
    return values


def _loop(surface: Surface, edges: _Edges, corner_values: Floats) -> _Refined:
    rows, names = _channels(surface)
    triangles = surface.corners.reshape(-1, 3)
    point_count, edge_count = len(rows), len(edges.ends)
    of_corner = edges.of_corner.reshape(-1, 3)  # edge from corner k to k + 1, opposite to corner k + 2
    opposite = sums(of_corner.ravel(), rows[np.roll(triangles, 1, axis=1).ravel()], edge_count)
    new_edges = _edge_points(rows, 3 / 8 * rows[edges.ends].sum(axis=1) + opposite / 8, edges)
    both = np.concatenate([edges.ends[:, 0], edges.ends[:, 1]])
    valence = np.maximum(np.bincount(both, minlength=point_count), 1)[:, None]
    ring = sums(both, rows[np.concatenate([edges.ends[:, 1], edges.ends[:, 0]])], point_count)
    beta = (5 / 8 - (3 / 8 + np.cos(2 * np.pi / valence) / 4) ** 2) / valence  # Loop 1987
    new_points = _vertex_points(rows, (1 - valence * beta) * rows + beta * ring, edges, corner_values)
    new_rows = np.vstack([new_points, new_edges])
    middle = point_count + of_corner
    before = np.roll(middle, 1, axis=1)
    corner_triangles = np.stack([triangles, middle, before], axis=-1)  # (T, 3, 3)
    children = np.concatenate([corner_triangles, middle[:, None, :]], axis=1).reshape(-1, 3)
    parents = np.repeat(np.arange(len(triangles)), 4)
    values: dict[str, Values] = {}
    for name, v in surface.values.items():
        if v.domain == "face":
            values[name] = Values(v.rows[parents], "face")
        elif v.domain == "corner":
            corner_rows = np.asarray(v.rows, np.float64).reshape(len(triangles), 3, -1)
            halves = (corner_rows + np.roll(corner_rows, -1, axis=1)) / 2
            quads = np.stack([corner_rows, halves, np.roll(halves, 1, axis=1)], axis=2)
            all_rows = np.concatenate([quads, halves[:, None]], axis=1)
            values[name] = Values(all_rows.reshape(-1, corner_rows.shape[2]), "corner")
        elif v.domain == "constant":
            values[name] = v
    values.update(_point_values(new_rows, names))
    refined = Surface(new_rows[:, :3], np.full(len(children), 3), children.ravel(), surface.faces[parents], values)
    middles = point_count + np.arange(edge_count)
    creases = np.vstack([np.stack([edges.ends[:, k], middles], axis=-1) for k in (0, 1)])
    crease_values = np.tile(_weaker(edges.sharpness), 2)
    new_corners = np.concatenate([_weaker(corner_values), np.zeros(edge_count)])
    return refined, creases[crease_values > 0], crease_values[crease_values > 0], new_corners


def _at_limit(surface: Surface, edges: _Edges, corner_values: Floats) -> Surface:
    """Moves the points of quads to their positions on the limit surface (Halstead, Kass and DeRose 1993).

    On creases and boundaries the limit is that of a cubic B-spline curve, (a + 4 p + b) / 6. Displacements follow
    the same linear rules.
    """
    deltas = surface.values.get(POINT_DELTAS)
    points = np.asarray(surface.points if deltas is None else np.hstack([surface.points, deltas.rows]), np.float64)
    count = len(points)
    corners = surface.corners.reshape(-1, 4)
    opposite = sums(corners.ravel(), points[np.roll(corners, 2, axis=1).ravel()], count)
    both = np.concatenate([edges.ends[:, 0], edges.ends[:, 1]])
    others = np.concatenate([edges.ends[:, 1], edges.ends[:, 0]])
    valence = np.maximum(np.bincount(both, minlength=count), 1)[:, None]
    ring = sums(both, points[others], count)
    limit = (valence**2 * points + 4 * ring + opposite) / (valence * (valence + 5))
    is_sharp = np.tile(edges.sharpness > 0, 2)
    number = np.bincount(both[is_sharp], minlength=count)
    along = sums(both[is_sharp], points[others[is_sharp]], count)
    on_crease = number == 2
    limit[on_crease] = ((4 * points + along) / 6)[on_crease]
    stays = (number > 2) | (corner_values > 0) | (np.bincount(surface.corners, minlength=count) == 0)
    limit[stays] = points[stays]
    surface = replace(surface, points=limit[:, :3])
    return surface if deltas is None else surface.with_values(**{POINT_DELTAS: Values(limit[:, 3:], "point")})
