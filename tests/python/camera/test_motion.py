"""Motion while the shutter is open: streaks against closed forms, and motion against the mean of many stills."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
import realcam as rc

from ..scenes import quad, scene_of, shifted

LENS = rc.Lens.load("tessar-50mm").focused(4.0)
NOTHING = scene_of(quad((0, 0, 50), 1e-3))  # behind the camera
SHUTTER = 0.5  # s


def turned(angle: float) -> np.ndarray:
    """About z."""
    matrix = np.eye(4)
    matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return matrix


def camera(**options: object) -> rc.Camera:
    values = {"exposure_time_s": SHUTTER, "model": "pinhole", "film": rc.Film(36, 24, (96, 64)), **options}
    return rc.Camera(LENS, **values)


def metres_per_pixel(cam: rc.Camera, depth_m: float) -> float:
    """Width of a pixel in a plane at this depth in front of the entrance pupil, on the axis."""
    return 2 * depth_m * np.tan(np.radians(cam.field_of_view_deg.horizontal) / 2) / cam.film.resolution[0]


def pixels_of(scene: rc.Scene, cam: rc.Camera, device: str, spp: int = 256) -> np.ndarray:
    return rc.render(scene, cam, effects=(), spp=spp, device=device).pixels[..., 1].astype(float)


def lit_area(half: float, half_height: float | None = None) -> rc.Scene:
    return scene_of(quad((0, 0, 0), half, half_height, emission=1000))


def pupil_plane(cam: rc.Camera, depth_m: float) -> float:
    """z of the plane at this depth from the entrance pupil."""
    position = cam.entrance_pupil_position_m
    assert position is not None
    return position[2] - depth_m


def test_where_a_camera_is_at_a_time() -> None:
    """It turns by 90 degrees in two seconds, and looks at points that are 2 and 4 m away."""
    cam = camera(motion=[(1, (0, 0, 0), (0, 0, -2)), (3, (1, 1, 0), (5, 1, 0))])
    half = 3 / np.sqrt(2)
    for time_s, position, look_at in (
        (0, (0, 0, 0), (0, 0, -2)),
        (2, (0.5, 0.5, 0), (0.5 + half, 0.5, -half)),
        (9, (1, 1, 0), (5, 1, 0)),
    ):
        np.testing.assert_allclose(cam.pose_at(time_s), (position, look_at, (0, 1, 0)), atol=1e-12)
    still = camera(position=(1, 2, 3), look_at=(0, 0, 1))
    assert still.pose_at(5) == (still.position, still.look_at, still.up)


def test_a_streak_is_as_long_as_its_way(device: str) -> None:
    cam = camera()
    pixel = metres_per_pixel(cam, 2.0)
    z = pupil_plane(cam, 2.0)
    half, ray_direction = 10 * pixel, 16 * pixel
    sign = NOTHING.with_instance(lit_area(half), name="sign")
    scene = sign.moved(
        "sign", [shifted(-ray_direction / 2, 0, z), shifted(ray_direction / 2, 0, z)], times_s=[0, SHUTTER]
    )
    row = pixels_of(scene, cam, device)[28:36].mean(axis=0)
    row /= row[46:50].mean()

    # Share of the exposure during which a point is covered, at the centres of fine subdivisions of each pixel. Errors
    # are the falloff of the field's brightness, 1% here, and the noise of 8 rows of 256 samples.
    place = (np.arange(96 * 64) + 0.5) / 64 - 48
    covered = np.clip(np.minimum(place + 10 + 8, 10 + 8 - place) / 16, 0, 1).reshape(96, 64).mean(axis=1)
    np.testing.assert_allclose(row, covered, atol=0.02)


def test_a_fan_turns_at_an_even_pace_along_arcs(device: str) -> None:
    cam = camera(film=rc.Film(24, 24, (64, 64)))
    pixel, z = metres_per_pixel(cam, 2.0), pupil_plane(cam, 2.0)
    blade = scene_of(quad((14 * pixel, 0, 0), 14 * pixel, 1.5 * pixel, emission=1000))
    scene = NOTHING.with_instance(blade, name="fan")
    angle = np.radians(120)
    scene = scene.moved("fan", [shifted(z=z), shifted(z=z) @ turned(angle)], times_s=[0, SHUTTER])
    picture = pixels_of(scene, cam, device, spp=1024)
    y, x = np.mgrid[31.5:-32.5:-1, -31.5:32.5]
    radius, direction = np.hypot(x, y), np.degrees(np.arctan2(y, x))
    ring = np.abs(radius - 20) < 4
    # At radius r the blade of width 3 subtends an angle of 3 / r and sweeps 120 degrees.
    still = pixels_of(NOTHING.with_instance(lit_area(2), shifted(z=z)), cam, device)
    inside = ring & (direction > 10) & (direction < 110)
    expected = 2 * np.arcsin(1.5 / radius[inside]) / angle
    got = (picture / still)[inside]
    np.testing.assert_allclose(got.mean(), expected.mean(), rtol=0.01)
    for low in range(10, 110, 20):
        part = inside & (direction > low) & (direction < low + 20)
        share = 2 * np.arcsin(1.5 / radius[part]) / angle
        # Noise of a sector: about 90 pixels of 1024 samples, 7% on the blade, give 1.2%.
        assert (picture / still)[part].sum() == pytest.approx(share.sum(), rel=0.05), low
    assert picture[ring & ((direction > 130) | (direction < -12))].max() == 0


def test_a_rolling_shutter_leans_what_passes(device: str) -> None:
    cam = camera(exposure_time_s=1e-4, readout_time_s=0.2)
    pixel, z = metres_per_pixel(cam, 2.0), pupil_plane(cam, 2.0)
    speed = 20 * pixel / 0.2
    scene = NOTHING.with_instance(lit_area(3 * pixel, 60 * pixel), name="pole")
    scene = scene.moved("pole", [shifted(-10 * pixel, 0, z), shifted(-10 * pixel + speed, 0, z)], times_s=[0, 1])
    picture = pixels_of(scene, cam, device)
    middle = (picture * (np.arange(96) + 0.5 - 48)).sum(axis=1) / picture.sum(axis=1)
    # Row k is exposed k / 64 of the readout time later, a moment long.
    np.testing.assert_allclose(middle, -10 + 20 * np.arange(64) / 64, atol=0.05)
    together = pixels_of(scene, cam.replace(readout_time_s=0), device)
    middle = (together * (np.arange(96) + 0.5 - 48)).sum(axis=1) / together.sum(axis=1)
    np.testing.assert_allclose(middle, -10, atol=0.05)


BOX = scene_of(
    quad((0, 0, 0.2), 0.2, diffuse=0.6),
    quad((0.2, 0, 0), 0.2, right=(0, 0, -1), diffuse=(0.7, 0.3, 0.2)),
    quad((0, 0.2, 0), 0.2, up=(0, 0, -1), diffuse=0.4),
)
FLOOR = scene_of(quad((0, -0.4, -3), 6, up=(0, 0, -1), diffuse=0.5))


@pytest.mark.parametrize("model", ["pinhole", "thin", "full"])
def test_a_camera_that_passes_a_scene_sees_what_a_scene_does_that_passes_it(device: str, model: str) -> None:
    world = FLOOR.with_instance(BOX, shifted(0.2, 0, -3)).with_instance(lit_area(0.5), shifted(-1, 1, -4))
    view = camera(model=model, motion=[(0, (0, 0, 0), (0, 0, -1)), (SHUTTER, (0.3, 0.1, -0.2), (0.3, 0.1, -1.2))])
    passing = rc.render(world, view, effects=(), spp=16, device=device)

    parts = NOTHING.with_instance(FLOOR, name="a").with_instance(BOX, shifted(0.2, 0, -3), name="b")
    parts = parts.with_instance(lit_area(0.5), shifted(-1, 1, -4), name="c")
    for name, matrix in parts.instances:
        parts = parts.moved(name, [matrix, shifted(-0.3, -0.1, 0.2) @ matrix], times_s=[0, SHUTTER])
    passed = rc.render(parts, camera(model=model), effects=(), spp=16, device=device)
    # The same samples, but for roundings at edges.
    difference = np.abs(passing.pixels.astype(float) - passed.pixels).max(axis=2) / passing.pixels.max()
    assert (difference > 1e-3).mean() < 0.02
    assert passing.pixels.mean() == pytest.approx(passed.pixels.mean(), rel=1e-3)
    both = np.isfinite(passing.depth) & np.isfinite(passed.depth) & (difference < 1e-4)
    np.testing.assert_allclose(passing.depth[both], passed.depth[both], rtol=1e-3)


def moving_lamp(kind: str) -> rc.Scene:
    if kind == "area":
        lamp = scene_of(quad((0, 0, 0), 0.3, up=(0, 0, 1), emission=(3000, 2000, 1000)))
    else:
        # A light in the plane of a triangle would be hidden along it.
        dark = scene_of(quad((0, 20, 0), 1e-3))
        lamp = dark.with_spot_light((0, 0, 0), (0.3, -1, 0), (2000, 1000, 500), outer_cone_deg=40)
    return FLOOR.with_instance(BOX, shifted(0.2, 0, -3), name="box").with_instance(lamp, name="lamp")


@pytest.mark.parametrize("kind", ["area", "spot"])
def test_a_picture_of_motion_is_the_mean_of_stills(device: str, kind: str) -> None:
    keys = [shifted(-1, 1.2, -3), shifted(1.5, 0.8, -2.5) @ turned(0.8)]
    scene = moving_lamp(kind).moved("lamp", keys, times_s=[0, SHUTTER])
    scene = scene.moved("box", [shifted(0.2, 0, -3), shifted(0.5, 0.2, -3) @ turned(0.5)], times_s=[0, SHUTTER])
    cam = camera(model="thin", film=rc.Film(36, 24, (24, 16)))
    moving = rc.render(scene, cam, effects=(), spp=4096, max_bounces=1, device=device).pixels.astype(float)
    times = (np.arange(64) + 0.5) / 64 * SHUTTER
    stills = np.mean(
        [
            rc.render(scene.at_time(t), cam, effects=(), spp=128, max_bounces=1, seed=i, device=device).pixels
            for i, t in enumerate(times)
        ],
        axis=0,
        dtype=float,
    )
    # Means of 64 moments by the midpoint rule; noise of either picture some 1% of a pixel.
    assert moving.mean() == pytest.approx(stills.mean(), rel=5e-3)
    np.testing.assert_allclose(moving, stills, atol=0.06 * stills.max())
    assert np.abs(moving - stills).mean() < 0.015 * stills.mean() + 0.004 * stills.max()


def test_what_stands_while_the_shutter_is_open_costs_no_sharpness(device: str) -> None:
    scene = FLOOR.with_instance(BOX, name="box").with_instance(lit_area(0.5), shifted(-1, 1, -4))
    moving = scene.moved("box", [shifted(0, 0, -3), shifted(1, 0, -3)], times_s=[5, 6])
    cam = camera()
    before = rc.render(moving, cam, effects=(), spp=4, device=device)
    assert np.array_equal(before.pixels, rc.render(moving.at_time(0), cam, effects=(), spp=4, device=device).pixels)
    after = rc.render(moving, cam.replace(shutter_opens_s=7), effects=(), spp=4, device=device)
    assert np.array_equal(after.pixels, rc.render(moving.at_time(6), cam, effects=(), spp=4, device=device).pixels)


def test_a_session_begins_anew_where_the_time_matters(device: str) -> None:
    still = FLOOR.with_instance(BOX, shifted(0, 0, -3), name="box").with_environment(500)
    moving = still.moved("box", [shifted(0, 0, -3), shifted(1, 0, -3)], times_s=[0, 1])
    cam = camera()
    session = rc.Session(still, cam, device=device, effects=())
    session.add(4)
    session.set(camera=cam.replace(exposure_time_s=0.1, shutter_opens_s=0.3))
    assert session.image().spp == 4
    session.set(scene=moving)
    session.add(4)
    early = session.image().pixels
    session.set(camera=cam.replace(shutter_opens_s=0.4))
    session.add(4)
    late = session.image().pixels
    direct = rc.render(moving, cam.replace(shutter_opens_s=0.4), effects=(), spp=4, device=device).pixels
    np.testing.assert_allclose(late, direct, rtol=1e-6)  # a GPU adds the same samples in another order
    assert np.abs(late - early).max() > 0.1 * early.mean()


@pytest.mark.parametrize("model", ["pinhole", "thin", "thick", "full"])
def test_motion_vectors_lead_from_where_a_thing_was_to_where_it_will_be(device: str, model: str) -> None:
    """A chessboard of cards with an id each, seen with a short exposure at the begin and at the end."""
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    cam = rc.Camera(lens, model=model, film=rc.Film(36, 24, (240, 160)), exposure_time_s=SHUTTER)
    z = pupil_plane(cam, 2.0)
    scene = NOTHING
    begin, end = shifted(-0.1, 0.05, z) @ turned(0.2), shifted(0.15, -0.05, z + 0.1) @ turned(-0.1)
    for i in range(-3, 4):
        for k in range(-2, 3):
            card = shifted(0.2 * i, 0.2 * k)
            name = f"{i} {k}"
            scene = scene.with_instance(lit_area(0.05), name=name)
            scene = scene.moved(name, [begin @ card, end @ card], times_s=[0, SHUTTER])
    motion = rc.render(scene, cam, effects=(), spp=1, layers=["motion", "object_id"], device=device).layers

    def centers(time: float) -> dict[int, np.ndarray]:
        still = cam.replace(exposure_time_s=1e-6, shutter_opens_s=time)
        ids = rc.render(scene, still, effects=(), spp=1, layers=["object_id"], device=device).layers["object_id"]
        rows, columns = np.mgrid[0:160, 0:240]
        inner = [i for i in np.unique(ids) if i > 1]
        whole = [i for i in inner if not (np.isin(i, ids[[0, -1]]) or np.isin(i, ids[:, [0, -1]]))]
        return {i: np.array([columns[ids == i].mean(), rows[ids == i].mean()]) for i in whole}

    first, last = centers(0), centers(SHUTTER - 1e-6)
    compared = 0
    for i in set(first) & set(last):
        vectors = motion["motion"][motion["object_id"] == i]
        if len(vectors) < 60:
            continue
        compared += 1
        # Middles of some hundred pixels with ragged edges: a tenth of a pixel. In perspective a card's middle is not
        # the middle of its picture, by half a pixel times the change of its size, 5%.
        np.testing.assert_allclose(vectors.mean(axis=0), last[i] - first[i], atol=0.2)
    assert compared >= 12
    assert (motion["motion"][motion["object_id"] == 0] == 0).all()


def test_motion_vectors_of_a_turning_camera(device: str) -> None:
    angle = 0.02
    keys = [(0, (0, 0, 0), (0, 0, -1)), (SHUTTER, (0, 0, 0), (np.sin(angle), 0, -np.cos(angle)))]
    wall = scene_of(quad((0, 0, -1000), 2000, 100, emission=1))  # the sky above and below
    image = rc.render(wall, camera(motion=keys), effects=(), spp=1, layers=["motion"], device=device)
    x = np.arange(96) + 0.5 - 48
    pixel = metres_per_pixel(camera(), 1.0)
    expected = (np.tan(np.arctan(x * pixel) - angle / 2) - np.tan(np.arctan(x * pixel) + angle / 2)) / pixel
    motion = image.layers["motion"]
    # The camera turns to the right, so the picture goes to the left; of 1 mm in 1 km nothing is to be seen.
    expected = -np.abs(expected)
    inside = slice(4, -4)
    np.testing.assert_allclose(motion[32, inside, 0], expected[inside], rtol=2e-3)
    np.testing.assert_allclose(motion[2, inside, 0], motion[61, inside, 0], rtol=1e-3)


def test_parts_go_with_their_whole_along_arcs() -> None:
    car = BOX.with_instance(BOX, shifted(2, 0, 0), name="wheel")
    scene = NOTHING.with_instance(car, name="car").moved("car", [np.eye(4), turned(2.0)], times_s=[0, 1])
    for time in np.linspace(0, 1, 23):
        matrices = dict(scene.at_time(time).instances)
        np.testing.assert_allclose(matrices["car"], turned(2 * time), atol=1e-12)
        # Keys of the part stand as dense as 1e-5 of lengths of 3 m, its axes' in all, wants.
        np.testing.assert_allclose(matrices["car/wheel"], turned(2 * time) @ shifted(2, 0, 0), atol=5e-5)
    ended = scene.moved("car", np.eye(4))
    assert ended.motions == (None, None)
    np.testing.assert_allclose(dict(ended.instances)["car/wheel"], shifted(2, 0, 0), atol=1e-12)


def test_motion_is_a_part_of_the_values() -> None:
    scene = NOTHING.with_instance(BOX, name="box")
    moving = scene.moved("box", [np.eye(4), shifted(1, 0, 0)], times_s=[0, 1])
    assert moving != scene
    assert pickle.loads(pickle.dumps(moving)) == moving == copy.deepcopy(moving)
    times, matrices = moving.motions[0] or ((), np.empty(0))
    assert times == (0, 1)
    assert matrices.shape == (2, 4, 4)
    keys = [(0, (0, 0, 0), (0, 0, -1)), (1, (1, 0, 0), (1, 0, -1), (0, 1, 0))]
    cam = camera(motion=keys, shutter_opens_s=0.25, readout_time_s=0.125)
    assert pickle.loads(pickle.dumps(cam)) == cam
    assert cam.motion == ((0, (0, 0, 0), (0, 0, -1), (0, 1, 0)), (1, (1, 0, 0), (1, 0, -1), (0, 1, 0)))
    assert (cam.shutter_opens_s, cam.readout_time_s) == (0.25, 0.125)
    assert cam.position == (0, 0, 0)
    assert cam.replace(iso=200).motion == cam.motion
    assert cam.replace(position=(3, 0, 0)).motion == ()
    assert cam.replace(motion=[]).position == (0, 0, 0)


@pytest.mark.parametrize(
    ("transforms", "times", "required"),
    [
        ([np.eye(4)], [0, 1], "as many transforms as times"),
        ([np.eye(4)] * 2, [1, 1], "the times must be strictly increasing"),
        ([np.eye(4)] * 2, [0, np.nan], "within 1e9 s"),
        ([np.eye(4), np.diag([1, 1, 0, 1])], [0, 1], r'instance 0 \("box"\): key 1 of its motion: .* flat'),
        ([np.eye(4), np.diag([1, 1, -1, 1])], [0, 1], "mirror"),
    ],
)
def test_what_is_no_motion_is_refused(transforms: list[np.ndarray], times: list[float], required: str) -> None:
    with pytest.raises(rc.InputError, match=required):
        NOTHING.with_instance(BOX, name="box").moved("box", transforms, times_s=times)


def test_what_is_no_motion_of_a_camera_is_refused() -> None:
    for words, message in (
        (
            {"motion": [(0, (0, 0, 0), (0, 0, -1))] * 2},
            "key 1 of the camera's motion: the times must be strictly increasing",
        ),
        ({"motion": [(0, (0, 0, 0), (0, 0, 0))]}, "key 0 of the camera's motion: the camera must look"),
        ({"readout_time_s": -1}, "readout"),
        ({"shutter_opens_s": np.inf}, "shutter opens"),
    ):
        with pytest.raises(rc.InputError, match=message):
            camera(**words)


def test_a_wheel_that_turns_too_fast_is_refused() -> None:
    times = np.arange(400) * SHUTTER / 399
    scene = NOTHING.with_instance(BOX, name="wheel")
    scene = scene.moved("wheel", [turned(2.5 * k) for k in range(400)], times_s=list(times))
    with pytest.raises(rc.InputError, match=r'"wheel"\): turns too fast'):
        rc.render(scene.with_environment(1), camera(), effects=(), spp=1, device="cpu")
    keys = [(k / 100, (0, 0, 0), (np.cos(2.5 * k), 0, np.sin(2.5 * k))) for k in range(100)]
    with pytest.raises(rc.InputError, match="the camera turns too fast"):
        rc.render(NOTHING.with_environment(1), camera(motion=keys, exposure_time_s=1), effects=(), spp=1, device="cpu")
