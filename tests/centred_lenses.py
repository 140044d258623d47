"""The bundled lenses that closed forms and paraxial equations describe: centred, of revolution, with a flat film."""

from __future__ import annotations

import math

import realcam as rc


def is_centred(lens: rc.Lens) -> bool:
    return lens.is_rotational and math.isinf(lens.film_radius_of_curvature_mm)


CENTRED = [name for name in rc.lens_names() if is_centred(rc.Lens.load(name))]
