"""Derivatives of the best-focus film distance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._core import Lens
from .dual_array import Doubles
from .field_light import field_light
from .variable import Variable


def film_distance_by(lens: Lens, variables: Sequence[Variable]) -> Doubles:
    """(V,): derivatives of the film distance of a focused lens that focuses by moving as a whole.

    The film is at the smallest axial spot, z = -sum(x m) / sum(m^2) for rays x + m z. For a near object z depends on
    the film, too, because the object distance is measured from it.
    """
    all_variables = [*variables, Variable.film_distance()]
    light = field_light(lens, all_variables, 0.0, lens.wavelength_nm, pattern="rings")
    passes = light.passes[:-1]
    weights = light.weights[passes]
    o, p = light.origins[:-1][passes], light.directions[:-1][passes]
    mx, my = p[:, 0] / p[:, 2], p[:, 1] / p[:, 2]
    x, y = o[:, 0] - o[:, 2] * mx, o[:, 1] - o[:, 2] * my
    z = -(x * mx + y * my).sum(weights) / (mx * mx + my * my).sum(weights)
    by: Doubles = np.asarray(z.by[:-1] / (1 - z.by[-1]))
    return by
