"""Computer vision: camera models fitted to real lenses, files of poses and intrinsics, rigs, and optical flow."""

from .camera_json import camera_json, save_camera_json
from .colmap import save_colmap, save_colmap_of_rig
from .conventions import relative_pose
from .fit import CameraModelFit, fit_camera_model
from .flow import OpticalFlow, optical_flow
from .rig import Rig, RigCamera

__all__ = [
    "CameraModelFit",
    "OpticalFlow",
    "Rig",
    "RigCamera",
    "camera_json",
    "fit_camera_model",
    "optical_flow",
    "relative_pose",
    "save_camera_json",
    "save_colmap",
    "save_colmap_of_rig",
]
