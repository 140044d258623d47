"""Layers of a picture against closed forms: what lies at a known distance and slant, and who it is."""

from __future__ import annotations

import copy
import math
import pickle
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

ALL = (
    "depth",
    "normal",
    "albedo",
    "circle_of_confusion_mm",
    "sample_count",
    "variance",
    "depth_middle",
    "normal_middle",
    "object_id",
    "material_id",
    "motion",
    "position_middle",
    "traced_light",
)
NUMBERS = ("sample_count", "object_id", "material_id")
THREE = ("normal", "albedo", "variance", "normal_middle", "position_middle", "traced_light")
FILM = rc.Film(24, 16, (24, 16))
SLANT = np.array([0.6, 0.0, 0.8])


def lens(focus_m: float = 2.0) -> rc.Lens:
    return rc.Lens.load("double-gauss-50mm").focused(focus_m)


def camera(model: str = "full", film: rc.Film = FILM, focus_m: float = 2.0, **more: object) -> rc.Camera:
    return rc.Camera(lens(focus_m), film=film, model=model, **{"exposure_time_s": 1, **more})


def slanted_wall(size: float = 50.0) -> rc.Scene:
    """Through (0, 0, -3), turned about the vertical."""
    wall = scenes.quad((0, 0, -3), size, right=(0.8, 0, -0.6), diffuse=(0.7, 0.4, 0.1))
    return scenes.scene_of(wall).with_environment(1.0)


def two_walls() -> rc.Scene:
    """The right half at 1 m, the left half at 3 m."""
    near, far = scenes.quad((5, 0, -1), 5, diffuse=0.9), scenes.quad((0, 0, -3), 50, diffuse=0.1)
    return scenes.scene_of(near, far).with_environment(1.0)


def middle_points(taken_by: rc.Camera) -> np.ndarray:
    """(H, W, 2): slopes x and y over the distance, of the pinhole's rays through the middles of the pixels."""
    rays = taken_by.replace(film=taken_by.film.replace(resolution=(24 * 64, 16 * 64))).generate_rays(spp=1)
    slopes = (rays.directions[:, :2] / -rays.directions[:, 2:]).reshape(16, 64, 24, 64, 2)
    return slopes.mean(axis=(1, 3))


def test_every_layer_has_its_shape_and_type(device: str) -> None:
    image = rc.render(two_walls(), camera(), effects=(), spp=4, layers="all", device=device)
    assert tuple(image.layers) == ALL
    for name, array in image.layers.items():
        assert array.shape == (16, 24) + ((3,) if name in THREE else (2,) if name == "motion" else ()), name
        assert array.dtype == (np.uint32 if name in NUMBERS else np.float32), name
    assert image.layers["depth"] is image.depth
    assert (image.layers["sample_count"] == 4).all()


@pytest.mark.parametrize("names", [(), ("depth",), ("normal", "variance"), ["object_id"], "albedo"])
def test_only_what_is_asked_for_is_there_and_the_picture_is_the_same(names: object, device: str) -> None:
    plain = rc.render(two_walls(), camera(), effects=(), spp=4, device=device)
    image = rc.render(two_walls(), camera(), effects=(), spp=4, layers=names, device=device)  # type: ignore[arg-type]
    assert set(image.layers) == ({names} if isinstance(names, str) else set(names))  # type: ignore[arg-type]
    np.testing.assert_array_equal(image.pixels, plain.pixels)
    np.testing.assert_array_equal(image.depth, plain.depth)
    assert plain.layers == {}


def test_a_name_that_is_none() -> None:
    for wrong in ("colour", "", "depth,normal"):
        with pytest.raises(rc.InputError, match=r"unknown layer.*all, or some of depth, normal"):
            rc.render(two_walls(), camera(), effects=(), spp=1, layers=[wrong])
    with pytest.raises(rc.InputError, match="unknown layer"):
        rc.Session(two_walls(), camera(), layers="colour", effects=())


def test_a_slanted_plane(device: str) -> None:
    taken_by = camera("pinhole")
    image = rc.render(slanted_wall(), taken_by, effects=(), spp=64, layers="all", device=device)
    slopes = middle_points(taken_by)
    pupil = -taken_by.entrance_pupil_position_m[2]
    # (x, y, -z) = s (slope_x, slope_y, 1) behind the pupil, on n . p = n_z * -3.
    distance = (3 - pupil) * SLANT[2] / (SLANT[2] - SLANT[0] * slopes[..., 0])
    # Slopes are means over 64 x 64 random points in a pixel: to 1% of its width, 1e-4 of the distance at this slant.
    np.testing.assert_allclose(image.layers["depth_middle"], pupil + distance, rtol=2e-4)
    # Over a pixel the distance changes by 1% of itself; the mean of 64 stratified samples is nearer to the middle's.
    np.testing.assert_allclose(image.layers["depth"], pupil + distance, rtol=2e-3)
    # On the plane to float32, and where its own depth is.
    position = image.layers["position_middle"]
    np.testing.assert_allclose(position @ SLANT, SLANT[2] * -3, atol=2e-6)
    np.testing.assert_allclose(-position[..., 2], image.layers["depth_middle"], rtol=1e-6)
    for name in ("normal", "normal_middle"):
        np.testing.assert_allclose(image.layers[name], np.broadcast_to(SLANT, (16, 24, 3)), atol=1e-6)
    np.testing.assert_allclose(
        image.layers["albedo"], np.broadcast_to(np.float32([0.7, 0.4, 0.1]), (16, 24, 3)), rtol=1e-6
    )


def test_normals_are_on_the_side_of_the_camera_and_in_the_axes_of_the_scene(device: str) -> None:
    behind = scenes.scene_of(scenes.quad((0, 0, -3), 50, right=(-0.8, 0, 0.6), diffuse=0.5)).with_environment(1.0)
    turned = camera("pinhole", position=(0, 0, 0), look_at=(0.2, 0.1, -3), up=(1, 1, 0))
    for taken_by in (camera(), turned):
        image = rc.render(behind, taken_by, effects=(), spp=4, layers=["normal", "normal_middle"], device=device)
        for normals in image.layers.values():
            np.testing.assert_allclose(normals, np.broadcast_to(SLANT, (16, 24, 3)), atol=1e-6)


def test_an_instance_that_is_stretched_has_its_own_normals(device: str) -> None:
    card = scenes.scene_of(scenes.quad((0, 0, 0), 50, right=(0.8, 0, -0.6), diffuse=0.5))
    matrix = np.diag([1.0, 1.0, 2.0, 1.0])
    matrix[2, 3] = -3
    scene = scenes.scene_of(scenes.quad((0, 0, 9), 1)).with_environment(1.0).with_instance(card, matrix, name="card")
    image = rc.render(scene, camera(), effects=(), spp=4, layers="all", device=device)
    expected = np.array([0.6, 0, 0.4]) / math.hypot(0.6, 0.4)  # by the inverse transpose
    for name in ("normal", "normal_middle"):
        np.testing.assert_allclose(image.layers[name], np.broadcast_to(expected, (16, 24, 3)), atol=1e-6)


@pytest.mark.parametrize("model", ["full", "thin"])
def test_two_walls_in_one_pixel(model: str, device: str) -> None:
    """The mean lies between them, and the middle ray meets one of them."""
    image = rc.render(two_walls(), camera(model), effects=(), spp=256, layers="all", device=device)
    depth, middle = image.layers["depth"], image.layers["depth_middle"]
    edge = depth[:, 11:13]
    assert ((edge > 1.05) & (edge < 2.95)).any()
    nearest = np.abs(middle[..., None] - [1.0, 3.0])
    assert nearest.min(axis=2).max() < 1e-5
    near = nearest.argmin(axis=2) == 0
    assert near[:, 13:].all()
    assert not near[:, :11].any()
    np.testing.assert_array_equal(image.layers["material_id"], np.where(near, 1, 2))
    assert (image.layers["object_id"] == 1).all()
    # Depth and albedo are means with the same weights: shares of the near wall.
    np.testing.assert_allclose((image.layers["albedo"][..., 0] - 0.1) / 0.8, (3 - depth) / 2, atol=1e-5)


def test_means_are_weighted_as_the_exposure_is(device: str) -> None:
    """Depth against the camera's own rays and their weights, at a corner where the weights differ."""
    fisheye = rc.Lens.load("fisheye-6mm-220deg")
    taken_by = rc.Camera(fisheye, film=rc.Film(*fisheye.film_mm, (12, 12)), exposure_time_s=1)
    scene = scenes.sphere(3.0, 24, rc.Material(diffuse=(0.5,) * 3), inward=True).with_environment(1.0)
    image = rc.render(scene, taken_by, effects=(), spp=64, seed=3, layers=["depth"], device=device)
    rays = taken_by.generate_rays(spp=64, seed=3)
    passed = rays.weights > 0
    # The triangles lie within 1% of the sphere. The weights differ by some percent within a pixel at the edge.
    along = (rays.origins_m * rays.directions).sum(axis=1)
    distance = -along + np.sqrt(along**2 - (rays.origins_m**2).sum(axis=1) + 9.0)
    depth = -(rays.origins_m + distance[:, None] * rays.directions)[:, 2]
    weights = np.where(passed, rays.weights, 0).astype(float).reshape(12, 12, 64)
    total = weights.sum(axis=2)
    lit = total > 0
    expected = (weights * depth.reshape(12, 12, 64)).sum(axis=2)[lit] / total[lit]
    np.testing.assert_array_equal(np.isfinite(image.depth), lit)
    np.testing.assert_allclose(image.depth[lit], expected, atol=0.05)


def test_the_circle_of_confusion_is_the_thin_lens_formula(device: str) -> None:
    film = rc.Film(2.4, 1.6, (12, 8))
    focus = 2.0
    for wall_m in (0.7, 1.3, 2.0, 4.0, 1e4):
        wall = scenes.scene_of(scenes.quad((0, 0, -wall_m), 10 * wall_m, diffuse=0.5)).with_environment(1.0)
        image = rc.render(
            wall, camera("thin", film, focus), effects=(), spp=8, layers="circle_of_confusion_mm", device=device
        )
        first = lens(focus).first_order()
        # Distances from the entrance pupil, mm.
        offset = lens(focus).film_position_mm - first.entrance_pupil_position_mm
        s, s_f = 1000 * wall_m - offset, 1000 * focus - offset
        magnification = magnification_of(lens(focus))
        expected = first.entrance_pupil_diameter_mm * magnification * abs(s_f - s) / s
        np.testing.assert_allclose(image.layers["circle_of_confusion_mm"], expected, rtol=2e-4, atol=2e-6)


def magnification_of(of: rc.Lens) -> float:
    """Magnification in the plane in focus (film height over object height), from rays of the pinhole model."""
    taken_by = rc.Camera(of, film=rc.Film(2, 2, (2, 1)), model="pinhole")
    rays = taken_by.generate_rays(spp=4096)
    pupil = np.asarray(taken_by.entrance_pupil_position_m)
    at = of.focus_distance_m + pupil[2]
    x = (rays.directions[:, 0] / -rays.directions[:, 2] * at).reshape(2, -1)
    # Two halves of the film, 1 mm apart from middle to middle.
    return 1.0 / (1000 * float(x[1].mean() - x[0].mean()))


@pytest.mark.parametrize("wall_m", [0.8, 1.2, 4.0])
def test_the_circle_of_confusion_is_what_the_rays_of_the_lens_cover(wall_m: float) -> None:
    """On the axis of the real lens, stopped down: its aberrations are then small against the circle."""
    real = rc.Lens.load("double-gauss-50mm").stopped_down(11.0).focused(2.0)
    taken_by = rc.Camera(real, film=rc.Film(1e-4, 1e-4, (1, 1)), exposure_time_s=1)
    rays = taken_by.generate_rays(spp=4096)
    rays_at = rays.origins_m + (-wall_m - rays.origins_m[:, 2:]) / rays.directions[:, 2:] * rays.directions
    on_wall = rays_at[rays.weights > 0, 0]
    chief = magnification_of(real) * (2.0 + taken_by.entrance_pupil_position_m[2])
    on_film = 1000 * np.ptp(on_wall) * chief / (wall_m + taken_by.entrance_pupil_position_m[2])
    wall = scenes.scene_of(scenes.quad((0, 0, -wall_m), 10, diffuse=0.5)).with_environment(1.0)
    image = rc.render(wall, taken_by, effects=(), spp=4, layers="circle_of_confusion_mm")
    np.testing.assert_allclose(image.layers["circle_of_confusion_mm"], on_film, rtol=0.05)


def test_a_vignetted_corner_keeps_its_depth(device: str) -> None:
    real = rc.Lens.load("tessar-50mm").focused(3.0)
    film = rc.Film(60, 60, (24, 24))  # beyond the image circle
    taken_by = rc.Camera(real, film=film, exposure_time_s=1)
    wall = scenes.scene_of(scenes.quad((0, 0, -3), 100, diffuse=0.5)).with_environment(1.0)
    image = rc.render(wall, taken_by, effects=(), spp=64, layers="all", device=device)
    light = image.pixels[..., 0]
    lit = light > 0
    vignetted = lit & (light < 0.2 * light.max())
    assert vignetted.sum() > 8
    assert (~lit).sum() > 4
    np.testing.assert_allclose(image.depth[lit], 3.0, rtol=1e-5)
    assert np.isinf(image.depth[~lit]).all()
    middle = image.layers["depth_middle"]
    passes = ~np.isnan(middle)
    np.testing.assert_allclose(middle[passes], 3.0, rtol=1e-5)
    # At the edge of the image circle a pixel may get light but none at its centre; the pixel then has little light.
    assert not (passes & ~lit).any()
    assert light[lit & ~passes].max() < 0.05 * light.max()
    assert (image.layers["object_id"][~passes] == 0).all()
    assert (image.layers["normal_middle"][~passes] == 0).all()
    assert np.isnan(image.layers["circle_of_confusion_mm"][~lit]).all()


def test_a_hole_in_the_pupil_does_not_blind_the_middle_ray(device: str) -> None:
    name = next(n for n in rc.lens_names() if any(s.inner_semi_diameter_mm > 0 for s in rc.Lens.load(n).surfaces))
    mirror = rc.Lens.load(name).focused(10.0)
    taken_by = rc.Camera(mirror, film=rc.Film(*mirror.film_mm, (12, 8)), exposure_time_s=1)
    wall = scenes.scene_of(scenes.quad((0, 0, -10), 30, diffuse=0.5)).with_environment(1.0)
    image = rc.render(wall, taken_by, effects=(), spp=16, layers=["depth_middle", "object_id"], device=device)
    lit = image.pixels[..., 0] > 0.1 * image.pixels.max()
    np.testing.assert_allclose(image.layers["depth_middle"][lit], 10.0, rtol=1e-4)
    assert (image.layers["object_id"][lit] == 1).all()


def test_ids_lead_to_names(device: str) -> None:
    ball = scenes.sphere(0.1, 8, rc.Material(diffuse=(0.5, 0.2, 0.2), name="rubber"), inward=False)
    room = scenes.scene_of(scenes.quad((0, 0, -3), 9, diffuse=0.6)).with_environment(1.0)
    places = {"left": (-0.25, 0.0, -2.0), "right": (0.25, 0.0, -2.0)}
    for name, place in places.items():
        matrix = np.eye(4)
        matrix[:3, 3] = place
        room = room.with_instance(ball, matrix, name=name)
    image = rc.render(room, camera("pinhole"), effects=(), spp=1, layers=["object_id", "material_id"], device=device)
    assert image.object_names == ("", "static geometry", "left", "right")
    objects = np.array(image.object_names)[image.layers["object_id"]]
    materials = np.array(image.material_names)[image.layers["material_id"]]
    assert (objects[0, 0], objects[8, 5], objects[8, 18]) == ("static geometry", "left", "right")
    # Both balls are the same object: one material.
    assert len(image.material_names) == 3
    assert len({materials[8, 5], materials[8, 18]}) == 1
    assert materials[0, 0] != materials[8, 5]
    np.testing.assert_array_equal(objects == "static geometry", materials == materials[0, 0])


def test_where_nothing_is_met(device: str) -> None:
    image = rc.render(scenes.sky(), camera(), effects=(), spp=4, layers="all", device=device)
    layers = image.layers
    assert np.isinf(layers["depth"]).all()
    assert np.isinf(layers["depth_middle"]).all()
    assert np.isnan(layers["position_middle"]).all()
    for name in ("normal", "normal_middle", "albedo", "object_id", "material_id"):
        assert (layers[name] == 0).all(), name
    # For a point at infinity, rays from all over the pupil are parallel, as wide in the plane in focus as the pupil.
    first = lens().first_order()
    expected = first.entrance_pupil_diameter_mm * magnification_of(lens())
    np.testing.assert_allclose(layers["circle_of_confusion_mm"], expected, rtol=2e-4)


@pytest.mark.parametrize(
    ("material", "albedo"),
    [
        (rc.Material(diffuse=(0.2, 0.4, 0.6), specular=(0.1, 0.1, 0.1), shininess=10), (0.3, 0.5, 0.7)),
        (rc.Material.metallic_roughness(base_color=(0.9, 0.6, 0.2), metallic=1.0, roughness=0.3), (0.9, 0.6, 0.2)),
        (rc.Material.metallic_roughness(base_color=(1, 1, 1), transmission=1.0, roughness=0.0), (1, 1, 1)),
        # A dielectric of index 1.5 reflects 4%, and what is left meets the base.
        (rc.Material.metallic_roughness(base_color=(0.5, 0, 1), roughness=0.5), (0.52, 0.04, 1)),
    ],
)
def test_albedo_of_materials(material: rc.Material, albedo: tuple[float, ...], device: str) -> None:
    wall = scenes.quad((0, 0, -3), 50)[0]
    scene = rc.Scene.from_arrays(wall, [[0, 1, 2], [0, 2, 3]], materials=[material]).with_environment(1.0)
    image = rc.render(scene, camera(), effects=(), spp=4, layers="albedo", device=device)
    np.testing.assert_allclose(image.layers["albedo"], np.broadcast_to(np.float32(albedo), (16, 24, 3)), rtol=1e-5)


def speckled_scene() -> rc.Scene:
    """A wall of a quarter of a million random specks in each pixel: samples of a sequence that is spread evenly over
    the pixel meet them as if they knew nothing of each other."""
    corners, _ = scenes.quad((0, 0, -3), 1.0)
    specks = np.full((2048, 2048, 4), 255, np.uint8)
    specks[..., 3] = np.random.default_rng(5).integers(0, 256, (2048, 2048))
    # Opacity has no coarser levels, whose means would make pictures differ less than independent samples do.
    wall = rc.Material(diffuse=(1, 1, 1), opacity_texture=specks, opacity_cutoff=0.5)
    uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]
    scene = rc.Scene.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], uvs=uvs, materials=[wall])
    return scene.with_sun((0, 0, -1), (3.0, 2.0, 1.0))


SPECKLED_FILM = rc.Film(24, 24, (4, 4))


def test_variance_is_a_bound_where_the_samples_are_spread_evenly(device: str) -> None:
    """A wall with a slope of light over each pixel: pictures differ far less than independent samples would have it."""
    lamp = scenes.scene_of(scenes.quad((0, 0, -3), 50, diffuse=0.8)).with_point_light((0.5, 0, -2), (9.0,) * 3)
    images = [
        rc.render(
            lamp, camera("pinhole"), effects=(), spp=64, seed=seed, max_bounces=0, layers="variance", device=device
        )
        for seed in range(50)
    ]
    actual = np.stack([image.pixels for image in images]).astype(float).var(axis=0, ddof=1)
    told = np.stack([image.layers["variance"] for image in images]).astype(float).mean(axis=0)
    assert actual.mean() < 0.2 * told.mean()


def far_point(tangent_x: float, tangent_y: float) -> rc.Scene:
    place = (tangent_x * 1e4, tangent_y * 1e4, -1e4)
    return scenes.scene_of(scenes.quad((0, 0, 9), 1)).with_point_light(place, (1e8,) * 3)


@pytest.mark.parametrize(
    ("scene", "film", "settings", "least"),
    [
        (far_point(0, 0), rc.Film(1.2, 0.8, (24, 16)), {}, 0.01),
        (scenes.scene_of(scenes.quad((0, 0, -4), 0.004, emission=1e5)), rc.Film(1.2, 0.8, (24, 16)), {}, 0.2),
        (far_point(0.1, 0.05), rc.Film(24, 24, (24, 24)), {"effects": ["diffraction"], "light_tracing": "off"}, 0.5),
        (far_point(0.1, 0.05), rc.Film(24, 24, (24, 24)), {"effects": ["ghosts=0"], "light_tracing": "off"}, 0.05),
    ],
    ids=["point", "lamp", "starburst", "ghosts"],
)
@pytest.mark.filterwarnings("ignore:ghosts")
@pytest.mark.slow
def test_variance_includes_light_that_starts_at_lamps(
    scene: rc.Scene, film: rc.Film, settings: dict[str, object], least: float, device: str
) -> None:
    by = rc.Camera(lens(1.0).stopped_down(2.8), film=film, position=(0, 0, 0), exposure_time_s=1)
    options = {"effects": (), "spp": 64, "max_bounces": 0, "layers": "variance", "device": device} | settings
    images = [rc.render(scene, by, seed=seed, **options) for seed in range(100)]  # type: ignore[arg-type]
    actual = np.stack([image.pixels for image in images]).astype(float).var(axis=0, ddof=1).sum()
    told = np.stack([image.layers["variance"] for image in images]).astype(float).mean(axis=0).sum()
    # A starburst lights four pixels. Each figure of a pixel has one degree of freedom and 100 seeds, its variance 99:
    # the quotient of the sums has a deviation of sqrt(2 * 2 / 100 / 4) = 0.1. Four of them are allowed. Stratified
    # samples have less noise than reported.
    assert least < actual / told < 1.4


def test_variance_scales_with_samples_and_exposure(device: str) -> None:
    scene = speckled_scene()

    def told(spp: int, time_s: float) -> np.ndarray:
        taken_by = camera("pinhole", SPECKLED_FILM, exposure_time_s=time_s)
        image = rc.render(scene, taken_by, effects=(), spp=spp, max_bounces=0, layers="variance", device=device)
        return image.layers["variance"].astype(float)

    np.testing.assert_allclose(told(64, 0.25), told(64, 1.0) / 16, rtol=1e-6)
    # The variance of 64 samples, over 16 pixels, is known to 3%.
    assert told(64, 1.0).mean() / told(1024, 1.0).mean() == pytest.approx(16, rel=0.15)
    assert np.isnan(told(1, 1.0)).all()


def test_layers_of_a_session_grow_with_its_samples(device: str) -> None:
    session = rc.Session(two_walls(), camera(), device=device, seed=2, layers="all", effects=())
    for spp in (16, 16, 32):
        session.add(spp)
        session.image()
    image = session.image()
    whole = rc.render(two_walls(), camera(), effects=(), device=device, seed=2, spp=64, layers="all")
    assert tuple(image.layers) == ALL
    for name, array in image.layers.items():
        np.testing.assert_allclose(array, whole.layers[name], rtol=1e-5, atol=1e-12, err_msg=name)
    session.set(camera=camera(focus_m=1.0))
    session.add(4)
    again = rc.render(two_walls(), camera(focus_m=1.0), effects=(), device=device, seed=2, spp=4, layers="all")
    np.testing.assert_allclose(
        session.image().layers["circle_of_confusion_mm"], again.layers["circle_of_confusion_mm"], rtol=1e-5
    )


def test_images_with_layers_are_values() -> None:
    image = rc.render(two_walls(), camera(), effects=(), spp=2, layers="all")
    for other in (pickle.loads(pickle.dumps(image)), copy.deepcopy(image)):
        assert other == image
        assert tuple(other.layers) == ALL
    assert image != rc.render(two_walls(), camera(), effects=(), spp=2)
    changed = copy.deepcopy(image)
    changed.layers["albedo"][0, 0, 0] += 1
    assert changed != image
    assert "with layers depth, normal" in repr(image)
    assert "layers" not in repr(rc.render(two_walls(), camera(), effects=(), spp=2))


@pytest.mark.picture_files
def test_layers_that_do_not_fit_the_picture_are_not_written(tmp_path: Path) -> None:
    image = rc.render(two_walls(), camera(), effects=(), spp=1, layers="all")
    image.layers["albedo"] = image.layers["albedo"][:-1]  # type: ignore[index]
    with pytest.raises(rc.InputError, match=r'layer "albedo" must have the shape \(H, W, 3\)'):
        image.save(tmp_path / "a.exr")
    assert list(tmp_path.iterdir()) == []
