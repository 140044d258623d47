"""Lens optimisation by bounded least squares: spot sizes, focal length and other operands."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import InputError, Lens, LensFileError
from ..derivatives.field_light import field_light
from ..derivatives.focus import film_distance_by
from ..derivatives.variable import Variable, checked
from .operands import Operand

Progress = Callable[[int, float], bool | None]

DIFFERENCE_STEP = 0.005  # half width of finite differences, in units of Variable.step


@dataclass(frozen=True)
class Targets:
    """Merit function of an optimisation.

    fields_deg, field_weights: field angles whose spots are minimised, and their weights.
    wavelengths_nm, wavelength_weights: wavelengths and their weights; spots are about the centroid of all wavelengths,
    so that lateral colour counts. None: the design wavelength; equal weights.
    object_distance_m: from the front vertex; None: the plane in focus. focal_length_mm: None: unconstrained.
    focal_length_weight: an error of 1 mm in the focal length counts as this many mm of RMS spot radius.
    refocuses: True keeps the film at the best axial focus; False keeps its distance.
    operands: further operands: MTF, distortion, angles, thicknesses, length.
    """

    fields_deg: Sequence[float] = (0.0,)
    field_weights: Sequence[float] | None = None
    wavelengths_nm: Sequence[float] | None = None
    object_distance_m: float | None = None
    focal_length_mm: float | None = None
    focal_length_weight: float = 1.0
    refocuses: bool = True
    wavelength_weights: Sequence[float] | None = None
    operands: Sequence[Operand] = ()


@dataclass(frozen=True)
class Optimisation:
    """Result of an optimisation.

    rms_spot_before_mm, rms_spot_mm: RMS spot radius of the initial and the best lens, weighted over all fields and
    wavelengths. evaluations: number of evaluated lenses. message: reason for the end.
    merit: the minimised sum of squares of spots and operands, mm^2.
    """

    lens: Lens
    rms_spot_before_mm: float
    rms_spot_mm: float
    evaluations: int
    message: str
    merit: float


def optimised(
    lens: Lens,
    variables: Sequence[Variable],
    targets: Targets | None = None,
    *,
    most_steps: int = 50,
    samples: int = 6,
    progress: Progress | None = None,
    global_looks: int = 0,
    seed: int = 0,
    answers_interrupt: bool = False,
) -> Optimisation:
    """Optimises variables of a lens for small spots (scipy's least_squares, trust region reflective).

    Derivatives are exact (Lens.gradient), except for three cases that use finite differences: lenses that focus by a
    moving group, near objects of lenses that are not rotationally symmetric, and refocusing of such lenses.
    most_steps: of the local search. samples: rings of rays in the pupil.
    progress: called after each evaluation with its count and the RMS spot in mm; returning False ends the search.
    global_looks: number of evaluations of a global search within the bounds, which must be finite; the local search
    starts from its best lens (scipy's differential_evolution, from `seed`).
    answers_interrupt: Ctrl-C ends the search with the best lens so far, in place of KeyboardInterrupt.
    Lenses that cannot be built (surfaces that intersect, rims beyond their surface) are never accepted. Raises
    InputError for invalid variables and targets, and if the initial lens cannot be evaluated.
    """
    from scipy.optimize import least_squares  # slow to load, and no other part of the package needs it

    search = _Search(lens, list(variables), targets or Targets(), samples, progress)
    before = search.rms_of(search.of_start)
    try:
        start = search.globally_best(global_looks, seed) if global_looks else np.zeros(len(search.variables))
        found = least_squares(
            search.residuals,
            start,
            jac=search.jacobian,
            bounds=search.bounds(),
            max_nfev=most_steps,
            # No gtol: squared micrometres in mm^2 have a tiny gradient everywhere, so it does not indicate convergence.
            ftol=1e-9,
            xtol=1e-9,
            gtol=None,
        )
        message = str(found.message)
    except _Ended:
        message = "stopped by the progress function"
    except KeyboardInterrupt:
        if not answers_interrupt:
            raise
        message = "interrupted"
    return Optimisation(search.best, before, search.best_rms, search.evaluations, message, search.best_merit)


class _Ended(Exception):  # noqa: N818
    """The progress function has ended the optimisation."""


class _Search:
    """Least-squares problem of an optimisation. Points x are (V,), changes of the variables in units of their steps.

    best, best_rms, best_merit: the best lens so far. of_start: residuals of the initial lens. failed: residual of
    lenses that cannot be evaluated. is_exact: True if derivatives are exact, not finite differences.
    """

    def __init__(
        self, lens: Lens, variables: list[Variable], targets: Targets, samples: int, progress: Progress | None
    ) -> None:
        _check(lens, variables, targets)
        self.lens, self.variables, self.targets = lens, variables, targets
        self.samples, self.progress = samples, progress
        self.field_weights = _normalised(targets.field_weights, len(targets.fields_deg))
        self.wavelengths = list(targets.wavelengths_nm or [lens.wavelength_nm])
        self.wavelength_weights = _normalised(targets.wavelength_weights, len(self.wavelengths))
        self.operands = [operand.checked(lens) for operand in targets.operands]
        if targets.focal_length_mm is not None:
            self.operands.append(
                Operand("effective_focal_length_mm", targets.focal_length_mm, targets.focal_length_weight)
            )
        self.start = np.array([v.of(lens.surfaces[v.surface]) for v in variables])
        self.steps = np.array([v.step(lens.surfaces[v.surface]) for v in variables])
        self.evaluations = 0
        self.best, self.best_rms, self.best_merit = lens, math.inf, math.inf
        self.spot_count = 0  # number of residuals that belong to spots; those of operands follow
        self.of_start = self._evaluated(lens)
        self.failed = 1e3 * (1 + float(np.abs(self.of_start).max()))
        if not np.isfinite(self.of_start).all():
            raise InputError(f'no light passes lens "{lens.name}" from one of the fields')
        # Without rotational symmetry, a near object point moves when the lens changes; that has no exact derivatives.
        distance_m = lens.focus_distance_m if targets.object_distance_m is None else targets.object_distance_m
        self.is_exact = (
            (lens.is_rotational or math.isinf(distance_m))
            and not (targets.refocuses and _focuses_by_group(lens))
            and self._has_chief_rays()
        )

    def _has_chief_rays(self) -> bool:
        """True if all chief rays pass: exact derivatives need them, and a secondary mirror may block them."""
        return all(
            self.lens.aim([[0.0, 0.0]], field, object_distance_m=self.targets.object_distance_m).status[0] == 0
            for field in (0.0, *self.targets.fields_deg)
        )

    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        lower, upper = (np.array([getattr(v, name) for v in self.variables]) for name in ("lower", "upper"))
        return (lower - self.start) / self.steps, (upper - self.start) / self.steps

    def lens_at(self, x: NDArray[np.float64]) -> Lens:
        """The lens at a point, refocused if the targets require it. Raises InputError and LensFileError."""
        surfaces = {v.surface: self.lens.surfaces[v.surface] for v in self.variables}
        for variable, value in zip(self.variables, self.start + x * self.steps, strict=True):
            surfaces[variable.surface] = variable.set(surfaces[variable.surface], float(value))
        lens = self.lens.with_surfaces(surfaces)
        return lens.focused(lens.focus_distance_m) if self.targets.refocuses else lens

    def residuals(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Residuals at a point, and updates the best lens. Raises _Ended."""
        self.evaluations += 1
        try:
            lens = self.lens_at(x)
            residuals = self._evaluated(lens)
        except (InputError, LensFileError):
            residuals = np.full_like(self.of_start, np.nan)
        if not np.isfinite(residuals).all():
            # A large residual makes least_squares reject and shorten the step.
            return np.full_like(self.of_start, self.failed)
        merit = float(residuals @ residuals)
        if merit < self.best_merit:
            self.best, self.best_merit, self.best_rms = lens, merit, self.rms_of(residuals)
        if self.progress is not None and self.progress(self.evaluations, self.best_rms) is False:
            raise _Ended
        return residuals

    def globally_best(self, evaluations: int, seed: int) -> NDArray[np.float64]:
        """Returns the best point found by differential evolution within the bounds, with about this number of
        evaluations. Raises InputError if a variable has no finite bounds."""
        from scipy.optimize import differential_evolution

        lower, upper = self.bounds()
        if not np.isfinite([lower, upper]).all():
            raise InputError("a global search needs finite bounds for every variable")

        def merit(x: NDArray[np.float64]) -> float:
            residuals = self.residuals(x)
            return float(residuals @ residuals)

        members = 5 * len(self.variables)
        found = differential_evolution(
            merit,
            list(zip(lower, upper, strict=True)),
            maxiter=max(1, evaluations // members - 1),
            popsize=5,
            x0=np.zeros(len(self.variables)),
            polish=False,
            seed=seed,
        )
        # The local search must not start on a bound.
        inside = 1e-6 * (upper - lower)
        return np.asarray(np.clip(found.x, lower + inside, upper - inside))

    def jacobian(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """(residuals, V): derivatives of the residuals by x."""
        return np.asarray(self._exact_jacobian(x) * self.steps) if self.is_exact else self._differences(x)

    def _film_distance_by(self, x: NDArray[np.float64], lens: Lens) -> NDArray[np.float64]:
        """(V,): derivatives of the film distance by the variables, as the lens is refocused."""
        if not self.targets.refocuses:
            return np.zeros(len(x))
        if lens.is_rotational:
            return film_distance_by(lens, self.variables)

        # Without rotational symmetry, the chief ray of the film's centre changes with the lens and has no exact
        # derivatives: finite differences, one-sided if the lens on one side cannot be built.
        def moved(step: NDArray[np.float64]) -> float:
            try:
                return self.lens_at(x + step).film_distance_mm - lens.film_distance_mm
            except (InputError, LensFileError):
                return math.nan

        sides = (DIFFERENCE_STEP, -DIFFERENCE_STEP)
        slopes = [[moved(side * unit) / side for side in sides] for unit in np.eye(len(x))]
        means = [np.mean([s for s in pair if math.isfinite(s)] or 0.0) for pair in slopes]
        return np.asarray(np.array(means) / self.steps)

    def _exact_jacobian(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """(residuals, V): derivatives of the residuals by the variables, per their units."""
        lens, targets, variables = self.lens_at(x), self.targets, [*self.variables, Variable.film_distance()]
        film_by = self._film_distance_by(x, lens)

        def total(by: NDArray[np.float64]) -> NDArray[np.float64]:
            """Total derivatives by the variables, including the motion of the film."""
            return np.asarray(by[..., :-1] + by[..., -1:] * film_by)

        rows = []
        for field, weight in zip(targets.fields_deg, self.field_weights, strict=True):
            by, weights, passes = [], [], []
            for wavelength, part in zip(self.wavelengths, self.wavelength_weights, strict=True):
                light = field_light(
                    lens,
                    variables,
                    field,
                    wavelength,
                    object_distance_m=targets.object_distance_m,
                    samples=self.samples,
                )
                by.append(total(light.on_film()[:-1].by))
                weights.append(part * light.weights)
                passes.append(light.passes[:-1])
            passing = np.concatenate(passes)
            fractions = np.concatenate(weights) / np.concatenate(weights).sum()
            changes = np.where(passing[:, None, None], np.concatenate(by), 0.0)
            centroid = np.tensordot(fractions, changes, 1)
            errors = np.where(passing[:, None, None], changes - centroid, 0.0) * np.sqrt(fractions)[:, None, None]
            scale = math.sqrt(weight / max(passing.mean(), 1e-9))
            rows.append(scale * errors.reshape(-1, len(self.variables)))
        for operand in self.operands:
            value, change = operand.gradient_of(lens, variables, self.samples)
            slope = operand.weight if operand.residual(value) != 0 or operand.bound == "equal" else 0.0
            rows.append(slope * total(change)[None])
        return np.concatenate(rows)

    def _differences(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Jacobian by central differences: focal length depends on curvatures so much more strongly than spots do that
        the error of one-sided differences would hide the spots. One-sided if the lens on one side cannot be built."""
        columns = []
        for unit in np.eye(len(x)):
            sides = (DIFFERENCE_STEP, -DIFFERENCE_STEP)
            evaluated = [(side, self.residuals(x + side * unit)) for side in sides]
            possible = [(side, residuals) for side, residuals in evaluated if residuals[0] != self.failed]
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
        """RMS spot radius, mm, from residuals."""
        return float(np.sqrt(np.sum(residuals[: self.spot_count] ** 2)))

    def _evaluated(self, lens: Lens) -> NDArray[np.float64]:
        """Residuals: ray errors in mm whose squares sum to the mean square spot radius, then those of the operands; nan
        if no light of a field passes."""
        targets = self.targets
        parts = []
        for field, weight in zip(targets.fields_deg, self.field_weights, strict=True):
            parts.append(math.sqrt(weight) * self._ray_errors(lens, field))
        spots = np.concatenate(parts)
        self.spot_count = len(spots)
        others = [operand.residual(operand.value_of(lens, self.samples)) for operand in self.operands]
        return np.asarray(np.append(spots, others))

    def _ray_errors(self, lens: Lens, field_deg: float) -> NDArray[np.float64]:
        """Weighted distances of the rays from their centroid in x and y, mm; nan if no light passes."""
        points, weights = [], []
        for wavelength, part in zip(self.wavelengths, self.wavelength_weights, strict=True):
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
            weights.append(part * spot.weights)
        all_points, fractions = np.concatenate(points), np.concatenate(weights)
        passes = np.isfinite(all_points[:, 0])
        fractions = np.where(passes, fractions, 0.0)
        fractions = fractions / fractions.sum()
        centroid = fractions @ np.where(passes[:, None], all_points, 0.0)
        # Weighted by the inverse fraction of passing rays, so that vignetting does not count as sharpness.
        errors = np.where(passes[:, None], all_points - centroid, 0.0) * np.sqrt(fractions)[:, None]
        return np.asarray(errors.ravel() / math.sqrt(max(passes.mean(), 1e-9)))


def _normalised(weights: Sequence[float] | None, count: int) -> NDArray[np.float64]:
    """Weights with the sum 1; None: `count` equal ones."""
    array = np.array([1.0] * count if weights is None else weights, float)
    return np.asarray(array / array.sum())


def _focuses_by_group(lens: Lens) -> bool:
    """True if focusing moves elements other than the film, or if the lens cannot be focused at infinity or nearby."""
    near = 20 * abs(lens.first_order().effective_focal_length_mm) / 1000
    try:
        return lens.focused(near).surfaces != lens.focused(math.inf).surfaces
    except InputError:
        return True


def _check(lens: Lens, variables: list[Variable], targets: Targets) -> None:
    """Raises InputError for variables and targets that do not apply to the lens."""
    supported = ("curvature", "thickness", "conic", "aspheric", "index")
    for variable in checked(lens, variables):
        if variable.quantity not in supported:
            raise InputError(
                f'an optimisation cannot change "{variable.quantity}"; expected one of {", ".join(supported)}'
            )
        if variable.quantity == "thickness" and variable.surface == len(lens.surfaces) - 1:
            raise InputError("the last surface has no thickness; the film distance follows it")
        surface = lens.surfaces[variable.surface]
        if variable.quantity != "thickness" and surface.type in ("stop", "aperture"):
            raise InputError(f"surface {variable.surface + 1} is a plane {surface.type} and has no {variable.quantity}")
        value = variable.of(surface)
        if not variable.lower < value < variable.upper:
            raise InputError(
                f"the {variable.quantity} of surface {variable.surface + 1} is {value:.6g} and does not lie between "
                f"its bounds, {variable.lower:.6g} and {variable.upper:.6g}"
            )
    weights = targets.field_weights
    if not targets.fields_deg or (weights is not None and len(weights) != len(targets.fields_deg)):
        raise InputError("fields_deg must have at least one field, and field_weights as many numbers")
    if weights is not None and not all(w > 0 and math.isfinite(w) for w in weights):
        raise InputError("field_weights must be positive numbers")
    weights, colours = targets.wavelength_weights, targets.wavelengths_nm or [lens.wavelength_nm]
    if weights is not None and (len(weights) != len(colours) or not all(w > 0 for w in weights)):
        raise InputError(f"wavelength_weights must be {len(colours)} positive numbers, one for each wavelength")
    # Raises for variables without an effect, such as the conic of a plane.
    lens._ray_derivatives(np.zeros((0, 3)), np.zeros((0, 3)), [v.as_tuple() for v in variables])
