"""Finds focus and f-number of a picture by PyTorch: gradients of its light by both rings, and Adam.

    python examples/torch_focus.py

Needs realcam[torch]. Prints the rings on the way from 2 m and f/4 to those of the picture, 2.6 m and f/3.2.
"""

from __future__ import annotations

import argparse

import numpy as np
import realcam as rc
import torch

WANTED = {"focus_distance_m": 2.6, "f_number": 3.2}


def stripes() -> rc.Scene:
    """Two rows of shining stripes of random brightness, 1.6 m and 3 m from the camera."""
    random = np.random.default_rng(1)
    vertices, materials = [], []
    for side, distance in ((-1, 1.6), (1, 3.0)):
        for x in distance * np.linspace(-0.1, 0.1, 30):
            bottom, top = sorted((0.005 * side * distance, 0.055 * side * distance))
            left, right = x - 0.0025 * distance, x + 0.0025 * distance
            vertices += [(u, v, -distance) for u, v in ((left, bottom), (right, bottom), (right, top), (left, top))]
            materials.append(rc.Material(emission=(float(random.uniform(0, 20)),) * 3))
    faces = [(4 * i + a, 4 * i + b, 4 * i + c) for i in range(len(materials)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    owners = np.repeat(np.arange(len(materials)), 2)
    return rc.Scene.from_arrays(vertices, faces, triangle_materials=owners, materials=materials)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=60)
    parser.add_argument("--spp", type=int, default=16)
    arguments = parser.parse_args()

    scene = stripes()
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0).stopped_down(4.0)
    camera = rc.Camera(lens, film=rc.Film(9, 6, (48, 32)), exposure_time_s=0.1)
    common = {"max_bounces": 0, "spp": arguments.spp}
    wanted = {name: torch.tensor(value) for name, value in WANTED.items()}
    observed = rc.torch_render(scene, camera, wanted, seed=999, max_bounces=0, spp=256)

    rings = {"focus_distance_m": torch.tensor(2.0), "f_number": torch.tensor(4.0)}
    optimiser = torch.optim.Adam([ring.requires_grad_() for ring in rings.values()], lr=0.1)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, arguments.steps)
    for step in range(arguments.steps):
        optimiser.zero_grad()
        picture = rc.torch_render(scene, camera, rings, seed=step, **common)
        loss = ((picture - observed) ** 2).mean() / (observed**2).mean()
        loss.backward()
        optimiser.step()
        schedule.step()
        if step % 10 == 9:
            focus, f_number = (ring.item() for ring in rings.values())
            print(f"step {step + 1}: loss {loss.item():.2g}, focus {focus:.3f} m, f/{f_number:.3f}", flush=True)


if __name__ == "__main__":
    main()
