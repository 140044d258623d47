"""Diffraction in pictures: Airy's disc, a perfect lens's contrast, spikes of blades, and as much light as without."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc
import scipy.optimize
import scipy.special

from ...measurement import Measurement, hold
from .. import scenes
from .test_ghost_pictures import far_lamp

LINE_NM = 550.0


def perfect_lens(f_number: float, focal_length: float = 50.0) -> rc.Lens:
    """Plane in front and a hyperboloid behind: it brings light along the axis to one point (Descartes)."""
    n, radius = 1.6, 0.5 * focal_length / f_number
    glass = {"clear_semi_diameter_mm": 1.3 * radius}
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=radius, thickness_mm=0),
        rc.Surface(radius_of_curvature_mm=math.inf, thickness_mm=10, material=n, **glass),
        rc.Surface(radius_of_curvature_mm=-(n - 1) * focal_length, conic=-(n**2), **glass),
    ]
    return rc.Lens(surfaces=surfaces, film_distance_mm=focal_length, wavelength_nm=LINE_NM)


def airy_radius_um(f_number: float, focal_length: float = 50.0) -> float:
    """Radius of the first dark ring: 0.61 wavelengths over the sine of the marginal angle. The hyperboloid is at the
    distance f (n - 1) / (n cos(angle) - 1) from the focus."""
    n, radius = 1.6, 0.5 * focal_length / f_number
    angle = scipy.optimize.brentq(
        lambda a: focal_length * (n - 1) * math.sin(a) / (n * math.cos(a) - 1) - radius, 0.0, 0.5
    )
    return 0.5 * 1.219670 * LINE_NM / 1000 / math.sin(angle)


def film_of(pixel_um: float, side: int) -> rc.Film:
    return rc.Film(side * pixel_um / 1000, side * pixel_um / 1000, (side, side))


def picture(
    scene: rc.Scene,
    lens: rc.Lens,
    film: rc.Film,
    spp: int,
    nm: float = LINE_NM,
    model: str = "full",
    **settings: object,
) -> np.ndarray:
    """(H, W): one channel of the picture under a line."""
    camera = rc.Camera(lens, film=film, exposure_time_s=1, model=model)
    effects = {"diffraction"} | set(settings.pop("effects", ()))  # type: ignore[call-overload]
    image = rc.render(scene, camera, spp=spp, effects=effects, illuminant=nm, device="cpu", **settings)  # type: ignore[arg-type]
    return image.pixels[:, :, 1].astype(np.float64)


def radii(side: int, pixel: float) -> np.ndarray:
    """(H, W): of the pixels' middles from the picture's."""
    place = (np.arange(side) + 0.5 - side / 2) * pixel
    return np.hypot(place[None, :], place[:, None])


@pytest.mark.parametrize("f_number", [4.0, 8.0, 22.0])
def test_the_picture_of_a_star_is_airys_disc(f_number: float) -> None:
    lens, side = perfect_lens(f_number), 96
    airy_um = airy_radius_um(f_number)
    pixel = airy_um / 12
    star = picture(far_lamp(0.0, 0.0, distance_m=1e6), lens, film_of(pixel, side), spp=1024)
    r = radii(side, pixel)
    flux = math.pi * lens.stop_semi_diameter_mm**2 / (pixel / 1000) ** 2  # of a lamp of 1 lux, in pixels
    inside = star[r < airy_um].sum() / flux
    hold(Measurement("Effects", "light of a star inside Airy's first dark ring, 83.8%", f"f/{f_number:g}", "cpu",
                     "float32", abs(inside - 0.8378), 0.003, "of all"))  # fmt: skip
    # Airy's pattern of another size, up to behind its second dark ring at 2.233, fitted to it. A pixel of a twelfth of
    # the first one's radius takes sharpness from it, but moves no ring.
    about = (r > 0.5 * airy_um) & (r < 1.8 * airy_um)

    def misfit(size: float) -> float:
        x = np.pi * 1.219670 * r[about] / (size * airy_um)
        pattern = (scipy.special.j1(x) / x) ** 2
        scale = (pattern * star[about]).sum() / (pattern**2).sum()
        return float(((star[about] - scale * pattern) ** 2).sum())

    size = scipy.optimize.minimize_scalar(misfit, bounds=(0.8, 1.2), method="bounded").x
    hold(Measurement("Effects", "radius of Airy's first dark ring", f"f/{f_number:g}", "cpu", "float32",
                     abs(size - 1), 0.01, "of 1.22 wavelengths times f-number"))  # fmt: skip


def perfect_contrast(frequency: np.ndarray) -> np.ndarray:
    """MTF of a diffraction-limited circular aperture; `frequency` is relative to the cutoff frequency."""
    return 2 / np.pi * (np.arccos(frequency) - frequency * np.sqrt(1 - frequency**2))


@pytest.mark.parametrize("f_number", [4.0, 22.0])
@pytest.mark.parametrize("emits", [False, True])
def test_an_edge_has_the_contrast_of_a_perfect_lens(f_number: float, emits: bool) -> None:
    """Samples see a surface that reflects; of one that emits, starbursts bring a part."""
    lens, side = perfect_lens(f_number), 256
    shortest = airy_radius_um(f_number) / 1.219670  # period that passes, um
    pixel = shortest / 5
    distance, half = 1e4, 50.0
    light = {"emission": 1.0} if emits else {"diffuse": 1.0}
    scene = scenes.scene_of(scenes.quad((half, 0, -distance), half, 2 * half, **light))  # type: ignore[arg-type]
    scene = scene if emits else scene.with_sun((0, 0, -1), (1, 1, 1))
    edge = picture(scene, lens, rc.Film(side * pixel / 1000, 16 * pixel / 1000, (side, 16)), spp=1024).mean(axis=0)
    line = np.diff(edge)
    line /= edge[-16:].mean() - edge[:16].mean()
    periods = np.arange(1, 9) / 10 / shortest  # per um
    place = np.arange(1, side) * pixel
    contrast = np.abs(np.exp(-2j * np.pi * periods[:, None] * place[None, :]) @ line)
    contrast /= np.sinc(periods * pixel) ** 2  # the pixel, and the difference of two
    # The window of 256 pixels cuts off what an edge spreads further: 1 / (pi^2 25) of the light on each side; noise
    # of 1024 x 16 samples is 0.006 of the contrast.
    hold(Measurement("Effects", "contrast of an edge that " + ("emits" if emits else "reflects"),
                     f"a perfect lens at f/{f_number:g}, 8 frequencies up to 0.8 of the limit", "cpu", "float32",
                     float(np.abs(contrast - perfect_contrast(np.arange(1, 9) / 10)).max()), 0.02, ""))  # fmt: skip


@pytest.mark.parametrize(
    ("model", "others"),
    [
        *((model, ()) for model in ("full", "thin", "mapped", "thick", "pinhole")),
        *(("full", others) for others in (("dispersion",), ("dispersion", "coatings"))),
    ],
)
def test_an_even_field_stays_as_it_is(model: str, others: tuple[str, ...]) -> None:
    """Grey, and as bright as without diffraction."""
    lens = rc.Lens.load("double-gauss-50mm").with_coating("quarter_wave").stopped_down(16)
    film = rc.Film(36, 24, (36, 24))
    camera = rc.Camera(lens, film=film, exposure_time_s=1, model=model)
    with_it, without = (
        rc.render(scenes.sky(), camera, spp=1024, effects={*others, *more}, device="cpu").pixels.astype(float)
        for more in (("diffraction",), ())
    )
    # Noise of 1024 samples with one to three wavelengths each.
    hold(Measurement("Effects", "light of an even sky with diffraction over that without",
                     " and ".join([f"{model} lens", *others]), "cpu", "float32",
                     float(abs(with_it.mean(axis=(0, 1)) / without.mean(axis=(0, 1)) - 1).max()),
                     0.003 if others else 0.002, ""))  # fmt: skip


def test_nothing_is_lost_of_a_lamp_that_rays_meet() -> None:
    """A small lamp has the light it has without diffraction, and the starburst of a point that is as bright."""
    lens, film, distance = perfect_lens(16.0), film_of(20.0, 96), 1e3
    half = 0.5  # 50 um on the film
    lamp = scenes.scene_of(scenes.quad((0, 0, -distance), half, emission=1e6))
    intensity = 1e6 * (2 * half) ** 2
    behind = scenes.scene_of(scenes.quad((0, 0, 1e5), half))
    point = behind.with_point_light((0, 0, -distance), (intensity,) * 3)
    seen, star = (picture(scene, lens, film, spp=spp) for scene, spp in ((lamp, 2048), (point, 1024)))
    # 13000 samples meet the lamp.
    camera = rc.Camera(lens, film=film, exposure_time_s=1)
    without = rc.render(lamp, camera, effects=(), spp=2048, device="cpu").pixels[:, :, 1].astype(float)
    hold(Measurement("Effects", "light of a small lamp with diffraction over that without", "f/16", "cpu", "float32",
                     abs(seen.sum() / without.sum() - 1), 0.02, ""))  # fmt: skip
    r = radii(96, 20.0)
    far = (r > 200) & (r < 900)
    assert star.sum() == pytest.approx(seen.sum(), rel=0.02)
    # The starburst falls as the cube of the distance: that of a lamp of this size is 1% stronger than a point's.
    hold(Measurement("Effects", "starburst of a lamp that rays meet, against a point's", "f/16, 10 to 45 pixels away",
                     "cpu", "float32", abs(seen[far].sum() / star[far].sum() - 1), 0.03, ""))  # fmt: skip
    # For a circular aperture, 2 / (pi^2 f) of the light lies beyond f periods over its width: Airy's far rings.
    periods = np.array([200, 900]) / (LINE_NM / 1000 * 16)
    expected = float(2 / np.pi**2 * (1 / periods[0] - 1 / periods[1]))
    hold(Measurement("Effects", "light of a starburst, against Airy's far rings", "f/16, 10 to 45 pixels away", "cpu",
                     "float32", abs(star[far].sum() / star.sum() / expected - 1), 0.03, ""))  # fmt: skip


@pytest.mark.parametrize("blades", [5, 8, 9])
def test_blades_make_spikes(blades: int) -> None:
    lens = rc.Lens.load("double-gauss-50mm").with_iris(blades=blades, rotation_deg=10).stopped_down(16)
    side = 161
    star = picture(far_lamp(0.0, 0.0), lens, film_of(10.0, side), spp=128)  # 2 million samples in the ring
    place = np.arange(side) - side // 2
    x, y = np.meshgrid(place, -place)
    ring = (np.hypot(x, y) > 30) & (np.hypot(x, y) < 75)
    angle = np.degrees(np.arctan2(y, x))[ring]
    light, _ = np.histogram(angle, bins=180, range=(-180, 180), weights=star[ring])
    spikes = blades if blades % 2 == 0 else 2 * blades
    spectrum = np.abs(np.fft.rfft(light))
    assert np.argmax(spectrum[1:40]) + 1 == spikes
    # Along the blades' normals; the picture is turned by half a turn, which an even number of spikes does not show.
    phase = np.angle(np.fft.rfft(light)[spikes]) / spikes
    first = -180 + 1 - np.degrees(phase)
    assert abs((first - 10 + 180 / spikes) % (360 / spikes) - 180 / spikes) < 1


def test_a_starburst_grows_with_the_wavelength() -> None:
    lens, film = perfect_lens(16.0), film_of(0.6, 128)
    r = radii(128, 0.6)

    def half_light(nm: float) -> float:
        star = picture(far_lamp(0.0, 0.0, distance_m=1e6), lens, film, spp=128, nm=nm)
        order = np.argsort(r.ravel())
        summed = np.cumsum(star.ravel()[order])
        return float(np.interp(0.5 * math.pi * lens.stop_semi_diameter_mm**2 / 0.0006**2, summed, r.ravel()[order]))

    assert half_light(660.0) / half_light(440.0) == pytest.approx(1.5, rel=0.03)


def test_a_lamp_behind_an_object_makes_no_starburst() -> None:
    lens, film = rc.Lens.load("double-gauss-50mm").stopped_down(8).focused(5.0), rc.Film(24, 24, (64, 64))
    black = scenes.scene_of(scenes.quad((0, 0, -5), 1.0))
    hidden = black.with_point_light((0, 0, -10), (1e6,) * 3)
    assert picture(hidden, lens, film, spp=16).max() == 0
    assert picture(black.with_point_light((2.2, 0, -10), (1e6,) * 3), lens, film, spp=16).max() > 0


def test_coatings_with_diffraction_take_as_much_light_as_without() -> None:
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare").stopped_down(11)
    camera = rc.Camera(lens, film=rc.Film(36, 24, (24, 16)), exposure_time_s=1)
    one, both = (
        rc.render(scenes.sky(), camera, spp=1024, effects=effects, illuminant=nm, device="cpu").pixels.mean()
        for effects, nm in (({"coatings"}, None), ({"coatings", "diffraction"}, lens.wavelength_nm))
    )
    assert both == pytest.approx(one, rel=0.002)


def test_a_star_through_a_real_lens_is_nearly_its_exact_psf() -> None:
    """Stopped down to f/22 the double Gauss has a fifth of a wave of aberration: rays and diffraction, each by itself,
    spread a star nearly as its waves do (docs/diffraction.md has how nearly)."""
    lens = rc.Lens.load("double-gauss-50mm").stopped_down(22)
    psf = lens.psf(0, [LINE_NM], object_distance_m=math.inf, pitch_um=2.0, size=128)
    star = picture(far_lamp(0.0, 0.0, distance_m=1e6), lens, film_of(2.0, 128), spp=128)
    r, light = radii(128, 2.0), star / star.sum() * psf.energy
    for radius_um in (8.0, 16.0, 32.0):
        assert light[r < radius_um].sum() == pytest.approx(psf.energy_inside(radius_um), abs=0.04)
