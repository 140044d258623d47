"""From film to raw and back: a colour chart, developed here and by raw developers."""

from __future__ import annotations

import shutil
import subprocess
import warnings
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..programs import Command
from .sensors import film_of

SIDE = 48  # pixels of a patch
pytest.importorskip("colour_demosaicing", reason="colour-demosaicing comes with the dev extra")
PITCH_UM = 4.78
WITHIN_DE00 = 2.0  # what the project asks for


@pytest.fixture(autouse=True)
def quiet() -> Iterator[None]:
    """colour-science warns of packages that it would like to have."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", module="colour")
        yield


@cache
def patches() -> np.ndarray:
    """(4, 6, 3): linear sRGB of the 24 patches of the ColorChecker, as published in 2005 (xyY under D50), to D65 by
    Bradford's matrix; what sRGB cannot show is cut at 0.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import colour
    chart = colour.CCS_COLOURCHECKERS["ColorChecker 2005"]
    xyz = colour.xyY_to_XYZ(np.array(list(chart.data.values())))
    linear = colour.XYZ_to_RGB(
        xyz, "sRGB", illuminant=chart.illuminant, chromatic_adaptation_transform="Bradford", apply_cctf_encoding=False
    )
    return np.clip(linear, 0, None).reshape(4, 6, 3)


def chart_film(iso: float, illuminant: str = "") -> rc.Image:
    """The chart, with a white of 1 at 0.9 of what a picture of this ISO shows as white; in other light at half of it,
    because ISO numbers are D65's, and tungsten has more red photons.
    """
    exposure = patches() * (0.45 if illuminant else 0.9) / (0.018 * iso)
    pixels = exposure.repeat(SIDE, axis=0).repeat(SIDE, axis=1)
    return film_of(pixels, pitch_um=PITCH_UM, iso=iso, illuminant=illuminant)


def patch_means(pixels: np.ndarray) -> np.ndarray:
    """(24, 3): of the middle half of each patch, so that no neighbour takes part."""
    q = SIDE // 4
    blocks = pixels.reshape(4, SIDE, 6, SIDE, 3)[:, q:-q, :, q:-q]
    return blocks.mean(axis=(1, 3)).reshape(24, 3)


def differences(linear: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """CIEDE2000 of linear sRGB, white 1."""
    import colour

    def lab(rgb: np.ndarray) -> np.ndarray:
        return colour.XYZ_to_Lab(colour.RGB_to_XYZ(rgb, "sRGB"))

    return np.asarray(colour.delta_E(lab(linear), lab(reference), method="CIE 2000"))


def scaled_to(linear: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Scales the picture by a single factor to fit the reference, because developers choose their own exposure."""
    return linear * (reference * linear).sum() / (linear * linear).sum()


SENSORS = ("ideal", "sony-imx071-color")


def exposed(name: str, illuminant: str = "") -> tuple[rc.Image, rc.RawImage]:
    sensor = rc.Sensor.load(name)
    iso = 1.01 * (sensor.iso_range()[0] or 100)
    film = chart_film(iso, illuminant)
    return film, sensor.expose(film, seed=2)


@pytest.mark.parametrize("illuminant", ["", "A", "FL2"])
@pytest.mark.parametrize("name", SENSORS)
@pytest.mark.parametrize("demosaic", ["menon", "malvar", "bilinear"])
def test_the_developed_chart_looks_as_the_film_does(name: str, illuminant: str, demosaic: str) -> None:
    film, raw = exposed(name, illuminant)
    reference = patch_means(film.pixels) * 0.018 * raw.iso
    found = patch_means(raw.exposure(demosaic)) * 0.018 * raw.iso
    # The values are absolute lux seconds, without any fit. Noise remains: black has some 500 electrons a pixel, so that
    # the mean of 576 pixels is known to 0.2% for each filter, and the matrix doubles that.
    assert differences(found, reference).max() < 1.0
    assert np.median(differences(found, reference)) < 0.15


@pytest.mark.parametrize("name", SENSORS)
def test_codes_for_a_screen_look_as_those_of_the_film(name: str) -> None:
    import colour

    film, raw = exposed(name)
    codes = [colour.cctf_decoding(c / 255) for c in (film.developed("linear"), raw.developed())]
    assert differences(patch_means(codes[1]), patch_means(codes[0])).max() < WITHIN_DE00


@pytest.mark.parametrize("pattern", ["RGGB", "BGGR", "GRBG", "GBRG"])
def test_every_order_of_the_filters(pattern: str, tmp_path: Path) -> None:
    rawpy = pytest.importorskip("rawpy", reason="rawpy comes with the dev extra")
    sensor = rc.Sensor.load("sony-imx071-color").replace(color_filter_array=pattern)
    iso = 1.01 * sensor.iso_range()[0]
    film = chart_film(iso)
    raw = sensor.expose(film)
    reference = patch_means(film.pixels)
    assert differences(patch_means(raw.exposure()) * 0.018 * iso, reference * 0.018 * iso).max() < 0.5
    raw.save(tmp_path / "x.dng")
    with rawpy.imread(str(tmp_path / "x.dng")) as file:
        letters = "RGBG"
        assert "".join(letters[file.raw_pattern[i // 2, i % 2]] for i in range(4)) == pattern


@pytest.mark.parametrize("name", SENSORS)
def test_rawpy_opens_the_dng(name: str, tmp_path: Path) -> None:
    rawpy = pytest.importorskip("rawpy", reason="rawpy comes with the dev extra")
    film, raw = exposed(name)
    raw.save(tmp_path / "chart.dng")
    with rawpy.imread(str(tmp_path / "chart.dng")) as file:
        assert np.array_equal(file.raw_image_visible, raw.mosaic)
        assert file.black_level_per_channel[:3] == [round(raw.black_level_dn)] * 3
        assert file.white_level == raw.white_level_dn
        balance = np.array(file.camera_whitebalance[:3])
        np.testing.assert_allclose(balance / balance[1], raw.as_shot_neutral[1] / raw.as_shot_neutral, rtol=1e-4)
        linear = file.postprocess(
            use_camera_wb=True,
            output_color=rawpy.ColorSpace.sRGB,
            gamma=(1, 1),
            no_auto_bright=True,
            output_bps=16,
            user_flip=0,
        )
    found = patch_means(linear / 65535)
    reference = patch_means(film.pixels) * 0.018 * raw.iso
    assert differences(scaled_to(found, reference), reference).max() < WITHIN_DE00
    # The factor is the half stop of BaselineExposure, which LibRaw leaves to its caller.
    factor = (reference * found).sum() / (found * found).sum()
    assert factor == pytest.approx(1.404, rel=0.02)


def grey_ramp(folder: Path) -> tuple[np.ndarray, rc.RawImage]:
    """Exposures of the columns, and what a monochrome sensor makes of them, in mono.dng."""
    sensor = rc.Sensor.load("sony-imx900-mono")
    lux_s = np.linspace(0, 0.15, 64)
    raw = sensor.expose(film_of(np.tile(lux_s, (48, 1)), pitch_um=2.25, iso=sensor.iso_range()[0]))
    raw.save(folder / "mono.dng")
    return lux_s, raw


def greys(pixels: np.ndarray) -> np.ndarray:
    """Column means of the brighter half, up to where it saturates; they have no colour."""
    means = pixels.mean(axis=0)
    assert np.ptp(means, axis=1).max() < 0.01 * means.max()
    return means.mean(axis=1)[32:60]


def test_rawpy_opens_a_dng_without_filters(tmp_path: Path) -> None:
    rawpy = pytest.importorskip("rawpy", reason="rawpy comes with the dev extra")
    lux_s, raw = grey_ramp(tmp_path)
    with rawpy.imread(str(tmp_path / "mono.dng")) as file:
        assert np.array_equal(file.raw_image_visible[..., 0], raw.mosaic)
        linear = file.postprocess(
            use_camera_wb=True, gamma=(1, 1), no_auto_bright=True, output_bps=16, user_flip=0, highlight_mode=0
        )
    grey, expected = greys(linear / 65535), lux_s[32:60]
    # 48 pixels of a column know it to 0.6% or better.
    np.testing.assert_allclose(grey / grey.sum(), expected / expected.sum(), rtol=0.03)
    # Here the exposure is absolute.
    np.testing.assert_allclose(raw.exposure()[..., 0].mean(axis=0)[32:60], lux_s[32:60], rtol=0.03)


def test_the_dng_has_what_the_format_asks_for(tmp_path: Path) -> None:
    tifffile = pytest.importorskip("tifffile", reason="tifffile comes with the dev extra")
    _, raw = exposed("sony-imx071-color", "A")
    raw.save(tmp_path / "chart.dng")
    with tifffile.TiffFile(tmp_path / "chart.dng") as file:
        tags = {tag.code: tag.value for tag in file.pages[0].tags}
        assert np.array_equal(file.asarray(), raw.mosaic)
    assert bytes(tags[50706]) == b"\x01\x04\x00\x00"
    assert tags[50778] == 17  # illuminant A
    matrix = np.array(tags[50721], float).reshape(9, 2)
    matrix = (matrix[:, 0] / matrix[:, 1]).reshape(3, 3)
    neutral = np.array(tags[50728], float).reshape(3, 2)
    neutral = neutral[:, 0] / neutral[:, 1]
    # White of illuminant A (CIE 15: X = 1.0985, Z = 0.3558) is neutral.
    np.testing.assert_allclose(matrix @ [1.0985, 1, 0.3558], neutral, atol=2e-3)
    forward = np.array(tags[50964], float).reshape(9, 2)
    forward = (forward[:, 0] / forward[:, 1]).reshape(3, 3)
    np.testing.assert_allclose(forward.sum(axis=1), [0.9642, 1, 0.8251], atol=1e-3)
    description = tags[270]
    for entry in ("realcam:sensor = sony-imx071-color", "realcam:illuminant = A", "realcam:lens = double-gauss-50mm"):
        assert entry in description


def by_darktable(raw: Path) -> np.ndarray:
    """(H, W, 3): linear sRGB, without the defaults of a workflow, which would bend the tones."""
    oiio = pytest.importorskip("OpenImageIO", reason="OpenImageIO comes with the dev extra")
    picture = raw.with_suffix(".exr")
    done = subprocess.run(
        [
            *("darktable-cli", raw, picture, "--icc-type", "LIN_REC709"),
            *("--apply-custom-presets", "false", "--core", "--disable-opencl"),
            *("--configdir", raw.with_name("config"), "--library", ":memory:"),
            *("--conf", "plugins/darkroom/workflow=none"),
            *("--conf", "plugins/darkroom/chromatic-adaptation=legacy"),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert picture.is_file(), done.stdout + done.stderr
    pixels: np.ndarray = oiio.ImageBuf(str(picture)).get_pixels(oiio.FLOAT)[..., :3]
    return pixels


needs_darktable = pytest.mark.skipif(shutil.which("darktable-cli") is None, reason="darktable-cli is not installed")


@pytest.mark.slow
@needs_darktable
def test_darktable_opens_a_dng_without_filters(tmp_path: Path) -> None:
    lux_s, raw = grey_ramp(tmp_path)
    grey = greys(by_darktable(tmp_path / "mono.dng"))
    # darktable 4.2 leaves the black level in pictures of three samples: linear in the numbers as they are.
    numbers = raw.mosaic.mean(axis=0)[32:60]
    np.testing.assert_allclose(grey / grey.sum(), numbers / numbers.sum(), rtol=0.01)
    assert np.corrcoef(grey, lux_s[32:60])[0, 1] > 0.999


@pytest.mark.slow
@needs_darktable
@pytest.mark.parametrize("name", SENSORS)
def test_darktable_opens_the_dng(name: str, tmp_path: Path) -> None:
    film, raw = exposed(name)
    raw.save(tmp_path / "chart.dng")
    pixels = by_darktable(tmp_path / "chart.dng")
    assert pixels.shape == film.pixels.shape
    reference = patch_means(film.pixels) * 0.018 * raw.iso
    assert differences(scaled_to(patch_means(pixels), reference), reference).max() < WITHIN_DE00


@pytest.mark.picture_files
def test_the_command_takes_a_film_to_raw(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command) -> None:
    rawpy = pytest.importorskip("rawpy", reason="rawpy comes with the dev extra")
    oiio = pytest.importorskip("OpenImageIO", reason="OpenImageIO comes with the dev extra")
    film = chart_film(200)
    film.save(tmp_path / "film.exr")
    monkeypatch.chdir(tmp_path)

    options = ["--sensor", "sony-imx071-color", "--seed", "2", "-o", "a.dng", "-o", "a.png", "-o", "a.npy"]
    told = command("expose", "film.exr", *options)
    assert told.returncode == 0, told.stderr
    assert "sony-imx071-color, ISO 200" in told.stdout
    assert "assumed: " in told.stdout
    raw = rc.Sensor.load("sony-imx071-color").expose(film, seed=2)
    assert np.array_equal(np.load(tmp_path / "a.npy"), raw.mosaic)
    with rawpy.imread(str(tmp_path / "a.dng")) as file:
        assert np.array_equal(file.raw_image_visible, raw.mosaic)
    picture = oiio.ImageBuf(str(tmp_path / "a.png"))
    assert np.array_equal(picture.get_pixels(oiio.UINT8), raw.developed())
    for name, value in raw.metadata().items():
        assert picture.spec().getattribute(name) == value, name
    for words, why in (
        (["film.exr", "-o", "x.bmp"], ".dng, .npy (raw) or .png"),
        (["film.exr", "-o", "x.dng", "--sensor", "idael"], 'unknown sensor "idael"'),
        (["film.exr", "-o", "x.dng", "--sensor", "sony-imx174-mono"], "the lowest ISO of this sensor is"),
        (["a.png", "-o", "x.dng"], "has no exposure"),
        (["film.exr", "-o", "x.dng", "-o", "x.png", "--tone", "magic"], '"magic" is unknown; expected linear, film'),
        (["film.exr", "-o", "film.exr"], "is the film itself"),
    ):
        refused = command("expose", *words)
        assert refused.returncode == 2
        assert why in refused.stderr
        assert refused.stderr.count("\n") == 1 + ("expose" in refused.stderr and "pixels of" in refused.stderr)
    assert not list(tmp_path.glob("x.*"))
    listed = command("sensor", "list").stdout
    assert all(name in listed for name in rc.sensor_names())
    told = command("sensor", "info", "sony-imx900-mono").stdout
    assert "9458 e" in told and "FRAMOS" in told
