"""Animations of glTF files: how their nodes move, by the formulas of the format (glTF 2.0, appendix C)."""

from __future__ import annotations

import base64
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc

from .. import scenes


class Gltf:
    """A file with one triangle and nodes that show it."""

    def __init__(self) -> None:
        self.data = b""
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.nodes: list[dict[str, Any]] = []
        self.animations: list[dict[str, Any]] = []
        self.begin_animation("walk")
        self.cameras: list[dict[str, Any]] = []
        self.triangle = self.array(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), "VEC3")
        self.primitive: dict[str, Any] = {"attributes": {"POSITION": self.triangle}}

    def array(self, numbers: object, kind: str) -> int:
        raw = np.asarray(numbers, np.float32)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": raw.nbytes})
        count = raw.size // {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[kind]
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": 5126, "count": count, "type": kind})
        self.data += raw.tobytes()
        return len(self.accessors) - 1

    def node(self, name: str, **keys: Any) -> int:
        self.nodes.append({"name": name, "mesh": 0, **keys})
        return len(self.nodes) - 1

    def begin_animation(self, name: str) -> None:
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []
        self.animations.append({"name": name, "samplers": self.samplers, "channels": self.channels})

    def animate(self, node: int, path: str, times: object, values: object, interpolation: str = "LINEAR") -> None:
        kind = {"rotation": "VEC4", "weights": "SCALAR"}.get(path, "VEC3")
        sampler = {"input": self.array(times, "SCALAR"), "output": self.array(values, kind)}
        self.samplers.append({**sampler, "interpolation": interpolation})
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})

    def load(self, folder: Path, **options: Any) -> rc.Scene:
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        file = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": len(self.data), "uri": uri}],
            "bufferViews": self.views,
            "accessors": self.accessors,
            "meshes": [{"primitives": [self.primitive]}],
            "nodes": self.nodes,
            "cameras": self.cameras,
            "animations": self.animations,
        }
        path = folder / "animated.gltf"
        path.write_text(json.dumps(file))
        return rc.Scene.load(path, **options)


def about_y(angle: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[0, 0] = matrix[2, 2] = np.cos(angle)
    matrix[0, 2], matrix[2, 0] = np.sin(angle), -np.sin(angle)
    return matrix


def shifted(*shift: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = shift
    return matrix


def at(scene: rc.Scene, name: str, time: float) -> np.ndarray:
    return dict(scene.at_time(time).instances)[name]


def test_translation_rotation_and_scale_by_keys(tmp_path: Path) -> None:
    gltf = Gltf()
    ball = gltf.node("ball", translation=[7, 7, 7])
    gltf.animate(ball, "translation", [1, 2, 4], [[0, 0, 0], [1, 0, 0], [1, 4, 0]])
    gltf.animate(ball, "rotation", [1, 3], [[0, 0, 0, 1], [0, np.sin(0.6), 0, np.cos(0.6)]])
    gltf.animate(ball, "scale", [1, 2], [[1, 1, 1], [3, 2, 1]])
    scene = gltf.load(tmp_path, scale=0.5)
    for time in np.linspace(0, 5, 41):
        place = [np.interp(time, [1, 2, 4], column) for column in ([0, 1, 1], [0, 0, 4], [0, 0, 0])]
        size = [np.interp(time, [1, 2], [1, s]) for s in (3, 2, 1)]
        turn = about_y(np.interp(time, [1, 3], [0, 1.2]))
        expected = shifted(*(0.5 * np.array(place))) @ turn @ np.diag([*size, 1])
        np.testing.assert_allclose(at(scene, "ball", time), expected, atol=1e-6)


def test_steps_and_splines(tmp_path: Path) -> None:
    gltf = Gltf()
    flag, swing = gltf.node("flag"), gltf.node("swing")
    gltf.animate(flag, "translation", [0, 1, 2], [[0, 0, 0], [1, 0, 0], [5, 0, 0]], "STEP")
    rows = [[[0, 0, 0], [0, 0, 0], [0, 3, 0]], [[0, -1, 0], [2, 1, 0], [0, 0, 0]]]  # tangent, value, tangent
    gltf.animate(swing, "translation", [0, 2], rows, "CUBICSPLINE")
    scene = gltf.load(tmp_path)
    assert [at(scene, "flag", t)[0, 3] for t in (0.0, 0.5, 0.999, 1.0, 1.5, 2.0, 3.0)] == pytest.approx(
        [0, 0, 0, 1, 1, 5, 5], abs=1e-9
    )
    for t in np.linspace(0, 1, 21):
        x = 2 * (3 * t**2 - 2 * t**3)
        y = 2 * 3 * (t**3 - 2 * t**2 + t) + (3 * t**2 - 2 * t**3) + 2 * -1 * (t**3 - t**2)
        # Keys stand as dense as a millionth of the way of each wants, or 128 to a segment: chords of 1/128 of it.
        np.testing.assert_allclose(at(scene, "swing", 2 * t)[:2, 3], [x, y], atol=2e-4)


def test_nodes_move_with_those_above_them(tmp_path: Path) -> None:
    gltf = Gltf()
    wheel = gltf.node("wheel", translation=[2, 0, 0])
    lamp = gltf.node("lamp", translation=[0, 1, 0])
    car = gltf.node("car", children=[wheel, lamp])
    gltf.node("street")
    gltf.animate(car, "rotation", [0, 1], [[0, 0, 0, 1], [0, np.sin(0.75), 0, np.cos(0.75)]])
    gltf.animate(wheel, "rotation", [0, 1], [[0, 0, 0, 1], [0, np.sin(1), 0, np.cos(1)]])
    scene = gltf.load(tmp_path)
    assert [name for name, _ in scene.instances] == ["car", "wheel"]
    assert scene.triangle_count == 4
    for t in np.linspace(0, 1, 11):
        np.testing.assert_allclose(at(scene, "car", t), about_y(1.5 * t), atol=1e-6)
        np.testing.assert_allclose(
            at(scene, "wheel", t), about_y(1.5 * t) @ shifted(2, 0, 0) @ about_y(2 * t), atol=1e-4
        )
    parked = scene.moved("car", shifted(0, 0, 9))
    np.testing.assert_allclose(at(parked, "wheel", 0.5), shifted(0, 0, 9) @ shifted(2, 0, 0) @ about_y(1), atol=1e-4)
    named = gltf.load(tmp_path, objects=["lamp"])
    assert [name for name, _ in named.instances] == ["car", "wheel", "lamp"]
    np.testing.assert_allclose(at(named, "lamp", 0.5), about_y(0.75) @ shifted(0, 1, 0), atol=1e-4)


def test_keys_that_change_nothing_make_no_object(tmp_path: Path) -> None:
    gltf = Gltf()
    node = gltf.node("box")
    gltf.animate(node, "translation", [0, 1], [[1, 2, 3]] * 2)
    gltf.animate(node, "scale", [0, 1], [[0, 0, 0], [1, 1, 1], [0, 0, 0]] * 2, "CUBICSPLINE")
    scene = gltf.load(tmp_path)
    assert scene.instances == ()
    assert scene.bounds_m == ((1, 2, 3), (2, 3, 3))


def test_what_is_not_played_is_said(tmp_path: Path) -> None:
    gltf = Gltf()
    node = gltf.node("box")
    gltf.node("fixed", matrix=np.eye(4).ravel().tolist())
    gltf.animate(node, "scale", [0, 1], [[1, 1, 1], [0, 0, 0]])
    gltf.animate(1, "translation", [0, 1], [[0, 0, 0], [1, 0, 0]])
    gltf.channels.append({"sampler": 0, "target": {"node": 0, "path": "weights"}})
    scene = gltf.load(tmp_path)
    warnings = "\n".join(scene.warnings)
    assert 'animation 0 "walk": 1 channels animate the weights of a mesh without morph targets' in warnings
    assert "1 channels animate nodes that have a matrix" in warnings
    assert 'node "box" is scaled to zero while it moves, and stays as it is at time 0' in warnings
    assert scene.motions == (None,)
    np.testing.assert_array_equal(at(scene, "box", 1), np.eye(4))


def test_animations_of_different_objects_play_together(tmp_path: Path) -> None:
    """One animation for each object, as Blender's exporter writes them, and one for the camera."""
    gltf = Gltf()
    ball, box = gltf.node("ball"), gltf.node("box", translation=[0, 0, -5])
    gltf.cameras.append({"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}})
    gltf.nodes.append({"name": "eye", "camera": 0, "translation": [0, 0, 9]})
    gltf.animate(ball, "translation", [0, 1], [[0, 0, 0], [1, 0, 0]])
    gltf.begin_animation("box rises")
    gltf.animate(box, "translation", [0, 2], [[0, 0, -5], [0, 4, -5]])
    gltf.begin_animation("box turns")
    gltf.animate(box, "rotation", [0, 2], [[0, 0, 0, 1], [0, np.sin(0.5), 0, np.cos(0.5)]])
    gltf.begin_animation("dolly")
    gltf.animate(2, "translation", [0, 4], [[0, 0, 9], [0, 0, 5]])
    scene = gltf.load(tmp_path)
    assert not scene.warnings
    np.testing.assert_allclose(at(scene, "ball", 0.5), shifted(0.5, 0, 0), atol=1e-6)
    np.testing.assert_allclose(at(scene, "box", 1), shifted(0, 2, -5) @ about_y(0.5), atol=1e-6)
    eye = rc.Shot.load(tmp_path / "animated.gltf", spp=1, exposure_time_s=0.01).camera
    np.testing.assert_allclose(np.subtract(eye.pose_at(2)[0], eye.pose_at(0)[0]), [0, 0, -2], atol=1e-6)


def test_a_property_follows_the_first_animation_that_moves_it(tmp_path: Path) -> None:
    gltf = Gltf()
    leg, arm = gltf.node("leg"), gltf.node("arm")
    gltf.animate(leg, "translation", [0, 1], [[0, 0, 0], [1, 0, 0]])
    gltf.begin_animation("run")
    gltf.animate(leg, "translation", [0, 1], [[0, 0, 0], [0, 9, 0]])
    gltf.begin_animation("wave")
    gltf.animate(arm, "translation", [0, 1], [[0, 0, 0], [0, 0, 2]])
    gltf.animate(leg, "translation", [0, 1], [[0, 0, 0], [0, 7, 0]])
    scene = gltf.load(tmp_path)
    np.testing.assert_allclose(at(scene, "leg", 0.5), shifted(0.5, 0, 0), atol=1e-6)
    np.testing.assert_allclose(at(scene, "arm", 0.5), shifted(0, 0, 1), atol=1e-6)
    (notice,) = scene.warnings
    assert 'animation 1 "run", animation 2 "wave": channels for properties that an earlier animation moves' in notice


def test_a_malformed_transform_is_left_out_with_a_warning(tmp_path: Path) -> None:
    gltf = Gltf()
    gltf.animate(gltf.node("moving"), "translation", [0, 1], [[0, 0, 0], [1, 0, 0]])
    for wrong in ({"matrix": [1, 2, 3]}, {"translation": "x"}, {"rotation": [0, 0, 1]}, {"scale": [1, 1, None]}):
        gltf.node("box", **wrong)
    assert "4 nodes have a malformed matrix, translation, rotation or scale" in "\n".join(gltf.load(tmp_path).warnings)


def rising_wall(tmp_path: Path) -> rc.Scene:
    """A triangle of 40 m in the plane z = -10 that moves to z = -5 from 0 to 4 s, by a morph target."""
    gltf = Gltf()
    corners = np.array([[-20, -20, -10], [20, -20, -10], [0, 20, -10]])
    gltf.primitive = {
        "attributes": {"POSITION": gltf.array(corners, "VEC3")},
        "targets": [{"POSITION": gltf.array(np.array([[0, 0, 5]] * 3), "VEC3")}],
    }
    gltf.animate(gltf.node("wall"), "weights", [0, 4], [0, 1])
    return gltf.load(tmp_path).with_environment(1)


def test_a_picture_shows_a_mesh_that_deforms_in_the_middle_of_its_exposure(tmp_path: Path, device: str) -> None:
    scene = rising_wall(tmp_path)
    for effects in ((), ("-motion_blur", "-rolling_shutter")):
        camera = scenes.pinhole()
        session = rc.Session(scene, camera, device=device, effects=effects)
        for opens_s, exposure_s, readout_s in ((0, 1, 0), (0, 3, 0), (2, 1, 0.5), (6, 1, 0)):
            view = camera.replace(shutter_opens_s=opens_s, exposure_time_s=exposure_s, readout_time_s=readout_s)
            middle_s = opens_s + (exposure_s + (0 if effects else readout_s)) / 2
            session.set(camera=view)
            session.add(1)
            # Depth is measured from the film's centre along the axis, as a float.
            depth = session.image().depth[8, 12]
            assert depth == pytest.approx(camera.position[2] + 10 - 1.25 * min(middle_s, 4), rel=1e-5)
            # Samples of the same shape add up.
            session.set(camera=view)
            session.add(1)
            assert session.image().spp == 2


def test_a_scene_that_deforms_has_its_shape_at_any_time_and_after_a_pickle(tmp_path: Path) -> None:
    scene = rising_wall(tmp_path)
    for copied in (scene, pickle.loads(pickle.dumps(scene))):
        assert copied == scene
        for time in (0, 1, 4, 9):
            assert copied.at_time(time).bounds_m[0][2] == pytest.approx(-10 + 1.25 * min(time, 4))
    assert "1 meshes change their shape over time" in "\n".join(scene.warnings)
    assert scene.bounds_m[0][2] == -10  # at time 0


@pytest.mark.parametrize(
    ("times", "values", "interpolation", "required"),
    [
        ([0, 0], [[0, 0, 0]] * 2, "LINEAR", "channel 0: its times must be strictly increasing"),
        ([0, np.nan], [[0, 0, 0]] * 2, "LINEAR", "a time must lie within 1e9 s"),
        ([0, 1], [[0, 0, 0]] * 3, "LINEAR", "has 2 times and 3 values; expected 1 for each"),
        ([0, 1], [[0, 0, 0]] * 2, "CUBICSPLINE", "has 2 times and 2 values; expected 3 for each"),
        ([0, 1], [[0, np.inf, 0]] * 2, "LINEAR", "not finite"),
        ([0, 1], [[0, 0, 0]] * 2, "SWING", 'its interpolation is "SWING"; expected LINEAR, STEP or CUBICSPLINE'),
        ([], [], "LINEAR", "has 0 times"),
    ],
)
def test_keys_that_are_none_are_refused(
    tmp_path: Path, times: list[float], values: list[list[float]], interpolation: str, required: str
) -> None:
    gltf = Gltf()
    gltf.animate(gltf.node("box"), "translation", times, values, interpolation)
    with pytest.raises(rc.SceneFileError, match=required):
        gltf.load(tmp_path)
