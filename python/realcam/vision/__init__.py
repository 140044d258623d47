"""Computer vision: camera models fitted to real lenses, files of poses and intrinsics, rigs, and optical flow."""

from .camera_json import camera_json as camera_json
from .camera_json import save_camera_json as save_camera_json
from .colmap import save_colmap as save_colmap
from .colmap import save_colmap_of_rig as save_colmap_of_rig
from .conventions import relative_pose as relative_pose
from .fit import CameraModelFit as CameraModelFit
from .fit import fit_camera_model as fit_camera_model
from .flow import OpticalFlow as OpticalFlow
from .flow import optical_flow as optical_flow
from .rig import Rig as Rig
from .rig import RigCamera as RigCamera
