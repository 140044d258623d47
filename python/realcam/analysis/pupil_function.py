"""Pupil functions: phase and amplitude over direction cosines, and the optical transfer functions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.linalg

from .._core import InputError, RayBundle
from ..fields import FieldPosition, field_text
from ..short_text import ShortText
from .fields import Bundles, Doubles

# (polynomial degree, radial scan lines, nodes per line of the rays that it is fitted to), in the order of trial.
FITS = ((10, 32, 6), (14, 48, 9), (20, 72, 13))
# A fit with this error at its rays may have an error of some 0.01 waves between them, as for aspheric phone lenses.
GOOD_FIT_WAVES = 2e-4
LINES = 28  # parallel lines over the pupil, for the integral across them
LINES_WITH_HOLE = (
    120  # for pupils with a central obstruction: chord lengths have a kink where a line touches an inner edge
)


class UnevenWavefrontError(InputError):
    """No polynomial fits the wavefront, so only the geometric transfer function is available."""


@dataclass(frozen=True, repr=False)
class PupilFunction(ShortText):
    """Amplitude and optical path over RayBundle.slopes, as Chebyshev polynomials in slopes scaled to -1 ... 1.

    phase, tilt, amplitude: (K, K), coefficients by degree in x and y: of the path in radians, of the path's change in
      radians per mm of defocus, and of the amplitude.
    middle, half: (2,), centre and half width of the slopes before scaling.
    edge: (M, 2, 2), segments of the pupil's outline from start to end, scaled.
    waves_per_cosine: index over wavelength, 1/mm: a frequency divided by it is a shift in the pupil.
    chief_ray_mm: (2,), film point of the chief ray, to which the path refers.
    fit_error_waves: RMS error of the fitted path.
    mirrored: True if the pupil is mirror-symmetric in x.
    """

    phase: Doubles
    tilt: Doubles
    amplitude: Doubles
    middle: Doubles
    half: Doubles
    edge: Doubles
    waves_per_cosine: float
    chief_ray_mm: Doubles
    fit_error_waves: float
    mirrored: bool


def pupil_function(bundles: Bundles, field: FieldPosition, wavelength_nm: float) -> PupilFunction:
    """Pupil function of a field point by polynomials of the lowest sufficient degree.

    Raises UnevenWavefrontError if the highest degree does not suffice, and InputError if no light passes.
    """
    for degree, arms, nodes in FITS:
        fitted = fit_pupil(bundles.at(field, wavelength_nm, arms, nodes), degree)
        if fitted.fit_error_waves < GOOD_FIT_WAVES:
            return fitted
    # With aberrations that strong little contrast is left, and an error of 0.1 waves changes it invisibly.
    if fitted.fit_error_waves < 0.1:
        return fitted
    raise UnevenWavefrontError(
        f"the wavefront at {field_text(field)} is too uneven for a transfer function "
        f"(a polynomial is {fitted.fit_error_waves:.2g} waves off); use the method geometric"
    )


def fit_pupil(bundle: RayBundle, degree: int) -> PupilFunction:
    """Least-squares fit of polynomials of total degree `degree` over the rays of a bundle.

    Mirror-symmetric pupils use half of the rays, and even degrees in x.
    """
    count = len(bundle.energy) // 2 if bundle.mirrored else len(bundle.energy)
    corners = bundle.edge_slopes.reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    if bundle.mirrored:
        middle[0] = 0
    scaled = (bundle.slopes[:count] - middle) / half
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i) if not (bundle.mirrored and i % 2)]
    i, j = np.array(powers).T
    basis = _chebyshev_table(scaled[:, 0], degree)[:, i] * _chebyshev_table(scaled[:, 1], degree)[:, j]
    wave_number = 2e6 * np.pi * bundle.index / bundle.wavelength_nm
    samples = np.column_stack(  # of phase, tilt and amplitude
        [wave_number * bundle.path_mm[:count], wave_number * bundle.directions[:count, 2], bundle.amplitude[:count]]
    )
    # gelsy (complete orthogonal factorisation) takes less than half the time of singular values.
    solution, *_ = scipy.linalg.lstsq(basis, samples, cond=1e-10, lapack_driver="gelsy", check_finite=False)
    error_waves = (basis @ solution[:, 0] - samples[:, 0]) / (2 * np.pi)
    energy = bundle.energy[:count]
    coefficients = np.zeros((3, degree + 1, degree + 1))
    coefficients[:, i, j] = solution.T
    return PupilFunction(
        coefficients[0],
        coefficients[1],
        coefficients[2],
        middle,
        half,
        (bundle.edge_slopes - middle) / half,
        1e6 * bundle.index / bundle.wavelength_nm,
        np.array(bundle.chief_ray_mm),
        float(np.sqrt(np.sum(energy * error_waves**2) / np.sum(energy))),
        bundle.mirrored,
    )


@dataclass(frozen=True, repr=False)
class Lines(ShortText):
    """Parallel chords of a pupil at Chebyshev nodes, at which the chord lengths of a round edge are smooth.

    along: the axis that the lines are parallel to, 0 (x) or 1 (y).
    positions: (L,), coordinates on the other axis; weight: (L,), quadrature weights across the lines.
    ends: (L, interval, 2), ends of each line's intervals inside the pupil; nan if there are fewer.
    even: True if each line is mirror-symmetric and has a single interval.
    """

    along: int
    positions: Doubles
    weight: Doubles
    ends: Doubles
    even: bool

    def overlaps(self, shifts: Doubles) -> Iterator[tuple[Doubles, Doubles]]:
        """Yields centres and lengths, (F, L) each, of the pupil's overlap with its shifted copy.

        shifts: (F,), along the lines. One pair of arrays for each pair of intervals that overlap anywhere; the length
        is 0 where they do not.
        """
        half = 0.5 * shifts[:, None]
        count = self.ends.shape[1]
        for a in range(count):
            for b in range(count):
                low = np.maximum(self.ends[:, a, 0] + half, self.ends[:, b, 0] - half)
                high = np.minimum(self.ends[:, a, 1] + half, self.ends[:, b, 1] - half)
                overlap = high > low
                if overlap.any():
                    yield np.where(overlap, 0.5 * (low + high), 0.0), np.where(overlap, high - low, 0.0)


def lines_of(pupil: PupilFunction, *, tangential: bool) -> Lines:
    """Lines over a pupil along y (tangential) or x (sagittal), LINES of them, or LINES_WITH_HOLE if some have several
    intervals."""
    along = 1 if tangential else 0
    for count in (LINES, LINES_WITH_HOLE):
        angle = np.pi * (np.arange(count) + 0.5) / count
        weight = np.sin(angle) * np.pi / count
        if pupil.mirrored and tangential:  # lines on one side represent both sides
            angle, weight = angle[: count // 2], 2 * weight[: count // 2]
        ends = _ends(pupil.edge, np.cos(angle), along)
        if ends.shape[1] < 2:
            break
    return Lines(along, np.cos(angle), weight, ends, pupil.mirrored and not tangential and ends.shape[1] < 2)


def transfer_limit(pupil: PupilFunction, lines: Lines, frequencies_per_mm: Doubles) -> Doubles:
    """(F,): transfer function without aberrations and with uniform amplitude: the fraction of the pupil that overlaps
    its copy, shifted by frequency x wavelength."""
    shifts = frequencies_per_mm / pupil.waves_per_cosine / pupil.half[lines.along]
    areas = [np.zeros(len(shifts)), np.zeros(1)]
    for area, area_shifts in zip(areas, (shifts, np.zeros(1)), strict=True):
        for _, length in lines.overlaps(area_shifts):
            area += length @ lines.weight
    limit: Doubles = areas[0] / areas[1]
    return limit


def transfer(
    pupil: PupilFunction, lines: Lines, frequencies_per_mm: Doubles, defocus_mm: Doubles | None = None
) -> np.ndarray:
    """(D, F): complex optical transfer function along the lines, relative to the chief ray's film point.

    The pupil's autocorrelation (H. H. Hopkins, Proc. Roy. Soc. A 231, 91, 1955): the mean of A(p + s/2) A(p - s/2)
    exp(i (phase(p + s/2) - phase(p - s/2))) over the p for which both points lie in the pupil, s = frequency x
    wavelength, divided by that of A^2. Each line is integrated by Gauss-Legendre nodes within the overlap.
    """
    planes = np.zeros(1) if defocus_mm is None else defocus_mm
    shifts = frequencies_per_mm / pupil.waves_per_cosine / pupil.half[lines.along]
    # Coefficients of phase, amplitude and tilt: first over the pupil, then as polynomials along each line.
    tables = np.stack([pupil.phase, pupil.amplitude, pupil.tilt])
    if not planes.any():
        tables = tables[:2]  # without defocus the tilt is not needed
    if lines.along == 0:
        tables = tables.swapaxes(1, 2)
    # (3, degree + 1, line)
    on_line = np.einsum("tij,li->tjl", tables, _chebyshev_table(lines.positions, tables.shape[1] - 1))
    energy = _energy(on_line, lines)
    otf: np.ndarray = _overlap(on_line, lines, shifts, planes, _nodes(on_line, shifts, planes)) / energy
    return otf


def _nodes(on_line: Doubles, shifts: Doubles, planes: Doubles) -> int:
    """Number of Gauss nodes: a phase of z radians from the centre to either end needs about z / 2 + 10."""
    slopes = _slope_table(on_line.shape[1] - 1)
    steepest = 0.0
    for plane in {planes.min(), planes.max()}:
        phase = on_line[0] + plane * on_line[2] if plane else on_line[0]
        steepest = max(steepest, float((slopes @ phase).std()))
    # Three standard deviations of the slope: only a small part of the pupil is steeper.
    required = 16 + 1.5 * steepest * float(shifts.max(initial=0.0))
    return next((count for count in (16, 20, 24, 32, 48, 72, 108) if count >= required), 160)


@cache
def _slope_table(degree: int) -> Doubles:
    """(32, degree + 1): mean slopes of the Chebyshev polynomials between 33 points from -1 to 1."""
    positions = np.linspace(-1, 1, 33)
    slopes: Doubles = np.diff(_chebyshev_table(positions, degree), axis=0) / (positions[1] - positions[0])
    return slopes


def _chebyshev_table(positions: Doubles, degree: int) -> Doubles:
    """(N, degree + 1): Chebyshev polynomials T_k(x); numpy's chebvander takes several times as long."""
    table = np.empty((degree + 1, len(positions)))
    table[0] = 1
    table[1] = positions
    double = 2 * positions
    for k in range(2, degree + 1):
        table[k] = double * table[k - 1] - table[k - 2]
    by_position: Doubles = table.T
    return by_position


@cache
def _gauss(nodes: int) -> tuple[Doubles, Doubles]:
    """Nodes and weights of Gauss-Legendre quadrature on -1 ... 1."""
    return np.polynomial.legendre.leggauss(nodes)


def _energy(on_line: Doubles, lines: Lines) -> float:
    """Integral of the squared amplitude over the pupil."""
    node, weight = _gauss(16)
    total = 0.0
    for middle, length in lines.overlaps(np.zeros(1)):
        (amplitude,) = _values(on_line[1:2], middle[..., None] + 0.5 * length[..., None] * node)
        total += float(np.sum(amplitude**2 @ weight * (0.5 * length * lines.weight)))
    return total


def _overlap(on_line: Doubles, lines: Lines, shifts: Doubles, planes: Doubles, nodes: int) -> np.ndarray:
    """(D, F): complex integrals over the overlap of the pupil with its shifted copy.

    on_line: (3, degree + 1, line), coefficients of phase, amplitude and tilt along the lines; without the tilt if all
    planes are 0. planes: (D,), defocus in mm. nodes: even number of Gauss nodes for each line.
    """
    node, weight = _gauss(nodes)
    if lines.even:  # the other half of a line has the same cosine, and the opposite sine
        node, weight = node[nodes // 2 :], 2 * weight[nodes // 2 :]
    total = np.zeros((len(planes), len(shifts)), dtype=complex)
    half_shift = 0.5 * shifts[:, None, None]
    for middle, length in lines.overlaps(shifts):
        position = middle[..., None] + 0.5 * length[..., None] * node  # (F, line, node)
        front = _values(on_line, position - half_shift)
        back = _values(on_line, position + half_shift)
        amplitude = front[1] * back[1] * weight * (0.5 * length * lines.weight)[..., None]
        phase = back[0] - front[0]
        for d, plane in enumerate(planes):
            defocused = phase + plane * (back[2] - front[2]) if plane else phase
            # Cosine and sine of reals take half the time of a complex exponential.
            total.real[d] += np.sum(amplitude * np.cos(defocused), axis=(1, 2))
            if not lines.even:
                total.imag[d] += np.sum(amplitude * np.sin(defocused), axis=(1, 2))
    return total


def _values(on_line: Doubles, position: Doubles) -> Doubles:
    """(table, F, line, node): polynomials of each line at points on it, by Clenshaw's recurrence.

    on_line: (table, degree + 1, line), coefficients; position: (F, line, node).
    """
    coefficient = on_line[:, :, None, :, None]
    ahead, here, free = np.zeros((3, len(on_line), *position.shape))
    double = 2 * position
    for k in range(on_line.shape[1] - 1, 0, -1):
        np.multiply(double, here, out=free)  # in place: allocating arrays would take as long as the sums
        free -= ahead
        free += coefficient[:, k]
        ahead, here, free = here, free, ahead
    np.multiply(position, here, out=free)
    free -= ahead
    free += coefficient[:, 0]
    values: Doubles = free
    return values


def _ends(edge: Doubles, lines: Doubles, along: int) -> Doubles:
    """(line, interval, 2): ends of each line's intervals inside the pupil; nan if there are fewer.

    edge: (M, 2, 2), segments of the outline; lines: (line,), coordinates across; along: axis of the lines, 0 or 1.
    """
    across = 1 - along
    start, end = edge[:, 0], edge[:, 1]
    line, piece = np.nonzero((start[:, across] <= lines[:, None]) != (end[:, across] <= lines[:, None]))
    start, end = start[piece], end[piece]
    t = (lines[line] - start[:, across]) / (end[:, across] - start[:, across])
    position = start[:, along] + t * (end[:, along] - start[:, along])
    count = np.bincount(line, minlength=len(lines))
    largest = int(count.max(initial=0))
    largest += largest % 2
    crossings = np.full((len(lines), largest), np.nan)
    crossings[line, np.arange(len(line)) - (np.cumsum(count) - count)[line]] = position
    crossings.sort(axis=1)  # nan comes last
    ends: Doubles = crossings.reshape(len(lines), largest // 2, 2)
    return ends
