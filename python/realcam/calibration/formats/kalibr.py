"""Camera chains of Kalibr (camchain-*.yaml). First pixel: 0.

Sources: Kalibr's wiki, "Supported models"; C. Mei and P. Rives, ICRA 2007; V. Usenko et al., arXiv 1807.08957.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import yaml_content
from ..models.central import CentralModel, camera_matrix
from ..models.distortion import BrownConrady
from ..models.opencv_models import distortion_of, fisheye_coefficients, fisheye_distortion
from ..models.projections import (
    DoubleSphere,
    Equidistant,
    ExtendedUnified,
    FieldOfViewAngle,
    Perspective,
    Projection,
    UnifiedSphere,
)
from ..models.terms import Inexpressible, Terms, is_undistorted, terms_of
from ..rig import transforms_from_previous
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer

# Projections by camera_model, and the number of intrinsics in front of fu, fv, pu, pv.
PROJECTIONS: dict[str, tuple[Callable[..., Projection], int]] = {
    "pinhole": (Perspective, 0),
    "omni": (UnifiedSphere, 1),
    "ds": (DoubleSphere, 2),
    "eucm": (ExtendedUnified, 2),
}
# Distortions by distortion_model, and the number of their coefficients.
DISTORTIONS: dict[str, tuple[Callable[[list[float]], BrownConrady], int]] = {
    "radtan": (distortion_of, 4),
    "none": (lambda _: BrownConrady(), 0),
}
EQUIDISTANT = ("equidistant", "equi")


def _model(entries: Entries) -> CentralModel:
    make, leading = PROJECTIONS[entries.choice("camera_model", PROJECTIONS)]
    *parameters, fu, fv, pu, pv = entries.numbers("intrinsics", leading + 4)
    if fu <= 0 or fv <= 0:
        entries.fail("intrinsics", "positive focal lengths")
    matrix = camera_matrix(fu, fv, pu + 0.5, pv + 0.5)
    projection, distortion = _with_distortion(entries, make(*parameters))
    return CentralModel(projection, distortion, matrix)


def _with_distortion(entries: Entries, projection: Projection) -> tuple[Projection, BrownConrady]:
    is_pinhole = isinstance(projection, Perspective)
    known = [*DISTORTIONS, *(EQUIDISTANT if is_pinhole else ()), *(("fov",) if is_pinhole else ())]
    model = entries.choice("distortion_model", known)
    if model in EQUIDISTANT:
        return Equidistant(), fisheye_distortion(entries.numbers("distortion_coeffs", 4))
    if model == "fov":
        return FieldOfViewAngle(entries.numbers("distortion_coeffs", 1)[0]), BrownConrady()
    make, count = DISTORTIONS[model]
    coefficients = entries.numbers("distortion_coeffs", count) if count or "distortion_coeffs" in entries else []
    return projection, make(coefficients)


EXTRINSICS = {"T_cn_cnm1": "camera_from_previous", "T_cam_imu": "camera_from_imu"}


def _transforms(entries: Entries) -> dict[str, Array]:
    found = {name: entries.matrix(key, 4, 4) for key, name in EXTRINSICS.items() if key in entries}
    for key, name in EXTRINSICS.items():
        if name in found and not np.array_equal(found[name][3], [0, 0, 0, 1]):
            entries.fail(key, "a rigid transform with the last row 0 0 0 1")
    return found


def _camera(entries: Entries, name: str) -> StatedCamera:
    return StatedCamera(
        _model(entries),
        entries.size("resolution"),
        f"{entries.text('camera_model')}-{entries.text('distortion_model')}",
        name=name,
        format="kalibr",
        pixel_origin=0.0,
        extrinsics=_transforms(entries),
        file_values=dict(entries.values),
    )


def _chain(document: Document) -> dict[str, dict[str, object]]:
    return {str(k): v for k, v in document.mapping().items() if isinstance(v, dict) and "camera_model" in v}


def cameras(document: Document, options: Options) -> Cameras:
    return {
        name: lambda name=name, values=values: _camera(Entries(document, values, f"{name}."), name)  # type: ignore[misc]
        for name, values in _chain(document).items()
    }


def _radtan(terms: Terms) -> tuple[str, list[float]]:
    """Returns the distortion model and its coefficients."""
    if is_undistorted(terms):
        return "none", []
    terms.without("bottom", "prism", "tilt", "is_sequential")
    return "radtan", [*terms.even(terms.top, 2), *terms.tangential]


def _stated(terms: Terms) -> tuple[str, list[float], str, list[float]]:
    """Returns camera model, its parameters, distortion model and its coefficients."""
    projection = terms.projection
    if isinstance(projection, Equidistant):
        terms.within_90_degrees()
        return "pinhole", [], "equidistant", fisheye_coefficients(terms)
    if isinstance(projection, FieldOfViewAngle) and is_undistorted(terms):
        return "pinhole", [], "fov", [projection.omega]
    parameters = {
        Perspective: ("pinhole", ()),
        UnifiedSphere: ("omni", ("xi",)),
        DoubleSphere: ("ds", ("xi", "alpha")),
        ExtendedUnified: ("eucm", ("alpha", "beta")),
    }
    if type(projection) not in parameters:
        raise Inexpressible(f"has no model of the kind {type(projection).__name__}")
    model, names = parameters[type(projection)]
    return model, [getattr(projection, name) for name in names], *_radtan(terms)


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    model, parameters, distortion, coefficients = _stated(terms)
    return {
        "camera_model": model,
        "intrinsics": [*parameters, *terms.pixel_matrix(0.0)],
        "distortion_model": distortion,
        "distortion_coeffs": coefficients,
        "resolution": list(camera.size),
    }


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    names = [saved.name for saved in cameras]
    if not all(name.startswith("cam") and name[3:].isdigit() for name in names):
        names = [f"cam{index}" for index in range(len(cameras))]
    steps = [None, *transforms_from_previous([saved.camera for saved in cameras])] if cameras[1:] else [None]
    chain: dict[str, Any] = {}
    for name, saved, step in zip(names, cameras, steps, strict=True):
        poses: dict[str, Any] = {} if step is None else {"T_cn_cnm1": step}
        if "camera_from_imu" in saved.camera.extrinsics:
            poses["T_cam_imu"] = saved.camera.extrinsics["camera_from_imu"]
        own = {key: value for key, value in saved.values.items() if key not in EXTRINSICS}
        chain[name] = {**poses, **own}
    return {path: yaml_content(chain)}


FORMAT: Format = Format(
    "kalibr",
    lambda d: any("intrinsics" in camera for camera in _chain(d).values()),
    cameras,
    Writer(("*camchain*.yaml", "*.yaml"), _values, _content),
)
