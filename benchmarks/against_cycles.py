"""Bundled lenses as OSL cameras of Cycles against realcam's own pictures: light, lost rays, lamps, colours and cost.

    python benchmarks/against_cycles.py [LENS ...] [--cost] [-o TABLE.md]

Needs Blender's Python package bpy, which requires its own version of Python. Takes half a minute of CPU time per lens.
Light: illuminance from a white environment at five film points from the centre to a corner, or to the edge of a smaller
image circle. Lamps: square emitters imaged to six film points; in focus they measure distortion, out of focus the
bokeh. Each column has the largest error over the film points, and the largest noise, from pairs of pictures with two
seeds.

Colours: distance of a lamp's red image from its blue one, compared with rays traced through glasses of exact index.

With --cost: CPU time of a ray that passes over that of a ray of Cycles' own camera, in a closed room with a lamp,
without the time in which Blender compiles the shader.
"""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
import realcam as rc
from cycles_camera import CyclesCamera, Window
from machine import machine
from realcam import _core
from realcam.osl import focus_range, shader_text
from realcam.osl.expressible import check_expressible

LAMP_COLUMNS = 1200
"""Pixels along the longer side of the film for lamps; a tenth of a pixel is 3 um of a film of 36 mm."""
COLOUR_COLUMNS = (12000, 3000)
"""Pixels along the longer side of the film for colours: the first of these in which the lamp's image fits a window."""
COLOUR_F_NUMBER = 8.0
"""f-number at which colours are measured, unless the lens is slower: a small aperture makes the images small."""
PUPIL_WAVELENGTHS_NM = (400.0, 550.0, 700.0)
"""Wavelengths whose pupils together cover those of all others."""
MAX_WINDOW_PX = 128
"""Largest side of the picture of a lamp."""
BLUR_PX = 12
"""Diameter of the disc of a lamp out of focus, in pixels of LAMP_COLUMNS."""
LAMPS = [(0.0, 0.0), (-0.9, -0.6), (-0.6, 0.9), (0.0, 0.5), (0.6, -0.2), (0.9, 0.9)]
"""Film points (x, y) in half sides of the film. They are not symmetric, so that a mirrored picture shows as an
error."""
ROOM_M = 10.0
"""Side of the room in which the cost is measured."""


class Row(NamedTuple):
    """Results of one lens; pairs are the largest error and its noise."""

    lens: str
    irradiance: float
    """Irradiance at the film's centre from an environment of radiance 1, by realcam."""
    light: list[tuple[float, float]]
    """Relative error of the irradiance at five film points."""
    passing: float
    """Fraction of the camera rays that pass the lens."""
    distortion_px: tuple[float, float]
    bokeh_px: tuple[float, float]
    colour_um: tuple[float, float, float]
    """Distance from the red to the blue image by realcam's rays, excess of Cycles over it, and noise."""
    cost: float
    """Relative CPU time of a ray; NaN: not measured."""


class Frame:
    """A film with square pixels and an integer resolution, which both programs divide into the same pixels."""

    def __init__(self, lens: rc.Lens, longer: int) -> None:
        self.pitch_mm = max(lens.film_mm) / longer
        self.resolution = (round(lens.film_mm[0] / self.pitch_mm), round(lens.film_mm[1] / self.pitch_mm))
        self.film_mm = (self.resolution[0] * self.pitch_mm, self.resolution[1] * self.pitch_mm)

    def window(self, point: tuple[float, float], side: int) -> Window:
        """Window of side x side pixels about a film point (x, y), in half sides of the film to the right and up; it is
        moved to lie within the film."""
        columns, rows = self.resolution
        side_x, side_y = min(side, columns), min(side, rows)
        column = round(0.5 * columns * (1 + point[0]) - 0.5 * side_x)
        row = round(0.5 * rows * (1 - point[1]) - 0.5 * side_y)
        return Window(min(max(column, 0), columns - side_x), min(max(row, 0), rows - side_y), side_x, side_y)

    def camera(self, lens: rc.Lens, window: Window | None = None) -> rc.Camera:
        """Camera of realcam whose film is the window; None: the whole film."""
        columns, rows = self.resolution
        window = window or Window(0, 0, columns, rows)
        film = rc.Film(
            window.columns * self.pitch_mm,
            window.rows * self.pitch_mm,
            (window.columns, window.rows),
            (
                (window.column + 0.5 * (window.columns - columns)) * self.pitch_mm,
                (0.5 * (rows - window.rows) - window.row) * self.pitch_mm,
            ),
        )
        return rc.Camera(lens, film=film, exposure_time_s=1)


def illuminated_fraction(lens: rc.Lens) -> float:
    """Fraction of the half diagonal of the film within which the irradiance is at least a tenth of the central one."""
    fractions = np.linspace(0, 1, 51)
    width_mm, height_mm = lens.film_mm
    light = [lens.film_pupil((0.5 * s * width_mm, 0.5 * s * height_mm)).irradiance for s in fractions]
    return float(fractions[np.array(light) > 0.1 * light[0]].max())


def light_errors(cycles: CyclesCamera, lens: rc.Lens, lit: float) -> tuple[float, list[tuple[float, float]]]:
    """Returns the irradiance at the film's centre by realcam, and (relative error, noise) of Cycles at five film
    points.

    lit: fraction of the half diagonal up to which the points lie.
    """
    frame = Frame(lens, 300)
    cycles.film(*frame.film_mm, frame.resolution)
    cycles.background(1)
    # A scene must have a triangle; this one is behind the camera.
    behind = rc.Scene.from_arrays([[0, 0, 1000], [1, 0, 1000], [0, 1, 1000]], [[0, 1, 2]])
    sky = behind.with_environment(1)
    errors = []
    for position in np.linspace(0, lit, 5):
        window = frame.window((position, position), 8)
        own = rc.render(sky, frame.camera(lens, window), effects=(), spp=2048)
        measured_light = [cycles.picture(512, window, seed)[..., 1].mean() for seed in (0, 1)]
        light = float(own.pixels[..., 1].mean())
        noise = 0.5 * abs(measured_light[1] - measured_light[0])
        errors.append((np.mean(measured_light) / light - 1, noise / light))
        if not position:
            central = light
    cycles.background(0)
    return central, errors


def passing(cycles: CyclesCamera, lens: rc.Lens, shader: str) -> float:
    """Fraction of the camera rays that pass the lens, over pixels with at least a tenth of the largest irradiance.

    shader: the lens's OSL text, which is changed so that the green channel counts the passing rays.
    """
    counted = shader.replace("throughput = brightness * film;", "throughput = color(brightness, 1, 0);")
    assert counted != shader
    frame = Frame(lens, 60)
    cycles.film(*frame.film_mm, frame.resolution)
    cycles.background(1)
    cycles.lens(counted, keep_brightness=0, dispersion=0, f_number=0)
    picture = cycles.picture(256)
    cycles.background(0)
    light, passed = picture[..., 0], picture[..., 1]
    return float(passed[light > 0.1 * light.max()].mean())


class Lamp:
    """A square emitter that a lens images to a film point.

    point: the film point, in half sides of the film. distance_m: along the axis. side_px: side of its image.
    """

    def __init__(self, frame: Frame, lens: rc.Lens, point: tuple[float, float], distance_m: float, side_px: float):
        columns, rows = frame.resolution
        pixel = np.array([0.5 * columns * (1 + point[0]), 0.5 * rows * (1 - point[1])])
        origins, directions = frame.camera(lens).ray(pixel + np.array([[0, 0], [1, 0], [0, 1]]))
        # For rays more than 72 degrees from the axis, a distance along the ray in place of the axis.
        points = origins + directions * distance_m / max(-directions[0, 2], 0.3)
        across, down = 0.5 * side_px * (points[1:] - points[0])
        self.vertices_m = points[0] + np.array([-across + down, across + down, across - down, -across - down])
        self.scene = rc.Scene.from_arrays(
            self.vertices_m, np.array([[0, 1, 2], [0, 2, 3]]), materials=[rc.Material(emission=(1, 1, 1))]
        )


def lit_window(frame: Frame, lens: rc.Lens, lamp: Lamp, point: tuple[float, float], effects: tuple[str, ...]) -> Window:
    """Smallest window about a film point that contains the lamp's image, but at most MAX_WINDOW_PX wide and high."""
    window = frame.window(point, MAX_WINDOW_PX)
    rough = rc.render(lamp.scene, frame.camera(lens, window), effects=effects, spp=16).pixels.sum(axis=2)
    rows, columns = (np.flatnonzero(rough.sum(axis=axis) > 1e-4 * rough.sum()) for axis in (1, 0))
    first = (max(columns[0] - 2, 0), max(rows[0] - 2, 0))
    last = (min(columns[-1] + 3, window.columns), min(rows[-1] + 3, window.rows))
    return Window(window.column + first[0], window.row + first[1], last[0] - first[0], last[1] - first[1])


def pictures_of(cycles: CyclesCamera, lamp: Lamp, window: Window) -> list[np.ndarray]:
    """Two pictures of the lamp by Cycles with different seeds, 512 samples each."""
    cycles.mesh("lamp", lamp.vertices_m, np.array([[0, 1, 2, 3]]), 0, 1)
    return [cycles.picture(512, window, seed) for seed in (0, 1)]


def centroids(picture: np.ndarray) -> np.ndarray:
    """(3, 2): column and row of the centroid of each channel, in pixels."""
    rows, columns = np.indices(picture.shape[:2])
    total = picture.sum(axis=(0, 1))
    return np.stack([(picture * axis[..., None]).sum(axis=(0, 1)) / total for axis in (columns, rows)], axis=1)


def radius(picture: np.ndarray) -> float:
    """RMS distance of the green light from its centroid, in pixels."""
    rows, columns = np.indices(picture.shape[:2])
    column, row = centroids(picture)[1]
    squared = (columns - column) ** 2 + (rows - row) ** 2
    return math.sqrt((picture[..., 1] * squared).sum() / picture[..., 1].sum())


def lamp_errors(cycles: CyclesCamera, lens: rc.Lens, lit: float, lamp_m: float, focus_m: float) -> tuple[float, float]:
    """Largest error over six lamps of the image's centroid or RMS radius, and the largest noise, in pixels.

    lit: fraction of the half diagonal that is illuminated. lamp_m: distance of the lamps; focus_m: distance in focus.
    """
    frame, focused = Frame(lens, LAMP_COLUMNS), lens.focused(focus_m)
    cycles.film(*frame.film_mm, frame.resolution)
    cycles.data.cycles_custom["focus_m"] = focus_m
    errors, noise = [], []
    for x, y in LAMPS:
        point = (lit * x, lit * y)
        lamp = Lamp(frame, focused, point, lamp_m, 3)
        window = lit_window(frame, focused, lamp, point, ())
        camera = frame.camera(focused, window)
        own = [rc.render(lamp.scene, camera, effects=(), spp=1024, seed=seed).pixels for seed in (0, 1)]
        theirs = pictures_of(cycles, lamp, window)
        # (program, seed, measure): column and row of the green centroid, and radius.
        measures = np.array([[np.append(centroids(each)[1], radius(each)) for each in pair] for pair in (own, theirs)])
        errors.append(np.abs(np.diff(measures.mean(axis=1), axis=0)))
        noise.append(0.5 * np.hypot(*np.diff(measures, axis=1)))
    return float(np.max(errors)), float(np.max(noise))


def colour_of_rays(lens: rc.Lens, lamp: Lamp, outwards: np.ndarray) -> float:
    """Distance from the red to the blue image of the lamp's centre, um, by realcam's ray trace with the exact indices.

    outwards: unit vector on the film away from its centre, as in the developed image. NaN if no pupil is found.
    """
    data = lens.first_order()
    centre_mm = 1e3 * lamp.vertices_m.mean(axis=0) + [0, 0, lens.film_position_mm]
    # Rays start in a plane in front of the lens, whose first surface may be concave.
    start_mm = min(0.0, lens.surfaces[0].sag_mm(lens.surfaces[0].clear_semi_diameter_mm)) - 1

    def traced(x_mm: np.ndarray, y_mm: np.ndarray, wavelength_nm: float) -> tuple[np.ndarray, np.ndarray]:
        """Traces rays to a grid in the entrance pupil. Returns which rays pass, and their film points, mm."""
        x, y = (axis.ravel() for axis in np.meshgrid(x_mm, y_mm))
        directions = np.stack([x, y, np.full_like(x, data.entrance_pupil_position_mm)], axis=1) - centre_mm
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        origins = centre_mm + directions * ((start_mm - centre_mm[2]) / directions[:, 2])[:, None]
        rays = lens.trace(origins, directions, start="scene", wavelength_nm=wavelength_nm)
        to_film = (lens.film_position_mm - rays.origins_mm[:, 2]) / rays.directions[:, 2]
        return rays.status == 0, (rays.origins_mm + to_film[:, None] * rays.directions)[:, :2]

    # The pupil of a wide lens moves and grows towards the corner, so that the search grid grows until it contains it.
    for half_width in (0.75, 1.5, 3, 6, 12):
        across = np.linspace(-half_width, half_width, 121) * data.entrance_pupil_diameter_mm
        # The pupil depends on the wavelength if the front elements refract strongly.
        lit = np.any([traced(across, across, nm)[0] for nm in PUPIL_WAVELENGTHS_NM], axis=0).reshape(121, 121)
        if lit.any() and not (lit[[0, -1]].any() or lit[:, [0, -1]].any()):
            break
    else:
        return math.nan
    # A fine grid over the pupil then resolves its edge to a hundredth of its width.
    margin = 2 * (across[1] - across[0])
    x_mm, y_mm = (
        np.linspace(axis[0] - margin, axis[-1] + margin, 141)
        for axis in (across[lit.any(axis=0)], across[lit.any(axis=1)])
    )
    light, moments = np.zeros(3), np.zeros(3)
    for first_nm, last_nm, *white in _core._film_of_white("D65"):
        passed, points = traced(x_mm, y_mm, 0.5 * (first_nm + last_nm))
        light += np.array(white) * passed.sum()
        # The image is upside down.
        moments -= np.array(white) * (points[passed] @ outwards).sum()
    centroid = moments / light
    return float(1e3 * (centroid[2] - centroid[0]))


def colour_errors(
    cycles: CyclesCamera, lens: rc.Lens, shader: str, lit: float, lamp_m: float
) -> tuple[float, float, float]:
    """Distances from the red to the blue image, outwards, of a lamp in focus near the corner, um.

    Returns that of realcam's rays, the excess of Cycles over it, and the noise; NaN if the image is too large.
    """
    point = (0.85 * lit, 0.85 * lit)
    focused = lens.focused(lamp_m).stopped_down(max(COLOUR_F_NUMBER, lens.wide_open().f_number))
    for columns in COLOUR_COLUMNS:
        frame = Frame(lens, columns)
        lamp = Lamp(frame, focused, point, lamp_m, 20)
        window = lit_window(frame, focused, lamp, point, ("dispersion",))
        if MAX_WINDOW_PX not in (window.columns, window.rows):
            break
    else:
        return math.nan, math.nan, math.nan
    cycles.film(*frame.film_mm, frame.resolution)
    cycles.lens(shader, dispersion=1, keep_brightness=0, focus_m=lamp_m, f_number=COLOUR_F_NUMBER)
    pictures = pictures_of(cycles, lamp, window)
    outwards = np.array(frame.film_mm) / math.hypot(*frame.film_mm)
    distances = [
        1e3 * frame.pitch_mm * float((outwards * [1, -1]) @ (centroids(each)[2] - centroids(each)[0]))
        for each in ((pictures[0] + pictures[1]) / 2, *pictures)
    ]
    own = colour_of_rays(focused, lamp, outwards)
    return own, distances[0] - own, 0.5 * abs(distances[2] - distances[1])


def cost(cycles: CyclesCamera, lens: rc.Lens, shader: str, passing_fraction: float) -> float:
    """CPU time of a passing ray over that of a ray of Cycles' own camera: ratio of the smallest times of four
    rounds."""
    frame, samples = Frame(lens, 60), 48
    cycles.film(*frame.film_mm, frame.resolution)
    corners = 0.5 * ROOM_M * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    walls = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    cycles.mesh("room", corners, walls, 0.7)
    cycles.mesh("lamp", 0.2 * corners[[2, 3, 7, 6]] + [0, 0.39 * ROOM_M, 0], np.array([[0, 1, 2, 3]]), 0, 1)
    data = lens.first_order()
    times: dict[str, list[float]] = {"thin": [], "real": []}
    for _ in range(4):
        cycles.thin_lens(abs(data.effective_focal_length_mm), data.f_number, 0.5 * ROOM_M)
        times["thin"].append(cycles.path_s(samples))
        cycles.lens(shader, f_number=0)
        times["real"].append(cycles.path_s(samples))
    cycles.remove("room")
    return min(times["real"]) / min(times["thin"]) / passing_fraction


def measured(cycles: CyclesCamera, lens: rc.Lens, with_cost: bool) -> Row:
    """Measures all columns of the table for one lens."""
    shader, lens = shader_text(lens), lens.focused(math.inf)
    lit, data = illuminated_fraction(lens), lens.first_order()
    focal_mm = abs(data.effective_focal_length_mm)
    nearest_m = focus_range(lens).nearest_m
    lamp_m = max(0.06 * focal_mm, 3 * nearest_m)
    blur_mm = BLUR_PX * max(lens.film_mm) / LAMP_COLUMNS
    # Focus distance, nearer than the lamp, at which its disc has this diameter, by first order.
    near_m = 1 / (1 / lamp_m + 1e3 * blur_mm * lens.wide_open().f_number / focal_mm**2)
    cycles.remove("lamp")
    passing_fraction = passing(cycles, lens, shader)
    cycles.lens(shader, keep_brightness=0, dispersion=0, focus_m=0, f_number=0)
    cycles.data.dof.use_dof = False
    irradiance, light = light_errors(cycles, lens, lit)
    return Row(
        lens.name,
        irradiance,
        light,
        passing_fraction,
        lamp_errors(cycles, lens, lit, lamp_m, lamp_m),
        lamp_errors(cycles, lens, lit, lamp_m, max(near_m, nearest_m)),
        colour_errors(cycles, lens, shader, lit, lamp_m),
        cost(cycles, lens, shader, passing_fraction) if with_cost else math.nan,
    )


HEADING = (
    "| lens | irradiance, middle | light | rays that pass | distortion, px | bokeh, px | red to blue, um | more, um |"
)


def line(row: Row) -> str:
    """Line of the table."""
    error, noise = (100 * np.abs(row.light).max(axis=0)).tolist()
    own, excess, noise_um = row.colour_um
    text = (
        f"| `{row.lens}` | {row.irradiance:.4f} | {error:.2f} ± {noise:.2f}% | {100 * row.passing:.0f}% "
        f"| {row.distortion_px[0]:.3f} ± {row.distortion_px[1]:.3f} | {row.bokeh_px[0]:.3f} ± {row.bokeh_px[1]:.3f} "
    )
    text += f"| {own:.2f} | {excess:+.3f} ± {noise_um:.3f} |" if math.isfinite(own) else "| | |"
    return text + (f" {row.cost:.2f} |" if math.isfinite(row.cost) else "")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lenses", nargs="*", default=rc.lens_names())
    parser.add_argument("--cost", action="store_true", help="also measure the cost, which takes twice as long")
    parser.add_argument("-o", "--output", type=Path)
    arguments = parser.parse_args()
    cycles = CyclesCamera()
    heading = HEADING + (" cost |" if arguments.cost else "")
    lines, refused = [heading, re.sub(r"[^|]+", "---", heading)], []
    for name in arguments.lenses:
        lens = rc.Lens.load(name)
        try:
            check_expressible(lens)
        except rc.InputError as error:
            refused.append(f"- {error}")
        else:
            lines.append(line(measured(cycles, lens, arguments.cost)))
        text = "\n".join([f"bpy {bpy.app.version_string}, {machine()}", "", *lines, "", *refused]) + "\n"
        if arguments.output:
            arguments.output.write_text(text)
    print(text)


if __name__ == "__main__":
    main()
