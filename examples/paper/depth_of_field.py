"""Figure 7 and equation 8: depth of field, full lens beside thin lens, by formula, by rays and in the picture."""

from __future__ import annotations

import math

import matplotlib.figure
import numpy as np
from realcam import Camera, Film, Lens, render
from realcam.photography import depth_of_field

from .experiment import Experiment, Row, drawn
from .scenes import stars

PAPER_MM = 7.86
CIRCLE_MM = 0.03
F_NUMBER = 5.6


def magnification_for(depth_mm: float, f_number: float, circle_mm: float) -> float:
    """m of 2 N c (m + 1) / m^2 = depth."""
    a = 2 * f_number * circle_mm / depth_mm
    return (a + math.sqrt(a * a + 4 * a)) / 2


def experiment(device: str) -> Experiment:
    pairs = [(n, magnification_for(PAPER_MM, n, CIRCLE_MM)) for n in (1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0, 22.0)]
    m = magnification_for(PAPER_MM, F_NUMBER, CIRCLE_MM)
    lens = _lens_at(m)
    by_rays = depth_of_field(lens, CIRCLE_MM)
    offsets, full = measured_blur_mm(lens, "full", device)
    _, thin = measured_blur_mm(lens, "thin", device)
    rows = [
        Row(
            "equation 8, 2 N c (m + 1) / m²",
            f"{PAPER_MM} mm",
            "holds for " + ", ".join(f"N = {n:g} with m = {pair:.3f}" for n, pair in pairs) + f" (c = {CIRCLE_MM} mm)",
        ),
        Row(
            f"N = {F_NUMBER}, m = {m:.4f}: textbook's near and far limits",
            "",
            f"{1000 * by_rays.formula.depth_m:.2f} mm",
        ),
        Row("the same by real rays", "", f"{1000 * by_rays.real.depth_m:.2f} mm"),
        Row("measured in the picture, full lens", "", _range_text(offsets, full)),
        Row("measured in the picture, thin lens", "", _range_text(offsets, thin)),
    ]
    return Experiment(
        "Figure 7 and equation 8: depth of field",
        (
            "One equation has two unknowns, so that the paper's depth belongs to a whole row of f-numbers and "
            "magnifications; the table has those on an aperture ring. The double Gauss is set to one of them, and "
            "photographs a row of small lights that stand one behind the other. The diameter of the even disc that "
            "is as wide as each light's image (its second moment, less that of pixel and light) is drawn; where it "
            "is below the circle of confusion the picture is sharp.",
        ),
        (drawn("Blur measured in the pictures", _plot(offsets, full, thin)),),
        tuple(rows),
    )


def _lens_at(magnification: float) -> Lens:
    """The double Gauss, stopped down and focused at this lateral magnification (size on the film over object size)."""
    lens = Lens.load("double-gauss-50mm").stopped_down(F_NUMBER)
    data = lens.first_order()
    f = data.effective_focal_length_mm
    # Newton's form: f / m in front of the front focal point, and f m behind the rear one.
    film = lens.vertices_mm[-1] + data.back_focal_distance_mm + f * magnification
    return lens.focused((film + f / magnification - data.front_focal_distance_mm) / 1000)


def measured_blur_mm(lens: Lens, model: str, device: str) -> tuple[np.ndarray, np.ndarray]:
    """Offsets of lights from the plane in focus (mm, positive: farther) and the diameters of their discs (mm)."""
    offsets = np.linspace(-9, 9, 25)
    pitch, rows, step = 0.006, 63, 48  # mm on the film, pixels, pixels between lights
    film = Film(pitch * step * len(offsets), pitch * rows, (step * len(offsets), rows))
    camera = Camera(lens, film=film, exposure_time_s=1, iso=100, model=model)
    data = lens.first_order()
    places, sides = [], []
    for index, offset in enumerate(offsets):
        object_mm = 1000 * lens.focus_distance_m + offset  # to the film
        from_focal_point = object_mm - lens.film_position_mm + data.front_focal_distance_mm
        scale = data.effective_focal_length_mm / from_focal_point  # image over object
        x = pitch * step * (index - (len(offsets) - 1) / 2)
        places.append((x / scale / 1000, 0.0, -object_mm / 1000))
        sides.append(2 * pitch / scale / 1000)
    image = render(stars(places, sides, 1e6), camera, spp=1024, device=device, effects=())
    light = image.pixels.mean(axis=2).astype(np.float64)
    diameters = []
    for index in range(len(offsets)):
        part = light[:, index * step : (index + 1) * step]
        variance = _variance(part.sum(axis=1)) * pitch**2 - pitch**2 / 12 - (2 * pitch) ** 2 / 12
        diameters.append(4 * math.sqrt(max(variance, 0.0)))  # of a disc: diameter^2 / 16
    return offsets, np.array(diameters)


def _variance(profile: np.ndarray) -> float:
    at = np.arange(len(profile))
    total = profile.sum()
    if total == 0:
        return math.nan
    middle = (at * profile).sum() / total
    return float((((at - middle) ** 2) * profile).sum() / total)


def _range_text(offsets: np.ndarray, diameters: np.ndarray) -> str:
    """The depth of field and its limits, at which lines fitted to the diameters reach the circle of confusion.

    Each side has its own line, fitted to the diameters near the circle of confusion.
    """
    ends = []
    for side in (offsets < 0, offsets > 0):
        near_circle = side & (diameters > 0.5 * CIRCLE_MM) & (diameters < 2 * CIRCLE_MM)
        slope, start = np.polyfit(offsets[near_circle], diameters[near_circle], 1)
        ends.append((CIRCLE_MM - start) / slope)
    return f"{ends[1] - ends[0]:.2f} mm ({ends[0]:+.2f} to {ends[1]:+.2f})"


def _plot(offsets: np.ndarray, full: np.ndarray, thin: np.ndarray) -> matplotlib.figure.Figure:
    figure = matplotlib.figure.Figure(figsize=(7, 3.2), layout="constrained")
    axes = figure.add_subplot()
    axes.plot(offsets, 1000 * full, "o-", markersize=3, label="full lens")
    axes.plot(offsets, 1000 * thin, "s-", markersize=3, label="thin lens")
    axes.axhline(1000 * CIRCLE_MM, color="grey", linestyle="--", label="circle of confusion")
    axes.set(xlabel="distance from the plane in focus / mm", ylabel="disc's diameter on the film / um")
    axes.legend(frameon=False)
    return figure
