"""The pages of the API: every public name of realcam and its modules, with the text of its docstring."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from written import write_text

# Names of `realcam` by what they are for. tests/python/pages/test_site.py holds that none is missing.
GROUPS = {
    "Lenses": (
        "Lens", "Surface", "Stop", "Mirror", "Glass", "Coating", "CoatingLayer", "CoatingResponse", "FirstOrder",
        "Meridian", "Ghost", "lens_names", "glass_names", "CrossSection", "cross_section",
    ),
    "Rays, wavefronts and spots": (
        "AimedRays", "FilmPupil", "PSF", "RayBundle", "RayStatus", "Seidel", "Spot", "TraceResult", "Wavefront",
        "ImageSimulation", "image_simulation",
    ),
    "Changing a lens": (
        "Optimisation", "Targets", "Operand", "Variable", "optimised", "GlassMatch", "GlassSearch", "nearest_glasses",
        "with_better_glasses",
    ),
    "Derivatives": (
        "CameraParameters", "Gradient", "PictureFit", "RayDerivatives", "RayGradient", "backpropagate_rays",
        "fit_pictures", "ray_derivatives", "render_filtered", "render_gradient", "torch_render",
    ),
    "Tolerances": (
        "Tolerances",
        "tolerance_study",
        "ToleranceStudy",
        "Tolerance",
        "Sensitivity",
        "CopyFigures",
        "ElementShift",
        "random_copy",
    ),
    "Photographers' figures": (
        "DepthOfField", "FieldOfView", "PhotographicFigures", "depth_of_field", "photographic_figures",
    ),
    "Camera": ("Camera", "Film", "CameraKey", "Shake", "CameraRays", "RayChunks", "Autofocus", "autofocus"),
    "Scene": ("Scene", "Material", "read_environment"),
    "Pictures": (
        "render", "photograph", "RenderSettings", "RenderStats", "Image", "Shot", "Session", "ReachedNoise", "LiveView",
        "LiveFrame", "OcioView", "Device", "DeviceArray", "devices",
    ),
    "Many machines": ("Job", "JobStatus", "FilmPart"),
    "Effects and accuracy": (
        "effects", "EffectInfo", "plan", "Plan", "PlanDecision", "accuracy_cost", "AccuracyCost",
    ),
    "Sensors": ("Sensor", "RawImage", "sensor_names"),
    "Rigs": ("Rig", "RigCamera"),
    "Calibrations": ("Calibration", "PointStatus", "GeometryError", "Vignetting", "CalibrationFileError"),
    "Lenses of rays": ("RayPairLens",),
    "Vision": (
        "ProjectionStatus", "CameraModelFit", "fit_camera_model", "camera_json", "save_camera_json", "save_colmap",
        "OpticalFlow", "optical_flow",
    ),
    "Errors": (
        "RealcamError", "InputError", "ArgumentError", "LensFileError", "SceneFileError", "ImageFileError",
        "DeviceError", "NothingToPlan", "Cancelled",
    ),
}  # fmt: skip
MODULES = {
    "realcam.analysis": "Aberrations and MTF, as arrays and as plots",
    "realcam.drawing": "Drawings of lenses",
    "realcam.dataset": "Labelled pictures",
}


def summary(title: str, module: str, names: tuple[str, ...]) -> str:
    rows = "\n".join(f"   {module}.{name}" for name in names)
    return f"{title}\n{'-' * len(title)}\n\n.. autosummary::\n   :toctree: .\n   :nosignatures:\n\n{rows}\n"


def write(folder: Path) -> None:
    """Writes the page index.rst; Sphinx writes those of the names beside it."""
    modules = {name: import_module(name) for name in MODULES}
    parts = [
        "Python\n======\n\n"
        "What ``import realcam as rc`` brings. :doc:`The tour </docs/python>` shows how it is used.\n",
        *(summary(title, "realcam", names) for title, names in GROUPS.items()),
        *(
            summary(title, name, tuple(n for n in modules[name].__all__ if callable(getattr(modules[name], n))))
            for name, title in MODULES.items()
        ),
    ]
    text = "\n".join(parts)
    for page in folder.glob("*.rst"):  # of names that are no longer there
        if page.stem != "index" and f"   {page.stem}\n" not in text:
            page.unlink()
    write_text(folder / "index.rst", text)
