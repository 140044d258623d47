"""Images of lights that samples from the lights find: their energy, their discs, and the same picture as without.

What is right is a closed form, rays in double precision, and samples of pixels alone.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc
from numpy.lib.stride_tricks import sliding_window_view

from ...measurement import Measurement, hold
from .. import scenes

FILM = rc.Film(24, 16, (48, 32))


def camera(lens: rc.Lens | None = None, film: rc.Film = FILM, **more: object) -> rc.Camera:
    lens = lens or rc.Lens.load("double-gauss-50mm").focused(1.0).stopped_down(2.8)
    return rc.Camera(lens, film=film, exposure_time_s=1, **more)


def behind() -> rc.Scene:
    """The one triangle that a scene must have, out of the camera's view."""
    return rc.Scene.from_arrays(np.array([[0.0, 0.0, 1e5], [1.0, 0.0, 1e5], [0.0, 1.0, 1e5]]), [[0, 1, 2]])


def photograph(scene: rc.Scene, at: rc.Camera, tracing: str, device: str, **settings: object) -> np.ndarray:
    """(H, W, 3)."""
    settings = {"effects": (), "spp": 64, "max_bounces": 0} | settings
    image = rc.render(scene, at, light_tracing=tracing, device=device, **settings)  # type: ignore[arg-type]
    return image.pixels.astype(np.float64)


def stop_in_front(radius_mm: float, film_shift_mm: float) -> rc.Lens:
    """A singlet whose stop is its entrance pupil; the film is `film_shift_mm` behind the focus."""
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=radius_mm, thickness_mm=0),
        rc.Surface(radius_of_curvature_mm=120, thickness_mm=4, material=1.6, clear_semi_diameter_mm=15),
        rc.Surface(radius_of_curvature_mm=-120, clear_semi_diameter_mm=15),
    ]
    lens = rc.Lens(surfaces=surfaces, film_distance_mm=40.0)
    focus = lens.first_order().back_focal_distance_mm
    return rc.Lens(surfaces=surfaces, film_distance_mm=focus + film_shift_mm)


def flux(picture: np.ndarray, film: rc.Film) -> float:
    """Lumens on the film."""
    width, height = film.resolution
    return float(picture[..., 1].sum()) * film.width_mm * film.height_mm / (width * height) * 1e-6


def test_all_light_of_a_point_in_the_stop_reaches_the_film(device: str, backend: str) -> None:
    """Closed form: the luminous intensity times the solid angle of the stop, for any position of the point."""
    worst = 0.0
    for distance_m, tangent in ((0.3, 0.0), (2.0, 0.05), (1e3, -0.1)):
        place = (tangent * distance_m, 0.5 * tangent * distance_m, -distance_m)
        lens = stop_in_front(2.0, 5.0)
        film = rc.Film(36, 24, (72, 48))
        scene = behind().with_point_light(place, (1e6 * distance_m**2,) * 3)
        at = camera(lens, film, position=(0, 0, 1e-3 * lens.film_position_mm))
        got = flux(photograph(scene, at, "weighted", device, spp=256), film)
        # The mean over the stop of 1 / r^2 times the cosine: a series in the stop's radius, whose next term is 1e-9.
        r2 = float(np.dot(place, place))
        cosine = distance_m / math.sqrt(r2)
        want = 1e6 * distance_m**2 * cosine / r2 * math.pi * 2e-3**2
        worst = max(worst, abs(got / want - 1))
    # Quasi-random samples of a circle in a square: some 1e5, whose error is about 1e-3.
    hold(Measurement("Effects", "light of a point through a stop in front", "closed form, 0.3 m to 1 km", backend,
                     "float32", worst, 3e-3, "relative"))  # fmt: skip


@pytest.mark.parametrize(
    ("stop_mm", "film_shift_mm", "film"),
    [
        (4.0, 30.0, rc.Film(4, 3, (36, 27))),
        (4.0, 10.0, rc.Film(1.2, 0.9, (36, 27))),
        (8.0, 20.0, rc.Film(4, 3.6, (40, 36))),
    ],
)
@pytest.mark.parametrize("distance_m", [2.0, 1e3])
def test_no_light_is_lost_on_the_axis_of_a_narrow_field(
    stop_mm: float, film_shift_mm: float, film: rc.Film, distance_m: float, device: str
) -> None:
    """The rays of each film point differ more in direction than those to different film points."""
    lens = stop_in_front(stop_mm, film_shift_mm)
    scene = behind().with_point_light((0, 0, -distance_m), (1e6 * distance_m**2,) * 3)
    at = camera(lens, film, position=(0, 0, 1e-3 * lens.film_position_mm))
    got = flux(photograph(scene, at, "weighted", device), film)
    # The mean of the cosine over r^2, times the stop's area: 2 pi d (1 / d - 1 / sqrt(d^2 + stop^2)) / 2, whose next
    # term is 1e-5 of it. 1e5 quasi-random samples of a circle in a square err by some 1e-3.
    want = 1e6 * math.pi * (1e-3 * stop_mm) ** 2 / (1 + (1e-3 * stop_mm / distance_m) ** 2)
    assert got == pytest.approx(want, rel=3e-3)


@pytest.mark.parametrize("lens_name", ["sonnar-180mm", "telephoto-250mm", "macro-105mm"])
def test_points_beside_the_field_of_a_wide_front_are_seen(lens_name: str, device: str) -> None:
    """Near the lens, where only the nearer side of its front sees them in the field. As a small lamp is seen there."""
    lens, film = rc.Lens.load(lens_name).focused(5.0), rc.Film(12, 8, (24, 16))
    place = (0.02, 0.0, -1e-3 * lens.film_position_mm - (0.15 if lens_name == "macro-105mm" else 0.6))
    at = camera(lens, film, position=(0, 0, 0))
    lamp = lamps(place, radius=0.002, radiance=1e6)
    point = behind().with_point_light(place, (1e6 * 0.004**2,) * 3)
    by_pixels = [float(photograph(lamp, at, "off", device, spp=512, seed=seed).mean()) for seed in range(8)]
    want, error = float(np.mean(by_pixels)), float(np.std(by_pixels, ddof=1)) / math.sqrt(8)
    assert error < 0.03 * want
    got = float(photograph(point, at, "weighted", device, spp=256).mean())
    # The lamp shines with the cosine of up to 8 degrees less than the point.
    assert abs(got - want) < 5 * error + 0.01 * want


def test_a_point_out_of_focus_is_an_even_disc(device: str, backend: str) -> None:
    """A slow lens has no aberrations to speak of: the flux over the area of the stop's shadow."""
    lens, film = stop_in_front(1.0, 20.0), rc.Film(1.2, 0.8, (36, 24))
    scene = behind().with_point_light((0, 0, -1e3), (1e12,) * 3)
    at = camera(lens, film, position=(0, 0, 1e-3 * lens.film_position_mm))
    picture = photograph(scene, at, "weighted", device, spp=4096)[..., 1]
    columns, rows = np.meshgrid(np.arange(36) + 0.5 - 18, np.arange(24) + 0.5 - 12)
    radius_mm = 20.0 / lens.first_order().effective_focal_length_mm
    inside = np.hypot(columns, rows) * (1.2 / 36) < radius_mm - 0.05
    want = 1e12 / 1e6 * math.pi * 1e-6 / (math.pi * (radius_mm * 1e-3) ** 2)
    hold(Measurement("Effects", "disc of a point out of focus", "a stop of 1 mm, 20 mm beside the focus", backend,
                     "float32", float(np.abs(picture[inside] / want - 1).max()), 5e-3, "relative"))  # fmt: skip


def lamps(*places: tuple[float, float, float], radius: float = 0.004, radiance: float = 1e5) -> rc.Scene:
    """Squares that face the camera at the origin, which looks to -z."""
    return scenes.scene_of(*(scenes.quad(place, radius, emission=radiance) for place in places))


def occluded() -> rc.Scene:
    return scenes.scene_of(
        scenes.quad((0, 0, -4), 0.006, emission=1e5),
        scenes.quad((0.0155, 0, -2), 0.01),
    )


def veiled() -> rc.Scene:
    veil = rc.Material(diffuse=(0, 0, 0), opacity=0.4)
    corners, _ = scenes.quad((0, 0, -2), 0.2)
    return scenes.scene_of(scenes.quad((0, 0, -4), 0.006, emission=1e5), (corners, veil))


def behind_glass() -> rc.Scene:
    """Rays to a lamp behind a pane are not straight: only samples of pixels find it."""
    glass = rc.Material(diffuse=(0, 0, 0), transmission=1, ior=1.5)
    front, back = (scenes.quad((0, 0, z), 0.3, right=(side, 0, 0))[0] for z, side in ((-2, 1), (-2.01, -1)))
    return scenes.scene_of(scenes.quad((0, 0, -4), 0.02, emission=1e4), (front, glass), (back, glass))


def moving() -> rc.Scene:
    """A lamp that crosses a part of the picture while the shutter is open."""
    begin, end = np.eye(4), np.eye(4)
    end[:3, 3] = (0.4, 0.1, 0)
    return behind().with_instance(lamps((0, 0, -4)), begin, name="lamp").moved("lamp", [begin, end], times_s=[0, 1])


def before_a_dim_wall() -> rc.Scene:
    """A lamp 2 cm before a wall that shines everywhere, 100 times darker."""
    return scenes.scene_of(
        scenes.quad((0.05, 0, -1), 0.002, emission=1e5), scenes.quad((0, 0, -1.02), 2.0, emission=1e3)
    )


def led_in_a_dim_panel() -> rc.Scene:
    """A small lamp in the plane of the panel, in a hole of it."""
    left, right = ((x, 0, -1) for x in (-0.952, 1.052))
    above, below = ((0.05, y, -1) for y in (1.002, -1.002))
    return scenes.scene_of(
        scenes.quad((0.05, 0, -1), 0.002, emission=1e5),
        *(scenes.quad(place, 1.0, emission=1e3) for place in (left, right)),
        *(scenes.quad(place, 0.002, 1.0, emission=1e3) for place in (above, below)),
    )


def fine_mesh() -> rc.Scene:
    """A part of a ball that shines, 0.2 m in radius, of triangles smaller than pixels, up to 70 degrees from its
    middle."""
    angles = np.radians(np.linspace(-70, 70, 300))
    across, up = np.meshgrid(angles, angles)
    ball = 0.2 * np.stack([np.sin(across), np.sin(up) * np.cos(across), np.cos(up) * np.cos(across)], axis=-1)
    corners = ball - np.array([0, 0, 1.2])
    first = np.stack([corners[:-1, :-1], corners[:-1, 1:], corners[1:, 1:]], axis=-2)
    second = np.stack([corners[:-1, :-1], corners[1:, 1:], corners[1:, :-1]], axis=-2)
    triangles = np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])
    faces = np.arange(len(triangles)).reshape(-1, 3)
    return rc.Scene.from_arrays(triangles, faces, materials=[rc.Material(emission=(1e3,) * 3)])


CASES: dict[str, tuple[Callable[[], rc.Scene], dict[str, object], dict[str, object]]] = {
    "on the axis": (lambda: lamps((0, 0, -4)), {}, {}),
    "at the frame's edge": (lambda: lamps((0.88, 0.58, -4), (-0.89, 0, -4)), {}, {}),
    "in the near field": (lambda: lamps((0.01, 0.005, -0.3), radius=0.0006), {}, {}),
    "in focus": (lambda: lamps((0.05, 0, -1), radius=0.002), {}, {}),
    "in focus, larger than pixels": (lambda: lamps((0.05, 0, -1), radius=0.03), {}, {}),
    "a thin tube in focus": (
        lambda: scenes.scene_of(
            scenes.quad((0.05, 0, -1), 0.2, 0.0005, emission=1e5, right=(0.8, 0.6, 0), up=(-0.6, 0.8, 0))
        ),
        {},
        {},
    ),
    "before a dim wall": (before_a_dim_wall, {}, {}),
    "in a dim panel": (led_in_a_dim_panel, {}, {}),
    "a large one": (lambda: lamps((0.05, 0, -4), radius=0.3), {}, {}),
    "1e8 brighter": (lambda: lamps((0, 0, -4), radiance=1e13), {}, {}),
    "a hundred": (
        lambda: lamps(*((0.1 * x, 0.1 * y, -4 - 0.1 * x) for x in range(-5, 5) for y in range(-5, 5))),
        {},
        {},
    ),
    "behind an edge": (occluded, {}, {}),
    "behind a veil": (veiled, {}, {}),
    "behind glass": (behind_glass, {}, {"max_bounces": 3}),
    "moving": (moving, {}, {}),
    "from a moving camera": (
        lambda: lamps((0.3, 0, -4)),
        {
            "position": (0, 0, 0),
            "motion": [(0, (0, 0, 0), (0, 0, -1)), (1, (0.2, 0, 0), (0.1, 0, -1))],
            "readout_time_s": 0.5,
        },
        {},
    ),
    "dispersion": (lambda: lamps((0.4, 0.2, -4)), {}, {"effects": ("dispersion",)}),
    "diffraction": (lambda: lamps((0.4, 0.2, -4)), {}, {"effects": ("diffraction",)}),
    "all effects": (lambda: lamps((0.4, 0.2, -4)), {}, {"effects": ("dispersion", "coatings", "diffraction")}),
}


# Left to samples of pixels, or found by these alone.
NOT_FROM_LIGHTS = ("in focus, larger than pixels", "a large one", "behind glass")


@pytest.mark.parametrize("case", CASES)
def test_all_techniques_see_the_same(case: str, device: str) -> None:
    make, more, settings = CASES[case]
    at, scene = camera(**({"position": (0, 0, 0)} | more)), make()
    seeds = range(8)

    def blocks(tracing: str, spp: int) -> np.ndarray:
        """(seeds, 6 x 4 x 3): means over blocks of the film."""
        pictures = [photograph(scene, at, tracing, device, seed=seed, spp=spp, **settings) for seed in seeds]
        return np.stack([p.reshape(4, 8, 6, 8, 3).mean(axis=(1, 3)).ravel() for p in pictures])

    by_pixels = photograph(scene, at, "off", device, spp=64, **settings)
    is_traced = not np.array_equal(photograph(scene, at, "weighted", device, spp=64, **settings), by_pixels)
    assert is_traced == (case not in NOT_FROM_LIGHTS)
    alone = blocks("off", 256)
    assert alone.mean() > 0
    for tracing in ("weighted", "alone"):
        other = blocks(tracing, 64)
        error = np.sqrt((alone.var(axis=0) + other.var(axis=0)) / (len(seeds) - 1))
        lit = alone.mean(axis=0) > 1e-6 * alone.mean()
        difference = np.abs(alone.mean(axis=0) - other.mean(axis=0))
        # A lamp that pixel samples hit seven times on average is missed once in a thousand tests. The light of one hit
        # follows from Poisson statistics: the variance over the mean.
        met_once = float((alone.var(axis=0)[lit] / alone.mean(axis=0)[lit]).max()) / len(seeds)
        missed = np.where(alone.mean(axis=0) < 7 * met_once, 7 * met_once, 0)
        # Student's t with some seven degrees of freedom, in 72 blocks: above 7 once in a thousand tests. The last term
        # covers float32 and the unit of the sums.
        assert (difference <= 7 * error + missed + 1e-5 * alone.mean(axis=0).max()).all(), (
            case,
            tracing,
            difference[lit] / error[lit],
        )


@pytest.mark.parametrize(
    ("case", "share"),
    # Out of focus each film sample meets the lamp one time in some hundred, while each sample from the lamp counts.
    [
        ("on the axis", 0.05),
        ("a hundred", 0.1),
        ("behind an edge", 0.1),
        # A sixth of the samples of the lamp's pixel hit it.
        ("in focus", 0.1),
        ("a thin tube in focus", 0.1),
        # The wall's own noise is left.
        ("before a dim wall", 0.1),
        ("in a dim panel", 0.1),
        ("in focus, larger than pixels", 1.05),
        ("a large one", 1.05),
    ],
)
def test_noise_falls_where_lamps_are_out_of_focus_and_nowhere_rises(case: str, share: float, device: str) -> None:
    scene, at = CASES[case][0](), camera(position=(0, 0, 0))

    def variance(tracing: str) -> float:
        return float(np.var([photograph(scene, at, tracing, device, spp=16, seed=s) for s in range(24)], axis=0).sum())

    assert variance("weighted") <= share * variance("off")


def test_a_fine_mesh_in_focus_is_left_to_samples_of_pixels(device: str) -> None:
    """The mesh's triangles are smaller than pixels but adjacent. Light is traced only near the mesh's outer edges."""
    at = camera(position=(0, 0, 0))
    by_pixels, both = (photograph(fine_mesh(), at, tracing, device, spp=4) for tracing in ("off", "weighted"))
    lit = by_pixels.min(axis=2) > 0
    inside = np.zeros_like(lit)
    inside[3:-3, 3:-3] = sliding_window_view(lit, (7, 7)).all(axis=(2, 3))
    assert inside.sum() > 0.5 * lit.sum()
    np.testing.assert_array_equal(both[inside], by_pixels[inside])


PIXEL_MM = 0.1


def grid_of_lamps(lens: rc.Lens, share: float) -> rc.Scene:
    """Square lamps at 5 m, which fill a share of a pixel, one in each block of 6 x 6 pixels of a film of 72 x 48."""
    step = 5.0 * PIXEL_MM / lens.first_order().effective_focal_length_mm  # of one pixel there, but for 0.2%
    return lamps(
        *(
            (step * (6 * x + 3.1 + 0.2 * y - 36), step * (6 * y + 2.9 + 0.1 * x - 24), -5.0)
            for x in range(12)
            for y in range(8)
        ),
        radius=0.5 * step * math.sqrt(share),
    )


@pytest.mark.parametrize("share", [0.006, 1e-4, 0.3])
def test_no_lamp_in_focus_is_missed(share: float, device: str) -> None:
    """96 lamps in each picture, each smaller than a pixel. Samples from the pixels may miss any or all of them."""
    lens = rc.Lens.load("machine-vision-10mm").focused(5.0)
    at = camera(lens, rc.Film(7.2, 4.8, (72, 48)), position=(0, 0, 0))
    scene = grid_of_lamps(lens, share)
    pictures = [photograph(scene, at, "weighted", device, seed=seed)[..., 1] for seed in range(11)]
    light = np.stack([p.reshape(8, 6, 12, 6).sum(axis=(1, 3)) for p in pictures])
    mean = light.mean(axis=0)
    assert light.min() > 0.5 * mean.min()
    # 11 seeds know the deviation of one lamp within a fifth, and that of all within 3%.
    assert np.sqrt((light.var(axis=0, ddof=1) / mean**2).mean()) < 0.1
    # On the axis, a lamp of radiance L and area A brings the light of a point of intensity L A; there, a lens that is
    # free of vignetting has the same illuminance for all lamps, but for the fourth power of the cosine.
    assert mean.min() > 0.5 * mean.max()


@pytest.mark.parametrize("half_width_m", [2e-4, 2e-3])
def test_a_lamp_in_focus_has_all_its_light(half_width_m: float, device: str) -> None:
    """Closed form: radiance times the lamp's area and the solid angle of the stop."""
    bare = stop_in_front(2.0, 0.0)
    lens = rc.Lens(surfaces=bare.surfaces, film_distance_mm=bare.film_distance_mm).focused(5.0)
    film = rc.Film(3.6, 2.4, (36, 24))
    at = camera(lens, film, position=(0, 0, 1e-3 * lens.film_position_mm))
    scene = lamps((0.0013, 0.0021, -5.0), radius=half_width_m)
    got = [flux(photograph(scene, at, "weighted", device, seed=seed), film) for seed in range(4)]
    want = 1e5 * (2 * half_width_m) ** 2 * math.pi * 2e-3**2 / 5.0**2
    assert np.mean(got) == pytest.approx(want, rel=0.01)
    assert np.std(got) < 0.1 * want


def test_a_stop_ends_the_samples_of_lamps_too(device: str) -> None:
    """Passing over those that a picture of 2^24 samples has left takes most of a minute."""
    wide = camera(film=rc.Film(24, 16, (1920, 1280)), position=(0, 0, 0))
    session = rc.Session(CASES["a hundred"][0](), wide, device=device, max_bounces=0, effects=())
    stop = threading.Timer(0.5, session.cancel)
    stop.start()
    begin = time.monotonic()
    with pytest.raises(rc.Cancelled):
        session.add(1 << 24)
    assert time.monotonic() - begin < 15
    stop.join()
