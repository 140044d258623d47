"""A contact sheet of copies of one lens before one test target: its middle and four corners through each of them.

    python examples/copies.py copies.png --copies 50 --grade commercial

The target has a star in the middle and one in each corner. A copy with an element off the axis shows some corners
softer than others, and one with a thickness off all of them.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
import realcam as rc
from realcam.sheet import save_labelled

PLACES = ((-1, 1), (1, 1), (0, 0), (-1, -1), (1, -1))  # of stars, in shares of those in the corners
SPOKES = 24
LUMINANCE = 1000.0  # cd/m^2


def target(places_m: np.ndarray, radius_m: float, distance_m: float) -> rc.Scene:
    """Black stars on a wall that shines white."""
    reach = 20 * np.abs(places_m).max()
    wall = [(-reach, -reach), (reach, -reach), (reach, reach), (-reach, reach)]
    vertices, triangles, materials = [(x, y, -1e-4 * distance_m) for x, y in wall], [(0, 1, 2), (0, 2, 3)], [0, 0]
    for x, y in places_m:
        for spoke in range(SPOKES):
            first = len(vertices)
            vertices.append((x, y, 0))
            for side in (0, 1):
                angle = math.pi * (2 * spoke + side) / SPOKES
                vertices.append((x + radius_m * math.cos(angle), y + radius_m * math.sin(angle), 0))
            triangles.append((first, first + 1, first + 2))
            materials.append(1)
    white, black = rc.Material(emission=(LUMINANCE,) * 3), rc.Material(diffuse=(0, 0, 0))
    return rc.Scene.from_arrays(vertices, triangles, triangle_materials=materials, materials=[white, black])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", help="The sheet, .png")
    parser.add_argument("--lens", default="double-gauss-50mm")
    parser.add_argument("--f-number", type=float, default=2.8)
    parser.add_argument("--grade", default="commercial", help="commercial, precision or high")
    parser.add_argument("--copies", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--columns", type=int, default=10)
    parser.add_argument("--pixels", type=int, default=48, help="Of each star")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--device", default="auto")
    wanted = parser.parse_args()

    distance_m = 3.0
    lens = rc.Lens.load(wanted.lens).stopped_down(wanted.f_number).focused(distance_m)
    study = rc.tolerance_study(lens, wanted.grade, wanted.copies, seed=wanted.seed)
    width, height = (0.33 * side for side in lens.film_mm)
    scale = (distance_m - 1e-3 * lens.film_position_mm) / (1e-3 * lens.first_order().effective_focal_length_mm)
    places_mm = np.array(PLACES) * (width, height)
    star_mm = 0.045 * width
    scene = target(1e-3 * scale * places_mm, 1e-3 * scale * star_mm, distance_m)
    side_mm = 2.2 * star_mm
    sheet = []
    worst = int(np.argmin(study.measure("lowest_mtf")))
    for number in range(len(study)):
        copy = study.copy(number)
        sheet.append((label_of(study, number, worst), stars(scene, copy, places_mm, side_mm, distance_m, wanted)))
        print(f"\r{number + 1} of {len(study)}", end="", flush=True)
    save_labelled(sheet, wanted.output, wanted.columns)
    print(f"\nwrote {wanted.output}; copy {worst} has the softest corner")


def label_of(study: rc.ToleranceStudy, number: int, worst: int) -> str:
    """Least and largest MTF of the fields."""
    mtf = study.figures.mtf[number, :, :, study.main].mean(1)
    return f"{number}{'*' if number == worst else ''}: {mtf.min():.2f} to {mtf.max():.2f}"


def stars(scene, lens, places_mm, side_mm, distance_m, wanted) -> np.ndarray:
    """The five places through a lens, as they lie in the picture."""
    pixels, gap = wanted.pixels, 2
    tile = np.full((3 * pixels + 2 * gap, 3 * pixels + 2 * gap, 3), 0.5)
    for (x, y), at in zip(PLACES, places_mm, strict=True):
        film = rc.Film(side_mm, side_mm, (pixels, pixels), shift_mm=tuple(at))
        # White is 0.44 lux seconds on the axis, 2.2 stops above the middle grey of ISO 100.
        exposure_s = 0.44 * 4 * wanted.f_number**2 / (math.pi * LUMINANCE)
        camera = rc.Camera(
            lens, film=film, position=(0, 0, distance_m), look_at=(0, 0, 0), exposure_time_s=exposure_s, iso=100
        )
        image = rc.render(scene, camera, spp=wanted.spp, effects=(), max_bounces=0, device=wanted.device)
        row, column = (1 - y) * (pixels + gap), (1 + x) * (pixels + gap)
        tile[row : row + pixels, column : column + pixels] = image.developed("linear") / 255
    return tile


if __name__ == "__main__":
    main()
