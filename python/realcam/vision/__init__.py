"""Computer vision: camera models fitted to real lenses, and files of poses and intrinsics."""

from .camera_json import camera_json, save_camera_json
from .colmap import save_colmap, save_colmap_of_rig
from .conventions import relative_pose
from .fit import CameraModelFit, fit_camera_model

__all__ = [
    "CameraModelFit",
    "camera_json",
    "fit_camera_model",
    "relative_pose",
    "save_camera_json",
    "save_colmap",
    "save_colmap_of_rig",
]
