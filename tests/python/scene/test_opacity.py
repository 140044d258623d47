"""Surfaces with holes: what goes through them is what their opacity leaves, for pictures and for shadows."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes

SKY = 100.0


def holed(at_z: float, half: float = 3.0, **material: object) -> tuple[np.ndarray, rc.Material]:
    """A black plate that faces the camera."""
    corners, _ = scenes.quad((0, 0, at_z), half)
    return corners, rc.Material(diffuse=(0, 0, 0), **material)  # type: ignore[arg-type]


def plates(*parts: tuple[np.ndarray, rc.Material]) -> rc.Scene:
    """Texture coordinates 0 to 1, v upwards."""
    count = len(parts)
    first, halves = 4 * np.arange(count)[:, None], np.array([0, 1, 2, 0, 2, 3])
    return rc.Scene.from_arrays(
        np.concatenate([corners for corners, _ in parts]),
        (first + halves).reshape(-1, 3),
        uvs=np.tile([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], (count, 1)),
        triangle_materials=np.repeat(np.arange(count), 2),
        materials=[material for _, material in parts],
    )


def hold_share(measured: np.ndarray, share: float, samples: int) -> None:
    """Within five standard errors of a binomial mean."""
    assert measured.mean() == pytest.approx(share, abs=5 * math.sqrt(share * (1 - share) / samples) + 1e-6)


@pytest.mark.parametrize("layers", [1, 2, 5])
@pytest.mark.parametrize("opacity", [0.0, 0.3, 0.9, 1.0])
def test_the_sky_through_plates(opacity: float, layers: int) -> None:
    scene = plates(*(holed(-2 - 0.1 * i, opacity=opacity) for i in range(layers))).with_environment(SKY)
    camera = scenes.pinhole()
    seen = scenes.radiance(scene, camera, spp=64) / SKY
    hold_share(seen, (1 - opacity) ** layers, 64 * seen[..., 0].size)


@pytest.mark.parametrize("opacity", [0.0, 0.25, 1.0])
def test_the_shadow_of_plates(opacity: float) -> None:
    floor = (scenes.quad((0, 0, -2), 3)[0], rc.Material(diffuse=(0.5, 0.5, 0.5)))
    # Behind the camera, so that only the sun goes through them.
    scene = plates(floor, holed(1, half=50, opacity=opacity), holed(1.5, half=50, opacity=opacity))
    lit = scene.with_sun((0, 0, -1), (math.pi, math.pi, math.pi))
    seen = scenes.radiance(lit, scenes.pinhole(), spp=64) / 0.5
    hold_share(seen, (1 - opacity) ** 2, 64 * seen[..., 0].size)


def opacity_seen(camera: rc.Camera, row: np.ndarray) -> tuple[np.ndarray, rc.CameraRays]:
    """Opacity at each ray's point on holed(-2) for a map whose rows all equal `row`, linear between texel centres; and
    the rays."""
    points, rays = scenes.points_on_plane(camera, 16, (0, 0, -2), (0, 0, 1))
    return np.interp((points[:, 0] + 3) / 6 * len(row) - 0.5, np.arange(len(row)), row / 255), rays


def test_a_map_of_opacity_in_all_its_forms() -> None:
    """Grey, colours and alpha say the same."""
    row = np.repeat([255, 0, 102, 0, 255, 0, 204, 51], 12).astype(np.uint8)
    grey = np.repeat(row[None], 8, axis=0)
    colours = np.stack([grey] * 3, axis=-1)
    alpha = np.concatenate([np.full((*grey.shape, 3), 77, np.uint8), grey[..., None]], axis=-1)
    opacity, rays = opacity_seen(scenes.pinhole(), row)
    expected = 1 - scenes.mean_over_pixels(rays, opacity)
    pictures = []
    for texture in (grey, colours, alpha):
        scene = plates(holed(-2, opacity_texture=texture)).with_environment(SKY)
        pictures.append(scenes.radiance(scene, scenes.pinhole(), spp=16)[..., 0])
        # A column has 16 samples in each of 16 rows of the same opacity: five standard errors of a random choice.
        columns = pictures[-1].mean(axis=0) / SKY
        np.testing.assert_allclose(columns, expected.mean(axis=0), atol=5 * 0.5 / math.sqrt(16 * 16))
        assert columns.mean() == pytest.approx(expected.mean(), abs=5 * 0.5 / math.sqrt(16 * expected.size))
    np.testing.assert_array_equal(pictures[0], pictures[1])
    np.testing.assert_array_equal(pictures[0], pictures[2])


def test_a_cutoff_makes_edges_sharp() -> None:
    row = np.linspace(0, 255, 64).round().astype(np.uint8)
    opacity, rays = opacity_seen(scenes.pinhole(), row)
    for cutoff in (0.45, 0.55):
        scene = plates(holed(-2, opacity_texture=np.repeat(row[None], 4, axis=0), opacity_cutoff=cutoff))
        seen = scenes.radiance(scene.with_environment(SKY), scenes.pinhole(), spp=16)[..., 0] / SKY
        # A ray that passes the edge by less than its rounding may be decided otherwise.
        np.testing.assert_allclose(seen, scenes.mean_over_pixels(rays, opacity < cutoff), atol=1.5 / 16)
        assert 0.1 < seen.mean() < 0.9
        assert seen.mean() == pytest.approx((opacity < cutoff).mean(), abs=1e-3)


def test_a_lamp_with_holes_gives_the_light_of_what_is_there() -> None:
    """Light samples (bounces 0) and scattered rays that hit the lamp give the same mean."""
    floor = (scenes.quad((0, 0, -2), 3)[0], rc.Material(diffuse=(0.5, 0.5, 0.5)))
    lamp, _ = scenes.quad((0, 0, 1), 2, right=(-1, 0, 0))
    camera = scenes.pinhole()

    def irradiance(**material: object) -> float:
        glowing = rc.Material(diffuse=(0, 0, 0), emission=(100, 100, 100), **material)  # type: ignore[arg-type]
        return float(scenes.radiance(plates(floor, (lamp, glowing)), camera, spp=256).mean())

    # The lamp's light has a relative standard deviation of about 1 a sample, of 98,000: 0.3%, and five of them.
    assert irradiance(opacity=0.25) == pytest.approx(0.25 * irradiance(), rel=0.02)
    half = np.repeat([[0, 255]], 2, axis=0).astype(np.uint8)
    assert irradiance(opacity_texture=half) == pytest.approx(0.5 * irradiance(), rel=0.02)


def test_an_instance_has_holes_of_its_own() -> None:
    plate = plates(holed(0, half=0.6, opacity=0.5))
    wall = plates(holed(-5, half=0.1)).with_environment(SKY)
    place = np.diag([5.0, 5, 5, 1])
    place[2, 3] = -2
    scene = wall.with_instance(plate, place)
    seen = scenes.radiance(scene, scenes.pinhole(), spp=64)[:4] / SKY
    hold_share(seen, 0.5, 64 * seen[..., 0].size)


def test_emission_on_both_sides() -> None:
    front = scenes.quad((0, 0, -2), 3)[0]
    back = scenes.quad((0, 0, -2), 3, right=(-1, 0, 0))[0]
    glowing = rc.Material(diffuse=(0, 0, 0), emission=(7, 7, 7), double_sided=True)
    for corners in (front, back):
        np.testing.assert_allclose(scenes.radiance(plates((corners, glowing)), scenes.pinhole()), 7, rtol=1e-6)
    # The lamp also lights both sides alike: floors above and below it.
    lamp = scenes.quad((0, 0, -2), 0.5, right=(1, 0, 0), up=(0, 0, -1))[0]
    floor = (scenes.quad((0, -1, -2), 3, right=(1, 0, 0), up=(0, 0, -1))[0], rc.Material())
    ceiling = (scenes.quad((0, 1, -2), 3, right=(1, 0, 0), up=(0, 0, 1))[0], rc.Material())
    room = plates(floor, ceiling, (lamp, glowing))
    seen = [scenes.radiance(room, scenes.pinhole(look_at=(0, y, -2)), spp=256).mean() for y in (-1.0, 1.0)]
    assert seen[0] > 0
    assert seen[0] == pytest.approx(seen[1], rel=0.02)


def test_a_shadow_catcher_shows_shadows_alone() -> None:
    camera = scenes.pinhole()
    catcher = (scenes.quad((0, 0, -2), 3)[0], rc.Material(shadow_catcher=True))
    wall = (scenes.quad((0, 0, -2.5), 4)[0], rc.Material(diffuse=(0.5, 0.5, 0.5)))
    # Beside the lens, between the lamp and the catcher: it hides the lamp from the half x < 0, of the wall as well.
    shade = (scenes.quad((-3, 0, 0.5), 3)[0], rc.Material(diffuse=(0, 0, 0)))
    lamp = ((0, 0, 1), (50.0, 50.0, 50.0))

    def seen(*parts: tuple[np.ndarray, rc.Material]) -> np.ndarray:
        # The catcher counts as a bounce.
        picture = scenes.radiance(plates(*parts).with_point_light(*lamp), camera, spp=16, max_bounces=1)
        return np.asarray(picture[..., 0])

    np.testing.assert_array_equal(seen(catcher), 0)
    np.testing.assert_allclose(seen(catcher, wall), seen(wall), rtol=1e-5)
    # The plate hides the lamp from a half of the wall, too.
    lit, caught = seen(wall), seen(catcher, wall, shade)
    np.testing.assert_array_equal(caught[:, :11], 0)
    np.testing.assert_allclose(caught[:, 13:], lit[:, 13:], rtol=1e-5)


def test_a_shadow_catcher_takes_the_share_of_each_light() -> None:
    """Two lamps of ratio 3 to 1; a plate hides the stronger one, so that a quarter of the light behind remains."""
    camera = scenes.pinhole()
    catcher = (scenes.quad((0, 0, -2), 3)[0], rc.Material(shadow_catcher=True))
    far = 60.0  # from where both fall alike on all of the catcher
    shade = (scenes.quad((far / 2, 0, far / 2), 12)[0], rc.Material(diffuse=(0, 0, 0)))
    scene = (
        plates(catcher, shade)
        .with_point_light((far, 0, far), (30000.0,) * 3)
        .with_point_light((-far, 0, far), (10000.0,) * 3)
        .with_environment(1e-3)  # which is seen behind, and brings next to nothing
    )
    with_plate = scenes.radiance(scene, camera, spp=256, max_bounces=1).mean()
    assert with_plate / 1e-3 == pytest.approx(0.25, abs=0.02)


def test_light_and_shadows_go_through_a_shadow_catcher() -> None:
    floor = (scenes.quad((0, 0, -2), 3)[0], rc.Material(diffuse=(0.5, 0.5, 0.5)))
    before = (scenes.quad((0, 0, 1), 60)[0], rc.Material(shadow_catcher=True))
    camera, sun = scenes.pinhole(), ((0, 0, -1), (math.pi,) * 3)
    np.testing.assert_allclose(
        scenes.radiance(plates(floor, before).with_sun(*sun), camera),
        scenes.radiance(plates(floor).with_sun(*sun), camera),
        rtol=1e-5,
    )


@pytest.mark.parametrize(("inner", "outer"), [(0.0, 45.0), (20.0, 30.0), (25.0, 25.0), (0.0, 90.0)])
def test_a_spot_fades_as_the_extension_says(inner: float, outer: float) -> None:
    place, axis = np.array([0.2, 0.1, 1.0]), np.array([0.1, 0.0, -1.0])
    axis /= np.linalg.norm(axis)
    scene = scenes.scene_of(scenes.quad((0, 0, -2), 3, diffuse=0.5)).with_spot_light(
        tuple(place), tuple(2 * axis), (100, 100, 100), inner_cone_deg=inner, outer_cone_deg=outer
    )
    camera = scenes.pinhole()
    points, rays = scenes.points_on_plane(camera, 16, (0, 0, -2), (0, 0, 1))
    direction = points - place
    distance = np.linalg.norm(direction, axis=1)
    cos_inner, cos_outer = np.cos(np.radians([inner, outer]))
    # KHR_lights_punctual's lightAngleScale and lightAngleOffset.
    scale = 1 / max(1e-3, cos_inner - cos_outer)
    fading = np.clip(direction @ axis / distance * scale - cos_outer * scale, 0, 1) ** 2
    expected = 0.5 / math.pi * 100 * scenes.mean_over_pixels(rays, fading * -direction[:, 2] / distance**3)
    measured = scenes.radiance(scene, camera)[..., 0]
    # For a spot that fades within a thousandth of the cosine, the cosine's rounding is 1e-4 of that range.
    np.testing.assert_allclose(measured, expected, rtol=2e-3 if inner == outer else 5e-5, atol=1e-4 * expected.max())
    assert expected.max() > 0


def test_what_makes_no_sense_is_refused() -> None:
    scene = plates(holed(-2))
    with pytest.raises(rc.InputError, match="outer_cone_deg <= 90"):
        scene.with_spot_light((0, 0, 0), (0, 0, -1), (1, 1, 1), outer_cone_deg=91)
    with pytest.raises(rc.InputError, match="outer_cone_deg"):
        scene.with_spot_light((0, 0, 0), (0, 0, -1), (1, 1, 1), inner_cone_deg=50)
    with pytest.raises(rc.InputError, match="spot's direction"):
        scene.with_spot_light((0, 0, 0), (0, 0, 0), (1, 1, 1))
    for wrong in ({"opacity": 1.5}, {"opacity": -0.1}, {"opacity": math.nan}, {"opacity_cutoff": 2.0}):
        with pytest.raises(rc.InputError, match="opacity"):
            plates(holed(-2, **wrong))
