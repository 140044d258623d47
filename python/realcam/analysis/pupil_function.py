"""The pupil as waves see it: phase and amplitude over direction cosines, and optical transfer functions from them."""

from __future__ import annotations

from dataclasses import dataclass

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
    raise InputError(
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


def transfer(
    pupil: PupilFunction,
    frequencies_per_mm: Doubles,
    *,
    tangential: bool,
    defocus_mm: Doubles | None = None,
    ideal: bool = False,
) -> np.ndarray:
    """(D, F), complex: the optical transfer function along y (tangential) or x, relative to the chief ray's film point.

    The pupil's autocorrelation (H. H. Hopkins, Proc. Roy. Soc. A 231, 91, 1955): the mean of A(p + s/2) A(p - s/2)
    exp(i (phase(p + s/2) - phase(p - s/2))) over the p at which both lie in the pupil, s = frequency x wavelength, over
    that of A^2. Lines along s cross the pupil at the nodes of Chebyshev's second kind, where a round edge makes their
    lengths smooth; on each line stand Gauss's nodes between the ends of the overlap. ideal: without aberrations, with
    an even amplitude.
    """
    planes = np.zeros(1) if defocus_mm is None else defocus_mm
    along = 1 if tangential else 0
    shifts = frequencies_per_mm / pupil.waves_per_cosine / pupil.half[along]
    for lines in (LINES, LINES_WITH_HOLE):
        turn = np.pi * (np.arange(lines) + 0.5) / lines
        ends = _ends(pupil.edge, np.cos(turn), along)
        if ends.shape[1] < 2:
            break
    line_weight = np.sin(turn) * np.pi / lines
    # Polynomials along each line, (3, power, line).
    tables = np.stack([pupil.phase, pupil.tilt, pupil.amplitude])
    if not tangential:
        tables = tables.swapaxes(1, 2)
    on_line = np.einsum("tij,li->tjl", tables, chebyshev.chebvander(np.cos(turn), tables.shape[1] - 1))
    if ideal:
        on_line[:] = 0
        on_line[2, 0] = 1
    whole = _overlap(on_line, ends, line_weight, np.zeros(1), planes[:1], 16)[0, 0].real
    sums = _overlap(on_line, ends, line_weight, shifts, planes, _nodes(on_line, shifts, planes))
    otf: np.ndarray = sums / whole
    return otf


def _nodes(on_line: Doubles, shifts: Doubles, planes: Doubles) -> int:
    """Gauss's rule follows a phase of z radians from its middle to either end with some z / 2 + 10 nodes."""
    v = np.linspace(-1, 1, 41)
    most = 0.0
    for plane in (planes.min(), planes.max()):
        slope = np.gradient(chebyshev.chebval(v, on_line[0] + plane * on_line[1]), v, axis=-1)
        typical = float(np.percentile(np.abs(slope - np.median(slope)), 97))
        most = max(most, typical)
    z = most * float(shifts.max(initial=0.0))
    return int(min(16 + 0.6 * z, 160))


def _overlap(
    on_line: Doubles, ends: Doubles, line_weight: Doubles, shifts: Doubles, planes: Doubles, nodes: int
) -> np.ndarray:
    """(D, F), complex: integrals over the overlap of the pupil with itself, shifted."""
    node, weight = np.polynomial.legendre.leggauss(nodes)
    total = np.zeros((len(planes), len(shifts)), dtype=complex)
    half_shift = 0.5 * shifts[:, None]
    stretches = ends.shape[1]
    for a in range(stretches):
        for b in range(stretches):
            low = np.maximum(ends[:, a, 0] + half_shift, ends[:, b, 0] - half_shift)  # (F, line)
            high = np.minimum(ends[:, a, 1] + half_shift, ends[:, b, 1] - half_shift)
            length = np.where(high > low, high - low, 0.0)
            if not length.any():
                continue
            middle = np.where(length > 0, 0.5 * (low + high), 0.0)
            place = middle[..., None] + 0.5 * length[..., None] * node  # (F, line, node)
            front = _values(on_line, place - half_shift[..., None])
            back = _values(on_line, place + half_shift[..., None])
            amplitude = front[2] * back[2] * weight * (0.5 * length * line_weight)[..., None]
            phase, tilt = back[0] - front[0], back[1] - front[1]
            for d, plane in enumerate(planes):
                turn = phase + plane * tilt if plane else phase
                total[d] += np.sum(amplitude * np.exp(1j * turn), axis=(1, 2))
    return total


def _values(on_line: Doubles, place: Doubles) -> Doubles:
    """(3, F, line, node): polynomials of each line at places on it, by Clenshaw's recurrence."""
    count = on_line.shape[1]
    if not on_line[:, 1:].any():
        return np.broadcast_to(on_line[:, 0, None, :, None], (3, *place.shape))
    coefficient = on_line[:, :, None, :, None]
    ahead, here = np.zeros((3, *place.shape)), np.zeros((3, *place.shape))
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
