"""Compares patents' lenses with products that photographers have measured: tables and plots of docs/photographs.md.

    python benchmarks/photographs.py                      # tables, as Markdown
    python benchmarks/photographs.py --plots docs/images  # and photographs-distortion.png, photographs-others.png

The measurements are those of lensfun's contributors; tests/python/photographs/products.toml has the coefficients.
"""

from __future__ import annotations

import argparse
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
import realcam as rc
from numpy.typing import NDArray

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

Doubles = NDArray[np.float64]
Entry = Mapping[str, Any]

FOLDER = Path(__file__).parents[1] / "tests" / "python" / "photographs"
FULL_FRAME_MM = (36.0, 24.0)
FRAME_POINTS = (36, 24)  # in one quadrant
FIELDS = 25
# Wavelengths that stand for the channels of a camera: about the centroids of their sensitivities in daylight.
RED_NM, GREEN_NM, BLUE_NM = 600.0, 540.0, 460.0

# Bounds of the comparison, fixed before any of the lenses of tests/python/photographs/lenses was traced. Each is the
# 90th percentile of the differences between two contributors (see `scatter`) plus a tolerance of production.
# Distortion and colour: the 95th percentile of copies of the Summicron with errors of the grade "precision" in radii
# (0.1%), thicknesses (0.05 mm) and glasses (0.0005, 0.5%) is 2.9 um and 1.3 um, here rounded up. Other lenses vary
# more: docs/photographs.md.
# Falloff: 0.1 stop is assumed for rims and diaphragms.
SCATTER_UM, PRODUCTION_UM = 20.5, 3.0
SCATTER_COLOUR_UM, PRODUCTION_COLOUR_UM = 2.4, 1.5
SCATTER_STOPS, PRODUCTION_STOPS = 0.115, 0.1
DISTORTION_BOUND_UM = SCATTER_UM + PRODUCTION_UM
COLOUR_BOUND_UM = SCATTER_COLOUR_UM + PRODUCTION_COLOUR_UM
FALLOFF_BOUND_STOPS = SCATTER_STOPS + PRODUCTION_STOPS


def load_table() -> dict[str, list[dict[str, Any]]]:
    """Returns the lists `product` and `repeated` of products.toml."""
    with (FOLDER / "products.toml").open("rb") as file:
        return tomllib.load(file)


def frame_radii_mm(crop: float) -> Doubles:
    """(N,): distances from the axis of a regular grid over a quadrant of the frame 36 mm x 24 mm / crop."""
    half = [0.5 * side / crop * (np.arange(n) + 0.5) / n for side, n in zip(FULL_FRAME_MM, FRAME_POINTS, strict=True)]
    x, y = np.meshgrid(*half)
    return np.hypot(x, y).ravel()


def unit_radius_mm(crop: float) -> float:
    """The radius that is 1 in lensfun's distortion and lateral colour: half the short side of the frame."""
    return 0.5 * FULL_FRAME_MM[1] / crop


def distorted(radius: Doubles, model: Entry) -> Doubles:
    """Distorted radius by lensfun's models, both radii in units of unit_radius_mm."""
    if model["model"] == "ptlens":
        a, b, c = model["a"], model["b"], model["c"]
        return radius * (a * radius**3 + b * radius**2 + c * radius + 1 - a - b - c)
    if model["model"] == "poly3":
        return radius * (1 - model["k1"] + model["k1"] * radius**2)
    if model["model"] == "poly5":
        return radius * (1 + model["k1"] * radius**2 + model["k2"] * radius**4)
    raise ValueError(f'unknown model of distortion "{model["model"]}"')


def measured_height_mm(tangent: Doubles, model: Entry, crop: float, focal_length_mm: float) -> Doubles:
    """Image height of an object at a tangent of the field angle. The focal length is lensfun's, not the paraxial."""
    unit = unit_radius_mm(crop)
    return unit * distorted(focal_length_mm * tangent / unit, model)


def measured_colour_mm(radius_mm: Doubles, model: Entry, crop: float, channel: str) -> Doubles:
    """Image height in the channel "r" or "b" minus that in green, at heights in green."""
    unit = unit_radius_mm(crop)
    u = radius_mm / unit
    if model["model"] == "linear":
        return unit * u * (model["k" + channel] - 1)
    return (
        unit * u * (model["v" + channel] - 1 + model.get("c" + channel, 0.0) * u + model.get("b" + channel, 0.0) * u**2)
    )


def measured_illumination(radius_mm: Doubles, model: Entry, crop: float) -> Doubles:
    """Illuminance relative to the axis; lensfun's radius is 1 in the corner of the frame."""
    u = radius_mm / (0.5 * math.hypot(*FULL_FRAME_MM) / crop)
    return 1 + model["k1"] * u**2 + model["k2"] * u**4 + model["k3"] * u**6


def fitted_scale(residual: Callable[[float], Doubles], start: float) -> float:
    """Least squares in one scale, by Gauss-Newton with a numerical derivative."""
    scale = start
    for _ in range(20):
        error = residual(scale)
        slope = (residual(scale * (1 + 1e-6)) - error) / (scale * 1e-6)
        scale -= float(error @ slope) / float(slope @ slope)
    return scale


def rms(values: Doubles) -> float:
    return math.sqrt(float(np.mean(np.square(values))))


@dataclass(frozen=True)
class ChiefRays:
    """Heights on the film of chief rays from infinity. tangents: (F,), of the field angles; the heights: (F,), mm."""

    tangents: Doubles
    red_mm: Doubles
    green_mm: Doubles
    blue_mm: Doubles


@dataclass(frozen=True)
class Falloff:
    """Relative illumination of the patent's lens and of the product at one f-number, at heights on the film."""

    f_number: float
    lens_f_number: float
    radius_mm: Doubles
    patent: Doubles
    product: Doubles
    rms_stops: float


@dataclass(frozen=True)
class Comparison:
    """The patent's lens beside the product.

    radius_mm: (N,), heights on the film by the patent's lens in green; patent_percent, product_percent: (N,), their
    distortion relative to one ideal lens. distortion_um: rms over the frame of the difference of heights, after one
    scale; ideal_um: the same for a lens without distortion in the patent's place.
    red_um, blue_um: rms over the frame of the differences of lateral colour, relative to green; plain_red_um: that of
    red for a lens without lateral colour. None if lensfun has no lateral colour.
    edge_red_um: lateral colour of red at 85% of the largest height: the patent's lens and the product.
    covered_mm: largest height that was compared; half the frame's diagonal unless the patent's light ends before.
    """

    entry: Entry
    focal_length_mm: float
    radius_mm: Doubles
    patent_percent: Doubles
    product_percent: Doubles
    distortion_um: float
    ideal_um: float
    red_um: float | None
    blue_um: float | None
    plain_red_um: float | None
    edge_red_um: tuple[float, float] | None
    falloff: tuple[Falloff, ...]
    covered_mm: float


def load_lens(entry: Entry) -> rc.Lens:
    own = FOLDER / "lenses" / f"{entry['lens']}.toml"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        lens = rc.Lens.load(own if own.exists() else entry["lens"])
    lens = lens.zoomed(entry["zoom"]) if "zoom" in entry else lens
    width, height = (side / entry["crop"] for side in FULL_FRAME_MM)
    return lens.with_film(width, height)


def chief_rays(lens: rc.Lens) -> ChiefRays:
    """Chief rays up to the corner of the film, or to where the lens's light ends."""
    curve = rc.analysis.lateral_colour(
        lens, wavelengths_nm=[RED_NM, GREEN_NM, BLUE_NM], samples=FIELDS, object_distance_m=math.inf
    )
    design = rc.analysis.distortion(lens, curve.fields_deg, object_distance_m=math.inf, projection="tangent").real_mm
    heights = np.abs(curve.shift_mm + design)
    return ChiefRays(np.abs(np.tan(np.radians(curve.fields_deg))), *heights)


def tangents_at(rays: ChiefRays, radius_mm: Doubles) -> Doubles:
    """Tangents of the field angles at heights in green. Their ratio is interpolated, because it hardly changes."""
    ratio = rays.tangents[1:] / rays.green_mm[1:]
    return radius_mm * np.interp(radius_mm**2, rays.green_mm[1:] ** 2, ratio)


def compare_falloff(lens: rc.Lens, entry: Entry) -> tuple[Falloff, ...]:
    found = []
    for model in entry.get("falloff", ()):
        open_lens = lens.wide_open()
        state = (
            open_lens.stopped_down(model["f_number"]) if model["f_number"] > 1.02 * open_lens.f_number else open_lens
        )
        pupils = rc.analysis.film_pupils(state, samples=13, object_distance_m=math.inf)
        height = np.abs(pupils.film_mm)
        radius = frame_radii_mm(entry["crop"])
        radius = radius[radius <= height.max()]
        patent = np.interp(radius, height, pupils.relative_illumination)
        product = measured_illumination(radius, model, entry["crop"])
        found.append(
            Falloff(
                model["f_number"],
                float(state.f_number),
                height,
                pupils.relative_illumination,
                measured_illumination(height, model, entry["crop"]),
                rms(np.log2(patent / product)),
            )
        )
    return tuple(found)


def compare(entry: Entry, *, with_falloff: bool = True) -> Comparison:
    lens = load_lens(entry)
    rays = chief_rays(lens)
    crop = entry["crop"]
    radius = frame_radii_mm(crop)
    radius = radius[radius <= rays.green_mm.max()]
    tangent = tangents_at(rays, radius)

    focal, difference = _after_scale(tangent, radius, entry["distortion"], crop, entry["focal_mm"])
    # The ideal lens's heights are f tan(theta): the product's heights against the best proportional ones.
    product = measured_height_mm(tangent, entry["distortion"], crop, focal)
    proportion = float(product @ tangent) / float(tangent @ tangent)
    paraxial = rays.green_mm[1] / rays.tangents[1]
    shown = rays.tangents[1:]
    product_shown = measured_height_mm(shown, entry["distortion"], crop, focal)
    red = blue = plain = edge = None
    if "colour" in entry:
        photographed = [measured_colour_mm(radius, entry["colour"], crop, channel) for channel in "rb"]
        shifts = [other - rays.green_mm for other in (rays.red_mm, rays.blue_mm)]
        red, blue = (
            1e3 * rms(measured - np.interp(radius, rays.green_mm, shift))
            for measured, shift in zip(photographed, shifts, strict=True)
        )
        plain = 1e3 * rms(photographed[0])
        place = np.array([0.85 * rays.green_mm.max()])
        edge = (
            1e3 * float(np.interp(place[0], rays.green_mm, shifts[0])),
            1e3 * float(measured_colour_mm(place, entry["colour"], crop, "r")[0]),
        )
    return Comparison(
        entry,
        float(lens.first_order().effective_focal_length_mm),
        rays.green_mm[1:],
        100 * (rays.green_mm[1:] / (paraxial * shown) - 1),
        100 * (product_shown / (paraxial * shown) - 1),
        1e3 * rms(difference),
        1e3 * rms(product - proportion * tangent),
        red,
        blue,
        plain,
        edge,
        compare_falloff(lens, entry) if with_falloff else (),
        float(rays.green_mm.max()),
    )


@dataclass(frozen=True)
class Scatter:
    """Differences between two contributors' measurements of products of one name, rms over the smaller frame."""

    distortion_um: Doubles
    colour_um: Doubles
    falloff_stops: Doubles


def scatter(repeated: Sequence[Entry]) -> Scatter:
    distortion, colour, falloff = [], [], []
    for pair in repeated:
        large, small = pair["crop"]
        radius = frame_radii_mm(small)
        tangent = np.linspace(0.0, 1.4 * radius.max(), 4000)  # of a focal length of 1 mm
        tangent = np.interp(radius, measured_height_mm(tangent, pair["distortion"][1], small, 1.0), tangent)
        distortion.append(1e3 * rms(_after_scale(tangent, radius, pair["distortion"][0], large, 1.0)[1]))
        if "colour" in pair:
            first, second = pair["colour"]
            errors = [
                measured_colour_mm(radius, first, large, c) - measured_colour_mm(radius, second, small, c) for c in "rb"
            ]
            colour.append(1e3 * rms(np.concatenate(errors)))
        for first, second in pair.get("falloff", ()):
            ratio = measured_illumination(radius, first, large) / measured_illumination(radius, second, small)
            falloff.append(rms(np.log2(ratio)))
    return Scatter(np.array(distortion), np.array(colour), np.array(falloff))


def _after_scale(
    tangent: Doubles, radius: Doubles, model: Entry, crop: float, start_mm: float
) -> tuple[float, Doubles]:
    """Focal length for which the measured heights are closest to `radius`, and their differences, mm."""

    def difference(focal_length_mm: float) -> Doubles:
        return measured_height_mm(tangent, model, crop, focal_length_mm) - radius

    focal = fitted_scale(difference, start_mm)
    return focal, difference(focal)


def name_of(entry: Entry) -> str:
    return entry["product"] + (f", {entry['zoom'].removesuffix('mm')} mm" if "zoom" in entry else "")


def _marked(value: float | None, bound: float, digits: int) -> str:
    """The figure, in bold if it exceeds the bound."""
    if value is None:
        return ""
    text = f"{value:.{digits}f}"
    return f"**{text}**" if value > bound else text


def product_table(comparisons: Sequence[Comparison]) -> str:
    lines = [
        "| product | patent | contributor's camera | distortion / µm | no distortion / µm | red / µm | blue / µm "
        "| no colour / µm | falloff / stops |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for c in comparisons:
        falloff = ", ".join(f"f/{f.f_number:g}: {_marked(f.rms_stops, FALLOFF_BOUND_STOPS, 2)}" for f in c.falloff)
        cells = [
            name_of(c.entry).replace("|", "-"),
            c.entry["patent"],
            c.entry["camera"],
            _marked(c.distortion_um, DISTORTION_BOUND_UM, 1),
            f"{c.ideal_um:.0f}",
            _marked(c.red_um, COLOUR_BOUND_UM, 1),
            _marked(c.blue_um, COLOUR_BOUND_UM, 1),
            "" if c.plain_red_um is None else f"{c.plain_red_um:.1f}",
            falloff,
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def scatter_table(found: Scatter) -> str:
    lines = [
        "| contributors differ by | pairs | half of them less than | 90% less than | at most |",
        "|---|---|---|---|---|",
    ]
    for what, values, digits in (
        ("distortion / µm", found.distortion_um, 1),
        ("lateral colour / µm", found.colour_um, 1),
        ("falloff / stops", found.falloff_stops, 3),
    ):
        half, most = np.quantile(values, [0.5, 0.9])
        lines.append(f"| {what} | {len(values)} | {half:.{digits}f} | {most:.{digits}f} | {values.max():.{digits}f} |")
    return "\n".join(lines)


def save_distortion_plot(comparisons: Sequence[Comparison], path: Path) -> None:
    columns = 5
    rows = math.ceil(len(comparisons) / columns)
    figure = matplotlib.figure.Figure(figsize=(12, 1.75 * rows), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True).ravel()
    for panel in panels[len(comparisons) :]:
        panel.axis("off")
    for panel, c in zip(panels, comparisons, strict=False):
        panel.plot(c.radius_mm, c.patent_percent, color="#1f77b4", label="patent")
        panel.plot(c.radius_mm, c.product_percent, "--", color="#d62728", label="product")
        panel.set_title(name_of(c.entry)[:40], fontsize=7)
        panel.tick_params(labelsize=7)
        low, high = panel.get_ylim()
        middle = 0.5 * (low + high)
        half = max(0.5 * (high - low), 0.75)
        panel.set_ylim(middle - half, middle + half)
    panels[0].legend(fontsize=7)
    figure.supxlabel("height on the film / mm", fontsize=9)
    figure.supylabel("distortion / %", fontsize=9)
    figure.savefig(path, dpi=75)


def save_other_plot(comparisons: Sequence[Comparison], path: Path) -> None:
    figure = matplotlib.figure.Figure(figsize=(10, 4.6), layout="constrained")
    colour, falloff = figure.subplots(1, 2)
    edges = [c.edge_red_um for c in comparisons if c.edge_red_um is not None]
    colour.plot(*zip(*edges, strict=True), "o", color="#d62728", markersize=4)
    colour.set_xlabel("patent / µm")
    colour.set_ylabel("product / µm")
    colour.set_title("Red relative to green, at 85% of the half diagonal")
    for k, (label, shade) in enumerate((("wide open", "#1f77b4"), ("two stops down, or about", "#ff7f0e"))):
        pairs = [
            (math.log2(c.falloff[k].patent[-2]), math.log2(c.falloff[k].product[-2]))
            for c in comparisons
            if len(c.falloff) > k
        ]
        falloff.plot(*zip(*pairs, strict=True), "o", color=shade, markersize=4, label=label)
    falloff.set_xlabel("patent / stops")
    falloff.set_ylabel("product / stops")
    falloff.set_title("Falloff close to the corner")
    for axes in (colour, falloff):
        low = min(axes.get_xlim()[0], axes.get_ylim()[0])
        high = max(axes.get_xlim()[1], axes.get_ylim()[1])
        axes.plot([low, high], [low, high], color="0.6", linewidth=0.8, zorder=0)
        axes.grid(alpha=0.3)
    falloff.legend()
    figure.savefig(path, dpi=75)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plots", type=Path, help="folder for the plots")
    options = parser.parse_args()
    table = load_table()
    print(scatter_table(scatter(table["repeated"])))
    print(f"\nBounds: {DISTORTION_BOUND_UM:g} um, {COLOUR_BOUND_UM:g} um, {FALLOFF_BOUND_STOPS:g} stops\n", flush=True)
    comparisons = [compare(entry) for entry in table["product"]]
    print(product_table(comparisons), flush=True)
    if options.plots:
        save_distortion_plot(comparisons, options.plots / "photographs-distortion.png")
        save_other_plot(comparisons, options.plots / "photographs-others.png")


if __name__ == "__main__":
    main()
