"""Glass at all sizes and places: the same picture from 1 mm to 1 km, and 1000 km away; panes that nearly touch."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from .. import scenes

FILM = rc.Film(36, 24, (48, 32))


def ball(center: np.ndarray, radius: float, rings: int = 24) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners, triangles and normals, outwards."""
    polar, azimuth = np.meshgrid(
        np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1), indexing="ij"
    )
    normals = np.stack([np.sin(polar) * np.cos(azimuth), np.cos(polar), -np.sin(polar) * np.sin(azimuth)], -1)
    n = 2 * rings + 1
    a = np.array([r * n + c for r in range(rings) for c in range(2 * rings)])
    lower, upper = np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)
    normals = normals.reshape(-1, 3)
    return center + radius * normals, np.concatenate([lower[: -2 * rings], upper[2 * rings :]]), normals


def photograph(size: float, shift: tuple[float, float, float]) -> np.ndarray:
    """A ball of coloured glass and a mirror on a floor under a lamp, a pinhole's picture; `size`: of 1 m."""
    pupil = np.array(scenes.pinhole(FILM).entrance_pupil_position_m)

    def placed(points: np.ndarray) -> np.ndarray:
        return np.asarray(size * points + pupil + shift)

    corners, triangles, normals = ball(np.array([0.0, -0.1, -2.0]), 0.4)
    mirror_ball = ball(np.array([0.7, -0.2, -2.6]), 0.3)
    floor = scenes.quad((0, -0.5, -2), 3, right=(1, 0, 0), up=(0, 0, -1))[0]
    lamp = scenes.quad((0.5, 2, -1.5), 0.6, right=(-1, 0, 0), up=(0, 0, -1))[0]
    quads = np.array([[0, 1, 2], [0, 2, 3]])
    counts = np.cumsum([0, len(corners), len(mirror_ball[0]), 4, 4])
    scene = rc.Scene.from_arrays(
        placed(np.concatenate([corners, mirror_ball[0], floor, lamp])),
        np.concatenate(
            [triangles, mirror_ball[1] + counts[1], quads + counts[2], quads + counts[3]],
        ),
        normals=np.concatenate([normals, mirror_ball[2], np.zeros((8, 3))]),
        triangle_materials=np.repeat(np.arange(4), [len(triangles), len(mirror_ball[1]), 2, 2]),
        materials=[
            rc.Material(diffuse=(0, 0, 0), transmission=1, ior=1.5, absorption=tuple(np.array([0.2, 1, 3]) / size)),
            rc.Material(diffuse=(0.1, 0.1, 0.1), mirror=(0.8, 0.8, 0.8)),
            rc.Material(diffuse=(0.5, 0.4, 0.3)),
            rc.Material(diffuse=(0, 0, 0), emission=(500, 500, 500)),
        ],
    ).with_environment((1, 2, 4))
    camera = scenes.pinhole(FILM, position=shift, look_at=tuple(np.add(shift, (0, 0, -1))))
    return np.asarray(rc.render(scene, camera, effects=(), spp=32, max_bounces=8, device="cpu").pixels, float)


@pytest.mark.parametrize(
    ("size", "shift"),
    [
        (1e-3, (0.0, 0.0, 0.0)),
        (1e3, (0.0, 0.0, 0.0)),
        (1.0, (1e6, -3e5, 2e5)),
        (1e-3, (1e6, -3e5, 2e5)),
        (1e3, (1e6, -3e5, 2e5)),
    ],
    ids=str,
)
def test_the_same_picture_at_every_size_and_place(size: float, shift: tuple[float, float, float]) -> None:
    """The samples are the same. One that meets an edge by less than its rounding goes another way, and curved glass
    makes roundings some tens of times larger at each border, so that a few pixels hold a path that differs.
    """
    reference, other = photograph(1.0, (0, 0, 0)), photograph(size, shift)
    assert reference.mean() > 0
    assert other.mean() == pytest.approx(reference.mean(), rel=3e-3)
    difference = np.abs(other - reference).max(axis=2)
    astray = difference > 1e-2 * reference.max(axis=2)
    # Metres of 1e6 are known to 1e-10 in double: a millimetre there keeps 1e-7 of itself, as float does.
    assert astray.mean() < 0.05


def panes(gap: float, distance: float) -> rc.Scene:
    """Two thin panes across the view, before a sky."""
    glass = rc.Material(diffuse=(0, 0, 0), transmission=1, ior=1.5, thin=True)
    half = 2 * distance
    corners = np.concatenate([scenes.quad((0, 0, -distance - at), half)[0] for at in (0.0, gap)])
    faces = (4 * np.arange(2)[:, None] + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3)
    return rc.Scene.from_arrays(corners, faces, materials=[glass]).with_environment(1)


def pane_reflectance(cosine: np.ndarray, ior: float = 1.5) -> np.ndarray:
    """Unpolarised, of a film with both its borders and all reflections between them, without interference."""
    inside = np.sqrt(1 - (1 - cosine**2) / ior**2)
    s = ((cosine - ior * inside) / (cosine + ior * inside)) ** 2
    p = ((ior * cosine - inside) / (ior * cosine + inside)) ** 2
    r = (s + p) / 2
    return np.asarray(2 * r / (1 + r))


@pytest.mark.parametrize("distance", [0.5, 5.0, 500.0])
@pytest.mark.parametrize("gap", [1e-5, 1e-2])
def test_through_two_panes_no_light_gets_lost_and_none_leaks(gap: float, distance: float) -> None:
    """With the same sky on both sides, what passes and what comes back is all of its light. A dark wall behind leaves
    what comes back, which tells two panes from one.
    """
    camera = scenes.pinhole(FILM)
    lit = panes(gap * distance, distance)
    picture = rc.render(lit, camera, effects=(), spp=64, max_bounces=24, device="cpu").pixels
    sky = rc.render(scenes.sky(), camera, effects=(), spp=64, device="cpu").pixels
    np.testing.assert_allclose(picture.mean() / sky.mean(), 1, rtol=2e-3)
    # A black wall close behind both: what is left is what the panes reflect, R + T R T / (1 - R^2) = 2 R / (1 + R).
    wall = scenes.quad((0, 0, -distance * 1.5), 3 * distance)
    dark = rc.render(
        lit.with_instance(scenes.scene_of(wall)), camera, effects=(), spp=256, max_bounces=24, device="cpu"
    ).pixels
    rays = camera.generate_rays(spp=16)
    one = pane_reflectance(-rays.directions[:, 2].astype(float))
    expected = np.average(2 * one / (1 + one), weights=rays.weights)
    # A binomial choice at each border: 0.08 of 390,000 samples is known to 0.6%; four times that.
    assert dark.mean() / sky.mean() == pytest.approx(expected, rel=0.025)


def test_a_box_of_two_sheets_is_dark_inside() -> None:
    """Sheets a hundred-thousandth of the box apart, in bright light, at the origin and far from it."""
    up, ahead = np.array([0, 1.5, 0]), np.array([0.0, 0, -1])
    for shift in (0.0, 1e6):
        corners, faces = [], []
        for half in (1.0, 1.00001):
            first = 8 * len(corners)
            corners.append(half * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float))
            sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
            faces += [[first + i for i in t] for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]
        white = rc.Material(diffuse=(0.9, 0.9, 0.9))
        place = np.array([shift, 0.3 * shift, -0.2 * shift])
        box = rc.Scene.from_arrays(np.concatenate(corners) + place, faces, materials=[white])
        lit = (
            box.with_environment(1e4)
            .with_sun((0.3, -1, 0.2), (1e5,) * 3)
            .with_point_light(tuple(place + up), (1e4,) * 3)
        )
        camera = scenes.pinhole(FILM, position=tuple(place - 0.5 * ahead), look_at=tuple(place + ahead))
        assert rc.render(lit, camera, effects=(), spp=64, max_bounces=4, device="cpu").pixels.max() == 0
