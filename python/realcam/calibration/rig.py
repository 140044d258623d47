"""Poses of several cameras relative to one another, from the transforms that their files state."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from .._core import InputError
from .arrays import Array
from .stated_camera import StatedCamera
from .transforms import inverse_of

# Transforms that do not lead to a frame that all cameras share.
_OWN_FRAMES = ("camera_from_previous", "rectified_from_camera")


def transforms_from(frame: str, cameras: Sequence[StatedCamera]) -> list[Array]:
    """Returns the (4, 4) transforms from a frame to the axes of each camera, metres.

    frame: such as "imu". If the cameras do not state it, the axes of the first camera take its place. Raises InputError
    if the cameras state no common frame.
    """
    key = f"camera_from_{frame}"
    if all(key in camera.extrinsics for camera in cameras):
        return [camera.extrinsics[key] for camera in cameras]
    shared = [k for k in cameras[0].extrinsics if k not in _OWN_FRAMES and all(k in c.extrinsics for c in cameras)]
    if shared:
        back = inverse_of(cameras[0].extrinsics[shared[0]])
        return [np.eye(4), *(camera.extrinsics[shared[0]] @ back for camera in cameras[1:])]
    found = [np.eye(4)]
    for camera in cameras[1:]:
        if "camera_from_previous" not in camera.extrinsics:
            raise InputError(
                f'camera "{camera.name:.40}" states no pose relative to the others; expected extrinsics with '
                f"camera_from_previous, or the same key for all cameras, such as {key}"
            )
        found.append(camera.extrinsics["camera_from_previous"] @ found[-1])
    return found


def transforms_from_previous(cameras: Sequence[StatedCamera]) -> list[Array]:
    """Returns the transforms from the axes of each camera but the last to those of the next one. Raises InputError."""
    if all("camera_from_previous" in camera.extrinsics for camera in cameras[1:]):
        return [camera.extrinsics["camera_from_previous"] for camera in cameras[1:]]
    found = transforms_from("camera0", cameras)
    return [after @ inverse_of(before) for before, after in pairwise(found)]
