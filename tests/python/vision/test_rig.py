"""Cameras that are fixed to one another: where they stand, what they see, and how they are calibrated."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam.vision import save_colmap_of_rig

from .. import scenes
from .test_vision import quaternion_matrix

BASELINE_M = 0.1


def camera(**changes: object) -> rc.Camera:
    lens = rc.Lens.load("double-gauss-50mm").focused(2)
    stands = {"film": rc.Film(36, 24, (48, 32)), "position": (1, 2, 3), "look_at": (0.2, 0.1, -0.4), "iso": 100}
    return rc.Camera(lens, **stands).replace(**changes)  # type: ignore[arg-type]


def turned(degrees: float, shift: tuple[float, float, float] = (0, 0, 0)) -> np.ndarray:
    """About the vertical, then shifted."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    pose = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1.0]])
    pose[:3, 3] = shift
    return pose


def floor() -> rc.Scene:
    return scenes.scene_of(scenes.quad((0, 0, 0), 3, up=(0, 0, -1), diffuse=0.5)).with_environment(500)


def test_a_stereo_pair_stands_beside_its_camera_and_has_the_pose_of_opencv() -> None:
    rig = rc.Rig.stereo(camera(), baseline_m=BASELINE_M)
    left, right = rig.cameras["left"], rig.cameras["right"]
    # The cameras are centred on the original camera and have its orientation, to the rounding of numbers of about 3.
    assert np.add(left.position, right.position) / 2 == pytest.approx((1, 2, 3), abs=1e-14)
    assert np.linalg.norm(np.subtract(right.position, left.position)) == pytest.approx(BASELINE_M, abs=1e-14)
    for each in (left, right):
        assert each.world_to_camera[0] == pytest.approx(camera().world_to_camera[0], abs=1e-14)
    # OpenCV's stereo geometry: a point at x in the left camera is at x - baseline in the right one.
    rotation, translation = rig.relative_pose("right", "left")
    assert rotation == pytest.approx(np.eye(3), abs=1e-14)
    assert translation == pytest.approx((-BASELINE_M, 0, 0), abs=1e-14)


def test_disparity_of_a_far_point_is_baseline_times_focal_length_over_depth() -> None:
    rig = rc.Rig.stereo(camera(position=(0, 0, 0), look_at=(0, 0, -1)), baseline_m=BASELINE_M)
    left, right = rig.cameras["left"], rig.cameras["right"]
    pupil_m = left.entrance_pupil_position_m
    assert pupil_m is not None
    depth_m = 2.0 + pupil_m[2]  # of the plane in focus, from the pupil
    point = [[0.0, 0.0, -2.0]]
    (left_x, _), (right_x, _) = left.project(point)[0], right.project(point)[0]
    required = BASELINE_M / depth_m * left.camera_matrix[0, 0]
    # The film is where the picture is sharpest, some tenths of a percent from where first-order optics has it.
    assert left_x - right_x == pytest.approx(required, rel=3e-3)


def test_toe_in_crosses_the_axes_where_the_triangle_says() -> None:
    toe_in_deg = 3.0
    rig = rc.Rig.stereo(camera(position=(0, 0, 0), look_at=(0, 0, -1)), baseline_m=BASELINE_M, toe_in_deg=toe_in_deg)
    distance = BASELINE_M / 2 / np.tan(np.radians(toe_in_deg))
    for each in rig.cameras.values():
        column, row = each.project([[0, 0, -distance]])[0]
        assert (column, row) == pytest.approx((24, 16), abs=1e-4)  # the middle of the film


def test_a_moved_rig_takes_its_cameras_and_their_motions_along() -> None:
    far = camera(motion=[(0, (0, 0, 0), (0, 0, -1), (0, 1, 0)), (0.1, (0, 0, 1), (0, 0, 0), (0, 1, 0))])
    rig = rc.Rig({"still": camera(position=(0, 0, 1), look_at=(0, 0, 0)), "moving": far})
    pose = turned(90, (5, 0, 0))  # z becomes x
    cameras = rig.moved(pose).cameras
    assert cameras["still"].position == pytest.approx((6, 0, 0), abs=1e-15)
    assert cameras["still"].look_at == pytest.approx((5, 0, 0), abs=1e-15)
    times, places = zip(*((key[0], key[1]) for key in cameras["moving"].motion), strict=True)
    assert times == (0, 0.1)
    assert np.array(places) == pytest.approx(np.array([(5, 0, 0), (6, 0, 0)]), abs=1e-15)
    # Poses among the members do not change.
    before, after = rig.relative_pose("still", "moving"), rig.moved(pose).relative_pose("still", "moving")
    assert before[0] == pytest.approx(after[0])
    assert before[1] == pytest.approx(after[1])


def test_a_rig_that_moves_gives_its_cameras_motions() -> None:
    rig = rc.Rig.stereo(camera(position=(0, 0, 0), look_at=(0, 0, -1)), baseline_m=BASELINE_M)
    moving = rig.moved([turned(0), turned(0, (1, 0, 0))], times_s=(0, 0.5))
    keys = moving.cameras["right"].motion
    assert [key[0] for key in keys] == [0, 0.5]
    assert keys[1][1] == pytest.approx((1 + BASELINE_M / 2, 0, 0))
    with pytest.raises(rc.InputError, match="no single pose"):
        moving.calibration()


def test_pictures_of_a_rig_are_those_of_its_cameras() -> None:
    scene = floor()
    tele = camera(lens=rc.Lens.load("tessar-50mm").focused(4), position=(0, 0.3, 0.1), look_at=(0, 0, -2))
    rig = rc.Rig({"wide": camera(position=(0, 0.3, 0), look_at=(0, 0, -2)), "tele": tele})
    images = rig.render(scene, spp=4, effects=(), seed=7, device="cpu")
    assert list(images) == ["wide", "tele"]
    for number, (name, each) in enumerate(rig.cameras.items()):
        assert images[name] == rc.render(scene, each, spp=4, effects=(), seed=7 + number, device="cpu")


def test_a_spectral_filter_lets_the_share_of_its_transmission_through() -> None:
    film = rc.Film(48 * 5.86e-3, 32 * 5.86e-3, (48, 32))  # pixels of the sensor
    rig_camera = camera(film=film, position=(0, 0.5, 0), look_at=(0, 0, -1), iso=800, exposure_time_s=1e-4)
    sensor = rc.Sensor.load("sony-imx174-mono")
    grey = tuple((float(nm), 0.5) for nm in range(380, 781, 10))
    rig = rc.Rig(
        {
            "plain": rc.RigCamera(rig_camera, sensor),
            "grey": rc.RigCamera(rig_camera, sensor, grey),
            "line": rc.RigCamera(rig_camera, sensor, ((549, 0), (550, 1), (551, 0))),
            "film": rig_camera,
        }
    )
    plain, half, line = (
        rig.members[name].filtered_sensor.electrons_per_um2()  # type: ignore[union-attr]
        for name in ("plain", "grey", "line")
    )
    assert half == pytest.approx(plain / 2, rel=1e-9)
    # A triangle of 1 nm area: what light of that nm gives, less than a hundredth of all.
    assert (line > 0).any()
    assert line.sum() < 0.01 * plain.sum()
    images = rig.render(floor(), spp=2, effects=(), device="cpu")
    raws = rig.expose(images)
    assert list(raws) == ["plain", "grey", "line"]
    # Another sensor of the same kind has its own fixed pattern, and the gain is that without a filter.
    assert [raw.serial for raw in raws.values()] == [0, 1, 2]
    gains = [raw.gain_dn_per_e for raw in raws.values()]
    assert gains == pytest.approx([gains[0]] * 3, rel=1e-6)
    # 1500 numbers of some thousand electrons or more: their mean is certain to a thousandth.
    light = [float(raw.mosaic.mean()) - raw.black_level_dn for raw in raws.values()]
    assert light[1] / light[0] == pytest.approx(0.5, rel=5e-3)


def test_a_filter_before_a_cover_glass_multiplies_it() -> None:
    glass = ((400.0, 0.8), (700.0, 0.8))
    sensor = rc.Sensor.load("sony-imx174-mono")
    member = rc.RigCamera(camera(), sensor.replace(cover_glass=glass), ((450, 0), (650, 1)))
    filtered = member.filtered_sensor
    assert filtered is not None
    table = np.array(filtered.cover_glass)
    inside = (table[:, 0] > 450) & (table[:, 0] < 650)
    assert table[inside, 1] == pytest.approx(0.8 * (table[inside, 0] - 450) / 200, abs=1e-12)


def test_calibration_says_where_cameras_stand_in_rig_and_world(tmp_path: Path) -> None:
    rig = rc.Rig.stereo(camera(), baseline_m=BASELINE_M)
    fit = rc.fit_camera_model(rig.cameras["left"], "opencv5")
    rig.save_calibration(tmp_path / "rig.json", [fit])
    data = json.loads((tmp_path / "rig.json").read_text())
    point = np.array([0.3, -0.2, -5.0, 1])  # in the axes of the rig
    in_world = (np.array(data["rig_to_world"]) @ point)[:3]
    for entry in data["cameras"].values():
        of_rig, of_world = entry["rig_to_camera"], entry["pose"]["world_to_camera"]
        one = np.array(of_rig["rotation"]) @ point[:3] + of_rig["translation_m"]
        other = np.array(of_world["rotation"]) @ in_world + of_world["translation_m"]
        assert one == pytest.approx(other, abs=1e-12)
    assert [len(entry["fits"]) for entry in data["cameras"].values()] == [1, 0]


def test_a_rig_of_colmap_has_poses_from_its_first_camera(tmp_path: Path) -> None:
    rig = rc.Rig(
        {
            "front": camera(position=(0, 0, 0), look_at=(0, 0, -1)),
            "side": camera(position=(0, 0, 0), look_at=(-1, 0, 0)),  # turned to the left
        }
    )
    rig.save_colmap_rig(tmp_path / "rig_config.json")
    front, side = json.loads((tmp_path / "rig_config.json").read_text())[0]["cameras"]
    assert front == {"image_prefix": "front/", "ref_sensor": True}
    w, x, y, z = side["cam_from_rig_rotation"]
    # The direction ahead of the front camera is to the right of the side camera: 90 degrees about y, which points down.
    assert (w, x, y, z) == pytest.approx((np.sqrt(0.5), 0, np.sqrt(0.5), 0), abs=1e-12)


def rig_at_two_places() -> tuple[rc.Rig, dict[str, np.ndarray]]:
    left, right = camera(position=(-0.1, 0, 0), look_at=(0, 0, -2)), camera(position=(0.1, 0, 0), look_at=(0, 0, -2))
    return rc.Rig({"left": left, "right": right}), {"0.png": np.eye(4), "1.png": turned(90, (1, 2, 3))}


def test_frames_of_colmap_put_its_cameras_where_they_are(tmp_path: Path) -> None:
    """The pose of a frame and that of a sensor in the rig give the pose of the picture: R2 (R1 x + t1) + t2."""
    rig, places = rig_at_two_places()
    rig.save_colmap(tmp_path / "sparse" / "0", places, "pinhole")

    def lines(name: str) -> list[list[str]]:
        text = (tmp_path / "sparse" / "0" / name).read_text()
        return [line.split() for line in text.splitlines() if line and not line.startswith("#")]

    def pose(words: list[str]) -> tuple[np.ndarray, np.ndarray]:
        numbers = [float(word) for word in words]
        return quaternion_matrix(*numbers[:4]), np.array(numbers[4:])

    assert [words[0] for words in lines("cameras.txt")] == ["1", "2"]  # one for each sensor of the rig
    (rig_words,) = lines("rigs.txt")
    assert rig_words[:7] == ["1", "2", "CAMERA", "1", "CAMERA", "2", "1"]
    turn, shift = pose(rig_words[7:])
    pictures = {words[9]: words for words in lines("images.txt")}
    assert list(pictures) == ["left/0.png", "right/0.png", "left/1.png", "right/1.png"]
    for (name, place), frame in zip(places.items(), lines("frames.txt"), strict=True):
        left, right = (pictures[f"{side}/{name}"][0] for side in ("left", "right"))
        assert frame[9:] == f"2 CAMERA 1 {left} CAMERA 2 {right}".split()
        rig_turn, rig_shift = pose(frame[2:9])
        expected = rig.moved(place).cameras
        composed = {"left": (rig_turn, rig_shift), "right": (turn @ rig_turn, turn @ rig_shift + shift)}
        for side, by_rig in composed.items():
            true = expected[side].world_to_camera
            for found in (by_rig, pose(pictures[f"{side}/{name}"][1:8])):
                # The error of 15 digits of numbers of a few metres.
                assert found[0] == pytest.approx(true[0], abs=1e-13)
                assert found[1] == pytest.approx(true[1], abs=1e-13)


def test_a_rig_of_colmap_whose_cameras_move_or_change_is_refused(tmp_path: Path) -> None:
    left = rc.Camera(rc.Lens.load("tessar-50mm"))
    right = left.replace(position=(0.1, 0.0, 0.0), look_at=(0.1, 0.0, -1.0))
    for name, other, message in (
        ("moved", right.replace(position=(0.2, 0.0, 0.0)), "camera 'right' has moved in the rig"),
        ("stopped down", right.replace(lens=right.lens.stopped_down(8)), "has another lens or film"),
    ):
        moments = {"first": {"left": left, "right": right}, name: {"left": left, "right": other}}
        with pytest.raises(rc.InputError, match=message):
            save_colmap_of_rig(tmp_path, moments, "pinhole")


def test_colmap_itself_reads_the_model_of_a_rig(tmp_path: Path) -> None:
    pycolmap = pytest.importorskip("pycolmap")
    rig, places = rig_at_two_places()
    rig.save_colmap(tmp_path, places, "opencv5")
    model = pycolmap.Reconstruction(tmp_path)
    assert (model.num_rigs(), model.num_frames(), model.num_cameras(), model.num_images()) == (1, 2, 2, 4)
    points = np.random.default_rng(2).uniform([-0.3, -0.2, -3], [0.3, 0.2, -2], (20, 3))
    for image in model.images.values():
        side, name = image.name.split("/")
        placed = rig.moved(places[name])
        there = points @ places[name][:3, :3].T + places[name][:3, 3]
        theirs = [image.camera.img_from_cam(image.cam_from_world() * point) for point in there]
        # The model leaves 0.015 of the 1920 columns in docs/vision.md, 48 here, and some more away from its plane.
        assert np.array(theirs) == pytest.approx(placed.cameras[side].project(there), abs=0.01)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: rc.Rig({}), "one camera at least"),
        (lambda: rc.Rig({"a": 3}), "realcam.Camera or a RigCamera; it is 3"),
        (lambda: rc.Rig({"": camera()}), "has a text as its name"),
        (lambda: rc.Rig({"a": camera()}, np.diag([2, 2, 2, 1])), "neither scaled nor mirrored"),
        (lambda: rc.Rig({"a": camera()}, np.diag([-1, 1, 1, 1])), "neither scaled nor mirrored"),
        (lambda: rc.Rig({"a": camera()}, np.eye(3)), r"a \(4, 4\) matrix"),
        (lambda: rc.Rig({"a": camera()}, np.eye(4), (0, 1)), "2 matrices"),
        (lambda: rc.Rig({"a": camera()}).relative_pose("a", "b"), "no camera 'b'; expected one of a"),
        (lambda: rc.Rig.stereo(camera(), baseline_m=0), "baseline_m must be a positive number"),
        (lambda: rc.RigCamera(camera(), None, ((500, 1),)), "has no sensor"),
        (lambda: rc.RigCamera(camera(), rc.Sensor.load(), (5,)), "pairs of a wavelength"),  # type: ignore[arg-type]
        (lambda: rc.RigCamera(camera(), rc.Sensor.load(), ((500, 2), (501, 2))), "cover_glass"),
    ],
)
def test_mistakes_have_one_line(make: object, message: str) -> None:
    with pytest.raises(rc.InputError, match=message) as caught:
        make()  # type: ignore[operator]
    assert "\n" not in str(caught.value)
