"""A camera as its calibration describes it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._core import Camera, InputError, Lens
from . import maps, rectification, resampling
from .arrays import Array, Integers, picture_size, rows_of
from .camera import GeometryError, Vignetting, calibrated_camera, geometry_error
from .formats.format import Options
from .load import load, load_all
from .models import opencv_models
from .models.central import shift
from .save import save
from .stated_camera import StatedCamera
from .status import PointStatus

FIRST_PIXEL_CENTRE = 0.5  # in realcam's pixel coordinates


@dataclass(frozen=True, eq=False, repr=False)
class Calibration(StatedCamera):
    """A calibrated camera: a central model that maps directions to pixels and back.

    Pixels are realcam's: the centre of the first pixel is (0.5, 0.5), and rows increase downwards. Camera axes are
    x right, y down, z forward.
    Attributes: those of StatedCamera.
    """

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        camera: str | None = None,
        format: str | None = None,
        *,
        size: tuple[int, int] | None = None,
        crop_factor: float | None = None,
        camera_matrix: ArrayLike | None = None,
    ) -> Calibration:
        """Loads a calibration file; docs/calibration.md lists the formats.

        camera: name of one of several cameras of the file. format: name of the format; None: found from the content,
        then from the suffix. size: (width, height) in pixels, for formats that do not state it. crop_factor: of the
        camera, for lensfun. camera_matrix: (3, 3) K of the undistorted picture, for ST maps and tables of cv2.remap
        that do not state it. Raises CalibrationFileError, InputError.
        """
        K = None if camera_matrix is None else _camera_matrix(camera_matrix, "camera_matrix")
        return _calibration(load(path, camera, format, _options(size, crop_factor, K)))

    @staticmethod
    def load_all(
        path: str | os.PathLike[str],
        format: str | None = None,
        *,
        size: tuple[int, int] | None = None,
        crop_factor: float | None = None,
    ) -> dict[str, Calibration]:
        """Loads all cameras of a file, by their names and in its order; arguments and errors as for load."""
        stated = load_all(path, format, _options(size, crop_factor, None))
        return {name: _calibration(camera) for name, camera in stated.items()}

    def save(self, path: str | os.PathLike[str], format: str | None = None) -> None:
        """Writes a calibration file, in the pixel convention of its format; docs/calibration.md lists the formats.

        format: name of the format; None: found from the whole name of the file (such as transforms.json), then the
        format that the camera was loaded from if it has the suffix, then the usual format of the suffix. A camera that
        is unchanged since it was loaded keeps its numbers to the last bit. Raises InputError, which names other formats
        if this one cannot hold the model, and ImageFileError if the file cannot be written.
        """
        save({self.name or "camera": self}, path, format)

    @staticmethod
    def save_all(path: str | os.PathLike[str], cameras: Mapping[str, Calibration], format: str | None = None) -> None:
        """Writes several cameras with their relative poses to one file, as load_all reads them.

        cameras: by their names, in the order of the file. The poses follow from `extrinsics`: a transform from a frame
        that all cameras state, or "camera_from_previous" of all but the first. If the format states poses in another
        frame than the cameras, the axes of the first camera take its place. Raises what save raises.
        """
        save(cameras, path, format)

    @staticmethod
    def opencv(K: ArrayLike, D: ArrayLike, size: tuple[int, int]) -> Calibration:
        """Returns the model of cv2.projectPoints with OpenCV's K, in which the first pixel's centre is (0, 0).

        D: 0, 4, 5, 8, 12 or 14 coefficients in OpenCV's order. Raises InputError.
        """
        coefficients = _coefficients(D)
        model = opencv_models.pinhole_model(
            shift(FIRST_PIXEL_CENTRE, FIRST_PIXEL_CENTRE) @ _camera_matrix(K, "K"), coefficients
        )
        return Calibration(model, size, f"opencv{len(coefficients)}", pixel_origin=0.0)

    @staticmethod
    def opencv_fisheye(K: ArrayLike, D: ArrayLike, size: tuple[int, int]) -> Calibration:
        """Returns the model of cv2.fisheye with its K and k1 to k4; directions from 90 degrees on are refused."""
        coefficients = _coefficients(D)
        if len(coefficients) != 4:
            raise InputError(f"the fisheye model has 4 coefficients, not {len(coefficients)}")
        model = opencv_models.fisheye_model(
            shift(FIRST_PIXEL_CENTRE, FIRST_PIXEL_CENTRE) @ _camera_matrix(K, "K"), coefficients
        )
        return Calibration(model, size, "opencv_fisheye", pixel_origin=0.0)

    @staticmethod
    def pinhole(camera_matrix: ArrayLike, size: tuple[int, int]) -> Calibration:
        """Returns a pinhole camera with K in realcam's pixel coordinates."""
        return Calibration(opencv_models.pinhole_model(_camera_matrix(camera_matrix, "camera_matrix")), size, "pinhole")

    def __repr__(self) -> str:
        name = f" {self.name!r:.60}" if self.name else ""
        return (
            f"<realcam.Calibration{name} {self.model}, {self.size[0]} x {self.size[1]} px, "
            f"up to {self.largest_angle_deg:.4g} degrees>"
        )

    @property
    def camera_matrix(self) -> Array:
        """(3, 3) K of the pinhole camera that agrees with the model near the axis, in realcam's pixel coordinates."""
        return self.camera_model.camera_matrix

    @property
    def largest_angle_deg(self) -> float:
        """Angle to the axis up to which every direction has a pixel of its own."""
        return float(np.degrees(self.camera_model.largest_angle))

    def project(self, points: ArrayLike) -> tuple[Array, Integers]:
        """Projects (N, 3) points in camera axes, metres.

        Returns (N, 2) pixels, NaN if refused, and (N,) values of PointStatus. Points beyond a fold of the distortion
        are refused. A fitted model without a fold is used up to one diagonal of the picture beyond its edges.
        """
        pixels, status = self.camera_model.project(rows_of(points, 3, "points"))
        self._mark_outside(pixels, status)
        pixels[status > PointStatus.OUTSIDE_PICTURE] = np.nan
        return pixels, status

    def ray(self, pixels: ArrayLike) -> tuple[Array, Integers]:
        """Returns (N, 3) unit directions in camera axes of (N, 2) pixels, NaN if refused, and (N,) PointStatus."""
        rows = rows_of(pixels, 2, "pixels")
        directions, status = self.camera_model.ray(rows)
        self._mark_outside(rows, status)
        directions[status > PointStatus.OUTSIDE_PICTURE] = np.nan
        return directions, status

    def resized(self, size: tuple[int, int]) -> Calibration:
        """Returns the calibration of the picture scaled to another size."""
        width, height = picture_size(size)
        scale = np.diag([width / self.size[0], height / self.size[1], 1.0])
        return replace(self, camera_model=self.camera_model.transformed(scale), size=(width, height), file_values={})

    def cropped(self, left: int, top: int, width: int, height: int) -> Calibration:
        """Returns the calibration of a part of the picture, whose first pixel is (left, top). Raises InputError."""
        size = picture_size((width, height))
        if left < 0 or top < 0 or left + size[0] > self.size[0] or top + size[1] > self.size[1]:
            raise InputError(f"the part exceeds the picture of {self.size[0]} x {self.size[1]} pixels")
        film = self.film_mm and (self.film_mm[0] * size[0] / self.size[0], self.film_mm[1] * size[1] / self.size[1])
        model = self.camera_model.transformed(shift(-left, -top))
        return replace(self, camera_model=model, size=size, file_values={}, film_mm=film)

    def undistort(
        self,
        image: ArrayLike,
        *,
        camera_matrix: ArrayLike | None = None,
        size: tuple[int, int] | None = None,
        rotation: ArrayLike | None = None,
        interpolation: str = "bilinear",
    ) -> Array:
        """Returns the picture that a pinhole camera would take, (H, W) or (H, W, C) doubles; NaN where there is none.

        image: (H, W) or (H, W, C) of this calibration's size. camera_matrix, size: of the pinhole camera; default:
        this camera's. rotation: (3, 3), from this camera's axes to the pinhole camera's. interpolation: "bilinear" or
        "bicubic". Raises InputError.
        """
        matrix = self.camera_matrix if camera_matrix is None else _camera_matrix(camera_matrix, "camera_matrix")
        target = picture_size(self.size if size is None else size)
        turn = None if rotation is None else rectification.rotation_of(rows_of(rotation, 3, "rotation"), "rotation")
        values = resampling.checked_image(image, self.size)
        return resampling.remapped(values, maps.undistorting_map(self, matrix, target, turn), interpolation)

    def redistort(
        self, image: ArrayLike, *, camera_matrix: ArrayLike | None = None, interpolation: str = "bilinear"
    ) -> Array:
        """Returns the picture that this camera would take, from one of a pinhole camera: the inverse of undistort.

        image: (H, W) or (H, W, C), of any size. camera_matrix: of the pinhole camera; default: this camera's. Pixels
        beside the pinhole camera's picture are NaN. Raises InputError.
        """
        matrix = self.camera_matrix if camera_matrix is None else _camera_matrix(camera_matrix, "camera_matrix")
        values = resampling.checked_image(image)
        return resampling.remapped(values, maps.redistorting_map(self, matrix), interpolation)

    def stereo_rectification(self, other: Calibration, T: ArrayLike) -> rectification.StereoRectification:
        """Returns rotations and projection matrices that align the rows of two pictures.

        T: (4, 4), from this camera's axes to the other's, metres. Raises InputError.
        """
        return rectification.rectified(self.camera_matrix, other.camera_matrix, self.size, rows_of(T, 4, "T"))

    def camera(
        self,
        lens: Lens | str = "auto",
        *,
        film_width_mm: float | None = None,
        f_number: float | None = None,
        focus_m: float | None = None,
        vignetting: Vignetting | None = None,
        scene_from_camera: ArrayLike | None = None,
        **settings: Any,
    ) -> Camera:
        """Returns a realcam.Camera with the calibration's geometry, exact at every distance, and the light of a lens.

        The chief ray of each pixel passes through one centre of projection in the calibrated direction, and the lens's
        bundle moves with it: blur, cat's eyes, aberrations, colours and ghosts stay those of the lens.
        lens: a Lens, the name or file of one, or "auto": the bundled lens whose field resembles the calibration most,
        scaled to its focal length. film_width_mm: None: as the calibration states it; else such that the focal length
        of a given lens stays; else 7.2. f_number, focus_m: None: those of the lens. vignetting: in place of the lens's
        own falloff. scene_from_camera: (4, 4) pose of the centre of projection, metres, axes as in project.
        settings: further arguments of realcam.Camera, such as position and look_at, exposure_time_s, iso, model.
        Raises InputError, also if "auto" finds no lens within 10 degrees everywhere.
        """
        return calibrated_camera(self, lens, film_width_mm, f_number, focus_m, vignetting, scene_from_camera, settings)

    def geometry_error(self, camera: Camera) -> GeometryError:
        """Measures with traced rays how far a camera's geometry is from the calibration. Raises InputError."""
        return geometry_error(self, camera)

    def _mark_outside(self, pixels: Array, status: Integers) -> None:
        """Replaces OK by OUTSIDE_PICTURE beside the picture, or by NO_PROJECTION where the model ends."""
        with np.errstate(invalid="ignore"):
            beyond = np.maximum(-pixels, pixels - np.array(self.size, dtype=float)).max(axis=1)
        is_ok = status == PointStatus.OK
        status[is_ok & (beyond > 0)] = PointStatus.OUTSIDE_PICTURE
        if self.camera_model.is_extrapolated:
            status[is_ok & (beyond > np.hypot(*self.size))] = PointStatus.NO_PROJECTION


def _options(size: tuple[int, int] | None, crop_factor: float | None, camera_matrix: Array | None) -> Options:
    """Raises InputError for an invalid size."""
    return Options(None if size is None else picture_size(size), crop_factor, camera_matrix)


def _calibration(stated: StatedCamera) -> Calibration:
    return Calibration(**{entry.name: getattr(stated, entry.name) for entry in fields(stated)})


def _camera_matrix(values: ArrayLike, name: str) -> Array:
    matrix = rows_of(values, 3, name)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all() or not np.linalg.det(matrix):
        raise InputError(f"{name} must be an invertible matrix of (3, 3) finite numbers")
    if tuple(matrix[2]) != (0, 0, 1):
        raise InputError(f"the last row of {name} must be (0, 0, 1)")
    return matrix


def _coefficients(values: ArrayLike) -> Sequence[float]:
    coefficients = np.asarray(values, dtype=float).ravel()
    if not np.isfinite(coefficients).all():
        raise InputError("distortion coefficients must be finite numbers")
    return [float(value) for value in coefficients]
