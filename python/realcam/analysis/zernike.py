"""Zernike polynomials, orthonormal on the unit disc, in Noll or fringe order, and fits to wavefronts."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import InputError, Lens
from ..short_text import ShortText
from . import style
from .fields import Doubles

ORDERS = ("noll", "fringe")
_FIRST = {(0, 0): "piston", (1, 1): "tilt x", (1, -1): "tilt y", (2, 0): "defocus"}
_FAMILIES = ("spherical", "coma", "astigmatism", "trefoil", "tetrafoil", "pentafoil", "hexafoil", "heptafoil")
_ORDINALS = ("", "secondary ", "tertiary ", "quaternary ")


def name_of(n: int, m: int) -> str:
    """Name of the polynomial of radial degree n and azimuthal frequency m; "n, m" if it has no common one."""
    if (n, m) in _FIRST:
        return _FIRST[n, m]
    # Tilt (|m| = 1) precedes primary coma, piston and defocus (m = 0) precede primary spherical aberration.
    ordinal = (n - abs(m)) // 2 - max(2 - abs(m), 0)
    if abs(m) >= len(_FAMILIES) or ordinal >= len(_ORDINALS):
        return f"{n}, {m:+d}"
    if m == 0:
        orientation = ""
    elif m % 2:
        orientation = " x" if m > 0 else " y"
    else:
        orientation = " 0°" if m > 0 else f" {90 / -m:g}°"
    return f"{_ORDINALS[ordinal]}{_FAMILIES[abs(m)]}{orientation}"


def noll(j: int) -> tuple[int, int]:
    """(n, m) of the Noll index j >= 1; m < 0: sine (R. J. Noll, J. Opt. Soc. Am. 66, 207, 1976)."""
    n = (math.isqrt(8 * j - 7) - 1) // 2
    position = j - n * (n + 1) // 2 - 1  # position among the n + 1 terms of this n
    m = 1 + 2 * (position // 2) if n % 2 else 2 * ((position + 1) // 2)
    return n, m if j % 2 == 0 else -m


def fringe(j: int) -> tuple[int, int]:
    """(n, m) of the fringe index j >= 1: ordered by (n + |m|) / 2, then by falling |m|, cosine before sine."""
    group = math.isqrt(j - 1)
    position = j - 1 - group**2
    m = group - position // 2
    return 2 * group - m, -m if position % 2 else m


def term(n: int, m: int, x: Doubles, y: Doubles) -> Doubles:
    """The polynomial at points of the unit disc, with a mean square of 1 over it. Angles are from x towards y."""
    radius2 = x * x + y * y
    k = (n - abs(m)) // 2
    radial = np.zeros_like(x)
    for s in range(k + 1):  # R_n^m / r^|m|, highest power first
        factor = (-1) ** s * math.comb(n - s, s) * math.comb(n - 2 * s, k - s)
        radial = radial + factor * radius2 ** (k - s)
    rotated = (x + 1j * y) ** abs(m)  # r^|m| exp(i |m| angle)
    angular = rotated.imag if m < 0 else rotated.real
    result: Doubles = math.sqrt((2 if m else 1) * (n + 1)) * radial * angular
    return result


@dataclass(frozen=True, repr=False)
class ZernikeFit(ShortText):
    """Result of fit_zernike(): K coefficients fitted to N points of a wavefront.

    order: "noll" or "fringe"; indices: (K,), j in that order; nm: K pairs (n, m), m < 0 for sine; names: K names.
    coefficients_waves: (K,), of polynomials that are orthonormal on the unit disc: over a full circular pupil the
      square of each is its contribution to the mean square. Fringe coefficients of programs whose polynomials are 1 at
      the edge are larger by the root of (n + 1) (m = 0) or 2 (n + 1).
    residual_waves: RMS of the residuals.
    pupil: (N, 2), the points; residuals_waves: (N,), nan for rays that do not pass.
    field_deg: of the lens's wavefront; nan for a fit to given values.
    """

    order: str
    indices: np.ndarray
    nm: tuple[tuple[int, int], ...]
    names: tuple[str, ...]
    coefficients_waves: Doubles
    residual_waves: float
    pupil: Doubles
    residuals_waves: Doubles
    field_deg: float = math.nan

    def at(self, pupil: ArrayLike) -> Doubles:
        """(N,): the fitted sum, in waves, at points (N, 2) of the pupil."""
        points = np.asarray(pupil, dtype=float)
        basis = [term(n, m, points[:, 0], points[:, 1]) for n, m in self.nm]
        value: Doubles = np.column_stack(basis) @ self.coefficients_waves
        return value


def fit_zernike(
    pupil: ArrayLike, opd_waves: ArrayLike, *, weights: ArrayLike | None = None, order: str = "noll", terms: int = 37
) -> ZernikeFit:
    """Least-squares fit over the points with finite values, that is, over the real pupil, even if it is vignetted.

    pupil: (N, 2), x and y; opd_waves: (N,), nan if undefined; weights: (N,), fractions of the area.
    Raises InputError for an unknown order, if there are fewer points than terms, or if terms are linearly dependent.
    """
    if order not in ORDERS:
        raise InputError(f'unknown order "{order}"; expected noll or fringe')
    if not 1 <= terms <= 231:
        raise InputError("terms must lie between 1 and 231")
    points, values = np.asarray(pupil, dtype=float), np.asarray(opd_waves, dtype=float)
    areas = np.ones(len(values)) if weights is None else np.asarray(weights, dtype=float)
    if points.shape != (len(values), 2) or areas.shape != values.shape:
        raise InputError("pupil must be of shape (N, 2), opd_waves and weights of shape (N,)")
    nm = tuple((noll if order == "noll" else fringe)(j) for j in range(1, terms + 1))
    passes = np.isfinite(values)
    if passes.sum() < terms:
        raise InputError(f"{terms} terms cannot be fitted to {passes.sum()} rays; use more rays, or fewer terms")
    x, y = points[passes].T
    basis = np.column_stack([term(n, m, x, y) for n, m in nm])
    root = np.sqrt(areas[passes])
    coefficients, _, rank, _ = np.linalg.lstsq(root[:, None] * basis, root * values[passes], rcond=None)
    if rank < terms:
        raise InputError(f"{terms} terms are linearly dependent on this pupil; use fewer")
    residuals = np.full(len(values), np.nan)
    residuals[passes] = values[passes] - basis @ coefficients
    rms = float(np.sqrt(np.sum(areas[passes] * residuals[passes] ** 2) / np.sum(areas[passes])))
    names = tuple(name_of(*pair) for pair in nm)
    return ZernikeFit(order, np.arange(1, terms + 1), nm, names, coefficients, rms, points, residuals)


def zernike_fit(
    lens: Lens,
    field_deg: float = 0.0,
    *,
    wavelength_nm: float | None = None,
    order: str = "noll",
    terms: int = 37,
    samples: int = 48,
    object_distance_m: float | None = None,
) -> ZernikeFit:
    """Fit of a lens's wavefront over its real stop, whose radius is normalised to 1.

    order, terms: as for fit_zernike. samples: as for Lens.wavefront. Defaults: the design wavelength; the plane in
    focus. Raises InputError as fit_zernike does, and if no light passes.
    """
    front = lens.wavefront(field_deg, wavelength_nm=wavelength_nm, object_distance_m=object_distance_m, samples=samples)
    fit = fit_zernike(front.pupil, front.opd_waves, weights=front.weights, order=order, terms=terms)
    return replace(fit, field_deg=field_deg)


def plot_zernike_fit(fit: ZernikeFit, axes: Axes) -> None:
    """Plots named bars of the coefficients without piston; only the largest ones if space is short."""
    height_pt = 72 * axes.get_window_extent().height / axes.figure.dpi
    max_bars = max(int(height_pt / (1.15 * style.tick_size_pt())), 1)
    size = np.abs(fit.coefficients_waves[1:])
    chosen = np.sort(1 + np.argsort(-size)[:max_bars])
    positions = np.arange(len(chosen))
    axes.barh(positions, fit.coefficients_waves[chosen], color=style.BLUE, linewidth=0)
    style.zero_lines(axes, y=False)
    axes.set_yticks(positions, [f"{fit.names[k]}  {fit.indices[k]}" for k in chosen])
    axes.set_ylim(len(chosen) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    axes.set_ylabel(f"{'Noll' if fit.order == 'noll' else 'fringe'} index")
    axes.set_xlabel(f"coefficient / waves RMS; residual {fit.residual_waves:.2g}")
    field = "" if math.isnan(fit.field_deg) else f" at {fit.field_deg:.3g}°"
    largest = "" if len(chosen) == len(size) else f", the {len(chosen)} largest"
    axes.set_title(f"Zernike polynomials{field}{largest}")
    axes.grid(visible=False, axis="y")
