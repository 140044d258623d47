"""Figure 8: frames per second of 640 x 640 pixels and 20 samples, and where their time goes."""

from __future__ import annotations

import time

from frame_scene import frame_camera, frame_scene
from realcam import LiveView, devices, render

from .experiment import Experiment, Row

SAMPLES = 20


def experiment(device: str) -> Experiment:
    camera, scene = frame_camera(), frame_scene()
    image = render(scene, camera, spp=SAMPLES, device=device, effects=())
    stats = image.stats
    busy = stats.lens_seconds + stats.scene_seconds + stats.other_seconds
    name = next((str(d) for d in devices() if stats.device in str(d) or d.name.startswith(device)), stats.device)
    live = LiveView(scene, device="cuda" if "GPU" in stats.device else "cpu")
    _ = live.shoot(camera, spp=SAMPLES).codes  # what is prepared once
    begin, frames = time.perf_counter(), 0
    while frames < 3 or time.perf_counter() - begin < 2:
        aside = 0.01 * (frames % 20)
        _ = live.shoot(camera.replace(position=(aside, 1.5, 4)), spp=SAMPLES).codes
        frames += 1
    rate = frames / (time.perf_counter() - begin)
    return Experiment(
        "Figure 8: speed",
        (
            f"640 x 640 pixels of {SAMPLES} samples, each through all eleven surfaces, with one shadow ray; the "
            "camera moves from frame to frame, and each frame is a finished 8-bit picture in the host's memory. "
            "The paper's machine is of 2013, so that frames per second say little; what is left to compare is the "
            "lens's share of the time.",
        ),
        (),
        (
            Row("frames per second", "", f"{rate:.3g} on {name}"),
            Row("share of the lens", "", f"{100 * stats.lens_seconds / busy:.0f}%"),
            Row("share of finding what rays meet", "", f"{100 * stats.scene_seconds / busy:.0f}%"),
            Row("rest (shading, sums)", "", f"{100 * stats.other_seconds / busy:.0f}%"),
            Row("sampled rays that pass the lens", "", f"{100 * stats.passed_rays / stats.sampled_rays:.1f}%"),
        ),
    )
