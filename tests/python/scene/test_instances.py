"""Instances in a scene: the same picture as of the same triangles, each transformed by numpy."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from ..scenes import quad, scene_of

LENS = rc.Lens.load("tessar-50mm").focused(4.0)
LAMP = rc.Material(diffuse=(0.1, 0.1, 0.1), emission=(4000, 3500, 3000))
PAINT = rc.Material(diffuse=(0.3, 0.6, 0.4), specular=(0.3, 0.3, 0.3), shininess=30)
TEXTURE = np.random.default_rng(1).integers(60, 255, (16, 16, 4), dtype=np.uint8)

Mesh = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def camera(**options: object) -> rc.Camera:
    view = {"position": (0, 1, 3), "look_at": (0, 0.5, -1), **options}
    return rc.Camera(LENS, film=rc.Film(36, 24, (72, 48)), **view)


def ball(rings: int = 8) -> Mesh:
    """Vertices, triangles, smooth normals and texture coordinates of an egg."""
    polar, turn = np.meshgrid(np.linspace(0.1, 3.0, rings), np.linspace(0, 2 * np.pi, 2 * rings), indexing="ij")
    normals = np.stack([np.sin(polar) * np.cos(turn), np.cos(polar), np.sin(polar) * np.sin(turn)], -1).reshape(-1, 3)
    a = (np.arange(rings - 1)[:, None] * 2 * rings + np.arange(2 * rings - 1)).ravel()
    right, below = a + 1, a + 2 * rings
    triangles = np.concatenate([np.stack([a, right, below], -1), np.stack([right, below + 1, below], -1)])
    return 0.4 * normals * (1, 1.5, 1), triangles, normals, np.stack([turn, polar], -1).reshape(-1, 2)


def as_scene(mesh: Mesh, matrix: np.ndarray | None = None, material: rc.Material = PAINT) -> rc.Scene:
    vertices, triangles, normals, uvs = mesh
    if matrix is not None:
        linear = matrix[:3, :3]
        vertices = vertices @ linear.T + matrix[:3, 3]
        normals = normals @ np.linalg.inv(linear)
        normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        if np.linalg.det(linear) < 0:  # what was outside still is
            triangles = triangles[:, [0, 2, 1]]
    scene = rc.Scene.from_arrays(vertices, triangles, normals=normals, uvs=uvs, materials=[material])
    return scene.with_texture(0, TEXTURE)


def placed(x: float, y: float, z: float, *, turn: float = 0.0, scale: float | tuple[float, ...] = 1.0) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = [[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]]
    matrix[:3, :3] = matrix[:3, :3] @ np.diag(np.broadcast_to(scale, 3))
    matrix[:3, 3] = x, y, z
    return matrix


GROUND = scene_of(
    quad((0, 0, 0), 30, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5),
    quad((0, 4, -2), 1, right=(1, 0, 0), up=(0, 0, 1), emission=5000),
).with_environment((200, 250, 300))

TRANSFORMS = [
    placed(-1.2, 0.6, -1, turn=0.4),
    placed(0.1, 0.9, -1.5, turn=2, scale=1.5),
    placed(1.2, 0.4, -0.5, scale=(-0.7, 0.7, 0.7)),
]


def union(scenes: list[rc.Scene]) -> rc.Scene:
    """The ground with scenes that stand where they are: the identity has no roundings."""
    whole = GROUND
    for scene in scenes:
        whole = whole.with_instance(scene)
    return whole


def picture(scene: rc.Scene, device: str, spp: int = 16, **more: object) -> rc.Image:
    return rc.render(scene, camera(), effects=(), spp=spp, device=device, **more)


def hold_same(one: rc.Scene, other: rc.Scene, device: str, **more: object) -> None:
    """Pictures of both, but for roundings, and for samples that pass an edge within them: those change their pixel by a
    share."""
    a, b = (picture(scene, device, **more) for scene in (one, other))
    difference = np.abs(a.pixels.astype(float) - b.pixels).max(axis=2) / (a.pixels.max(axis=2) + 1e-9)
    assert (difference > 1e-3).mean() < 0.01
    assert np.median(difference) < 1e-5
    assert a.pixels.mean() == pytest.approx(b.pixels.mean(), rel=1e-3)
    depth = np.isfinite(a.depth) & np.isfinite(b.depth) & (difference < 1e-3)
    np.testing.assert_allclose(a.depth[depth], b.depth[depth], rtol=1e-5)


def test_instances_look_like_their_triangles(device: str) -> None:
    objects = GROUND
    for matrix in TRANSFORMS:
        objects = objects.with_instance(as_scene(ball()), matrix)
    triangles = union([as_scene(ball(), matrix) for matrix in TRANSFORMS])
    hold_same(objects, triangles, device, spp=32, max_bounces=2)
    assert objects.triangle_count == triangles.triangle_count == GROUND.triangle_count + 3 * len(ball()[1])


def test_an_object_may_be_all_there_is_to_see(device: str) -> None:
    vertices, triangles, normals, _ = ball()
    whole = rc.Scene.from_arrays(vertices + np.array([0, 0.7, -1]), triangles, normals=normals, materials=[PAINT])
    alone = whole.with_environment(1000)
    behind = scene_of(quad((0, 0, 1e4), 1)).with_environment(1000).with_instance(whole)
    hold_same(behind, alone, device)


@pytest.mark.parametrize("scale", [1.0, (0.2, 3.0, 1.0), (-1.0, 1.0, 0.5)], ids=str)
def test_lamps_shine_where_they_stand(device: str, scale: float | tuple[float, ...]) -> None:
    dark = scene_of(quad((0, 0, 0), 30, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5))
    matrix = placed(0.3, 1.5, -1, turn=0.7, scale=scale)
    by_object = dark.with_instance(as_scene(ball(5), material=LAMP), matrix)
    by_triangles = dark.with_instance(as_scene(ball(5), matrix, material=LAMP))
    a, b = (picture(scene, device, 64, max_bounces=1).pixels.mean() for scene in (by_object, by_triangles))
    # Mirrored corners are in another order, and so points on the lamp are others: the same in the mean of 2e5 samples.
    assert a == pytest.approx(b, rel=1e-2)
    assert a > 0
    if np.linalg.det(matrix[:3, :3]) > 0:
        hold_same(by_object, by_triangles, device, spp=64, max_bounces=1)
    assert by_object.has_light


def test_a_point_light_moves_with_its_object(device: str) -> None:
    """Irradiance below a lamp at a height h: I / h^2."""
    lamp = scene_of(quad((0, 0, 5000), 1)).with_point_light((0, 0.5, 0), (100, 100, 100))
    floor = scene_of(quad((0, 0, 0), 50, right=(1, 0, 0), up=(0, 0, -1), diffuse=1.0))
    above = rc.Camera(LENS, film=rc.Film(0.36, 0.24, (6, 4)), position=(0, 4, 0), look_at=(0, 0, 0), up=(0, 0, -1))
    pictures = []
    for height in (1.0, 2.0):
        scene = floor.with_instance(lamp, placed(0, height - 1.0, 0, scale=2))
        options = {"spp": 16, "max_bounces": 0, "light_tracing": "off"}  # which leaves the lamp itself out
        pictures.append(rc.render(scene, above, effects=(), device=device, **options).pixels.mean())
    assert pictures[0] / pictures[1] == pytest.approx(4, rel=1e-3)


def test_a_moved_object_is_where_it_was_put(device: str) -> None:
    scene = GROUND
    for i, matrix in enumerate(TRANSFORMS):
        scene = scene.with_instance(as_scene(ball(), material=LAMP), matrix, name=f"egg {i}")
    picture(scene, device)
    where = placed(0.5, 1.2, 0, turn=1)
    anew = GROUND
    for matrix in (TRANSFORMS[0], where, TRANSFORMS[2]):
        anew = anew.with_instance(as_scene(ball(), material=LAMP), matrix)
    hold_same(scene.moved("egg 1", where), anew, device)
    # The scene itself has stayed what it was.
    np.testing.assert_array_equal(scene.instances[1][1], TRANSFORMS[1])
    assert [name for name, _ in scene.instances] == ["egg 0", "egg 1", "egg 2"]


def test_a_plain_as_an_object_is_as_exact_as_the_ground(device: str) -> None:
    """1e7 m wide, 1.5 m below a camera far from every origin: in float corners it would float half a metre off."""
    plain = scene_of(quad((0, 0, 0), 1e7, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5)).with_environment(1000)
    base = scene_of(quad((0, 0, 1e11), 1)).with_environment(1000)
    far = np.array([3e6, 0.0, 4e6])
    scene = base.with_instance(plain, placed(1e6, 0, 0, turn=0.3), name="plain")
    above = camera(position=far + np.array([0, 1.5, 0]), look_at=far + np.array([0, 0, -3]))
    for moved, height in ((scene, 1.5), (scene.moved("plain", placed(1e6 + 1e5, 0.25, 0, turn=0.3)), 1.25)):
        depth = rc.render(moved, above, effects=(), spp=4, device=device).depth
        middle = depth[depth.shape[0] // 2 - 1 : depth.shape[0] // 2 + 1].mean()
        # Along the axis, which goes down by 1.5 in 3.
        expected = height / (1.5 / np.hypot(3, 1.5))
        assert middle == pytest.approx(expected, rel=2e-3)
        assert np.isfinite(depth[depth.shape[0] // 2 :]).all()


def test_a_plain_that_stands_twice_near_the_camera(device: str) -> None:
    """No sun through a roof that is an instance of the same plain as the floor: each is exact at its own position."""
    plain = scene_of(quad((0, 0, 0), 1e7, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5))
    sun = scene_of(quad((0, 0, 1e11), 1)).with_sun((0.3, -1, 0), (8e4, 8e4, 8e4))
    between = rc.Camera(
        LENS, film=rc.Film(36, 24, (72, 48)), position=(0, 0.6, 1.5), look_at=(0, 0.1, 0), model="pinhole"
    )
    roofed = sun.with_instance(plain, [placed(1e6, 0, 0), placed(0, 0.75, 0)])
    assert rc.render(roofed, between, effects=(), spp=16, device=device, max_bounces=0).pixels.max() == 0


@pytest.mark.parametrize("size", [1e3, 1e6])
def test_a_floor_made_by_scale_takes_shadows(device: str, size: float) -> None:
    def scene_with_floor(half: float, scale: float) -> rc.Scene:
        floor = scene_of(quad((0, 0, 0), half, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5))
        panel = scene_of(quad((0, 0.2, 0), 0.2, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.2))
        scene = panel.with_environment((300, 300, 300)).with_sun((0.3, -1, 0.1), (8e4, 8e4, 8e4))
        place = placed(0.3, 0, 0.1, scale=scale)
        return scene.with_instance(floor, place)

    hold_same(scene_with_floor(1.0, size), scene_with_floor(size, 1.0), device, spp=32)


@pytest.mark.parametrize("unit", [1e-6, 1e5])
def test_objects_in_other_units(device: str, unit: float) -> None:
    """Smooth normals and textures need points within triangles as precise as the object's unit, even micrometres."""
    vertices, triangles, normals, uvs = ball(16)
    small = as_scene((vertices * unit, triangles, normals, uvs))
    expected = GROUND.with_instance(as_scene(ball(16)), placed(0, 0.7, -1))
    hold_same(GROUND.with_instance(small, placed(0, 0.7, -1, scale=1 / unit)), expected, device)


def test_a_speck_and_a_giant_share_an_object(device: str) -> None:
    vertices, triangles, normals, uvs = ball(16)
    small = as_scene((vertices * 1e-6, triangles, normals, uvs))
    whole = GROUND.with_instance(small, [placed(0, 0.01, -1, scale=1e2), placed(0.3, 0.7, -1, scale=5e5)], name="egg")
    grown = whole.moved("egg 0", placed(-0.5, 0.7, -1, scale=1e6))
    expected = GROUND.with_instance(as_scene(ball(16)), placed(0.3, 0.7, -1, scale=0.5))
    hold_same(whole, expected, device)
    hold_same(grown, expected.with_instance(as_scene(ball(16)), placed(-0.5, 0.7, -1)), device)


@pytest.mark.parametrize("ratio", [30.0, 1000.0])
def test_a_body_that_is_long_and_thin_in_its_own_frame(device: str, ratio: float) -> None:
    vertices, triangles, normals, uvs = ball()
    stretch = np.array([ratio, 1 / ratio, 1])
    thin = as_scene((vertices / stretch, triangles, normals * stretch, uvs), material=LAMP)
    back = placed(0.2, 0.7, -1, turn=0.5, scale=tuple(stretch))
    plain = as_scene(ball(), placed(0.2, 0.7, -1, turn=0.5), LAMP)
    hold_same(GROUND.with_instance(thin, back), union([plain]), device, spp=32)


@pytest.mark.parametrize("ratio", [1.0, 50.0])
def test_no_light_leaves_a_closed_lantern(device: str, ratio: float) -> None:
    """Lamps that shine into a box, whose walls and margins are those of a plate and a rod in its own frame."""
    walls = []
    for axis in np.eye(3):
        for n in (axis, -axis):  # outwards; right x up points in
            right = np.roll(n, 1)
            walls.append(quad(0.5 * n, 0.5, right=right, up=np.cross(-n, right), emission=5000))
    stretch = np.array([ratio, 1 / ratio, 1])
    flat = [(corners / stretch, material) for corners, material in walls]
    floor = scene_of(quad((0, 0, 0), 30, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5))
    lantern = placed(0.1, 0.7, -1, turn=0.5, scale=tuple(stretch))
    outside = picture(floor.with_instance(scene_of(*flat), lantern), device, 64, max_bounces=1)
    # A part in 1e4 of what the same walls give when they shine outwards; rays through edges are of that order.
    turned = [(corners[[0, 3, 2, 1]], material) for corners, material in flat]
    shining = picture(floor.with_instance(scene_of(*turned), lantern), device, 64, max_bounces=1)
    assert shining.pixels.mean() > 0
    assert outside.pixels.mean() < 1e-4 * shining.pixels.mean()


def test_a_large_object_that_comes_near_is_placed_anew(device: str) -> None:
    plain = scene_of(quad((0, 0, 0), 1e6, right=(1, 0, 0), up=(0, 0.2, -1), diffuse=0.5))
    sky = scene_of(quad((0, 0, 1e11), 1)).with_environment(1000)
    for near in (placed(0, -0.3, 0), placed(3e4, 5e3, -7e4, turn=0.1)):
        far = sky.with_instance(plain, placed(0, -1.5e6, 0), name="plain")
        picture(far, device)
        hold_same(far.moved("plain", near), sky.with_instance(plain, near), device)


def test_objects_of_objects(device: str) -> None:
    hat = placed(0, 0.9, 0, scale=0.5)
    pair = as_scene(ball()).with_instance(as_scene(ball()), hat, name="hat")
    scene = GROUND.with_instance(pair, TRANSFORMS[0], name="egg")
    assert [name for name, _ in scene.instances] == ["egg", "egg/hat"]
    assert [name for name, _ in GROUND.with_instance(pair).instances] == ["", "hat"]
    # One that moves takes its parts along.
    for whole, place in ((scene, TRANSFORMS[0]), (scene.moved("egg", TRANSFORMS[1]), TRANSFORMS[1])):
        flat = union([as_scene(ball(), place), as_scene(ball(), place @ hat)])
        hold_same(whole, flat, device)


def test_many_instances_share_their_triangles(device: str) -> None:
    scene, egg = GROUND, as_scene(ball())
    vertices, triangles, normals, uvs = ball()
    places = [placed(i % 20 - 10, 0.1, -(i // 20), scale=0.2) for i in range(400)]
    scene = scene.with_instance(egg, places, name="egg")
    assert [name for name, _ in scene.instances[::399]] == ["egg 0", "egg 399"]
    one_mesh = (
        np.concatenate([vertices @ place[:3, :3].T + place[:3, 3] for place in places]),
        np.concatenate([triangles + i * len(vertices) for i in range(400)]),
        np.tile(normals, (400, 1)),
        np.tile(uvs, (400, 1)),
    )
    hold_same(scene, union([as_scene(one_mesh)]), device)


def test_bounds_and_focus_know_of_objects() -> None:
    scene = scene_of(quad((0, 0, -50), 1)).with_instance(scene_of(quad((0, 0, 0), 0.5)), placed(0, 0, -5, scale=4))
    np.testing.assert_allclose(scene.bounds_m, [(-2, -2, -50), (2, 2, -5)], atol=1e-12)
    focused = rc.Camera(LENS).framing(scene, position=(0, 0, 0), look_at=(0, 0, -1))
    assert focused.lens.focus_distance_m == pytest.approx(5)


@pytest.mark.parametrize(
    ("place", "says"),
    [
        (np.eye(3), r"shape \(4, 4\)"),
        (np.ones((4, 4)), "last row"),
        ([[1, 1, 0, 0], [0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], r'instance 0 \("egg"\).*flat'),
        (np.diag([1, 1, 0, 1]), "flat"),
        (placed(np.nan, 0, 0), "finite"),
        (np.zeros((0, 4, 4)), "holds no matrix"),
    ],
)
def test_invalid_transforms_are_refused(place: object, says: str) -> None:
    with pytest.raises(rc.InputError, match=says):
        GROUND.with_instance(as_scene(ball()), place, name="egg")


@pytest.mark.parametrize(
    ("which", "place", "says"),
    [
        (2, np.eye(4), "no instance 2; the scene has 2"),
        (-1, np.eye(4), "no instance -1"),
        ("eg", np.eye(4), 'no instance "eg"'),
        (np.int64(1), [np.eye(4), np.eye(4)], "must be a single matrix"),
    ],
)
def test_an_instance_that_cannot_be_moved_is_told(which: object, place: object, says: str) -> None:
    scene = GROUND.with_instance(as_scene(ball()), name="egg").with_instance(as_scene(ball()), name="egg")
    with pytest.raises(rc.InputError, match=says):
        scene.moved(which, place)


def positions_of(scene: rc.Scene) -> dict[str, list[float]]:
    """Position of each instance's origin."""
    return {name: list(matrix[:3, 3]) for name, matrix in scene.instances}


CAR = as_scene(ball()).with_instance(as_scene(ball()), placed(1, 0, 0), name="wheel")


def test_an_instance_takes_its_own_parts_along_and_no_others() -> None:
    scene = GROUND.with_instance(CAR, name="car").with_instance(CAR, placed(10, 0, 0), name="car")
    # A name that only looks like that of a part.
    scene = scene.with_instance(as_scene(ball()), placed(5, 0, 0), name="car/flag")
    assert list(positions_of(scene)) == ["car", "car/wheel", "car.2", "car.2/wheel", "car/flag"]
    moved = positions_of(scene.moved(0, placed(0, 0, 3)))
    assert moved["car"] == [0, 0, 3]
    assert moved["car/wheel"] == [1, 0, 3]
    assert [moved[name][0] for name in ("car.2", "car.2/wheel", "car/flag")] == [10, 11, 5]
    assert positions_of(scene.moved("car", placed(0, 0, 3))) == moved
    assert positions_of(scene.moved("car.2", placed(20, 0, 0)))["car.2/wheel"] == [21, 0, 0]


def test_parts_of_parts_move_with_the_whole_and_without_a_name() -> None:
    train = as_scene(ball()).with_instance(CAR, placed(0, 0, 2))
    scene = GROUND.with_instance(train).with_instance(train, placed(7, 0, 0))
    moved = scene.moved(3, placed(7, 4, 0))
    assert [list(matrix[:3, 3]) for _, matrix in moved.instances] == [
        [0, 0, 0], [0, 0, 2], [1, 0, 2], [7, 4, 0], [7, 4, 2], [8, 4, 2]
    ]  # fmt: skip
    # A part that was moved on its own stays where it was put in the whole.
    apart = positions_of(
        GROUND.with_instance(CAR, name="car").moved("car/wheel", placed(0, 5, 0)).moved("car", placed(3, 0, 0))
    )
    assert apart["car/wheel"] == [3, 5, 0]


def test_names_stay_distinct() -> None:
    egg = as_scene(ball())
    scene = GROUND
    for name in ("egg", "egg.2", "egg", "egg", ""):
        scene = scene.with_instance(egg, name=name)
    scene = scene.with_instance(egg, [placed(0, 0, 0), placed(1, 0, 0)], name="nest").with_instance(egg, name="nest 1")
    assert [name for name, _ in scene.instances] == [
        "egg", "egg.2", "egg.3", "egg.4", "", "nest 0", "nest 1", "nest 1.2"
    ]  # fmt: skip
