"""Bundled lenses that are not of revolution, or whose film is curved, against what is published of them."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import realcam as rc

from ...centred_lenses import CENTRED
from ..programs import Command
from ..scenes import quad, scene_of

UNUSUAL = sorted(set(rc.lens_names()) - set(CENTRED))


@pytest.mark.parametrize("name", UNUSUAL)
def test_they_photograph(name: str) -> None:
    """At least 95% of the samples pass, and the picture has the light of the pupil."""
    made = rc.Lens.load(name)
    rays = rc.Camera(made, film=rc.Film(*(0.7 * side for side in made.film_mm), (24, 16))).generate_rays(spp=64)
    weights = np.asarray(rays.weights, float)
    assert (weights > 0).mean() > 0.95
    middle = weights.reshape(16, 24, -1)[7:9, 11:13].mean()
    # The film's middle is lit as its pupil says; 64 samples of four pixels leave some 1% of noise.
    assert middle == pytest.approx(made.film_pupil().irradiance, rel=0.04)


@pytest.mark.parametrize(
    ("name", "across_mm", "upright_mm"),
    # For the front anamorphic the source states 31.5 mm; both lenses have a squeeze of 2, within their three digits.
    [("anamorphic-31mm", 31.5, 63), ("anamorphic-65mm", 65, 130)],
)
def test_squeeze_of_anamorphic_lenses(name: str, across_mm: float, upright_mm: float) -> None:
    across, upright = rc.Lens.load(name).meridians()
    assert across.focal_length_mm == pytest.approx(across_mm, rel=0.02)
    assert upright.focal_length_mm == pytest.approx(upright_mm, rel=0.06)
    assert upright.f_number == pytest.approx(across.f_number * (2 if name == "anamorphic-65mm" else 1), rel=0.02)


def test_an_adapter_keeps_one_focal_length_of_its_lens() -> None:
    across, upright = rc.Lens.load("scope-adapter-50mm").meridians()
    alone = rc.Lens.load("tessar-50mm").first_order().effective_focal_length_mm
    assert across.focal_length_mm == pytest.approx(alone, rel=1e-9)
    # An afocal pair enlarges by f1 / f2 of its cylinders, thick lenses by hand. This one is not quite afocal: it moves
    # the focus by 0.7 mm, 1.7% of the distance of the film.
    front, back = (
        1 / ((n - 1) * (1 / a - 1 / b + (n - 1) * t / (n * a * b)))
        for a, b, n, t in ((128.3, 7592.181, 1.74795, 30.87), (-394.954, 148.466, 1.83932, 6.81))
    )
    assert upright.focal_length_mm / across.focal_length_mm == pytest.approx(-front / back, rel=0.03)


def chief_ray_scale(lens: rc.Lens, axis: int) -> float:
    """Height on the film of the paraxial chief ray of slope 1, by hand, in one section."""
    height, slope, n = np.array([1.0, 0.0]), np.array([0.0, 1.0]), 1.0  # of two rays: along the axis, and inclined
    at_stop = None
    for k, surface in enumerate(lens.surfaces):
        if surface.type == "stop":
            at_stop = height.copy()
        else:
            radius = surface.radius_of_curvature_mm
            if surface.form == "toroid" and axis == 0:
                radius = surface.radius_of_curvature_x_mm
            behind = surface.material.index(lens.wavelength_nm)
            slope = (n * slope - height / radius * (behind - n)) / behind
            n = behind
        last = k + 1 == len(lens.surfaces)
        height = height + slope * (lens.film_distance_mm if last else surface.thickness_mm)
    assert at_stop is not None
    return float(height[1] - height[0] * at_stop[1] / at_stop[0])


def test_pictures_are_squeezed_as_first_order_says() -> None:
    """Two pairs of lamps, a degree from the axis to either side, across and upright: the distances of their images are
    those of paraxial chief rays, which on a film beside the focus are not quite the focal lengths times the tangents.
    The two entrance pupils lie some 5 cm apart, which is 0.05% of the lamps' distance."""
    made = rc.Lens.load("anamorphic-31mm").stopped_down(16).focused(100.0)
    lamps = [
        quad((100 * x, 100 * y, -100.0), 0.01, emission=1e6)
        for t in (math.tan(math.radians(1)),)
        for x, y in ((t, 0), (-t, 0), (0, t), (0, -t))
    ]
    film = rc.Film(3.0, 3.0, (300, 300))
    picture = rc.render(
        scene_of(*lamps), rc.Camera(made, film=film, look_at=(0, 0, -1)), effects=(), spp=64, device="cpu"
    )
    light = picture.pixels.sum(axis=2)
    at = (np.arange(300) + 0.5) / 100 - 1.5
    x, y = np.meshgrid(at, at)

    def centre(part: np.ndarray) -> np.ndarray:
        return np.array([(light * part * axis).sum() / (light * part).sum() for axis in (x, y)])

    apart_x = centre(x > abs(y))[0] - centre(-x > abs(y))[0]
    apart_y = centre(y > abs(x))[1] - centre(-y > abs(x))[1]
    assert apart_y / apart_x == pytest.approx(chief_ray_scale(made, 1) / chief_ray_scale(made, 0), rel=1e-3)


def sine_of_the_cone(lens: rc.Lens, axis: int) -> float:
    """Sine of the angle of the widest ray in one section that passes from the film centre to the scene, by search."""
    sines = np.linspace(0, 0.4, 8001)
    ways = np.zeros((len(sines), 3))
    ways[:, axis], ways[:, 2] = sines, -np.sqrt(1 - sines**2)
    passes = lens.trace(np.tile(lens.film_frame[3], (len(sines), 1)), ways).status == 0
    return float(sines[passes].max())


@pytest.mark.parametrize("name", ["anamorphic-31mm", "anamorphic-65mm", "scope-adapter-50mm"])
def test_the_exposure_is_that_of_an_elliptical_cone(name: str) -> None:
    """E = pi L sin a sin b under a sky of radiance L = 1. Stopped down, where the pupil is an ellipse to 0.1%."""
    made = rc.Lens.load(name).stopped_down(11)
    elliptical = math.pi * sine_of_the_cone(made, 0) * sine_of_the_cone(made, 1)
    rays = rc.Camera(made, film=rc.Film(0.2, 0.2, (16, 16))).generate_rays(spp=256)
    assert np.mean(rays.weights) == pytest.approx(elliptical, rel=5e-3)


def test_a_point_out_of_focus_is_the_pupils_ellipse() -> None:
    """A cylinder behind a stop of 4 mm, and a distant lamp: a ray at x in the stop meets the film, d behind the curved
    face, at x (1 - d / f), and in the other section at y. An evenly lit ellipse has a mean square of a quarter of its
    semi-axis'. Spherical aberration changes f by 0.1% (1.17 h^2 / 2f), and the noise of some 5e4 samples 0.2%."""
    d, thickness, n = 60.0, 1.0, 1.5
    made = rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=4, thickness_mm=1e-6),
            rc.Surface(
                form="toroid",
                radius_of_curvature_x_mm=50,
                thickness_mm=thickness,
                material=n,
                clear_semi_diameter_mm=6,
            ),
            rc.Surface(clear_semi_diameter_mm=6),
        ],
        film_distance_mm=d - thickness / n,
    )
    film = rc.Film(12, 12, (120, 120))
    lamp = quad((0, 0, -1000.0), 4.0, emission=1e6)
    picture = rc.render(
        scene_of(lamp), rc.Camera(made, film=film, look_at=(0, 0, -1)), effects=(), spp=1024, device="cpu"
    )
    light = picture.pixels.sum(axis=2)
    at = (np.arange(120) + 0.5) / 10 - 6
    x2, y2 = ((light * axis**2).sum() / light.sum() for axis in np.meshgrid(at, at))
    # The lamp, 8 mrad wide, and the pixels widen it: their squares over 12 are added.
    blur = ((8e-3 * d) ** 2 + 0.1**2) / 12
    assert math.sqrt(4 * (y2 - blur)) == pytest.approx(4.0, rel=0.01)
    assert math.sqrt(4 * (x2 - blur)) == pytest.approx(4.0 * abs(1 - d / 100), rel=0.01)


def test_lens_info_lists_forms_placements_and_both_focal_lengths(command: Command) -> None:
    def told(name: str) -> str:
        return command("lens", "info", name).stdout

    anamorphic = told("anamorphic-65mm")
    assert "toroid, radius -99.5 mm in xz" in anamorphic
    assert re.search(r"at 0 degrees from x +65\.14", anamorphic) and re.search(r"at 90 degrees .* 130\.7", anamorphic)
    assert "moved by (0, -20, 0) mm tilted by (6, 0, 0) degrees" in told("view-camera-210mm")
    assert re.search(r"film +radius -12 mm", told("eye-22mm"))


def test_the_eye() -> None:
    """Escudero-Sanz and Navarro (1999): 60.4 dioptres; an arc of a degree is 0.29 mm on the retina."""
    eye = rc.Lens.load("eye-22mm")
    data = eye.first_order(589.3)
    assert 1000 / data.effective_focal_length_mm == pytest.approx(60.4, abs=0.1)
    height = eye.spot(film_mm=(0, 0.2885)).chief_ray_mm[1]
    angle = eye.aim([[0.0, 0.0]], film_mm=(0, height)).directions[0]
    assert math.degrees(math.atan2(abs(angle[1]), angle[2])) == pytest.approx(1.0, abs=0.02)


def test_a_schmidt_camera_is_as_sharp_at_the_edge_as_in_the_middle() -> None:
    """Born and Wolf, section 6.4: the stop is in the centre of the mirror, so that all directions are alike but for the
    plate's obliquity, if the film is curved about the same centre."""
    camera = rc.Lens.load("schmidt-225mm")
    middle, corner = (camera.spot(film_mm=at).rms_radius_mm for at in ((0.0, 0.0), (18.0, 12.0)))
    assert middle < 1e-3
    assert corner < 5e-3
    assert camera.with_film_radius(math.inf).spot(film_mm=(18.0, 12.0)).rms_radius_mm > 0.2


def test_rays_land_on_the_curved_film() -> None:
    """For rays from one object point: the point where each ray, as a straight line, intersects the film's sphere."""
    camera = rc.Lens.load("schmidt-225mm")
    rng = np.random.default_rng(1)
    pupil = rng.uniform(-0.7, 0.7, (50, 2))
    spot = camera.spot(film_mm=(18.0, 12.0), pupil=pupil)
    aimed = camera.aim(pupil, film_mm=(18.0, 12.0))
    out = camera.trace(aimed.origins_mm, aimed.directions, start="scene")
    ok = out.status == 0
    assert ok.sum() > 30
    x, y, z, middle = camera.film_frame
    at, direction = (v[ok] @ np.array([x, y, z]).T for v in (out.origins_mm - middle, out.directions))
    centre = np.array([0, 0, camera.film_radius_of_curvature_mm])
    along = ((centre - at) * direction).sum(1)
    off = ((centre - at) ** 2).sum(1) - along**2
    lands = at + (along - np.sqrt(camera.film_radius_of_curvature_mm**2 - off))[:, None] * direction
    np.testing.assert_allclose(spot.points_mm[ok], lands[:, :2], atol=1e-9)


def test_a_wavefront_has_its_sphere_on_the_curved_film() -> None:
    """Spherical aberration alone is left, which grows little to the corner: the defocus of a flat film would be
    sag / (8 N^2) = 59 waves there."""
    camera = rc.Lens.load("schmidt-225mm")
    assert camera.wavefront(film_mm=(0.0, 0.0)).rms_waves < 0.3
    assert camera.wavefront(film_mm=(18.0, 12.0)).rms_waves < 1


def test_an_off_axis_paraboloid_is_stigmatic() -> None:
    mirror = rc.Lens.load("off-axis-500mm")
    assert mirror.spot(0.0).rms_radius_mm < 1e-12
    # From the focus to the mirror at 80 mm from its axis: 500 + 80^2 / (4 500).
    assert mirror.first_order().effective_focal_length_mm == pytest.approx(503.2, rel=1e-9)


def test_a_periscope_sees_past_what_stands_before_its_lens() -> None:
    made = rc.Lens.load("periscope-50mm")
    # 30 mm of offset between the light that enters and the film.
    assert made.film_frame[3] == pytest.approx([0, 30, made.film_frame[3][2]])
    aimed = made.aim([[0.0, 0.0]])
    assert aimed.origins_mm[0] == pytest.approx([0, 0, 0], abs=1e-9)
    assert made.first_order().effective_focal_length_mm == pytest.approx(
        rc.Lens.load("tessar-50mm").first_order().effective_focal_length_mm, rel=1e-9
    )


def test_a_lens_of_one_mirror_is_made_with_its_film_before_it() -> None:
    stop = rc.Stop(clear_semi_diameter_mm=20, thickness_mm=400)
    mirror = rc.Surface(radius_of_curvature_mm=-400, type="mirror", clear_semi_diameter_mm=30, conic=-1)
    lens = rc.Lens(surfaces=[stop, mirror], film_distance_mm=-200)
    assert lens.film_distance_mm == -200
    # The focus of a parabola is half its radius from the vertex.
    assert lens.first_order().effective_focal_length_mm == pytest.approx(200)
