"""Recipe of a data set, read from a TOML file."""

from __future__ import annotations

import dataclasses
import os
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InputError, Lens, RealcamError, RenderSettings, Sensor, _did_you_mean, _read_toml
from ..calibration import Calibration
from ..files import record_input
from .calibrated import calibrations_in

MOTION_S = 1.0  # duration of all motion in a scene, in seconds; every exposure and next picture must lie within it
LABELS = ("depth", "mask", "motion", "flow")
DEPTHS = ("axis", "ray")
DEFAULT_SIZE = (640, 480)
_LENSES = ("double-gauss-50mm", "tessar-50mm", "sonnar-50mm", "phone-4mm", "fisheye-6mm-220deg")
# Keys that say which cameras there are; the values that other keys may have depend on them.
_CAMERA_KEYS = ("calibration", "calibration_camera", "rig")
_USED_SUFFIXES = ("mask", "next", "flow_visible")  # files of a sample that a camera's name could be taken for
# File names have six digits for the picture's number; beyond the limits of numbers of things a picture takes hours.
_MAX: dict[str, float] = {"count": 10**6, "size": 32768, "objects": 1000, "board": 1000, "shard_size": 10**6}
# The scene is a floor of 18 m x 18 m: beyond these there is nothing to see.
_MAX |= {"square_m": 10, "stereo_m": 100, "speed_m_s": 1000, "camera_speed_m_s": 1000, "f_stops": 1000, "iso": 10**7}


@dataclass(frozen=True)
class Recipe:
    """Parameters of a data set. A pair of numbers is a range that is sampled uniformly, except that of iso.

    count: number of pictures. size: columns and rows of a picture; (): those of the calibration, or 640 and 480. seed:
    the same recipe and seed give the same pictures. lenses: names or files; one is chosen at random for each picture;
    "auto": the bundled lens that resembles the calibration most. (): "auto" with a calibration, otherwise five bundled
    lenses.
    f_stops: range of the factor, 1 or more, by which the lens's f-number is multiplied. objects: range of the number
    of objects in a scene. models: files of the objects (.glb, .obj, ...) by category, scaled so that their largest
    extent is one metre before each object gets its own size; {}: boxes, balls and pyramids.
    speed_m_s: speed of the objects along the floor, in m/s. camera_speed_m_s,
    camera_turn_deg_s: speed in m/s and angular speed in degrees/s of the camera, in a random direction and about a
    random axis. next_after_s: time from a picture to the next one, which is the target of the flow. readout_time_s: of
    a rolling shutter; 0: all rows are exposed at once. iso: range, whose logarithm is sampled uniformly. sensor: name
    or file of the camera's sensor. board: columns and rows of squares of a calibration board in each scene; (): no
    board. square_m: side of its squares, in metres. labels: additional outputs, any of depth, mask, motion and flow;
    flow also writes the next picture. depth: "axis", depth along the axis from the film, or "ray", distance from the
    centre of projection along the pixel's ray. spp: samples per pixel. shard_size: pictures per tar file.
    calibration: file with the calibration of the camera, whose geometry the pictures have. calibration_camera: name of
    one of several cameras in it. rig: file with the calibrations and relative poses of several cameras, which take
    pictures at the same time. film_width_mm: width of the calibrated film; 0: as Calibration.camera chooses it.
    stereo_m: distance in metres to a second camera of the same kind, to the right; 0: no second camera.

    Raises InputError and CalibrationFileError.
    """

    count: int = 200
    size: tuple[int, ...] = ()
    seed: int = 0
    lenses: tuple[str, ...] = ()
    f_stops: tuple[float, float] = (1.0, 3.0)
    objects: tuple[int, int] = (3, 8)
    models: Mapping[str, str] = field(default_factory=dict)
    speed_m_s: tuple[float, float] = (0.0, 0.0)
    camera_speed_m_s: tuple[float, float] = (0.0, 0.0)
    camera_turn_deg_s: tuple[float, float] = (0.0, 0.0)
    next_after_s: float = 0.04
    readout_time_s: float = 0.0
    iso: tuple[float, float] = (100.0, 100.0)
    sensor: str = "ideal"
    board: tuple[int, ...] = ()
    square_m: float = 0.04
    labels: tuple[str, ...] = ("depth", "mask")
    depth: str = "axis"
    spp: int = 24
    shard_size: int = 100
    calibration: str = ""
    calibration_camera: str = ""
    rig: str = ""
    film_width_mm: float = 0.0
    stereo_m: float = 0.0

    def __post_init__(self) -> None:
        for name, kind in _KINDS.items():
            object.__setattr__(self, name, _converted(kind, name, getattr(self, name)))
        RenderSettings(spp=self.spp)  # checks the number of samples
        for name in ("count", "shard_size", "square_m", "next_after_s"):
            if not getattr(self, name) > 0:
                raise InputError(f"{name} must be above 0")
        for name, limit in _MAX.items():
            if max(np.atleast_1d(getattr(self, name)), default=0) > limit:
                raise InputError(f"{name} must be {limit} or less")
        if self.size and len(self.size) != 2:
            raise InputError(f"size must be two whole numbers; it is {self.size!r:.40}")
        if min(self.size, default=1) < 1 or min(self.objects) < 1 or self.seed < 0 or self.readout_time_s < 0:
            raise InputError("size and objects must be 1 or more, seed and readout_time_s 0 or more")
        for name in ("f_stops", "objects", "speed_m_s", "camera_speed_m_s", "camera_turn_deg_s", "iso"):
            low, high = getattr(self, name)
            if not 0 <= low <= high:
                raise InputError(f"{name} must be a range, the smaller number first")
        if max(self.next_after_s, self.readout_time_s) > MOTION_S / 2 or self.camera_turn_deg_s[1] >= 180:
            raise InputError(
                f"next_after_s and readout_time_s must be {MOTION_S / 2} s or less, and camera_turn_deg_s below 180"
            )
        if self.f_stops[0] < 1 or self.iso[0] <= 0:
            raise InputError("f_stops must be 1 or more, and iso above 0")
        if self.board and (len(self.board) != 2 or min(self.board) < 2):
            raise InputError("board must be [columns, rows] of squares, 2 or more each")
        for label in self.labels:
            if label not in LABELS:
                raise InputError(f'labels: "{label:.40}" is unknown; expected {", ".join(LABELS)}')
        if self.depth not in DEPTHS:
            raise InputError(f'depth: "{self.depth:.40}" is unknown; expected {", ".join(DEPTHS)}')
        Sensor.load(self.sensor)
        for lens in self.lenses:
            if lens != "auto":
                Lens.load(lens)
        if not self.lenses:
            object.__setattr__(self, "lenses", ("auto",) if self.calibration or self.rig else _LENSES)
        self._check_cameras()

    def _check_cameras(self) -> None:
        """Checks the keys of calibrations against one another. Raises InputError."""
        if self.film_width_mm < 0 or self.stereo_m < 0:
            raise InputError("film_width_mm and stereo_m must be 0 or more")
        if self.rig and (self.calibration or self.stereo_m):
            raise InputError("rig excludes calibration and stereo_m: its file states all cameras and their poses")
        if self.calibration_camera and not self.calibration:
            raise InputError("calibration_camera belongs to a calibration, and there is none")
        if not self.calibration and not self.rig:
            if self.film_width_mm or "auto" in self.lenses:
                raise InputError('film_width_mm and the lens "auto" are for a calibration or rig, and there is none')
            return
        for name, calibration in self.calibrations.items():
            width, height = calibration.size
            if self.size and abs(self.size[0] * height - self.size[1] * width) > 0.5 * width:
                raise InputError(
                    f"size must have the aspect of the calibration, {width} x {height} pixels; it is "
                    f"{self.size[0]} x {self.size[1]}"
                )
            if self.rig and (not re.fullmatch("[A-Za-z0-9_-]{1,60}", name) or name in _USED_SUFFIXES):
                raise InputError(
                    f'rig: camera "{name:.40}" cannot name files; expected letters, digits, _ and -, and none of '
                    f"{', '.join(_USED_SUFFIXES)}"
                )

    @property
    def calibrations(self) -> Mapping[str, Calibration]:
        """Calibrations of all cameras by name, with the picture sizes of their file; empty without a calibration."""
        if not self.calibration and not self.rig:
            return {}
        return calibrations_in(self.rig or self.calibration, self.calibration_camera, bool(self.rig))

    def picture_size(self, camera: str = "") -> tuple[int, int]:
        """Returns the columns and rows of a camera's pictures. camera: a key of `calibrations`."""
        if self.size:
            return self.size[0], self.size[1]
        return self.calibrations[camera].size if camera in self.calibrations else DEFAULT_SIZE

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Recipe:
        """Reads a recipe. Paths in it are relative to its folder. Raises InputError naming file, line and key."""
        name = os.fspath(path)
        record_input(path)
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{name}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
        values, lines = _read_toml(text, name)
        if values.pop("format", None) != 1:
            raise InputError(f"{name}: expected format = 1, the version of this description")
        for key in values:
            if key not in _KINDS:
                raise InputError(f'{name}:{lines[key]}: unknown key "{key:.40}"{_did_you_mean(key, list(_KINDS))}')
        if values.get("lenses") == []:
            raise InputError(
                f"{name}:{lines['lenses']}: lenses must name at least one lens; default lenses need no key"
            )
        # Absolute, because the processes of an executor may have another current folder.
        folder = Path(path).parent.absolute()
        values = {key: _located(folder, key, value) for key, value in values.items()}
        for file in _paths_in(list(values.values())):
            record_input(file)
        cameras = {key: values[key] for key in _CAMERA_KEYS if key in values}
        checked: dict[str, Any] = {}
        for key, value in (cameras | values).items():
            if key in _CAMERA_KEYS:  # one after the other, so that an error names the line of the one that is wrong
                checked[key] = value
            try:
                cls(**(checked | {key: value}))
            except RealcamError as error:
                raise InputError(f"{name}:{lines[key]}: {error}") from None
        return cls(**values)

    @property
    def categories(self) -> tuple[str, ...]:
        """Categories of the objects, in the order of their COCO ids, which start at 1."""
        return tuple(self.models) or ("box", "ball", "pyramid")


# Annotations of the fields as text, such as "tuple[int, ...]", for _converted.
_KINDS: dict[str, str] = {
    f.name: str(f.type).replace("Mapping[str, str]", "texts by name") for f in dataclasses.fields(Recipe)
}


def _located(folder: Path, key: str, value: Any) -> Any:
    """Returns the value of a key with its paths relative to the recipe's folder; values of other types unchanged."""

    def beside(file: Any) -> Any:
        is_path = isinstance(file, str) and re.search(r"[/.]", file)
        return str(folder / file) if is_path else file

    if key == "lenses" and isinstance(value, list):
        return [beside(file) for file in value]
    if key == "models" and isinstance(value, Mapping):
        return {name: str(folder / file) if isinstance(file, str) else file for name, file in value.items()}
    if key in ("calibration", "rig") and isinstance(value, str) and value:
        return str(folder / value)
    return beside(value) if key == "sensor" else value


def _paths_in(value: Any) -> Iterator[str]:
    """Yields the absolute paths among the texts of a value."""
    if isinstance(value, str) and Path(value).is_absolute():
        yield value
    for item in value.values() if isinstance(value, Mapping) else value if isinstance(value, list) else ():
        yield from _paths_in(item)


def _converted(kind: str, name: str, value: Any) -> Any:
    """Converts a value to the type of its field. Raises InputError."""
    if kind == "texts by name":
        if isinstance(value, Mapping) and all(isinstance(v, str) for pair in value.items() for v in pair):
            return dict(value)
    elif kind.startswith("tuple["):
        element, second = kind[6:-1].split(", ")
        items = [value, value] if second != "..." and isinstance(value, int | float) else value
        if isinstance(items, list | tuple) and (second == "..." or len(items) == 2):
            return tuple(_converted(element, name, item) for item in items)
    elif kind == "float" and isinstance(value, int | float) and not isinstance(value, bool):
        if abs(value) <= sys.float_info.max:
            return float(value)
    elif (kind == "int" and isinstance(value, int) and not isinstance(value, bool)) or (
        kind == "str" and isinstance(value, str)
    ):
        return value
    nouns = {"int": "a whole number", "float": "a number", "str": "a text"}
    expected = (
        nouns.get(kind)
        or {"i": "whole numbers", "f": "numbers", "s": "texts", "t": "texts by name"}[kind.removeprefix("tuple[")[0]]
    )
    count = "two " if kind.startswith("tuple[") and not kind.endswith("...]") else ""
    raise InputError(f"{name} must be {count}{expected}; it is {value!r:.40}")
