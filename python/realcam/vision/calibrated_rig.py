"""Cameras of calibrations in the frame of a rig."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .._core import Camera, InputError
from ..calibration import Calibration
from ..calibration.arrays import Array
from ..calibration.rig import transforms_from
from ..calibration.transforms import inverse_of
from .conventions import FLIPPED


def poses_in_rig(calibrations: Mapping[str, Calibration]) -> dict[str, Array]:
    """Returns the (4, 4) poses of the centres of projection in the frame of a rig, as Calibration.camera takes them.

    The frame is that of the first camera: x right, y up, z backward, origin at its centre of projection, metres.
    Raises InputError if the calibrations do not state their relative poses.
    """
    transforms = transforms_from("camera0", list(calibrations.values()))
    back = inverse_of(transforms[0])
    return {
        name: FLIPPED @ inverse_of(transform @ back) for name, transform in zip(calibrations, transforms, strict=True)
    }


def cameras_in_rig(calibrations: Mapping[str, Calibration], settings: Mapping[str, Any]) -> dict[str, Camera]:
    """Returns the cameras of calibrations in the frame of poses_in_rig. settings: arguments of Calibration.camera.

    Raises InputError.
    """
    if not calibrations or not all(isinstance(each, Calibration) for each in calibrations.values()):
        raise InputError("calibrations must be a mapping of names to rc.Calibration, with one at least")
    if "scene_from_camera" in settings:
        raise InputError("a rig's cameras get their poses from their calibrations; moved(matrix) poses the rig")
    poses = poses_in_rig(calibrations)
    return {name: each.camera(scene_from_camera=poses[name], **settings) for name, each in calibrations.items()}
