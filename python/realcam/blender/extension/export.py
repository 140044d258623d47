"""Export to realcam: the scene as glTF with realcam's camera pose, and a shot file with the lens settings."""

from __future__ import annotations

import json
import math
from pathlib import Path

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper
from mathutils import Vector

from .lenses import film_mm, lenses


class RealcamExportShot(bpy.types.Operator, ExportHelper):
    """Write the scene (.glb) and a shot file (.toml) that realcam renders through the same lens"""

    bl_idname = "export_scene.realcam"
    bl_label = "Export realcam Shot"
    filename_ext = ".toml"
    filter_glob: StringProperty(default="*.toml", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        camera = context.scene.camera
        return camera is not None and camera.data.realcam.lens in lenses()

    def execute(self, context: bpy.types.Context) -> set[str]:
        write_shot(context.scene, Path(self.filepath))
        return {"FINISHED"}


def write_shot(scene: bpy.types.Scene, path: Path) -> None:
    """Writes the shot file and, beside it, the scene as .glb.

    The camera is a perspective one meanwhile, because glTF has no custom cameras.
    """
    camera = scene.camera.data
    camera.type = "PERSP"
    try:
        bpy.ops.export_scene.gltf(
            filepath=str(path.with_suffix(".glb")), export_format="GLB", export_cameras=True, export_lights=True
        )
    finally:
        camera.type = "CUSTOM"
    path.write_text(shot_text(scene, path.with_suffix(".glb").name), encoding="utf-8")


def shot_text(scene: bpy.types.Scene, scene_file: str) -> str:
    """The shot file. scene_file: name of the .glb."""
    rings = scene.camera.data.realcam
    figures = lenses()[rings.lens]
    width_mm, height_mm = film_mm(rings.lens, rings.film)
    # Blender fits the film's longer side to the picture's longer side; the other side follows from the aspect ratio.
    columns, rows = scene.render.resolution_x, scene.render.resolution_y
    longer_mm = max(width_mm, height_mm)
    film = [longer_mm * columns / max(columns, rows), longer_mm * rows / max(columns, rows)]
    world_from_camera = scene.camera.matrix_world
    focus_m = max(_focus_m(scene), figures["nearest_m"])
    lines = [
        "format = 1",
        f"scene = {_toml_text(scene_file)}",
        # Written as a pose, not as glTF's camera: realcam puts the entrance pupil at a glTF camera, but this is the
        # film.
        f"position_m = {_triple(world_from_camera.translation)}",
        f"look_at_m = {_triple(world_from_camera.translation - world_from_camera.col[2].xyz)}",
        f"up = {_triple(world_from_camera.col[1].xyz)}",
        f"lens = {_toml_text(figures['name'])}",
        *([f"zoom = {_toml_text(figures['zoom'])}"] if figures["zoom"] else []),
        f"film_mm = [{film[0]:.6g}, {film[1]:.6g}]",
        f"resolution = [{columns}, {rows}]",
        f"focus_m = {focus_m:.9g}",
        f"f_number = {max(rings.f_number, figures['f_number']):.6g}",
    ]
    if rings.blades > 2:
        lines += [
            f"blades = {rings.blades}",
            f"blade_rounding = {rings.rounding:.6g}",
            f"blade_rotation_deg = {rings.rotation_deg:.6g}",
        ]
    return "\n".join(lines) + "\n"


def _toml_text(text: str) -> str:
    """TOML basic string: JSON's escapes are valid in it, but it also forbids a literal DEL."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _triple(vector: Vector) -> str:
    """Converts to the glTF frame, in which y is up."""
    return f"[{vector.x:.9g}, {vector.z:.9g}, {-vector.y:.9g}]"


def _focus_m(scene: bpy.types.Scene) -> float:
    """Focus distance from the film; inf without depth of field."""
    dof = scene.camera.data.dof
    if not dof.use_dof:
        return math.inf
    distance = dof.focus_distance
    if dof.focus_object is not None:
        # Distance along the camera axis, as Cycles defines it.
        to_camera = scene.camera.matrix_world.normalized().inverted()
        distance = abs((to_camera @ dof.focus_object.matrix_world.translation).z)
    return distance * scene.unit_settings.scale_length


def _menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.operator(RealcamExportShot.bl_idname, text="realcam Shot (.toml, .glb)")


def register() -> None:
    bpy.utils.register_class(RealcamExportShot)
    bpy.types.TOPBAR_MT_file_export.append(_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_export.remove(_menu)
    bpy.utils.unregister_class(RealcamExportShot)
