"""Modulation transfer function over frequency, over the field and through focus, with the diffraction limit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypedDict

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import InputError, Lens, RayBundle
from ..fields import FieldPosition
from ..short_text import ShortText
from . import style
from .fields import (
    Bundles,
    Doubles,
    analysis_inputs,
    bundles_of,
    checked_count,
    default_frequencies_per_mm,
    fields_of,
    frequencies_of,
    numbers_of,
    texts_of,
)
from .pupil_function import lines_of, pupil_function, transfer, transfer_limit

if TYPE_CHECKING:
    from typing_extensions import Unpack

METHODS = ("diffraction", "geometric")


class MtfOptions(TypedDict, total=False):
    """Arguments of mtf() that its variants pass on."""

    wavelengths_nm: ArrayLike | None
    weights: ArrayLike | None
    method: str
    object_distance_m: float | None
    bundles: Bundles | None


@dataclass(frozen=True, repr=False)
class Mtf(ShortText):
    """MTF values, 0 to 1.

    fields_deg: (F,); frequencies_per_mm: (K,), periods per mm on the film; defocus_mm: (D,), planes behind the film.
    tangential, sagittal: (D, F, K), for patterns that vary along y and along x.
    limit_tangential, limit_sagittal: (F, K), diffraction limit of the same pupil, with its real f-number and
      vignetting. Ones for the method "geometric".
    method: "diffraction" or "geometric".
    """

    fields_deg: Doubles
    frequencies_per_mm: Doubles
    defocus_mm: Doubles
    wavelengths_nm: Doubles
    weights: Doubles
    tangential: Doubles
    sagittal: Doubles
    limit_tangential: Doubles
    limit_sagittal: Doubles
    method: str


def mtf(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    frequencies_per_mm: ArrayLike | None = None,
    *,
    wavelengths_nm: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    defocus_mm: ArrayLike = 0.0,
    method: str = "diffraction",
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> Mtf:
    """Polychromatic MTF, by the autocorrelation of the pupil function from real rays, or by rays alone.

    fields_deg: None is 0, 0.7 and 1 times the largest image height. frequencies_per_mm: None is 10, 20 and 40 for a
    film diagonal of 43 mm, scaled inversely for others. wavelengths_nm: None is F line, design wavelength, C line.
    weights: None is equal weights. defocus_mm: (D,) planes behind the film. method: "diffraction", or "geometric": by
    rays, as many as the highest frequency needs, to 1e-4; nan if 200 000 rays do not determine the contrast to 0.01.
    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Raises InputError if no light passes.
    """
    if method not in METHODS:
        raise InputError(f'unknown method "{method}"; expected diffraction or geometric')
    source, fields, wavelengths = analysis_inputs(lens, fields_deg, wavelengths_nm, object_distance_m, bundles)
    frequencies = default_frequencies_per_mm(lens) if frequencies_per_mm is None else frequencies_of(frequencies_per_mm)
    fractions = _normalised(weights, len(wavelengths))
    planes = numbers_of(defocus_mm, "defocus_mm")
    result = np.zeros((2, len(planes), len(fields), len(frequencies)))
    limit = np.zeros((2, len(fields), len(frequencies)))
    transfer_of = diffraction_transfer if method == "diffraction" else _geometric_transfer
    for f, field in enumerate(fields):
        transfers = [transfer_of(source, float(field), float(nm), frequencies, planes) for nm in wavelengths]
        # All wavelengths refer to one film point, so that lateral colour counts: phases of the chief rays' offsets in y
        # (tangential) and x (sagittal) from the first wavelength's.
        offsets = np.array([one.chief_ray_mm - transfers[0].chief_ray_mm for one in transfers])[:, ::-1]
        phases = np.exp(-2j * np.pi * offsets[:, :, None] * frequencies)
        result[:, :, f] = np.abs(
            sum(w * one.otf * phase[:, None] for w, one, phase in zip(fractions, transfers, phases, strict=True))
        )
        limit[:, f] = sum(w * one.limit for w, one in zip(fractions, transfers, strict=True))
    return Mtf(fields, frequencies, planes, wavelengths, fractions, result[0], result[1], limit[0], limit[1], method)


@dataclass(frozen=True)
class Transfer:
    """Optical transfer functions of one field and wavelength.

    otf: (2, D, K), complex, tangential and sagittal, with the phase relative to the chief ray's film point.
    limit: (2, K), that of the pupil without aberrations. chief_ray_mm: (2,), film point of the chief ray.
    """

    otf: np.ndarray
    limit: Doubles
    chief_ray_mm: Doubles


def _normalised(weights: ArrayLike | None, count: int) -> Doubles:
    """Weights of `count` wavelengths with the sum 1; None: equal weights. Raises InputError."""
    array = np.ones(count) if weights is None else numbers_of(weights, "weights")
    if array.shape != (count,) or not (array > 0).all():
        raise InputError(f"weights must be {count} positive numbers, one for each wavelength")
    fractions: Doubles = array / array.sum()
    return fractions


def diffraction_transfer(
    source: Bundles, field: FieldPosition, wavelength_nm: float, frequencies: Doubles, planes: Doubles
) -> Transfer:
    """Transfer function with diffraction, by the autocorrelation of the pupil function.

    frequencies: (K,), per mm; planes: (D,), mm behind the film. Raises InputError.
    """
    pupil = pupil_function(source, field, wavelength_nm)
    directions = [lines_of(pupil, tangential=tangential) for tangential in (True, False)]
    return Transfer(
        np.stack([transfer(pupil, lines, frequencies, planes) for lines in directions]),
        np.stack([transfer_limit(pupil, lines, frequencies) for lines in directions]),
        pupil.chief_ray_mm,
    )


# Radial scan lines and Gauss nodes per line of the smallest ray bundle, and how often both numbers may be doubled.
_ARMS, _NODES, _MAX_DOUBLINGS = 32, 6, 5
# Errors of the contrast: the goal, and the largest accepted one at the maximum number of rays.
_GOAL_ERROR, _MAX_ERROR = 1e-4, 1e-2


def _geometric_transfer(
    source: Bundles, field: float, wavelength_nm: float, frequencies: Doubles, planes: Doubles
) -> Transfer:
    """Geometric transfer function, with as many rays as the frequencies need; arguments of diffraction_transfer.

    A sum over M radial scan lines is exact for fewer than M periods around the pupil, a sum over n Gauss nodes for
    about n periods along a line. The initial counts follow from the periods across the spot; they are doubled until the
    contrast converges, and nan replaces values that have not converged then. Raises InputError if no light passes.
    """

    def bundle(doublings: int) -> RayBundle:
        return source.at(field, wavelength_nm, _ARMS << doublings, _NODES << doublings)

    radius = np.linalg.norm(_points(bundle(0), planes, slice(None)), axis=2).max()
    periods = float(frequencies.max() * radius)
    sufficient = math.ceil(math.log2(max(1.0, 2 * math.pi * periods / _ARMS, periods / _NODES)))
    doublings = min(1 + sufficient, _MAX_DOUBLINGS)
    previous = _sum_of_rays(bundle(doublings - 1), frequencies, planes)
    while True:
        otf = _sum_of_rays(bundle(doublings), frequencies, planes)
        error = np.abs(otf - previous)
        if error.max() < _GOAL_ERROR or doublings == _MAX_DOUBLINGS:
            break
        previous, doublings = otf, doublings + 1
    otf = np.where(error < _MAX_ERROR, otf, np.nan)
    return Transfer(otf, np.ones((2, len(frequencies))), np.array(bundle(0).chief_ray_mm))


def _points(bundle: RayBundle, planes: Doubles, rays: slice) -> Doubles:
    """(D, N, 2): points on the planes, mm from the chief ray's film point."""
    slopes = bundle.directions[rays, :2] / bundle.directions[rays, 2:]
    points: Doubles = bundle.points_mm[rays] - bundle.chief_ray_mm + planes[:, None, None] * slopes
    return points


def _sum_of_rays(bundle: RayBundle, frequencies: Doubles, planes: Doubles) -> np.ndarray:
    """(2, D, K): complex transfer function, tangential and sagittal, about the chief ray."""
    otf = np.zeros((2, len(planes), len(frequencies)), complex)
    step = max(1, (1 << 21) // (len(planes) * len(frequencies)))  # rays per batch: about 100 MB
    for first in range(0, len(bundle.energy), step):
        rays = slice(first, first + step)
        phases = 2 * np.pi * frequencies[:, None] * _points(bundle, planes, rays).transpose(2, 0, 1)[::-1, :, None, :]
        otf += np.cos(phases) @ bundle.energy[rays] - 1j * (np.sin(phases) @ bundle.energy[rays])  # faster than exp
    return otf


def mtf_over_frequency(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    *,
    highest_per_mm: float | None = None,
    samples: int = 97,
    **options: Unpack[MtfOptions],
) -> Mtf:
    """MTF from 0 to highest_per_mm; None is 2.5 times the highest default frequency. options: those of mtf()."""
    top = 2.5 * default_frequencies_per_mm(lens)[-1] if highest_per_mm is None else highest_per_mm
    highest = float(frequencies_of(top, "highest_per_mm").max())
    return mtf(lens, fields_deg, np.linspace(0, highest, checked_count(samples)), **options)


def mtf_over_field(
    lens: Lens,
    frequencies_per_mm: ArrayLike | None = None,
    *,
    fields_deg: ArrayLike | None = None,
    samples: int = 41,
    **options: Unpack[MtfOptions],
) -> Mtf:
    """MTF at `samples` fields from the axis to the corner of the film. options: those of mtf()."""
    options["bundles"] = source = bundles_of(lens, options.get("object_distance_m"), options.get("bundles"))
    return mtf(lens, fields_of(lens, fields_deg, samples, source), frequencies_per_mm, **options)


def mtf_through_focus(
    lens: Lens,
    frequency_per_mm: float | None = None,
    *,
    fields_deg: ArrayLike | None = None,
    defocus_mm: ArrayLike | None = None,
    samples: int = 41,
    **options: Unpack[MtfOptions],
) -> Mtf:
    """MTF of one frequency through focus. options: those of mtf().

    frequency_per_mm: None is the middle default frequency. defocus_mm: None is f-number over frequency to either side,
    where a perfect lens has lost its axial contrast.
    """
    middle = default_frequencies_per_mm(lens)[1] if frequency_per_mm is None else frequency_per_mm
    frequency = float(frequencies_of(middle, "frequency_per_mm").max())
    planes = (
        np.linspace(-1, 1, checked_count(samples)) * lens.first_order().f_number / max(frequency, 1e-9)
        if defocus_mm is None
        else numbers_of(defocus_mm, "defocus_mm")
    )
    return mtf(lens, fields_deg, [frequency], defocus_mm=planes, **options)


def _add_labels(axes: Axes, title: str, data: Mtf) -> None:
    """Adds title, y axis and legend, which all plots of MTF share."""
    axes.set_ylim(0, 1.02)
    axes.set_ylabel("contrast")
    axes.set_title(title if data.method == "diffraction" else f"{title}, geometric")
    axes.plot([], [], color=style.GREY, label="tangential")
    axes.plot([], [], "--", color=style.GREY, label="sagittal")
    style.legend_beside(axes)


def plot_mtf_over_frequency(data: Mtf, axes: Axes) -> None:
    """Plots MTF over frequency, with the diffraction limit of the first field."""
    for f, label in enumerate(texts_of(data.fields_deg, "°")):
        axes.plot(data.frequencies_per_mm, data.tangential[0, f], color=style.field_colour(f), label=label)
        axes.plot(data.frequencies_per_mm, data.sagittal[0, f], "--", color=style.field_colour(f))
    if data.method == "diffraction":
        axes.plot(data.frequencies_per_mm, data.limit_tangential[0], ":", color=style.text_colour(), label="limit")
    axes.set_xlim(0, max(float(data.frequencies_per_mm.max()), 1e-9))
    axes.set_xlabel("periods per mm")
    _add_labels(axes, "MTF", data)


def plot_mtf_over_field(data: Mtf, axes: Axes) -> None:
    """Plots MTF over the field, with the tangential diffraction limit of the vignetted pupil."""
    for k, label in enumerate(texts_of(data.frequencies_per_mm, "/mm")):
        axes.plot(data.fields_deg, data.tangential[0, :, k], color=style.field_colour(k), label=label)
        axes.plot(data.fields_deg, data.sagittal[0, :, k], "--", color=style.field_colour(k))
        if data.method == "diffraction":
            axes.plot(
                data.fields_deg,
                data.limit_tangential[:, k],
                ":",
                color=style.field_colour(k),
                linewidth=0.8,
                label="limit" if k == 0 else "_nolegend_",
            )
    axes.set_xlim(*style.field_limits(data.fields_deg))
    axes.set_xlabel("field / °")
    _add_labels(axes, "MTF over the field", data)


def plot_mtf_through_focus(data: Mtf, axes: Axes) -> None:
    """Plots MTF over defocus, with the diffraction limit of the first field."""
    for f, label in enumerate(texts_of(data.fields_deg, "°")):
        axes.plot(data.defocus_mm, data.tangential[:, f, 0], color=style.field_colour(f), label=label)
        axes.plot(data.defocus_mm, data.sagittal[:, f, 0], "--", color=style.field_colour(f))
    if data.method == "diffraction":
        axes.axhline(float(data.limit_tangential[0, 0]), linestyle=":", color=style.text_colour(), label="limit")
    style.zero_lines(axes, y=False)
    if len(data.defocus_mm) > 1:
        axes.set_xlim(float(data.defocus_mm.min()), float(data.defocus_mm.max()))
    axes.set_xlabel("plane behind the film / mm")
    _add_labels(axes, f"MTF at {data.frequencies_per_mm[0]:.4g}/mm through focus", data)
