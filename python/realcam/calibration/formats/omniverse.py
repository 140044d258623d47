"""Cameras of NVIDIA Omniverse in USD text: attributes omni:lensdistortion:*. First pixel: 0.5.

Source: documentation of omni.usd.schema.omni_lens_distortion. The origin is inferred from its example, and the
direction of the f-theta polynomial from its default, 0.00245 radians per pixel. No rendering has confirmed them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..files.document import Document
from ..files.entries import Entries
from ..files.output import number
from ..models.central import CameraModel, camera_matrix
from ..models.opencv_models import fisheye_coefficients, fisheye_model, opencv_coefficients, pinhole_model
from ..models.projections import Equidistant, Perspective
from ..models.terms import Inexpressible, Terms, terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer
from .ftheta import angle_limit, backward_model, ftheta_of, pixel_matrix, polynomial
from .texture import lut_contents, lut_model
from .usd_layer import BINARY, layer_prims
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
    if "opticalCenter" in entries:  # is not used, but written again
        entries.numbers("opticalCenter", 2)
    paths = (entries.text("rayEnterDirectionTexture"), entries.text("rayExitPositionTexture"))
    return lut_model(entries.document, *paths, size), size


MODELS: dict[str, Read] = {
    "opencvPinhole": _opencv_pinhole,
    "opencvFisheye": _opencv_fisheye,
    "ftheta": _ftheta,
    "lut": _lut,
}
_MATRIX_KEYS, _NOMINAL_KEYS = ("fx", "fy", "cx", "cy"), ("nominalWidth", "nominalHeight", "opticalCenter")
# Attributes that are written again; all have been read without errors.
KEYS = {
    "opencvPinhole": {*_MATRIX_KEYS, *PINHOLE_KEYS, "imageSize"},
    "opencvFisheye": {*_MATRIX_KEYS, *(f"k{i}" for i in range(1, 5)), "imageSize"},
    "ftheta": {*_NOMINAL_KEYS, *(f"k{i}" for i in range(5)), "maxFov"},
    "lut": {*_NOMINAL_KEYS, "rayEnterDirectionTexture", "rayExitPositionTexture"},
}
# Models whose documentation does not state the focal length that turns their plane into pixels.
WITHOUT_EQUATION = ("kannalaBrandtK3", "radTanThinPrism")


def _camera(document: Document, name: str, values: dict[str, object]) -> StatedCamera:
    prim = Entries(document, values, f"{name}.")
    model = prim.text(f"{PREFIX}model")
    if model in WITHOUT_EQUATION:
        prim.fail(f"{PREFIX}model", f"one of {', '.join(MODELS)}, as no published equation states its focal length")
    prim.choice(f"{PREFIX}model", MODELS)
    prefix = f"{PREFIX}{model}:"
    values_of_model = {key.removeprefix(prefix): value for key, value in values.items() if key.startswith(prefix)}
    camera_model, size = MODELS[model](Entries(document, values_of_model, f"{name}.{prefix}"))
    known = {key: value for key, value in values_of_model.items() if key in KEYS[model]}
    return StatedCamera(camera_model, size, model, name=name, format="omniverse", file_values={"model": model, **known})


def _prims(document: Document) -> dict[str, dict[str, object]]:
    return layer_prims(document) if document.content.startswith(BINARY) else camera_prims(document.text)


def _matches(document: Document) -> bool:
    return document.content.startswith(BINARY) or (document.syntax == "usda" and f"{PREFIX}model" in document.text)


def cameras(document: Document, options: Options) -> Cameras:
    return {
        name: lambda name=name, values=values: _camera(document, name, values)  # type: ignore[misc]
        for name, values in _prims(document).items()
        if f"{PREFIX}model" in values
    }


def _opencv_values(terms: Terms) -> dict[str, Any]:
    fx, fy, cx, cy = terms.pixel_matrix(0.5)
    matrix = {"fx": fx, "fy": fy, "cx": cx, "cy": cy}
    if isinstance(terms.projection, Equidistant):
        terms.within_90_degrees()
        k = fisheye_coefficients(terms)
        coefficients = {f"k{i}": value for i, value in enumerate(k, start=1)}
        return {"model": "opencvFisheye", **matrix, **coefficients, "imageSize": terms.size}
    terms.projected_by(Perspective)
    D = opencv_coefficients(terms, (12,))
    return {"model": "opencvPinhole", **matrix, **dict(zip(PINHOLE_KEYS, D, strict=True)), "imageSize": terms.size}


def _ftheta_values(terms: Terms) -> dict[str, Any]:
    ftheta = ftheta_of(terms)
    if ftheta.direction != "PIXELDIST_TO_ANGLE" or ftheta.cde != (1, 0, 0) or any(ftheta.coefficients[5:]):
        raise Inexpressible("has only k0 to k4 of f-theta, from pixels to angles, for square pixels")
    coefficients = [*ftheta.coefficients, *[0.0] * 5][:5]
    size = {"nominalWidth": float(terms.size[0]), "nominalHeight": float(terms.size[1])}
    return {
        "model": "ftheta",
        **size,
        "opticalCenter": ftheta.centre,
        "maxFov": 2 * float(np.degrees(ftheta.largest_angle)),
        **{f"k{i}": value for i, value in enumerate(coefficients)},
    }


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    """Returns the attributes of the model; a model without attributes of its own becomes textures."""
    for values_of in (_opencv_values, _ftheta_values):
        try:
            return values_of(terms_of(camera))
        except Inexpressible:
            continue
    width, height = map(float, camera.size)
    size = {"nominalWidth": width, "nominalHeight": height, "opticalCenter": (width / 2, height / 2)}
    return {"model": "lut", **size, **dict.fromkeys(TEXTURES, "")}


TEXTURES = {"rayEnterDirectionTexture": "ray_enter_direction", "rayExitPositionTexture": "ray_exit_position"}
SCHEMAS = {
    "opencvPinhole": "OmniLensDistortionOpenCvPinholeAPI",
    "opencvFisheye": "OmniLensDistortionOpenCvFisheyeAPI",
    "ftheta": "OmniLensDistortionFthetaAPI",
    "lut": "OmniLensDistortionLutAPI",
}
TYPES = {"imageSize": "int2", "opticalCenter": "float2", **dict.fromkeys(TEXTURES, "asset")}
APERTURE_MM = 20.955  # USD's default of horizontalAperture


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    files: dict[Path, bytes] = {}
    names = _prim_names([saved.name for saved in cameras])
    prims = []
    for name, (_, values, camera) in zip(names, cameras, strict=True):
        attributes = dict(values)
        if values["model"] == "lut":
            for (key, texture), content in zip(TEXTURES.items(), lut_contents(camera), strict=True):
                attributes[key] = f"./{path.stem}_{name}_{texture}.exr"
                files[path.with_name(attributes[key][2:])] = content
        prims.append(_prim(name, attributes, camera))
    head = f'#usda 1.0\n(\n    defaultPrim = "{names[0]}"\n    metersPerUnit = 1\n    upAxis = "Y"\n)\n'
    return {path: (head + "".join(prims)).encode(), **files}


def _prim_names(names: Sequence[str]) -> list[str]:
    """Returns identifiers of USD, which are unique."""
    found: list[str] = []
    for name in names:
        word = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name) or "Camera"
        word = word if not word[0].isdigit() else f"Camera_{word}"
        candidates = (word, *(f"{word}_{i}" for i in range(len(found) + 1)))
        found.append(next(candidate for candidate in candidates if candidate not in found))
    return found


def _prim(name: str, values: Mapping[str, Any], camera: StatedCamera) -> str:
    model = str(values["model"])
    width, height = camera.size
    K = camera.camera_model.camera_matrix
    aperture = camera.film_mm[0] if camera.film_mm else APERTURE_MM
    lines = [
        f"float focalLength = {number(K[0, 0] / width * aperture)}",
        f"float horizontalAperture = {number(aperture)}",
        f"float verticalAperture = {number(aperture * height / width)}",
        f'token {PREFIX}model = "{model}"',
    ]
    for key, value in values.items():
        if key != "model":
            lines.append(f"{TYPES.get(key, 'float')} {PREFIX}{model}:{key} = {_value(key, value)}")
    if model == "lut":
        lines += _older_attributes(values, camera)
    body = "".join(f"    {line}\n" for line in lines)
    return f'\ndef Camera "{name}" (\n    prepend apiSchemas = ["{SCHEMAS[model]}"]\n)\n{{\n{body}}}\n'


def _older_attributes(values: Mapping[str, Any], camera: StatedCamera) -> list[str]:
    """Returns the attributes of the generalised projection, which releases without the schema of textures read."""
    width, height = camera.size
    enter, exit_ = (values[key] for key in TEXTURES)
    return [
        'token cameraProjectionType = "generalizedProjection"',
        f"float fthetaWidth = {width}",
        f"float fthetaHeight = {height}",
        f"float fthetaCx = {width / 2}",
        f"float fthetaCy = {height / 2}",
        f"asset generalizedProjectionDirectionTexturePath = @{enter}@",
        f"asset generalizedProjectionNDCTexturePath = @{exit_}@",
    ]


def _value(key: str, value: Any) -> str:
    """Returns a value as USD text; those of a file that was read are texts already."""
    if TYPES.get(key) == "asset":
        return f"@{value}@"
    if isinstance(value, str):
        words = value.replace(",", " ").split()
    else:
        words = [number(v) for v in value] if isinstance(value, tuple | list) else [number(value)]
    return f"({', '.join(words)})" if key in TYPES else words[0]


FORMAT: Format = Format(
    "omniverse",
    _matches,
    cameras,
    Writer(("*.usda",), _values, _content),
)
