"""The pictures of a lens's page: drawing, MTF and a photograph of the demo scene."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import matplotlib.image
import numpy as np
import realcam as rc
from realcam.analysis import style

ROOT = Path(__file__).resolve().parents[2]
SHOT = ROOT / "scenes" / "demo.toml"
LONGER_SIDE_PX = 420
SAMPLES = 16
HALF_WIDTH_M = 0.36  # of what the film sees beside the subject
NEAREST_M = 0.42
WIDEST_DEG = 120.0


def camera_for(lens: rc.Lens, shot: rc.Shot) -> rc.Camera:
    """Sees the shot's subject as wide as the shot does, from the same side and with the same exposure.

    Lenses of wide angles stay NEAREST_M away from it, and show more of the scene.
    """
    eye = np.array(shot.camera.position)
    away = eye - shot.camera.look_at
    away /= np.linalg.norm(away)
    subject = eye - shot.camera.lens.focus_distance_m * away
    width, height = lens.film_mm
    scale = LONGER_SIDE_PX / max(width, height)
    camera = rc.Camera(lens, film=rc.Film(width, height, (round(scale * width), round(scale * height))))
    angle_deg = min(camera.field_of_view_deg.horizontal, WIDEST_DEG)
    data = lens.first_order()
    # Angles are seen from the entrance pupil, but distances count from the film.
    pupil_mm = data.entrance_pupil_position_mm
    behind_pupil_m = 1e-3 * (lens.film_position_mm - pupil_mm) if math.isfinite(pupil_mm) else 0.0
    before_pupil_m = max(HALF_WIDTH_M / math.tan(math.radians(angle_deg / 2)), NEAREST_M)
    # From film to subject it is at least four focal lengths, for a thin lens that shows it life-size.
    least_m = max(lens.nearest_focus_m, 5e-3 * abs(data.effective_focal_length_mm))
    distance_m = max(before_pupil_m + behind_pupil_m, least_m)
    # Exposure goes with the square of the f-number; the lens is wide open.
    stops = data.f_number / shot.camera.lens.first_order().f_number
    return camera.replace(
        lens=lens.focused(distance_m),
        position=tuple(subject + distance_m * away),
        look_at=tuple(subject),
        exposure_time_s=shot.camera.exposure_time_s * stops**2,
        iso=shot.camera.iso,
    )


def save_photograph(lens: rc.Lens, shot: rc.Shot, target: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of glass whose index is known for one wavelength alone
        image = rc.render(
            shot.scene,
            camera_for(lens, shot),
            spp=SAMPLES,
            max_bounces=3,
            effects=(),
            layers=["albedo", "normal", "traced_light"],
        )
    matplotlib.image.imsave(target, image.denoised().developed())


def save_mtf(lens: rc.Lens, target: Path) -> None:
    with style.themed("light", 8.0):
        figure = style.new_figure(6.2, 2.9)
        axes = figure.add_subplot()
        try:
            data = rc.analysis.mtf_over_field(lens)
        except rc.InputError:  # a wavefront that is too far from a sphere for the contrast of waves
            data = rc.analysis.mtf_over_field(lens, method="geometric")
        rc.analysis.plot_mtf_over_field(data, axes)
        rc.analysis.save_figure(figure, target, dpi=110)
