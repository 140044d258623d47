"""The demo scene through a lens by Cycles and by realcam, side by side: docs/images/blender.jpg.

    python benchmarks/cycles_picture.py docs/images/blender.jpg

Needs Blender's Python package bpy, which has its own version of Python. Takes about two minutes of CPU time.
"""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import bpy
import numpy as np
import realcam as rc
from cycles_camera import CyclesCamera
from mathutils import Matrix
from PIL import Image
from realcam.osl import shader_text

SCENES = Path(__file__).resolve().parent.parent / "scenes"
RESOLUTION, SAMPLES = (330, 220), 192
POSITION, LOOK_AT = np.array([0.0, 0.25, 1.1]), np.array([0.0, 0.12, 0.0])
FOCUS_M, EXPOSURE_S = 0.9, 0.01
DUSK_CD_M2 = (20.0, 28.0, 46.0)  # radiance of the environment, red, green and blue
LENS = "fast-50mm"


def by_realcam() -> rc.Image:
    """The denoised picture by realcam."""
    scene = rc.Scene.load(SCENES / "demo.glb").with_environment(DUSK_CD_M2)
    lens = rc.Lens.load(LENS).focused(FOCUS_M)
    camera = rc.Camera(
        lens,
        film=rc.Film(36, 24, RESOLUTION),
        position=tuple(POSITION),
        look_at=tuple(LOOK_AT),
        exposure_time_s=EXPOSURE_S,
    )
    settings = {
        "effects": {"dispersion"},
        "max_bounces": 6,
        "spp": SAMPLES,
        "layers": ["albedo", "normal", "traced_light"],
    }
    return rc.render(scene, camera, **settings).denoised()


def by_cycles() -> np.ndarray:
    """(rows, columns, 3): the film's illuminance, lux."""
    cycles = CyclesCamera()
    cycles.film(36, 24, RESOLUTION)
    bpy.ops.import_scene.gltf(filepath=str(SCENES / "demo.glb"))
    world = cycles.scene.world.node_tree.nodes["Background"].inputs
    world[0].default_value, world[1].default_value = (*np.array(DUSK_CD_M2) / 100, 1), 100
    cycles.lens(shader_text(rc.Lens.load(LENS)), focus_m=FOCUS_M, keep_brightness=0)
    backward = POSITION - LOOK_AT
    backward /= np.linalg.norm(backward)
    right = np.cross([0, 1, 0], backward)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3] = np.stack([right, np.cross(backward, right), backward, POSITION], axis=1)
    # From glTF's frame, whose y axis points up, to Blender's, whose z axis does.
    upright = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    cycles.scene.camera.matrix_world = Matrix((upright @ pose).tolist())
    cycles.scene.cycles.max_bounces = 6
    cycles.scene.cycles.use_denoising = True
    return cycles.picture(SAMPLES)


def main(output: Path) -> None:
    own = by_realcam()
    theirs = dataclasses.replace(own, pixels=np.float32(EXPOSURE_S * by_cycles()))
    pictures = [np.asarray(each.developed()) for each in (theirs, own)]
    gap = np.full((RESOLUTION[1], 8, 3), 255, np.uint8)
    Image.fromarray(np.concatenate([pictures[0], gap, pictures[1]], axis=1)).save(output, quality=88)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
