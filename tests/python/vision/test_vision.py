"""Camera models of computer vision: their formulas against OpenCV, their fits against closed forms, and the files."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam.vision import models
from realcam.vision.fit import projected
from realcam.vision.regularised import ALLOWED_PX, nearest_coefficients

OPENCV = ("pinhole", "opencv4", "opencv5", "opencv8")
MATRIX = np.array([[812.3, 0, 480], [0, 790.1, 320], [0, 0, 1.0]])


def camera_of(name: str, **changes: object) -> rc.Camera:
    lens = rc.Lens.load(name)
    return rc.Camera(lens, film=rc.Film.for_lens(lens, resolution=(960, 640))).replace(**changes)


def in_front(count: int = 500) -> np.ndarray:
    """Points in the axes of a camera, up to 35 degrees to the side: there the coefficients below give growing radii."""
    rng = np.random.default_rng(3)
    return rng.uniform([-2, -2, 4], [2, 2, 9], (count, 3))


@pytest.mark.parametrize("name", [*OPENCV, "fisheye"])
def test_distortion_is_opencvs(name: str) -> None:
    cv2 = pytest.importorskip("cv2")
    seen, still = in_front(), (np.zeros(3), np.zeros(3))
    if name == "fisheye":
        k = np.array([-0.021, 0.007, -0.0013, 0.0004])
        theirs, _ = cv2.fisheye.projectPoints(seen[:, None], *still, MATRIX, k)
        theirs = theirs.reshape(-1, 1, 2)
    else:
        k = np.array([-0.21, 0.07, -0.013, 0.04, 0.011, 0.002])[: models.MODELS[name].terms]
        theirs, _ = cv2.projectPoints(seen, *still, MATRIX, distortion(name, k))
    assert projected(models.MODELS[name], MATRIX, k, seen) == pytest.approx(theirs[:, 0], abs=1e-9)


def distortion(name: str, k: np.ndarray) -> np.ndarray:
    values = models.distortion_coefficients(models.MODELS[name], k)
    return np.array(values or [0.0] * 4)


def test_models_beyond_the_plane() -> None:
    """At 100 degrees to the side the fisheye's polynomial is that of the angle, and tangents have no value."""
    angle = np.radians(100.0)
    seen = np.array([[np.sin(angle), 0, np.cos(angle)]])
    k = np.array([0.01, 0.002, 0.0003, 0.0])
    powers = angle + 0.01 * angle**3 + 0.002 * angle**5 + 0.0003 * angle**7
    assert projected(models.MODELS["fisheye"], MATRIX, k, seen)[0, 0] == pytest.approx(480 + 812.3 * powers)
    f_theta = angle + 0.01 * angle**2 + 0.002 * angle**3 + 0.0003 * angle**4
    assert projected(models.MODELS["f_theta"], MATRIX, k, seen)[0, 0] == pytest.approx(480 + 812.3 * f_theta)
    assert np.isnan(projected(models.MODELS["opencv5"], MATRIX, np.zeros(3), seen)).all()


def test_the_domain_ends_where_the_radius_turns() -> None:
    # x (1 - 0.1 x^2) is largest at x = sqrt(1 / 0.3), theta (1 - 0.1 theta^2) likewise.
    edge = np.sqrt(1 / 0.3)
    assert models.MODELS["opencv4"].largest_angle(np.array([-0.1, 0])) == pytest.approx(np.arctan(edge))
    assert models.MODELS["fisheye"].largest_angle(np.array([-0.1, 0, 0, 0])) == pytest.approx(edge)
    assert models.MODELS["opencv4"].largest_angle(np.array([0.1, 0])) == np.pi / 2
    # A pole: the denominator 1 - 0.25 x^2 vanishes at 2.
    assert models.MODELS["opencv8"].largest_angle(np.array([0, 0, 0, -0.25, 0, 0])) == pytest.approx(np.arctan(2))


@pytest.mark.parametrize("model", ["pinhole", "thin"])
@pytest.mark.parametrize("name", models.MODELS)
def test_a_fit_to_an_ideal_lens_is_the_matrix(model: str, name: str) -> None:
    """r = f tan(theta): the models by the tangent hold it, and the polynomials of the angle come near it."""
    camera = camera_of("double-gauss-50mm", model=model)
    camera = camera.replace(lens=camera.lens.focused(np.inf))
    fit = rc.fit_camera_model(camera, name)
    pitch = camera.film.width_mm / 960
    focal = camera.lens.first_order().effective_focal_length_mm / pitch
    if models.MODELS[name].by_tangent:
        assert fit.camera_matrix[0, 0] == pytest.approx(focal, rel=1e-10)
        assert fit.max_px < 1e-8
        if name != "opencv8":  # its numerator and denominator may cancel
            assert np.abs(fit.coefficients).max(initial=0) < 1e-8
    else:
        # tan(theta) = theta + theta^3 / 3 + ...: with the ninth power of 0.41 what is left is 1e-5 of the radius.
        assert fit.camera_matrix[0, 0] == pytest.approx(focal, rel=2e-3)
        assert fit.max_px < 0.2
    assert fit.camera_matrix[:, 2].tolist() == [480, 320, 1]
    assert fit.covers_film


def test_pixels_that_are_not_square() -> None:
    camera = camera_of("double-gauss-50mm", film=rc.Film(36, 24, (960, 320)))
    fit = rc.fit_camera_model(camera, "opencv8")
    assert fit.camera_matrix[0, 0] == pytest.approx(2 * fit.camera_matrix[1, 1])
    square = rc.fit_camera_model(camera_of("double-gauss-50mm", film=rc.Film(36, 24, (960, 640))), "opencv8")
    assert fit.camera_matrix[0, 0] == pytest.approx(square.camera_matrix[0, 0], rel=1e-5)


@pytest.mark.parametrize(
    ("lens", "model", "limit"),
    [("double-gauss-50mm", "opencv8", 0.05), ("tessar-50mm", "opencv5", 0.2), ("fisheye-6mm-220deg", "fisheye", 2)],
)
def test_a_fit_says_what_the_lens_shows(lens: str, model: str, limit: float) -> None:
    camera = camera_of(lens, position=(2, -1, 4), look_at=(-1, 0.5, 2), up=(0.3, 1, 0.2))
    fit = rc.fit_camera_model(camera, model)
    assert fit.rms_px <= fit.max_px < limit
    assert fit.covers_film and fit.largest_angle_deg > 0.5 * camera.field_of_view_deg.diagonal
    # The residuals are what project and Camera.project differ by, at points in focus that the fit has not seen.
    rng = np.random.default_rng(5)
    pixels = rng.uniform((0, 0), (960, 640), (300, 2))
    origins, directions, light = camera.ray(pixels, return_light=True)
    points = (origins + min(fit.distance_m, 1e5) * directions)[light >= 0.1]
    shown = camera.project(points)
    off = np.linalg.norm(fit.project(points) - shown, axis=1)
    assert off.max() < 1.2 * fit.max_px + 1e-3
    # unproject is the inverse of project.
    back = fit.unproject(shown)
    assert np.linalg.norm(back, axis=1) == pytest.approx(1)
    there = np.array(camera.entrance_pupil_position_m) + 7 * back
    assert fit.project(there) == pytest.approx(shown, abs=1e-8)
    # At another distance the entrance pupil's wandering shows, which one centre of projection cannot have.
    assert np.sqrt(np.mean(np.sum(fit.residuals_at(fit.distance_m) ** 2, axis=1))) == pytest.approx(fit.rms_px)
    assert np.isfinite(fit.residuals_at(np.inf)).all()


@pytest.mark.parametrize("lens", ["telephoto-250mm", "singlet-100mm"])
def test_a_rational_model_with_a_pole_beyond_the_film_covers_it(lens: str) -> None:
    fit = rc.fit_camera_model(camera_of(lens), "opencv8")
    assert fit.covers_film
    assert fit.largest_angle_deg > 0.5 * fit.camera.field_of_view_deg.diagonal


def test_more_coefficients_fit_no_worse() -> None:
    camera = camera_of("wide-22mm")
    rms = [rc.fit_camera_model(camera, name).rms_px for name in ("pinhole", "opencv4", "opencv5", "opencv8")]
    # If opencv5 fits well enough, opencv8 gives the same model, to the last digits of the search.
    assert (np.diff(rms) < 1e-9).all() and rms[-1] < 0.01 * rms[0]


def test_opencv8_has_no_coefficients_that_the_film_does_not_call_for() -> None:
    """Without regularisation the best fit had k of 2347, 10858, -10899: factors of numerator and denominator cancel."""
    fit = rc.fit_camera_model(camera_of("double-gauss-50mm"), "opencv8")
    largest_s = np.tan(np.radians(0.5 * fit.camera.field_of_view_deg.diagonal))
    parts = np.abs(fit.coefficients) * largest_s ** np.array([2, 4, 6, 2, 4, 6])
    # Numerator and denominator are 1 + ..., and the lens distorts by 2%: no term is larger than some of that.
    assert parts.max() < 0.1
    assert fit.covers_film
    # The terms of a rational model of weak distortion are nearly the same functions; those of opencv5 are not.
    assert fit.condition > 1e5 > 1e3 > rc.fit_camera_model(fit.camera, "opencv5").condition


def test_a_rational_model_is_no_farther_from_its_polynomial_than_the_truth() -> None:
    """Exact numbers of a rational model: what is found shows the same, and has no larger coefficients than needed."""
    model, s = models.MODELS["opencv8"], np.linspace(0.01, 1.2, 400)
    truth = np.array([0.3, 0.05, 0.0, 0.6, 0.1, 0.0])
    shown = model.radius(s, truth)

    def residuals(parameters: np.ndarray) -> np.ndarray:
        off = 1000 * (parameters[0] * model.radius(s, parameters[1:]) - shown)  # a focal length of 1000 pixels
        return np.stack([off, np.zeros_like(off)], axis=1)

    start = np.array([1.0, 0, 0, 0, 0, 0, 0])
    found = nearest_coefficients(model, residuals, np.append(1.0, truth), start, s[-1])
    assert np.sqrt(np.mean(np.sum(residuals(found) ** 2, axis=1))) <= ALLOWED_PX
    # The truth has no residuals, so that what minimises residuals and penalty together has no larger penalty than it,
    # but for the step between two weights. The penalty counts from the polynomial, which is within 0.5 of both.
    sizes = s[-1] ** np.array([2, 4, 6, 2, 4, 6.0])
    assert np.linalg.norm(sizes * found[1:]) < np.linalg.norm(sizes * truth) + 0.5


@pytest.mark.parametrize(
    ("lens", "enough"), [("tessar-50mm", "opencv4"), ("sonnar-50mm", "opencv5"), ("fisheye-10mm", None)]
)
def test_too_many_terms_are_warned_of_once(lens: str, enough: str | None) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        fit = rc.fit_camera_model(camera_of(lens), "opencv8")
    messages = [str(each.message) for each in caught]
    if enough is None:  # opencv5 is pixels off
        assert messages == []
        return
    (message,) = messages
    assert message.startswith(f"{enough} predicts points between the fitted ones as well as opencv8")
    assert caught[0].filename == __file__
    simpler = rc.fit_camera_model(fit.camera, enough)
    assert simpler.held_out_rms_px() < fit.held_out_rms_px() + 0.01


def test_opencv_projects_what_the_fit_does() -> None:
    """The whole way: pose, matrix and coefficients in OpenCV's own functions, its pixels half a pixel from ours."""
    cv2 = pytest.importorskip("cv2")
    for lens, model in (("double-gauss-50mm", "opencv8"), ("fisheye-10mm", "fisheye")):
        camera = camera_of(lens, position=(2, -1, 4), look_at=(-1, 0.5, 2), up=(0.3, 1, 0.2))
        fit = rc.fit_camera_model(camera, model)
        origins, directions = camera.ray(fit.pixels[::7])
        points = origins + min(fit.distance_m, 1e5) * directions
        rotation, translation = camera.world_to_camera
        K, coefficients = fit.opencv()
        pose = cv2.Rodrigues(rotation)[0], translation
        if model == "fisheye":
            ahead = (points @ rotation.T + translation)[:, 2] > 0
            points = points[ahead]
            theirs, _ = cv2.fisheye.projectPoints(points[:, None], *pose, K, coefficients)
        else:
            theirs, _ = cv2.projectPoints(points, *pose, K, coefficients)
        assert theirs.reshape(-1, 2) + 0.5 == pytest.approx(fit.project(points), abs=1e-7)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda: rc.fit_camera_model(camera_of("tessar-50mm"), "brown"),
            'unknown camera model "brown"; expected one of pin',
        ),
        (lambda: rc.fit_camera_model(camera_of("fisheye-6mm-220deg"), "opencv5"), "reaches 90 degrees off the axis"),
        (lambda: rc.fit_camera_model(camera_of("tessar-50mm"), distance_m=0), "distance_m must be a positive number"),
        (lambda: rc.fit_camera_model(camera_of("tessar-50mm"), distance_m=0.001), "lies inside the lens"),
        (lambda: rc.fit_camera_model(camera_of("tessar-50mm"), "f_theta").opencv(), "have no model f_theta"),
    ],
)
def test_mistakes_are_explained(call: object, says: str) -> None:
    with pytest.raises(rc.InputError, match=says):
        call()


def test_json_has_pose_and_intrinsics(tmp_path: Path) -> None:
    camera = camera_of("double-gauss-50mm", position=(2, -1, 4), look_at=(-1, 0.5, 2))
    camera = camera.replace(lens=camera.lens.focused(np.inf))
    rc.save_camera_json(
        tmp_path / "camera.json", camera, [rc.fit_camera_model(camera, m) for m in ("opencv8", "f_theta")]
    )
    # Strict JSON: no Infinity.
    text = (tmp_path / "camera.json").read_text()
    data = json.loads(text, parse_constant=lambda word: pytest.fail(word))
    assert data["lens"]["focus_distance_m"] is None
    assert (data["width"], data["height"], data["film_mm"]) == (960, 640, [36, 24])
    rotation = np.array(data["pose"]["world_to_camera"]["rotation"])
    point = np.array([-1, 0.5, 2])  # on the axis
    seen = rotation @ point + data["pose"]["world_to_camera"]["translation_m"]
    assert seen[:2] == pytest.approx([0, 0], abs=1e-12) and seen[2] > 0
    # OpenGL's camera looks to -z.
    there = np.linalg.inv(data["pose"]["camera_to_world_opengl"]) @ [*point, 1]
    assert there[:3] == pytest.approx([0, 0, -seen[2]], abs=1e-12)
    assert data["opencv_camera_matrix"][0][2] == data["camera_matrix"][0][2] - 0.5 == 479.5
    opencv8, f_theta = data["fits"]
    assert len(opencv8["opencv_coefficients"]) == 8 and opencv8["opencv_coefficients"][2:4] == [0, 0]
    assert "opencv_coefficients" not in f_theta and len(f_theta["coefficients"]) == 4


def quaternion_matrix(w: float, x: float, y: float, z: float) -> np.ndarray:
    """Rotation matrix of a quaternion in the convention of COLMAP's documentation (Hamilton)."""
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@pytest.mark.parametrize(
    ("model", "kind", "numbers"),
    [("pinhole", "PINHOLE", 4), ("opencv5", "FULL_OPENCV", 12), ("fisheye", "OPENCV_FISHEYE", 8)],
)
def test_colmap_model(tmp_path: Path, model: str, kind: str, numbers: int) -> None:
    first = camera_of("double-gauss-50mm", position=(2, -1, 4), look_at=(-1, 0.5, 2), up=(0.3, 1, 0.2))
    second = first.replace(position=(0, 1, 3), look_at=(0, 0, 0), up=(0, 1, 0))
    third = second.replace(lens=second.lens.focused(5))
    rc.save_colmap(tmp_path / "sparse", {"a.png": first, "b.png": second, "c.png": third}, model)
    lines = [s for s in (tmp_path / "sparse/cameras.txt").read_text().splitlines() if not s.startswith("#")]
    assert len(lines) == 2  # pictures with the same lens share one
    words = lines[0].split()
    assert words[:4] == ["1", kind, "960", "640"] and len(words) == 4 + numbers
    images = [s for s in (tmp_path / "sparse/images.txt").read_text().split("\n") if not s.startswith("#")]
    assert images[1::2] == ["", "", ""]  # a line of 2D points after each
    assert [line.split()[8:] for line in images[0:6:2]] == [["1", "a.png"], ["1", "b.png"], ["2", "c.png"]]
    pose = [float(word) for word in images[0].split()[1:8]]
    rotation, translation = first.world_to_camera
    assert quaternion_matrix(*pose[:4]) == pytest.approx(rotation, abs=1e-12)
    assert pose[4:] == pytest.approx(translation, abs=1e-12)
    # OpenCV's own functions, with the numbers of the file: fx, fy, cx, cy and distortion.
    cv2 = pytest.importorskip("cv2")
    fx, fy, cx, cy, *k = map(float, words[4:])
    point, matrix = np.array([[[-1, 0.6, 2.2]]]), np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    project = cv2.fisheye.projectPoints if model == "fisheye" else cv2.projectPoints
    theirs, _ = project(point, cv2.Rodrigues(rotation)[0], translation, matrix, np.array(k or [0.0] * 4))
    assert rc.fit_camera_model(first, model).project(point[0])[0] == pytest.approx(theirs.ravel(), abs=1e-9)
    assert (tmp_path / "sparse/points3D.txt").read_text().startswith("#")


def test_colmap_refuses_what_it_cannot_hold(tmp_path: Path) -> None:
    camera = camera_of("tessar-50mm")
    with pytest.raises(rc.InputError, match="COLMAP has no camera model f_theta"):
        rc.save_colmap(tmp_path / "sparse", {"a.png": camera}, "f_theta")
    with pytest.raises(rc.InputError, match="must not contain spaces"):
        rc.save_colmap(tmp_path / "sparse", {"a picture.png": camera})
    assert not (tmp_path / "sparse").exists()


def test_metadata_has_pose_and_matrix() -> None:
    camera = camera_of("double-gauss-50mm", position=(1e6, -1, 4), look_at=(1e6 - 3, 0.5, 2))
    image = rc.Image(np.zeros((1, 1, 3), np.float32), np.zeros((1, 1), np.float32), camera, 1, 0, None)
    entries = image.metadata()
    assert entries["realcam:pixel_pitch_um"] == "37.5x37.5"
    K = np.array(entries["realcam:camera_matrix"].split(), float).reshape(3, 3)
    np.testing.assert_allclose(K, camera.camera_matrix, rtol=1e-14)
    pose = np.array(entries["realcam:world_to_camera"].split(), float).reshape(3, 4)
    rotation, translation = camera.world_to_camera
    assert pose[:, :3] == pytest.approx(rotation, abs=1e-14)
    assert pose[:, 3] == pytest.approx(translation, rel=1e-14, abs=1e-8)
    # A camera that moves is where it is in the middle of its exposure.
    moving = camera.replace(exposure_time_s=0.2, motion=[(0, (0, 0, 0), (0, 0, -1)), (0.2, (2, 0, 0), (2, 0, -1))])
    assert moving.world_to_camera[1][0] == pytest.approx(-1)
