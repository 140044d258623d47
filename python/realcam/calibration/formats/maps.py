"""Maps of compositing programs and of OpenCV: ST maps (.exr) and tables for cv2.remap (.npz).

An ST map holds, for each pixel of the output, the point of the input to read: s = (column + 0.5) / W and
t = 1 - (row + 0.5) / H. A file of cv2.remap holds columns and rows, the first pixel's centre being (0, 0). The pinhole
camera of the undistorted picture is that of Calibration.camera_matrix. Maps without it need `camera_matrix`.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.exr import exr_attribute, exr_content, exr_values
from ..files.output import numbers
from ..maps import redistorting_map, undistorting_map
from ..models.map_model import MapModel
from ..models.terms import Inexpressible, sees_behind
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, sole

HIDDEN = -1.0  # s and t of a pixel that shows nothing
MATRIX_KEY = "realcam:camera_matrix"
LARGEST_TABLES = 1 << 30  # bytes of a decompressed .npz
KEYS = {False: ("undistort_map_x", "undistort_map_y"), True: ("redistort_map_x", "redistort_map_y")}


class _Kind(NamedTuple):
    """format: its name. is_redistorting: direction of the map."""

    format: str
    is_redistorting: bool


def _map(camera: StatedCamera, is_redistorting: bool) -> Array:
    K = camera.camera_model.camera_matrix
    return redistorting_map(camera, K) if is_redistorting else undistorting_map(camera, K, camera.size)


def _model(document: Document, positions: Array, is_redistorting: bool, K: Array | None) -> MapModel:
    if K is None:
        document.fail("states no pinhole camera; expected camera_matrix=K of the undistorted picture")
    model = MapModel(positions, is_redistorting, K, np.eye(3))
    if model.is_empty:
        document.fail("holds no position inside a picture")
    return model


def _st_cameras(kind: _Kind, document: Document, options: Options) -> Cameras:
    return sole(lambda: _st_camera(kind, document, options))


def _st_camera(kind: _Kind, document: Document, options: Options) -> StatedCamera:
    values = exr_values(document.path, 2, document.fail)
    height, width = values.shape[:2]
    is_hidden = (values == HIDDEN).all(axis=2)
    positions = np.stack([values[:, :, 0] * width, (1 - values[:, :, 1]) * height], axis=2)
    positions[is_hidden] = np.nan
    text = exr_attribute(document.path, MATRIX_KEY)
    K = Entries(document, {MATRIX_KEY: text}).matrix(MATRIX_KEY, 3, 3) if text else None
    K = K if options.camera_matrix is None else options.camera_matrix
    model = _model(document, positions, kind.is_redistorting, K)
    stated = {"map": values, "camera_matrix": model.pinhole_matrix}
    return StatedCamera(model, (width, height), "map", format=kind.format, file_values=stated)


def _camera_matrix(camera: StatedCamera) -> Mapping[str, Any]:
    """Returns the pinhole camera alone: the maps of a camera that was not read from maps are made when it is saved."""
    if sees_behind(camera):
        raise Inexpressible("ends at 90 degrees off the axis, and the picture shows more")
    return {"camera_matrix": camera.camera_model.camera_matrix}


def _st_map(kind: _Kind, camera: StatedCamera) -> Array:
    positions = _map(camera, kind.is_redistorting)
    width, height = camera.size
    values = np.stack([positions[:, :, 0] / width, 1 - positions[:, :, 1] / height], axis=2)
    return np.nan_to_num(values, nan=HIDDEN)


def _st_content(kind: _Kind, cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    ((_, values, camera),) = cameras
    found = values["map"] if "map" in values else _st_map(kind, camera)
    picture = np.concatenate([found, np.zeros_like(found[:, :, :1])], axis=2)
    return {path: exr_content(picture, "RGB", {MATRIX_KEY: numbers(values["camera_matrix"])})}


def _st_format(kind: _Kind, patterns: tuple[str, ...]) -> Format:
    return Format(
        kind.format,
        lambda d: d.suffix == ".exr" and ("redistort" in d.path.name.lower()) == kind.is_redistorting,
        lambda document, options: _st_cameras(kind, document, options),
        Writer(
            patterns,
            # Each format has a function of its own, as formats with the same one share the values of their files.
            lambda camera: _camera_matrix(camera),
            lambda cameras, path: _st_content(kind, cameras, path),
            is_single=True,
        ),
    )


def _tables(document: Document) -> dict[str, Array]:
    """Returns the arrays of an .npz, which is never unpickled."""
    try:
        with zipfile.ZipFile(io.BytesIO(document.content)) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > LARGEST_TABLES or len(archive.infolist()) > 64:
                document.fail("holds more than the tables of a camera")
        with np.load(io.BytesIO(document.content), allow_pickle=False) as loaded:
            return {key: loaded[key] for key in loaded.files}
    except (zipfile.BadZipFile, ValueError, OSError, EOFError, KeyError) as error:
        document.fail(f"is not an .npz file of numbers: {error!s:.80}".replace("\n", " "))


def _remap_camera(document: Document, options: Options) -> StatedCamera:
    tables = _tables(document)
    is_redistorting = KEYS[False][0] not in tables and "map_x" not in tables
    keys = ("map_x", "map_y") if "map_x" in tables else KEYS[is_redistorting]
    x, y = (tables.get(key, np.zeros(0)) for key in keys)
    if x.ndim != 2 or x.shape != y.shape or min(x.shape) < 2 or x.dtype.kind != "f" or y.dtype.kind != "f":
        document.fail(f"{keys[0]}: expected two tables of (H, W) numbers, {keys[0]} and {keys[1]}")
    K = options.camera_matrix
    stated = tables.get("new_camera_matrix", tables.get("camera_matrix"))
    if K is None and stated is not None:
        K = Entries(document, {"camera_matrix": stated.tolist()}).matrix("camera_matrix", 3, 3)
        K[:2, 2] += 0.5
    positions = np.stack([x, y], axis=2).astype(float) + 0.5
    positions[~np.isfinite(positions).all(axis=2)] = np.nan
    size = (x.shape[1], x.shape[0])
    return StatedCamera(
        _model(document, positions, is_redistorting, K),
        size,
        "map",
        format="remap",
        pixel_origin=0.0,
        file_values={key: table for key, table in tables.items() if key != "map_x" and key != "map_y"}
        | ({KEYS[False][0]: x, KEYS[False][1]: y} if "map_x" in tables else {}),
    )


def _remap_tables(camera: StatedCamera) -> Mapping[str, Any]:
    values: dict[str, Any] = {}
    for is_redistorting, keys in KEYS.items():
        positions = (_map(camera, is_redistorting) - 0.5).astype(np.float32)
        values |= {keys[0]: positions[:, :, 0], keys[1]: positions[:, :, 1]}
    K = camera.camera_model.camera_matrix.copy()
    K[:2, 2] -= 0.5
    return {**values, "new_camera_matrix": K, "image_size": np.array(camera.size)}


def _remap_content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    file = io.BytesIO()
    ((_, values, camera),) = cameras
    is_read = any(key in values for keys in KEYS.values() for key in keys)
    np.savez_compressed(file, **(values if is_read else _remap_tables(camera)))
    return {path: file.getvalue()}


UNDISTORT: Format = _st_format(_Kind("stmap", False), ("*stmap*.exr", "*.exr"))
REDISTORT: Format = _st_format(_Kind("stmap-redistort", True), ("*redistort*.exr",))
REMAP: Format = Format(
    "remap",
    lambda d: d.suffix == ".npz",
    lambda document, options: sole(lambda: _remap_camera(document, options)),
    Writer(("*.npz",), _camera_matrix, _remap_content, is_single=True),
)
