"""Ghosts in pictures: first-order positions, flux against an independent sum, and cases without any ghosts."""

from __future__ import annotations

import itertools
import math
import warnings

import numpy as np
import pytest
import realcam as rc

from ...measurement import Measurement, hold
from .. import scenes

FILM = rc.Film(24, 24, (96, 96))


def far_lamp(tangent_x: float, tangent_y: float, distance_m: float = 1e4, brightness: float = 1.0) -> rc.Scene:
    """A point light that gives `brightness` lux at the camera, in the direction with these tangents to the axis."""
    behind = np.array([[0.0, 0.0, 1e5], [1.0, 0.0, 1e5], [0.0, 1.0, 1e5]])
    place = (tangent_x * distance_m, tangent_y * distance_m, -distance_m)
    lux = brightness * float(np.dot(place, place))
    return rc.Scene.from_arrays(behind, [[0, 1, 2]]).with_point_light(place, (lux, lux, lux))


def ghosts(
    scene: rc.Scene, camera: rc.Camera, spp: int = 64, device: str = "cpu", effect: str = "ghosts=0", **settings: object
) -> np.ndarray:
    """(H, W, 3): what ghosts bring to the film. A point light is seen by no other sample, but for its image's own."""
    settings = {"light_tracing": "off"} | settings
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        effects = {effect} | set(settings.pop("effects", ()))  # type: ignore[call-overload]
        image = rc.render(scene, camera, spp=spp, effects=effects, device=device, **settings)  # type: ignore[arg-type]
    return image.pixels.astype(np.float64)


def lit_without_ghosts(scene: rc.Scene, camera: rc.Camera, **settings: object) -> np.ndarray:
    image = rc.render(scene, camera, device="cpu", **{"effects": (), "light_tracing": "off", **settings})  # type: ignore[arg-type]
    return image.pixels.astype(np.float64)


def singlet(stop_mm: float) -> rc.Lens:
    """Two bare surfaces have one ghost; the stop is in front. Film in the focus."""
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=stop_mm, thickness_mm=0),
        rc.Surface(radius_of_curvature_mm=60, thickness_mm=6, material=1.6, clear_semi_diameter_mm=15),
        rc.Surface(radius_of_curvature_mm=-80, clear_semi_diameter_mm=15),
    ]
    lens = rc.Lens(surfaces=surfaces, film_distance_mm=40.0)
    return rc.Lens(surfaces=surfaces, film_distance_mm=lens.first_order().back_focal_distance_mm).with_coating("bare")


def paraxial_film_height(lens: rc.Lens, height: float, slope: float) -> float:
    """Film height of a paraxial ray reflected at the back face, then the front face: n'u' = nu - yc(n' - n), with a
    negative index while the ray travels backwards."""
    n = 1.6
    front, back = (surface.curvature_per_mm for surface in lens.surfaces[1:])
    direction = [(front, 1, n, 6.0), (back, n, -n, -6.0), (front, -n, n, 6.0), (back, n, 1, lens.film_distance_mm)]
    y, u = height, slope
    for curvature, before, behind, distance in direction:
        u = (before * u - y * curvature * (behind - before)) / behind
        y += distance * u
    return y


def test_ghost_of_a_singlet_is_where_first_order_puts_it() -> None:
    lens, tangent, side = singlet(stop_mm=0.5), 0.05, 480
    film = rc.Film(12, 12, (side, side))
    scene, camera = far_lamp(tangent, 0.0), rc.Camera(lens, film=film, exposure_time_s=1)
    light = ghosts(scene, camera, spp=16).mean(axis=2)
    along = (np.arange(side) + 0.5) * 12 / side - 6
    total = light.sum()
    middle = float((light * along[None, :]).sum() / total)
    # The picture is turned, so that +x of the scene is to its right.
    place = -paraxial_film_height(lens, 0.0, -tangent)
    growth = abs(paraxial_film_height(lens, 1.0, 0.0))
    # A disc whose squared distance from the middle has the mean r^2 / 2, and half of that along one axis.
    spread = float(np.sqrt(((along[None, :] - middle) ** 2 * light).sum() / total))
    radius = 2 * spread
    # Third order: (0.05)^2 of the height, and of the disc.
    hold(Measurement("Effects", "place of a singlet's ghost", "first order, at 3 degrees", "cpu", "float32",
                     abs(middle - place), 0.005 * abs(place) + 0.005, "mm"))  # fmt: skip
    hold(Measurement("Effects", "radius of a singlet's ghost", "first order", "cpu", "float32",
                     abs(radius - growth * 0.5), 0.01 * growth * 0.5, "mm"))  # fmt: skip
    reflected = (0.6 / 2.6) ** 2
    flux = np.pi * 0.25 / np.sqrt(1 + tangent**2) * (1 - reflected) ** 2 * reflected**2  # lux mm^2
    assert total * (12 / side) ** 2 == pytest.approx(flux, rel=0.01)


class SequentialTrace:
    """Rays of light through bare spheres and cylinders in the order that a ghost meets them, by the textbook: vectors,
    Snell, and Fresnel's formulas for s and p. It shares no code with realcam."""

    def __init__(self, lens: rc.Lens, film_reflectance: float = 0.0, film_radius: float = 0.0) -> None:
        """The film is the surface behind the last one: a plane mirror. Faces may be tilted about x; toroids are
        cylinders with their power in the xz plane."""
        self.film, self.film_z, self.film_reflectance = len(lens.surfaces), lens.film_position_mm, film_reflectance
        self.stop_mm = lens.stop_semi_diameter_mm
        # Vertex, axes as rows, curvature, the coordinates in which it curves, index in front and behind, rim.
        self.surfaces: list[tuple[float, np.ndarray, float, np.ndarray, float, float, float]] = []
        index = 1.0
        for z, surface in zip(lens.vertices_mm, lens.surfaces, strict=True):
            refracts, is_cylinder = surface.type == "refracting", surface.form == "toroid"
            cos, sin = (f(np.radians(surface.tilt_deg[0])) for f in (np.cos, np.sin))
            axes = np.array([[1, 0, 0], [0, cos, sin], [0, -sin, cos]])
            c = 1 / surface.radius_of_curvature_x_mm if is_cylinder else surface.curvature_per_mm
            behind = surface.material.index(lens.wavelength_nm) if refracts else index
            rim = surface.clear_semi_diameter_mm if refracts else self.stop_mm
            self.surfaces.append((z, axes, c, np.array([1, not is_cylinder, 1]), index, behind, rim))
            index = behind
        self.surfaces.append((self.film_z, np.eye(3), 0.0, np.ones(3), index, index, film_radius))
        self.refracting = [i for i, surface in enumerate(lens.surfaces) if surface.type == "refracting"]

    def path_of(self, first: int, second: int) -> list[tuple[int, int, bool]]:
        """(surface, direction along z, whether it is reflected)."""
        there = [(i, 1, i == first) for i in range(first + 1)]
        back = [(i, -1, i == second) for i in range(first - 1, second - 1, -1)]
        return there + back + [(i, 1, False) for i in range(second + 1, self.film)]

    def to_film(
        self, o: np.ndarray, d: np.ndarray, direction: list[tuple[int, int, bool]]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Places on the film and shares of the power; 0 where a ray is lost."""
        s = p = np.ones(len(o))
        with np.errstate(all="ignore"):
            for surface, sign, reflected in direction:
                z, axes, c, curved, in_front, beyond, rim = self.surfaces[surface]
                # |o + t d - C|^2 = R^2 in curvatures: A t^2 - 2 G t + F = 0.
                local, along = (o - [0, 0, z]) @ axes.T, d @ axes.T
                F = c * (curved * local**2).sum(1) - 2 * local[:, 2]
                G = along[:, 2] - c * (curved * local * along).sum(1)
                A = c * (curved * along**2).sum(1)
                local = local + (F / (G + sign * np.sqrt(G * G - A * F)))[:, None] * along
                normal = np.array([0.0, 0.0, 1.0]) - c * curved * local
                normal *= sign / np.linalg.norm(normal, axis=1, keepdims=True)
                inside = np.hypot(local[:, 0], local[:, 1]) <= rim
                before, behind = (in_front, beyond)[::sign]
                cos1 = (along * normal).sum(1)
                ratio = before / behind
                squared = 1 - ratio**2 * (1 - cos1**2)
                cos2 = np.sqrt(np.maximum(squared, 0))
                rs = ((before * cos1 - behind * cos2) / (before * cos1 + behind * cos2)) ** 2
                rp = ((behind * cos1 - before * cos2) / (behind * cos1 + before * cos2)) ** 2
                if surface == self.film:
                    rs = rp = np.full(len(o), self.film_reflectance)
                if reflected:
                    along = along - 2 * cos1[:, None] * normal
                    s, p = s * rs * inside, p * rp * inside
                else:
                    along = ratio * along + (cos2 - ratio * cos1)[:, None] * normal
                    s, p = s * (1 - rs) * inside * (squared > 0), p * (1 - rp) * inside * (squared > 0)
                o, d = local @ axes + [0, 0, z], along @ axes
            place = o + ((self.film_z - o[:, 2]) / d[:, 2])[:, None] * d
        return place[:, :2], np.nan_to_num((s + p) / 2)

    def flux(self, pair: tuple[int, int], tangent: float, film_mm: float, grid: int, *, disc: bool = False) -> float:
        """lux mm^2 on a square film, or the disc in it, of a lamp of 1 lux at this tangent. `grid`: points along x, and
        half as many along y, of which one side is the mirror image of the other."""
        d = np.array([-tangent, 0.0, 1.0]) / np.sqrt(1 + tangent**2)
        reach = self.surfaces[0][-1] * 1.3
        edge = (np.arange(grid) + 0.5) / grid * 2 * reach - reach
        x, y = (a.ravel() for a in np.meshgrid(edge, edge[grid // 2 :]))
        start = np.stack([x, y, np.zeros(len(x))], axis=1) - 30 * d
        place, share = self.to_film(start, np.broadcast_to(d, start.shape), self.path_of(*pair))
        inside = (np.abs(place) <= film_mm / 2).all(axis=1)
        if disc:
            inside = np.hypot(place[:, 0], place[:, 1]) <= film_mm / 2
        return float(2 * np.where(inside, share, 0).sum() * (2 * reach / grid) ** 2 * d[2])


@pytest.mark.parametrize("degrees", [0.0, 12.0, 30.0])
def test_all_pairs_of_a_double_gauss_and_a_film_bring_as_much_light_as_an_independent_sum(degrees: float) -> None:
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare").focused(5.0)
    tangent = float(np.tan(np.radians(degrees)))
    trace = SequentialTrace(lens, 0.1, float(np.hypot(12, 12)))
    pairs = [(b, a) for a, b in itertools.combinations([*trace.refracting, trace.film], 2)]
    assert len(pairs) == 45 + 10
    # Sums over n x n points are good to n^-1.5 where edges cut them: 0.1% of each of 55.
    flux = {pair: trace.flux(pair, tangent, 24, 96) for pair in pairs}
    of_film = sum(light for (first, _), light in flux.items() if first == trace.film)
    camera, scene = rc.Camera(lens, film=FILM, exposure_time_s=1), far_lamp(tangent, 0.0)

    def total(**settings: object) -> float:
        return ghosts(scene, camera, spp=64, **settings).mean(axis=2).sum() * (24 / 96) ** 2  # type: ignore[arg-type]

    hold(Measurement("Effects", "light that all 45 ghosts of a double Gauss bring to the film",
                     f"a far lamp at {degrees:g} degrees, against a sum over rays in double", "cpu", "float32",
                     abs(total() / (sum(flux.values()) - of_film) - 1), 0.01, ""))  # fmt: skip
    if degrees == 30:
        return
    hold(Measurement("Effects", "light that the ghosts of film and double Gauss bring to the film",
                     f"a tenth reflected, a far lamp at {degrees:g} degrees, against a sum over rays in double", "cpu",
                     "float32", abs(total(effects={"film_reflection=0.1"}) / sum(flux.values()) - 1), 0.01,
                     ""))  # fmt: skip
    # Without those that bring less than 1e-6 of the lens's light.
    assert total(effect="film_reflection=0.1") == pytest.approx(of_film, rel=0.02)


@pytest.mark.parametrize("wavelength_nm", [400.0, 450.0, 650.0])
def test_ghosts_under_a_line_have_the_reflectances_of_that_line(wavelength_nm: float) -> None:
    """Ghosts of a singlet and a highly dispersive window."""

    def lens_for(nm: float) -> rc.Lens:
        surfaces = [
            rc.Stop(clear_semi_diameter_mm=5, thickness_mm=0),
            rc.Surface(radius_of_curvature_mm=60, thickness_mm=6, material="N-BK7", clear_semi_diameter_mm=15),
            rc.Surface(radius_of_curvature_mm=-80, thickness_mm=3, clear_semi_diameter_mm=15),
            rc.Surface(thickness_mm=4, material="N-SF11", clear_semi_diameter_mm=15),
            rc.Surface(clear_semi_diameter_mm=15),
        ]
        return rc.Lens(surfaces=surfaces, film_distance_mm=55.0, wavelength_nm=nm).with_coating("bare")

    tangent = float(np.tan(np.radians(9)))
    trace = SequentialTrace(lens_for(wavelength_nm))
    pairs = [(b, a) for a, b in itertools.combinations(trace.refracting, 2)]
    expected = sum(trace.flux(pair, tangent, 24, 128) for pair in pairs)
    camera = rc.Camera(lens_for(587.5618), film=FILM, exposure_time_s=1)
    lit = ghosts(far_lamp(tangent, 0.0), camera, spp=256, effects={"dispersion"}, illuminant=wavelength_nm)
    total = lit.mean(axis=2).sum() * (24 / 96) ** 2
    hold(Measurement("Effects", "light of the ghosts of a singlet and a window of N-SF11",
                     f"{wavelength_nm:g} nm, against a sum over rays in double", "cpu", "float32",
                     abs(total / expected - 1), 0.01, ""))  # fmt: skip


def ghosts_of_boards(
    camera: rc.Camera, place: tuple[float, float, float], spp: int, effects: set[str]
) -> tuple[np.ndarray, np.ndarray]:
    """(H, W) each, of a board of 1 cd/m^2 to all sides: light that it emits, and light that it reflects of a sun."""
    reflecting = scenes.scene_of(scenes.quad(place, 0.5, diffuse=1.0)).with_sun((0, 0, -1), (np.pi, np.pi, np.pi))
    plain = effects - {"film_reflection"}
    emitted, reflected = (
        ghosts(scene, camera, spp=spp, effects=effects) - lit_without_ghosts(scene, camera, spp=spp, effects=plain)
        for scene in (scenes.scene_of(scenes.quad(place, 0.5, emission=1.0)), reflecting)
    )
    return emitted.mean(axis=2), reflected.mean(axis=2)


@pytest.mark.parametrize("effects", [set(), {"dispersion", "film_reflection"}])
@pytest.mark.slow
def test_what_reflects_light_has_the_ghosts_of_what_emits_it(effects: set[str]) -> None:
    """Ghosts of reflecting surfaces are traced from the film, those of emitters from the light source."""
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare").focused(5.0)
    camera = rc.Camera(lens, film=FILM, exposure_time_s=1)
    pictures = ghosts_of_boards(camera, (0.3, 0.2, -3.0), 512, effects)
    emitted, reflected = (light.reshape(4, 24, 4, 24).mean(axis=(1, 3)) for light in pictures)
    hold(Measurement("Effects", "ghosts of a board that reflects light against those of one that emits it",
                     " and ".join(["light", *sorted(effects)]), "cpu", "float32",
                     abs(reflected.sum() / emitted.sum() - 1), 0.01, ""))  # fmt: skip
    # Five standard deviations of these means. The largest standard deviation over a few seeds was 1.2% for 1024
    # samples, which is 1.7% for 512.
    np.testing.assert_allclose(reflected, emitted, atol=0.085 * emitted.max())
    assert emitted.min() < 0.5 * emitted.max()


def test_the_veil_of_a_sky_is_that_of_lamps_all_around() -> None:
    """The sum of flux(angle) over a half-space: a sky of radiance 1 is a lamp of 1 lux in each steradian."""
    lens, side, film_mm = singlet(stop_mm=5.0), 48, 24
    camera = rc.Camera(lens, film=rc.Film(film_mm, film_mm, (side, side)), exposure_time_s=1)
    effect = {"spp": 512, "device": "cpu", "seed": 3}
    light = ghosts(scenes.sky(), camera, **effect) - lit_without_ghosts(scenes.sky(), camera, spp=512, seed=3)  # type: ignore[arg-type]
    place = (np.arange(side) + 0.5) * film_mm / side - film_mm / 2
    inside = np.hypot(place[None, :], place[:, None]) <= film_mm / 2
    total = (light.mean(axis=2) * inside).sum() * (film_mm / side) ** 2
    trace = SequentialTrace(lens)
    nodes, weights = np.polynomial.legendre.leggauss(48)
    angles = np.radians(89) * (1 + nodes) / 2
    flux = [trace.flux((2, 1), float(np.tan(angle)), film_mm, 96, disc=True) for angle in angles]
    expected = float((2 * np.pi * np.sin(angles) * flux) @ weights) * np.radians(89) / 2
    # The disc's border cuts pixels: a few of 1800, of light that is the same on both sides. The sums are good to 0.1%.
    hold(Measurement("Effects", "veil of a constant sky by a singlet's ghost", "against a sum over rays in double",
                     "cpu", "float32", abs(total / expected - 1), 0.01, ""))  # fmt: skip


def test_a_lamp_behind_an_object_or_the_camera_makes_no_ghost() -> None:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    camera = rc.Camera(lens, film=FILM, exposure_time_s=1)
    assert ghosts(far_lamp(0.05, 0.0, distance_m=-1e4), camera, spp=4).sum() == 0
    settings = {"spp": 4, "max_bounces": 0}
    for x, is_seen in ((-0.5, True), (0.5, False)):
        scene = scenes.scene_of(scenes.quad((x, 0.25, -5), 0.4)).with_point_light((1000, 500, -10000), (1e8,) * 3)
        light = ghosts(scene, camera, **settings) - lit_without_ghosts(scene, camera, **settings)  # type: ignore[arg-type]
        assert light.any() == is_seen
        assert light.sum() >= 0


@pytest.mark.parametrize("name", ["double-gauss-50mm", "fisheye-6mm-220deg", "phone-4mm", "mirror-telephoto-500mm"])
@pytest.mark.parametrize("tangents", [(0.0, 0.0), (0.4, 0.3), (5.0, 0.0)])
def test_lamps_anywhere_give_numbers(name: str, tangents: tuple[float, float]) -> None:
    """On the axis, in the corner, far outside the frame: never below black, and exactly in step with the lamp."""
    camera = rc.Camera(rc.Lens.load(name).with_coating("bare"), film=rc.Film(36, 24, (30, 20)), exposure_time_s=1)
    once, brighter = (ghosts(far_lamp(*tangents, brightness=b), camera, spp=4) for b in (1.0, 1e8))
    assert np.isfinite(once).all()
    assert (once >= 0).all()
    # The unit of the sums follows the light, so that the same samples leave the same numbers.
    np.testing.assert_allclose(brighter, 1e8 * once, rtol=1e-5, atol=1e-9 * brighter.max())


def test_the_same_ghosts_each_time_whatever_the_threads() -> None:
    camera = rc.Camera(rc.Lens.load("double-gauss-50mm"), film=FILM, exposure_time_s=1)
    one, two = (ghosts(far_lamp(0.15, 0.1), camera, spp=8, threads=threads) for threads in (1, 2))
    np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize("effect", ["ghosts=0", "diffraction"])
def test_tents_keep_the_light_of_ghosts_and_stars(effect: str, device: str) -> None:
    """The values of the tents of all pixels at a film point add up to 1, as those of the boxes do; the light is in the
    middle of the film."""
    camera = rc.Camera(singlet(2.0).stopped_down(20), film=rc.Film(24, 16, (48, 32)), exposure_time_s=1)

    def light(filter: str, seed: int) -> float:
        scene = far_lamp(0.02, 0.01)
        picture = ghosts(scene, camera, device=device, effect=effect, filter=filter, seed=seed)
        return float(picture[..., 1].sum())

    box, tent = (np.array([light(filter, seed) for seed in range(12)]) for filter in ("box", "tent"))
    assert box.mean() > 0
    error = np.hypot(box.std(ddof=1), tent.std(ddof=1)) / math.sqrt(12)
    # Once in 100,000 by chance; float32 sums to 1e-6.
    assert abs(tent.mean() - box.mean()) < 6 * error + 1e-5 * box.mean()
    assert error < 0.02 * box.mean()


@pytest.mark.parametrize(
    "effect", ["ghosts=2", "ghosts=", "ghosts=-1", "ghosts=nan", "dispersion=1", "film_reflection=1.1"]
)
def test_a_share_that_is_none_is_refused(effect: str) -> None:
    camera = rc.Camera(rc.Lens.load("double-gauss-50mm"), film=FILM)
    with pytest.raises(rc.InputError, match=f'"{effect}" is not an effect'):
        rc.render(scenes.sky(), camera, spp=1, effects=effect)


def test_shares_are_told_again() -> None:
    camera = rc.Camera(rc.Lens.load("double-gauss-50mm"), film=FILM)
    with pytest.warns(UserWarning, match="ghosts: the coating of surfaces"):
        assert rc.render(scenes.sky(), camera, spp=1, effects="ghosts=1e-8").effects == ("ghosts=1e-08",)


def test_ghosts_are_listed_by_what_they_bring() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    bare, coated = (lens.with_coating(coating).ghosts() for coating in ("bare", "quarter_wave"))
    assert len(bare) == 45
    shares = [ghost.share or 0.0 for ghost in bare]
    assert shares == sorted(shares, reverse=True)
    assert sum(ghost.share or 0.0 for ghost in coated) < 0.1 * sum(shares)
    first = bare[0]
    alone = lens.ghost(first.first, first.second)
    assert alone.effective_focal_length_mm == first.effective_focal_length_mm
    assert alone.share is None


def test_ghosts_of_the_film_are_listed_with_its_number() -> None:
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare")
    film = len(lens.surfaces)
    tenth, fifth = (lens.ghosts(film_reflectance=r) for r in (0.1, 0.2))
    assert len(tenth) == 55
    of_film = {ghost.second: ghost.share for ghost in tenth if ghost.first == film}
    assert len(of_film) == 10
    for ghost in fifth:
        if ghost.first == film:
            assert ghost.share == pytest.approx(2 * of_film[ghost.second], rel=1e-12)
    with pytest.raises(rc.InputError, match="film_reflectance"):
        lens.ghosts(film_reflectance=1.5)
