"""Both backends take the same samples of the same scene: their pictures differ by rounding alone.

A sample that passes an edge by less than its rounding may meet another surface on the other backend. Such pixels are
counted; all others have to agree.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

pytestmark = pytest.mark.gpu

GPUS = [d.name.removeprefix("cuda:") for d in rc.devices() if d.name.startswith("cuda:")]
needs_gpu = pytest.mark.skipif(not GPUS, reason=f"no GPU: {rc.devices()[-1]} is all there is")
needs_two = pytest.mark.skipif(len(GPUS) < 2, reason=f"{len(GPUS)} GPUs; two are wanted")

# A sample whose path differs changes its pixel by that sample's share, some percent; rounding alone changes the pixel
# by at most 1e-5 of its value: 2^-24 times some hundred operations.
ASTRAY = 5e-4
# An edge is as wide as the rounding of a hit, 1e-6 of the distance, against a pixel of 1e-3: with up to 64 samples and
# a few edges in a pixel, one in a thousand pixels.
ASTRAY_SHARE = 2e-3
RELATIVE_RMSE = 1e-4  # the bound


def textured_scene() -> rc.Scene:
    """Texture, environment image, mirror-like and diffuse surfaces, all kinds of light."""
    rng = np.random.default_rng(3)
    plane = np.array([[-3, 0, 3], [3, 0, 3], [3, 0, -6], [-3, 0, -6]], float)
    wall = np.array([[-1, 0, -3], [1, 0.2, -3], [1, 1.6, -3.4], [-1, 1.4, -3.2]], float)
    lamp = np.array([[-0.4, 2, -1], [-0.4, 2, -2], [0.4, 2, -2], [0.4, 2, -1]], float)
    scene = rc.Scene.from_arrays(
        np.concatenate([plane, wall, lamp]),
        [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [8, 9, 10], [8, 10, 11]],
        uvs=np.tile([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]], (3, 1)),
        triangle_materials=[0, 0, 1, 1, 2, 2],
        materials=[
            rc.Material(diffuse=(0.7, 0.6, 0.5)),
            rc.Material(diffuse=(0.2, 0.2, 0.3), specular=(0.5, 0.5, 0.5), shininess=60),
            rc.Material(emission=(900, 900, 800)),
        ],
    )
    scene = scene.with_texture(0, rng.integers(0, 255, (32, 32, 4), dtype=np.uint8))
    scene = scene.with_point_light((1.5, 1.0, -0.5), (300, 200, 100)).with_sun((0.3, -1, -0.2), (500, 500, 600))
    return scene.with_environment(rng.uniform(1, 200, (16, 32, 3)).astype(np.float32))


def scene_with_objects() -> rc.Scene:
    """The textured scene, and copies of it as objects, lamps and all: turned, of several sizes, one mirrored."""
    scene, turn = textured_scene(), np.array([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
    for i, size in enumerate((0.3, 0.2, -0.25)):
        matrix = turn @ np.diag([size, abs(size), abs(size) * 1.5, 1])
        matrix[:3, 3] = (i - 1, 0.3 + 0.03 * i, -1 - i)  # no two planes in one
        scene = scene.with_instance(textured_scene(), matrix)
    return scene


def scene_with_holes() -> rc.Scene:
    """Plates by their factor, a map and a cutoff, one behind the other, also in instances; a spot and a lamp with holes
    that light them."""
    rng = np.random.default_rng(5)
    alpha = rng.integers(0, 255, (16, 16), dtype=np.uint8)
    plate = np.array([[-0.8, 0, -2], [0.8, 0, -2], [0.8, 1.4, -2], [-0.8, 1.4, -2]], float)
    corners = [plate + np.array([0.2 * i, 0, -0.4 * i]) for i in range(3)]
    lamp = np.array([[-0.4, 2, -1], [-0.4, 2, -2], [0.4, 2, -2], [0.4, 2, -1]], float)
    floor = np.array([[-3, 0, 3], [3, 0, 3], [3, 0, -6], [-3, 0, -6]], float)
    scene = rc.Scene.from_arrays(
        np.concatenate([*corners, lamp, floor]),
        (4 * np.arange(5)[:, None] + [0, 1, 2, 0, 2, 3]).reshape(-1, 3),
        uvs=np.tile([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]], (5, 1)),
        triangle_materials=np.repeat(np.arange(5), 2),
        materials=[
            rc.Material(diffuse=(0.6, 0.2, 0.2), opacity=0.4),
            rc.Material(diffuse=(0.2, 0.6, 0.2), opacity_texture=alpha),
            rc.Material(diffuse=(0.2, 0.2, 0.6), opacity_texture=alpha, opacity_cutoff=0.5),
            rc.Material(emission=(900, 900, 800), opacity_texture=alpha, double_sided=True),
            rc.Material.metallic_roughness(base_color=(0.7, 0.7, 0.7), roughness=0.4),
        ],
    )
    scene = scene.with_spot_light((1, 2.5, 1), (-0.4, -1, -0.8), (300, 300, 300), inner_cone_deg=10, outer_cone_deg=30)
    place = np.diag([0.4, 0.4, 0.4, 1])
    place[:3, 3] = (0.9, 0.05, 0.1)
    catcher = rc.Scene.from_arrays(
        [[-2, 0.02, 2], [2, 0.02, 2], [2, 0.02, 0]], [[0, 1, 2]], materials=[rc.Material(shadow_catcher=True)]
    )
    return scene.with_environment(20).with_instance(scene, place).with_instance(catcher)


def scene_with_motion() -> rc.Scene:
    """The scene with holes, with instances and lamps that move, rotate and grow while the shutter is open."""
    scene = scene_with_holes().with_instance(textured_scene(), np.diag([0.2, 0.2, 0.2, 1]), name="copy")
    scene = scene.with_instance(frame_scene(spheres=2, boxes=1), name="balls")
    end = np.array([[0.0, 0, 0.3, 0.8], [0, 0.3, 0, 0.3], [-0.3, 0, 0, -0.5], [0, 0, 0, 1]])
    scene = scene.moved("copy", [np.diag([0.2, 0.2, 0.2, 1]), end], times_s=[0, 1 / 125])
    turn = np.array([[0.8, 0, 0.6, -0.3], [0, 1, 0, 0.1], [-0.6, 0, 0.8, 0], [0, 0, 0, 1]])
    return scene.moved("balls", [np.eye(4), turn, np.eye(4)], times_s=[0, 0.003, 0.02])


SCENES = {
    "holes": scene_with_holes,
    "motion": scene_with_motion,
    "area light": lambda: frame_scene(spheres=20, boxes=20),
    "all kinds": textured_scene,
    "objects": scene_with_objects,
}


BOTH = ("cpu", "cuda")


def view(lens: rc.Lens, resolution: tuple[int, int], **more: Any) -> rc.Camera:
    pose = {} if "motion" in more else {"position": (0, 1, 3), "look_at": (0, 0.6, -2)}
    return rc.Camera(lens, film=rc.Film(*lens.film_mm, resolution), **pose, **more)


def double_gauss(resolution: tuple[int, int] = (120, 80), **more: Any) -> rc.Camera:
    return view(rc.Lens.load("double-gauss-50mm").focused(4.0), resolution, **more)


def tessar(resolution: tuple[int, int]) -> rc.Camera:
    return view(rc.Lens.load("tessar-50mm").focused(4.0), resolution)


def pictures(scene: str, camera: rc.Camera, devices: tuple[str, str] = BOTH, **options: Any) -> list[rc.Image]:
    made = SCENES[scene]()
    return [rc.render(made, camera, device=device, **{"effects": (), **options}) for device in devices]


def hold_parity(a: rc.Image, b: rc.Image) -> None:
    reference, other = a.pixels.astype(float), b.pixels.astype(float)
    difference = np.abs(other - reference).max(axis=2)
    astray = difference > ASTRAY * (reference.max(axis=2) + 1e-3 * reference.mean())
    assert astray.mean() <= ASTRAY_SHARE
    kept = ~astray
    rmse = np.sqrt((difference[kept] ** 2).mean() / (reference[kept] ** 2).mean())
    assert rmse <= RELATIVE_RMSE
    # Every ray that one sends through the lens, the other sends too; decisions at its rims may differ by rounding.
    assert a.stats.sampled_rays == b.stats.sampled_rays
    assert abs(a.stats.passed_rays - b.stats.passed_rays) <= 1 + 1e-5 * a.stats.sampled_rays
    # Depth is a mean over the samples that hit a surface. A sample that passes an edge changes it even if the surface
    # behind is as bright as the one in front.
    met = np.isfinite(a.depth) & np.isfinite(b.depth) & kept
    assert (~np.isclose(b.depth[met], a.depth[met], rtol=1e-3, atol=0)).mean() <= ASTRAY_SHARE


def hold_layer_parity(a: rc.Image, b: rc.Image) -> None:
    assert list(a.layers) == list(b.layers)
    assert (a.object_names, a.material_names) == (b.object_names, b.material_names)
    np.testing.assert_array_equal(a.layers["sample_count"], b.layers["sample_count"])
    for name, reference in a.layers.items():
        one, other = reference.astype(float), b.layers[name].astype(float)
        same = np.isclose(other, one, rtol=1e-3, atol=1e-3 * np.abs(one[np.isfinite(one)]).mean(), equal_nan=True)
        # A ray at the very edge of a surface or a rim may pass it on one side only; so may one sample of a mean.
        assert (~same).sum() <= 2 + 3 * ASTRAY_SHARE * same.size, name


def hold_close(a: rc.Image, b: rc.Image) -> None:
    """The same light, where samples that pass a pixel's border by less than their rounding are next door."""
    assert a.stats.sampled_rays == b.stats.sampled_rays
    one, other = a.pixels.astype(float), b.pixels.astype(float)
    np.testing.assert_allclose(other.mean(axis=(0, 1)), one.mean(axis=(0, 1)), rtol=1e-3)
    assert np.sqrt(((one - other) ** 2).mean() / (one**2).mean()) <= 2e-2


each_scene = pytest.mark.parametrize("scene", SCENES)
each_model = pytest.mark.parametrize("model", ["pinhole", "thin", "thick", "full"])


@needs_gpu
@each_scene
@each_model
@pytest.mark.parametrize("bounces", [0, 3])
def test_pictures_and_layers_agree(scene: str, model: str, bounces: int) -> None:
    images = pictures(scene, double_gauss(model=model), spp=32, seed=5, max_bounces=bounces, layers="all")
    hold_parity(*images)
    hold_layer_parity(*images)


@needs_gpu
@each_model
@pytest.mark.parametrize("scene", ["motion", "all kinds"])
def test_pictures_of_a_moving_camera_agree(scene: str, model: str) -> None:
    keys = [(0, (0, 1, 3), (0, 0.6, -2)), (0.005, (0.1, 1, 3), (0.2, 0.6, -2)), (0.02, (0.1, 1.1, 3), (0, 0.6, -2))]
    camera = double_gauss(model=model, motion=keys, shutter_opens_s=0.001, readout_time_s=0.01)
    images = pictures(scene, camera, spp=32, seed=5, max_bounces=1, layers="all")
    hold_parity(*images)
    hold_layer_parity(*images)


@needs_gpu
@pytest.mark.parametrize("name", rc.lens_names())
def test_pictures_through_every_lens_agree(name: str) -> None:
    lens = rc.Lens.load(name)
    hold_layer_parity(*pictures("objects", view(lens, (60, 40)), spp=32, layers="all"))
    lens = lens.stopped_down(1.4 * lens.first_order().f_number) if lens.first_order().f_number > 0 else lens
    hold_parity(*pictures("area light", view(lens, (60, 40)), spp=32, max_bounces=1))


@needs_gpu
@pytest.mark.parametrize("resolution", [(1, 1), (3, 2), (33, 17), (257, 3)])
@pytest.mark.parametrize("spp", [1, 3, 64, 1000])
def test_any_number_of_pixels_and_samples(resolution: tuple[int, int], spp: int) -> None:
    a, b = pictures("all kinds", tessar(resolution), spp=spp)
    assert a.stats.sampled_rays == b.stats.sampled_rays == spp * resolution[0] * resolution[1]
    # One stray sample among few weighs much: the middle of the pixels' errors.
    errors = np.abs(b.pixels - a.pixels).max(axis=2) / (a.pixels.max(axis=2) + 1e-6 * a.pixels.max())
    assert np.median(errors) <= RELATIVE_RMSE


@needs_gpu
@pytest.mark.parametrize(("resolution", "spp"), [((1, 1), 1000), ((3, 2), 7), ((257, 3), 64)])
def test_layers_of_any_number_of_pixels_and_samples(resolution: tuple[int, int], spp: int) -> None:
    hold_layer_parity(*pictures("all kinds", tessar(resolution), spp=spp, layers="all"))


@needs_gpu
@pytest.mark.parametrize("effects", [(), ("dispersion",)])
def test_the_same_picture_twice(effects: tuple[str, ...]) -> None:
    a, b = pictures("all kinds", tessar((60, 40)), ("cuda", "cuda"), spp=50, effects=effects)
    np.testing.assert_array_equal(a.pixels, b.pixels)


@needs_two
def test_several_gpus_take_the_same_picture() -> None:
    one, both = pictures("all kinds", double_gauss(), ("cuda:0", "cuda:0,1"), spp=101)
    # The same samples; their sums in double are added in another order.
    np.testing.assert_allclose(both.pixels, one.pixels, rtol=3e-7)
    assert both.stats.sampled_rays == one.stats.sampled_rays
    assert both.stats.scene_rays == one.stats.scene_rays


@needs_gpu
@each_scene
def test_pictures_of_a_spectral_line_agree(scene: str) -> None:
    settings: dict[str, Any] = {"effects": ["dispersion"], "illuminant": 450}
    hold_parity(*pictures(scene, double_gauss(), spp=32, seed=5, max_bounces=1, **settings))


@needs_gpu
@each_scene
@pytest.mark.parametrize("name", ["double-gauss-50mm", "phone-4mm"])
def test_pictures_with_dispersion_agree(scene: str, name: str) -> None:
    """A ray that is taken back to the border of its pixel may end on either side of it: some thousandths of the samples
    count for other wavelengths."""
    camera = view(rc.Lens.load(name).focused(4.0), (60, 40))
    hold_close(*pictures(scene, camera, spp=256, max_bounces=1, effects=["dispersion"]))


@needs_gpu
@each_scene
@pytest.mark.parametrize("name", ["double-gauss-50mm", "phone-4mm", "mirror-telephoto-500mm"])
def test_pictures_with_coatings_agree(scene: str, name: str) -> None:
    lens = rc.Lens.load(name).focused(6.0)
    mirrors = [i for i, surface in enumerate(lens.surfaces) if surface.type == "mirror"]
    lens = lens.with_coating("quarter_wave")
    if mirrors:
        lens = lens.with_coating("silver", mirrors)
    for settings in ({"effects": ["coatings"]}, {"effects": ["coatings", "dispersion"], "illuminant": 450}):
        hold_parity(*pictures(scene, view(lens, (60, 40)), spp=32, seed=5, max_bounces=1, **settings))


@needs_gpu
@each_scene
@pytest.mark.parametrize("base", [set(), {"dispersion"}])
def test_ghosts_agree(scene: str, base: set[str]) -> None:
    """A ghost sample that passes a rim or a pixel's border by less than its rounding is lost, or next door: one in
    thousands, of which each may weigh much."""
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare").focused(4.0)
    camera = view(lens, (60, 40), readout_time_s=0.01)
    with_ghosts, without = (pictures(scene, camera, spp=256, effects=names) for names in (base | {"ghosts"}, base))
    one, other = (a.pixels.astype(float) - b.pixels for a, b in zip(with_ghosts, without, strict=True))
    assert one.sum() > 0
    np.testing.assert_allclose(other.sum(), one.sum(), rtol=3e-3)
    assert np.sqrt(((one - other) ** 2).mean()) <= 0.05 * np.sqrt((one**2).mean())


@needs_gpu
@each_scene
@pytest.mark.parametrize("effects", [("diffraction",), ("coatings", "diffraction", "dispersion")])
def test_pictures_with_diffraction_agree(scene: str, effects: tuple[str, ...]) -> None:
    """A splat that passes a pixel's border by less than its rounding is next door: as of ghosts."""
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare").with_iris(blades=6).stopped_down(11).focused(4.0)
    hold_close(*pictures(scene, view(lens, (60, 40)), spp=256, max_bounces=1, effects=effects))
