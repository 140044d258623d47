"""A camera as a calibration file states it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .arrays import Array, picture_size
from .models.central import CameraModel


@dataclass(frozen=True, eq=False, repr=False)
class StatedCamera:
    """Camera as stated in a file: the result of the readers of all formats.

    camera_model: the equations, in realcam's pixels. size: (width, height) in pixels. model: name of the model in its
    file format. name: of the camera in its file. format: of the file; empty for a camera that was not loaded.
    pixel_origin: coordinate of the centre of the first pixel in the file's own convention. extrinsics: (4, 4) rigid
    transforms, metres, under names such as "camera_from_imu". file_values: parameters as the file states them; empty
    for a camera that was not loaded, or that was changed afterwards. film_mm: (width, height) of the film, if known.
    poses: (4, 4) transforms from camera axes to the world's, in the file's unit of length, by the names of pictures.
    """

    camera_model: CameraModel
    size: tuple[int, int]
    model: str
    name: str = ""
    format: str = ""
    pixel_origin: float = 0.5
    extrinsics: Mapping[str, Array] = field(default_factory=dict)
    file_values: Mapping[str, Any] = field(default_factory=dict)
    film_mm: tuple[float, float] | None = None
    poses: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", picture_size(self.size))
