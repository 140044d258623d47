"""Optical flow: the motion of each pixel's object point from one picture to the next."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, InputError, Scene
from ..files import check_target, write_whole
from ..image import Image
from ..pickling import PickledByFields
from ..render import render

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

LAYERS = ("object_id", "position_middle", "depth_middle")  # layers that flow_between requires

_FAR_M = 1e9  # stands for infinity: the parallax of camera motion is negligible there
_MAX_ITERATIONS = 20
_FLO_UNKNOWN = 1e10  # the format's value for unknown flow


@dataclass(frozen=True, eq=False)
class OpticalFlow(PickledByFields):
    """Displacement of each pixel's object point in the next picture.

    pixels: (H, W, 2) float32, displacement to the right and down, in pixels; NaN if no light of the scene reaches the
    pixel centre, or if the next lens does not image the point. visible: (H, W) bool, True if the point lies within the
    next picture and is not occluded there.

    Raises InputError.
    """

    pixels: NDArray[np.float32]
    visible: NDArray[np.bool_]

    def __post_init__(self) -> None:
        pixels, visible = self.pixels, self.visible
        if not isinstance(pixels, np.ndarray) or pixels.dtype != np.float32 or pixels.shape[2:] != (2,):
            raise InputError("pixels must be an array of (H, W, 2) float32")
        if not isinstance(visible, np.ndarray) or visible.dtype != bool or visible.shape != pixels.shape[:2]:
            raise InputError("visible must be an array of (H, W) bool, for the pixels' H and W")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, OpticalFlow):
            return NotImplemented
        return np.array_equal(self.visible, other.visible) and np.array_equal(self.pixels, other.pixels, equal_nan=True)

    __hash__ = None  # type: ignore[assignment]  # its arrays may be written to

    def __repr__(self) -> str:
        height, width = self.visible.shape
        return f"<realcam.OpticalFlow {width} x {height} pixels, {np.mean(self.visible):.0%} visible>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes .flo, the format of the Middlebury and Sintel data sets.

        The flow of occluded points is included; 1e10 marks unknown flow. Raises ImageFileError.
        """
        check_target(path, (".flo",))
        height, width = self.visible.shape
        head = np.array([202021.25], "<f4").tobytes() + np.array([width, height], "<i4").tobytes()
        write_whole(path, head + np.nan_to_num(self.pixels, nan=_FLO_UNKNOWN).astype("<f4").tobytes())


def optical_flow(
    scene: Scene, camera: Camera, next_camera: Camera, next_scene: Scene | None = None, *, device: str = "auto"
) -> OpticalFlow:
    """Returns the optical flow from a camera's picture to that of another camera, or of the same camera later.

    flow = rc.optical_flow(scene, camera, camera.replace(shutter_opens_s=1 / 24))

    The flow is that of the surface hit by each pixel-centre ray (docs/layers.md), from the middle of its row's exposure
    to the middle of the exposure of the row that shows it in the next picture. It includes the motion of camera and
    objects, and the distortion and breathing of lenses. Points at infinity move with the camera's rotation. next_scene:
    the scene of the next picture, with the same instances, if objects have moved otherwise than by the motion of their
    instances; None: the same scene.

    Raises InputError, DeviceError.
    """
    first, second = (
        render(picture_scene, picture_camera, spp=1, max_bounces=0, layers=list(LAYERS), effects=(), device=device)
        for picture_scene, picture_camera in ((scene, camera), (next_scene or scene, next_camera))
    )
    return flow_between(first, second, scene, next_scene)


def flow_between(first: Image, second: Image, scene: Scene, next_scene: Scene | None = None) -> OpticalFlow:
    """Computes optical_flow from two rendered pictures that have LAYERS. Raises InputError."""
    second_scene = next_scene or scene
    if [name for name, _ in second_scene.instances] != [name for name, _ in scene.instances]:
        raise InputError("next_scene must have the instances of scene, by the same names and in the same order")
    depth = first.layers["depth_middle"]
    row, column = np.nonzero(~np.isnan(depth))
    centres = np.column_stack([column, row]) + 0.5
    ids, points = first.layers["object_id"][row, column], first.layers["position_middle"][row, column].astype(float)
    is_far = np.isinf(depth[row, column])
    if is_far.any():
        origins, directions = first.camera.ray(centres[is_far])
        points[is_far] = origins + _FAR_M * directions
    matrices = _row_transforms(second_scene, second.camera)
    to_objects = np.linalg.inv(_row_transforms(scene, first.camera)).astype(np.float64)
    in_objects = _transformed(points, ids, row, to_objects)
    # Rolling shutter: the row determines the time, and the time the row. Fixed-point iteration until both agree.
    seen_row, last = row.copy(), second.depth.shape[0] - 1
    next_points, projected = np.empty_like(points), np.empty_like(centres)
    pending = np.arange(len(row))
    for _ in range(_MAX_ITERATIONS):
        next_points[pending] = _transformed(in_objects[pending], ids[pending], seen_row[pending], matrices)
        projected[pending] = second.camera.project(next_points[pending])
        next_row = np.clip(np.nan_to_num(projected[pending, 1]), 0, last).astype(np.int64)
        has_changed = (next_row != seen_row[pending]) & (len(matrices) > 1)
        seen_row[pending] = next_row
        pending = pending[has_changed]
        if len(pending) == 0:
            break
    # project() uses the mean of a pixel's rays, which differs slightly from the pixel-centre ray; taking the difference
    # of two projections cancels that.
    displacement = projected - first.camera.project(points)
    flow = np.full((*depth.shape, 2), np.nan, np.float32)
    visible = np.zeros(depth.shape, bool)
    flow[row, column] = displacement
    visible[row, column] = _is_visible(second, centres + displacement, next_points, ids)
    return OpticalFlow(flow, visible)


def _row_transforms(scene: Scene, camera: Camera) -> Array:
    """Returns the transforms of the instances in the middle of each row's exposure: (rows, instances, 4, 4).

    There is a single row if they are the same for all rows.
    """
    height = camera.film.resolution[1]
    rows = height if any(scene.motions) and camera.readout_time_s > 0 else 1
    middle_s = camera.shutter_opens_s + 0.5 * camera.exposure_time_s
    scenes = [scene.at_time(middle_s + camera.readout_time_s * row / height) for row in range(rows)]
    matrices = [matrix for each in scenes for _, matrix in each.instances]
    transforms: Array = np.reshape(matrices, (rows, len(scene.instances), 4, 4))
    return transforms


def _transformed(points: Array, ids: NDArray[np.uint32], rows: Rows, transforms: Array) -> Array:
    """Transforms points by the matrices of their objects and rows. ids: values of the layer object_id."""
    transformed: Array = points.copy()
    on = ids >= 2  # 0: no object; 1: static geometry
    matrices = transforms[rows[on] if len(transforms) > 1 else 0, ids[on].astype(np.int64) - 2]
    transformed[on] = np.einsum("nij,nj->ni", matrices[:, :3, :3], points[on]) + matrices[:, :3, 3]
    return transformed


def _is_visible(picture: Image, at: Array, points: Array, ids: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Returns True for the points, projected to the pixel positions `at`, that are visible in a picture.

    A point is visible if one of the four pixels around its position shows the same object, and this at the point's
    distance or further away. The tolerance of 0.1% of the distance covers curved surfaces and float32 rounding.
    """
    height, width = picture.depth.shape
    with np.errstate(invalid="ignore"):
        inside = (at >= 0).all(axis=1) & (at[:, 0] <= width) & (at[:, 1] <= height)
    distances = np.linalg.norm(picture.layers["position_middle"] - picture.camera.position, axis=-1)
    distances = np.where(np.isinf(picture.layers["depth_middle"]), _FAR_M, distances)
    is_visible = np.zeros(len(at), bool)
    corner = np.floor(at[inside] - 0.5).astype(np.int64)
    farthest, nearest = np.full((2, len(corner)), np.nan)
    for down in range(-1, 3):
        for right in range(-1, 3):
            row, column = np.clip(corner[:, 1] + down, 0, height - 1), np.clip(corner[:, 0] + right, 0, width - 1)
            is_same = picture.layers["object_id"][row, column] == ids[inside]
            of_object = np.where(is_same, distances[row, column], np.nan)
            nearest = np.fmin(nearest, of_object)
            if 0 <= down <= 1 and 0 <= right <= 1:
                farthest = np.fmax(farthest, of_object)
    # A slanted surface extends beyond the centres of the last pixels that show it.
    slant = farthest - nearest
    of_points = np.linalg.norm(points[inside] - picture.camera.position, axis=1)
    is_visible[inside] = 0.999 * of_points <= farthest + slant
    return is_visible
