"""Dispersion: colours where lens.trace and first-order optics put them, white that stays white, and what cannot be had.

The observer is here that of Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
Functions" (JCGT 2013), and D65 the CIE's table every 20 nm: neither comes from the tables that the program uses.
"""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

PITCH_MM = 0.02
D65_380_TO_780 = np.fromstring(
    "49.98 82.75 93.43 104.86 117.81 115.92 109.35 104.79 104.41 100.0 95.79 "
    "90.01 87.70 83.70 80.21 78.28 71.61 61.60 75.09 46.42 63.38",
    sep=" ",
)
SRGB_FROM_XYZ = np.array(
    [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]]
)


def film_curves(nm: np.ndarray) -> np.ndarray:
    """(3, N): what white light under D65 is to the three channels, each with the sum 1."""

    def lobe(middle: float, below: float, above: float) -> np.ndarray:
        return np.exp(-0.5 * ((nm - middle) / np.where(nm < middle, below, above)) ** 2)

    x = 1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2)
    y = 0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1)
    z = 1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)
    curves = SRGB_FROM_XYZ @ np.array([x, y, z]) * np.interp(nm, np.arange(380, 781, 20), D65_380_TO_780)
    return curves / curves.sum(axis=1, keepdims=True)


def quiet(scene: rc.Scene, camera: rc.Camera, **settings: object) -> rc.Image:
    """A picture with dispersion. Ignores warnings, because the lens may have no dispersion."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return rc.render(scene, camera, effects={"dispersion"}, **settings)  # type: ignore[arg-type]


def landscape_lens(stop_to_lens_mm: float, radius_mm: float) -> rc.Lens:
    """A singlet of N-BK7, f = 100 mm, behind a stop: nothing is corrected. Film in the paraxial focus of the d line."""
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=radius_mm, thickness_mm=stop_to_lens_mm),
        rc.Surface(radius_of_curvature_mm=102.0, thickness_mm=4.0, material="N-BK7", clear_semi_diameter_mm=12.0),
        rc.Surface(radius_of_curvature_mm=-102.0, clear_semi_diameter_mm=12.0),
    ]
    lens = rc.Lens(surfaces=surfaces, film_distance_mm=90.0)
    return rc.Lens(surfaces=surfaces, film_distance_mm=lens.first_order().back_focal_distance_mm)


class Edge:
    """A bright half-plane far off the axis of a singlet behind its stop, whose lateral colour is some pixels wide."""

    MIDDLE = 400  # the column on the axis
    AROUND = 45  # columns on either side of the edge of which the light is summed

    def __init__(self) -> None:
        self.lens = landscape_lens(40.0, 2.0)
        self.distance_m = 1000.0
        self.left_m = 0.06 * self.distance_m  # 6 mm on the film, 300 pixels from the axis
        self.camera = rc.Camera(self.lens, film=rc.Film(16, 0.2, (800, 10)), exposure_time_s=1)
        film_m = self.lens.film_position_mm / 1000
        width = 0.1 * self.distance_m
        middle = (self.left_m + width, 0, -self.distance_m - film_m)
        self.scene = scenes.scene_of(scenes.quad(middle, width, emission=1))

    def places(self, image: rc.Image) -> np.ndarray:
        """(3,): where the edge is in each channel, mm to the right of the axis. An edge that an aberration blurs is
        where its mean is, whatever the blur: the light of a strip says how much of it is bright. In parts of a picture
        without the edge, because light falls off towards the side, and of its bright end, because each wavelength has
        a picture of its own size and so of its own brightness."""
        strip = image.pixels.astype(np.float64).mean(axis=0)  # (800, 3)
        about = round(self.traced(550.0) / PITCH_MM) + self.MIDDLE
        first, last = about - self.AROUND, about + self.AROUND
        parts = strip[first:last] / self.whole()[first:last]
        share = parts.sum(axis=0) / parts[-self.AROUND // 2 :].mean(axis=0)
        return np.asarray((last - self.MIDDLE - share) * PITCH_MM)

    def whole(self) -> np.ndarray:
        """(800, 1): film irradiance under a uniform field, as a fitted polynomial, so without noise."""
        sky = rc.render(scenes.sky(), self.camera, effects=(), spp=64).pixels[..., 1].astype(np.float64).mean(axis=0)
        columns = np.arange(len(sky)) - self.MIDDLE
        return np.asarray(np.polyval(np.polyfit(columns, sky, 4), columns))[:, None]

    def traced(self, nm: float) -> float:
        """Mean film coordinate of rays from a point of the edge, in mm to the right (pictures are turned)."""
        n = 64
        ring, turn = np.sqrt((np.arange(n) + 0.5) / n), np.arange(n) * 2 * np.pi / n
        r = self.lens.stop_semi_diameter_mm * ring[:, None]
        # The stop is the first surface; a far point sends rays evenly all over it.
        target = np.stack([(r * np.cos(turn)).ravel(), (r * np.sin(turn)).ravel(), np.zeros(n * n)], axis=1)
        point = np.array([-1000 * self.left_m, 0.0, -1000 * self.distance_m])
        start = np.broadcast_to(point, target.shape)
        out = self.lens.trace(start, target - point, start="scene", wavelength_nm=nm)
        passed = np.asarray(out.status) == int(rc.RayStatus.OK)
        assert passed.all()
        o, d = np.asarray(out.origins_mm), np.asarray(out.directions)
        return float((o[:, 0] + (self.lens.film_position_mm - o[:, 2]) / d[:, 2] * d[:, 0]).mean())


@pytest.fixture(scope="module")
def edge() -> Edge:
    return Edge()


@pytest.mark.parametrize("nm", [430.0, 486.1, 546.1, 656.3])
def test_lateral_colour_of_a_line_is_that_of_the_trace(edge: Edge, nm: float) -> None:
    place = edge.places(quiet(edge.scene, edge.camera, spp=64, illuminant=nm, max_bounces=0))
    assert place == pytest.approx(edge.traced(nm), abs=PITCH_MM / 20)


def test_lateral_colour_of_white_light(edge: Edge) -> None:
    """Each channel's edge is the mean of the edges of all wavelengths, weighted by the channel's response. The analytic
    observer has an error of one percent, for a spread over two pixels."""
    place = edge.places(quiet(edge.scene, edge.camera, spp=1024, max_bounces=0))
    nm = np.arange(390.0, 741.0, 10.0)
    traced = np.array([edge.traced(float(w)) for w in nm])
    expected = film_curves(nm) @ traced
    assert place == pytest.approx(expected, abs=PITCH_MM / 20)
    assert abs(place[0] - place[2]) > 0.5 * PITCH_MM  # there is something to see


@pytest.mark.parametrize("nm", [430.0, 780.0])
def test_axial_colour_is_that_of_first_order(nm: float) -> None:
    """A far small lamp is blurred to a disc by the way from the film to the focus of its wavelength, over N."""
    lens = landscape_lens(0.0, 1.5)  # f/33
    there = lens.first_order(nm)
    far_m = 1e4
    shift = there.back_focal_distance_mm - lens.film_distance_mm
    last_vertex = lens.film_position_mm - lens.film_distance_mm
    pupil_to_focus = there.back_focal_distance_mm + last_vertex - there.exit_pupil_position_mm
    radius = abs(shift) * there.exit_pupil_diameter_mm / 2 / pupil_to_focus
    mark_mm = 0.01
    half_m = mark_mm / 2 / there.effective_focal_length_mm * far_m
    scene = scenes.scene_of(scenes.quad((0, 0, -far_m), half_m, emission=1e6))
    camera = rc.Camera(lens, film=rc.Film(0.4, 0.4, (80, 80)), exposure_time_s=1)
    light = quiet(scene, camera, spp=1024, illuminant=nm, max_bounces=0).pixels[..., 1].astype(np.float64)
    at = (np.arange(80) + 0.5 - 40) * 0.005
    squares = at[None, :] ** 2 + at[:, None] ** 2
    # Second moments add: of the disc r^2 / 2, of the mark and of the pixel a^2 / 6 each.
    measured = math.sqrt(2 * ((light * squares).sum() / light.sum() - (mark_mm**2 + 0.005**2) / 6))
    # Real rays at the rim meet the axis 0.04 mm nearer, of shifts of 1.1 and 2 mm, and others less; noise is below 1%.
    assert measured == pytest.approx(radius, rel=0.04)


@pytest.fixture(scope="module")
def grey_card() -> tuple[rc.Camera, np.ndarray]:
    """A camera whose lens vignettes all colours alike, its stop being its last surface; the mean (3,) of its picture
    without dispersion."""
    lens = rc.Lens.load("singlet-100mm").stopped_down(32)
    camera = rc.Camera(lens, film=rc.Film(3.6, 2.4, (36, 24)), exposure_time_s=1)
    plain = rc.render(scenes.sky(), camera, effects=(), spp=8192).pixels.astype(np.float64)
    return camera, plain.mean(axis=(0, 1))


@pytest.mark.parametrize("illuminant", [None, "FL2", 546.1, [(400, 1.0), (500, 0.2), (700, 2.0)]])
def test_a_grey_card_stays_grey(grey_card: tuple[rc.Camera, np.ndarray], illuminant: object) -> None:
    """Seven million samples, whose channels vary by as much as white itself, mean to 0.04%."""
    camera, plain = grey_card
    seen = quiet(scenes.sky(), camera, spp=8192, illuminant=illuminant).pixels.astype(np.float64).mean(axis=(0, 1))
    assert seen / plain == pytest.approx(1.0, abs=1e-3)


def test_colours_of_the_scene_stay_under_d65(grey_card: tuple[rc.Camera, np.ndarray]) -> None:
    camera, _ = grey_card
    for color in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.7, 0.2, 0.05)):
        scene = scenes.sky().with_environment(color)
        plain = rc.render(scene, camera, effects=(), spp=1024).pixels.astype(np.float64).mean(axis=(0, 1))
        seen = quiet(scene, camera, spp=1024).pixels.astype(np.float64).mean(axis=(0, 1))
        assert seen == pytest.approx(plain, abs=2e-3 * plain.max())


@pytest.mark.parametrize("spp", [2, 8])  # from 8 on, the chance of stopped samples is taken out too
@pytest.mark.parametrize(
    ("illuminant", "color"), [("A", (0.05, 0.05, 1)), ("FL2", (0.02, 1, 0.02)), ("D65", (1, 0.5, 0.1))]
)
def test_balanced_colours_are_right_in_the_mean(illuminant: str, color: tuple[float, float, float], spp: int) -> None:
    """The reference is the same samples without the control variates."""
    camera = rc.Camera(rc.Lens.load("double-gauss-50mm").stopped_down(4), film=rc.Film(24, 16, (72, 48)))
    scene = scenes.sky().with_environment(color)
    differences, means = [], []
    for seed in range(20):
        session = rc.Session(
            scene, camera, effects=("dispersion",), illuminant=illuminant, max_bounces=0, seed=seed, device="cpu"
        )
        session.add(spp)
        inner = np.s_[8:-8, 8:-8]  # at the border, the mean is over other pixels
        sums = session.expose((0, 0, 72, 48), 0, spp).pixels
        plain = camera.exposure_time_s * sums["irradiance"] / sums["samples"][..., None]
        pixels = session.image().pixels.astype(np.float64)
        differences.append((pixels - plain)[inner].mean(axis=(0, 1)))
        means.append(plain[inner].mean(axis=(0, 1)))
    # The chance of stopped samples, which is taken out from 8 samples on, is a thousandth of the light.
    error = np.std(differences, axis=0, ddof=1) / math.sqrt(len(differences))
    assert np.abs(np.mean(differences, axis=0)).max() < 1e-3 * np.mean(means, axis=0).max() + 4 * error.max()


def test_other_light_changes_colours_but_not_white() -> None:
    """Under a line in the red, blue is black and red is white: the film is balanced to what light there is."""
    camera = rc.Camera(rc.Lens.load("singlet-100mm"), film=rc.Film(3.6, 2.4, (12, 8)), exposure_time_s=1)
    blue = quiet(scenes.sky().with_environment((0, 0, 1)), camera, spp=16, illuminant=650).pixels.mean(axis=(0, 1))
    red = quiet(scenes.sky().with_environment((1, 0, 0)), camera, spp=16, illuminant=650).pixels.mean(axis=(0, 1))
    assert blue.max() < 0.05 * red.min()
    assert red.max() == pytest.approx(red.min(), rel=1e-5)


def one_index(lens: rc.Lens) -> rc.Lens:
    """The lens of glasses that have their index at the design wavelength everywhere."""
    for i, surface in enumerate(lens.surfaces):
        if surface.type == "refracting" and surface.material.index(500.0) != 1:
            lens = lens.with_surface(i, material=surface.material.index(lens.wavelength_nm))
    return lens


def busy_scene() -> rc.Scene:
    """Soft shadows, light that bounces, colours, and depths out of focus."""
    lamp = scenes.quad((0.5, 1.5, -2), 0.3, right=(1, 0, 0), up=(0, 0, 1), emission=200)
    floor = scenes.quad((0, -0.3, -2), 3, right=(1, 0, 0), up=(0, 0, -1), diffuse=(0.7, 0.6, 0.5))
    back = scenes.quad((0, 0.5, -3), 2, diffuse=(0.3, 0.5, 0.7))
    front = scenes.quad((-0.2, 0, -1.4), 0.15, diffuse=(0.8, 0.3, 0.2))
    return scenes.scene_of(lamp, floor, back, front).with_environment((2, 3, 4))


@pytest.mark.parametrize("name", ["double-gauss-50mm", "phone-4mm"])
def test_without_data_it_changes_nothing(name: str) -> None:
    lens = one_index(rc.Lens.load(name)).focused(2.0)
    camera = rc.Camera(lens, film=rc.Film(lens.film_mm[0], lens.film_mm[1], (48, 32)), exposure_time_s=1)
    plain = rc.render(busy_scene(), camera, effects=(), spp=256).pixels.astype(np.float64)
    seen = quiet(busy_scene(), camera, spp=256).pixels.astype(np.float64)
    # The same paths, each with a third of its possible wavelengths: the difference is noise of zero mean.
    assert seen.mean(axis=(0, 1)) == pytest.approx(plain.mean(axis=(0, 1)), rel=5e-3)
    assert np.sqrt(((seen - plain) ** 2).mean()) < 0.05 * plain.mean()


@pytest.mark.slow
def test_noise_where_colours_stay_in_a_pixel() -> None:
    """Noise that wavelength sampling adds to RGB, relative to the picture: 0.18 with a single wavelength per sample.
    With three wavelengths per sample, the remaining noise comes from the part of each channel that they miss and from
    the borders of pixels.
    """
    lens = rc.Lens.load("double-gauss-100mm").focused(2.0)
    camera = rc.Camera(lens, film=rc.Film(36, 24, (48, 32)), exposure_time_s=1)

    def variance(effects: str | tuple[()]) -> np.ndarray:
        pictures = [
            rc.render(busy_scene(), camera, spp=64, seed=seed, effects=effects).pixels.astype(np.float64)
            for seed in range(12)
        ]
        squares = (np.mean(pictures, axis=0) ** 2).mean(axis=(0, 1))
        return np.asarray(np.var(pictures, axis=0, ddof=1).mean(axis=(0, 1)) / squares)

    added = np.sqrt(variance("dispersion") - variance(()))
    assert (added < 0.07).all(), added


def test_a_bright_sky_is_even() -> None:
    """All samples bring the same light, and pixels would differ by the colours that they get by chance: by 8%."""
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    camera = rc.Camera(lens, film=rc.Film(36, 24, (240, 160)), exposure_time_s=1)
    sky = scenes.scene_of(scenes.quad((0, 0, 9000), 0.01)).with_environment(50.0)

    dispersed = np.array(
        [rc.render(sky, camera, spp=32, seed=seed, effects="dispersion").pixels.astype(np.float64) for seed in range(6)]
    )
    noise = np.sqrt(dispersed.var(axis=0, ddof=1).mean(axis=(0, 1)))
    # A mean of 25 pixels is known to a fifth of 8%, and some of that is the pixel's own.
    assert (noise < 0.016 * dispersed.mean(axis=(0, 1, 2))).all(), noise
    # The colours of the lens's vignetting are no chance: the corners' means are those of samples that count alone.
    alone = np.array(
        [quiet(sky, camera, spp=32, seed=seed, layers=("variance",)).pixels.astype(np.float64) for seed in range(6, 12)]
    )
    for corner in (np.s_[:, :40, :40], np.s_[:, -40:, -40:]):
        means = [each[corner].mean(axis=(1, 2)) for each in (dispersed, alone)]
        error = np.sqrt(sum(mean.var(axis=0, ddof=1) for mean in means) / 6) + 2e-4 * means[1].mean(axis=0)
        assert (np.abs(means[0].mean(axis=0) - means[1].mean(axis=0)) < 5 * error).all()


def test_samples_count_in_the_pixels_where_their_colours_end() -> None:
    """Through a singlet whose colours lie some pixels apart. With the layer of the variance a sample counts in its own
    pixel alone: the same mean, also where tiles of pixels that share samples meet, and more noise."""
    camera = rc.Camera(landscape_lens(40.0, 4.0), film=rc.Film(36, 15, (96, 40)), exposure_time_s=1)
    scene = busy_scene()

    def pictures(seeds: range, **settings: object) -> np.ndarray:
        return np.array(
            [quiet(scene, camera, spp=64, seed=seed, **settings).pixels.astype(np.float64) for seed in seeds]
        )

    shared, alone = pictures(range(10)), pictures(range(10, 20), layers=("variance",))
    noise = [np.sqrt(np.mean(each.var(axis=0, ddof=1), axis=(0, 1))) for each in (shared, alone)]
    assert (noise[0] < 0.95 * noise[1]).all(), noise
    # Shared samples make neighbours err alike, so that the error of a mean of pixels is known from the seeds alone.
    for axis in (1, 2):  # the means of columns, and of rows
        means = [each.mean(axis=axis) for each in (shared, alone)]  # (seeds, pixels, channels)
        error = np.sqrt(sum(mean.var(axis=0, ddof=1) for mean in means) / 10)
        apart = (means[0].mean(axis=0) - means[1].mean(axis=0)) / error
        # Some hundred quotients of 18 degrees of freedom: one in 1e5 is beyond 6, and the mean square is 1.13.
        assert np.abs(apart).max() < 6
        assert (apart**2).mean() < 1.5


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("wide-22mm", "the glasses of surfaces 1, 3, .* have"),
        ("fisheye-6mm-220deg", r"the glass of surface \d+ .* has"),
    ],
)
def test_what_the_lens_cannot_give_is_said(name: str, message: str) -> None:
    camera = rc.Camera(rc.Lens.load(name), film=rc.Film(3.6, 2.4, (6, 4)))
    with pytest.warns(UserWarning, match=f"dispersion: {message} one index only"):
        rc.render(scenes.sky(), camera, spp=1, effects="dispersion")


def test_what_makes_no_picture_is_an_error() -> None:
    lens = rc.Lens.load("singlet-100mm")
    camera = rc.Camera(lens, film=rc.Film(3.6, 2.4, (6, 4)))

    known = rc.Glass.table([(486.1327, 1.52238), (587.5618, 1.5168), (656.2725, 1.51432)])
    short = camera.replace(lens=lens.with_surface(0, material=known))
    for taken_by, effects, illuminant, message in (
        (camera, "glare", None, 'unknown effect "glare"; expected some of auto, none, dispersion, coatings'),
        (camera, (), "A", "illuminant needs one of the effects dispersion and diffraction"),
        (camera.replace(model="thin"), "dispersion", None, "dispersion: the camera's model must be full"),
        (camera, "dispersion", "D100", "illuminant: .*is unknown"),
        (camera, "dispersion", 900.0, "illuminant: .*between 380 and 780"),
        (camera, "dispersion", [(500, 1.0), (480, 1.0)], "illuminant: .*must be strictly increasing"),
        (camera, "dispersion", [(500, 1.0)], "illuminant: .*at least two points"),
        (camera, "dispersion", [(546, 1.0), (560, 1.0)], "illuminant: .*too little"),
        (short, "dispersion", None, "the glass of surface 1 .*is known from 486.1 to 656.3 nm; 380"),
    ):
        with pytest.raises(rc.InputError, match=message):
            rc.render(scenes.sky(), taken_by, spp=1, effects=effects, illuminant=illuminant)
    rc.render(scenes.sky(), short, spp=1, effects="dispersion", illuminant=546.1)


def test_metadata_session_and_shot_file(tmp_path: Path) -> None:
    camera = rc.Camera(rc.Lens.load("singlet-100mm"), film=rc.Film(3.6, 2.4, (12, 8)), exposure_time_s=1)
    scene = scenes.sky()
    image = quiet(scene, camera, spp=8, illuminant="FL2")
    assert image.metadata()["realcam:effects"] == "dispersion"
    assert image.metadata()["realcam:illuminant"] == "FL2"
    assert "realcam:effects" not in rc.render(scene, camera, effects=(), spp=1).metadata()
    session = rc.Session(scene, camera, effects=["dispersion"], illuminant="FL2")
    session.add(8)
    assert np.array_equal(session.image().pixels, image.pixels)
    assert session.image().metadata() == image.metadata()
    (tmp_path / "box.obj").write_text("v 0 0 -1\nv 1 0 -1\nv 0 1 -1\nf 1 2 3\n")
    text = 'format = 1\nscene = "box.obj"\nexposure_time_s = 1\nlens = "singlet-100mm"\n'
    (tmp_path / "a.toml").write_text(text + 'effects = ["dispersion"]\nilluminant = [[400, 1], [700, 2.5]]\n')
    shot = rc.Shot.load(tmp_path / "a.toml")
    assert (shot.effects, shot.illuminant) == (("dispersion",), "400:1,700:2.5")
    (tmp_path / "b.toml").write_text(text + "effects = []\nilluminant = 546\n")
    with pytest.raises(rc.InputError, match=r"b\.toml:6: illuminant needs one of the effects dispersion"):
        rc.Shot.load(tmp_path / "b.toml")
