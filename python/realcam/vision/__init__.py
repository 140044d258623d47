"""Cameras as computer vision knows them: camera models fitted to real lenses, and files of poses and intrinsics."""

from .camera_json import camera_json, save_camera_json
from .colmap import save_colmap
from .fit import CameraModelFit, fit_camera_model

__all__ = ["CameraModelFit", "camera_json", "fit_camera_model", "save_camera_json", "save_colmap"]
