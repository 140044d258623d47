"""The pupil as waves see it: phase and amplitude over direction cosines, and optical transfer functions from them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from .._core import InputError, RayBundle
from .fields import Bundles, Doubles

# Degrees of the polynomials that are tried, with the spokes and nodes of the rays that they are fitted to.
FITS = ((10, 32, 6), (14, 48, 9), (20, 72, 13))
# A fit that is off by this much at its own rays is off by some 0.01 waves between them, as of a phone lens's aspheres.
GOOD_FIT_WAVES = 2e-4
LINES = 28
LINES_WITH_HOLE = 120  # lengths of lines have a kink where a line touches an inner edge


class UnevenWavefrontError(InputError):
    """No polynomial follows the wavefront: there is no transfer function, but that of rays alone."""


@dataclass(frozen=True)
class PupilFunction:
    """Amplitude and path over slopes (RayBundle.slopes), as polynomials of Chebyshev's in slopes scaled to -1 ... 1.

    phase, tilt, amplitude: (K, K), coefficients by powers of x and y: of the path in radians, of the change of the path
      for each mm of defocus in radians, of the amplitude.
    middle, half: (2,), of the scaling.
    edge: (M, 2, 2), pieces of the pupil's outline, scaled.
    waves_per_cosine: index over wavelength, 1/mm: a frequency divided by it is a shift in the pupil.
    fit_error_waves: root mean square that the fitted path is off.
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


def pupil_function(bundles: Bundles, field_deg: float, wavelength_nm: float) -> PupilFunction:
    """Of the degree that the wavefront wants. Raises InputError where no polynomial follows it."""
    for degree, spokes, nodes in FITS:
        fitted = fit_pupil(bundles.at(field_deg, wavelength_nm, spokes, nodes), degree)
        if fitted.fit_error_waves < GOOD_FIT_WAVES:
            return fitted
    # A tenth of a wave changes the contrast of what is left of so strong aberrations by less than can be seen.
    if fitted.fit_error_waves < 0.1:
        return fitted
    raise UnevenWavefrontError(
        f"the wavefront at {field_deg:.6g} deg is too uneven for a transfer function "
        f"(a polynomial is {fitted.fit_error_waves:.2g} waves off); the method geometric takes rays alone"
    )


def fit_pupil(bundle: RayBundle, degree: int) -> PupilFunction:
    """By least squares over the rays. Of a pupil that is its own mirror image one half, and even powers of x, do."""
    count = len(bundle.energy) // 2 if bundle.mirrored else len(bundle.energy)
    corners = bundle.edge_slopes.reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    if bundle.mirrored:
        middle[0] = 0
    at = (bundle.slopes[:count] - middle) / half
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i) if not (bundle.mirrored and i % 2)]
    i, j = np.array(powers).T
    basis = chebyshev.chebvander(at[:, 0], degree)[:, i] * chebyshev.chebvander(at[:, 1], degree)[:, j]
    wave_number = 2e6 * np.pi * bundle.index / bundle.wavelength_nm
    wanted = np.column_stack(
        [wave_number * bundle.path_mm[:count], wave_number * bundle.directions[:count, 2], bundle.amplitude[:count]]
    )
    solution, *_ = np.linalg.lstsq(basis, wanted, rcond=1e-10)
    off = (basis @ solution[:, 0] - wanted[:, 0]) / (2 * np.pi)
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
        float(np.sqrt(np.sum(energy * off**2) / np.sum(energy))),
    )


@dataclass(frozen=True)
class Lines:
    """Lines along one direction across a pupil, at the nodes of Chebyshev's second kind, where a round edge makes their
    lengths smooth.

    places: (L,), where they cross the other direction; weight: (L,), of each in an integral across them.
    ends: (L, stretch, 2), between which places each lies in the pupil; nan where it does not.
    """

    along: int
    places: Doubles
    weight: Doubles
    ends: Doubles

    def overlaps(self, shifts: Doubles) -> Iterator[tuple[Doubles, Doubles]]:
        """Middles and lengths, (F, L) each, of where the pupil overlaps itself shifted, for each pair of stretches."""
        half = 0.5 * shifts[:, None]
        count = self.ends.shape[1]
        for a in range(count):
            for b in range(count):
                low = np.maximum(self.ends[:, a, 0] + half, self.ends[:, b, 0] - half)
                high = np.minimum(self.ends[:, a, 1] + half, self.ends[:, b, 1] - half)
                there = high > low
                if there.any():
                    yield np.where(there, 0.5 * (low + high), 0.0), np.where(there, high - low, 0.0)


def lines_of(pupil: PupilFunction, *, tangential: bool) -> Lines:
    along = 1 if tangential else 0
    for count in (LINES, LINES_WITH_HOLE):
        turn = np.pi * (np.arange(count) + 0.5) / count
        ends = _ends(pupil.edge, np.cos(turn), along)
        if ends.shape[1] < 2:
            break
    return Lines(along, np.cos(turn), np.sin(turn) * np.pi / count, ends)


def transfer_limit(pupil: PupilFunction, lines: Lines, frequencies_per_mm: Doubles) -> Doubles:
    """(F,): the transfer function without aberrations and with an even amplitude: the share of the pupil on which it
    overlaps itself, shifted by frequency x wavelength."""
    shifts = frequencies_per_mm / pupil.waves_per_cosine / pupil.half[lines.along]
    areas = [np.zeros(len(shifts)), np.zeros(1)]
    for area, by in zip(areas, (shifts, np.zeros(1)), strict=True):
        for _, length in lines.overlaps(by):
            area += length @ lines.weight
    share: Doubles = areas[0] / areas[1]
    return share


def transfer(
    pupil: PupilFunction, lines: Lines, frequencies_per_mm: Doubles, defocus_mm: Doubles | None = None
) -> np.ndarray:
    """(D, F), complex: the optical transfer function along the lines, relative to the chief ray's film point.

    The pupil's autocorrelation (H. H. Hopkins, Proc. Roy. Soc. A 231, 91, 1955): the mean of A(p + s/2) A(p - s/2)
    exp(i (phase(p + s/2) - phase(p - s/2))) over the p at which both lie in the pupil, s = frequency x wavelength, over
    that of A^2. On each line stand Gauss's nodes between the ends of the overlap.
    """
    planes = np.zeros(1) if defocus_mm is None else defocus_mm
    shifts = frequencies_per_mm / pupil.waves_per_cosine / pupil.half[lines.along]
    # Polynomials along each line, (3, power, line).
    tables = np.stack([pupil.phase, pupil.amplitude, pupil.tilt])
    if not planes.any():
        tables = tables[:2]  # no plane asks for the change by defocus
    if lines.along == 0:
        tables = tables.swapaxes(1, 2)
    on_line = np.einsum("tij,li->tjl", tables, chebyshev.chebvander(lines.places, tables.shape[1] - 1))
    whole = _overlap(on_line, lines, np.zeros(1), np.zeros(1), 16)[0, 0].real
    otf: np.ndarray = _overlap(on_line, lines, shifts, planes, _nodes(on_line, shifts, planes)) / whole
    return otf


def _nodes(on_line: Doubles, shifts: Doubles, planes: Doubles) -> int:
    """Gauss's rule follows a phase of z radians from its middle to either end with some z / 2 + 10 nodes."""
    v = np.linspace(-1, 1, 33)
    most = 0.0
    for plane in {planes.min(), planes.max()}:
        phase = on_line[0] + plane * on_line[2] if plane else on_line[0]
        rise = np.diff(chebyshev.chebval(v, phase), axis=-1) / (v[1] - v[0])
        most = max(most, float(rise.std()))
    # Three standard deviations of the slope: what is steeper is little of the pupil.
    wanted = 16 + 1.5 * most * float(shifts.max(initial=0.0))
    return next((count for count in (16, 20, 24, 32, 48, 72, 108) if count >= wanted), 160)


@cache
def _gauss(nodes: int) -> tuple[Doubles, Doubles]:
    return np.polynomial.legendre.leggauss(nodes)


def _overlap(on_line: Doubles, lines: Lines, shifts: Doubles, planes: Doubles, nodes: int) -> np.ndarray:
    """(D, F), complex: integrals over the overlap of the pupil with itself, shifted."""
    node, weight = _gauss(nodes)
    total = np.zeros((len(planes), len(shifts)), dtype=complex)
    half_shift = 0.5 * shifts[:, None, None]
    for middle, length in lines.overlaps(shifts):
        place = middle[..., None] + 0.5 * length[..., None] * node  # (F, line, node)
        front = _values(on_line, place - half_shift)
        back = _values(on_line, place + half_shift)
        amplitude = front[1] * back[1] * weight * (0.5 * length * lines.weight)[..., None]
        phase = back[0] - front[0]
        for d, plane in enumerate(planes):
            turn = phase + plane * (back[2] - front[2]) if plane else phase
            total[d] += np.sum(amplitude * np.exp(1j * turn), axis=(1, 2))
    return total


def _values(on_line: Doubles, place: Doubles) -> Doubles:
    """(table, F, line, node): polynomials of each line at places on it, by Clenshaw's recurrence."""
    count = on_line.shape[1]
    coefficient = on_line[:, :, None, :, None]
    ahead, here = np.zeros((2, len(on_line), *place.shape))
    double = 2 * place
    for k in range(count - 1, 0, -1):
        ahead, here = here, coefficient[:, k] + double * here - ahead
    values: Doubles = coefficient[:, 0] + place * here - ahead
    return values


def _ends(edge: Doubles, lines: Doubles, along: int) -> Doubles:
    """(line, stretch, 2): between which places each line lies in the pupil; nan where it does not."""
    across = 1 - along
    start, end = edge[:, 0], edge[:, 1]
    rise = end[:, across] - start[:, across]
    before, behind = start[:, across] <= lines[:, None], end[:, across] <= lines[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        share = (lines[:, None] - start[:, across]) / rise
        place = start[:, along] + share * (end[:, along] - start[:, along])
    crossings = np.sort(np.where(before != behind, place, np.nan), axis=1)  # nan comes last
    most = int(np.isfinite(crossings).sum(axis=1).max(initial=0))
    most += most % 2
    return crossings[:, :most].reshape(len(lines), most // 2, 2)
