"""Distortion of the double Gauss of the CODE V listing, measured in a picture; which way up pictures are."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes

# CODE V 10.8 listing of ag_dblgauss (Double Gauss F/2), chief rays at 10 and 14 degrees.
EFL = 100.0038
FOCUS = 0.400269  # its film stands so far in front of the paraxial focus
CHIEF_RAYS = {  # field angle: (height on the film, exit angle in degrees, distortion in percent)
    10.0: (17.485856, 8.5339, -0.4976),
    14.0: (24.588739, 11.6658, -1.0557),
}
PITCH_MM = 0.02


def listed_distortion(height: float, angle_deg: float, exit_angle_deg: float) -> float:
    """CODE V's percentage, from the chief ray's height on the film.

    The real chief ray at the paraxial focus against EFL tan(angle), in parts of what the latter is on the
    film. From the listed heights this gives the listed -0.4976 and -1.0557; heights on the film alone over
    EFL tan(angle) would be -0.84% and -1.38%, because that film is not in the paraxial focus.
    """
    shift = FOCUS * math.tan(math.radians(exit_angle_deg))
    ideal = EFL * math.tan(math.radians(angle_deg))
    return 100 * (height + shift - ideal) / (ideal - shift)


def centroid(strip: np.ndarray, height_mm: float) -> tuple[float, float]:
    """Centroid (along the columns, and upwards) of the light around a height on the film, in mm."""
    rows, columns = strip.shape
    y = -(np.arange(rows) + 0.5 - rows / 2) * PITCH_MM
    near = np.abs(y - height_mm) < 1.0
    weights = np.where(near[:, None], strip, 0.0)
    x = (np.arange(columns) + 0.5 - columns / 2) * PITCH_MM
    return float(weights.sum(axis=0) @ x / weights.sum()), float(weights.sum(axis=1) @ y / weights.sum())


@pytest.fixture(scope="module")
def marks_at_both_angles() -> np.ndarray:
    """A strip of film, 2 mm x 52 mm, with images of square marks 10 km away, 0.4 mm wide each; f/22."""
    lens = rc.Lens.load("double-gauss-100mm").stopped_down(22)
    far_m = 1e4
    # Angles are those in front of the lens: seen from the middle of the entrance pupil. 10 km count as
    # infinity: the image of 10 km lies 1 um behind that.
    pupil_m = (lens.film_position_mm - lens.first_order().entrance_pupil_position_mm) / 1000
    marks = []
    for angle in CHIEF_RAYS:
        for sign in (1, -1):
            height = sign * far_m * math.tan(math.radians(angle))
            marks.append(scenes.quad((0, height, -far_m - pupil_m), 0.2e-3 / EFL * 1e3 * far_m, emission=1e4))
    camera = rc.Camera(lens, film=rc.Film(2, 52, (100, 2600)), exposure_time_s=1)
    return rc.render(scenes.scene_of(*marks), camera, effects=(), spp=64).pixels[..., 0].astype(np.float64)


@pytest.mark.parametrize("angle", CHIEF_RAYS)
@pytest.mark.parametrize("sign", [1, -1])
def test_distortion_in_a_picture(marks_at_both_angles: np.ndarray, angle: float, sign: int) -> None:
    listed_height, exit_angle, distortion = CHIEF_RAYS[angle]
    x, y = centroid(marks_at_both_angles, sign * listed_height)
    # Differences from a chief ray: the centroid is taken over a pupil of 1 / 11 of the full one, whose coma is
    # below 0.1 um (listed: 1.5 um over a pupil of 0.31), and over a mark of 0.4 mm, over which the
    # third-order distortion changes by 0.02 um. The 25600 samples of a mark, stratified over its pixels, have a
    # standard error of 0.115 mm / sqrt(25600) = 0.7 um at most; three standard errors are 0.0120% of 17.5 mm.
    assert sign * y == pytest.approx(listed_height, abs=0.002)
    assert listed_distortion(sign * y, angle, exit_angle) == pytest.approx(distortion, abs=0.012)
    assert x == pytest.approx(0, abs=0.002)


@pytest.mark.parametrize("model", ["thin", "full"])  # rays of all models: test_camera.cpp
def test_picture_is_neither_mirrored_nor_upside_down(model: str) -> None:
    # Red up and left, green up and right, blue down and right: each other arrangement is another picture.
    marks = [
        scenes.quad((-1, 0.7, -6), 0.2, emission=(1e3, 0, 0)),
        scenes.quad((1, 0.7, -6), 0.2, emission=(0, 1e3, 0)),
        scenes.quad((1, -0.7, -6), 0.2, emission=(0, 0, 1e3)),
    ]
    lens = rc.Lens.load("double-gauss-50mm").focused(6)
    image = rc.render(
        scenes.scene_of(*marks), rc.Camera(lens, film=rc.Film(36, 24, (36, 24)), model=model), effects=(), spp=4
    )
    rows, columns = np.indices((24, 36))
    for channel, (right, down) in enumerate([(False, False), (True, False), (True, True)]):
        light = image.pixels[..., channel].astype(np.float64)
        place = float((light * columns).sum() / light.sum()), float((light * rows).sum() / light.sum())
        assert (place[0] > 17.5, place[1] > 11.5) == (right, down)
        # f = 50 mm at 6 m: 1 m is 8.5 mm and 0.7 m is 6 mm from the middle; pixels are 1 mm.
        assert abs(place[0] - 17.5) == pytest.approx(8.5, abs=0.3)
        assert abs(place[1] - 11.5) == pytest.approx(6.0, abs=0.3)
