"""Materials of a scene by their names, and textures from arrays as users have them."""

from __future__ import annotations

import pickle
import time
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

WOOD = rc.Material(diffuse=(0.5, 0.25, 0.125), name="wood")
GLOSS = rc.Material(diffuse=(0, 0, 0), specular=(0.5, 0.5, 0.5), shininess=20, emission=(1, 2, 3))


def wall(materials: list[rc.Material]) -> rc.Scene:
    """A rectangle that fills the picture, of the first material, and triangles behind it of the others."""
    corners, _ = scenes.quad((0, 0, -2), 0.48, 0.32)
    triangles = [[0, 1, 2], [0, 2, 3], *([[0, 1, 2]] * (len(materials) - 1))]
    return rc.Scene.from_arrays(
        corners,
        triangles,
        uvs=[[0, 0], [1, 0], [1, 1], [0, 1]],
        triangle_materials=[0, *range(len(materials))],
        materials=materials,
    ).with_environment(1.0)


def test_a_material_says_what_it_was_made_of() -> None:
    assert (WOOD.name, WOOD.diffuse, WOOD.texture) == ("wood", (0.5, 0.25, 0.125), None)
    assert (GLOSS.specular, GLOSS.shininess, GLOSS.emission) == ((0.5, 0.5, 0.5), 20, (1, 2, 3))
    textured = GLOSS.replace(texture=np.full((2, 3), 7, np.uint8), name="poster")
    assert textured.texture is not None
    assert textured.texture.tolist() == [[[7, 7, 7, 255]] * 3] * 2
    assert not textured.texture.flags.writeable
    assert textured.replace(texture=None, name="") == GLOSS != textured
    assert textured.replace() == textured == pickle.loads(pickle.dumps(textured))
    assert hash(textured.replace()) == hash(textured)
    assert textured.replace(diffuse=(1, 1, 1)).texture is not None


def test_materials_of_a_scene_have_names() -> None:
    scene = wall([WOOD, GLOSS, WOOD, rc.Material(name="material 1")])
    assert list(scene.materials) == ["wood", "material 1", "wood.2", "material 1.2"]
    assert scene.materials["wood"] == WOOD
    assert scene.materials["material 1"] == GLOSS


def test_a_material_is_replaced_by_name_and_by_number() -> None:
    scene = wall([WOOD, GLOSS])
    red = rc.Material(diffuse=(1, 0, 0))
    for which in ("wood", 0):
        changed = scene.with_material(which, red)
        assert changed.materials == {"wood": red.replace(name="wood"), "material 1": GLOSS}
    assert scene.materials["wood"] == WOOD
    # Under a radiance of 1, the radiance of a wall of this colour equals its reflectance.
    np.testing.assert_allclose(
        scenes.radiance(wall([WOOD]).with_material("wood", red), scenes.pinhole())[8, 12], (1, 0, 0), atol=1e-5
    )


def test_a_material_that_is_not_there_is_named() -> None:
    scene = wall([WOOD, GLOSS])
    with pytest.raises(rc.InputError, match=r'there is no material .wod.; the scene has "wood", "material 1"'):
        scene.with_material("wod", GLOSS)
    with pytest.raises(rc.InputError, match="there is no material 2; the scene has 2"):
        scene.with_material(2, GLOSS)
    with pytest.raises(rc.InputError, match="there is no material -1"):
        scene.with_texture(-1, np.zeros((1, 1)))


def test_names_come_from_the_file(tmp_path: Path) -> None:
    (tmp_path / "m.mtl").write_text("newmtl red paint\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n")
    (tmp_path / "s.obj").write_text(
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red paint\nf 1 2 3\nusemtl blue\nf 3 2 1\n"
    )
    materials = rc.Scene.load(tmp_path / "s.obj").materials
    assert materials["red paint"].diffuse == (1, 0, 0)
    assert materials["blue"].diffuse == (0, 0, 1)
    assert materials["blue"].name == "blue"


def test_a_replaced_texture_is_forgotten() -> None:
    """Scenes do not grow with every texture that was on them for a while."""
    scene = wall([WOOD, WOOD])
    once = scene.with_texture("wood", np.zeros((64, 64), np.uint8))
    often = once
    for code in range(20):
        often = often.with_texture("wood", np.full((64, 64), code, np.uint8))
    assert len(pickle.dumps(often)) < len(pickle.dumps(once)) + 200
    assert often.with_texture("wood", np.zeros((64, 64), np.uint8)) == once
    both = once.with_material("wood.2", once.materials["wood"])
    assert len(pickle.dumps(both)) < len(pickle.dumps(once)) + 200
    assert both.materials["wood.2"].texture is not None


# All are the same grey or colour, from the same 8-bit codes.
CODES = np.array([[0, 51], [153, 255]])
SAME = {
    "grey uint8": CODES.astype(np.uint8),
    "grey with an axis": CODES[..., None].astype(np.uint8),
    "rgb": CODES[..., None].repeat(3, 2).astype(np.uint8),
    "rgba": np.dstack([CODES] * 3 + [np.full((2, 2), 255)]).astype(np.uint8),
    "int64": CODES,
    "lists": CODES.tolist(),
    "big-endian": CODES.astype(">i4"),
    "not contiguous": np.asfortranarray(CODES),
}


@pytest.mark.parametrize("what", SAME)
def test_a_texture_is_what_its_array_says(what: str) -> None:
    texture = rc.Material(texture=SAME[what]).texture
    assert texture is not None
    np.testing.assert_array_equal(texture[..., :3], CODES[..., None].repeat(3, 2))
    assert (texture[..., 3] == 255).all()
    assert wall([WOOD]).with_texture(0, SAME[what]) == wall([WOOD]).with_texture(0, SAME["rgba"])


FRACTIONS = {
    "float64": CODES / 255,
    "float32": (CODES / 255).astype(np.float32),
    "float16": (CODES / 255).astype(np.float16),
    "not contiguous": np.asfortranarray(CODES / 255),
}


@pytest.mark.parametrize("what", FRACTIONS)
def test_fractions_are_the_same_colours(what: str) -> None:
    texture = rc.Material(texture=FRACTIONS[what]).texture
    assert texture is not None and texture.dtype == np.float32
    v = np.asarray(FRACTIONS[what], float)
    linear = np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)
    np.testing.assert_allclose(texture[..., :3], linear[..., None].repeat(3, 2), rtol=1e-6)
    assert (texture[..., 3] == 1).all()


def test_colours_stay_as_given_whatever_alpha_says() -> None:
    pixels = np.array([[[200, 100, 50, 128], [200, 100, 50, 0]]], np.uint8)
    texture = rc.Material(texture=pixels).texture
    np.testing.assert_array_equal(texture, pixels)


@pytest.mark.parametrize(
    ("pixels", "complaint"),
    [
        ([[0, 300]], r"between 0.0 and 300.0; expected integers from 0 to 255"),
        ([[-1, 0]], r"between -1.0 and 0.0; expected integers"),
        ([[0.5, 1.001]], r"between 0.5 and 1.001; expected floats from 0 \(black\) to 1 \(white\)"),
        ([[0.5, -0.001]], "floats from 0"),
        ([[0.5, np.nan]], "floats from 0"),
        ([[0.5, np.inf]], "floats from 0"),
        ([[True]], "must hold integers"),
        ([[1j]], "must hold integers"),
        ([1, 2, 3], r"shape \(H, W\), \(H, W, 3\) or \(H, W, 4\)"),
        (np.zeros((2, 2, 5)), "shape"),
        (np.zeros((0, 2, 3)), "shape"),
        ([[1, 2], [3]], "shape"),
        (None, "shape"),
    ],
)
def test_what_is_no_texture_is_refused(pixels: object, complaint: str) -> None:
    with pytest.raises(rc.InputError, match=complaint):
        wall([WOOD]).with_texture(0, pixels)  # type: ignore[arg-type]


def test_a_texture_needs_coordinates() -> None:
    bare = rc.Scene.from_arrays([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    with pytest.raises(rc.InputError, match="no texture coordinates"):
        bare.with_texture(0, [[1]])


def test_a_texture_that_is_too_large_is_refused_before_it_is_copied() -> None:
    """The array is one number, seen as 40000 x 40000."""
    pixels = np.broadcast_to(np.uint8(3), (40000, 40000, 3))
    begin = time.monotonic()
    with pytest.raises(rc.InputError, match=r"a texture of 40000 x 40000 pixels is too large; at most 256 million"):
        wall([WOOD]).with_texture(0, pixels)
    assert time.monotonic() - begin < 0.5
