"""Meshes whose points have time samples: morph targets of glTF, and the keys of their weights."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from math import inf, isqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from .glb import Glb
from .stage import OpenStage
from .subdivision import SCHEMES, refined_size

# Largest number of samples times points of a stage: of its meshes together, and of all nodes with such meshes. A mesh
# counts as if it had at least as many points as samples, because the keys of its weights are a square matrix.
MAX_MOVING_POINTS = 10_000_000


@dataclass(frozen=True)
class PointSamples:
    """Time samples of a mesh's points. times: (S,) time codes, S > 1. points: (S, P, 3). size: samples times points, as
    MAX_MOVING_POINTS counts them."""

    times: list[float]
    points: NDArray[np.float32]
    size: int


class Deformations:
    """The deforming meshes of a document."""

    def __init__(self, opened: OpenStage, glb: Glb) -> None:
        self._opened = opened
        self._glb = glb
        self._meshes: dict[int, tuple[int, int]] = {}  # sampler and size, by index of the mesh
        self._size_read = 0
        self._size_played = 0

    def samples_of(self, prim: Usd.Prim) -> PointSamples | None:
        """Returns the samples of a mesh's points from the start of the stage to the first change of its topology; None
        if its points do not move. Raises SceneFileError if points are not finite."""
        mesh = UsdGeom.Mesh(prim)
        count = len(mesh.GetPointsAttr().Get(self._opened.time) or ())
        refined_count = max(_count_when_refined(self._opened, mesh, count), 1)
        room = MAX_MOVING_POINTS - self._size_read
        samples = _samples(self._opened, mesh, count, min(room // refined_count, isqrt(room)))
        points = list(samples.values())
        if all(np.array_equal(row, points[0]) for row in points[1:]):
            return None
        size = len(samples) * max(refined_count, len(samples))
        self._size_read += size
        return PointSamples(list(samples), np.stack(points), size)

    def add(self, mesh: int, samples: PointSamples) -> None:
        """Adds the keys of the weights of a mesh, whose target k is the displacement from sample 0 to k + 1. mesh: its
        index in the document."""
        seconds = np.array([self._opened.seconds(time) for time in samples.times], np.float32)
        seconds, rows = np.unique(seconds, return_index=True)  # in floats, times may coincide
        weights = np.eye(len(samples.times), dtype=np.float32)[rows, 1:]
        is_held = self._opened.stage.GetInterpolationType() == Usd.InterpolationTypeHeld
        sampler = self._glb.sampler(self._glb.floats(seconds), weights.ravel(), is_held)
        self._meshes[mesh] = sampler, samples.size

    def play(self, node: int, mesh: int) -> None:
        """Animates the weights of a node that has a mesh, if the mesh deforms. node, mesh: indices in the document."""
        if mesh not in self._meshes:
            return
        sampler, size = self._meshes[mesh]
        if self._size_played + size > MAX_MOVING_POINTS:
            text = "some of its instances keep the shape of its first time sample, by the limit of a stage"
            self._opened.notices.add(self._glb.json["meshes"][mesh]["name"], text)
            return
        self._size_played += size
        self._glb.animate(node, "weights", sampler)


def _samples(opened: OpenStage, mesh: UsdGeom.Mesh, count: int, limit: int) -> dict[float, NDArray[np.float32]]:
    """Returns the samples of a mesh's points by time code, (count, 3) each, up to the first change of topology. limit:
    on their number."""
    attribute, end = mesh.GetPointsAttr(), _end_of_topology(opened, mesh)
    samples: dict[float, NDArray[np.float32]] = {}
    times = _times_from_start(opened, attribute)
    for time in times if len(times) > 1 else []:
        points = np.array(attribute.Get(time) or (), np.float32).reshape(-1, 3)
        if len(points) != count:
            end = min(end, time)
        if time >= end:
            break
        if len(samples) == limit:
            text = f"its points over time are read up to {limit} samples, by the limit of a stage"
            opened.notices.add(attribute.GetPath(), text)
            break
        if not np.isfinite(points).all():
            raise opened.fail(mesh.GetPrim(), f"points at time code {time:g}: expected finite numbers")
        samples[time] = points
    if end < inf:
        opened.notices.add(mesh.GetPath(), f"its topology changes at time code {end:g}; its shape stays from there")
    return samples


def _times_from_start(opened: OpenStage, attribute: Usd.Attribute) -> list[float]:
    """Returns the times of samples, beginning with the last one that is not after the start of the stage."""
    times = sorted(attribute.GetTimeSamples())
    return times[max(bisect_right(times, opened.time.GetValue()) - 1, 0) :]


def _end_of_topology(opened: OpenStage, mesh: UsdGeom.Mesh) -> float:
    """Returns the first time code at which the faces of a mesh differ from those at the start of the stage; infinity if
    there is none."""
    end = inf
    for attribute in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()):
        first: Any = attribute.Get(opened.time)
        later = _times_from_start(opened, attribute)[1:]
        end = min(end, next((t for t in later if not np.array_equal(attribute.Get(t), first)), inf))
    return end


def _count_when_refined(opened: OpenStage, mesh: UsdGeom.Mesh, count: int) -> int:
    """Returns the number of points of a mesh with this number of points after its subdivision."""
    if str(mesh.GetSubdivisionSchemeAttr().Get(opened.time)) not in SCHEMES:
        return count
    return max(count, refined_size(len(mesh.GetFaceVertexIndicesAttr().Get(opened.time) or ())))
