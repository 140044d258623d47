"""Camera files of CamOdoCal, VINS and KITTI-360. First pixel: 0.

Sources: CamOdoCal's camera_models; C. Mei and P. Rives, ICRA 2007. gamma is not a focal length: near the axis,
f = gamma / (1 + xi).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..files.document import Document
from ..files.entries import Entries
from ..files.output import yaml_content
from ..models.central import CentralModel, camera_matrix
from ..models.opencv_models import fisheye_coefficients, fisheye_model, omnidirectional_model, pinhole_model
from ..models.projections import Equidistant, Perspective, UnifiedSphere
from ..models.terms import Inexpressible, Terms, terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, sole


def _matrix(entries: Entries, fx: str, fy: str, cx: str, cy: str) -> np.ndarray:
    values = entries.child("projection_parameters")
    return camera_matrix(values.positive(fx), values.positive(fy), values.number(cx) + 0.5, values.number(cy) + 0.5)


def _distortion(entries: Entries) -> list[float]:
    values = entries.child("distortion_parameters")
    return [values.number(key) for key in ("k1", "k2", "p1", "p2")]


def _mei(entries: Entries) -> CentralModel:
    xi = entries.child("mirror_parameters").number("xi")
    if xi < 0:
        entries.child("mirror_parameters").fail("xi", "a number that is not negative")
    return omnidirectional_model(_matrix(entries, "gamma1", "gamma2", "u0", "v0"), xi, _distortion(entries))


def _pinhole(entries: Entries) -> CentralModel:
    return pinhole_model(_matrix(entries, "fx", "fy", "cx", "cy"), _distortion(entries))


def _kannala_brandt(entries: Entries) -> CentralModel:
    values = entries.child("projection_parameters")
    k = [values.number(key) for key in ("k2", "k3", "k4", "k5")]
    return fisheye_model(_matrix(entries, "mu", "mv", "u0", "v0"), k, np.pi)


MODELS: dict[str, Callable[[Entries], CentralModel]] = {
    "MEI": _mei,
    "PINHOLE": _pinhole,
    "KANNALA_BRANDT": _kannala_brandt,
}


def _camera(entries: Entries) -> StatedCamera:
    model = entries.choice("model_type", MODELS)
    name = entries.values.get("camera_name")
    return StatedCamera(
        MODELS[model](entries),
        entries.size("image_width", "image_height"),
        model,
        name=name if isinstance(name, str) else "",
        format="camodocal",
        pixel_origin=0.0,
        file_values=dict(entries.values),
    )


def cameras(document: Document, options: Options) -> Cameras:
    return sole(lambda: _camera(Entries(document, document.mapping())))


def _radtan(terms: Terms) -> dict[str, float]:
    terms.without("bottom", "prism", "tilt", "is_sequential")
    return dict(zip(("k1", "k2", "p1", "p2"), [*terms.even(terms.top, 2), *terms.tangential], strict=True))


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    values: dict[str, Any] = {
        "camera_name": camera.name or "camera",
        "image_width": camera.size[0],
        "image_height": camera.size[1],
    }
    matrix = terms.pixel_matrix(0.0)
    if isinstance(terms.projection, Equidistant):
        k = fisheye_coefficients(terms)
        keys = ("k2", "k3", "k4", "k5", "mu", "mv", "u0", "v0")
        named = dict(zip(keys, [*k, *matrix], strict=True))
        return {"model_type": "KANNALA_BRANDT", **values, "projection_parameters": named}
    if isinstance(terms.projection, Perspective):
        named = dict(zip(("fx", "fy", "cx", "cy"), matrix, strict=True))
        distortion = _radtan(terms)
        return {
            "model_type": "PINHOLE",
            **values,
            "distortion_parameters": distortion,
            "projection_parameters": named,
        }
    if isinstance(terms.projection, UnifiedSphere):
        named = dict(zip(("gamma1", "gamma2", "u0", "v0"), matrix, strict=True))
        return {
            "model_type": "MEI",
            **values,
            "mirror_parameters": {"xi": terms.projection.xi},
            "distortion_parameters": _radtan(terms),
            "projection_parameters": named,
        }
    raise Inexpressible(f"has no model of the kind {type(terms.projection).__name__}")


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    return {path: yaml_content(cameras[0].values, "%YAML:1.0\n---\n")}


FORMAT: Format = Format(
    "camodocal",
    lambda d: "model_type" in d.mapping(),
    cameras,
    Writer(("*.yaml", "*.yml"), _values, _content, is_single=True),
)
