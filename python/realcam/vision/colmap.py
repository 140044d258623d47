"""Export of cameras and poses as a COLMAP text model."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .._core import Camera, Film, InputError, Lens
from ..calibration.formats.colmap import camera_text
from ..calibration.formats.colmap_images import HEADS, image_text, pose_text, text_content
from ..calibration.transforms import turned
from ..files import make_folder, write_whole
from .conventions import relative_pose
from .fit import fit_camera_model
from .models import model_named

COLMAP_MODELS = {
    "pinhole": "PINHOLE",
    "opencv4": "OPENCV",
    "opencv5": "FULL_OPENCV",
    "opencv8": "FULL_OPENCV",
    "fisheye": "OPENCV_FISHEYE",
}


def save_colmap(folder: str | os.PathLike[str], pictures: Mapping[str, Camera], model: str = "opencv5") -> None:
    """Writes cameras.txt, images.txt and an empty points3D.txt for a mapping of picture names to cameras.

    folder: created if missing. model: see fit_camera_model; it is fitted once for each combination of lens, film and
    Camera.model. "pinhole" becomes COLMAP's PINHOLE, "opencv4" OPENCV, "opencv5" and "opencv8" FULL_OPENCV, and
    "fisheye" OPENCV_FISHEYE. Poses are in metres, with their origin at the centre of the entrance pupil.

    Raises InputError, ImageFileError.
    """
    lines = _CameraLines(model)
    ids: dict[_CameraKey, int] = {}
    images = []
    for i, (name, camera) in enumerate(pictures.items(), start=1):
        camera_id = ids.setdefault(_key_of(camera), len(ids) + 1)
        images.append(image_text(i, turned(*camera.world_to_camera), camera_id, name))
        lines.line_of(camera)
    _write(folder, [f"{i} {lines.by_camera[key]}" for key, i in ids.items()], images, {})


def save_colmap_of_rig(
    folder: str | os.PathLike[str], moments: Mapping[str, Mapping[str, Camera]], model: str = "opencv5"
) -> None:
    """Writes the files of save_colmap for a rigid rig, plus rigs.txt and frames.txt (COLMAP 3.12 and later).

    moments: moments[m][c] is the camera c of the rig at the moment m; its picture's path is "c/m". All moments have the
    same cameras, with the same lenses and films, at the same poses in the rig. model: as for save_colmap. The first
    camera is COLMAP's reference sensor. Raises InputError and ImageFileError.
    """
    lines = _CameraLines(model)
    rig = next(iter(moments.values()), {})
    if not rig:
        raise InputError("a COLMAP model of a rig needs the pictures of at least one pose")
    cameras = [f"{i} {lines.line_of(camera)}" for i, camera in enumerate(rig.values(), start=1)]
    first, *others = (camera.world_to_camera for camera in rig.values())
    placed = [turned(*relative_pose(pose, first)) for pose in others]
    sensors = [f"CAMERA {i} 1 {pose_text(pose)}" for i, pose in enumerate(placed, start=2)]
    images: list[str] = []
    frames: list[str] = []
    for moment, members in moments.items():
        if members.keys() != rig.keys():
            raise InputError(f"moment {moment!r} has the cameras {list(members)}; the first one has {list(rig)}")
        for name, camera in rig.items():
            if _key_of(members[name]) != _key_of(camera):
                raise InputError(f"moment {moment!r}: camera {name!r} has another lens or film than in the first one")
        poses = [members[name].world_to_camera for name in rig]
        for name, pose, expected in zip(list(rig)[1:], poses[1:], placed, strict=True):
            # Poses are metres and cosines; beyond rounding, 1e-6 of either is a motion.
            if np.abs(turned(*relative_pose(pose, poses[0])) - expected).max() > 1e-6:
                raise InputError(f"moment {moment!r}: camera {name!r} has moved in the rig, which must be rigid")
        picture_ids = []
        for i, (name, pose) in enumerate(zip(rig, poses, strict=True), start=1):
            images.append(image_text(len(images) + 1, turned(*pose), i, f"{name}/{moment}"))
            picture_ids.append(f"CAMERA {i} {len(images)}")
        frames.append(f"{len(frames) + 1} 1 {pose_text(turned(*poses[0]))} {len(picture_ids)} {' '.join(picture_ids)}")
    rigs = [" ".join([f"1 {len(cameras)} CAMERA 1", *sensors])]
    _write(folder, cameras, images, {"rigs.txt": (_RIGS, rigs), "frames.txt": (_FRAMES, frames)})


_RIGS = (
    "RIG_ID NUM_SENSORS REF_SENSOR_TYPE REF_SENSOR_ID SENSORS[] (SENSOR_TYPE SENSOR_ID HAS_POSE QW QX QY QZ TX TY TZ)"
)
_FRAMES = "FRAME_ID RIG_ID QW QX QY QZ TX TY TZ NUM_DATA_IDS DATA_IDS[] (SENSOR_TYPE SENSOR_ID DATA_ID)"

_CameraKey = tuple[Lens, Film, str]


def _key_of(camera: Camera) -> _CameraKey:
    return camera.lens, camera.film, camera.model


class _CameraLines:
    """Lines of cameras.txt, cached for each combination of lens, film and camera model. Raises InputError."""

    def __init__(self, model: str) -> None:
        if model not in COLMAP_MODELS:
            model_named(model)  # raises for an unknown name
            raise InputError(f"COLMAP has no camera model {model}; expected one of {', '.join(COLMAP_MODELS)}")
        self._model = model
        self.by_camera: dict[_CameraKey, str] = {}

    def line_of(self, camera: Camera) -> str:
        """Returns the line of a camera without its id; fits the camera model if no equal camera has been fitted."""
        key = _key_of(camera)
        if key not in self.by_camera:
            self.by_camera[key] = camera_text(
                fit_camera_model(camera, self._model).calibration, COLMAP_MODELS[self._model]
            )
        return self.by_camera[key]


def _write(
    folder: str | os.PathLike[str],
    cameras: list[str],
    images: list[str],
    others: Mapping[str, tuple[str, list[str]]],
) -> None:
    files = {
        "cameras.txt": (HEADS["cameras.txt"], cameras),
        "images.txt": (HEADS["images.txt"], images),
        "points3D.txt": (HEADS["points3D.txt"], []),
        **others,
    }
    make_folder(Path(folder))
    for file, (head, lines) in files.items():
        write_whole(Path(folder, file), text_content(head, lines))
