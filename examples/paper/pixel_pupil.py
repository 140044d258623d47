"""The pixel pupil's gain: samples only where light gets through."""

from __future__ import annotations

import math

from frame_scene import frame_scene
from realcam import Camera, Film, Lens
from realcam.accuracy import accuracy_cost

from .experiment import Experiment, Row


def experiment(device: str) -> Experiment:
    lens = Lens.load("double-gauss-50mm").focused(5.0)
    camera = Camera(lens, film=Film(36, 24, (96, 64)), position=(0, 1.5, 4), look_at=(0, 0.3, -4))
    scene = frame_scene(spheres=10, boxes=10)
    cost = accuracy_cost(
        scene,
        camera.metered(scene, device="cpu"),
        device=device,
        size=96,
        max_spp=64,
        reference_spp=1024,
        effects=(),
        levels=False,
    )
    ours = cost.samplings[-1]
    goal = ours.pictures[-1].rmse
    rows = []
    for level in cost.samplings:
        ratio = level.seconds_to(goal) / ours.seconds_to(goal)
        text = "never: light is lost" if math.isinf(ratio) else f"{ratio:.2f} times the time of the fitted outline"
        rows.append(Row(level.name, "", text))
    return Experiment(
        "The pixel pupil",
        (
            "Rays that start anywhere on the rear element are often stopped inside the lens. The paper lets each "
            "pixel learn where its rays pass (after Steinert et al. 2011); realcam knows it before the first "
            "sample, from the outline that real rays find when the lens is set. Compared is the time to the same "
            "error.",
        ),
        (),
        tuple(rows),
    )
