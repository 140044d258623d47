"""rc.Scene and Material as a user meets them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

CORNERS = np.array([[0, 0, -3], [1, 0, -3], [0, 1, -3.0]])
FACE = np.array([[0, 1, 2]])


def test_a_scene_counts_and_bounds() -> None:
    scene = rc.Scene.from_arrays(CORNERS, FACE)
    assert (scene.triangle_count, scene.material_count, scene.has_light) == (1, 1, False)
    np.testing.assert_array_equal(scene.bounds_m, [[0, 0, -3], [1, 1, -3]])
    assert scene.warnings == []
    assert scene.with_environment(1.0).has_light
    assert rc.Scene.from_arrays(CORNERS, FACE, materials=[rc.Material(emission=(0, 1, 0))]).has_light


def test_arrays_of_many_types_lists_and_strided_arrays() -> None:
    wide = np.zeros((3, 6))
    wide[:, ::2] = CORNERS
    for vertices, faces in (
        *((CORNERS.astype(kind), FACE) for kind in (np.float32, np.float64, np.int64)),
        *((CORNERS, FACE.astype(index)) for index in (np.uint8, np.int32, np.uint32, np.int64, np.uint64)),
        (CORNERS.tolist(), FACE.tolist()),
        (wide[:, ::2], np.asfortranarray(np.repeat(FACE, 2, axis=0))[::2]),
        (CORNERS[::-1], [[2, 1, 0]]),
    ):
        scene = rc.Scene.from_arrays(vertices, faces, triangle_materials=np.zeros(1, np.asarray(faces).dtype))
        np.testing.assert_array_equal(scene.bounds_m, [[0, 0, -3], [1, 1, -3]])


@pytest.mark.parametrize(
    ("arguments", "says"),
    # tests/cpp/scene/test_scene_checks.cpp tests the ranges of the numbers of a scene.
    [
        ({"vertices_m": np.zeros((3, 2))}, r"vertices_m must be an array of shape \(N, 3\)"),
        ({"triangles": [0, 1, 2]}, r"triangles .*\(N, 3\)"),
        ({"triangles": np.zeros((0, 3), int)}, "no triangles"),
        ({"triangles": [[0, 1, 2**40]]}, "vertex 1099511627776"),
        ({"triangles": [[0.5, 1, 2]]}, "integers"),
        ({"triangles": [[0, 0, 0]]}, "zero area"),
        ({"normals": np.zeros((3, 2))}, r"normals .*\(N, 3\)"),
        ({"uvs": np.zeros((3, 3))}, r"uvs .*\(N, 2\)"),
        ({"uvs": np.full((3, 2), math.nan)}, "finite"),
        ({"triangle_materials": [0, 0]}, "one index for each triangle"),
        ({"triangle_materials": [0.0]}, "integers"),
        ({"materials": [rc.Material(shininess=-1)]}, "material 0.*exponent"),
    ],
)
def test_arrays_that_make_no_scene(arguments: dict[str, object], says: str) -> None:
    with pytest.raises(rc.RealcamError, match=says) as caught:
        rc.Scene.from_arrays(**{"vertices_m": CORNERS, "triangles": FACE, **arguments})  # type: ignore[arg-type]
    assert isinstance(caught.value, (rc.InputError, rc.SceneFileError))
    assert "\n" not in str(caught.value)


def test_triangles_without_area_are_dropped_and_named() -> None:
    scene = rc.Scene.from_arrays(CORNERS, [[0, 1, 2], [0, 1, 1]])
    assert scene.triangle_count == 1
    assert any("without area" in warning for warning in scene.warnings)


NO_ENVIRONMENT = {
    "negative": -1,
    "past all measure": 1e31,
    "nan": math.nan,
    "infinite": math.inf,
    "two numbers": (1, 2),
    "negative colour": (1, 2, -3),
    "an object": object(),
    "flat image": np.zeros((3, 4)),
    "four channels": np.zeros((2, 4, 4)),
    "empty image": np.zeros((0, 4, 3)),
    "negative image": np.full((2, 4, 3), -1.0),
    "nan image": np.full((2, 4, 3), math.nan),
}


@pytest.mark.parametrize("radiance", NO_ENVIRONMENT.values(), ids=NO_ENVIRONMENT.keys())
def test_an_environment_that_is_none(radiance: object) -> None:
    with pytest.raises(rc.InputError, match="environment"):
        rc.Scene.from_arrays(CORNERS, FACE).with_environment(radiance)  # type: ignore[arg-type]


def test_lights_that_are_none() -> None:
    scene = rc.Scene.from_arrays(CORNERS, FACE)
    for direction in ((0, 0, 0), (math.nan, 0, 0), (math.inf, 0, 0)):
        with pytest.raises(rc.InputError, match="direction"):
            scene.with_sun(direction, (1, 1, 1))
    with pytest.raises(rc.InputError, match="position"):
        scene.with_point_light((0, math.nan, 0), (1, 1, 1))
    for bad in (1e31, math.inf, math.nan, -1.0):
        with pytest.raises(rc.InputError, match=r"illuminance.*between 0 and 1e"):
            scene.with_sun((0, -1, 0), (bad, 1, 1))
        with pytest.raises(rc.InputError, match=r"intensity.*between 0 and 1e"):
            scene.with_point_light((0, 1, 0), (1, bad, 1))


def test_scenes_are_values() -> None:
    scene = rc.Scene.from_arrays(CORNERS, FACE)
    lit = scene.with_environment((1, 2, 3)).with_sun((0, -1, 0), (1, 1, 1)).with_point_light((0, 1, 0), (1, 1, 1))
    assert lit.has_light
    assert not scene.has_light
    vertices = CORNERS.copy()
    kept = rc.Scene.from_arrays(vertices, FACE)
    vertices[:] = 99
    np.testing.assert_array_equal(kept.bounds_m, [[0, 0, -3], [1, 1, -3]])
    # An environment replaces the one before; lights add up.
    camera = scenes.pinhole()
    one = rc.render(scenes.sky(5.0).with_environment(1.0), camera, effects=(), spp=1).pixels
    np.testing.assert_array_equal(one, rc.render(scenes.sky(1.0), camera, effects=(), spp=1).pixels)


def write_obj(folder: Path) -> Path:
    (folder / "wall.mtl").write_text("newmtl red\nKd 0.8 0.1 0.1\n")
    path = folder / "wall.obj"
    path.write_text("mtllib wall.mtl\nv -1 -1 -3\nv 1 -1 -3\nv 1 1 -3\nv -1 1 -3\nusemtl red\nf 1 2 3 4\n")
    return path


def test_an_obj_from_any_kind_of_path_and_in_other_units(tmp_path: Path) -> None:
    path = write_obj(tmp_path)
    for form in (path, str(path)):
        scene = rc.Scene.load(form)
        assert scene.triangle_count == 2
        np.testing.assert_array_equal(scene.bounds_m, [[-1, -1, -3], [1, 1, -3]])
    small = rc.Scene.load(path, scale=0.01)
    np.testing.assert_allclose(small.bounds_m, [[-0.01, -0.01, -0.03], [0.01, 0.01, -0.03]], rtol=1e-12)
    camera = scenes.pinhole()
    measured = scenes.radiance(rc.Scene.load(path).with_environment(1.0), camera)
    np.testing.assert_allclose(measured[8, 12], (0.8, 0.1, 0.1), rtol=1e-5)
    for wrong in (0, -1, math.nan):
        with pytest.raises(rc.InputError, match="scale"):
            rc.Scene.load(path, scale=wrong)


def test_a_missing_texture_is_a_warning_and_seen(tmp_path: Path) -> None:
    path = write_obj(tmp_path)
    (tmp_path / "wall.mtl").write_text("newmtl red\nKd 0.8 0.8 0.8\nmap_Kd nowhere.png\n")
    path.write_text(
        path.read_text()
        .replace("usemtl", "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl")
        .replace("f 1 2 3 4", "f 1/1 2/2 3/3 4/4")
    )
    scene = rc.Scene.load(path)
    assert any("nowhere.png" in warning for warning in scene.warnings)
    measured = scenes.radiance(scene.with_environment(1.0), scenes.pinhole())
    # The stand-in texture is colourful, so that nobody mistakes it for the real one.
    assert np.ptp(measured[8, 12]) > 0.3 or np.ptp(measured[..., 0]) > 0.3
