"""Maps of the numbers of a material: each is multiplied by its own channel, and by no other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from .. import scenes

# A sky that is brighter above, so that what is reflected says where to.
GRADIENT = np.repeat(np.linspace(2.0, 0.1, 32)[:, None, None], 64, axis=1).repeat(3, axis=2)


def wall(material: rc.Material) -> rc.Scene:
    """A rectangle that fills the picture."""
    corners, _ = scenes.quad((0, 0, -2), 0.96, 0.64)
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    scene = rc.Scene.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], uvs=uvs, materials=[material])
    return scene.with_environment(GRADIENT)


def picture(material: rc.Material) -> np.ndarray:
    return np.asarray(rc.render(wall(material), scenes.pinhole(), effects=(), spp=16, seed=3, device="cpu").pixels)


def channel(index: int, value: float, others: float) -> np.ndarray:
    pixels = np.full((2, 2, 4), others, np.float32)
    pixels[..., index] = value
    return pixels


PBR = rc.Material.metallic_roughness
# Keyword, factor, the map's keyword, its channel, and what else the material has.
MAPS = [
    ("transmission", "transmission_texture", 0, {"roughness": 0.2, "thin": True, "base_color": (0.2, 0.5, 0.9)}),
    ("specular_weight", "specular_weight_texture", 3, {"roughness": 0.3, "base_color": (0, 0, 0)}),
    ("clearcoat", "clearcoat_texture", 0, {"base_color": (0.1, 0.1, 0.1), "clearcoat_roughness": 0.1}),
    ("clearcoat_roughness", "clearcoat_roughness_texture", 1, {"base_color": (0, 0, 0), "clearcoat": 1.0}),
]


@pytest.mark.parametrize(("number", "texture", "index", "rest"), MAPS)
def test_a_map_of_one_colour_is_the_number_times_its_channel(
    number: str, texture: str, index: int, rest: dict[str, object]
) -> None:
    mapped = picture(PBR(**{number: 0.8, texture: channel(index, 0.5, 0.9)}, **rest))
    expected = picture(PBR(**{number: 0.4}, **rest))
    without = picture(PBR(**{number: 0.8}, **rest))
    # The paths are the same, except for roundings.
    np.testing.assert_allclose(mapped, expected, rtol=1e-3)
    assert np.abs(without / expected - 1).max() > 0.02


def test_a_map_of_shininess() -> None:
    def make(**changes: object) -> rc.Material:
        return rc.Material(diffuse=(0, 0, 0), specular=(0.8, 0.8, 0.8), **changes)  # type: ignore[arg-type]

    mapped = picture(make(shininess=40.0, shininess_texture=channel(1, 0.25, 1.0)))
    np.testing.assert_allclose(mapped, picture(make(shininess=10.0)), rtol=1e-3)


def test_a_map_of_specular_colour() -> None:
    tint = np.full((2, 2, 3), 0.5, np.float32)
    tint[..., 2] = 1.0
    linear = ((0.5 + 0.055) / 1.055) ** 2.4
    mapped = picture(PBR(base_color=(0, 0, 0), roughness=0.0, specular_texture=tint))
    expected = picture(PBR(base_color=(0, 0, 0), roughness=0.0, specular_color=(linear, linear, 1.0)))
    np.testing.assert_allclose(mapped, expected, rtol=1e-3)


# A third up, in tangent space: 2 * 0.8 - 1 = 0.6 and 0.8.
TILTED = np.broadcast_to(np.array([0.5, 0.8, 0.9], np.float32), (2, 2, 3))


def test_the_coat_has_its_own_normal_map() -> None:
    """Over black without a reflection of its own it is the smooth dielectric of index 1.5 with that map."""
    bare = {"base_color": (0, 0, 0), "roughness": 0.0}
    coated = picture(PBR(**bare, specular_weight=0.0, clearcoat=1.0, clearcoat_normal_map=TILTED))  # type: ignore[arg-type]
    dielectric = picture(PBR(**bare, ior=1.5, normal_map=TILTED))  # type: ignore[arg-type]
    flat = picture(PBR(**bare, ior=1.5))  # type: ignore[arg-type]
    np.testing.assert_allclose(coated, dielectric, rtol=2e-3)
    assert np.abs(coated / flat - 1).max() > 0.2


def test_without_one_it_has_those_of_the_mesh() -> None:
    """Whatever the normal map of what lies under it (KHR_materials_clearcoat)."""
    bare = {"base_color": (0, 0, 0), "specular_weight": 0.0, "clearcoat": 1.0}
    np.testing.assert_allclose(
        picture(PBR(**bare, normal_map=TILTED)),  # type: ignore[arg-type]
        picture(PBR(**bare)),  # type: ignore[arg-type]
        rtol=2e-3,
    )


@pytest.mark.parametrize("roughness", [0.0, 0.3])
@pytest.mark.parametrize("make", [lambda m: PBR(**m), lambda m: PBR(**m, clearcoat_normal_map=TILTED)])
def test_a_white_metal_under_a_coat_gives_no_light_of_its_own(
    roughness: float, make: Callable[[dict[str, object]], rc.Material]
) -> None:
    material = make({"metallic": 1.0, "roughness": roughness, "clearcoat": 1.0, "clearcoat_roughness": 0.2})
    scene = wall(material).with_environment(1.0)
    measured = scenes.radiance(scene, scenes.pinhole(), spp=64)  # whose mean has a noise of 6e-4
    assert measured.mean() < 1 + 2e-3
    assert measured.mean() > 0.9


def test_fractions_stay_floats() -> None:
    """Steps of a tenth of a code of 8 bits, which would be one and the same."""
    steps = np.broadcast_to(np.linspace(0.5, 0.5039, 10, dtype=np.float32)[:, None], (10, 4))
    kept = rc.Material(texture=steps).texture
    assert kept is not None and kept.dtype == np.float32
    np.testing.assert_allclose(kept[..., 0], ((steps + 0.055) / 1.055) ** 2.4, rtol=1e-6)
    np.testing.assert_array_equal(kept[..., 3], 1)
    numbers = PBR(metallic_roughness_texture=np.float64(steps)).metallic_roughness_texture
    assert numbers is not None
    np.testing.assert_allclose(numbers[..., 1], steps, rtol=1e-7)  # linear as they are
    codes = rc.Material(texture=np.full((2, 2), 7, np.int64)).texture
    assert codes is not None and codes.dtype == np.uint8


def panel(emission: np.ndarray | None, lit: int) -> rc.Scene:
    """A floor under 64 small lamps: of one material whose map leaves one lamp lit, or with a material for it."""
    corners, faces, uvs, owners = [], [], [], []
    floor, _ = scenes.quad((0, 0, -2), 0.96, 0.64)
    corners.append(floor)
    uvs.append(np.zeros((4, 2)))
    faces += [[0, 1, 2], [0, 2, 3]]
    owners += [0, 0]
    for i in range(64):
        lamp, _ = scenes.quad(((i % 8 - 3.5) * 0.12, (i // 8 - 3.5) * 0.08, -1.0), 0.02, up=(0, -1, 0))
        first = 4 * len(corners)
        corners.append(lamp)
        uvs.append(np.full((4, 2), ((i + 0.5) / 64, 0.5)))  # the middle of a texel
        faces += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
        owners += [1, 1] if emission is not None or i == lit else [2, 2]
    lamp_material = rc.Material(diffuse=(0, 0, 0), emission=(100, 100, 100), emission_texture=emission)
    return rc.Scene.from_arrays(
        np.concatenate(corners),
        faces,
        uvs=np.concatenate(uvs),
        triangle_materials=owners,
        materials=[rc.Material(diffuse=(0.5, 0.5, 0.5)), lamp_material, rc.Material(diffuse=(0, 0, 0))],
    )


def test_lamps_are_chosen_by_what_their_map_leaves_of_them() -> None:
    lit = 27
    emission = np.zeros((1, 64), np.float32)
    emission[0, lit] = 1.0
    camera = scenes.pinhole()

    def noise_and_mean(scene: rc.Scene) -> tuple[float, float]:
        rounds = [
            np.asarray(rc.render(scene, camera, effects=(), spp=16, seed=s, max_bounces=1, device="cpu").pixels)
            for s in range(8)
        ]
        pictures = np.array(rounds)[..., 0]
        return float(np.sqrt(pictures.var(axis=0, ddof=1).mean())), float(pictures.mean())

    noise, mean = noise_and_mean(panel(emission, lit))
    noise_alone, mean_alone = noise_and_mean(panel(None, lit))
    # The mean of 8 x 16 samples of 384 pixels.
    assert mean == pytest.approx(mean_alone, rel=0.03)
    # One in 64 lamps by their factors alone would be 8 times the noise. A tenth of the choice goes to the whole map.
    assert noise < 3 * noise_alone
