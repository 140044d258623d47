"""Lens.trace as a user meets it."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

AXIS = np.array([[0.0, 0.0, -1.0]])


def test_trace_shapes_types_and_status() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    film = lens.film_position_mm
    origins = np.tile([0.0, 0.0, film], (5, 1))
    directions = np.array([[0, 0, -1], [0.9, 0, -0.1], [np.nan, 0, -1], [0, 0, 0], [0.05, 0, -1]])
    out = lens.trace(origins, directions)
    for array, shape, kind in (
        (out.origins_mm, (5, 3), "float64"),
        (out.directions, (5, 3), "float64"),
        (out.optical_path_mm, (5,), "float64"),
        (out.status, (5,), "int32"),
        (out.surface_index, (5,), "int32"),
    ):
        assert (array.shape, array.dtype) == (shape, kind)
    status = [rc.RayStatus(s) for s in out.status]
    assert status[0] == status[4] == rc.RayStatus.OK
    assert status[1] in (rc.RayStatus.MISSED, rc.RayStatus.VIGNETTED)
    assert status[2] == status[3] == rc.RayStatus.BAD_INPUT
    assert out.surface_index.tolist()[2:4] == [-1, -1]
    assert out.surface_index[0] == 0  # towards the scene, the last surface met is the first one
    assert np.isfinite(out.origins_mm).all()
    assert np.isfinite(out.directions).all()
    good = [0, 4]
    np.testing.assert_allclose(np.linalg.norm(out.directions[good], axis=1), 1, atol=1e-14)
    # On the axis the optical path is the sum of index times thickness.
    index = [s.material.index(lens.wavelength_nm) for s in lens.surfaces[:-1]]
    path = lens.film_distance_mm + sum(n * s.thickness_mm for n, s in zip(index, lens.surfaces, strict=False))
    assert out.optical_path_mm[0] == pytest.approx(path, abs=1e-11)


def test_trace_takes_any_arrays() -> None:
    lens = rc.Lens.load("tessar-50mm")
    rng = np.random.default_rng(1)
    directions = np.concatenate([rng.uniform(-0.1, 0.1, (40, 2)), np.full((40, 1), -1.0)], axis=1)
    origins = np.tile([1.0, 2.0, lens.film_position_mm], (40, 1))
    expected = lens.trace(origins, directions)
    strided = np.zeros((40, 6))
    strided[:, ::2] = directions
    for o, d in (
        (origins.tolist(), directions.tolist()),
        (np.asfortranarray(origins), strided[:, ::2]),
        (origins[::-1][::-1], directions * 7),  # need not be unit vectors
    ):
        out = lens.trace(o, d)
        np.testing.assert_allclose(out.directions, expected.directions, atol=1e-15)
        np.testing.assert_array_equal(out.status, expected.status)
    single = lens.trace(origins, directions, dtype=np.float32)
    # Tens of roundings of 6e-8 over 60 mm.
    np.testing.assert_allclose(single.origins_mm, expected.origins_mm, atol=1e-4)
    assert (single.origins_mm != expected.origins_mm).any()
    empty = lens.trace(np.zeros((0, 3)), np.zeros((0, 3)))
    assert (empty.origins_mm.shape, empty.status.shape) == ((0, 3), (0,))


@pytest.mark.parametrize("dtype", ["float64", "float32"])
@pytest.mark.parametrize("name", ["double-gauss-50mm", "phone-4mm", "mirror-telephoto-500mm"])
def test_a_mirror_image_of_the_rays_gives_that_of_the_result(name: str, dtype: str) -> None:
    """To the last bit: every formula is odd or even in x."""
    lens, flip = rc.Lens.load(name), np.array([-1.0, 1.0, 1.0])
    directions = np.random.default_rng(1).normal((0, 0, -1), 0.1, (64, 3))
    origins = np.tile([0.1, 0.2, lens.film_position_mm], (64, 1))
    one = lens.trace(origins, directions, dtype=dtype)
    other = lens.trace(origins * flip, directions * flip, dtype=dtype)
    np.testing.assert_array_equal(other.status, one.status)
    np.testing.assert_array_equal(other.origins_mm, one.origins_mm * flip)
    np.testing.assert_array_equal(other.directions, one.directions * flip)
    np.testing.assert_array_equal(other.optical_path_mm, one.optical_path_mm)


@pytest.mark.parametrize(
    ("origins", "directions", "options", "says"),
    [
        ([[0, 0]], [[0, 0]], {}, r"\(N, 3\)"),
        ([0, 0, 0], [0, 0, 1], {}, r"\(N, 3\)"),
        (np.zeros((2, 3)), np.zeros((3, 3)), {}, r"\(N, 3\)"),
        (AXIS, AXIS, {"start": "lens"}, '"film" or "scene"'),
        (AXIS, AXIS, {"dtype": "int32"}, "float64"),
        (AXIS, AXIS, {"wavelength_nm": math.nan}, "wavelength"),
        (AXIS, AXIS, {"wavelength_nm": 0.5}, "wavelength"),
    ],
)
def test_trace_says_what_is_wanted(origins: object, directions: object, options: dict[str, object], says: str) -> None:
    with pytest.raises(rc.InputError, match=says):
        rc.Lens.load("tessar-50mm").trace(origins, directions, **options)  # type: ignore[arg-type]


def test_surface_count_ends_rays_where_it_is_asked_to() -> None:
    lens = rc.Lens.load("tessar-50mm")
    count = len(lens.surfaces)
    start, along = np.array([[1.0, 0.0, -10.0]]), -AXIS
    for last in range(1, count + 1):
        out = lens.trace(start, along, start="scene", surface_count=last)
        assert out.surface_index[0] == last - 1
    whole, all_of_them = (
        lens.trace(start, along, start="scene"),
        lens.trace(start, along, start="scene", surface_count=count),
    )
    np.testing.assert_array_equal(whole.origins_mm, all_of_them.origins_mm)
    for wrong in (-1, count + 1):
        with pytest.raises(rc.InputError, match="surface"):
            lens.trace(start, along, start="scene", surface_count=wrong)
