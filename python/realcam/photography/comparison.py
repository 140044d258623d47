"""Summaries of lenses for their comparison."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import Lens
from ..fields import Field, area_weighted_spot, fields_at
from ..section.cut import Cut
from ..section.outlines import elements_of
from ..short_text import ShortText
from .figures import PhotographicFigures, photographic_figures


@dataclass(frozen=True, repr=False)
class FieldFigures(ShortText):
    """Sharpness at one field point, in the plane in focus."""

    field: Field
    rms_spot_radius_um: float  #: about the centroid, at the design wavelength
    mtf_tangential: NDArray[np.float64] | None  #: with diffraction, at the requested frequencies; None: not requested
    mtf_sagittal: NDArray[np.float64] | None


@dataclass(frozen=True, repr=False)
class LensSummary(ShortText):
    """Data of a lens for comparison with another."""

    lens: Lens
    figures: PhotographicFigures
    length_mm: float  #: distance from the foremost vertex to the film
    element_count: int  #: number of glass elements
    fields: tuple[FieldFigures, ...]
    mtf_frequencies_per_mm: tuple[float, ...]


def lens_summary(
    lens: Lens,
    *,
    shares: Sequence[float] = (0.0, 0.7, 1.0),
    mtf_frequencies_per_mm: Sequence[float] = (),
    circle_of_confusion_mm: float | None = None,
) -> LensSummary:
    """Returns photographic data of a lens and its sharpness over the field.

    shares: field points as fractions of the film corner's height, or of the illuminated field's edge.
    mtf_frequencies_per_mm: frequencies of the MTF, which takes a second for large aberrations; empty: no MTF.
    circle_of_confusion_mm: see depth_of_field(). Raises InputError.
    """
    frequencies = tuple(mtf_frequencies_per_mm)
    field_figures = []
    for field in fields_at(lens, shares):
        spot = area_weighted_spot(lens, field_deg=field.angle_deg)
        tangential = sagittal = None
        if frequencies:
            _, tangential, sagittal = lens.psf(field.angle_deg, centre="centroid").mtf(np.array(frequencies))
        field_figures.append(FieldFigures(field, 1000 * spot.rms_radius_mm, tangential, sagittal))
    return LensSummary(
        lens,
        photographic_figures(lens, circle_of_confusion_mm=circle_of_confusion_mm),
        lens.film_position_mm - min(lens.vertices_mm),
        len(elements_of(Cut(lens))),
        tuple(field_figures),
        frequencies,
    )
