"""Lenses fitted to ray pairs, beside exact traces of bundled lenses and closed forms of ideal lenses."""

from __future__ import annotations

import io
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc
from realcam.ray_pairs.ray_file import read_ray_pairs

WAVELENGTHS = (486.1, 546.1, 587.6, 656.3)


@pytest.fixture(scope="module")
def lens() -> rc.Lens:
    return rc.Lens.load("double-gauss-50mm").focused(2.0).stopped_down(4.0)


@pytest.fixture(scope="module")
def rays(lens: rc.Lens, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("rays") / "rays.npz"
    lens.save_rays(path, rays=24000, wavelengths_nm=WAVELENGTHS)
    return path


@pytest.fixture(scope="module")
def fitted(rays: Path) -> rc.RayPairLens:
    return rc.RayPairLens.fit(rays)


def exact(lens: rc.Lens, film: np.ndarray, side: np.ndarray, wavelength_nm: float) -> tuple[np.ndarray, ...]:
    """Origins, directions and passing of rays from film points through points of the plane of the last vertex."""
    start = np.column_stack([film, np.full(len(film), lens.film_position_mm)])
    end = np.column_stack([side, np.full(len(film), lens.film_position_mm - lens.film_distance_mm)])
    traced = lens.trace(
        start, (end - start) / np.linalg.norm(end - start, axis=1)[:, None], wavelength_nm=wavelength_nm
    )
    return traced.origins_mm, traced.directions, traced.status == rc.RayStatus.OK


def angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.cross(a, b), axis=1)


# 510 nm lies between the measured wavelengths: the cubic through four of them has an error far below the difference of
# neighbours, some 100 microradians. Coefficients are float32, whose rounding is 0.06 microradians of a unit vector.
@pytest.mark.parametrize(("wavelength_nm", "bound"), [(587.6, 1e-6), (510.0, 2e-6)])
def test_rays_are_those_of_the_exact_trace(
    lens: rc.Lens, fitted: rc.RayPairLens, wavelength_nm: float, bound: float
) -> None:
    random = np.random.default_rng(5)
    film, side = random.uniform(-15, 15, (4000, 2)), random.uniform(-10, 10, (4000, 2))
    origins, directions, ok = exact(lens, film, side, wavelength_nm)
    found_origins, found, passed = fitted.trace(film, side, wavelength_nm=wavelength_nm)
    both = ok & passed
    assert both.sum() > 300
    assert (ok == passed).mean() >= 0.995
    assert np.sqrt((angles(found, directions)[both] ** 2).mean()) < bound
    between = np.linalg.norm(np.cross(found_origins - origins, directions), axis=1)[both]
    assert np.sqrt((between**2).mean()) < 1e-4  # mm


def test_report_holds_for_rays_that_were_not_fitted(fitted: rc.RayPairLens) -> None:
    report = fitted.fit_report
    assert report.direction_rms_rad < 1e-6
    assert report.passing_accuracy >= 0.995
    assert report.film_radius_mm == pytest.approx(np.hypot(18, 12), rel=0.001)
    assert fitted.f_number == pytest.approx(4, rel=1e-6)


def test_first_order_is_that_of_the_lens(lens: rc.Lens, fitted: rc.RayPairLens) -> None:
    standing = fitted.table().paraxial_lens
    ours, theirs = standing.first_order(), lens.first_order()
    assert ours.effective_focal_length_mm == pytest.approx(theirs.effective_focal_length_mm, rel=1e-3)
    # The edge of the pupil is that of real rays, not of paraxial ones: 1.2% by the aberrations of this pupil.
    assert ours.f_number == pytest.approx(theirs.f_number, rel=0.02)
    assert standing.focus_distance_m == 2.0
    # So is its centre: the pupil's coma moves it by a hundredth of its distance from the film.
    assert ours.entrance_pupil_position_mm == pytest.approx(theirs.entrance_pupil_position_mm, abs=1.0)


def test_camera_takes_the_lens_pictures(lens: rc.Lens, fitted: rc.RayPairLens, device: str) -> None:
    film = rc.Film(36, 24, (90, 60))
    scene = wall()
    view = {"film": film, "position": (0, 0, 2), "exposure_time_s": 0.01}
    by_rays, by_surfaces = fitted.camera(**view), rc.Camera(lens, **view)
    settings: dict[str, Any] = {"spp": 64, "device": device}
    ours, theirs = (rc.render(scene, camera, **settings).pixels for camera in (by_rays, by_surfaces))
    # The same random numbers give noise that is alike; half a percent of the rays are decided otherwise.
    assert ours.mean() == pytest.approx(theirs.mean(), rel=0.005)
    assert ours[:6, :6].mean() == pytest.approx(theirs[:6, :6].mean(), rel=0.03)


def test_projection_is_that_of_the_lens(lens: rc.Lens, fitted: rc.RayPairLens) -> None:
    film = rc.Film(36, 24, (3600, 2400))
    by_rays, by_surfaces = fitted.camera(film=film), rc.Camera(lens, film=film)
    points = np.array([[x, y, -2.0] for x in (-0.6, -0.2, 0, 0.5) for y in (-0.4, 0.1, 0.35)])
    # Pixels of 10 um. The centroid on the film is that of the mean ray up to the size of aberrations.
    assert np.abs(by_rays.project(points) - by_surfaces.project(points)).max() < 1.0
    pixels = np.array([[1800.0, 1200.0], [700, 400], [3000, 2000]])
    _, directions = by_rays.ray(pixels)
    assert angles(directions, by_surfaces.ray(pixels)[1]).max() < 5e-4
    assert np.abs(by_rays.project(by_rays.ray(pixels)[0] + 3 * directions) - pixels).max() < 0.01
    with pytest.raises(rc.InputError, match="chief ray"):
        by_rays.ray(pixels, through="chief")


def test_layers_are_those_of_the_lens(lens: rc.Lens, fitted: rc.RayPairLens, device: str) -> None:
    scene = wall()
    view = {"film": rc.Film(36, 24, (30, 20))}
    depths = [
        rc.render(scene, camera, spp=1, layers="depth_middle", device=device).layers["depth_middle"]
        for camera in (fitted.camera(**view), rc.Camera(lens, **view))
    ]
    np.testing.assert_allclose(depths[0], depths[1], rtol=1e-4)


def wall() -> rc.Scene:
    corners = np.array([[-5, -5, -2], [5, -5, -2], [5, 5, -3], [-5, 5, -3]], np.float32)
    return rc.Scene.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]])).with_environment(1000)


def ray_arrays(
    meta: dict[str, Any], film: np.ndarray, side: np.ndarray, origin: np.ndarray, direction: np.ndarray, ok: np.ndarray
) -> dict[str, Any]:
    """Rays of 550 nm in the format ray-pairs/1."""
    return {
        "meta": {"format": "ray-pairs/1", **meta},
        "wavelength_nm": np.full(len(film), 550.0),
        "film_mm": film,
        "film_side_mm": side,
        "object_origin_mm": origin,
        "object_direction": direction,
        "ok": ok,
    }


def ideal_rays(count: int, focal_mm: float, film_mm: float, radius_mm: float) -> dict[str, Any]:
    """Rays of an ideal thin lens at z = 0: those of a film point meet in its image, by Newton's equation."""
    random = np.random.default_rng(1)
    film = random.uniform(-12, 12, (count, 2))
    side = random.uniform(-16, 16, (count, 2))  # in the plane z = 5
    at_lens = side - 5 * (film - side) / (film_mm - 5)
    distance = 1 / (1 / focal_mm - 1 / film_mm)
    image = np.column_stack([-film * distance / film_mm, np.full(count, -distance)])
    origin = np.column_stack([at_lens, np.zeros(count)])
    direction = (image - origin) / np.linalg.norm(image - origin, axis=1)[:, None]
    meta = {
        "f_number": focal_mm / (2 * radius_mm),
        "film_size_mm": [16, 12],
        "film_plane_z_mm": film_mm,
        "film_side_reference_z_mm": 5.0,
    }
    return ray_arrays(meta, film, side, origin, direction, np.hypot(*at_lens.T) < radius_mm)


def test_ideal_lens() -> None:
    arrays = ideal_rays(6000, 50.0, 52.0, 12.0)
    found = rc.RayPairLens.fit(arrays)
    first = found.table().paraxial_lens.first_order()
    assert found.fit_report.direction_rms_rad < 1e-6
    assert found.fit_report.passing_accuracy >= 0.995
    assert first.effective_focal_length_mm == pytest.approx(50, rel=1e-4)
    assert first.entrance_pupil_diameter_mm == pytest.approx(24, rel=0.01)
    pupil_to_film = found.table().paraxial_lens.film_position_mm - first.entrance_pupil_position_mm
    assert pupil_to_film == pytest.approx(52, abs=0.3)


def fisheye_rays(count: int, focal_mm: float, radius_mm: float) -> dict[str, Any]:
    """Rays of an ideal equidistant fisheye, theta = r / f.

    Each film point sends a parallel bundle through a disc that is perpendicular to it, about the centre of projection;
    its points are those of the plane behind the lens.
    """
    random = np.random.default_rng(2)
    angle, turn = np.radians(100) * np.sqrt(random.random(count)), 2 * np.pi * random.random(count)
    film = focal_mm * (angle * [np.cos(turn), np.sin(turn)]).T
    side = random.uniform(-1.5 * radius_mm, 1.5 * radius_mm, (count, 2))
    radial, tangential = np.array([np.cos(turn), np.sin(turn)]).T, np.array([-np.sin(turn), np.cos(turn)]).T
    a, b = (side * radial).sum(1)[:, None], (side * tangential).sum(1)[:, None]
    sine, cosine = np.sin(angle)[:, None], np.cos(angle)[:, None]
    direction = np.concatenate([-sine * radial, -cosine], 1)
    across = np.concatenate([cosine * radial, -sine], 1)
    origin = a * across + b * np.concatenate([tangential, 0 * cosine], 1) + [0, 0, 10]
    meta = {
        "f_number": 4.0,
        "film_size_mm": [20, 15],
        "film_plane_z_mm": 30 + focal_mm,
        "film_side_reference_z_mm": 30.0,
    }
    return ray_arrays(meta, film, side, origin, direction, np.hypot(*side.T) < radius_mm)


# The series of sin(theta) up to 100 degrees, of the powers that degree 11 has, is accurate to 1e-6.
def test_fields_beyond_90_degrees() -> None:
    found = rc.RayPairLens.fit(fisheye_rays(6000, 10.0, 1.25))
    assert found.fit_report.largest_angle_deg > 99
    assert found.fit_report.direction_rms_rad < 5e-6
    assert found.fit_report.passing_accuracy >= 0.995
    camera = found.camera(film=rc.Film(20, 15, (200, 150)))
    pixels = np.array([[100.0, 75.0], [150, 75], [199, 75]])
    _, directions = camera.ray(pixels)
    expected = (pixels[:, 0] - 100) * 0.1 / 10  # theta = r / f
    np.testing.assert_allclose(np.arctan2(directions[:, 0], -directions[:, 2]), expected, atol=1e-4)
    assert camera.field_of_view_deg.horizontal == pytest.approx(np.degrees(2), rel=1e-4)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"f_number": 8.0}, "f-number"),
        ({"focus_m": 1.0}, "focus distance"),
        ({"film": rc.Film(60, 40)}, "measured up to"),
        ({"wavelength_nm": 700.0}, "outside those that were measured"),
        ({"model": "full"}, "polynomial"),
    ],
)
def test_what_was_not_measured_is_refused(fitted: rc.RayPairLens, arguments: dict[str, Any], text: str) -> None:
    with pytest.raises(rc.InputError, match=text):
        fitted.camera(**arguments)


@pytest.mark.parametrize("effect", ["ghosts", "diffraction", "dispersion", "coatings"])
def test_effects_of_surfaces_are_refused_by_name(fitted: rc.RayPairLens, effect: str) -> None:
    camera = fitted.camera(film=rc.Film(36, 24, (6, 4)))
    with pytest.raises(rc.InputError, match=f"{effect}.*only rays were measured"):
        rc.render(wall(), camera, spp=1, effects=effect, device="cpu")


def test_another_lens_is_refused(lens: rc.Lens, fitted: rc.RayPairLens) -> None:
    camera = fitted.camera()
    for change in ({"lens": lens}, {"lens": camera.lens.stopped_down(8)}, {"model": "full"}):
        with pytest.raises(rc.InputError, match="measured"):
            camera.replace(**change)
    assert pickle.loads(pickle.dumps(camera)) == camera


def test_saved_lens_is_the_same(fitted: rc.RayPairLens, tmp_path: Path) -> None:
    path = tmp_path / "lens.npz"
    fitted.save(path)
    assert rc.RayPairLens.load(path).table(500.0) == fitted.table(500.0)
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    with pytest.raises(rc.InputError, match="damaged"):
        rc.RayPairLens.load(path)


def test_file_is_read_as_it_was_written(lens: rc.Lens, rays: Path) -> None:
    pairs = read_ray_pairs(rays)
    assert pairs.f_number == pytest.approx(lens.f_number)
    assert pairs.ok.mean() > 0.05
    assert np.abs(pairs.object_origin_mm[pairs.ok, 2]).max() < 1e-9


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("ok", None, "no array ok"),
        ("film_mm", np.zeros((3, 2)), "shape"),
        ("film_mm", np.full((6000, 2), np.nan), "finite"),
        ("wavelength_nm", np.full(6000, 5.0), "wavelength"),
        ("object_direction", np.full((6000, 3), 2.0), "unit vectors"),
        ("ok", np.zeros(6000, bool), "0 rays pass"),
        ("meta", {"format": "ray-pairs/2"}, "format"),
        ("meta", "{", "JSON"),
        ("film_mm", np.array(["a"] * 6000), "shape"),
    ],
)
def test_malformed_rays_are_one_line(name: str, value: Any, text: str) -> None:
    arrays = {**ideal_rays(6000, 50.0, 52.0, 12.0), name: value}
    if value is None:
        del arrays[name]
    with pytest.raises(rc.InputError, match=text) as error:
        rc.RayPairLens.fit(arrays)
    assert "\n" not in str(error.value)


def test_malformed_files_are_one_line(tmp_path: Path) -> None:
    path = tmp_path / "rays.npz"
    for content in (b"", b"PK\3\4", json.dumps({}).encode(), pickled()):
        path.write_bytes(content)
        for read in (rc.RayPairLens.fit, rc.RayPairLens.load):
            with pytest.raises(rc.InputError) as error:
                read(path)
            assert "\n" not in str(error.value)
            assert "rays.npz" in str(error.value)


def pickled() -> bytes:
    content = io.BytesIO()
    np.savez(content, meta=np.array([{}], object))
    return content.getvalue()
