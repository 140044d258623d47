"""Least squares over the numbers of a lens: sharper spots, a focal length, within bounds.

For a tinkerer, not for a designer: a local search from the lens as it is, with numbers that change continuously.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._core import InputError, Lens, LensFileError
from .variable import Variable

Progress = Callable[[int, float], bool | None]


@dataclass(frozen=True)
class Targets:
    """What a lens is to become.

    fields_deg, field_weights: angles in the scene whose spots are to be small, and how much they count.
    wavelengths_nm: all colours count alike, about one centroid, so that lateral colour counts, too. None: the design
    wavelength.
    object_distance_m: from the front vertex; None: the plane in focus. focal_length_mm: None: whatever comes.
    focal_length_weight: an error of the focal length counts as so many times that radius of all spots.
    refocuses: the film is where it is sharpest on the axis; else it stays.
    """

    fields_deg: Sequence[float] = (0.0,)
    field_weights: Sequence[float] | None = None
    wavelengths_nm: Sequence[float] | None = None
    object_distance_m: float | None = None
    focal_length_mm: float | None = None
    focal_length_weight: float = 1.0
    refocuses: bool = True


@dataclass(frozen=True)
class Optimisation:
    """What came of it. rms_spot_mm: weighted over all fields and colours; message: why it ended."""

    lens: Lens
    rms_spot_before_mm: float
    rms_spot_mm: float
    evaluations: int
    message: str


def optimised(
    lens: Lens,
    variables: Sequence[Variable],
    targets: Targets | None = None,
    *,
    most_steps: int = 50,
    samples: int = 6,
    progress: Progress | None = None,
) -> Optimisation:
    """Changes some numbers of a lens so that its spots become small (scipy's least_squares, trust region reflective).

    most_steps: each step looks at the lens once for every variable. samples: rings of rays in the pupil.
    progress: called after each look with its number and the RMS spot in mm; the search ends where it returns False.
    A lens that cannot be built (faces that cross, rims beyond their surface) is never stepped to. Raises InputError for
    variables and targets that are none, and where the lens as it is cannot be judged.
    """
    from scipy.optimize import least_squares  # slow to load, and no other part of the package needs it

    search = _Search(lens, list(variables), targets or Targets(), samples, progress)
    before = search.rms_of(search.of_start)
    try:
        found = least_squares(
            search.residuals,
            np.zeros(len(search.variables)),
            jac=search.jacobian,
            bounds=search.bounds(),
            max_nfev=most_steps,
            # Sums of squares of micrometres in mm are small, whatever the slope is: it tells nothing of the end.
            ftol=1e-9,
            xtol=1e-9,
            gtol=None,
        )
        message = str(found.message)
    except _Ended:
        message = "stopped by the progress function"
    return Optimisation(search.best, before, search.best_rms, search.evaluations, message)


class _Ended(Exception):  # noqa: N818
    pass


class _Search:
    def __init__(
        self, lens: Lens, variables: list[Variable], targets: Targets, samples: int, progress: Progress | None
    ) -> None:
        _check(lens, variables, targets)
        self.lens, self.variables, self.targets = lens, variables, targets
        self.samples, self.progress = samples, progress
        self.start = np.array([v.of(lens.surfaces[v.surface]) for v in variables])
        self.steps = np.array([v.step(lens.surfaces[v.surface]) for v in variables])
        self.evaluations = 0
        self.best, self.best_rms, self.best_merit = lens, math.inf, math.inf
        self.spot_count = 0
        self.of_start = self._judge(lens)
        self.failed = 1e3 * (1 + float(np.abs(self.of_start).max()))
        if not np.isfinite(self.of_start).all():
            raise InputError(f'no light passes lens "{lens.name}" from one of the fields')

    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        lower, upper = (np.array([getattr(v, name) for v in self.variables]) for name in ("lower", "upper"))
        return (lower - self.start) / self.steps, (upper - self.start) / self.steps

    def lens_at(self, x: NDArray[np.float64]) -> Lens:
        surfaces = {v.surface: self.lens.surfaces[v.surface] for v in self.variables}
        for variable, value in zip(self.variables, self.start + x * self.steps, strict=True):
            surfaces[variable.surface] = variable.set(surfaces[variable.surface], float(value))
        lens = self.lens.with_surfaces(surfaces)
        return lens.focused(lens.focus_distance_m) if self.targets.refocuses else lens

    def residuals(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        self.evaluations += 1
        try:
            lens = self.lens_at(x)
            residuals = self._judge(lens)
        except (InputError, LensFileError):
            residuals = np.full_like(self.of_start, np.nan)
        if not np.isfinite(residuals).all():
            # So bad that the step is taken back, and halved.
            return np.full_like(self.of_start, self.failed)
        merit = float(residuals @ residuals)
        if merit < self.best_merit:
            self.best, self.best_merit, self.best_rms = lens, merit, self.rms_of(residuals)
        if self.progress is not None and self.progress(self.evaluations, self.best_rms) is False:
            raise _Ended
        return residuals

    def jacobian(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Central differences: a focal length depends on curvatures so much more than a spot does that the error of
        one-sided ones would hide the spot. One-sided where a lens to one side cannot be built."""
        reach = 0.005
        columns = []
        for unit in np.eye(len(x)):
            looks = [(side, self.residuals(x + side * unit)) for side in (reach, -reach)]
            possible = [(side, residuals) for side, residuals in looks if residuals[0] != self.failed]
            if len(possible) == 1:
                possible.append((0.0, self.residuals(x)))
            if not possible:
                columns.append(np.zeros_like(self.of_start))
                continue
            (a, first), (b, last) = possible
            columns.append((first - last) / (a - b))
        derivatives: NDArray[np.float64] = np.array(columns).T
        return derivatives

    def rms_of(self, residuals: NDArray[np.float64]) -> float:
        return float(np.sqrt(np.sum(residuals[: self.spot_count] ** 2)))

    def _judge(self, lens: Lens) -> NDArray[np.float64]:
        """Ray errors in mm whose squares sum to the mean square spot radius, and the focal length's; nan: dark."""
        targets = self.targets
        weights = np.array(targets.field_weights or [1.0] * len(targets.fields_deg), float)
        weights /= weights.sum()
        parts = []
        for field, weight in zip(targets.fields_deg, weights, strict=True):
            parts.append(math.sqrt(weight) * self._ray_errors(lens, field))
        spots = np.concatenate(parts)
        self.spot_count = len(spots)
        if targets.focal_length_mm is None:
            return spots
        error = lens.first_order().effective_focal_length_mm - targets.focal_length_mm
        return np.asarray(np.append(spots, targets.focal_length_weight * error))

    def _ray_errors(self, lens: Lens, field_deg: float) -> NDArray[np.float64]:
        wavelengths = self.targets.wavelengths_nm or [lens.wavelength_nm]
        points, weights = [], []
        for wavelength in wavelengths:
            try:
                spot = lens.spot(
                    field_deg,
                    object_distance_m=self.targets.object_distance_m,
                    wavelength_nm=wavelength,
                    samples=self.samples,
                )
            except InputError:
                return np.full(1, np.nan)
            points.append(spot.points_mm)
            weights.append(spot.weights / len(wavelengths))
        at, share = np.concatenate(points), np.concatenate(weights)
        passes = np.isfinite(at[:, 0])
        share = np.where(passes, share, 0.0)
        share = share / share.sum()
        middle = share @ np.where(passes[:, None], at, 0.0)
        # A lens does not become sharp by being dark: the fewer rays pass, the more their errors count.
        errors = np.where(passes[:, None], at - middle, 0.0) * np.sqrt(share)[:, None]
        return np.asarray(errors.ravel() / math.sqrt(max(passes.mean(), 1e-9)))


def _check(lens: Lens, variables: list[Variable], targets: Targets) -> None:
    if not variables:
        raise InputError("there is nothing to change: at least one Variable is wanted")
    for variable in variables:
        if variable.quantity not in ("curvature", "thickness", "conic", "aspheric"):
            raise InputError(
                f'unknown quantity "{variable.quantity}"; curvature, thickness, conic or aspheric is wanted'
            )
        if not 0 <= variable.surface < len(lens.surfaces):
            raise InputError(f"there is no surface {variable.surface}; the lens has {len(lens.surfaces)}, from 0")
        if variable.quantity == "thickness" and variable.surface == len(lens.surfaces) - 1:
            raise InputError("the last surface has no thickness; the film follows it")
        surface = lens.surfaces[variable.surface]
        if variable.quantity != "thickness" and surface.type in ("stop", "aperture"):
            raise InputError(f"surface {variable.surface} is a {surface.type}, a plane, and has no {variable.quantity}")
        value = variable.of(surface)
        if not variable.lower < value < variable.upper:
            raise InputError(
                f"the {variable.quantity} of surface {variable.surface} is {value:.6g} and does not lie between its "
                f"bounds, {variable.lower:.6g} and {variable.upper:.6g}"
            )
    if len({(v.quantity, v.surface, v.power) for v in variables}) < len(variables):
        raise InputError("a variable is named twice")
    weights = targets.field_weights
    if not targets.fields_deg or (weights is not None and len(weights) != len(targets.fields_deg)):
        raise InputError("fields_deg must name at least one field, and field_weights as many")
    if weights is not None and not all(w > 0 and math.isfinite(w) for w in weights):
        raise InputError("field_weights must be positive numbers")
