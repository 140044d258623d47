"""Monte Carlo tolerance studies: random copies of a lens and their performance."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._core import InputError, Lens, _ToleranceEvaluator
from ..settings import whole_number
from .compensators import Chosen, Compensator, chosen
from .figures import CopyFigures, Doubles
from .sensitivities import Sensitivity, inverse_sensitivities, sensitivities
from .tolerances import Tolerance, Tolerances, drawn, errors_of

Progress = Callable[[float], bool | None]

MAX_COPIES = 1_000_000
BLOCK = 64  # copies between calls of progress
SHARES = (0.02, 0.1, 0.5, 0.9, 0.98)  # default probabilities of quantiles


@dataclass(frozen=True)
class ToleranceStudy:
    """Result of a Monte Carlo tolerance study: copies of a lens with random errors.

    lens, tolerances, seed: arguments of tolerance_study. items: the individual tolerances. sizes: (C, E), errors of
    each copy in the order of the items; a directed tolerance has two errors. fields_deg: (F, 2), angles towards x and
    y. frequencies_per_mm: (K,); measures of a single frequency use the middle one. nominal: figures of the lens without
    errors, as one copy. figures: figures of all copies. is_whole: False if the study ended before all copies were
    evaluated. compensators: the selected ones.
    """

    lens: Lens
    tolerances: Tolerances
    items: list[Tolerance]
    seed: int
    fields_deg: Doubles
    frequencies_per_mm: Doubles
    nominal: CopyFigures
    figures: CopyFigures
    sizes: Doubles
    is_whole: bool
    compensators: Chosen
    _evaluator: _ToleranceEvaluator = field(repr=False, compare=False)

    def __len__(self) -> int:
        return len(self.figures)

    @property
    def middle_frequency(self) -> int:
        """Index of the middle frequency."""
        return len(self.frequencies_per_mm) // 2

    def copy(self, number: int) -> Lens:
        """Returns a copy as a lens for rendering, with its compensators set. Raises InputError if there is no such
        copy."""
        if not 0 <= number < len(self):
            raise InputError(f"there is no copy {number}; there are {len(self)}, counted from 0")
        f = self.figures
        return self._evaluator.copy(
            errors_of(self.items),
            self.sizes[number],
            float(f.film_shift_mm[number]),
            (float(f.film_slope[number, 0]), float(f.film_slope[number, 1])),
            (
                float(f.element_shift_mm[number, 0]),
                float(f.element_shift_mm[number, 1]),
                float(f.element_shift_mm[number, 2]),
            ),
        )

    def errors_of(self, number: int) -> list[tuple[Tolerance, Doubles]]:
        """Returns each tolerance with the error of a copy, in the unit of the tolerance: one number, or two if the
        tolerance is directed."""
        result, column = [], 0
        for item in self.items:
            width = len(item.errors)
            result.append((item, self.sizes[number, column : column + width] / item.scale))
            column += width
        return result

    def measure(self, name: str) -> Doubles:
        """(C,): "mtf", mean over the fields at the middle frequency; "lowest_mtf", MTF of the worst field; "spot_mm",
        largest RMS radius; "focal_length_mm"; "distortion", the largest in magnitude, signed. Raises InputError."""
        return measured(self.figures, name, self.middle_frequency)

    def nominal_measure(self, name: str) -> float:
        """A measure, as for `measure`, of the lens without errors. Raises InputError."""
        return float(measured(self.nominal, name, self.middle_frequency)[0])

    def quantiles(self, name: str, shares: ArrayLike = SHARES) -> Doubles:
        """Quantiles of a measure over the copies. shares: probabilities, 0 to 1."""
        quantiles: Doubles = np.quantile(self.measure(name), np.asarray(shares, float))
        return quantiles

    def yield_of(self, **limits: float) -> float:
        """Fraction of the copies that meet all limits, 0 to 1.

        Limits are keyed by measure: minimum of mtf and lowest_mtf, maximum of spot_mm and of the magnitude of
        distortion, and maximum deviation of focal_length_mm from its nominal value. Raises InputError.
        """
        if not limits:
            raise InputError("yield_of needs at least one limit, such as lowest_mtf=0.3")
        good = np.ones(len(self), bool)
        for name, limit in limits.items():
            values = self.measure(name)
            if not isinstance(limit, int | float) or math.isnan(limit):
                raise InputError(f"{name}: the limit must be a number; found {limit!r:.40}")
            if name.endswith("mtf"):
                good &= values >= limit
            elif name == "focal_length_mm":
                good &= np.abs(values - self.nominal_measure(name)) <= limit
            else:
                good &= np.abs(values) <= limit
        return float(good.mean())

    def sensitivities(self) -> list[Sensitivity]:
        """Effect of each tolerance alone at its limits, with the compensators set, in descending order of loss."""
        return list(self._sensitivities)

    @cached_property
    def _sensitivities(self) -> list[Sensitivity]:
        return sensitivities(self._evaluator, self.items, self.nominal, self.middle_frequency)

    def worst_offenders(self, count: int = 10) -> list[Sensitivity]:
        """The `count` tolerances with the largest loss of mean MTF."""
        return self.sensitivities()[:count]

    def inverse_sensitivities(self, loss: float) -> list[Tolerance]:
        """Limits at which each tolerance alone, at its worse limit, costs `loss` of the mean MTF, say 0.02.

        A tolerance that costs less at any size has the limit inf. Raises InputError."""
        return inverse_sensitivities(self._evaluator, self.items, self.nominal, self.middle_frequency, loss)

    def summary(self) -> dict[str, Any]:
        """The study as plain values, for JSON."""
        names = ("mtf", "lowest_mtf", "spot_mm", "focal_length_mm", "distortion")
        return {
            "lens": self.lens.name,
            "copies": len(self),
            "is_whole": self.is_whole,
            "seed": self.seed,
            "fields_deg": self.fields_deg,
            "frequency_per_mm": float(self.frequencies_per_mm[self.middle_frequency]),
            "quantiles": {
                name: {
                    "nominal": self.nominal_measure(name),
                    **{f"{share:g}": value for share, value in zip(SHARES, self.quantiles(name), strict=True)},
                }
                for name in names
            },
            "sensitivities": [s.as_values() for s in self.sensitivities()],
        }


def measured(figures: CopyFigures, name: str, frequency: int) -> Doubles:
    """(C,): a measure of the copies, see ToleranceStudy.measure. frequency: index. Raises InputError."""
    if name == "mtf":
        return figures.mean_mtf(frequency)
    if name == "lowest_mtf":
        return figures.lowest_mtf(frequency)
    if name == "spot_mm":
        spot: Doubles = figures.rms_spot_mm.max(1)
        return spot
    if name == "focal_length_mm":
        return figures.focal_length_mm
    if name == "distortion":
        worst = np.abs(figures.distortion).argmax(1)
        distortion: Doubles = figures.distortion[np.arange(len(worst)), worst]
        return distortion
    raise InputError(f'unknown measure "{name:.40}"; expected mtf, lowest_mtf, spot_mm, focal_length_mm or distortion')


def tolerance_study(
    lens: Lens,
    tolerances: Tolerances | str,
    copies: int = 1000,
    *,
    compensators: Sequence[Compensator] = ("refocus",),
    sharpest_by: str = "mtf",
    seed: int = 0,
    fields_deg: ArrayLike | None = None,
    frequencies_per_mm: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    object_distance_m: float | None = None,
    rings: int = 12,
    progress: Progress | None = None,
) -> ToleranceStudy:
    """Makes copies of a lens with random errors, sets their compensators, and evaluates them, on all cores.

    tolerances: Tolerances, or the name of a grade. compensators: "refocus", "film_tilt", an ElementShift. sharpest_by:
    figure of merit of the compensators, averaged over all fields: "mtf" at the middle frequency, or "spot", the mean
    square radius. seed: gives the same copies on any number of threads; a larger study starts with the same copies.
    fields_deg: angles towards +y, or (F, 2) towards x and y; None: the axis, and 0.7 of the field towards each corner
    of the film. frequencies_per_mm: None: 10, 20 and 40 for a film of 36 x 24 mm, scaled in proportion for others.
    wavelengths_nm: equally weighted; None: F line, design wavelength and C line. object_distance_m: from object to
    front vertex; None: the plane in focus. rings: number of rings of rays in the pupil.
    progress: called with the fraction done; the study ends if it returns False. An interrupt after the first copies
    also ends it: the study then holds the copies evaluated so far, and is_whole is False.
    Raises InputError for a tolerance or compensator that does not apply to this lens, and for a nominal lens without
    rotational symmetry or with a curved film.
    """
    limits = Tolerances.grade(tolerances) if isinstance(tolerances, str) else tolerances
    if not isinstance(limits, Tolerances):
        raise InputError("tolerances must be a realcam.Tolerances, or the name of a grade")
    copies = whole_number("copies", copies, 1, MAX_COPIES)
    seed = whole_number("seed", seed, 0)
    if sharpest_by not in ("mtf", "spot"):
        raise InputError(f'sharpest_by: "{sharpest_by!s:.40}" is unknown; expected mtf or spot')
    if not 2 <= rings <= 100:
        raise InputError(f"rings is {rings!r:.40}; expected 2 to 100")
    if not lens.is_rotational:
        raise InputError(f'tolerances need a rotationally symmetric lens; lens "{lens.name}" is not')
    if math.isfinite(lens.film_radius_of_curvature_mm):
        raise InputError(f'tolerances need a flat film; that of lens "{lens.name}" is curved')
    items = limits.of(lens)
    from ..analysis.fields import default_frequencies_per_mm, numbers_of, wavelengths_of  # brings matplotlib

    fields = _fields(lens, fields_deg)
    frequencies = (
        default_frequencies_per_mm(lens)
        if frequencies_per_mm is None
        else np.sort(numbers_of(frequencies_per_mm, "frequencies_per_mm"))
    )
    if not (frequencies > 0).all():
        raise InputError("frequencies_per_mm must be positive numbers")
    colours = wavelengths_of(lens, wavelengths_nm)
    selected = chosen(lens, compensators, fields)
    evaluator = _ToleranceEvaluator(
        lens,
        np.deg2rad(fields),
        object_distance_m,
        np.column_stack([colours, np.ones_like(colours)]),
        frequencies.tolist(),
        rings,
        selected.refocus,
        selected.film_tilt,
        float(frequencies[len(frequencies) // 2]) if sharpest_by == "mtf" else None,
        selected.shift_arguments,
    )
    errors = errors_of(items)
    nominal = CopyFigures.joined([evaluator.judge(errors, np.zeros((1, len(errors))))])
    sizes = drawn(items, limits.distribution, copies, seed)
    parts = _evaluated(evaluator, errors, sizes, progress)
    figures = CopyFigures.joined(parts)
    done = len(figures)
    return ToleranceStudy(
        lens,
        limits,
        items,
        seed,
        fields,
        frequencies,
        nominal,
        figures,
        sizes[:done],
        done == copies,
        selected,
        evaluator,
    )


def random_copy(lens: Lens, tolerances: Tolerances | str, *, seed: int | None = None) -> Lens:
    """Returns one copy of a lens with random errors, refocused as in a study. seed: None: a new one at each call.
    Raises InputError as tolerance_study does."""
    drawn_seed = random.SystemRandom().randrange(1 << 32) if seed is None else seed
    return tolerance_study(lens, tolerances, 1, seed=drawn_seed, rings=6).copy(0)


def _evaluated(
    evaluator: _ToleranceEvaluator, errors: list[tuple[str, int, int]], sizes: Doubles, progress: Progress | None
) -> list[dict[str, Doubles]]:
    """Figures of the copies with these error sizes, (C, E), in blocks; fewer if progress or an interrupt ends the
    study."""
    parts: list[dict[str, Doubles]] = []
    for first in range(0, len(sizes), BLOCK):
        try:
            parts.append(evaluator.judge(errors, sizes[first : first + BLOCK]))
            if progress is not None and progress(min(1.0, (first + BLOCK) / len(sizes))) is False:
                break
        except KeyboardInterrupt:
            if not parts:
                raise
            break
    return parts


def _fields(lens: Lens, fields_deg: ArrayLike | None) -> Doubles:
    """Field angles, (F, 2), degrees towards x and y."""
    if fields_deg is None:
        from ..analysis.fields import field_angles_deg

        angle = float(field_angles_deg(lens, [0.7])[0])
        width, height = lens.film_mm
        along = np.array([width, height]) / math.hypot(width, height)
        signs = np.array([[0, 0], [1, 1], [-1, 1], [1, -1], [-1, -1]])
        return np.asarray(angle * signs * along)
    fields = np.atleast_1d(np.asarray(fields_deg, float))
    if fields.ndim == 1:
        fields = np.column_stack([np.zeros_like(fields), fields])
    if fields.ndim != 2 or fields.shape[1] != 2 or len(fields) == 0 or not np.isfinite(fields).all():
        raise InputError("fields_deg must be angles, or pairs of angles towards x and y: finite numbers, at least one")
    return np.asarray(fields)
