"""Bundled lenses as OSL cameras of Cycles against realcam's own pictures: light, lost rays, lamps, colours and cost.

    python benchmarks/against_cycles.py [LENS ...] [--cost] [-o TABLE.md]

Needs Blender's Python package bpy, which has its own version of Python. Half a minute of CPU time a lens. Light is that
of a white world in five places from the middle to a corner, or to the edge of a smaller image. Lamps are squares in six
places of the film; in focus they show distortion, out of focus the bokeh. A figure is the largest error of all
places, beside the largest noise, which pairs of pictures with two seeds show.

Colours are the distance of a lamp's red image from its blue one, compared with rays through glasses of exact index.

With --cost there is the CPU time of a ray that passes over that of a ray of Cycles' own camera, in a closed room with a
lamp. The time in which Blender compiles a shader is not in it.
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
from realcam.osl import focus_range, shader_text, wide_f_number
from realcam.osl.expressible import check_expressible

WIDE = 1200
"""Pixels along the longer side of the film; a tenth of one is 3 um of a film of 36 mm."""
FINE = (12000, 3000)
"""The same where colours are measured, the first in which the image of the lamp has room. They are measured at this
f-number or wide open: so the images are small."""
COLOUR_F_NUMBER = 8.0
ENDS_NM = (400.0, 550.0, 700.0)
"""Pupils of these wavelengths hold between them those of all others."""
LARGEST_PX = 128
"""Sides of the picture of a lamp."""
BLUR_PX = 12
LAMPS = [(0.0, 0.0), (-0.9, -0.6), (-0.6, 0.9), (0.0, 0.5), (0.6, -0.2), (0.9, 0.9)]
"""In half sides of the film. A picture that is mirrored or upside down has them elsewhere."""
SIDE_M = 10.0
"""Of the room in which the cost is measured."""


class Row(NamedTuple):
    lens: str
    irradiance: float
    light: list[tuple[float, float]]
    """In five places the error as a share, and its noise."""
    passing: float
    distortion_px: tuple[float, float]
    bokeh_px: tuple[float, float]
    colour_um: tuple[float, float, float]
    """Red to blue by realcam's rays, what Cycles has more, and the noise."""
    cost: float
    """NaN: not measured."""


class Frame:
    """A film whose pixels both programs count alike."""

    def __init__(self, lens: rc.Lens, longer: int) -> None:
        self.pitch_mm = max(lens.film_mm) / longer
        self.resolution = (round(lens.film_mm[0] / self.pitch_mm), round(lens.film_mm[1] / self.pitch_mm))
        self.film_mm = (self.resolution[0] * self.pitch_mm, self.resolution[1] * self.pitch_mm)

    def window(self, place: tuple[float, float], side: int) -> Window:
        """About a place, in half sides of the film to the right and up, as far as the film goes."""
        columns, rows = self.resolution
        side_x, side_y = min(side, columns), min(side, rows)
        column = round(0.5 * columns * (1 + place[0]) - 0.5 * side_x)
        row = round(0.5 * rows * (1 - place[1]) - 0.5 * side_y)
        return Window(min(max(column, 0), columns - side_x), min(max(row, 0), rows - side_y), side_x, side_y)

    def camera(self, lens: rc.Lens, window: Window | None = None) -> rc.Camera:
        """realcam's, with the film of the window alone."""
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


def lit_share(lens: rc.Lens) -> float:
    """How far towards the corner the light is a tenth of that in the middle, as a share of the way."""
    shares = np.linspace(0, 1, 51)
    width_mm, height_mm = lens.film_mm
    light = [lens.film_pupil((0.5 * s * width_mm, 0.5 * s * height_mm)).irradiance for s in shares]
    return float(shares[np.array(light) > 0.1 * light[0]].max())


def light_errors(cycles: CyclesCamera, lens: rc.Lens, lit: float) -> tuple[float, list[tuple[float, float]]]:
    """The irradiance in the middle, and its errors in five places."""
    frame = Frame(lens, 300)
    cycles.film(*frame.film_mm, frame.resolution)
    cycles.background(1)
    # A scene has to have a triangle; this one is behind the camera.
    behind = rc.Scene.from_arrays([[0, 0, 1000], [1, 0, 1000], [0, 1, 1000]], [[0, 1, 2]])
    sky = behind.with_environment(1)
    errors = []
    for place in np.linspace(0, lit, 5):
        window = frame.window((place, place), 8)
        own = rc.render(sky, frame.camera(lens, window), effects=(), spp=2048)
        seen = [cycles.picture(512, window, seed)[..., 1].mean() for seed in (0, 1)]
        light = float(own.pixels[..., 1].mean())
        errors.append((np.mean(seen) / light - 1, 0.5 * abs(seen[1] - seen[0]) / light))
        if not place:
            middle = light
    cycles.background(0)
    return middle, errors


def passing(cycles: CyclesCamera, lens: rc.Lens, shader: str) -> float:
    """The share of rays that pass, in pixels with a tenth of the middle's light."""
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
    """A square that a lens sees at a place of its film, at a distance along the axis."""

    def __init__(self, frame: Frame, lens: rc.Lens, place: tuple[float, float], distance_m: float, side_px: float):
        columns, rows = frame.resolution
        pixel = np.array([0.5 * columns * (1 + place[0]), 0.5 * rows * (1 - place[1])])
        origins, ways = frame.camera(lens).ray(pixel + np.array([[0, 0], [1, 0], [0, 1]]))
        # Beside and behind the camera, the distance is that along the ray.
        points = origins + ways * distance_m / max(-ways[0, 2], 0.3)
        across, down = 0.5 * side_px * (points[1:] - points[0])
        self.vertices_m = points[0] + np.array([-across + down, across + down, across - down, -across - down])
        self.scene = rc.Scene.from_arrays(
            self.vertices_m, np.array([[0, 1, 2], [0, 2, 3]]), materials=[rc.Material(emission=(1, 1, 1))]
        )


def lit_window(frame: Frame, lens: rc.Lens, lamp: Lamp, place: tuple[float, float], effects: tuple[str, ...]) -> Window:
    """Out to where the lamp's light ends."""
    window = frame.window(place, LARGEST_PX)
    rough = rc.render(lamp.scene, frame.camera(lens, window), effects=effects, spp=16).pixels.sum(axis=2)
    rows, columns = (np.flatnonzero(rough.sum(axis=axis) > 1e-4 * rough.sum()) for axis in (1, 0))
    first = (max(columns[0] - 2, 0), max(rows[0] - 2, 0))
    last = (min(columns[-1] + 3, window.columns), min(rows[-1] + 3, window.rows))
    return Window(window.column + first[0], window.row + first[1], last[0] - first[0], last[1] - first[1])


def pictures_of(cycles: CyclesCamera, lamp: Lamp, window: Window) -> list[np.ndarray]:
    """Two pictures by Cycles, with 1024 samples in all."""
    cycles.mesh("lamp", lamp.vertices_m, np.array([[0, 1, 2, 3]]), 0, 1)
    return [cycles.picture(512, window, seed) for seed in (0, 1)]


def centroids(picture: np.ndarray) -> np.ndarray:
    """(3, 2): of each channel, column and row in pixels."""
    rows, columns = np.indices(picture.shape[:2])
    total = picture.sum(axis=(0, 1))
    return np.stack([(picture * axis[..., None]).sum(axis=(0, 1)) / total for axis in (columns, rows)], axis=1)


def radius(picture: np.ndarray) -> float:
    """The root mean square distance of green light from its middle."""
    rows, columns = np.indices(picture.shape[:2])
    column, row = centroids(picture)[1]
    squared = (columns - column) ** 2 + (rows - row) ** 2
    return math.sqrt((picture[..., 1] * squared).sum() / picture[..., 1].sum())


def lamp_errors(cycles: CyclesCamera, lens: rc.Lens, lit: float, lamp_m: float, focus_m: float) -> tuple[float, float]:
    """Of six lamps the largest error of place or radius in pixels, and its largest noise."""
    frame, focused = Frame(lens, WIDE), lens.focused(focus_m)
    cycles.film(*frame.film_mm, frame.resolution)
    cycles.data.cycles_custom["focus_m"] = focus_m
    errors, noise = [], []
    for x, y in LAMPS:
        place = (lit * x, lit * y)
        lamp = Lamp(frame, focused, place, lamp_m, 3)
        window = lit_window(frame, focused, lamp, place, ())
        camera = frame.camera(focused, window)
        own = [rc.render(lamp.scene, camera, effects=(), spp=1024, seed=seed).pixels for seed in (0, 1)]
        seen = pictures_of(cycles, lamp, window)
        measures = np.array([[np.append(centroids(each)[1], radius(each)) for each in pair] for pair in (own, seen)])
        errors.append(np.abs(np.diff(measures.mean(axis=1), axis=0)))
        noise.append(0.5 * np.hypot(*np.diff(measures, axis=1)))
    return float(np.max(errors)), float(np.max(noise))


def colour_of_rays(lens: rc.Lens, lamp: Lamp, outwards: np.ndarray) -> float:
    """From the red image of the lamp's middle to its blue one, um, by realcam's trace with each glass's own index."""
    data = lens.first_order()
    middle_mm = 1e3 * lamp.vertices_m.mean(axis=0) + [0, 0, lens.film_position_mm]
    # From before the lens, whose front may bulge.
    start_mm = min(0.0, lens.surfaces[0].sag_mm(lens.surfaces[0].clear_semi_diameter_mm)) - 1

    def traced(x_mm: np.ndarray, y_mm: np.ndarray, wavelength_nm: float) -> tuple[np.ndarray, np.ndarray]:
        """Which rays pass, towards a grid in the entrance pupil, and where they meet the film."""
        x, y = (axis.ravel() for axis in np.meshgrid(x_mm, y_mm))
        ways = np.stack([x, y, np.full_like(x, data.entrance_pupil_position_mm)], axis=1) - middle_mm
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        origins = middle_mm + ways * ((start_mm - middle_mm[2]) / ways[:, 2])[:, None]
        rays = lens.trace(origins, ways, start="scene", wavelength_nm=wavelength_nm)
        to_film = (lens.film_position_mm - rays.origins_mm[:, 2]) / rays.directions[:, 2]
        return rays.status == 0, (rays.origins_mm + to_film[:, None] * rays.directions)[:, :2]

    # The pupil of a wide lens moves and grows towards the corner: it is looked for farther and farther out.
    for reach in (0.75, 1.5, 3, 6, 12):
        across = np.linspace(-reach, reach, 121) * data.entrance_pupil_diameter_mm
        # Blue light has another pupil than red, where the front bends it much.
        lit = np.any([traced(across, across, at_nm)[0] for at_nm in ENDS_NM], axis=0).reshape(121, 121)
        if lit.any() and not (lit[[0, -1]].any() or lit[:, [0, -1]].any()):
            break
    else:
        return math.nan
    # Then a fine grid over it, as its edge has to be found to a hundredth of its width.
    margin = 2 * (across[1] - across[0])
    x_mm, y_mm = (
        np.linspace(at[0] - margin, at[-1] + margin, 141) for at in (across[lit.any(axis=0)], across[lit.any(axis=1)])
    )
    light, moments = np.zeros(3), np.zeros(3)
    for first_nm, last_nm, *white in _core._film_of_white("D65"):
        passed, places = traced(x_mm, y_mm, 0.5 * (first_nm + last_nm))
        light += np.array(white) * passed.sum()
        # The image is upside down.
        moments -= np.array(white) * (places[passed] @ outwards).sum()
    centroid = moments / light
    return float(1e3 * (centroid[2] - centroid[0]))


def colour_errors(
    cycles: CyclesCamera, lens: rc.Lens, shader: str, lit: float, lamp_m: float
) -> tuple[float, float, float]:
    """Of a lamp in focus near the corner, from its red image to its blue one away from the axis, um."""
    place = (0.85 * lit, 0.85 * lit)
    focused = lens.focused(lamp_m).stopped_down(max(COLOUR_F_NUMBER, wide_f_number(lens)))
    for longer in FINE:
        frame = Frame(lens, longer)
        lamp = Lamp(frame, focused, place, lamp_m, 20)
        window = lit_window(frame, focused, lamp, place, ("dispersion",))
        if LARGEST_PX not in (window.columns, window.rows):
            break
    else:
        return math.nan, math.nan, math.nan
    cycles.film(*frame.film_mm, frame.resolution)
    cycles.lens(shader, dispersion=1, keep_brightness=0, focus_m=lamp_m, f_number=COLOUR_F_NUMBER)
    seen = pictures_of(cycles, lamp, window)
    outwards = np.array(frame.film_mm) / math.hypot(*frame.film_mm)
    distances = [
        1e3 * frame.pitch_mm * float((outwards * [1, -1]) @ (centroids(each)[2] - centroids(each)[0]))
        for each in ((seen[0] + seen[1]) / 2, *seen)
    ]
    own = colour_of_rays(focused, lamp, outwards)
    return own, distances[0] - own, 0.5 * abs(distances[2] - distances[1])


def cost(cycles: CyclesCamera, lens: rc.Lens, shader: str, share: float) -> float:
    """CPU time of a ray that passes over that of a ray of Cycles' own camera, the least of some rounds."""
    frame, samples = Frame(lens, 60), 48
    cycles.film(*frame.film_mm, frame.resolution)
    corners = 0.5 * SIDE_M * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    walls = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    cycles.mesh("room", corners, walls, 0.7)
    cycles.mesh("lamp", 0.2 * corners[[2, 3, 7, 6]] + [0, 0.39 * SIDE_M, 0], np.array([[0, 1, 2, 3]]), 0, 1)
    data = lens.first_order()
    times: dict[str, list[float]] = {"thin": [], "real": []}
    for _ in range(4):
        cycles.thin_lens(abs(data.effective_focal_length_mm), data.f_number, 0.5 * SIDE_M)
        times["thin"].append(cycles.path_s(samples))
        cycles.lens(shader, f_number=0)
        times["real"].append(cycles.path_s(samples))
    cycles.remove("room")
    return min(times["real"]) / min(times["thin"]) / share


def measured(cycles: CyclesCamera, lens: rc.Lens, with_cost: bool) -> Row:
    shader, lens = shader_text(lens), lens.focused(math.inf)
    lit, data = lit_share(lens), lens.first_order()
    focal_mm = abs(data.effective_focal_length_mm)
    nearest_m = focus_range(lens).nearest_m
    lamp_m = max(0.06 * focal_mm, 3 * nearest_m)
    blur_mm = BLUR_PX * max(lens.film_mm) / WIDE
    # By first order, nearer than the lamp, so that its disc has this diameter.
    near_m = 1 / (1 / lamp_m + 1e3 * blur_mm * wide_f_number(lens) / focal_mm**2)
    cycles.remove("lamp")
    share = passing(cycles, lens, shader)
    cycles.lens(shader, keep_brightness=0, dispersion=0, focus_m=0, f_number=0)
    cycles.data.dof.use_dof = False
    irradiance, light = light_errors(cycles, lens, lit)
    return Row(
        lens.name,
        irradiance,
        light,
        share,
        lamp_errors(cycles, lens, lit, lamp_m, lamp_m),
        lamp_errors(cycles, lens, lit, lamp_m, max(near_m, nearest_m)),
        colour_errors(cycles, lens, shader, lit, lamp_m),
        cost(cycles, lens, shader, share) if with_cost else math.nan,
    )


HEADING = (
    "| lens | irradiance, middle | light | rays that pass | distortion, px | bokeh, px | red to blue, um | more, um |"
)


def line(row: Row) -> str:
    error, noise = (100 * np.abs(row.light).max(axis=0)).tolist()
    own, more, doubt = row.colour_um
    text = (
        f"| `{row.lens}` | {row.irradiance:.4f} | {error:.2f} ± {noise:.2f}% | {100 * row.passing:.0f}% "
        f"| {row.distortion_px[0]:.3f} ± {row.distortion_px[1]:.3f} | {row.bokeh_px[0]:.3f} ± {row.bokeh_px[1]:.3f} "
    )
    text += f"| {own:.2f} | {more:+.3f} ± {doubt:.3f} |" if math.isfinite(own) else "| | |"
    return text + (f" {row.cost:.2f} |" if math.isfinite(row.cost) else "")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lenses", nargs="*", default=rc.lens_names())
    parser.add_argument("--cost", action="store_true", help="also the cost, which takes twice as long")
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
