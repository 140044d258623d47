"""Absurd light, both ends of everything, and what users get wrong."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .sensors import counter, film_of

NAMES = rc.sensor_names()
each_sensor = pytest.mark.parametrize("name", NAMES)


def of(name: str) -> tuple[rc.Sensor, float, float]:
    """A sensor, its pitch in um, and its lowest ISO (100 if it states no ISO)."""
    sensor = rc.Sensor.load(name)
    return sensor, sensor.pixel_pitch_um or 5.0, sensor.iso_range()[0] or 100.0


@each_sensor
def test_light_of_any_size(name: str) -> None:
    sensor, pitch_um, iso = of(name)
    values = [0, 1e-30, 1e-3, 1e5, 1e38, 3.4e38, np.inf, -np.inf, np.nan, -1e38]
    pixels = np.repeat(np.array(values, np.float32), 256).reshape(len(values) * 8, 32)
    raw = sensor.expose(film_of(pixels, pitch_um=pitch_um, iso=iso))
    rows = raw.mosaic.reshape(len(values), 256).astype(float)
    spread = 8 * raw.gain_dn_per_e * (sensor.read_noise_e + sensor.dsnu_e) + 1
    black, white = raw.black_level_dn, raw.white_level_dn
    for value, numbers in zip(values, rows, strict=True):
        if value > 1e3:
            assert numbers.min() >= white - spread, value
            assert numbers.max() <= 2**sensor.adc_bits - 1
        elif not value >= 1e-3:
            assert abs(numbers - black).max() <= spread, value
    developed = raw.exposure(demosaic="bilinear")
    assert np.isfinite(developed).all()


@each_sensor
def test_a_light_1e8_times_as_bright_leaves_its_neighbours_alone(name: str) -> None:
    sensor, pitch_um, iso = of(name)
    dim = np.full((64, 64), 0.1 * 78 / iso, np.float32)
    bright = dim.copy()
    bright[20:24, 20:24] *= 1e8
    without, with_light = (sensor.expose(film_of(p, pitch_um=pitch_um, iso=iso)) for p in (dim, bright))
    same = np.ones(dim.shape, bool)
    same[20:24, 20:24] = False
    assert np.array_equal(without.mosaic[same], with_light.mosaic[same])
    full = with_light.white_level_dn
    assert (
        with_light.mosaic[20:24, 20:24]
        >= full - 8 * with_light.gain_dn_per_e * (sensor.read_noise_e + sensor.dsnu_e) - 1
    ).all()
    # Cut highlights are white, not coloured: all channels of the middle alike.
    middle = with_light.exposure("bilinear")[21:23, 21:23]
    assert np.ptp(middle, axis=2).max() <= 0.02 * middle.max()


@each_sensor
def test_zero_exposure_is_black_and_saturated_is_white(name: str) -> None:
    sensor, pitch_um, iso = of(name)
    black, white = (
        sensor.expose(film_of(np.full((200, 200), lux_s), pitch_um=pitch_um, iso=iso)) for lux_s in (0, 1e3)
    )
    dark_e = sensor.dark_current_e_per_s * 0.01
    expected = black.black_level_dn + black.gain_dn_per_e * dark_e
    error = black.gain_dn_per_e * np.sqrt(sensor.read_noise_e**2 + sensor.dsnu_e**2 + dark_e) + 0.3
    assert black.mosaic.mean() == pytest.approx(expected, abs=5 * error / 200)
    assert black.developed(demosaic="bilinear").mean() < 12
    assert (white.developed(demosaic="bilinear") == 255).all()


@each_sensor
def test_both_ends_of_iso(name: str) -> None:
    sensor, pitch_um, _ = of(name)
    lowest, highest = sensor.iso_range(pitch_um)
    for iso in (lowest or 1e-3, highest if highest < 1e9 else 1e9):
        # Half of what saturates, by the definition of the number.
        film = film_of(np.full((64, 64), 0.5 * 78 / iso), pitch_um=pitch_um, iso=iso)
        raw = sensor.expose(film)
        white = (raw.mosaic.astype(float) - raw.black_level_dn) / (raw.white_level_dn - raw.black_level_dn)
        most_sensitive = white.reshape(32, 2, 32, 2).mean(axis=(0, 2)).max()
        # The smallest signals, a few electrons at 1e9 ISO, are noisy.
        electrons = max(0.5 * (raw.white_level_dn - raw.black_level_dn) / raw.gain_dn_per_e, 1e-3)
        assert most_sensitive == pytest.approx(0.5, abs=0.02 + 6 / np.sqrt(electrons * 1024))
    if highest < 1e9:
        with pytest.raises(rc.InputError, match=r"the lowest ISO of this sensor is .*; it is"):
            sensor.expose(film_of(np.zeros((4, 4)), pitch_um=pitch_um, iso=0.9 * lowest))


def test_an_iso_above_the_largest_gain_is_brightened_when_developed(tmp_path: Path) -> None:
    """Three stops above, the numbers are those of the largest gain, and the picture is as bright as its ISO says."""
    tifffile = pytest.importorskip("tifffile", reason="tifffile comes with the dev extra")
    sensor = rc.Sensor.load("sony-imx071-color")
    highest = sensor.iso_range()[1]
    iso, grey_lx_s = 8 * highest, 10 / (8 * highest)  # middle grey
    film = film_of(np.full((128, 128), grey_lx_s), pitch_um=sensor.pixel_pitch_um, iso=iso)
    pushed, plain = sensor.expose(film), sensor.expose(film, iso=highest)
    assert (pushed.mosaic == plain.mosaic).all()
    assert pushed.iso == iso
    assert pushed.exposure("bilinear").mean() == pytest.approx(grey_lx_s, rel=0.02)
    # 118 is middle grey; noise, which is large here, is not linear in the code.
    assert np.median(pushed.developed(demosaic="bilinear")) == pytest.approx(118, abs=6)
    exposures = []
    for raw in (plain, pushed):
        raw.save(tmp_path / "a.dng")
        with tifffile.TiffFile(tmp_path / "a.dng") as file:
            numerator, denominator = file.pages[0].tags[50730].value
        exposures.append(numerator / denominator)
    assert exposures[1] - exposures[0] == pytest.approx(3, abs=1e-3)


@pytest.mark.parametrize("iso", [1e-37, 1e38])
def test_iso_numbers_of_no_camera(iso: float) -> None:
    """The ends of what a Camera admits, on pixels from a nanometre to a metre."""
    for pitch_um in (1e-3, 1e6):
        pixels = np.array([[0, 1e-30, 1, 3.4e38]]).repeat(4, axis=0)
        mosaic = rc.Sensor.load("ideal").expose(film_of(pixels, pitch_um=pitch_um, iso=iso)).mosaic
        assert (mosaic[:, 0] == 0).all()
        assert mosaic.max() <= 65535


def test_saturation_by_iso_12232() -> None:
    """At any ISO number the converter is full at 78 / ISO lux seconds of white, in the most sensitive filter."""
    sensor = rc.Sensor.load("ideal")
    for iso in (50, 800):
        for share, is_full in ((0.99, False), (1.01, True)):
            raw = sensor.expose(film_of(np.full((64, 64), share * 78 / iso), pitch_um=20, iso=iso))
            assert (np.mean(raw.mosaic == 65535) > 0.2) == is_full


def test_pixels_of_another_size_are_told() -> None:
    sensor = rc.Sensor.load("sony-imx071-color")
    iso = sensor.iso_range()[0]
    # The message states the film to use, 4944 x 3284 pixels of 4.78 um, alike in Python and at the command line.
    told = r"pixels of 37.5 um are exposed as the sensor's of 4.78 um.*23.63 x 15.7 mm of 4944 x 3284 pixels"
    with pytest.warns(UserWarning, match=told):
        sensor.expose(film_of(np.ones((4, 4)), pitch_um=37.5, iso=iso))
    assert sensor.film().resolution == (4944, 3284)
    assert sensor.film().width_mm == pytest.approx(4.944 * 4.78)
    with pytest.raises(rc.InputError, match="has no pixel pitch of its own"):
        rc.Sensor.load("ideal").film()


def test_sensors_are_values() -> None:
    sensor = rc.Sensor.load("sony-imx900-mono")
    assert sensor == rc.Sensor.load("sony-imx900-mono") != rc.Sensor.load("ideal")
    assert hash(sensor) == hash(rc.Sensor.load("sony-imx900-mono"))
    assert sensor.replace() == sensor != sensor.replace(dsnu_e=1)
    assert pickle.loads(pickle.dumps(sensor)) == copy.deepcopy(sensor) == sensor
    assert repr(sensor) == "<realcam.Sensor sony-imx900-mono, 2064 x 1552 pixels of 2.25 um, monochrome, 12 bit>"
    raw = sensor.expose(film_of(np.ones((4, 6)), pitch_um=2.25, iso=1000))
    assert pickle.loads(pickle.dumps(raw)) == raw
    assert repr(raw) == "<realcam.RawImage 6 x 4 pixels of 'sony-imx900-mono', ISO 1000>"
    with pytest.raises(TypeError, match="unhashable"):
        hash(raw)


@each_sensor
def test_bundled_sensors_say_where_they_are_from(name: str) -> None:
    sensor = rc.Sensor.load(name)
    assert sensor.name == name
    assert sensor.title
    assert sensor.source
    assert sensor.assumptions


GOOD = 'format = 1\nname = "x"\nquantum_efficiency = [[400, 0.5], [700, 0.5]]\n'


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (GOOD + "read_nois_e = 3\n", r's.toml:4: unknown key "read_nois_e" \(did you mean "read_noise_e"'),
        (GOOD + "read_noise_e = -1\n", r"s.toml:4: read_noise_e must be a number from 0 to 1e12"),
        (GOOD + 'adc_bits = "12"\n', r's.toml:4: "adc_bits" must be a finite number'),
        (GOOD + "adc_bits = 17\n", r"s.toml:4: adc_bits must be a whole number from 1 to 16"),
        (GOOD + "adc_bits = 12.5\n", r's.toml:4: "adc_bits" must be a whole number'),
        (GOOD + "black_level_dn = 70000\n", r"s.toml:4: black_level_dn must be from 0 to half of"),
        (GOOD + "saturation_capacity_e = 1000\n", r"gain_dn_per_e must be given if saturation_capacity_e is given"),
        (GOOD + 'color_filter_array = "RGBG"\n', r"s.toml:4: .color_filter_array. must be RGGB, BGGR"),
        (GOOD + "cover_glass = [[400, 1.2]]\n", r"s.toml:4: cover_glass must be a table of values from 0 to 1"),
        (GOOD + "cover_glass = [[500, 1], [400, 1]]\n", r"cover_glass must be a table whose first column increases"),
        (GOOD + "angular_response = [[5, 1], [20, 0.5]]\n", r"angular_response must be a table that begins with"),
        (GOOD + "prnu_percent = 50\n", r"prnu_percent must be from 0 to 15"),
        (GOOD + "resolution = [100]\n", r"resolution"),
        ('format = 1\nname = "x"\n', r"quantum_efficiency must be a table of at least two wavelengths"),
        ('name = "x"\n', r"expected format = 1"),
        ("format = 1\n", r'"name" is missing'),
        ("format = = 1\n", r"s.toml:1: not valid TOML"),
    ],
)
def test_mistakes_in_sensor_files_are_told_with_their_line(text: str, why: str, tmp_path: Path) -> None:
    file = tmp_path / "s.toml"
    file.write_text(text)
    with pytest.raises(rc.InputError, match=why) as error:
        rc.Sensor.load(file)
    assert "\n" not in str(error.value)


def test_other_mistakes_are_told() -> None:
    film, sensor = film_of(np.ones((4, 4)), pitch_um=1, iso=100), counter()
    iso, ideal = sensor.iso_range()[0], rc.Sensor.load("ideal")
    raw, color = sensor.expose(film, iso=iso), ideal.expose(film)
    for use, message in (
        (lambda: rc.Sensor.load("idael"), 'unknown sensor "idael".*did you mean "ideal"'),
        (lambda: rc.Sensor.load("./nothing.toml"), "no such file"),
        (lambda: sensor.expose(3), r"image must be a realcam.Image; it is 3"),  # type: ignore[arg-type]
        (lambda: sensor.expose(film, iso=iso, seed=-1), "the seed must lie between"),
        (lambda: raw.camera_from_xyz, "has no colour filters"),
        (lambda: color.exposure("magic"), "unknown demosaicing 'magic'"),
        (lambda: color.save("raw.bmp"), r"raw\.bmp: expected \.dng, \.npy "),
        (lambda: ideal.replace(resolution=(3, 3)).expose(film), "has 4 x 4 pixels, and the sensor 'ideal' 3 x 3"),
    ):
        with pytest.raises(rc.InputError, match=message):
            use()


def test_what_is_not_installed_is_told_in_one_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    raw = rc.Sensor.load("ideal").expose(film_of(np.ones((4, 4)), pitch_um=5))
    monkeypatch.setitem(__import__("sys").modules, "tifffile", None)
    monkeypatch.setitem(__import__("sys").modules, "colour_demosaicing.bayer", None)
    for use in (lambda: raw.save(tmp_path / "x.dng"), raw.developed):
        with pytest.raises(rc.InputError, match=r"pip install realcam\[raw\] installs it") as error:
            use()
        assert "\n" not in str(error.value)
    assert not list(tmp_path.iterdir())


def test_microlenses_see_less_from_the_side() -> None:
    """A response of cos^2 of the chief ray's angle, from the paraxial exit pupil: 1 / (1 + r^2 / d^2)."""
    angles = np.linspace(0, 60, 121)
    sensor = counter().replace(angular_response=np.stack([angles, np.cos(np.radians(angles)) ** 2], axis=1).tolist())
    iso, shape, pitch_um = sensor.iso_range()[0], (300, 300), 100.0
    film = film_of(
        np.full(shape, 5000 / sensor.electrons_per_um2("550")[0].sum()), pitch_um=pitch_um, iso=iso, illuminant="550"
    )
    with pytest.warns(UserWarning, match="pixels of 100 um"):
        raw = sensor.expose(film)
    lens = film.camera.lens
    distance_mm = lens.film_position_mm - lens.first_order().exit_pupil_position_mm
    y, x = np.indices(shape) - 149.5
    expected = 5000 / (1 + (x**2 + y**2) * 0.1**2 / distance_mm**2)
    blocks = (raw.mosaic - expected).reshape(10, 30, 10, 30).mean(axis=(1, 3))
    # Noise of 900 pixels, and the table's steps, some 1e-4.
    assert np.abs(blocks).max() < 5 * np.sqrt(5000 / 900) + 2
    assert expected.min() < 4400  # there is something to see


def test_what_is_changed_is_told() -> None:
    changed = rc.Sensor.load("sony-imx071-color").replace(prnu_percent=2, read_noise_e=50, adc_bits=14)
    assert changed.assumptions[-1] == "changed since its file: read_noise_e, prnu_percent"
    assert rc.Sensor.load("ideal").replace(name="mine").assumptions == rc.Sensor.load("ideal").assumptions


@pytest.mark.parametrize(
    ("changes", "required"),
    [
        ({"black_level_dn": 200, "adc_bits": 8}, "black_level_dn must be from 0 to half"),
        ({"dark_current_temperature_c": -300}, "from -273.15"),
        ({"read_noise_e": 1e30}, "from 0 to 1e12"),
        ({"pixel_pitch_um": 1e-300}, "from 0.001 to 1e6"),
    ],
)
def test_values_beyond_sense_are_refused(changes: dict[str, object], required: str) -> None:
    with pytest.raises(rc.InputError, match=required):
        rc.Sensor.load("ideal").replace(**changes)


@pytest.mark.parametrize(
    "mosaic", [np.zeros((4, 4)), np.zeros((4, 4, 3), np.uint16), [[1, 2]], np.zeros((0, 4), np.uint16)]
)
def test_what_is_no_mosaic_is_refused(mosaic: object) -> None:
    with pytest.raises(rc.InputError, match="mosaic must be an array"):
        rc.RawImage(mosaic, rc.Sensor.load(), 100, 1, 4.78)
