"""realcam photographs 3D scenes through real lenses, ray by ray.

import realcam as rc

lens = rc.Lens.load("double-gauss-50mm").focused(1.2).stopped_down(2.8)
camera = rc.Camera(lens, position=(0, 0.3, 1.2), look_at=(0, 0.1, 0), exposure_time_s=1 / 60, iso=400)
scene = rc.Scene.load("scene.glb").with_environment(2000)
rc.render(scene, camera, spp=64).save("photograph.png")
"""

from typing import TYPE_CHECKING, Any

try:
    from . import _core as _core
except ImportError as error:
    from .import_advice import advised

    raise advised(error) from None
from ._core import (
    PSF,
    AimedRays,
    ArgumentError,
    Camera,
    CameraKey,
    CameraRays,
    Cancelled,
    Coating,
    CoatingLayer,
    CoatingResponse,
    Device,
    DeviceArray,
    DeviceError,
    EffectInfo,
    FieldOfView,
    Film,
    FilmPupil,
    FirstOrder,
    Ghost,
    Glass,
    ImageFileError,
    InputError,
    Lens,
    LensFileError,
    LiveFrame,
    Material,
    Meridian,
    NothingToPlan,
    Plan,
    PlanDecision,
    ProjectionStatus,
    RayBundle,
    RayChunks,
    RayStatus,
    RealcamError,
    RenderSettings,
    RenderStats,
    Scene,
    SceneFileError,
    Seidel,
    Sensor,
    Shake,
    Spot,
    Surface,
    TraceResult,
    Wavefront,
    __version__,
    devices,
    effects,
    glass_names,
    lens_names,
    sensor_names,
)
from .accuracy import AccuracyCost, accuracy_cost
from .autofocus import Autofocus, autofocus
from .cuda_plugin import path_of_plugin as _path_of_plugin
from .derivatives import Gradient, RayDerivatives, RayGradient, backpropagate_rays, ray_derivatives
from .drawing import CrossSection, cross_section
from .film_part import FilmPart
from .flow import OpticalFlow, optical_flow
from .glass_search import GlassMatch, GlassSearch, nearest_glasses, with_better_glasses
from .image import Image
from .image_file import read_environment
from .image_simulation import ImageSimulation, image_simulation
from .job import Job, JobStatus
from .lens import Mirror, Stop
from .live_view import LiveView
from .operands import Operand
from .optimisation import Optimisation, Targets, optimised
from .photography import DepthOfField, PhotographicFigures, depth_of_field, photographic_figures
from .planning import plan
from .raw_image import RawImage
from .render import render
from .rig import Rig, RigCamera
from .session import ReachedNoise, Session
from .shot import Shot, photograph
from .tolerance import (
    CopyFigures,
    ElementShift,
    Sensitivity,
    Tolerance,
    Tolerances,
    ToleranceStudy,
    random_copy,
    tolerance_study,
)
from .variable import Variable
from .vision import CameraModelFit, camera_json, fit_camera_model, save_camera_json, save_colmap

if TYPE_CHECKING:
    from . import analysis

_core._name_cuda_plugin(_path_of_plugin())

__all__ = [
    "PSF",
    "AccuracyCost",
    "AimedRays",
    "ArgumentError",
    "Autofocus",
    "Camera",
    "CameraKey",
    "CameraModelFit",
    "CameraRays",
    "Cancelled",
    "Coating",
    "CoatingLayer",
    "CoatingResponse",
    "CopyFigures",
    "CrossSection",
    "DepthOfField",
    "Device",
    "DeviceArray",
    "DeviceError",
    "EffectInfo",
    "ElementShift",
    "FieldOfView",
    "Film",
    "FilmPart",
    "FilmPupil",
    "FirstOrder",
    "Ghost",
    "Glass",
    "GlassMatch",
    "GlassSearch",
    "Gradient",
    "Image",
    "ImageFileError",
    "ImageSimulation",
    "InputError",
    "Job",
    "JobStatus",
    "Lens",
    "LensFileError",
    "LiveFrame",
    "LiveView",
    "Material",
    "Meridian",
    "Mirror",
    "NothingToPlan",
    "Operand",
    "OpticalFlow",
    "Optimisation",
    "PhotographicFigures",
    "Plan",
    "PlanDecision",
    "ProjectionStatus",
    "RawImage",
    "RayBundle",
    "RayChunks",
    "RayDerivatives",
    "RayGradient",
    "RayStatus",
    "ReachedNoise",
    "RealcamError",
    "RenderSettings",
    "RenderStats",
    "Rig",
    "RigCamera",
    "Scene",
    "SceneFileError",
    "Seidel",
    "Sensitivity",
    "Sensor",
    "Session",
    "Shake",
    "Shot",
    "Spot",
    "Stop",
    "Surface",
    "Targets",
    "Tolerance",
    "ToleranceStudy",
    "Tolerances",
    "TraceResult",
    "Variable",
    "Wavefront",
    "__version__",
    "accuracy_cost",
    "analysis",
    "autofocus",
    "backpropagate_rays",
    "camera_json",
    "cross_section",
    "depth_of_field",
    "devices",
    "effects",
    "fit_camera_model",
    "glass_names",
    "image_simulation",
    "lens_names",
    "nearest_glasses",
    "optical_flow",
    "optimised",
    "photograph",
    "photographic_figures",
    "plan",
    "random_copy",
    "ray_derivatives",
    "read_environment",
    "render",
    "save_camera_json",
    "save_colmap",
    "sensor_names",
    "tolerance_study",
    "with_better_glasses",
]


def __getattr__(name: str) -> Any:
    """Imports rc.analysis on first use: it loads matplotlib, which takes longer than all other imports together."""
    if name == "analysis":
        from importlib import import_module

        return import_module(".analysis", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
