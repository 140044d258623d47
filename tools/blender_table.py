"""Measures bundled lenses in Blender's Cycles against realcam, and writes the table of docs/blender.md.

    python tools/blender_table.py [LENS ...] -o docs/generated/blender.md

Needs bpy 5.0.1, which is for Python 3.11, beside realcam: pip install bpy==5.0.1 "numpy<2".
"""

from __future__ import annotations

import argparse
import math
import resource
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import realcam as rc
from realcam._core import _film_of_white
from realcam.osl import focus_range, shader_text
from realcam.osl.expressible import check_expressible

PLACES = (0.0, 0.3, 0.55, 0.8, 0.95)
IMAGE_ENDS_AT = 0.1
"""Of the light in the middle: beyond this the film is taken for dark."""


class Cycles:
    """A scene of Blender with nothing in it but a camera and a white world."""

    def __init__(self, columns: int, rows: int, spp: int) -> None:
        import bpy

        self.bpy = bpy
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.render.resolution_x, scene.render.resolution_y = columns, rows
        scene.render.threads_mode, scene.render.threads = "FIXED", 2
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.cycles.samples, scene.cycles.seed = spp, 1
        scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
        scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 1.0
        scene.world = bpy.data.worlds.new("world")
        scene.world.use_nodes = True
        self.world(1.0)
        scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(scene.camera)

    def world(self, radiance: float) -> None:
        background = self.scene.world.node_tree.nodes["Background"]
        background.inputs[0].default_value = (radiance, radiance, radiance, 1)

    def use(self, shader: str, film_mm: tuple[float, float], **parameters: float) -> None:
        """The camera's shader. bpy lacks the module that reads a shader's parameters, so they are set by name."""
        import _cycles

        folder = Path(tempfile.mkdtemp())
        (folder / "lens.osl").write_text(shader)
        if not _cycles.osl_compile(str(folder / "lens.osl"), str(folder / "lens.oso")):
            raise SystemExit("the shader does not compile")
        camera = self.scene.camera.data
        camera.sensor_fit = "HORIZONTAL"
        camera.sensor_width, camera.sensor_height = film_mm
        camera.type, camera.custom_mode = "CUSTOM", "EXTERNAL"
        camera.custom_filepath = str(folder / "lens.oso")
        for name, value in parameters.items():
            camera.cycles_custom[name] = value

    def render(self) -> tuple[np.ndarray, float]:
        """(rows, columns, 3) from the top left, and the seconds of CPU time that it took."""
        target = Path(tempfile.mkdtemp()) / "picture.exr"
        self.scene.render.filepath = str(target)
        before = _cpu_s()
        self.bpy.ops.render.render(write_still=True)
        took_s = _cpu_s() - before
        image = self.bpy.data.images.load(str(target))
        columns, rows = image.size
        pixels = np.array(image.pixels[:]).reshape(rows, columns, 4)[::-1, :, :3].copy()
        self.bpy.data.images.remove(image)
        return pixels, took_s


def _cpu_s() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def film_size(lens: rc.Lens, columns: int) -> tuple[int, int]:
    width_mm, height_mm = lens.film_mm
    return columns, round(columns * height_mm / width_mm)


def light_at(lens: rc.Lens, shader: str) -> dict[str, float]:
    """The largest error of the film's irradiance under a white world at five places, and the rays that pass."""
    width_mm, height_mm = lens.film_mm
    half_mm = 0.5 * math.hypot(width_mm, height_mm)
    radii_mm = np.linspace(0, half_mm, 60)
    light = np.array([lens.film_pupil((radius, 0.0)).irradiance for radius in radii_mm])
    image_mm = radii_mm[light > IMAGE_ENDS_AT * light[0]].max()
    columns, rows = film_size(lens, 90)
    cycles = Cycles(columns, rows, 1024)
    cycles.use(shader, lens.film_mm, dispersion=0, keep_brightness=0)
    picture = cycles.render()[0][..., 1]
    cycles.use(shader.replace("throughput = brightness * film;", "throughput = 1;"), lens.film_mm, dispersion=0)
    passed = cycles.render()[0][..., 1]
    x_mm = ((np.arange(columns) + 0.5) / columns - 0.5) * width_mm
    y_mm = ((np.arange(rows) + 0.5) / rows - 0.5) * height_mm
    distance_mm = np.hypot(x_mm, y_mm[:, None])
    errors = []
    for place in PLACES:
        # The pixels at this distance, of which there are some all round the axis: a lens of revolution lights them
        # alike, apart from their distance.
        near = np.argsort(np.abs(distance_mm - place * image_mm), axis=None)[:12]
        wanted = np.array([lens.film_pupil((radius, 0.0)).irradiance for radius in distance_mm.flat[near]])
        errors.append(picture.flat[near].mean() / wanted.mean() - 1)
    return {
        "centre": light[0],
        "worst_percent": 100 * max(errors, key=abs),
        "image_mm": image_mm,
        "pass_percent": 100 * passed[distance_mm < image_mm].mean(),
    }


def cost_of(shader: str, lens: rc.Lens) -> float:
    """CPU time over that of Blender's own camera with depth of field, of a room of diffuse walls and three balls."""
    cycles = Cycles(*film_size(lens, 180), 32)
    bpy = cycles.bpy
    cycles.world(0.0)
    bpy.ops.mesh.primitive_cube_add(size=8)
    for i in range(3):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.6, location=(1.4 * i - 1.4, 0.5 * i, -2.5), segments=64)
    bpy.ops.object.light_add(type="AREA", location=(0, 3.5, 0), rotation=(-math.pi / 2, 0, 0))
    bpy.context.object.data.energy = 500
    camera = cycles.scene.camera.data
    camera.sensor_width, camera.sensor_height = lens.film_mm
    camera.lens = abs(lens.first_order().effective_focal_length_mm)
    camera.dof.use_dof, camera.dof.focus_distance = True, 2.5
    camera.dof.aperture_fstop = lens.first_order().f_number
    times: dict[str, list[float]] = {"own": [], "lens": []}
    cycles.render()
    for _ in range(3):
        camera.type = "PERSP"
        times["own"].append(cycles.render()[1])
        cycles.use(shader, lens.film_mm)
        times["lens"].append(cycles.render()[1])
    return min(times["lens"]) / min(times["own"])


def light_of_point(lens: rc.Lens, point_mm: np.ndarray, wavelength_nm: float) -> tuple[np.ndarray, np.ndarray]:
    """(N, 2) places on the film, and weights, of the light of a point in the lens's frame: rays to its front."""
    rim_mm = 1.05 * lens.surfaces[0].clear_semi_diameter_mm
    side = np.linspace(-rim_mm, rim_mm, 301)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    front = np.stack([x, y, np.full_like(x, min(0.0, lens.surfaces[0].sag_mm(0.999 * rim_mm / 1.05)))], axis=1)
    way = front - point_mm
    away_mm = np.linalg.norm(way, axis=1, keepdims=True)
    weight = way[:, 2] / away_mm[:, 0] ** 3
    traced = lens.trace(np.tile(point_mm, (len(way), 1)), way / away_mm, start="scene", wavelength_nm=wavelength_nm)
    passed = traced.status == 0
    from_mm, ways = traced.origins_mm[passed], traced.directions[passed]
    to_film = (lens.film_position_mm - from_mm[:, 2]) / ways[:, 2]
    return (from_mm + to_film[:, None] * ways)[:, :2], weight[passed]


def centroid(places: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return (weights[:, None] * places).sum(axis=0) / weights.sum()


class Lamp:
    """A small ball that shines, of which a window of the film is rendered and compared with traced rays."""

    def __init__(self, lens: rc.Lens, radius_mm: float, distance_m: float) -> None:
        self.lens, self.distance_m = lens, distance_m
        angle = math.atan2(lens.film_mm[1], lens.film_mm[0])
        film_mm = radius_mm * np.array([math.cos(angle), math.sin(angle)])
        camera = rc.Camera(lens)
        columns, rows = camera.film.resolution
        pixel = (0.5 - film_mm / [camera.film.width_mm, camera.film.height_mm]) * [columns, rows]
        # Rows go downwards.
        origin, way, *_ = camera.ray([[pixel[0], rows - pixel[1]]])
        self.point_m = origin[0] + distance_m * way[0]
        self.point_mm = 1e3 * self.point_m + [0, 0, lens.film_position_mm]
        self.places, self.weights = light_of_point(lens, self.point_mm, lens.wavelength_nm)
        self.middle_mm = centroid(self.places, self.weights)
        spread = ((self.places - self.middle_mm) ** 2).sum(axis=1)
        self.size_mm = math.sqrt((self.weights * spread).sum() / self.weights.sum())

    def render(self, shader: str, half_mm: float, pixels: int, spp: int, **parameters: float) -> np.ndarray:
        """(3, 4): of each channel its light, the place of its middle on the film in mm, and its size in mm."""
        self.ball_m = 0.1 * half_mm * self.distance_m / abs(self.lens.first_order().effective_focal_length_mm)
        cycles = Cycles(pixels, pixels, spp)
        bpy = cycles.bpy
        cycles.world(0.0)
        bpy.ops.mesh.primitive_uv_sphere_add(radius=self.ball_m, location=self.point_m, segments=64, ring_count=32)
        material = bpy.data.materials.new("lamp")
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        shine = nodes.new("ShaderNodeEmission")
        material.node_tree.links.new(shine.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs[0])
        bpy.context.object.data.materials.append(material)
        window = shader
        for axis in (0, 1):
            text = f"(0.5 - raster[{axis}]) * size[{axis}]"
            assert text in window
            window = window.replace(text, f"{self.middle_mm[axis]:.9g} + (0.5 - raster[{axis}]) * {2 * half_mm:.9g}", 1)
        cycles.use(window, (36.0, 36.0), **parameters)
        picture = cycles.render()[0]
        side = (0.5 - (np.arange(pixels) + 0.5) / pixels) * 2 * half_mm
        x, y = self.middle_mm[0] + side, self.middle_mm[1] - side[:, None] + 0 * side
        result = []
        for channel in range(3):
            light = picture[..., channel]
            total = light.sum()
            middle = (light * x).sum() / total, (light * y).sum() / total
            spread = (light * ((x - middle[0]) ** 2 + (y - middle[1]) ** 2)).sum() / total
            result.append([total, *middle, math.sqrt(max(spread, 0))])
        return np.array(result)

    def ball_size_mm(self) -> float:
        """Of the ball's image alone, as the mean square distance from its middle."""
        step_mm = 100 * self.ball_m
        square = 0.0
        for axis in (0, 1):
            moved = self.point_mm + step_mm * np.eye(3)[axis]
            moved_to = centroid(*light_of_point(self.lens, moved, self.lens.wavelength_nm))
            square += float(((moved_to - self.middle_mm) ** 2).sum()) / step_mm**2
        return math.sqrt(square * (1e3 * self.ball_m) ** 2 / 4)


def lamps_of(lens: rc.Lens, shader: str, image_mm: float) -> dict[str, float]:
    """Largest errors of places and sizes of lamps out of focus, in pixels of a picture of 1920 columns, and the error
    of the lateral colour of a lamp in focus near the edge of the image, between the blue and the red channel."""
    pixel_mm = lens.film_mm[0] / 1920
    focus_m = max(60e-3 * abs(lens.first_order().effective_focal_length_mm), 1.5 * focus_range(lens).nearest_m)
    lens = lens.focused(focus_m)
    place, size = 0.0, 0.0
    for share in (0.0, 0.5, 0.85):
        lamp = Lamp(lens, share * image_mm, 2 * focus_m)
        found = lamp.render(shader, 3 * lamp.size_mm + 2 * pixel_mm, 64, 1024, dispersion=0, focus_m=focus_m)[1]
        wanted_mm = math.hypot(lamp.size_mm, lamp.ball_size_mm())
        place = max(place, float(np.hypot(*(found[1:3] - lamp.middle_mm))))
        size = max(size, abs(found[3] - wanted_mm))
    lamp = Lamp(lens, 0.85 * image_mm, focus_m)
    cells = _film_of_white("D65")
    middles = np.array([centroid(*light_of_point(lens, lamp.point_mm, nm)) for nm in cells[1::3, :2].mean(axis=1)])
    whites = cells.reshape(64, 3, 5)[..., 2:].mean(axis=1)
    wanted = (whites[:, 2:] * middles - whites[:, :1] * middles).mean(axis=0)
    colour = math.nan
    if "int dispersion = 1" in shader and np.hypot(*wanted) > 0.3 * pixel_mm:
        half_mm = 3 * (np.ptp(middles, axis=0).max() + lamp.size_mm + pixel_mm)
        found = lamp.render(shader, half_mm, 64, 1024, focus_m=focus_m)
        along = (found[2, 1:3] - found[0, 1:3]) @ wanted / (wanted @ wanted)
        colour = 100 * (along - 1)
    return {"place_px": place / pixel_mm, "size_px": size / pixel_mm, "colour_percent": colour}


def measured(name: str) -> dict[str, Any]:
    lens = rc.Lens.load(name)
    check_expressible(lens)
    lens = lens.focused(math.inf)
    shader = shader_text(lens)
    row = {"name": name, **light_at(lens, shader), "cost": cost_of(shader, lens)}
    row |= lamps_of(lens, shader, row["image_mm"])
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("lenses", nargs="*")
    parser.add_argument("-o", "--output", type=Path, required=True)
    given = parser.parse_args()
    columns = "| lens | irradiance, middle | largest error | rays that pass | cost | place | size | lateral colour |"
    lines = [columns, "|---|---|---|---|---|---|---|---|"]
    for name in given.lenses or rc.lens_names():
        try:
            row = measured(name)
        except rc.InputError as error:
            lines.append(f"| `{name}` | | | | | | | refused: {str(error).rpartition(': ')[2]} |")
            continue
        colour = f"{row['colour_percent']:+.1f}%" if math.isfinite(row["colour_percent"]) else "none"
        lines.append(
            f"| `{name}` | {row['centre']:.5f} | {row['worst_percent']:+.2f}% | {row['pass_percent']:.0f}% | "
            f"{row['cost']:.2f} | {row['place_px']:.3f} px | {row['size_px']:.3f} px | {colour} |"
        )
        print(lines[-1], flush=True)
        given.output.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
