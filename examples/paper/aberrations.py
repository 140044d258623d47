"""Figure 5: spherical aberration, coma and astigmatism of one convex lens; ray sketch beside picture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import matplotlib.figure
import numpy as np
from realcam import Camera, Film, Lens, render
from realcam._core import develop
from realcam.drawing import draw_cross_section

from .experiment import Experiment, Figure, Row, drawn, pixels
from .scenes import stars

SIZE = 96  # pixels of a picture's side


@dataclass(frozen=True)
class Case:
    name: str
    lens: Lens
    field_deg: float
    distance_m: float  # from the front vertex
    what: str


def experiment(device: str) -> Experiment:
    figures: list[Figure] = []
    rows: list[Row] = []
    for case in _cases():
        figures.append(drawn(f"{case.name}: rays", _sketch(case)))
        figures.append(_picture(case, device))
        rows.append(Row(case.name, "", case.what))
    return Experiment(
        "Figure 5: aberrations of one convex lens",
        (
            "A single lens (singlet-100mm, its stop behind it) images a small bright square. On the axis its rim "
            "focuses nearer than its middle; off the axis the spot grows a tail, most where the lens is turned "
            "round; stopped down, what is left is that radial and tangential lines are sharp at different "
            "distances. The pictures are rendered, pixel by pixel, and the spots in them are as wide as the spots "
            "of rays beside them.",
        ),
        tuple(figures),
        tuple(rows),
    )


def _cases() -> list[Case]:
    lens = Lens.load("singlet-100mm").focused(math.inf)
    spot = lens.spot(0.0, object_distance_m=math.inf)
    sums = lens.seidel(0.0001, object_distance_m=math.inf)
    spherical = Case(
        "spherical aberration", lens, 0.0, 1e4,
        f"RMS radius {1000 * spot.rms_radius_mm:.0f} um, at most {1000 * spot.max_radius_mm:.0f} um; third order: "
        f"{-1000 * float(np.sum(sums.spherical_mm)):.0f} um across at the paraxial focus",
    )  # fmt: skip
    # Turned round, the lens is bent the wrong way for a far object, and its stop is in front of it.
    wrong_way = lens.reversed().stopped_down(8)
    sums = wrong_way.seidel(6.0, object_distance_m=math.inf)
    coma = Case(
        "coma", wrong_way, 6.0, 1e4,
        f"the lens turned round, at f/8 and 6 degrees; third order: tangential coma "
        f"{1000 * float(np.sum(sums.tangential_coma_mm)):.0f} um",
    )  # fmt: skip
    small = lens.stopped_down(16)
    distance = _line_focus_m(small, 10.0)
    at = small.spot(10.0, object_distance_m=distance, samples=12).points_mm
    across, along = 1000 * np.nanstd(at[:, 0]), 1000 * np.nanstd(at[:, 1])
    astigmatism = Case(
        "astigmatism", small, 10.0, distance,
        f"at 10 degrees and f/16, an object at {distance:.2f} m: {along:.0f} um long in the radial direction and "
        f"{across:.0f} um across it (standard deviations)",
    )  # fmt: skip
    return [spherical, coma, astigmatism]


def _line_focus_m(lens: Lens, field_deg: float) -> float:
    """Distance of an object whose image off the axis is a line along the radius: the sagittal focus is on the film."""
    distances = np.geomspace(1, 50, 60)
    widths = [np.nanstd(lens.spot(field_deg, object_distance_m=d).points_mm[:, 0]) for d in distances]
    return float(distances[int(np.argmin(widths))])


def _sketch(case: Case) -> matplotlib.figure.Figure:
    figure = matplotlib.figure.Figure(figsize=(6, 2.6), layout="constrained")
    axes = figure.add_subplot()
    draw_cross_section(case.lens, axes, rays=15, fields_deg=[case.field_deg], object_distance_m=case.distance_m)
    axes.set_title(case.name)
    return figure


def _picture(case: Case, device: str) -> Figure:
    spot = case.lens.spot(case.field_deg, object_distance_m=case.distance_m, samples=12)
    height = -spot.centroid_mm[1]
    pitch = 5 * spot.max_radius_mm / SIZE
    # The film is turned so that the field lies along its long side; only its end is kept.
    columns = 2 * math.ceil(abs(height) / pitch) + SIZE
    film = Film(columns * pitch, SIZE * pitch, (columns, SIZE))
    camera = Camera(case.lens, film=film, exposure_time_s=1.0, iso=100)
    vertex = case.lens.film_position_mm / 1000
    slope = math.tan(math.radians(case.field_deg))
    magnification = 1000 * case.distance_m / abs(case.lens.first_order().effective_focal_length_mm)
    side = 1.5 * pitch / 1000 * magnification
    place = (slope * case.distance_m, 0.0, -(case.distance_m + vertex))
    samples = max(64, int(3e7 / (columns * SIZE)))
    image = render(stars([place], side, 1e3), camera, spp=samples, device=device, effects=())
    light = image.pixels.mean(axis=2)
    middle = int(np.average(np.arange(columns), weights=light.sum(axis=0)))
    left = int(np.clip(middle - SIZE // 2, 0, columns - SIZE))
    part = image.pixels[:, left : left + SIZE]
    bright = float(np.quantile(part[part > 0], 0.98)) if (part > 0).any() else 1.0
    caption = f"{case.name}: the picture, {SIZE * pitch:.2g} mm wide"
    return pixels(caption, develop(part, 1 / (0.018 * bright), "linear"), scale=2)
