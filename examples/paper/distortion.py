"""Figure 6: distortion, and a fisheye's barrel and dark corners."""

from __future__ import annotations

import math

import numpy as np
from realcam import Camera, Film, Lens, render
from realcam.analysis import distortion

from .experiment import Experiment, Row, photographed
from .scenes import grid_board, room


def experiment(device: str) -> Experiment:
    wide = Lens.load("wide-16mm-100deg").focused(math.inf)
    film = Film(21.6, 14.4, (440, 293))
    distance = 20.0
    across = film.width_mm / wide.first_order().effective_focal_length_mm * distance
    board = grid_board((0, 0, -distance), 1.8 * across, 36)
    camera = Camera(wide, film=film).metered(board, device="cpu")
    straight = render(board, camera.replace(model="thin"), spp=32, device=device, effects=())
    curved = render(board, camera, spp=32, device=device, effects=())
    corner = 0.49 * camera.field_of_view_deg.diagonal
    percent = distortion(wide, fields_deg=[corner]).percent
    fisheye = Lens.load("fisheye-6mm-220deg").focused(math.inf)
    inside = room(5.0, 10)
    round_film = Film(24, 24, (360, 360))
    round_camera = Camera(fisheye, film=round_film, position=(0, 0, 0), look_at=(0, 0, -1)).metered(
        inside, device="cpu"
    )
    barrel = render(inside, round_camera, spp=32, device=device, effects=())
    light = barrel.pixels.mean(axis=2)
    dark = float((light < 0.01 * light[170:190, 170:190].mean()).mean())
    circle_mm = 24 * math.sqrt((1 - dark) * 4 / math.pi)
    return Experiment(
        "Figure 6: distortion",
        (
            "The same board through an ideal thin lens, which keeps straight lines straight, and through the wide "
            "angle of the same focal length. Below the inside of a squared room through a fisheye of 220 degrees: "
            "straight lines become curves, and the corners of the film stay dark, because no light reaches them.",
        ),
        (
            photographed("thin lens", straight),
            photographed("wide-16mm-100deg, every surface", curved),
            photographed("fisheye-6mm-220deg in a squared room", barrel),
        ),
        (
            Row(f"distortion at {corner:.1f} degrees", "", f"{float(np.ravel(percent)[-1]):.2f}%"),
            Row(
                "the fisheye's image circle, by pixels with a hundredth of the middle's light",
                "",
                f"{circle_mm:.2f} mm (20.9 mm by the patent)",
            ),
            Row("dark share of a square film of 24 mm", "", f"{100 * dark:.0f}%"),
        ),
    )
