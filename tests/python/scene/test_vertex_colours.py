"""Colours of vertices in pictures, and the cameras of a glTF, as Python has them. Under an even sky of radiance 1 a
diffuse surface that faces the camera has its own colour.
"""

from __future__ import annotations

import json
import pickle
import struct
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

CORNERS = np.array([[-9, -9, -2], [9, -9, -2], [9, 9, -2], [-9, 9, -2]], float)
FACES = [[0, 1, 2], [0, 2, 3]]


def seen(scene: rc.Scene) -> np.ndarray:
    """In the middle of the picture, which is the middle of the square."""
    return scenes.radiance(scene, scenes.pinhole())[7:9, 11:13].mean(axis=(0, 1))


def square(colors: np.ndarray, **material: object) -> rc.Scene:
    return rc.Scene.from_arrays(CORNERS, FACES, colors=colors, materials=[rc.Material(**material)])


def test_scenes_with_colours_are_values() -> None:
    scene = square(np.array([[1, 0, 0, 0.5]] * 4))
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert scene != square(np.array([[1, 0, 0, 0.25]] * 4))
    for wrong in (np.ones((3, 3)), np.ones((4, 2)), -np.ones((4, 3)), np.full((4, 4), 2.0), np.full((4, 3), np.nan)):
        with pytest.raises((rc.InputError, rc.SceneFileError), match="colo"):
            square(wrong)


def test_instances_and_large_triangles_keep_their_colours() -> None:
    """A triangle that reaches far beyond its distance is cut into pieces (split_triangles.hpp)."""
    colors = np.array([[0.9, 0.1, 0.3], [0.1, 0.9, 0.3], [0.9, 0.1, 0.3], [0.1, 0.9, 0.3]])
    small = square(colors, diffuse=(1, 1, 1))
    expected = (0.9, 0.1, 0.3)
    np.testing.assert_allclose(seen(small.with_environment(1.0)), expected, atol=0.04 / 18)
    far = np.concatenate([1e4 * CORNERS[:, :2], CORNERS[:, 2:]], axis=1)
    large = rc.Scene.from_arrays(far, FACES, colors=colors, materials=[rc.Material(diffuse=(1, 1, 1))])
    np.testing.assert_allclose(seen(large.with_environment(1.0)), expected, atol=1e-5)
    instanced = scenes.sky(1.0).with_instance(small)
    np.testing.assert_allclose(seen(instanced), expected, atol=0.04 / 18)


def write_gltf(path: Path, nodes: list[dict[str, object]], cameras: list[dict[str, object]]) -> None:
    data = CORNERS.astype("<f4").tobytes() + np.array(FACES, "<u2").tobytes()
    path.with_suffix(".bin").write_bytes(data)
    path.write_text(
        json.dumps(
            {
                "asset": {"version": "2.0"},
                "scenes": [{"nodes": list(range(len(nodes)))}],
                "nodes": nodes,
                "cameras": cameras,
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                "accessors": [
                    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
                ],
                "bufferViews": [
                    {"buffer": 0, "byteLength": 48},
                    {"buffer": 0, "byteOffset": 48, "byteLength": 12},
                ],
                "buffers": [{"byteLength": len(data), "uri": path.with_suffix(".bin").name}],
            }
        )
    )


PERSPECTIVE = {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}


def test_cameras_of_a_gltf_in_python_and_shot_files(tmp_path: Path) -> None:
    turn = [0, float(np.sqrt(0.5)), 0, float(np.sqrt(0.5))]
    nodes = [
        {"mesh": 0},
        {"name": "front", "camera": 0, "translation": [1, 2, 7]},
        {"name": "aside", "camera": 0, "translation": [20, 0, 0], "rotation": turn},
    ]
    write_gltf(tmp_path / "a.gltf", nodes, [PERSPECTIVE])
    scene = rc.Scene.load(tmp_path / "a.gltf")
    assert [name for name, _, _ in scene.cameras] == ["front", "aside"]
    np.testing.assert_allclose(scene.cameras[0][1], [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 7], [0, 0, 0, 1]])
    assert scene.cameras[1][2] == pytest.approx(np.degrees(0.5))
    assert pickle.loads(pickle.dumps(scene)).cameras[1][0] == "aside"

    lens = rc.Lens.load("double-gauss-50mm")
    camera = rc.Camera(lens).framing(scene)
    np.testing.assert_allclose(camera.entrance_pupil_position_m, (1, 2, 7), atol=1e-6)
    aside = rc.Camera(lens).framing(scene, scene_camera="aside", focus_distance_m=20)
    np.testing.assert_allclose(aside.entrance_pupil_position_m, (20, 0, 0), atol=1e-6)
    np.testing.assert_allclose(np.subtract(aside.look_at, aside.position), (-1, 0, 0), atol=1e-9)
    own = rc.Camera(lens).framing(scene, scene_camera="none")
    assert own.position[:2] == pytest.approx((0, 0))

    text = 'format = 1\nscene = "a.gltf"\nexposure_time_s = 1\n'
    (tmp_path / "shot.toml").write_text(text)
    assert rc.Shot.load(tmp_path / "shot.toml").camera.position == camera.position
    (tmp_path / "shot.toml").write_text(text + 'camera = "aside"\nfocus_m = 20\n')
    assert rc.Shot.load(tmp_path / "shot.toml").camera.position == aside.position
    for line, why in {
        'camera = "x"': 'the scene has no camera "x"; it has "front", "aside"',
        "camera = ''": ':4: "camera" is empty',
        'camera = "front"\nposition_m = [0, 0, 1]': '"position_m" and "camera" exclude each other',
    }.items():
        (tmp_path / "shot.toml").write_text(text + line)
        with pytest.raises(rc.InputError, match=why):
            rc.Shot.load(tmp_path / "shot.toml")


def test_a_camera_that_moves_moves(tmp_path: Path) -> None:
    write_gltf(tmp_path / "a.gltf", [{"mesh": 0}, {"name": "dolly", "camera": 0}], [PERSPECTIVE])
    document = json.loads((tmp_path / "a.gltf").read_text())
    (tmp_path / "keys.bin").write_bytes(struct.pack("<2f", 0, 2) + struct.pack("<6f", 0, 0, 5, 4, 0, 5))
    document["buffers"].append({"byteLength": 32, "uri": "keys.bin"})
    document["bufferViews"] += [{"buffer": 1, "byteLength": 8}, {"buffer": 1, "byteOffset": 8, "byteLength": 24}]
    document["accessors"] += [
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR"},
        {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"},
    ]
    document["animations"] = [
        {
            "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
            "samplers": [{"input": 2, "output": 3}],
        }
    ]
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    camera = rc.Camera(rc.Lens.load("double-gauss-50mm"), shutter_opens_s=1.0).framing(
        rc.Scene.load(tmp_path / "a.gltf")
    )
    times, positions = zip(*[(key[0], key[1]) for key in camera.motion], strict=True)
    np.testing.assert_allclose(np.interp(1.0, times, [p[0] for p in positions]), 2.0, atol=1e-6)
