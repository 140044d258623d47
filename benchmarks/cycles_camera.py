"""A camera of Cycles in Blender's Python package (bpy), whose pictures come back as arrays."""

from __future__ import annotations

import sys
import tempfile
import time
import types
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np

# bpy lacks the module with which Blender lists a shader's parameters; here they are set by name.
sys.modules.setdefault("oslquery", types.SimpleNamespace(OSLQuery=lambda path: None))


class Window(NamedTuple):
    """Pixels of a picture, from its upper left corner."""

    column: int
    row: int
    columns: int
    rows: int


class CyclesCamera:
    """A camera at the origin that looks along -z with y up, as realcam's cameras do by default."""

    def __init__(self) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
        # No path ends by chance because its camera ray has little weight.
        scene.cycles.min_light_bounces = scene.cycles.max_bounces
        # realcam's pixels are the mean over their area.
        scene.cycles.pixel_filter_type = "BOX"
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        self.folder = tempfile.TemporaryDirectory()
        scene.render.use_persistent_data = True
        scene.render.filepath = str(Path(self.folder.name) / "picture.exr")
        scene.world = bpy.data.worlds.new("world")
        scene.world.use_nodes = True
        self.background(0)
        self.data = bpy.data.cameras.new("camera")
        scene.camera = bpy.data.objects.new("camera", self.data)
        scene.collection.objects.link(scene.camera)

    def background(self, radiance: float) -> None:
        self.scene.world.node_tree.nodes["Background"].inputs[0].default_value = (radiance, radiance, radiance, 1)

    def film(self, width_mm: float, height_mm: float, resolution: tuple[int, int]) -> None:
        self.data.sensor_width, self.data.sensor_height = width_mm, height_mm
        self.scene.render.resolution_x, self.scene.render.resolution_y = resolution

    def lens(self, shader: str, **parameters: float) -> None:
        """Sets the OSL source of the camera's lens shader, and its parameters by name."""
        text = bpy.data.texts.get("lens.osl") or bpy.data.texts.new("lens.osl")
        if text.as_string() != shader:
            text.from_string(shader)
            self.data.type, self.data.custom_mode = "CUSTOM", "INTERNAL"
            self.data.custom_shader = None
            self.data.custom_shader = text
        self.data.type = "CUSTOM"
        for name, value in parameters.items():
            self.data.cycles_custom[name] = value
        self.data.update_tag()

    def thin_lens(self, focal_length_mm: float, f_number: float, focus_m: float) -> None:
        """Selects Cycles' own thin-lens camera."""
        self.data.type, self.data.lens = "PERSP", focal_length_mm
        self.data.dof.use_dof = True
        self.data.dof.aperture_fstop, self.data.dof.focus_distance = f_number, focus_m

    def mesh(self, name: str, vertices_m: np.ndarray, faces: np.ndarray, colour: float, radiance: float = 0.0) -> None:
        """Adds a mesh, diffuse or emitting if radiance is not 0, in place of an earlier one with this name."""
        self.remove(name)
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices_m.tolist(), [], faces.tolist())
        material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        shader = nodes.new("ShaderNodeEmission" if radiance else "ShaderNodeBsdfDiffuse")
        value = radiance or colour
        shader.inputs["Color"].default_value = (value, value, value, 1)
        material.node_tree.links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
        mesh.materials.append(material)
        self.scene.collection.objects.link(bpy.data.objects.new(name, mesh))

    def remove(self, name: str) -> None:
        """Removes a mesh, if there is one with this name."""
        if name in bpy.data.meshes:
            bpy.data.meshes.remove(bpy.data.meshes[name])

    def picture(self, samples: int, window: Window | None = None, seed: int = 0) -> np.ndarray:
        """Renders a picture, (rows, columns, 3), linear, row 0 at the top. window: None: the whole film."""
        render, cycles = self.scene.render, self.scene.cycles
        cycles.samples, cycles.seed = samples, seed
        render.use_border = render.use_crop_to_border = window is not None
        if window:
            # Blender rounds down to pixels, which it counts from the bottom.
            width, height = render.resolution_x, render.resolution_y
            bottom = height - window.row - window.rows
            render.border_min_x, render.border_max_x = (
                (column + 0.25) / width for column in (window.column, window.column + window.columns)
            )
            render.border_min_y, render.border_max_y = ((row + 0.25) / height for row in (bottom, bottom + window.rows))
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(render.filepath)
        width, height = image.size
        pixels = np.array(image.pixels[:]).reshape(height, width, 4)[::-1, :, :3]
        bpy.data.images.remove(image)
        return pixels

    def path_s(self, samples: int) -> float:
        """CPU time of this number of samples per pixel, without the setup of a picture.

        The time of a picture with one sample is subtracted; an earlier picture compiles the shader.
        """
        times = []
        for count in (1, 1, samples + 1):
            start = time.process_time()
            self.picture(count)
            times.append(time.process_time() - start)
        return times[2] - times[1]
