"""Cameras of a recipe's calibrations, and the further cameras of a stereo pair or rig."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, InputError
from ..calibration import Calibration
from ..vision.calibrated_rig import poses_in_rig

Array = NDArray[np.float64]


@lru_cache(maxsize=16)
def calibrations_in(file: str, camera: str, is_rig: bool) -> Mapping[str, Calibration]:
    """Returns the calibrations of a file by the names of the cameras: the one with this name, or all those of a rig.

    camera: empty for the only camera of the file, and for a rig. Raises InputError, CalibrationFileError.
    """
    if not is_rig:
        found = {camera: Calibration.load(file, camera or None)}
    else:
        found = Calibration.load_all(file)
        if len(found) < 2:
            raise InputError(f"{file}: expected a rig of two cameras or more; found one")
        poses_in_rig(found)
    return MappingProxyType(found)


@lru_cache(maxsize=64)
def calibrated_camera(
    file: str, camera: str, is_rig: bool, size: tuple[int, int], lens: str, film_width_mm: float
) -> Camera:
    """Returns the camera of a calibration at the origin.

    camera: a name in calibrations_in(). film_width_mm: 0 for the width that Calibration.camera chooses. Raises
    InputError.
    """
    calibration = calibrations_in(file, camera if not is_rig else "", is_rig)[camera].resized(size)
    return calibration.camera(lens, film_width_mm=film_width_mm or None)


def poses_from_first(calibrations: Mapping[str, Calibration], first: Camera) -> dict[str, Array]:
    """Returns the poses (4, 4) of all cameras, in metres, in the axes of poses_in_rig, about the first camera's film.

    first: the first camera. Camera.position is the centre of the film; the centre of projection, which is the origin of
    poses_in_rig, is the entrance pupil in front of it.
    """
    still = first.replace(motion=[], position=(0, 0, 0), look_at=(0, 0, -1), up=(0, 1, 0))
    shift = np.eye(4)
    shift[:3, 3] = still.entrance_pupil_position_m
    return {name: shift @ pose for name, pose in poses_in_rig(calibrations).items()}
