"""Calibrations of lenses: the camera model that is fitted to a lens's rays, as rc.Calibration."""

from __future__ import annotations

from dataclasses import dataclass, fields

from .._core import Camera, Film, InputError, Lens
from ..calibration import Calibration
from .fit import CameraModelFit, fit_camera_model

CANDIDATES = ("opencv5", "fisheye")  # of the model None
GOOD_PX = 0.05  # RMS that no calibration with patterns resolves; the first candidate that reaches it is taken


@dataclass(frozen=True, eq=False, repr=False)
class LensCalibration(Calibration):
    """The calibration of a lens, and the fit that it is from.

    fit: of the picture before it was resized or cropped.
    """

    fit: CameraModelFit | None = None

    @property
    def rms_px(self) -> float:
        """RMS difference of the projections by the model and by the lens, in pixels of this picture."""
        return self._fitted.rms_px * self._scale

    @property
    def max_px(self) -> float:
        """Largest difference of the projections by the model and by the lens at the fitted points, in pixels."""
        return self._fitted.max_px * self._scale

    @property
    def _fitted(self) -> CameraModelFit:
        if self.fit is None:
            raise InputError("this calibration was not fitted to a lens")
        return self.fit

    @property
    def _scale(self) -> float:
        return float(self.camera_matrix[0, 0] / self._fitted.camera_matrix[0, 0])


def calibration(
    self: Lens,
    *,
    film_mm: tuple[float, float] | None = None,
    resolution: tuple[int, int] | None = None,
    model: str | None = None,
    distance_m: float | None = None,
    through: str = "light",
) -> LensCalibration:
    """Returns the calibration that a camera with this lens would have: a camera model fitted to the lens's rays, at its
    focus and f-number.

    film_mm: (width, height), and resolution: (columns, rows); None: see Film.for_lens. model: see fit_camera_model;
    None: "opencv5" if it fits to 0.05 pixels RMS, and otherwise the better one of it and "fisheye". distance_m,
    through: see fit_camera_model.
    The result can be saved in all formats of docs/calibration.md. Its rms_px and max_px say how well the model fits.
    Raises InputError.
    """
    camera = Camera(self, film=Film.for_lens(self, film_mm, resolution))
    fit = _best(camera, distance_m, through) if model is None else _fit(camera, model, distance_m, through)
    found = fit.calibration
    return LensCalibration(**{entry.name: getattr(found, entry.name) for entry in fields(found)}, fit=fit)


def _best(camera: Camera, distance_m: float | None, through: str) -> CameraModelFit:
    """Returns the better one of the candidates, of those that can be inverted on the whole film."""
    fits = []
    for model in CANDIDATES:
        try:
            fits.append(_fit(camera, model, distance_m, through))
        except InputError:
            # A model of the tangent ends at 90 degrees off the axis; the last candidate has no such limit.
            if model == CANDIDATES[-1]:
                raise
        if fits and fits[-1].covers_film and fits[-1].rms_px <= GOOD_PX:
            return fits[-1]
    return min(fits, key=lambda fit: (not fit.covers_film, fit.rms_px))


def _fit(camera: Camera, model: str, distance_m: float | None, through: str) -> CameraModelFit:
    return fit_camera_model(camera, model, distance_m=distance_m, through=through)
