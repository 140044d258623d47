"""Lens settings stored with each camera, and their effect on the camera."""

from __future__ import annotations

from zlib import crc32

import bpy
from bpy.app.handlers import persistent
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from .lenses import FILMS_MM, film_mm, lenses, shader_of

# Blender does not hold a reference to the strings of an enum's items, so they must be kept alive here.
_MENU: list[tuple[str, str, str, str, int]] = []


def lens_menu(_self: object, _context: object) -> list[tuple[str, str, str, str, int]]:
    """Items of the enum of lenses: key, name, description, icon and number.

    The number is a hash of the key: .blend files store it, so that it must not depend on the lenses of the extension.
    """
    if not _MENU:
        _MENU.append(("none", "None: Blender's own", "A perspective camera", "", 0))
        _MENU.extend(
            (key, lens["title"], lens["source"], "", crc32(key.encode()) >> 1) for key, lens in lenses().items()
        )
    return _MENU


def set_lens(self: RealcamLens, _context: object) -> None:
    """Assigns the lens shader to the camera as a text block of the .blend file, which then works without the
    extension."""
    camera = self.id_data
    if self.lens not in lenses():
        camera.type = "PERSP"
        return
    name = f"{self.lens}.osl"
    text = bpy.data.texts.get(name) or bpy.data.texts.new(name)
    text.from_string(shader_of(self.lens))
    camera.type = "CUSTOM"
    camera.custom_mode = "INTERNAL"
    _compile(camera, text)
    # Without Cycles the viewport shows a perspective camera; it gets the same field of view.
    camera.lens = lenses()[self.lens]["focal_length_mm"]
    if not camera.dof.use_dof:
        camera.dof.use_dof = True
        camera.dof.focus_distance = 10 / bpy.context.scene.unit_settings.scale_length
    set_film(self, None)
    set_rings(self, None)


def set_film(self: RealcamLens, _context: object) -> None:
    """Sets the camera's sensor to the film."""
    if self.lens not in lenses():
        return
    camera = self.id_data
    width_mm, height_mm = film_mm(self.lens, self.film)
    camera.sensor_width, camera.sensor_height = width_mm, height_mm
    # In a picture taller than wide, the film is in portrait orientation.
    camera.sensor_fit = "AUTO"


def set_rings(self: RealcamLens, _context: object) -> None:
    """Passes the settings to the shader."""
    if self.lens in lenses():
        _set_parameters(self.id_data, self, bpy.context.scene)


@persistent
def follow(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Updates the shaders from the settings at this frame: keyframes and units change without a call of `set_rings`."""
    for camera in bpy.data.cameras:
        rings = camera.evaluated_get(depsgraph).realcam
        if rings.lens in lenses():
            _set_parameters(camera, rings, scene)


def _compile(camera: bpy.types.Camera, text: bpy.types.Text) -> None:
    """Assigns a shader. Blender compiles it by the scene's engine, so that Cycles is made the engine meanwhile."""
    render = bpy.context.scene.render
    engine, render.engine = render.engine, "CYCLES"
    try:
        camera.custom_shader = None
        camera.custom_shader = text
    finally:
        render.engine = engine


def _set_parameters(camera: bpy.types.Camera, rings: RealcamLens, scene: bpy.types.Scene) -> None:
    """Sets the parameters of the camera's shader if they have changed."""
    parameters = {
        "focus_m": 0.0,  # the focus of Blender's depth of field, which can be an object
        "f_number": max(rings.f_number, lenses()[rings.lens]["f_number"]),
        "blades": float(rings.blades),
        "rounding": rings.rounding,
        "rotation_deg": rings.rotation_deg,
        "dispersion": int(rings.dispersion),
        "keep_brightness": int(rings.keep_brightness),
        "metres_per_unit": scene.unit_settings.scale_length,
    }
    if any(camera.cycles_custom.get(name) != value for name, value in parameters.items()):
        for name, value in parameters.items():
            camera.cycles_custom[name] = value
        camera.update_tag()


class RealcamLens(bpy.types.PropertyGroup):
    """Settings of a camera's lens."""

    lens: EnumProperty(name="Lens", items=lens_menu, update=set_lens)
    film: EnumProperty(name="Film", items=[(key, name, "") for key, (name, _) in FILMS_MM.items()], update=set_film)
    f_number: FloatProperty(
        name="f-number",
        default=0.0,
        min=0.0,
        max=64.0,
        precision=1,
        update=set_rings,
        description="f-number of the diaphragm; values below the smallest of the lens mean wide open",
    )
    blades: IntProperty(
        name="Blades",
        default=0,
        min=0,
        max=16,
        update=set_rings,
        description="Number of diaphragm blades; 0 to 2: circular",
    )
    rounding: FloatProperty(
        name="Rounding",
        default=0.0,
        min=0.0,
        max=1.0,
        update=set_rings,
        description="Rounding of the blades; 0: straight, 1: circular",
    )
    rotation_deg: FloatProperty(name="Rotation", default=0.0, update=set_rings, description="Rotation of the diaphragm")
    dispersion: BoolProperty(
        name="Dispersion", default=True, update=set_rings, description="Refractive indices depend on the wavelength"
    )
    keep_brightness: BoolProperty(
        name="Keep Brightness",
        default=True,
        update=set_rings,
        description="Same brightness at the picture's centre at any f-number; otherwise the illuminance of the film",
    )


def register() -> None:
    bpy.utils.register_class(RealcamLens)
    bpy.types.Camera.realcam = PointerProperty(type=RealcamLens)
    bpy.app.handlers.frame_change_post.append(follow)


def unregister() -> None:
    bpy.app.handlers.frame_change_post.remove(follow)
    del bpy.types.Camera.realcam
    bpy.utils.unregister_class(RealcamLens)
    _MENU.clear()
