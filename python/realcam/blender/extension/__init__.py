"""Real lenses as cameras of Cycles: a panel in the properties of the camera."""

from __future__ import annotations

from pathlib import Path

import bpy

from . import export, panel, settings

FOLDER = Path(__file__).resolve().parent


def register() -> None:
    settings.register()
    panel.register()
    export.register()
    # Each lens with its film is a preset of the camera.
    bpy.utils.register_preset_path(str(FOLDER))


def unregister() -> None:
    bpy.utils.unregister_preset_path(str(FOLDER))
    export.unregister()
    panel.unregister()
    settings.unregister()
