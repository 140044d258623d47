"""Other ways to sample the pupil, polynomials and double precision: the light of every surface's picture."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from .. import scenes

LENS = rc.Lens.load("double-gauss-50mm").focused(3.0)


def camera(model: str = "full") -> rc.Camera:
    return rc.Camera(LENS, film=rc.Film(24, 24, (32, 32)), exposure_time_s=1, model=model)


def light(device: str, model: str = "full", **settings: object) -> rc.Image:
    """Picture of a uniform sky, so that pixels differ only by the transmitted light of the lens."""
    return rc.render(scenes.sky(), camera(model), effects=(), spp=256, device=device, **settings)  # type: ignore[arg-type]


@pytest.mark.parametrize("sampling", ["rear_element", "pixel"])
def test_no_light_is_lost_wherever_rays_are_sent(device: str, sampling: str) -> None:
    """At least a sixth of the rays to the last surface pass: 262144 of them give the mean to 0.5%. Three times that is
    allowed, and 3% in the corner's quarter of the picture."""
    expected, found = light(device).pixels, light(device, pupil_sampling=sampling).pixels
    assert found.mean() == pytest.approx(expected.mean(), rel=0.015)
    assert found[:16, :16].mean() == pytest.approx(expected[:16, :16].mean(), rel=0.03)


def test_light_beside_the_paraxial_exit_pupil_is_lost(device: str) -> None:
    expected, found = light(device).pixels, light(device, pupil_sampling="exit_pupil").pixels
    assert 0.9 * expected.mean() < found.mean() < 1.003 * expected.mean()


def test_pixels_learn_where_light_passes(device: str) -> None:
    def share(sampling: str) -> float:
        stats = light(device, pupil_sampling=sampling).stats
        return stats.passed_rays / stats.sampled_rays

    rear, pixel, outline = (share(sampling) for sampling in ("rear_element", "pixel", "outline"))
    assert rear < pixel < outline
    assert pixel > 0.6 * rear + 0.4 * outline  # a quarter of the rays goes anywhere


def test_what_pixels_know_does_not_depend_on_threads() -> None:
    one, all_ = (light("cpu", pupil_sampling="pixel", threads=threads).pixels for threads in (1, 0))
    assert np.array_equal(one, all_)


def test_double_precision_shows_the_same_picture() -> None:
    """Single rays at rims pass in one of the two alone."""
    single, double = light("cpu").pixels, light("cpu", "full_double").pixels
    assert np.median(np.abs(double / single - 1)) < 1e-6
    assert double.mean() == pytest.approx(single.mean(), rel=1e-4)


def test_polynomials_show_the_light_of_the_lens(device: str) -> None:
    """Polynomials include the rims of stop, first and last surface only; this lens's other rims block less than 3%."""
    assert light(device, "polynomial").pixels.mean() == pytest.approx(light(device).pixels.mean(), rel=0.03)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"pupil_sampling": "rear"}, "must be outline, rear_element, exit_pupil or pixel"),
        ({"pupil_sampling": "pixel", "effects": "diffraction"}, "pixel excludes the effects"),
        ({"model": "thin", "pupil_sampling": "pixel"}, "pupil_sampling: the camera's model must be full"),
        ({"model": "polynomial", "effects": "dispersion"}, "dispersion: the camera's model must be full"),
    ],
)
def test_what_does_not_go_together_is_refused(settings: dict[str, str], sentence: str) -> None:
    taken = camera(settings.pop("model", "full"))
    with pytest.raises(rc.InputError, match=sentence):
        rc.render(scenes.sky(), taken, spp=1, device="cpu", **{"effects": (), **settings})  # type: ignore[arg-type]


def test_a_gpu_has_no_double_precision(device: str) -> None:
    if device == "cpu":
        pytest.skip("a CPU has")
    with pytest.raises(rc.InputError, match="full_double is for the CPU"):
        light(device, "full_double")
