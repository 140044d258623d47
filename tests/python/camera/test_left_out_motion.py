"""The effects motion_blur and rolling_shutter left out: pictures of what stands still, which other tests hold."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from ..scenes import quad, scene_of, shifted

LENS = rc.Lens.load("tessar-50mm").focused(4.0)
FILM = rc.Film(36, 24, (48, 32))
OPENS, EXPOSED, READOUT = 0.125, 0.5, 0.25  # s


def passing() -> rc.Scene:
    """A sign that crosses the picture within a second, lit by itself: a pixel has no noise but that of its edges."""
    sign = scene_of(quad((0, 0, 0), 0.3, 0.9, emission=1000))
    ground = scene_of(quad((0, 0, -9), 30, emission=10))
    return ground.with_instance(sign, name="sign").moved("sign", [shifted(-1, z=-3), shifted(1, z=-3)], times_s=[0, 1])


def camera(**options: object) -> rc.Camera:
    values = {"exposure_time_s": EXPOSED, "shutter_opens_s": OPENS, "model": "pinhole", "film": FILM, **options}
    return rc.Camera(LENS, **values)


def picture(scene: rc.Scene, cam: rc.Camera, *effects: str) -> np.ndarray:
    return rc.render(scene, cam, spp=16, device="cpu", effects=effects).pixels


def test_without_motion_blur_all_stands_as_in_the_middle_of_the_exposure() -> None:
    middle = OPENS + EXPOSED / 2
    still = picture(passing().at_time(middle), camera(shutter_opens_s=0))
    np.testing.assert_array_equal(picture(passing(), camera(), "-motion_blur"), still)
    assert np.abs(picture(passing(), camera()) - still).max() > 0.1 * still.max()


def test_a_camera_that_moves_stands_too() -> None:
    keys = [(0, (0, 0, 0), (0, 0, -1)), (1, (0.5, 0, 0), (0.5, 0, -1))]
    x = 0.5 * (OPENS + EXPOSED / 2)
    scene = passing().at_time(0.5)
    standing = picture(scene, camera(position=(x, 0, 0), look_at=(x, 0, -1)))
    left_out = picture(scene, camera(motion=keys), "-motion_blur")
    # Roundings of the pose move edges by some 1e-7 of a pixel.
    assert (np.abs(left_out - standing) > 1e-5 * standing.max()).mean() < 0.01


def test_without_motion_blur_each_row_sees_its_own_time() -> None:
    taken = picture(passing(), camera(readout_time_s=READOUT), "-motion_blur")
    for row in (0, 9, 16, 31):
        when = OPENS + EXPOSED / 2 + READOUT * row / FILM.resolution[1]
        still = picture(passing().at_time(when), camera(shutter_opens_s=0))
        # Kernels of scenes that move round a little differently, which some samples at the sign's edges show.
        np.testing.assert_allclose(taken[row], still[row], atol=0.05 * still.max())
        assert np.abs(taken[row] - picture(passing().at_time(when + 0.1), camera())[row]).max() > 0.2 * still.max()


def test_without_a_rolling_shutter_all_rows_are_exposed_together() -> None:
    together = picture(passing(), camera())
    np.testing.assert_array_equal(picture(passing(), camera(readout_time_s=READOUT), "-rolling_shutter"), together)
    still = picture(passing(), camera(), "-motion_blur")
    both = picture(passing(), camera(readout_time_s=READOUT), "-motion_blur", "-rolling_shutter")
    np.testing.assert_array_equal(both, still)


def test_named_effects_are_there_anyway() -> None:
    cam = camera(readout_time_s=READOUT)
    named = rc.render(passing(), cam, spp=4, device="cpu", effects={"motion_blur", "rolling_shutter"})
    np.testing.assert_array_equal(named.pixels, rc.render(passing(), cam, effects=(), spp=4, device="cpu").pixels)
    assert "realcam:effects" not in named.metadata()
    image = rc.render(passing(), cam, spp=1, device="cpu", effects={"-rolling_shutter", "-motion_blur"})
    assert image.metadata()["realcam:effects"] == "-motion_blur,-rolling_shutter"


def test_a_session_begins_anew_where_motion_is_left_out() -> None:
    session = rc.Session(passing(), camera(), device="cpu", effects="-motion_blur")
    session.add(16)
    np.testing.assert_array_equal(session.image().pixels, picture(passing(), camera(), "-motion_blur"))
    session.set(camera=camera(shutter_opens_s=0.3))
    session.add(16)
    moved = picture(passing().at_time(0.3 + EXPOSED / 2), camera())
    np.testing.assert_array_equal(session.image().pixels, moved)


@pytest.mark.parametrize(
    ("effects", "expected"),
    [
        (["motion"], 'unknown effect "motion"; expected some of auto, .* -motion_blur, -rolling_shutter'),
        (["--motion_blur"], 'unknown effect "--motion_blur"'),
        (["dispersion", "-dispersion"], "dispersion is both named and left out"),
    ],
)
def test_what_is_no_choice_of_effects_is_refused(effects: list[str], expected: str) -> None:
    with pytest.raises(rc.InputError, match=expected):
        rc.render(passing(), camera(), spp=1, device="cpu", effects=effects)
