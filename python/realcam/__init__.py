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
from .autofocus import Autofocus, autofocus
from .film_part import FilmPart
from .image import Image
from .image_file import read_environment
from .lens import Mirror, Stop
from .live_view import LiveView
from .ocio import OcioView
from .planning import plan
from .raw_image import RawImage
from .render import render
from .session import ReachedNoise, Session
from .shot import Shot, photograph

if TYPE_CHECKING:
    from . import analysis
    from .accuracy import AccuracyCost, accuracy_cost
    from .analysis.image_simulation import ImageSimulation, image_simulation
    from .calibration import Calibration, CalibrationFileError, GeometryError, PointStatus, Vignetting
    from .derivatives import (
        Gradient,
        RayDerivatives,
        RayGradient,
        Variable,
        backpropagate_rays,
        ray_derivatives,
    )
    from .derivatives.picture import render_gradient
    from .job import Job, JobStatus
    from .optimisation import (
        GlassMatch,
        GlassSearch,
        Operand,
        Optimisation,
        Targets,
        nearest_glasses,
        optimised,
        with_better_glasses,
    )
    from .photography import DepthOfField, PhotographicFigures, depth_of_field, photographic_figures
    from .ray_pairs import RayPairLens
    from .section import CrossSection, cross_section
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
    from .vision import CameraModelFit, OpticalFlow, Rig, RigCamera, fit_camera_model, optical_flow, save_colmap
    from .vision.camera_json import camera_json, save_camera_json

# Public names by the package of tools that defines them. The packages are imported on first use, because importing them
# and their libraries takes longer than the core.
_TOOLS = {
    "accuracy": "AccuracyCost accuracy_cost",
    "analysis": "analysis",
    "analysis.image_simulation": "ImageSimulation image_simulation",  # loads scipy
    "calibration": "Calibration CalibrationFileError GeometryError PointStatus Vignetting",
    "derivatives": "Gradient RayDerivatives RayGradient Variable backpropagate_rays ray_derivatives",
    "derivatives.picture": "render_gradient",
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
    "PSF",
    "AccuracyCost",
    "AimedRays",
    "ArgumentError",
    "Autofocus",
    "Calibration",
    "CalibrationFileError",
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
    "GeometryError",
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
    "OcioView",
    "Operand",
    "OpticalFlow",
    "Optimisation",
    "PhotographicFigures",
    "Plan",
    "PlanDecision",
    "PointStatus",
    "ProjectionStatus",
    "RawImage",
    "RayBundle",
    "RayChunks",
    "RayDerivatives",
    "RayGradient",
    "RayPairLens",
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
    "Vignetting",
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
    "render_gradient",
    "save_camera_json",
    "save_colmap",
    "sensor_names",
    "tolerance_study",
    "with_better_glasses",
]
