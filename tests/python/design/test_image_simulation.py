"""Image simulation: against direct convolution by Lens.psf, traced rays, and what white has to stay."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
import realcam as rc
from realcam import image_file
from scipy.signal import fftconvolve

if TYPE_CHECKING:
    from ..programs import Command

D_NM = 587.5618


@pytest.fixture(scope="module")
def gauss() -> rc.Lens:
    return rc.Lens.load("double-gauss-50mm")


def encoded(linear: np.ndarray) -> np.ndarray:
    """sRGB codes without rounding (IEC 61966-2-1)."""
    v = np.clip(linear, 0, 1)
    return 255 * np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)


@pytest.mark.parametrize(("f_number", "pixel_um"), [(8.0, 4.0), (2.8, 12.0)])
def test_on_the_axis_it_is_convolution_by_the_point_spread_function(
    gauss: rc.Lens, f_number: float, pixel_um: float
) -> None:
    """By waves at f/8, where the spot is small, and by rays with their aperture's diffraction at f/2.8."""
    lens = gauss.stopped_down(f_number)
    picture = np.random.default_rng(1).random((64, 64, 3)).astype(np.float32)
    picture = np.where(picture > 0.5, 1, 0.05).astype(np.float32)  # hard edges
    seen = rc.image_simulation(
        lens, picture, resolution=(64, 64), pixel_um=pixel_um, psf_grid=(2, 2), wavelengths_nm=D_NM
    )
    reach, fine = 12, 9
    size = fine * (2 * reach + 1)
    psf = lens.psf(wavelength_nm=D_NM, size=size, pitch_um=pixel_um / fine)
    kernel = psf.values.reshape(2 * reach + 1, fine, 2 * reach + 1, fine).sum(axis=(1, 3))
    expected = np.stack([fftconvolve(picture[..., k], kernel / kernel.sum(), mode="same") for k in range(3)], axis=2)
    inner = np.s_[reach:-reach, reach:-reach]
    error = np.abs(encoded(seen.pixels / seen.illumination[..., None]) - encoded(expected))[inner]
    assert error.mean() < 1, error.mean()
    assert np.abs(encoded(picture) - encoded(expected))[inner].mean() > 10  # the blur is no trifle


@pytest.mark.parametrize(
    ("name", "f_number"), [("double-gauss-50mm", 2.1), ("wide-24mm", 5.6), ("mirror-telephoto-500mm", 8)]
)
def test_white_stays_white(name: str, f_number: float) -> None:
    lens = rc.Lens.load(name).stopped_down(f_number)
    corner = 0.5 * np.hypot(*lens.film_mm)
    white = np.ones((40, 60, 3), np.float32)
    # Larger than the film, so that its own edges are not seen.
    wide = math.degrees(2 * math.atan(2 * corner / abs(lens.first_order().effective_focal_length_mm)))
    for falloff in (True, False):
        seen = rc.image_simulation(
            lens,
            white,
            height_deg=wide,
            falloff=falloff,
            psf_grid=(3, 2),
            object_distance_m=math.inf,
            wavelengths_nm=(480, 550, 620),
        )
        assert np.abs(seen.pixels[20, 30] - 1).max() < 0.005
        even = seen.pixels / seen.illumination[..., None] if falloff else seen.pixels
        assert np.abs(even - 1).max() < 0.005
    edge = lens.film_pupil((seen.x_mm[0], seen.y_mm[0])).irradiance / lens.film_pupil().irradiance
    assert seen.illumination[0, 0] == pytest.approx(edge, abs=2e-3)


def centre_of_light(light: np.ndarray) -> float:
    return float((light * np.arange(light.size)).sum() / light.sum())


def test_lines_lie_where_real_rays_land(gauss: rc.Lens) -> None:
    """Bright lines at field angles along y; the chief ray of each, traced through the lens, gives its film point."""
    lens = rc.Lens.load("wide-24mm").stopped_down(8)
    h = 801
    picture = np.zeros((h, 31, 3), np.float32)
    rows = np.array([60, 150, 300, 400, 560, 700])
    picture[rows] = 1
    height_deg = 50.0
    seen = rc.image_simulation(
        lens, picture, height_deg=height_deg, object_distance_m=math.inf, wavelengths_nm=D_NM, resolution=(31, h),
        falloff=False, psf_grid=(2, 9),
    )  # fmt: skip
    tangents = (0.5 * h - 0.5 - rows) / h * 2 * math.tan(math.radians(0.5 * height_deg))
    column = seen.pixels[:, 15, 1]
    pitch = seen.y_mm[0] - seen.y_mm[1]
    worst, bent = 0.0, 0.0
    for tangent in tangents:
        # An object above the axis sends light that falls; its image is upright again in the developed picture.
        height = -lens.spot(
            math.degrees(-math.atan(tangent)), object_distance_m=math.inf, wavelength_nm=D_NM
        ).chief_ray_mm[1]
        at = int(np.argmin(np.abs(seen.y_mm - height)))
        part = slice(at - 8, at + 9)
        found = float(np.interp(centre_of_light(column[part]), np.arange(17), seen.y_mm[part]))
        worst = max(worst, abs(found - height))
        bent = max(bent, abs(abs(height) - lens.first_order().effective_focal_length_mm * abs(tangent)))
    assert worst < 0.35 * pitch, worst / pitch  # coma moves the light's centre from the chief ray
    assert bent > 3 * pitch, bent / pitch  # a lens without distortion would not pass


def test_lateral_colour_is_that_of_chief_rays() -> None:
    """One wavelength for each channel: a line through a singlet behind its stop, whose red image is the larger one."""
    lens = rc.Lens(
        surfaces=[
            rc.Stop(thickness_mm=15, clear_semi_diameter_mm=2),
            rc.Surface(radius_of_curvature_mm=52, thickness_mm=5, material="schott:N-BK7", clear_semi_diameter_mm=16),
            rc.Surface(radius_of_curvature_mm=-5000, clear_semi_diameter_mm=16),
        ],
        film_distance_mm=97,
    )
    picture = np.zeros((601, 21, 3), np.float32)
    picture[60] = 1
    colours = (470.0, 550.0, 630.0)
    seen = rc.image_simulation(
        lens, picture, height_deg=13, object_distance_m=math.inf, wavelengths_nm=colours, resolution=(21, 1901),
        pixel_um=10, falloff=False, psf_grid=(2, 5),
    )  # fmt: skip
    tangent = (300 - 60) / 601 * 2 * math.tan(math.radians(6.5))
    heights = np.array([
        -lens.spot(-math.degrees(math.atan(tangent)), object_distance_m=math.inf, wavelength_nm=nm).chief_ray_mm[1]
        for nm in colours
    ])  # fmt: skip
    expected = seen.weights.T @ heights  # the mean of a channel's colours
    found = np.array([
        float(np.interp(centre_of_light(seen.pixels[:, 10, c]), np.arange(1901), seen.y_mm)) for c in range(3)
    ])  # fmt: skip
    pitch = seen.y_mm[0] - seen.y_mm[1]
    assert expected[0] - expected[2] > 2 * pitch
    assert found[0] - found[2] == pytest.approx(expected[0] - expected[2], abs=0.1 * pitch)


@pytest.mark.slow
def test_a_photograph_of_the_same_object_agrees() -> None:
    """rc.render of a luminous rectangle at 1 m, path by path with dispersion: the same picture."""
    lens = rc.Lens.load("wide-24mm").focused(1).stopped_down(2.8)
    blocks = np.random.default_rng(3).integers(40, 255, (8, 12, 3), dtype=np.uint8)
    blocks[0, 0], blocks[-1, 0], blocks[0, -1] = (255, 0, 0), 255, (0, 255, 0)
    codes = blocks.repeat(10, axis=0).repeat(10, axis=1)
    seen = rc.image_simulation(lens, codes, psf_grid=(5, 3))
    pupil_m = 1e-3 * (lens.first_order().entrance_pupil_position_mm - lens.film_position_mm)
    half = math.tan(math.radians(0.5 * seen.height_deg)) * (1 + pupil_m)
    corners = [[-1.5 * half, -half, -1], [1.5 * half, -half, -1], [1.5 * half, half, -1], [-1.5 * half, half, -1]]
    lamp = rc.Material(diffuse=(0, 0, 0), emission=(1000, 1000, 1000), emission_texture=codes)
    uvs = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    scene = rc.Scene.from_arrays(np.array(corners), [[0, 1, 2], [0, 2, 3]], uvs=uvs, materials=[lamp])
    camera = rc.Camera(lens, film=rc.Film.for_lens(lens, resolution=(120, 80)), exposure_time_s=1)
    taken = rc.render(scene, camera, spp=128, effects={"dispersion"}, device="cpu").pixels
    taken = taken * (seen.pixels[30:50, 50:70].mean() / taken[30:50, 50:70].mean())
    inner = np.s_[4:-4, 4:-4]
    error = encoded(taken)[inner] - encoded(seen.pixels)[inner]
    assert np.abs(error).mean() < 3  # noise, and the edges of texels, which the renderer interpolates
    assert np.abs(error.mean(axis=(0, 1))).max() < 1.5
    down, right = np.gradient(encoded(seen.pixels), axis=(0, 1))
    slopes = np.stack([down[inner].ravel(), right[inner].ravel()], axis=1)
    shift = np.linalg.lstsq(slopes, error.ravel(), rcond=None)[0]
    assert np.abs(shift).max() < 0.05, shift  # pixels


def test_an_object_has_a_height_in_metres(gauss: rc.Lens) -> None:
    """At 1 m: a picture 0.2 m high has the height 0.2 m times the lens's own magnification."""
    lens = gauss.focused(1).stopped_down(8)
    picture = np.ones((50, 50, 3), np.float32)
    seen = rc.image_simulation(
        lens, picture, height_m=0.2, resolution=(400, 400), falloff=False, psf_grid=(2, 2), wavelengths_nm=D_NM
    )
    inside = float(seen.pixels[:, 200, 1].sum()) * (seen.y_mm[0] - seen.y_mm[1])
    pupil_mm = lens.first_order().entrance_pupil_position_mm
    distance_mm = 1000 - lens.film_position_mm
    angle = math.degrees(math.atan(100 / (distance_mm + pupil_mm)))
    assert inside == pytest.approx(2 * lens.spot(angle, wavelength_nm=D_NM).chief_ray_mm[1], rel=2e-3)
    assert seen.height_deg == pytest.approx(2 * angle, rel=1e-9)


def test_crops_and_flips_are_parts_of_the_whole(gauss: rc.Lens) -> None:
    rng = np.random.default_rng(2)
    picture = rng.integers(0, 256, (60, 90, 3), dtype=np.uint8)
    options = {"psf_grid": (3, 3), "wavelengths_nm": [480, 550, 620]}
    whole = rc.image_simulation(gauss, picture, **options)  # type: ignore[arg-type]
    part = rc.image_simulation(gauss, picture, crop=(11, 7, 40, 33), flip="both", **options)  # type: ignore[arg-type]
    np.testing.assert_allclose(part.pixels[::-1, ::-1], whole.pixels[7:40, 11:51], atol=2e-6)
    np.testing.assert_array_equal(part.x_mm[::-1], whole.x_mm[11:51])
    assert whole.psfs.shape == (3, 3, 65, 65, 3)
    np.testing.assert_allclose(whole.psfs[1, 1].sum(axis=(0, 1)) * whole.psf_pitch_um**2, 1, rtol=0.03)
    mirrored = rc.image_simulation(gauss, picture[:, ::-1], **options)  # type: ignore[arg-type]
    np.testing.assert_allclose(mirrored.pixels[:, ::-1], whole.pixels, atol=2e-6)  # a lens of revolution


def test_a_large_picture_on_a_small_film_keeps_its_light(gauss: rc.Lens) -> None:
    """Stripes finer than the film's pixels become grey, not moire."""
    picture = np.zeros((600, 900), np.float32)
    picture[:, ::5] = 1
    seen = rc.image_simulation(
        gauss.stopped_down(8), picture, resolution=(90, 60), falloff=False, psf_grid=(2, 2), wavelengths_nm=D_NM
    )
    assert np.abs(seen.pixels[10:-10, 10:-10] - 1 / 5).max() < 0.02


def test_fisheyes_see_pictures_by_angle() -> None:
    lens = rc.Lens.load("fisheye-6mm-220deg")
    picture = np.ones((61, 61, 3), np.float32)
    seen = rc.image_simulation(lens, picture, height_deg=200, resolution=(90, 60), psf_grid=(2, 2), wavelengths_nm=D_NM)
    assert seen.projection == "angle"
    # The light ends on the film between 10 and 12 mm from the axis; 95 degrees are inside.
    radius = np.hypot(*np.meshgrid(seen.x_mm, seen.y_mm))
    assert seen.pixels[radius > 12].max() == 0
    height = abs(lens.spot(95.0, object_distance_m=math.inf, wavelength_nm=D_NM).chief_ray_mm[1])
    row = seen.pixels[30, :, 1] / np.maximum(seen.illumination[30], 1e-9)
    assert row[int(np.argmin(np.abs(seen.x_mm - height)))] == pytest.approx(1, abs=0.05)
    with pytest.raises(rc.InputError, match=r"height_m.*deg from the axis.*height_deg"):
        rc.image_simulation(lens, picture, height_m=1.0)
    with pytest.raises(rc.InputError, match=r"at a finite distance ends before 90 deg"):
        rc.image_simulation(lens, picture, object_distance_m=1.0)


@pytest.mark.parametrize("name", ["view-camera-210mm", pytest.param("anamorphic-65mm", marks=pytest.mark.slow)])
def test_lenses_that_are_not_of_revolution(name: str) -> None:
    """A spot in the picture lies where the lens images its object point: the film point found by tracing back."""
    lens = rc.Lens.load(name).stopped_down(11)
    picture = np.zeros((61, 91, 3), np.float32)
    picture[18:21, 63:66] = 1
    seen = rc.image_simulation(
        lens, picture, resolution=(182, 122), wavelengths_nm=D_NM, psf_grid=(3, 3), falloff=False
    )
    light = np.maximum(seen.pixels[..., 1], 0)
    x, y = (float((light * at).sum() / light.sum()) for at in (seen.x_mm[None, :], seen.y_mm[:, None]))

    def tangents(film: tuple[float, float]) -> np.ndarray:
        direction = lens.aim([[0.0, 0.0]], film_mm=film, object_distance_m=math.inf).directions[0]
        return np.asarray(-direction[:2] / direction[2])

    per_height = 2 * math.tan(math.radians(0.5 * seen.height_deg))
    expected = np.array([(64 + 0.5 - 45.5) / 61, (30.5 - 19.5) / 61]) * per_height
    found = tangents((-x, -y)) - tangents((0.0, 0.0))
    np.testing.assert_allclose(found, expected, atol=0.6 / 122 * per_height)  # half a pixel


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"flip": "up"}, 'unknown flip "up"; expected one of none, horizontal, vertical, both'),
        ({"crop": (5, 5, 90, 5)}, r"crop: 90 x 5 pixels from \(5, 5\) on do not lie within the film's 30 x 20 pixels"),
        ({"height_m": 1.0, "object_distance_m": math.inf}, "the object is at infinity; use height_deg"),
        ({"height_m": 1.0, "height_deg": 5.0, "object_distance_m": 2.0}, "exclude each other"),
        ({"height_deg": 180.0}, "height_deg must lie between 0 and 180"),
        ({"projection": "globe"}, 'unknown projection "globe"; expected tangent or angle'),
        ({"object_distance_m": -1.0}, "object_distance_m must be positive"),
        ({"psf_grid": (1, 5)}, "psf_grid must be at least 2"),
        ({"pixel_um": 0.0}, "pixel_um must be a positive number"),
        ({"wavelengths_nm": []}, "wavelengths_nm must be positive numbers"),
        (
            {"pixel_um": 0.05, "resolution": (30, 20), "object_distance_m": 0.3},
            r"the blur at the film point .* reaches \d+ pixels",
        ),
    ],
)
def test_what_cannot_be_is_said(gauss: rc.Lens, words: dict[str, object], message: str) -> None:
    with pytest.raises(rc.InputError, match=message):
        rc.image_simulation(gauss, np.ones((20, 30, 3), np.float32), **words)  # type: ignore[arg-type]


def test_lenses_without_light_are_told(gauss: rc.Lens) -> None:
    with pytest.raises(rc.InputError, match=r"no light through lens .* reaches the centre of the film"):
        rc.image_simulation(gauss.shifted(y_mm=60), np.ones((20, 30, 3), np.float32))


@pytest.mark.parametrize(
    "picture", [np.ones((4, 4, 4)), np.ones((0, 4, 3)), np.full((4, 4, 3), np.nan), np.ones((4, 4), bool)]
)
def test_arrays_that_are_no_pictures(gauss: rc.Lens, picture: np.ndarray) -> None:
    with pytest.raises(rc.InputError, match=r"^picture must "):
        rc.image_simulation(gauss, picture)


@pytest.mark.picture_files
def test_the_command(command: Command, tmp_path: Path) -> None:
    chart, target = tmp_path / "chart.png", tmp_path / "seen.png"
    codes = np.full((20, 30, 3), 255, np.uint8)
    codes[2:5] = (200, 40, 90)
    image_file.write_codes(codes, chart, {})
    options = ("--f-number", "8", "--psf-grid", "2x2", "--wavelengths", "550", "--height-deg", "40")
    done = command("lens", "image", "double-gauss-50mm", chart, "-o", target, *options)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"wrote {target}\n", "")
    seen = image_file.read_picture(target)
    assert seen.shape == (20, 30, 3)
    expected = rc.image_simulation(
        rc.Lens.load("double-gauss-50mm").stopped_down(8), chart, psf_grid=(2, 2), wavelengths_nm=550, height_deg=40
    )
    np.testing.assert_array_equal(encoded(seen).round(), expected.developed())
    assert seen[10, 15].min() > 0.995  # white is white
    done = command("lens", "image", "double-gauss-50mm", chart, "-o", target, *options, "--psfs", "-q")
    assert (done.returncode, done.stdout) == (0, "")
    assert image_file.read_picture(target).shape == (20, 50, 3)  # two by two squares beside it
    (tmp_path / "text.png").write_text("no picture")
    for name, words, message in (
        ("none.png", (), "no such file"),
        ("text.png", (), "is not a picture"),
        ("chart.png", ("--crop", "1,2,3"), '--crop: "1,2,3": expected 4 whole numbers with "," between'),
        ("chart.png", ("--resolution", "4by3"), "--resolution"),
    ):
        done = command("lens", "image", "double-gauss-50mm", tmp_path / name, "-o", target, *words)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and message in done.stderr, done.stderr
        assert "latitude" not in done.stderr
    done = command("lens", "image", "double-gauss-50mm", chart, "-o", tmp_path / "seen.gif")
    assert done.returncode == 2 and ".tiff or .webp" in done.stderr
