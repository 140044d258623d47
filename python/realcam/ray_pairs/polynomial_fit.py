"""Polynomials from the rays behind a lens to those in front of it, for the table of the camera model polynomial.

Each vector of the ray is a x + b p, with the film point x and the point p of a plane behind the lens, both scaled to at
most 1. a and b are polynomials of the dot products x.x, p.p and x.p, as rotational symmetry demands (Hanika and
Dachsbacher 2014). z of position and direction, where they are fitted, are polynomials of the dot products themselves.
Coefficients are polynomials of the wavelength variable.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..dispersion import WavelengthVariable

Array = NDArray[np.float64]

_MOST_WAVELENGTH_TERMS = 4


def wavelength_variable(shortest_nm: float, longest_nm: float) -> WavelengthVariable:
    """Returns the variable that is -1 at the longest and 1 at the shortest measured wavelength; 0 if they are one."""
    return WavelengthVariable.between(longest_nm, -1, shortest_nm, 1)


def wavelength_terms(wavelengths: int) -> int:
    """Returns the number of powers of the variable for this number of distinct wavelengths."""
    return min(wavelengths, _MOST_WAVELENGTH_TERMS)


@dataclass(frozen=True)
class RayPolynomials:
    """Coefficients by the power of the wavelength variable, in the order of RayPairTable."""

    degree: int
    coefficients: Array  # (powers, terms, 2 vectors, 2): a and b of position and direction
    heights: Array | None  # (powers, terms, 2): z of position and direction

    def at(self, variable: float) -> tuple[Array, Array | None]:
        """Returns coefficients (terms, 2, 2) and heights (terms, 2) at a value of the wavelength variable."""
        powers = variable ** np.arange(len(self.coefficients))
        heights = None if self.heights is None else np.tensordot(powers, self.heights, 1)
        return np.tensordot(powers, self.coefficients, 1), heights


def monomials(x: Array, p: Array, degree: int) -> Array:
    """Returns (x.x)^i (p.p)^j (x.p)^k with i + j + k <= degree for N points, (N, terms): i changes slowest."""
    u, v, w = (x * x).sum(1), (p * p).sum(1), (x * p).sum(1)
    exponents = [(i, j, k) for i in range(degree + 1) for j in range(degree + 1 - i) for k in range(degree + 1 - i - j)]
    return np.column_stack([u**i * v**j * w**k for i, j, k in exponents])


def fitted(
    x: Array, p: Array, variable: Array, powers: int, position: Array, direction: Array, degree: int, *, is_wide: bool
) -> RayPolynomials:
    """Fits rays by least squares. position, direction: (N, 3). is_wide: fits z of both, too."""
    terms = monomials(x, p, degree)
    scalars = np.concatenate([terms * (variable**power)[:, None] for power in range(powers)], 1)
    vectors = np.concatenate(
        [np.concatenate([scalars * x[:, axis, None], scalars * p[:, axis, None]], 1) for axis in (0, 1)]
    )
    targets = np.column_stack([np.concatenate([values[:, 0], values[:, 1]]) for values in (position, direction)])
    found = np.linalg.lstsq(vectors, targets, rcond=None)[0].reshape(2, powers, terms.shape[1], 2)
    heights = None
    if is_wide:
        found_z = np.linalg.lstsq(scalars, np.column_stack([position[:, 2], direction[:, 2]]), rcond=None)[0]
        heights = found_z.reshape(powers, terms.shape[1], 2)
    return RayPolynomials(degree, found.transpose(1, 2, 3, 0), heights)


def evaluated(polynomials: RayPolynomials, x: Array, p: Array, variable: Array) -> tuple[Array, Array]:
    """Returns positions and unit directions (N, 3) in double precision; z of positions is NaN unless it was fitted."""
    terms = monomials(x, p, polynomials.degree)
    powers = variable[:, None] ** np.arange(len(polynomials.coefficients))
    sums = np.einsum("np,nt,ptvc->nvc", powers, terms, polynomials.coefficients, optimize=True)
    across = sums[:, :, :1] * x[:, None] + sums[:, :, 1:] * p[:, None]
    if polynomials.heights is None:
        z = -np.sqrt(np.clip(1 - (across[:, 1] ** 2).sum(1), 0, None))
        return np.column_stack([across[:, 0], np.full(len(x), np.nan)]), np.column_stack([across[:, 1], z])
    heights = np.einsum("np,nt,pth->nh", powers, terms, polynomials.heights, optimize=True)
    direction = np.column_stack([across[:, 1], heights[:, 1]])
    return np.column_stack([across[:, 0], heights[:, 0]]), direction / np.linalg.norm(direction, axis=1)[:, None]
