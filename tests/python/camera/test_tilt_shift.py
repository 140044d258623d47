"""Lenses that are tilted and shifted before the film, and films that are curved: where their rays go, and pictures.

Truth: rotations and shifts of rays by hand; Gaussian optics of the lens on its axis; the exposure integral."""

import numpy as np
import pytest
import realcam as rc
from realcam import Camera, Film, Lens

from ..scenes import sky

FILM = Film(36, 24, (36, 24))


def turn_about_x(degrees):
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def film_rays(lens, count=200):
    """Rays from the film's plane to the last surface's rim: origins and directions in the lens frame."""
    rng = np.random.default_rng(3)
    film = np.column_stack(
        [rng.uniform(-15, 15, count), rng.uniform(-10, 10, count), np.full(count, lens.film_position_mm)]
    )
    rim = lens.surfaces[-1].clear_semi_diameter_mm
    to = np.column_stack([rng.uniform(-rim, rim, (count, 2)), np.full(count, lens.vertices_mm[-1])])
    return film, to - film


def through(lens, origins, directions):
    traced = lens.trace(origins, directions)
    assert (traced.status == 0).sum() > 50
    return traced


@pytest.mark.parametrize(("x", "y"), [(0.0, 8.0), (-5.0, 3.0)])
def test_a_shifted_lens_does_what_the_lens_does_with_shifted_rays(x, y):
    lens = Lens.load("double-gauss-50mm")
    by = np.array([x, y, 0])
    origins, directions = film_rays(lens)
    truth, traced = through(lens, origins, directions), through(lens.shifted(x, y), origins + by, directions)
    assert np.array_equal(truth.status, traced.status)
    ok = truth.status == 0
    # Lengths of 60 mm: a few roundings of 1e-14 mm each, which six elements multiply.
    assert np.abs(traced.origins_mm[ok] - by - truth.origins_mm[ok])[:, :2].max() < 1e-11
    assert np.abs(traced.directions[ok] - truth.directions[ok]).max() < 1e-12


@pytest.mark.parametrize("pivot", [0.0, 40.0])
def test_a_tilted_lens_does_what_the_lens_does_with_turned_rays(pivot):
    lens = Lens.load("double-gauss-50mm")
    turn, about = turn_about_x(5), np.array([0, 0, lens.film_position_mm - pivot])
    origins, directions = film_rays(lens)
    truth = through(lens, origins, directions)
    traced = through(lens.tilted(x_deg=5, pivot_mm=pivot), (origins - about) @ turn.T + about, directions @ turn.T)
    ok = truth.status == 0
    assert np.array_equal(ok, traced.status == 0)
    assert np.abs(traced.directions[ok] - truth.directions[ok] @ turn.T).max() < 1e-12
    # Both points lie on the same line: the vector between them is parallel to the direction.
    apart = traced.origins_mm[ok] - ((truth.origins_mm[ok] - about) @ turn.T + about)
    assert np.abs(np.cross(apart, traced.directions[ok])).max() < 1e-10


def test_the_film_stays_where_it_is():
    lens = Lens.load("double-gauss-50mm")
    shot = Camera(lens.tilted(3, -2).shifted(4, 1), film=FILM)
    rays = shot.generate_rays(spp=1)
    straight = Camera(lens, film=FILM).generate_rays(spp=1)
    # The camera's pose is that of its film: the middle of the picture looks a few degrees aside, and no more.
    middle = (straight.directions * straight.weights[:, None]).sum(0)
    aside = (rays.directions * rays.weights[:, None]).sum(0)
    cosine = middle @ aside / np.linalg.norm(middle) / np.linalg.norm(aside)
    assert 1 < np.rad2deg(np.arccos(cosine)) < 12


def sharp_point(origins, directions):
    """The point nearest to all of these lines, by least squares."""
    project = np.eye(3) - directions[:, :, None] * directions[:, None, :]
    return np.linalg.solve(project.sum(0), (project @ origins[:, :, None]).sum(0)[:, 0])


def test_the_hinge_of_the_view_camera():
    """H. M. Merklinger, 1993: wherever such a camera is focused, its plane in focus meets the front focal plane at
    f / tan(tilt) below the axis. Narrow bundles close to the axis show it, where the lens's curved field is flat."""
    lens = Lens.load("view-camera-210mm").focused(4.0)
    data, frame = lens.first_order(), lens.film_frame
    ring = 5 * np.array([[np.cos(a), np.sin(a), 0] for a in np.linspace(0, 6, 40)]) + [0, 0, lens.vertices_mm[-1]]
    points = []
    for height in (16.0, 20.0, 24.0):  # the film's middle is 20 mm below the axis
        film = frame[3] + height * frame[1]
        rays = lens.trace(np.tile(film, (40, 1)), ring - film)
        points.append(sharp_point(rays.origins_mm, rays.directions))
    _, y, z = np.transpose(points)
    hinge = np.polyval(np.polyfit(z, y, 1), data.front_focal_distance_mm)
    assert hinge == pytest.approx(-data.effective_focal_length_mm / np.tan(np.deg2rad(6)), rel=2e-3)


def passing_area(lens, film, turn, count=700):
    """Integral of the direction cosines on the film over the rays that pass, from a fine grid of them."""
    edge = (np.arange(count) + 0.5) / count * 2 - 1
    x, y = (a.ravel() for a in np.meshgrid(edge, edge))
    inside = x**2 + y**2 < 1
    local = np.column_stack([x, y, -np.sqrt(np.maximum(0, 1 - x**2 - y**2))])[inside]
    rays = lens.trace(np.tile(film, (len(local), 1)), local @ turn.T, dtype="float32")
    return (rays.status == 0).sum() * (2 / count) ** 2


@pytest.mark.parametrize("height", [-9.0, 0.0, 7.0])
def test_the_irradiance_of_a_tilted_lens_is_the_integral_over_its_pupil(height):
    lens = Lens.load("double-gauss-50mm").tilted(x_deg=8, y_deg=-3).shifted(y_mm=4)
    film = Film(1e-3, 1e-3, (1, 1), shift_mm=(5, height))
    rays = Camera(lens, film=film).generate_rays(spp=1 << 16)
    at = np.array([-5, -height, lens.film_position_mm])  # the film's axes point against the picture's
    # A grid of 700 x 700 rays, in which rays at the rim of a region 0.4 wide are counted or not: 0.2%. The noise of the
    # samples, about 5% blocked, is as large.
    assert rays.weights.mean() == pytest.approx(passing_area(lens, at, np.eye(3)), rel=5e-3)


@pytest.mark.parametrize("radius", [-40.0, -22.0, 30.0])
def test_the_irradiance_of_a_curved_film_is_that_of_its_tangent_plane(radius):
    lens = Lens.load("double-gauss-50mm").with_film_radius(radius)
    for x, y in ((0.0, 0.0), (10.0, 0.0), (-6.0, 12.0)):
        film = Film(1e-3, 1e-3, (1, 1), shift_mm=(-x, -y))
        rays = Camera(lens, film=film).generate_rays(spp=1 << 16)
        r2 = x * x + y * y
        sag = radius - np.sign(radius) * np.sqrt(radius**2 - r2)
        normal = np.array([-x, -y, radius - sag]) / radius
        # The shortest turn from z to the normal (Rodrigues).
        axis = np.cross([0, 0, 1], normal)
        cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        turn = np.eye(3) + cross + cross @ cross / (1 + normal[2])
        at = np.array([x, y, lens.film_position_mm + sag])
        assert rays.weights.mean() == pytest.approx(passing_area(lens, at, turn), rel=5e-3)


def test_a_lens_and_its_film_are_written_and_read_back(tmp_path):
    lens = Lens.load("double-gauss-50mm").tilted(3, 1, pivot_mm=20).shifted(1, 2).with_film_radius(-90)
    lens.save(tmp_path / "tilted.toml")
    assert Lens.load(tmp_path / "tilted.toml") == lens


def test_what_cannot_be_is_refused():
    lens = Lens.load("double-gauss-50mm")
    with pytest.raises(rc.LensFileError, match=r"too short: the film reaches out to 21\.6"):
        lens.with_film_radius(-21)
    for moved, why in ((lens.tilted(2), "surface 1 is tilted"), (lens.with_film_radius(-50), "its film is curved")):
        for model, effects, what in (("polynomial", (), "model polynomial"), ("full", "diffraction", "diffraction")):
            with pytest.raises(rc.InputError, match=f"{what} needs a rotationally symmetric lens.*{why}"):
                rc.render(sky(), Camera(moved, model=model), spp=1, effects=effects)


def test_a_lens_of_revolution_with_odd_terms_takes_pictures_with_all_defaults():
    """The radial pupil is its own, and light that is traced from lamps is not for it: both have to be heeded."""
    shot = rc.Shot.load("scenes/demo.toml", device="cpu")
    lens = shot.camera.lens.with_surface(0, radial_terms={3: 1e-12})
    assert lens.is_rotational
    film = Film(36, 24, (60, 40))
    place = {"position": shot.camera.position, "look_at": shot.camera.look_at}
    straight, odd = (
        rc.render(shot.scene, Camera(of, film=film, **place), spp=64, effects="auto", device="cpu")
        for of in (shot.camera.lens, lens)
    )
    # A term of 2e-9 mm at the rim changes nothing; the lamps are samples of pixels alone, with all their noise.
    assert odd.pixels.mean() == pytest.approx(straight.pixels.mean(), rel=0.05)
