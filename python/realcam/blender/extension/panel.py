"""The panel in the properties of the camera."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from .lenses import f_numbers, lenses


class RealcamTurnRing(bpy.types.Operator):
    """Turn the ring of the diaphragm by a third of a stop"""

    bl_idname = "camera.realcam_turn_ring"
    bl_label = "Turn Ring"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012
    clicks: IntProperty(default=1)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        camera = getattr(context, "camera", None)
        return camera is not None and camera.realcam.lens in lenses()

    def execute(self, context: bpy.types.Context) -> set[str]:
        rings = context.camera.realcam
        numbers = f_numbers(rings.lens)
        stop = min(range(len(numbers)), key=lambda i: abs(numbers[i] - rings.f_number))
        rings.f_number = numbers[max(0, min(len(numbers) - 1, stop + self.clicks))]
        return {"FINISHED"}


class RealcamPanel(bpy.types.Panel):
    """Panel of the lens settings."""

    bl_idname = "CAMERA_PT_realcam"
    bl_label = "Real Lens"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"
    COMPAT_ENGINES = {"CYCLES"}  # noqa: RUF012

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.camera is not None and context.engine in cls.COMPAT_ENGINES

    def draw(self, context: bpy.types.Context) -> None:
        camera = context.camera
        rings = camera.realcam
        layout = self.layout
        layout.use_property_split = True
        layout.prop(rings, "lens")
        if rings.lens not in lenses():
            return
        figures = lenses()[rings.lens]
        layout.prop(rings, "film")
        ring = layout.row(align=True)
        ring.prop(rings, "f_number", text=f"f-number (from {figures['f_number']:.3g})")
        ring.operator("camera.realcam_turn_ring", text="", icon="TRIA_LEFT").clicks = -1
        ring.operator("camera.realcam_turn_ring", text="", icon="TRIA_RIGHT").clicks = 1
        focus = layout.column()
        focus.prop(camera.dof, "focus_object", text="Focus on Object")
        distance = focus.column()
        distance.active = camera.dof.focus_object is None
        distance.prop(camera.dof, "focus_distance", text="Focus Distance")
        focus.label(text=f"Measured from the film, at the camera's origin; nearest {figures['nearest_m']:.3g} m")
        blades = layout.column()
        blades.prop(rings, "blades")
        shape = blades.column()
        shape.active = rings.blades > 2
        shape.prop(rings, "rounding")
        shape.prop(rings, "rotation_deg")
        if figures["disperses"]:
            layout.prop(rings, "dispersion")
        layout.prop(rings, "keep_brightness")


CLASSES = (RealcamTurnRing, RealcamPanel)


def register() -> None:
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
