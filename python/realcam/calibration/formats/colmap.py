"""Cameras of COLMAP (cameras.txt, cameras.bin), with the poses of the file of images beside it. First pixel: 0.5.

Source: COLMAP's documentation, "Output format". Models of an angle are refused from 90 degrees on, as COLMAP does.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..files.document import Document
from ..files.entries import Entries
from ..files.output import numbers
from ..models.central import CentralModel, camera_matrix
from ..models.terms import terms_of
from ..stated_camera import StatedCamera
from .colmap_images import HEADS, images_content, poses_beside, text_content
from .colmap_models import BY_NAME, MODELS, Model, model_and_parameters
from .format import Cameras, Format, Options, Saved, Writer


def _camera(entries: Entries, model: Model, name: str) -> StatedCamera:
    values = entries.numbers("parameters", model.parameters)
    fx, fy = values[0], values[model.focal_lengths - 1]
    if fx <= 0 or fy <= 0:
        entries.fail("parameters", "positive focal lengths first")
    cx, cy, *coefficients = values[model.focal_lengths :]
    projection, distortion = model.make(coefficients)
    return StatedCamera(
        CentralModel(projection, distortion, camera_matrix(fx, fy, cx, cy)),
        entries.size("width", "height"),
        model.name,
        name=name,
        format="colmap",
        file_values={"model": model.name, "parameters": values},
        poses=poses_beside(entries.document).get(name, {}),
    )


def _text_camera(document: Document, number: int, fields: list[str]) -> StatedCamera:
    if len(fields) < 5:
        document.fail(f"line {number}: expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]")
    if fields[1] not in BY_NAME:
        document.fail(f'line {number}: unknown model "{fields[1]:.40}"; expected one of {", ".join(BY_NAME)}')
    values = {"width": fields[2], "height": fields[3], "parameters": fields[4:]}
    return _camera(Entries(document, values, f"line {number}: "), BY_NAME[fields[1]], fields[0])


def text_cameras(document: Document, options: Options) -> Cameras:
    lines = enumerate(document.text.splitlines(), start=1)
    rows = [(i, line.split()) for i, line in lines if line.strip() and not line.lstrip().startswith("#")]
    return {fields[0]: lambda i=i, fields=fields: _text_camera(document, i, fields) for i, fields in rows}  # type: ignore[misc]


def binary_cameras(document: Document, options: Options) -> Cameras:
    content, found = document.content, {}
    try:
        (count,) = struct.unpack_from("<Q", content)
        position = 8
        for index in range(count):
            camera, model_id, width, height = struct.unpack_from("<iiQQ", content, position)
            if model_id not in MODELS:
                document.fail(f"camera {index}: unknown model id {model_id}; expected 0 to {max(MODELS)}")
            model = MODELS[model_id]
            values = struct.unpack_from(f"<{model.parameters}d", content, position + 24)
            position += 24 + 8 * model.parameters
            named = Entries(document, {"width": width, "height": height, "parameters": values}, f"camera {camera}: ")
            found[str(camera)] = lambda named=named, model=model, camera=camera: _camera(named, model, str(camera))
    except struct.error:
        document.fail(f"ends before its last camera, at byte {len(content)}")
    if position != len(content):
        document.fail(f"expected {position} bytes for its cameras; it has {len(content)}")
    return found


def _is_text(document: Document) -> bool:
    if document.syntax not in ("text", "yaml"):
        return False
    rows = [line.split() for line in document.text.splitlines() if line.strip() and not line.startswith("#")]
    return bool(rows) and len(rows[0]) > 1 and (rows[0][1] in BY_NAME or document.path.name == "cameras.txt")


def _is_binary(document: Document) -> bool:
    """True if the number of cameras and the first model id are plausible."""
    if document.syntax != "binary" or len(document.content) < 32:
        return False
    count, _, model_id = struct.unpack_from("<Qii", document.content)
    return document.path.name == "cameras.bin" or (0 < count < 1 << 24 and 0 <= model_id < 64)


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    model, parameters = model_and_parameters(terms_of(camera))
    return {"model": model.name, "parameters": parameters}


def camera_text(camera: StatedCamera, model: str) -> str:
    """Returns the line of a camera without its id, as a COLMAP model that has no fewer parameters than it needs."""
    values = _values(camera)
    # Models such as OPENCV are FULL_OPENCV without its last coefficients.
    padding = [0.0] * (BY_NAME[model].parameters - len(values["parameters"]))
    return _line({"model": model, "parameters": [*values["parameters"], *padding]}, camera)


def _line(values: Mapping[str, Any], camera: StatedCamera) -> str:
    return f"{values['model']} {camera.size[0]} {camera.size[1]} {numbers(values['parameters'])}"


def camera_ids(cameras: Sequence[Saved]) -> list[int]:
    """Returns the names of the cameras as numbers if all are positive integers, and otherwise 1, 2, ..."""
    names = [saved.name for saved in cameras]
    if all(name.isascii() and name.isdigit() and 0 < int(name) < 1 << 31 for name in names):
        return [int(name) for name in names]
    return list(range(1, len(names) + 1))


def _text_content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    ids = camera_ids(cameras)
    lines = [f"{number} {_line(saved.values, saved.camera)}" for number, saved in zip(ids, cameras, strict=True)]
    return {path: text_content(HEADS["cameras.txt"], lines), **images_content(ids, cameras, path)}


def _binary_content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    ids, parts = camera_ids(cameras), [struct.pack("<Q", len(cameras))]
    for number, (_, values, camera) in zip(ids, cameras, strict=True):
        model_id = next(key for key, model in MODELS.items() if model.name == values["model"])
        parameters = values["parameters"]
        parts.append(struct.pack(f"<iiQQ{len(parameters)}d", number, model_id, *camera.size, *parameters))
    return {path: b"".join(parts), **images_content(ids, cameras, path)}


TEXT: Format = Format("colmap", _is_text, text_cameras, Writer(("cameras.txt", "*.txt"), _values, _text_content))
BINARY: Format = Format(
    "colmap-binary", _is_binary, binary_cameras, Writer(("cameras.bin", "*.bin"), _values, _binary_content)
)
