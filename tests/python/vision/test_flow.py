"""Optical flow against closed forms: planes, turns, what hides what, and rows that are exposed one after the other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

FILM = rc.Film(36, 24, (60, 40))
WALL = scenes.scene_of(scenes.quad((0, 0, -4), 50, diffuse=0.5)).with_environment(1.0)
CARD = scenes.scene_of(scenes.quad((0, 0, 0), 0.3, diffuse=0.5))


def focal_px(camera: rc.Camera) -> float:
    return float(camera.camera_matrix[0, 0])


def middles() -> np.ndarray:
    columns, rows = FILM.resolution
    return np.stack(np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5), axis=-1)


def compared(flow: rc.OpticalFlow, expected: np.ndarray, within: float) -> np.ndarray:
    """Holds a flow to what is expected, up to the corners of the next picture; where it leads into that picture."""
    to = middles() + expected
    inside = (to >= 0).all(axis=-1) & (to <= FILM.resolution).all(axis=-1)
    known = np.isfinite(flow.pixels).all(axis=-1)
    assert 0.8 < inside.mean() < 1 and known[inside].all()
    assert flow.pixels[known] == pytest.approx(expected[known], abs=within)
    return inside


def distance_to_wall(camera: rc.Camera) -> float:
    pupil = camera.entrance_pupil_position_m
    assert pupil is not None
    return pupil[2] + 4


def test_of_a_pinhole_that_moves_sideways_it_is_f_dx_over_z(device: str) -> None:
    first = scenes.pinhole(FILM)
    second = scenes.pinhole(FILM, position=(0.2, -0.1, 0), look_at=(0.2, -0.1, -1))
    flow = rc.optical_flow(WALL, first, second, device=device)
    per_m = focal_px(first) / distance_to_wall(first)
    # Positions are float32 on a wall of 5 m: 5e-7 m, and 30 pixels a metre.
    inside = compared(flow, np.broadcast_to([-0.2 * per_m, -0.1 * per_m], (40, 60, 2)), 1e-4)
    assert np.array_equal(flow.visible, inside)


def test_of_a_pinhole_that_turns_it_is_a_homography() -> None:
    """For points at infinity, the homography is K R K^-1, with the axes of OpenCV."""
    first = scenes.pinhole(FILM)
    turn = np.radians(5)
    second = scenes.pinhole(FILM, look_at=(np.sin(turn), 0, -np.cos(turn)))
    flow = rc.optical_flow(scenes.sky(), first, second)
    # A point straight ahead moves to the left of the picture's centre when the camera turns right.
    right_to_left = np.array([[np.cos(turn), 0, -np.sin(turn)], [0, 1, 0], [np.sin(turn), 0, np.cos(turn)]])
    matrix = first.camera_matrix @ right_to_left @ np.linalg.inv(first.camera_matrix)
    to = np.dstack([middles(), np.ones((40, 60))]) @ matrix.T
    expected = to[..., :2] / to[..., 2:] - middles()
    # float32 of a flow of some pixels.
    inside = compared(flow, expected, 1e-5)
    assert np.array_equal(flow.visible, inside)


@pytest.mark.parametrize("name", ["double-gauss-50mm", "fisheye-6mm-220deg"])
def test_real_lenses_distort_and_breathe(name: str) -> None:
    """A wall across the axis, met by each pixel's mean ray in closed form. The picture's middle rays are others, which
    meet the wall less than a pixel beside; over a pixel the flow changes by less than the tolerance."""
    lens = rc.Lens.load(name).focused(4)
    first = rc.Camera(lens, film=rc.Film.for_lens(lens, resolution=(60, 40)))
    second = first.replace(lens=lens.focused(1), position=(0.5, 0, -1), look_at=(0.5, 0, -2))
    flow = rc.optical_flow(WALL, first, second)
    origins, directions = first.ray(middles().reshape(-1, 2))
    on_wall = directions[:, 2] < -0.3
    ray_direction = ((-4 - origins[:, 2]) / directions[:, 2])[:, None]
    expected = (second.project(origins + ray_direction * directions) - middles().reshape(-1, 2))[on_wall]
    found = flow.pixels.reshape(-1, 2)[on_wall]
    known = np.isfinite(expected).all(axis=1) & np.isfinite(found).all(axis=1)
    assert known.mean() > 0.5
    assert found[known] == pytest.approx(expected[known], abs=0.02)
    assert np.nanmax(np.abs(expected)) > 1


def test_a_card_hides_of_the_wall_what_lies_behind_it() -> None:
    """The wall's points whose line to the second pinhole goes through the card: similar triangles."""
    scene = WALL.with_instance(CARD, scenes.shifted(z=-2), name="card")
    first = scenes.pinhole(FILM, position=(-0.2, 0, 0), look_at=(-0.2, 0, -1))
    second = scenes.pinhole(FILM, position=(0.2, 0, 0), look_at=(0.2, 0, -1))
    flow = rc.optical_flow(scene, first, second)
    origins, directions = first.ray(middles().reshape(-1, 2))
    eye = np.array(second.entrance_pupil_position_m)

    def at(z: float, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
        return origin + ((z - origin[:, 2]) / direction[:, 2])[:, None] * direction

    def beyond_card(places: np.ndarray) -> np.ndarray:
        return np.abs(places[:, :2]).max(axis=1) - 0.3

    on_card, wall = at(-2, origins, directions), at(-4, origins, directions)
    crossing = at(-2, wall, eye - wall)
    pixel_m = 2.1 / focal_px(first)
    is_wall, hidden = beyond_card(on_card) > 0, beyond_card(crossing) < -1.5 * pixel_m
    clear = (beyond_card(crossing) > 1.5 * pixel_m) | (beyond_card(on_card) < -pixel_m)
    to = middles() + flow.pixels
    inside = ((to > 0) & (to < FILM.resolution)).all(axis=-1).ravel()
    visible = flow.visible.ravel()
    assert (is_wall & hidden).sum() > 30
    assert not visible[is_wall & hidden].any()
    assert visible[clear & inside].all()


def test_nothing_hides_a_floor_that_is_seen_at_a_grazing_angle() -> None:
    """Its last pixels are half a metre deep and land between pixels, some showing the sky."""
    floor = scenes.scene_of(scenes.quad((0, -0.3, -5), 50, 4.5, up=(0, 0, -1), diffuse=0.5)).with_environment(1.0)
    first = scenes.pinhole(FILM, up=(0.2, 1, 0))
    on_floor = rc.render(floor, first, spp=1, effects=(), layers=["object_id"]).layers["object_id"] == 1
    assert on_floor.mean() > 0.3
    turn = np.radians(0.5)
    second = scenes.pinhole(FILM, look_at=(0, np.sin(turn), -np.cos(turn)), up=(0.2, 1, 0))
    flow = rc.optical_flow(floor, first, second)
    to = middles() + flow.pixels
    inside = ((to > 0) & (to < FILM.resolution)).all(axis=-1)
    assert flow.visible[on_floor & inside].all()


def test_rows_that_are_exposed_later_see_things_later() -> None:
    """A card falls at b rows a second, and rows are exposed tau seconds after one another. What is in row r is seen at
    t = tau r, and in the next picture, T later, in r' = r + b (T + tau r' - tau r): so r' - r = b T / (1 - b tau)."""
    speed_m_s, later_s, readout_s = 4.0, 0.05, 0.04
    scene = WALL.with_instance(CARD, scenes.shifted(y=0.5, z=-2), name="card")
    scene = scene.moved(
        "card", np.stack([scenes.shifted(y=0.5, z=-2), scenes.shifted(y=0.5 - speed_m_s, z=-2)]), (0, 1)
    )
    camera = scenes.pinhole(FILM).replace(exposure_time_s=0.002, readout_time_s=readout_s)
    flow = rc.optical_flow(scene, camera, camera.replace(shutter_opens_s=later_s))
    image = rc.render(scene, camera, spp=1, effects=(), layers=["object_id"])
    on_card = image.layers["object_id"] == 2
    pupil = camera.entrance_pupil_position_m
    assert pupil is not None
    rows_per_s = speed_m_s * float(camera.camera_matrix[1, 1]) / (pupil[2] + 2)
    expected = rows_per_s * later_s / (1 - rows_per_s * readout_s / 40)
    # The row's time is that of the row in which the middle of a thing lands: half a row of time on the average.
    assert on_card.sum() > 50
    assert flow.pixels[on_card, 1] == pytest.approx(expected, abs=rows_per_s * readout_s / 40)
    assert flow.pixels[on_card, 0] == pytest.approx(0, abs=1e-4)
    assert flow.pixels[~on_card] == pytest.approx(0, abs=1e-5)


def test_the_next_scene_may_be_another_arrangement() -> None:
    scene = WALL.with_instance(CARD, scenes.shifted(z=-2), name="card")
    camera = scenes.pinhole(FILM)
    then = WALL.with_instance(CARD, scenes.shifted(x=0.1, z=-2), name="card")
    flow = rc.optical_flow(scene, camera, camera, then)
    card = rc.render(scene, camera, spp=1, effects=(), layers=["object_id"]).layers["object_id"] == 2
    pupil = camera.entrance_pupil_position_m
    assert pupil is not None
    assert flow.pixels[card, 0] == pytest.approx(0.1 * focal_px(camera) / (pupil[2] + 2), abs=1e-4)
    assert flow.visible[card].all() and not flow.visible[~card].all()
    with pytest.raises(rc.InputError, match="must have the instances of scene"):
        rc.optical_flow(scene, camera, camera, WALL)


def test_opencv_reads_a_flow(tmp_path: Path) -> None:
    cv2 = pytest.importorskip("cv2")
    pixels = np.random.default_rng(1).normal(size=(4, 6, 2)).astype(np.float32)
    pixels[1, 2] = np.nan
    rc.OpticalFlow(pixels, np.ones((4, 6), bool)).save(tmp_path / "a.flo")
    theirs = cv2.readOpticalFlow(str(tmp_path / "a.flo"))
    assert (theirs[1, 2] > 1e9).all()  # Middlebury's mark of what is unknown
    known = ~np.isnan(pixels)
    assert np.array_equal(theirs[known], pixels[known])
    with pytest.raises(rc.ImageFileError, match=r"unknown suffix; expected \.flo"):
        rc.OpticalFlow(pixels, np.ones((4, 6), bool)).save(tmp_path / "a.png")
