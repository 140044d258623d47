"""The sensor's numbers against the laws of photons, and their reproducibility."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from .sensors import counter, electron_film, film_of, photons_per_um2


def test_the_mean_of_many_exposures_is_what_light_brings() -> None:
    """Photons by the candela's definition, 555 nm, through a quantum efficiency of 0.4 and a cover glass of 0.9."""
    sensor = counter().replace(quantum_efficiency=[(400, 0.4), (700, 0.4)], cover_glass=[(400, 0.9), (700, 0.9)])
    sensor = sensor.replace(pixel_pitch_um=3.0, read_noise_e=4, black_level_dn=100)
    lowest = sensor.iso_range()[0]
    levels = np.array([0.001, 0.01, 0.1])
    lux_s = np.tile(levels.repeat(64), (64, 1))
    film = film_of(lux_s, pitch_um=3.0, iso=lowest, illuminant="555")
    stack = np.stack([sensor.expose(film, seed=s).mosaic for s in range(40)]).astype(float)
    expected = np.array([9 * 0.4 * 0.9 * photons_per_um2(x, 555) for x in levels])
    per_level = stack.reshape(40, 64, 3, 64).transpose(2, 0, 1, 3).reshape(3, -1)
    # Five deviations of a mean of 40 x 4096 numbers.
    error = np.sqrt((expected + 16 + 1 / 12) / per_level.shape[1])
    assert np.all(np.abs(per_level.mean(axis=1) - 100 - expected) < 5 * error)
    # The variance of a variance estimate of near-normal numbers is 2 V^2 / N.
    variance = expected + 16 + 1 / 12
    assert np.all(np.abs(per_level.var(axis=1) / variance - 1) < 5 * np.sqrt(2 / per_level.shape[1]))


def test_the_same_numbers_for_any_number_of_threads() -> None:
    film = electron_film(300, (257, 301))
    sensor = counter(black_level_dn=50).replace(
        prnu_percent=1, dsnu_e=2, read_noise_e=3, row_noise_e=1, hot_pixel_share=0.01
    )
    before = film.pixels.copy()
    one = sensor.expose(film, seed=5, threads=1)
    assert np.array_equal(one.mosaic, sensor.expose(film, seed=5, threads=2).mosaic)
    assert one == sensor.expose(film, seed=5)
    assert one != sensor.expose(film, seed=6)
    assert np.array_equal(film.pixels, before)


def test_seeds_give_independent_noise() -> None:
    """The correlation of N independent pairs has the deviation 1 / sqrt(N)."""
    film, sensor = electron_film(200, (500, 600)), counter()
    first, second = (sensor.expose(film, seed=s).mosaic.astype(float).ravel() for s in (1, 2))
    assert abs(np.corrcoef(first, second)[0, 1]) < 5 / np.sqrt(first.size)
    # Nor do pixels that lie side by side, or a power of two apart, which hashes of counters might relate.
    for step in (1, 2, 4, 256, 600, 1024):
        assert abs(np.corrcoef(first[:-step], first[step:])[0, 1]) < 5 / np.sqrt(first.size - step)


def test_what_a_sensor_has_for_ever_stays_from_exposure_to_exposure() -> None:
    """Averages of 60 exposures: PRNU and DSNU come out, by their deviations; another serial number has others."""
    sensor = counter(black_level_dn=200).replace(prnu_percent=2, dsnu_e=6, read_noise_e=2)
    shape, mean = (200, 300), 2000.0

    def average(level: float, serial: int) -> np.ndarray:
        film = (
            electron_film(level, shape, black_level_dn=200) if level else film_of(np.zeros(shape), pitch_um=1, iso=1e3)
        )
        iso = sensor.iso_range()[0]
        frames = [sensor.expose(film, seed=s, serial=serial, iso=iso).mosaic for s in range(60)]
        return np.mean(frames, axis=0)

    dark, bright = average(0, 1), average(mean, 1)
    temporal_dark, temporal_bright = (4 + 1 / 12) / 60, (mean + 4 + 1 / 12) / 60
    dsnu = np.sqrt(dark.var() - temporal_dark)
    prnu = np.sqrt((bright - dark).var() - temporal_bright - temporal_dark) / mean
    # A deviation from N numbers is known to 1 / sqrt(2 N): 0.3%; five of them.
    assert dsnu == pytest.approx(6, rel=0.015)
    assert prnu == pytest.approx(0.02, rel=0.015)
    assert abs(np.corrcoef(dark.ravel(), average(0, 2).ravel())[0, 1]) < 5 / np.sqrt(dark.size)


def test_rows_and_hot_pixels() -> None:
    sensor = counter(black_level_dn=500).replace(row_noise_e=5, hot_pixel_share=0.01, hot_pixel_current_e_per_s=400)
    dark = film_of(np.zeros((2000, 1000)), pitch_um=1, iso=sensor.iso_range()[0], exposure_time_s=1.0)
    mosaic = sensor.expose(dark, seed=3).mosaic.astype(float) - 500
    rows = np.median(mosaic, axis=1)
    # 2000 rows know a deviation to 1.6%; whole numbers add 1 / 12.
    assert np.sqrt(rows.var() - 1 / 12) == pytest.approx(5, rel=0.08)
    rest = mosaic - rows[:, None]
    # Exponentially distributed currents of mean 400 above 50: the share exp(-50 / 400) of the hot ones.
    share = np.mean(rest > 50)
    expected = 0.01 * np.exp(-50 / 400)
    assert share == pytest.approx(expected, abs=5 * np.sqrt(expected / rest.size) + 1e-5)
    # They are the same pixels in the next exposure.
    again = sensor.expose(dark, seed=4).mosaic.astype(float) - 500
    both = (rest > 100) & (again - np.median(again, axis=1)[:, None] > 100)
    assert both.sum() > 0.85 * np.sum(rest > 100)


def test_dark_current_grows_with_time_and_temperature() -> None:
    sensor = counter(black_level_dn=10).replace(
        dark_current_e_per_s=20, dark_current_temperature_c=25, dark_current_doubling_k=8
    )
    iso = sensor.iso_range()[0]

    def dark_mean(time_s: float, temperature_c: float | None) -> float:
        film = film_of(np.zeros((300, 300)), pitch_um=1, iso=iso, exposure_time_s=time_s)
        return float(sensor.expose(film, temperature_c=temperature_c).mosaic.mean()) - 10

    for time_s, temperature_c, expected in ((1, None, 20), (4, 25, 80), (1, 41, 80), (8, 17, 80), (0.01, None, 0.2)):
        error = np.sqrt(expected / 90000)
        assert dark_mean(time_s, temperature_c) == pytest.approx(expected, abs=5 * error)
    silent = sensor.replace(dark_current_doubling_k=0)
    film = film_of(np.zeros((3, 3)), pitch_um=1, iso=iso)
    with pytest.raises(rc.InputError, match="does not specify how its dark current depends on temperature"):
        silent.expose(film, temperature_c=0)


def test_converter_noise_comes_after_the_gain() -> None:
    sensor = counter(black_level_dn=1000).replace(largest_gain_db=40, read_noise_e=3, converter_noise_dn=4)
    lowest = sensor.iso_range()[0]
    for gain in (1, 10):
        film = film_of(np.zeros((500, 500)), pitch_um=1, iso=gain * lowest)
        deviation = sensor.expose(film).mosaic.std()
        assert deviation == pytest.approx(np.sqrt((3 * gain) ** 2 + 16 + 1 / 12), rel=5 / np.sqrt(2 * 250000))
