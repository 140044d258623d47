"""Camera models of computer vision, fitted to the rays of a real lens."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Camera, InputError
from ..calibration import Calibration
from ..calibration.models.central import CentralModel
from ..calibration.models.distortion import BrownConrady
from ..calibration.models.opencv_models import pinhole_model
from ..calibration.models.projections import Equidistant
from ..calibration.models.radial import RationalRadius
from ..html_tables import html_table
from . import conventions
from .models import MODELS, RadialModel, distortion_coefficients, model_named
from .regularised import condition_of, nearest_coefficients

Array = NDArray[np.float64]

GRID = 49  # sample points along the longer side of the film, including its edges
# Smallest illuminance of a fitted film point, as a fraction of that at the film centre. In darker corners a calibration
# pattern is not recognised, and the ray of the centre of light depends mostly on vignetting.
MIN_LIGHT = 0.1
# Improvement of the held-out RMS that justifies more coefficients; no calibration resolves less.
SIGNIFICANT_PX = 0.01
# Powers of the angle, relative to the first, that models of the angle have.
ANGLE_POWERS = {name: model.numerator for name, model in MODELS.items() if not model.by_tangent}
SIMPLER = ("pinhole", "opencv4", "opencv5")  # models with fewer coefficients than opencv8


@dataclass(frozen=True, eq=False, repr=False)
class CameraModelFit:
    """A camera model fitted to a camera.

    model: name of the model. camera: the camera to which it was fitted. camera_matrix: (3, 3), K in the pixel
    coordinates of Camera.project. coefficients: k1, k2, ... of the model (realcam.vision.models). distance_m: distance
    of the fitted points from the centre of the entrance pupil, in metres. through: see Camera.project. pixels: (N, 2),
    pixel positions of the fitted points. residuals: (N, 2), projection by the model minus that by the lens, in pixels.
    largest_angle_deg: largest angle to the axis up to which the model's radius increases with the angle, so that it can
    be inverted. condition: condition number of the model's terms over the film (realcam.vision.regularised); if it is
    large, very different coefficients fit nearly as well.
    """

    model: str
    camera: Camera
    camera_matrix: Array
    coefficients: Array
    distance_m: float
    through: str
    pixels: Array
    residuals: Array
    largest_angle_deg: float
    condition: float = np.nan

    def __repr__(self) -> str:
        return (
            f"<realcam.CameraModelFit {self.model} of {self.camera!r:.60}, {self.rms_px:.3g} px RMS, "
            f"{self.max_px:.3g} px at most, up to {self.largest_angle_deg:.4g} degrees>"
        )

    def _repr_html_(self) -> str:
        K = self.camera_matrix
        rows = [
            ("model", self.model),
            ("camera", repr(self.camera)),
            ("fx, fy", f"{K[0, 0]:.6g}, {K[1, 1]:.6g} px"),
            ("cx, cy", f"{K[0, 2]:.6g}, {K[1, 2]:.6g} px"),
            *((f"k{index}", f"{value:.6g}") for index, value in enumerate(self.coefficients, 1)),
            ("residuals", f"{self.rms_px:.3g} px RMS, {self.max_px:.3g} px at most, at {len(self.pixels)} points"),
            ("largest angle", f"{self.largest_angle_deg:.4g}°"),
            ("condition", f"{self.condition:.3g}"),
        ]
        return html_table(rows, align="left")

    @property
    def rms_px(self) -> float:
        """RMS length of the residuals, in pixels."""
        return float(np.sqrt(np.mean(np.sum(self.residuals**2, axis=1))))

    @property
    def max_px(self) -> float:
        """Largest length of a residual, in pixels."""
        return float(np.linalg.norm(self.residuals, axis=1).max())

    @property
    def covers_film(self) -> bool:
        """True if the model can be inverted at every fitted film point."""
        return not np.isnan(self.unproject(self.pixels)).any()

    @property
    def largest_radius_px(self) -> float:
        """Distance from the principal point at largest_angle_deg, in pixel widths."""
        return float(self.camera_matrix[0, 0] * self._largest_radius())

    def project(self, points_m: ArrayLike) -> Array:
        """Projects (N, 3) scene points to (N, 2) pixels, as Camera.project; NaN beyond largest_angle_deg."""
        rotation, translation = self.camera.world_to_camera
        points = np.asarray(points_m, dtype=float) @ rotation.T + translation
        return projected(model_named(self.model), self.camera_matrix, self.coefficients, points)

    def unproject(self, pixels: ArrayLike) -> Array:
        """Returns (N, 3) unit directions in the scene, from Camera.entrance_pupil_position_m, of (N, 2) pixels.

        NaN beyond largest_radius_px.
        """
        model = model_named(self.model)
        K = self.camera_matrix
        plane = (np.asarray(pixels, dtype=float) - K[:2, 2]) / np.diag(K)[:2]
        radius = np.hypot(plane[:, 0], plane[:, 1])
        # Bisection: 60 halvings reach the rounding error of an angle.
        low, high = np.zeros_like(radius), np.full_like(radius, np.radians(self.largest_angle_deg))
        for _ in range(60):
            middle = 0.5 * (low + high)
            below = model.radius(model.argument(middle), self.coefficients) < radius
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        angle = np.where(radius <= self._largest_radius(), 0.5 * (low + high), np.nan)
        across = np.sin(angle) / np.where(radius > 0, radius, 1)
        in_camera = np.stack([across * plane[:, 0], across * plane[:, 1], np.cos(angle)], axis=1)
        directions: Array = in_camera @ self.camera.world_to_camera[0]
        return directions

    def residuals_at(self, distance_m: float) -> Array:
        """Returns the (N, 2) residuals for points at another distance.

        A real lens has no single centre of projection: its entrance pupil moves with the angle, which matters close to
        the lens.
        """
        return self._residuals_of(*calibration_points(self.camera, distance_m, self.through))

    def held_out_rms_px(self) -> float:
        """Returns the RMS length of the residuals at film points half-way between the fitted ones, in pixels."""
        residuals = self._residuals_of(*calibration_points(self.camera, self.distance_m, self.through, between=True))
        return float(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))

    def _residuals_of(self, points: Array, pixels: Array) -> Array:
        return projected(model_named(self.model), self.camera_matrix, self.coefficients, points) - pixels

    @property
    def calibration(self) -> Calibration:
        """The fitted model as a rc.Calibration, which all formats of calibrations are saved from."""
        film, k = self.camera.film, [float(value) for value in self.coefficients]
        if self.model in ANGLE_POWERS:
            sees_behind = self.largest_fitted_angle_deg >= 90
            top = dict(zip(ANGLE_POWERS[self.model], k, strict=True))
            radius = RationalRadius((1.0, *(top.get(power, 0.0) for power in range(1, max(top) + 1))))
            projection = Equidistant(np.pi if sees_behind or self.model == "f_theta" else np.pi / 2)
            model = CentralModel(projection, BrownConrady(radius), self.camera_matrix)
        else:
            D = distortion_coefficients(model_named(self.model), self.coefficients)
            model = pinhole_model(self.camera_matrix, D)
        return Calibration(
            model,
            film.resolution,
            self.model,
            name=self.camera.lens.name,
            film_mm=(film.width_mm, film.height_mm),
        )

    @property
    def largest_fitted_angle_deg(self) -> float:
        """Largest angle to the axis of the fitted points."""
        rays = self.camera.ray(self.pixels, through=self.through)[1] @ self.camera.world_to_camera[0].T
        return float(np.degrees(_angles(rays).max()))

    def opencv(self) -> tuple[Array, Array]:
        """Returns (K, coefficients) in OpenCV's convention, in which the centre of the first pixel is (0, 0).

        Those of the model fisheye are for the functions of cv2.fisheye. Raises InputError for f_theta.
        """
        coefficients = distortion_coefficients(model_named(self.model), self.coefficients)
        return conventions.opencv_matrix(self.camera_matrix), np.array(coefficients)

    def _largest_radius(self) -> float:
        limit = np.array(np.radians(self.largest_angle_deg) * (1 - 1e-9))  # just below a possible pole
        model = model_named(self.model)
        with np.errstate(invalid="ignore"):
            radius = float(model.radius(model.argument(limit), self.coefficients))
        return radius if np.isfinite(radius) else np.inf


def fit_camera_model(
    camera: Camera, model: str = "opencv5", *, distance_m: float | None = None, through: str = "light"
) -> CameraModelFit:
    """Fits a camera model to the rays of a camera by least squares of the reprojection error in pixels.

    model: "pinhole", "opencv4", "opencv5", "opencv8" (OpenCV's, with 2, 3 and 6 radial coefficients; both tangential
    coefficients are 0), "fisheye" (Kannala and Brandt, cv2.fisheye), "f_theta" (a polynomial of the angle).
    The centre of projection is the centre of the paraxial entrance pupil, and the axis is the lens's. For a lens
    without rotational symmetry both focal lengths and the principal point are fitted as well; the residuals hold what
    no function of the angle can express. distance_m: radius of the sphere about the centre of projection on which the
    fitted points lie, inf allowed; None: the distance of the plane in focus on the axis. Off-axis points of a plane are
    further away, and a lens whose pupil moves with the angle, such as a fisheye, projects them differently (0.1 pixels
    at close range). through: see Camera.project. Film points that receive less than a tenth of the light at the film
    centre are ignored.
    Among all coefficients of "opencv8" within a hundredth of a pixel of the best fit, those closest to "opencv5" are
    returned. Warns if a model with fewer coefficients predicts held-out points equally well, to a hundredth of a pixel.

    Raises InputError, also if the model is a function of the tangent and the field of view reaches 90 degrees off the
    axis.
    """
    fit = _fitted(camera, model_named(model), distance_m, through)
    if model_named(model).denominator:
        _warn_of_too_many_terms(fit, distance_m)
    return fit


def _warn_of_too_many_terms(fit: CameraModelFit, distance_m: float | None) -> None:
    rms = fit.held_out_rms_px()
    for name in SIMPLER:
        simpler = _fitted(fit.camera, model_named(name), distance_m, fit.through).held_out_rms_px()
        if simpler - rms < SIGNIFICANT_PX:
            warnings.warn(
                f"{name} predicts points between the fitted ones as well as {fit.model}: {simpler:.2g} and "
                f'{rms:.2g} pixels RMS; fewer terms are enough for lens "{fit.camera.lens.name:.60}"',
                stacklevel=3,
            )
            return


def _fitted(camera: Camera, from_model: RadialModel, distance_m: float | None, through: str) -> CameraModelFit:
    from scipy import optimize  # slow to load

    if distance_m is None:
        distance_m = _focus_from_pupil_m(camera)
    points, pixels = calibration_points(camera, distance_m, through)
    start = camera.camera_matrix
    s = from_model.argument(_angles(points))
    if np.isnan(s).any():
        raise InputError(
            f'the camera model {from_model.name} cannot describe lens "{camera.lens.name}": its field of view reaches '
            "90 degrees off the axis; use fisheye, f_theta or a smaller film"
        )
    r = np.hypot(*((pixels - start[:2, 2]) / np.diag(start)[:2]).T)

    is_round = camera.lens.is_rotational
    matrix_terms = 1 if is_round else 4  # number of leading parameters that describe the camera matrix

    def matrix(parameters: Array) -> Array:
        scaled: Array = start.copy()
        if is_round:
            scaled[[0, 1], [0, 1]] *= parameters[0]
        else:
            scaled[[0, 1], [0, 1]] *= parameters[:2]
            scaled[:2, 2] += parameters[2:4]
            scaled[[0, 1], [1, 0]] = 0
        return scaled

    def residuals(parameters: Array) -> Array:
        return _projected_unchecked(from_model, matrix(parameters), parameters[matrix_terms:], points) - pixels

    # Tight tolerances: the sum of squares is flat near its minimum, where coefficients compensate each other.
    tolerances = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    guesses = _first_guesses(from_model, s, r)
    if not is_round:
        guesses = [np.concatenate([[guess[0], guess[0], 0, 0], guess[1:]]) for guess in guesses]
    found = [
        optimize.least_squares(lambda p: residuals(p).ravel(), guess, method="lm", x_scale="jac", **tolerances).x
        for guess in guesses
    ]
    # Numerator and denominator may have adjacent roots within the picture, that is, a pole between the fitted points.
    # The guess without a denominator has no pole.
    candidates = [*found, *guesses]
    widest = _angles(points).max()
    sound = [p for p in candidates if from_model.largest_angle(p[matrix_terms:]) >= widest] or candidates
    best = min(sound, key=lambda p: np.sum(residuals(p) ** 2))
    if from_model.denominator:
        near = nearest_coefficients(from_model, residuals, best, guesses[-1], float(s.max()))
        if from_model.largest_angle(near[matrix_terms:]) >= widest:
            best = near
    return CameraModelFit(
        model=from_model.name,
        camera=camera,
        camera_matrix=matrix(best),
        coefficients=best[matrix_terms:],
        distance_m=distance_m,
        through=through,
        pixels=pixels,
        residuals=residuals(best),
        largest_angle_deg=float(np.degrees(from_model.largest_angle(best[matrix_terms:]))),
        condition=condition_of(from_model, s, r),
    )


def _first_guesses(model: RadialModel, s: Array, r: Array) -> list[Array]:
    """Returns starting values (f, coefficients), the solutions of r (1 + ...) = f s (1 + ...) by linear least squares.

    The first has the model's denominator, the last does not.
    """
    numerator_terms = 1 + len(model.numerator)
    columns = model.linear_terms(s, r)
    guesses = []
    for count in sorted({numerator_terms, columns.shape[1]}, reverse=True):
        solution, *_ = np.linalg.lstsq(columns[:, :count], r, rcond=None)
        solution = np.append(solution, np.zeros(columns.shape[1] - count))
        f, numerator, denominator = np.split(solution, [1, numerator_terms])
        guesses.append(np.concatenate([f, numerator / f[0], denominator]))
    return guesses


def calibration_points(
    camera: Camera, distance_m: float, through: str = "light", between: bool = False
) -> tuple[Array, Array]:
    """Returns (points, pixels) for fitting a camera model.

    pixels: (N, 2), a grid over the film, without positions that receive less than a tenth of the light at the film
    centre. points: (N, 3), the points that project to these pixels, at distance_m metres from the centre of the
    entrance pupil, in the axes of Camera.world_to_camera; unit directions if the distance is infinite. between: uses
    the centres of the grid's cells instead of its points. Raises InputError.
    """
    if not distance_m > 0:
        raise InputError("distance_m must be a positive number of metres, or inf")
    if camera.motion:
        raise InputError("a camera model is fitted to a camera without motion; replace(motion=[]) gives one")
    columns, rows = camera.film.resolution
    width, height = camera.film.width_mm, camera.film.height_mm
    counts = [max(3, round(GRID * side / max(width, height))) for side in (width, height)]
    steps = [np.linspace(0, size, count) for size, count in zip((columns, rows), counts, strict=True)]
    if between:
        steps = [0.5 * (step[1:] + step[:-1]) for step in steps]
    grid = np.meshgrid(*steps)
    pixels = np.stack(grid, axis=-1).reshape(-1, 2)
    origins, directions, light = camera.ray(pixels, through=through, return_light=True)
    is_lit = ~np.isnan(directions[:, 0]) & (light >= MIN_LIGHT)
    pixels, origins, directions = pixels[is_lit], origins[is_lit], directions[is_lit]
    rotation, translation = camera.world_to_camera
    directions = directions @ rotation.T
    if np.isinf(distance_m):
        return directions, pixels
    # Intersection of each ray with the sphere about the centre of the entrance pupil.
    from_pupil = origins @ rotation.T + translation
    along = np.sum(from_pupil * directions, axis=1)
    discriminant = along**2 - np.sum(from_pupil**2, axis=1) + distance_m**2
    if (discriminant < 0).any() or (np.sqrt(discriminant) < along).any():
        raise InputError(f"distance_m is {distance_m}, which lies inside the lens; use a larger one")
    return from_pupil + (np.sqrt(discriminant) - along)[:, None] * directions, pixels


def projected(model: RadialModel, camera_matrix: Array, coefficients: Array, points: Array) -> Array:
    """Projects (N, 3) points in camera axes to (N, 2) pixels; NaN where the model is undefined or not monotonic."""
    pixels = _projected_unchecked(model, camera_matrix, coefficients, points)
    pixels[_angles(points) > model.largest_angle(coefficients)] = np.nan
    return pixels


def _projected_unchecked(model: RadialModel, camera_matrix: Array, coefficients: Array, points: Array) -> Array:
    """Projects points in camera axes to pixels, also where the model is not monotonic."""
    radius = model.radius(model.argument(_angles(points)), coefficients)
    across = np.hypot(points[:, 0], points[:, 1])
    share = radius / np.where(across > 0, across, 1)
    pixels: Array = share[:, None] * points[:, :2] * np.diag(camera_matrix)[:2] + camera_matrix[:2, 2]
    return pixels


def _angles(points: Array) -> Array:
    """Returns the angles of points in camera axes to the forward axis, in radians."""
    angles: Array = np.arctan2(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
    return angles


def _focus_from_pupil_m(camera: Camera) -> float:
    """Returns the distance of the plane in focus from the centre of the entrance pupil; inf if either is infinite."""
    if np.isinf(camera.lens.focus_distance_m) or camera.entrance_pupil_position_m is None:
        return np.inf
    pupil = np.linalg.norm(np.subtract(camera.entrance_pupil_position_m, camera.position))
    return float(camera.lens.focus_distance_m - pupil)
