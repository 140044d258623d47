"""Cameras of NVIDIA Omniverse in USD text: attributes omni:lensdistortion:*. First pixel: 0.5.

Source: documentation of omni.usd.schema.omni_lens_distortion. The origin is inferred from its example, and the
direction of the f-theta polynomial from its default, 0.00245 radians per pixel. No rendering has confirmed them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..files.document import Document
from ..files.entries import Entries
from ..models.central import CameraModel, camera_matrix
from ..models.opencv_models import fisheye_model, pinhole_model
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options
from .ftheta import angle_limit, backward_model, pixel_matrix, polynomial
from .texture import lut_model
from .usd_text import camera_prims

PREFIX = "omni:lensdistortion:"
PINHOLE_KEYS = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4")
Read = Callable[[Entries], tuple[CameraModel, tuple[int, int]]]


def _matrix(entries: Entries) -> np.ndarray:
    return camera_matrix(entries.positive("fx"), entries.positive("fy"), entries.number("cx"), entries.number("cy"))


def _opencv_pinhole(entries: Entries) -> tuple[CameraModel, tuple[int, int]]:
    D = [entries.number(key, 0.0) for key in PINHOLE_KEYS]
    return pinhole_model(_matrix(entries), D), entries.size("imageSize")


def _opencv_fisheye(entries: Entries) -> tuple[CameraModel, tuple[int, int]]:
    k = [entries.number(f"k{i}", 0.0) for i in range(1, 5)]
    return fisheye_model(_matrix(entries), k), entries.size("imageSize")


def _ftheta(entries: Entries) -> tuple[CameraModel, tuple[int, int]]:
    k = [entries.number(f"k{i}", 0.0) for i in range(5)]
    coefficients = polynomial(Entries(entries.document, {"k0 to k4": k}, entries.where), "k0 to k4")
    limit = angle_limit(np.radians(entries.positive("maxFov")) / 2)
    matrix = pixel_matrix(entries.numbers("opticalCenter", 2), 1.0, 0.0, 0.0)
    return backward_model(coefficients, matrix, limit), entries.size("nominalWidth", "nominalHeight")


def _lut(entries: Entries) -> tuple[CameraModel, tuple[int, int]]:
    size = entries.size("nominalWidth", "nominalHeight")
    paths = (entries.text("rayEnterDirectionTexture"), entries.text("rayExitPositionTexture"))
    return lut_model(entries.document, *paths, size), size


MODELS: dict[str, Read] = {
    "opencvPinhole": _opencv_pinhole,
    "opencvFisheye": _opencv_fisheye,
    "ftheta": _ftheta,
    "lut": _lut,
}
# Models whose equations are published without the focal length that turns their plane into pixels.
WITHOUT_EQUATION = ("kannalaBrandtK3", "radTanThinPrism")


def _camera(document: Document, name: str, values: dict[str, object]) -> StatedCamera:
    prim = Entries(document, values, f"{name}.")
    model = prim.text(f"{PREFIX}model")
    if model in WITHOUT_EQUATION:
        prim.fail(f"{PREFIX}model", f"one of {', '.join(MODELS)}, as no published equation states its focal length")
    prim.choice(f"{PREFIX}model", MODELS)
    prefix = f"{PREFIX}{model}:"
    own = {key.removeprefix(prefix): value for key, value in values.items() if key.startswith(prefix)}
    camera_model, size = MODELS[model](Entries(document, own, f"{name}.{prefix}"))
    return StatedCamera(camera_model, size, model, name=name, format="omniverse", file_values=own)


def cameras(document: Document, options: Options) -> Cameras:
    return {
        name: lambda name=name, values=values: _camera(document, name, values)  # type: ignore[misc]
        for name, values in camera_prims(document.text).items()
        if f"{PREFIX}model" in values
    }


FORMAT = Format("omniverse", lambda d: d.syntax == "usda" and f"{PREFIX}model" in d.text, cameras)
