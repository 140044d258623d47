"""Surfaces of the basic shapes, with exact normals."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from pxr import Usd, UsdGeom

from .surface import Floats, Surface, Values

SEGMENTS = 96  # about the axis: the chords of a radius r lie 0.0005 r inside the surface
_AXES = {"X": [2, 0, 1], "Y": [1, 2, 0], "Z": [0, 1, 2]}  # columns of a shape about z that give one about another axis


def shape_surface(prim: Usd.Prim, time: Usd.TimeCode) -> Surface | None:
    """Returns the surface of a basic shape; None for prims of other types and for shapes without extent."""
    for schema, surface_of in _SHAPES:
        if prim.IsA(schema):
            surface = surface_of(schema(prim), time)
            axis = prim.GetAttribute("axis").Get(time) if prim.HasAttribute("axis") else "Z"
            return about_axis(surface, str(axis)) if surface and np.ptp(surface.points, axis=0).any() else None
    return None


def about_axis(surface: Surface, axis: str) -> Surface:
    """Returns a surface about z turned to an axis "X", "Y" or "Z"."""
    columns = _AXES.get(axis, _AXES["Z"])
    normals = surface.values["normals"]
    turned = Surface(surface.points[:, columns], surface.counts, surface.corners, surface.faces)
    return turned.with_values(normals=Values(normals.rows[:, columns], normals.domain))


def joined(parts: list[Surface]) -> Surface:
    """Returns several surfaces as one; their normals are those of points."""
    offsets = np.cumsum([0] + [len(part.points) for part in parts])
    surface = Surface(
        np.vstack([part.points for part in parts]),
        np.concatenate([part.counts for part in parts]),
        np.concatenate([part.corners + offset for part, offset in zip(parts, offsets, strict=False)]),
        np.arange(sum(len(part.counts) for part in parts)),
    )
    return surface.with_values(normals=Values(np.vstack([part.values["normals"].rows for part in parts]), "point"))


def revolved(profile: Floats, normals: Floats, segments: int = SEGMENTS) -> Surface:
    """Returns the surface of a profile that revolves about z.

    profile, normals: (N, 2), (radius, z), in the order in which z rises on the outside of a solid.
    """
    angles = 2 * np.pi * np.arange(segments) / segments
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=-1)

    def rotated(rows: Floats) -> Floats:
        flat = rows[:, None, :1] * circle[None]
        return np.concatenate([flat, np.broadcast_to(rows[:, None, 1:], (*flat.shape[:2], 1))], axis=-1).reshape(-1, 3)

    column = np.arange(segments)
    following = (column + 1) % segments
    counts, corners = [], []
    for i in range(len(profile) - 1):
        low, high = i * segments, (i + 1) * segments
        face = [low + column, low + following, high + following, high + column]
        if profile[i, 0] == 0:
            face.pop(1)
        elif profile[i + 1, 0] == 0:
            face.pop(2)
        counts.append(np.full(segments, len(face)))
        corners.append(np.stack(face, axis=-1).ravel())
    all_counts = np.concatenate(counts)
    surface = Surface(rotated(profile), all_counts, np.concatenate(corners), np.arange(len(all_counts)))
    return surface.with_values(normals=Values(rotated(normals), "point"))


def disc(radius: float, z: float, direction: float) -> Surface:
    """Returns a disc about z that faces +z (direction 1) or -z (direction -1)."""
    profile = np.array([[radius, z], [0, z]]) if direction > 0 else np.array([[0, z], [radius, z]])
    return revolved(profile, np.array([[0, direction]] * 2))


def rectangle(width: float, height: float) -> Surface:
    """Returns a rectangle in the xy plane that faces +z."""
    x, y = width / 2, height / 2
    points = np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]], np.float64)
    surface = Surface(points, np.array([4]), np.arange(4), np.arange(1))
    return surface.with_values(normals=Values(np.tile([0.0, 0.0, 1.0], (4, 1)), "point"))


def sphere(radius: float, segments: int = SEGMENTS) -> Surface:
    """Returns a sphere of a radius about the origin."""
    return revolved(*_arc(radius, 0, -1, 1, segments), segments=segments)


def _arc(radius: float, z: float, begin: float, end: float, segments: int = SEGMENTS) -> tuple[Floats, Floats]:
    """Returns profile and normals of an arc about (0, z) between latitudes in units of 90 degrees."""
    count = max(round(segments / 4 * (end - begin)), 1) + 1
    latitude = np.linspace(begin, end, count) * np.pi / 2
    normals = np.stack([np.cos(latitude), np.sin(latitude)], axis=-1)
    normals[np.abs(np.abs(latitude) - np.pi / 2) < 1e-9, 0] = 0  # exact poles
    return radius * normals + np.array([0, z]), normals


def _side(bottom: float, top: float, height: float) -> Surface:
    """Returns the side of a cone or cylinder from z = -height / 2, where its radius is `bottom`."""
    normal = np.array([height, bottom - top])
    normal = normal / max(float(np.hypot(*normal)), 1e-300)
    return revolved(np.array([[bottom, -height / 2], [top, height / 2]]), np.array([normal, normal]))


def _cube(shape: Any, time: Usd.TimeCode) -> Surface:
    half = float(shape.GetSizeAttr().Get(time)) / 2
    face = rectangle(2 * half, 2 * half)
    points, normals = face.points + np.array([0, 0, half]), face.values["normals"].rows
    parts = []
    for columns in _AXES.values():
        for sign in (1, -1):
            turn = np.array([sign, 1, sign])  # half a turn about y
            part = Surface((points * turn)[:, columns], face.counts, face.corners, face.faces)
            parts.append(part.with_values(normals=Values((normals * turn)[:, columns], "point")))
    return joined(parts)


def _sphere(shape: Any, time: Usd.TimeCode) -> Surface:
    return sphere(float(shape.GetRadiusAttr().Get(time)))


def _cylinder(shape: Any, time: Usd.TimeCode) -> Surface:
    radius, height = (float(attribute.Get(time)) for attribute in (shape.GetRadiusAttr(), shape.GetHeightAttr()))
    return _closed(radius, radius, height)


def _cylinder_1(shape: Any, time: Usd.TimeCode) -> Surface:
    bottom, top = float(shape.GetRadiusBottomAttr().Get(time)), float(shape.GetRadiusTopAttr().Get(time))
    return _closed(bottom, top, float(shape.GetHeightAttr().Get(time)))


def _cone(shape: Any, time: Usd.TimeCode) -> Surface:
    return _closed(float(shape.GetRadiusAttr().Get(time)), 0.0, float(shape.GetHeightAttr().Get(time)))


def _closed(bottom: float, top: float, height: float) -> Surface:
    parts = [_side(bottom, top, height)]
    parts += [disc(bottom, -height / 2, -1)] if bottom > 0 else []
    parts += [disc(top, height / 2, 1)] if top > 0 else []
    return joined(parts)


def _capsule(shape: Any, time: Usd.TimeCode) -> Surface:
    radius = float(shape.GetRadiusAttr().Get(time))
    return _capsule_of(radius, radius, float(shape.GetHeightAttr().Get(time)))


def _capsule_1(shape: Any, time: Usd.TimeCode) -> Surface:
    bottom, top = float(shape.GetRadiusBottomAttr().Get(time)), float(shape.GetRadiusTopAttr().Get(time))
    return _capsule_of(bottom, top, float(shape.GetHeightAttr().Get(time)))


def _capsule_of(bottom: float, top: float, height: float) -> Surface:
    # The side is tangent to both spheres at this latitude.
    latitude = np.arcsin(np.clip((bottom - top) / max(height, 1e-300), -1, 1)) / (np.pi / 2)
    low, high = _arc(bottom, -height / 2, -1, latitude), _arc(top, height / 2, latitude, 1)
    return revolved(np.vstack([low[0], high[0]]), np.vstack([low[1], high[1]]))


def _plane(shape: Any, time: Usd.TimeCode) -> Surface:
    # By the schema, the width of a plane about z lies along x and its length along y; about x along z and y; about y
    # along x and z.
    width, length = float(shape.GetWidthAttr().Get(time)), float(shape.GetLengthAttr().Get(time))
    axis = str(shape.GetAxisAttr().Get(time))
    # The rectangle is turned by about_axis, which takes z to the axis, x to the next axis and y to the one after it.
    return rectangle(width, length) if axis == "Z" else rectangle(length, width)


_SHAPES: tuple[tuple[Any, Callable[[Any, Usd.TimeCode], Surface]], ...] = (
    (UsdGeom.Cube, _cube),
    (UsdGeom.Sphere, _sphere),
    (UsdGeom.Cylinder_1, _cylinder_1),
    (UsdGeom.Cylinder, _cylinder),
    (UsdGeom.Cone, _cone),
    (UsdGeom.Capsule_1, _capsule_1),
    (UsdGeom.Capsule, _capsule),
    (UsdGeom.Plane, _plane),
)
