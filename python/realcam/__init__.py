"""realcam photographs 3D scenes through real lenses, ray by ray.

import realcam as rc

lens = rc.Lens.load("double-gauss-50mm").focused(1.2).stopped_down(2.8)
camera = rc.Camera(lens, position=(0, 0.3, 1.2), look_at=(0, 0.1, 0), exposure_time_s=1 / 60, iso=400)
scene = rc.Scene.load("scene.glb").with_environment(2000)
rc.render(scene, camera, spp=64).save("photograph.png")
"""

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any

from .installation import advised as _advised
from .installation import cuda_plugin as _cuda_plugin

try:
    from . import _core as _core
except ImportError as error:
    raise _advised(error) from None
from ._core import PSF as PSF
from ._core import AimedRays as AimedRays
from ._core import ArgumentError as ArgumentError
from ._core import Camera as Camera
from ._core import CameraKey as CameraKey
from ._core import CameraRays as CameraRays
from ._core import Cancelled as Cancelled
from ._core import Coating as Coating
from ._core import CoatingLayer as CoatingLayer
from ._core import CoatingResponse as CoatingResponse
from ._core import Device as Device
from ._core import DeviceArray as DeviceArray
from ._core import DeviceError as DeviceError
from ._core import EffectInfo as EffectInfo
from ._core import FieldOfView as FieldOfView
from ._core import Film as Film
from ._core import FilmPupil as FilmPupil
from ._core import FirstOrder as FirstOrder
from ._core import Ghost as Ghost
from ._core import Glass as Glass
from ._core import ImageFileError as ImageFileError
from ._core import InputError as InputError
from ._core import Lens as Lens
from ._core import LensFileError as LensFileError
from ._core import LiveFrame as LiveFrame
from ._core import Material as Material
from ._core import Meridian as Meridian
from ._core import NothingToPlan as NothingToPlan
from ._core import Plan as Plan
from ._core import PlanDecision as PlanDecision
from ._core import ProjectionStatus as ProjectionStatus
from ._core import RayBundle as RayBundle
from ._core import RayChunks as RayChunks
from ._core import RayStatus as RayStatus
from ._core import RealcamError as RealcamError
from ._core import RenderSettings as RenderSettings
from ._core import RenderStats as RenderStats
from ._core import Scene as Scene
from ._core import SceneFileError as SceneFileError
from ._core import Seidel as Seidel
from ._core import Sensor as Sensor
from ._core import Shake as Shake
from ._core import Spot as Spot
from ._core import Surface as Surface
from ._core import TraceResult as TraceResult
from ._core import Wavefront as Wavefront
from ._core import __version__ as __version__
from ._core import devices as devices
from ._core import effects as effects
from ._core import glass_names as glass_names
from ._core import lens_names as lens_names
from ._core import sensor_names as sensor_names
from .autofocus import Autofocus as Autofocus
from .autofocus import autofocus as autofocus
from .film_part import FilmPart as FilmPart
from .image import Image as Image
from .image_file import read_environment as read_environment
from .lens import Mirror as Mirror
from .lens import Stop as Stop
from .live_view import LiveView as LiveView
from .ocio import OcioView as OcioView
from .planning import plan as plan
from .raw_image import RawImage as RawImage
from .render import render as render
from .session import ReachedNoise as ReachedNoise
from .session import Session as Session
from .shot import Shot as Shot
from .shot import photograph as photograph

if TYPE_CHECKING:
    from . import analysis as analysis
    from .accuracy import AccuracyCost as AccuracyCost
    from .accuracy import accuracy_cost as accuracy_cost
    from .analysis.image_simulation import ImageSimulation as ImageSimulation
    from .analysis.image_simulation import image_simulation as image_simulation
    from .calibration import Calibration as Calibration
    from .calibration import CalibrationFileError as CalibrationFileError
    from .calibration import GeometryError as GeometryError
    from .calibration import PointStatus as PointStatus
    from .calibration import Vignetting as Vignetting
    from .derivatives import Gradient as Gradient
    from .derivatives import RayDerivatives as RayDerivatives
    from .derivatives import RayGradient as RayGradient
    from .derivatives import Variable as Variable
    from .derivatives import backpropagate_rays as backpropagate_rays
    from .derivatives import ray_derivatives as ray_derivatives
    from .derivatives.camera_parameters import CameraParameters as CameraParameters
    from .derivatives.picture import render_gradient as render_gradient
    from .derivatives.picture_fit import PictureFit as PictureFit
    from .derivatives.picture_fit import fit_pictures as fit_pictures
    from .derivatives.torch_picture import torch_render as torch_render
    from .job import Job as Job
    from .job import JobStatus as JobStatus
    from .optimisation import GlassMatch as GlassMatch
    from .optimisation import GlassSearch as GlassSearch
    from .optimisation import Operand as Operand
    from .optimisation import Optimisation as Optimisation
    from .optimisation import Targets as Targets
    from .optimisation import nearest_glasses as nearest_glasses
    from .optimisation import optimised as optimised
    from .optimisation import with_better_glasses as with_better_glasses
    from .photography import DepthOfField as DepthOfField
    from .photography import PhotographicFigures as PhotographicFigures
    from .photography import depth_of_field as depth_of_field
    from .photography import photographic_figures as photographic_figures
    from .ray_pairs import RayPairLens as RayPairLens
    from .section import CrossSection as CrossSection
    from .section import cross_section as cross_section
    from .tolerance import CopyFigures as CopyFigures
    from .tolerance import ElementShift as ElementShift
    from .tolerance import Sensitivity as Sensitivity
    from .tolerance import Tolerance as Tolerance
    from .tolerance import Tolerances as Tolerances
    from .tolerance import ToleranceStudy as ToleranceStudy
    from .tolerance import random_copy as random_copy
    from .tolerance import tolerance_study as tolerance_study
    from .vision import CameraModelFit as CameraModelFit
    from .vision import OpticalFlow as OpticalFlow
    from .vision import Rig as Rig
    from .vision import RigCamera as RigCamera
    from .vision import fit_camera_model as fit_camera_model
    from .vision import optical_flow as optical_flow
    from .vision import save_colmap as save_colmap
    from .vision.camera_json import camera_json as camera_json
    from .vision.camera_json import save_camera_json as save_camera_json

# Public names by the package of tools that defines them. The packages are imported on first use, because importing them
# and their libraries takes longer than the core.
_TOOLS = {
    "accuracy": "AccuracyCost accuracy_cost",
    "analysis": "analysis",
    "analysis.image_simulation": "ImageSimulation image_simulation",  # loads scipy
    "calibration": "Calibration CalibrationFileError GeometryError PointStatus Vignetting",
    "derivatives": "Gradient RayDerivatives RayGradient Variable backpropagate_rays ray_derivatives",
    "derivatives.camera_parameters": "CameraParameters",  # loads scipy
    "derivatives.picture": "render_gradient",
    "derivatives.picture_fit": "PictureFit fit_pictures",
    "derivatives.torch_picture": "torch_render",
    "job": "Job JobStatus",
    "optimisation": "GlassMatch GlassSearch Operand Optimisation Targets nearest_glasses optimised with_better_glasses",
    "photography": "DepthOfField PhotographicFigures depth_of_field photographic_figures",
    "ray_pairs": "RayPairLens",
    "section": "CrossSection cross_section",
    "tolerance": "CopyFigures ElementShift Sensitivity Tolerance ToleranceStudy Tolerances random_copy tolerance_study",
    "vision": "CameraModelFit OpticalFlow Rig RigCamera fit_camera_model optical_flow save_colmap",
    "vision.camera_json": "camera_json save_camera_json",
}
_PACKAGE_OF = {name: package for package, names in _TOOLS.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    """Imports the package of tools that has this name."""
    if name not in _PACKAGE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    package = import_module(f".{_PACKAGE_OF[name]}", __name__)
    value = globals()[name] = package if name == _PACKAGE_OF[name] else getattr(package, name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_PACKAGE_OF})


class _ToolMethod:
    """A method of a class of the extension. Its first use imports the package of tools that defines it.

    type_, name: class and name of the method. package, function: where it is defined.
    """

    def __init__(self, type_: type, name: str, package: str, function: str) -> None:
        self.type, self.name, self.package, self.function = type_, name, package, function

    def __get__(self, instance: object, owner: type) -> Callable[..., Any]:
        setattr(self.type, self.name, getattr(import_module(f".{self.package}", __name__), self.function))
        method: Callable[..., Any] = getattr(owner if instance is None else instance, self.name)
        return method


# _core.pyi declares the public names.
for _type, _name, _package, _function in (
    (Lens, "draw", "drawing", "draw"),
    (Lens, "_repr_png_", "drawing.lens_drawings", "lens_png"),
    (Lens, "gradient", "derivatives", "gradient"),
    (Lens, "save_rays", "ray_pairs", "save_rays"),
    (Lens, "calibration", "vision.lens_calibration", "calibration"),
    (PSF, "_repr_png_", "analysis.point_spread", "psf_png"),
):
    setattr(_type, _name, _ToolMethod(_type, _name, _package, _function))

_core._name_cuda_plugin(_cuda_plugin())

__all__ = [
    "__version__",
    *(n for n, value in globals().items() if n[0] != "_" and getattr(value, "__module__", "").startswith(__name__)),
    *_PACKAGE_OF,
]
