"""Fits all camera models to all bundled lenses and writes the residuals into the table of docs/vision.md.

python tools/vision_table.py
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import realcam as rc
from realcam.vision.models import MODELS

PAGE = Path(__file__).resolve().parents[1] / "docs" / "vision.md"
WIDTH = 1920  # pixels


def cell(camera: rc.Camera, model: str) -> str:
    """RMS and largest residual in pixels, with a star if the model is not invertible over the whole film."""
    try:
        fit = rc.fit_camera_model(camera, model)
    except rc.InputError:
        return "–"
    return f"{fit.rms_px:.2g}, {fit.max_px:.2g}{'' if fit.covers_film else '*'}"


def parallax(camera: rc.Camera) -> str:
    """Largest error in pixels of the fisheye model, fitted in the plane in focus, for points 20 focal lengths away."""
    fit = rc.fit_camera_model(camera, "fisheye")
    metres = 20 * camera.lens.first_order().effective_focal_length_mm / 1000
    try:
        return f"{np.linalg.norm(fit.residuals_at(metres), axis=1).max():.2g}"
    except rc.InputError:
        return "–"


def main() -> None:
    lines = [
        f"| lens | {' | '.join(MODELS)} | fisheye at 20 f' |",
        "|---" * (len(MODELS) + 2) + "|",
    ]
    for name in rc.lens_names():
        lens = rc.Lens.load(name)
        width, height = lens.film_mm
        film = rc.Film.for_lens(lens, resolution=(WIDTH, round(WIDTH * height / width)))
        camera = rc.Camera(lens, film=film)
        lines.append(f"| {name} | {' | '.join(cell(camera, model) for model in MODELS)} | {parallax(camera)} |")
    text = PAGE.read_text(encoding="utf-8")
    table = "\n".join(lines)
    text = re.sub(r"(<!-- table -->\n).*?(<!-- end -->)", lambda m: f"{m[1]}{table}\n{m[2]}", text, flags=re.DOTALL)
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
