"""A camera in the hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from scipy.signal import welch

from .. import scenes


def test_the_spectrum_is_the_stated_one() -> None:
    corner, rms, rate = 2.0, 0.25, 50.0
    times = np.arange(0, 400, 1 / rate)
    shakes = [rc.Shake(rms_deg=rms, rms_mm=1000 * rms, corner_hz=corner, seed=seed).at(times) for seed in range(6)]
    curves = [curve for shake in shakes for part in shake for curve in part.T]
    frequencies, power = welch(np.array(curves), rate, nperseg=500)
    found = power.mean(axis=0)
    stated = 4 * rms**2 / (np.pi * corner) / (1 + (frequencies / corner) ** 2) ** 2
    # 36 curves of 64 lines each; a band of 1 Hz holds the share of the spectrum of 36 * 64 of them, of random place and
    # even power. So its power is right to some 1 / sqrt(count) in one standard deviation.
    for low in (0.2, 1.0, 2.0, 3.0, 5.0):
        band = (frequencies >= low) & (frequencies < low + 1)
        lines = 36 * 64 * stated[band].sum() * (frequencies[1]) / rms**2
        assert found[band].sum() == pytest.approx(stated[band].sum(), rel=4 / np.sqrt(lines) + 0.05)
    assert found[frequencies > 10.5 * corner].sum() < 1e-3 * found.sum()
    assert np.std(curves) == pytest.approx(rms, rel=0.03)


def test_curves_are_gaussian_and_independent() -> None:
    times = np.arange(0, 3000, 1.0)
    seeds = [rc.Shake(rms_deg=1, seed=seed).at(times)[0] for seed in (0, 1, 2)]
    curves = np.concatenate([curve.T for curve in seeds])
    correlation = np.corrcoef(curves)
    # About 3000 independent times (the correlation time is a sixth of a second).
    assert np.abs(correlation - np.eye(9)).max() < 5 / np.sqrt(3000)
    # The kurtosis of a sum of 64 cosines is 3 (1 - 1 / 128); that of 27000 numbers is known to sqrt(24 / 27000).
    assert (curves**4).mean() / (curves**2).mean() ** 2 == pytest.approx(3, abs=5 * np.sqrt(24 / 27000))
    again = rc.Shake(rms_deg=1, seed=1).at(times[::-1])[0]
    np.testing.assert_array_equal(again, seeds[1][::-1])


def test_a_curve_turns_and_shifts_the_camera_in_its_own_axes() -> None:
    curve = [
        (0, (0, 0, 0), (0, 0, 0)),
        (1, (3, 0, 0), (0.1, 0.2, 0.3)),
        (2, (0, 4, 0), (0, 0, 0)),
        (3, (0, 0, 90), (0, 0, 0)),
    ]
    angles, shifts = rc.Shake(curve=curve).at([-1, 0.5, 1, 9])
    np.testing.assert_allclose(angles, [[0, 0, 0], [1.5, 0, 0], [3, 0, 0], [0, 0, 90]], atol=1e-12)
    np.testing.assert_allclose(shifts[1], [0.05, 0.1, 0.15], atol=1e-12)
    # A camera that looks along +x, with y up: its right is +z, and its back is -x.
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), position=(1, 1, 1), look_at=(3, 1, 1), exposure_time_s=1e-6)
    shot = rc.Shot(scenes.scene_of(scenes.quad((0, 0, -3), 3)), camera, shake=rc.Shake(curve=curve))
    seen = shot.camera_at(1)
    np.testing.assert_allclose(seen.position, (1 - 0.3, 1 + 0.2, 1 + 0.1), atol=1e-6)
    direction = np.subtract(seen.look_at, seen.position)
    up = np.radians(3)
    np.testing.assert_allclose(direction, 2 * np.array([np.cos(up), np.sin(up), 0]), atol=1e-6)
    left = np.subtract(shot.camera_at(2).look_at, (1, 1, 1))
    turn = np.radians(4)
    np.testing.assert_allclose(left, 2 * np.array([np.cos(turn), 0, -np.sin(turn)]), atol=1e-6)
    np.testing.assert_allclose(shot.camera_at(3).up, (0, 0, -1), atol=1e-6)  # its upper side has gone to the left


def test_a_shake_leans_and_blurs_as_a_motion_does() -> None:
    """A steady turn by a curve of shake, and the same turn by keys of the pose."""
    scene = scenes.scene_of(scenes.quad((0.4, 0, -2), 0.3, diffuse=0.8)).with_environment((300, 200, 100))
    film = rc.Film(36, 24, (48, 32))
    camera = rc.Camera(
        rc.Lens.load("tessar-50mm").focused(2), film=film, exposure_time_s=0.02, readout_time_s=0.1, shutter_opens_s=0.3
    )
    settings = rc.RenderSettings(spp=32, effects=(), max_bounces=0)
    shake = rc.Shake(curve=[(0, (0, 0, 0), (0, 0, 0)), (1, (0, -60, 0), (0, 0, 0))])
    ways = [(t, (0, 0, 0), (np.sin(np.pi / 3 * t), 0, -np.cos(np.pi / 3 * t))) for t in (0, 1)]
    shaken = rc.Shot(scene, camera, settings, shake=shake).render(device="cpu").pixels
    moved = rc.render(scene, camera.replace(motion=ways), settings, device="cpu").pixels
    still = rc.render(scene, camera, settings, device="cpu").pixels
    # A turn at an even pace by keys on a circle: both are right to a thousandth of the way (docs/motion.md).
    assert np.abs(shaken - moved).mean() < 0.02 * np.abs(still - moved).mean()


def test_a_camera_can_turn_in_any_place() -> None:
    """Interpolation rounds the coordinates of a place; that is no motion."""
    place = np.array([0.1, 1.7399998855590821, 28.760542543952745])
    lens = rc.Lens.load("tessar-50mm").focused(2)
    pictures = []
    for middle in (np.zeros(3), place):
        scene = scenes.scene_of(scenes.quad(tuple(np.add(middle, (0.1, 0, -2))), 0.3, diffuse=0.8)).with_environment(
            300
        )
        ways = [(t, tuple(middle), tuple(np.add(middle, (0.1 * t, 0.02 * t, -1)))) for t in (0, 0.3, 1)]
        camera = rc.Camera(lens, film=rc.Film(36, 24, (24, 16)), exposure_time_s=1, motion=ways)
        pictures.append(rc.render(scene, camera, effects=(), spp=8, max_bounces=0, device="cpu").pixels)
    # The same rays, but for the last digits of a float.
    assert np.abs(pictures[0] - pictures[1]).mean() < 1e-3 * pictures[0].mean()


def test_a_curve_is_read_from_a_table(tmp_path: Path) -> None:
    path = tmp_path / "walk.csv"
    path.write_text("# gyro\ny_deg, time_s,z_m\n0.5, 0, 1e-3\n\n-1,0.25,0\r\n")
    assert rc.Shake.load(path) == rc.Shake(curve=[(0, (0, 0.5, 0), (0, 0, 1e-3)), (0.25, (0, -1, 0), (0, 0, 0))])


@pytest.mark.parametrize(
    ("text", "line", "expected"),
    [
        ("time_s,yaw\n0,1\n", 1, 'unknown column "yaw"'),
        ("x_deg\n1\n", 1, "the column time_s is missing"),
        ("time_s,x_deg,x_deg\n", 1, "the column x_deg is named twice"),
        ("time_s,x_deg\n0,1\n1\n", 3, "has 1 numbers; the columns are 2"),
        ("time_s,x_deg\n0,1\n1,one\n", 3, '"one" is not a finite number'),
        ("time_s,x_deg\n0,nan\n", 2, '"nan" is not a finite number'),
        ("time_s,x_deg\n1,0\n1,0\n", 3, "the times must be strictly increasing"),
        ("time_s,x_deg\n1,100\n", 2, "angles must lie within 90 degrees"),
        ("", None, "has no curve"),
        ("time_s\n", None, "has no curve"),
    ],
)
def test_mistakes_in_a_table_are_named(tmp_path: Path, text: str, line: int | None, expected: str) -> None:
    path = tmp_path / "walk.csv"
    path.write_text(text)
    with pytest.raises(rc.InputError) as refusal:
        rc.Shake.load(path)
    assert str(refusal.value).startswith(f"{path}:{line}: " if line else f"{path}: ")
    assert expected in str(refusal.value)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ({"rms_deg": -1}, "an angle from 0 to 9 degrees"),
        ({"rms_mm": float("nan")}, "a length from 0 to 1e6 mm"),
        ({"corner_hz": 0}, "a frequency up to 1e4 Hz"),
        ({"seed": -1}, "seed"),
        ({"curve": [(1, (0, 0, 0), (0, 0, 0))] * 2}, "key 1 of the shake: the times must be strictly increasing"),
    ],
)
def test_shakes_that_are_none_are_refused(words: dict[str, object], expected: str) -> None:
    with pytest.raises(rc.InputError, match=expected):
        rc.Shake(**words)
