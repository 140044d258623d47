"""A contact sheet of copies of one lens before one test target: its middle and four corners through each of them.

    python examples/copies.py copies.png --copies 50 --grade commercial

Each tile has the star in the middle and those in the corners, beside each the MTF there. The copy whose softest corner
is sharpest comes first, and the one with the softest corner of all comes last, in a frame. An element off its axis
makes some corners softer than others, and a thickness that is off all of them. Fifty copies take some minutes.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
import realcam as rc
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

PLACES = np.array([(0, 0), (-1, 1), (1, 1), (-1, -1), (1, -1)])  # stars in the picture, in units of half_mm
SPOKES = 24
LUMINANCE = 1000.0  # cd/m^2
DPI = 160
GREY, RED, AMBER, WHITE = (0.25, 0.25, 0.25), "#ff6b5a", "#ffc04d", "#ffffff"


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
    parser.add_argument("--pixels", type=int, default=40, help="Of each star")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--device", default="auto")
    wanted = parser.parse_args()

    distance_m = 3.0
    lens = rc.Lens.load(wanted.lens).stopped_down(wanted.f_number).focused(distance_m)
    # The stars lie at the fields of the study: on the axis, and a quarter of the film's diagonal away from it.
    first_order = lens.first_order()
    half_mm = 0.25 * np.array(lens.film_mm)
    angle_deg = math.degrees(math.atan(math.hypot(*half_mm) / first_order.effective_focal_length_mm))
    along = PLACES * half_mm / math.hypot(*half_mm)
    # A field angle is the angle of the light, which travels downwards from a star above the axis; hence the sign.
    study = rc.tolerance_study(lens, wanted.grade, wanted.copies, seed=wanted.seed, fields_deg=-angle_deg * along)
    to_pupil_m = distance_m - 1e-3 * (lens.film_position_mm - first_order.entrance_pupil_position_mm)
    # Side of the film area around each star; a star has 20 periods per mm at 0.2 mm from its centre.
    side_mm = 1.0
    star_m = 0.45e-3 * side_mm * to_pupil_m / (1e-3 * first_order.effective_focal_length_mm)
    scene = target(to_pupil_m * math.tan(math.radians(angle_deg)) * along, star_m, distance_m)

    order = np.argsort(-study.measure("lowest_mtf"))
    tiles = []
    for done, number in enumerate(order, 1):
        centres_mm = -study.figures.chief_ray_mm[number]
        tiles.append(stars(scene, study.copy(number), centres_mm, side_mm, distance_m, wanted))
        print(f"\r{done} of {len(order)}", end="", flush=True)
    sheet(study, order, tiles, wanted).savefig(wanted.output, dpi=DPI)
    print(f"\nwrote {wanted.output}; copy {order[-1]} has the softest corner")


def stars(scene, lens, centres_mm, side_mm, distance_m, wanted) -> np.ndarray:
    """Pictures of the five stars through a lens, arranged as on the film, with gaps between them."""
    pixels = wanted.pixels
    tile = np.full((3 * pixels, 3 * pixels, 3), GREY)
    # White is 0.44 lux seconds on the axis, 2.2 stops above the middle grey of ISO 100.
    exposure_s = 0.44 * 4 * wanted.f_number**2 / (math.pi * LUMINANCE)
    for (x, y), centre_mm in zip(PLACES, centres_mm, strict=True):
        film = rc.Film(side_mm, side_mm, (pixels, pixels), shift_mm=tuple(centre_mm))
        camera = rc.Camera(
            lens, film=film, position=(0, 0, distance_m), look_at=(0, 0, 0), exposure_time_s=exposure_s, iso=100
        )
        image = rc.render(scene, camera, spp=wanted.spp, effects=(), max_bounces=0, device=wanted.device)
        row, column = (1 - y) * pixels, (1 + x) * pixels
        tile[row : row + pixels, column : column + pixels] = image.developed("linear") / 255
    return tile


def sheet(study: rc.ToleranceStudy, order: np.ndarray, tiles: list[np.ndarray], wanted) -> Figure:
    """The tiles pixel by pixel, with the copy's number and the MTF of each star between the stars."""
    size, gap, head = tiles[0].shape[0], 6, 30
    columns = min(wanted.columns, len(tiles))
    rows = math.ceil(len(tiles) / columns)
    width, height = columns * (size + gap) + gap, rows * (size + gap) + gap + head
    figure = Figure((width / DPI, height / DPI))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(height, 0))
    axes.set_axis_off()
    title = (
        f"{len(tiles)} copies of {study.lens.name} at f/{wanted.f_number:g}, {wanted.grade} grade: MTF at "
        f"{study.frequencies_per_mm[study.middle_frequency]:g}/mm, best first. Amber is below three quarters of the "
        "lens as drawn, red below half"
    )
    axes.text(gap, head / 2, title, va="center", fontsize=6.5, parse_math=False)
    mtf = study.figures.mtf[..., study.middle_frequency].mean(2)
    drawn = study.nominal.mtf[0, ..., study.middle_frequency].mean(1)
    points = 72 / DPI * size / 12  # of a letter that is a twelfth of a tile high
    for index, (number, tile) in enumerate(zip(order, tiles, strict=True)):
        left, top = gap + index % columns * (size + gap), head + gap + index // columns * (size + gap)
        axes.imshow(tile, extent=(left, left + size, top + size, top), interpolation="nearest", aspect="auto")
        at = (left + size / 2, top + size / 6)
        axes.text(*at, f"{number}", color=WHITE, ha="center", va="center", fontsize=1.2 * points, weight="bold")
        for (x, y), value, best in zip(PLACES, mtf[number], drawn, strict=True):
            # Below the star in the middle; of those in the corners towards the middle of the tile's edge.
            across, down = (1 + x) / 2 * 2 / 3 + 1 / 6, (0.5 - 0.09 * y if x else 5 / 6)
            colour = RED if value < 0.5 * best else AMBER if value < 0.75 * best else WHITE
            at = (left + across * size, top + down * size)
            axes.text(*at, f"{value:.2f}", color=colour, ha="center", va="center", fontsize=points)
            if colour == RED:
                corner = left + (1 + x) / 3 * size, top + (1 - y) / 3 * size
                axes.add_patch(Rectangle(corner, size / 3, size / 3, fill=False, edgecolor=RED, linewidth=1))
        if index == len(order) - 1:
            frame = Rectangle((left - 3, top - 3), size + 6, size + 6, fill=False, edgecolor=RED, linewidth=2)
            axes.add_patch(frame)
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    return figure


if __name__ == "__main__":
    main()
