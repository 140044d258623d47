"""realcam photographs 3D scenes through real lenses, ray by ray.

import realcam as rc

lens = rc.Lens.load("double-gauss-50mm").focused(1.2).stopped_down(2.8)
camera = rc.Camera(lens, position=(0, 0.3, 1.2), look_at=(0, 0.1, 0), exposure_time_s=1 / 60, iso=400)
scene = rc.Scene.load("scene.glb").with_environment(2000)
rc.render(scene, camera, spp=64).save("photograph.png")
"""

from ._core import (
    Camera,
    CameraRays,
    Cancelled,
    DeviceError,
    Film,
    FirstOrder,
    Glass,
    ImageFileError,
    InputError,
    Lens,
    LensFileError,
    Material,
    RayStatus,
    RealcamError,
    RenderStats,
    Scene,
    SceneFileError,
    Surface,
    TraceResult,
    __version__,
    devices,
    lens_names,
)
from .image import Image
from .lens import Mirror, Stop
from .render import render

__all__ = [
    "Camera",
    "CameraRays",
    "Cancelled",
    "DeviceError",
    "Film",
    "FirstOrder",
    "Glass",
    "Image",
    "ImageFileError",
    "InputError",
    "Lens",
    "LensFileError",
    "Material",
    "Mirror",
    "RayStatus",
    "RealcamError",
    "RenderStats",
    "Scene",
    "SceneFileError",
    "Stop",
    "Surface",
    "TraceResult",
    "__version__",
    "devices",
    "lens_names",
    "render",
]
