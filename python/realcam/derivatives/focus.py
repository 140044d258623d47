"""How the film follows a lens that changes and is focused again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._core import Lens
from ..variable import Variable
from .dual_array import Doubles
from .field_light import field_light


def film_distance_by(lens: Lens, variables: Sequence[Variable]) -> Doubles:
    """(V,): derivatives of the film's distance of a lens that moves as a whole to focus, and is in focus.

    The film stands where the spot on the axis is smallest, z = -sum(x m) / sum(m^2) for rays x + m z. With a near
    object z depends on the film too, from which the object's distance counts.
    """
    all_variables = [*variables, Variable.film_distance()]
    light = field_light(lens, all_variables, 0.0, lens.wavelength_nm, pattern="rings")
    passes = light.passes[:-1]
    share = light.weights[passes]
    o, p = light.origins[:-1][passes], light.directions[:-1][passes]
    mx, my = p[:, 0] / p[:, 2], p[:, 1] / p[:, 2]
    x, y = o[:, 0] - o[:, 2] * mx, o[:, 1] - o[:, 2] * my
    z = -(x * mx + y * my).sum(share) / (mx * mx + my * my).sum(share)
    by: Doubles = np.asarray(z.by[:-1] / (1 - z.by[-1]))
    return by
