"""realcam's lenses as sensors of Mitsuba 3. Skipped where Mitsuba is not installed, or has neither LLVM nor a GPU."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
import realcam as rc

COLUMNS, ROWS = 30, 20
DOUBLE_GAUSS = {"lens": "double-gauss-50mm", "focus_distance_m": 2.0, "f_number": 2.8, "exposure_time_s": 1.0}


def test_without_mitsuba_the_import_says_what_to_install() -> None:
    program = "import sys; sys.modules['mitsuba'] = None; import realcam.mitsuba"
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    last = ended.stderr.strip().splitlines()[-1]
    assert last == "ImportError: realcam.mitsuba needs Mitsuba 3: pip install 'realcam[mitsuba]'"


def mitsuba(variant: str) -> Any:
    mi = pytest.importorskip("mitsuba", reason="Mitsuba is not installed: pip install 'realcam[mitsuba]'")
    try:
        mi.set_variant(variant)
        mi.Float(1) + mi.Float(2)
    except (ImportError, RuntimeError) as error:
        pytest.skip(f"Mitsuba cannot work in {variant} here: {error}")
    import realcam.mitsuba  # noqa: F401

    return mi


@pytest.fixture(params=["llvm_ad_rgb", "cuda_ad_rgb"])
def mi(request: pytest.FixtureRequest) -> Any:
    return mitsuba(request.param)


def film(**crop: int) -> dict[str, Any]:
    return {"type": "hdrfilm", "width": COLUMNS, "height": ROWS, "rfilter": {"type": "box"}, **crop}


def sensor_of(mi: Any, **properties: Any) -> Any:
    return mi.load_dict({"type": "realcam", "film": film()} | properties)


def sampled(mi: Any, sensor: Any, spp: int) -> tuple[Any, np.ndarray, np.ndarray]:
    """Rays of all pixels, their points in the picture (2, N) as fractions of its size, and the weights."""
    count = COLUMNS * ROWS * spp
    rng = np.random.default_rng(1)
    pixel = np.arange(count) // spp
    place = np.stack([pixel % COLUMNS, pixel // COLUMNS]) + rng.random((2, count))
    place = (place / [[COLUMNS], [ROWS]]).astype(np.float32)
    u, wavelength = (rng.random(shape).astype(np.float32) for shape in ((2, count), count))
    ray, weight = sensor.sample_ray(0.0, mi.Float(wavelength), mi.Point2f(place), mi.Point2f(u), True)
    return ray, place, np.array(weight)[0]


def pixel_means(values: np.ndarray) -> np.ndarray:
    return values.reshape(COLUMNS * ROWS, -1).mean(axis=1)


# One of each kind: spheres with blades, aspheres, mirrors with a hole, and more than 180 degrees.
@pytest.mark.parametrize(
    "properties",
    [
        {"lens": "double-gauss-50mm", "f_number": 5.6, "focus_distance_m": 0.8},
        {"lens": "phone-4mm-three-elements"},
        {"lens": "mirror-telephoto-500mm"},
        {"lens": "fisheye-6mm-220deg"},
    ],
    ids=lambda properties: properties["lens"],
)
def test_irradiance_is_that_of_generate_rays(mi: Any, properties: dict[str, Any]) -> None:
    spp = 800
    lens = rc.Lens.load(properties["lens"])
    if "f_number" in properties:
        lens = lens.focused(properties["focus_distance_m"]).stopped_down(properties["f_number"]).with_iris(0)
    camera = rc.Camera(lens, film=rc.Film.for_lens(lens, resolution=(COLUMNS, ROWS)))
    _, _, weights = sampled(mi, sensor_of(mi, exposure_time_s=1.0, **properties), spp)
    theirs = pixel_means(camera.generate_rays(spp=spp).weights)
    # Half a million samples of two in a hundred blocked rays are right to 0.02%. Where a film is dark in the corners,
    # pixels are partly lit, and samples that fall at random in them are right to 0.2%.
    assert weights.mean() == pytest.approx(theirs.mean(), rel=1e-3 if theirs.min() > 0 else 5e-3)
    lit = theirs > 0.5 * theirs.max()
    assert (pixel_means(weights > 0)[lit]).mean() > 0.95


def scene(mi: Any, integrator: str, **crop: int) -> Any:
    """A floor, a ball and a lamp that the picture shows from its edge on."""
    look_at = mi.ScalarTransform4f().look_at
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": integrator, "max_depth": 3},
            "sensor": {
                "type": "realcam",
                "film": film(**crop),
                "to_world": look_at(origin=[0.2, 0.3, 2], target=[0, 0, 0], up=[0, 1, 0]),
                **DOUBLE_GAUSS,
            },
            "wall": {
                "type": "rectangle",
                "to_world": mi.ScalarTransform4f().translate([0, 0, -0.5]).scale(2),
                "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.7, 0.4, 0.2]}},
            },
            "ball": {"type": "sphere", "radius": 0.2, "center": [-0.2, 0, 0], "bsdf": {"type": "diffuse"}},
            "lamp": {
                "type": "rectangle",
                "to_world": look_at(origin=[0.3, 0.2, 0.2], target=[0, 0, 1], up=[0, 1, 0]).scale(0.1),
                "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [10, 8, 6]}},
            },
        }
    )


def blocks(mi: Any, picture_of: Any, rounds: int, spp: int) -> np.ndarray:
    """(rounds, 4, 5, channels): means of 5 x 6 pixels."""
    pictures = [np.array(mi.render(picture_of, spp=spp, seed=seed)) for seed in range(rounds)]
    return np.array(pictures).reshape(rounds, 4, ROWS // 4, 5, COLUMNS // 5, -1).mean(axis=(2, 4))


@pytest.mark.parametrize("variant", ["llvm_ad_rgb", "llvm_ad_spectral", "cuda_ad_rgb"])
def test_path_and_ptracer_take_the_same_picture(variant: str) -> None:
    mi = mitsuba(variant)
    rounds = 16
    a, b = blocks(mi, scene(mi, "path"), rounds, 128), blocks(mi, scene(mi, "ptracer"), rounds, 512)
    # Standard error of each block, from its own rounds, plus the rounding of float32.
    error = np.sqrt((a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / rounds + (2e-4 * a.mean()) ** 2)
    # The largest of 60 t values (blocks and channels) with 30 degrees of freedom exceeds 5 in one of 700 tests.
    assert np.abs((a.mean(axis=0) - b.mean(axis=0)) / error).max() < 5
    whole = a.mean(axis=(1, 2, 3)), b.mean(axis=(1, 2, 3))
    of_whole = np.sqrt(sum(w.var(ddof=1) for w in whole) / rounds)
    assert of_whole < 0.01 * whole[0].mean()  # or the next line would say nothing
    assert abs(whole[0].mean() - whole[1].mean()) < 4 * of_whole


def test_a_crop_window_is_a_piece_of_the_picture(mi: Any) -> None:
    window = {"crop_offset_x": 6, "crop_offset_y": 5, "crop_width": 12, "crop_height": 10}
    for integrator, spp in (("path", 256), ("ptracer", 1024)):
        whole = np.array(mi.render(scene(mi, integrator), spp=spp))[5:15, 6:18]
        piece = np.array(mi.render(scene(mi, integrator, **window), spp=spp))
        # Means over 120 pixels of some hundred samples each; a window a pixel off would differ by a tenth.
        assert piece.mean(axis=(0, 1)) == pytest.approx(whole.mean(axis=(0, 1)), rel=0.04)


def test_light_of_a_colour_goes_its_own_way() -> None:
    """Rays of the spectral variant, sent back through the lens by Lens.trace in double, each at its wavelength."""
    mi = mitsuba("llvm_ad_spectral")
    lens = rc.Lens.load("double-gauss-50mm")
    ray, place, weights = sampled(mi, sensor_of(mi, lens="double-gauss-50mm", exposure_time_s=1.0), 1)
    nm = np.array(ray.wavelengths)
    assert (nm == nm[0]).all()  # of one ray
    # The sensor stands at the origin and looks along z, with x to the left.
    o = 1000 * np.array(ray.o).T * [-1, 1, -1] + [0, 0, lens.film_position_mm]
    d = np.array(ray.d).T.astype(float) * [-1, 1, -1]
    seen = np.flatnonzero(weights > 0)[::5]
    assert len(seen) > 100 and np.ptp(nm[0][seen]) > 300
    width, height = lens.film_mm
    for i in seen:
        back = lens.trace(o[i : i + 1], -d[i : i + 1], wavelength_nm=float(nm[0][i]), start="scene")
        at, direction = back.origins_mm[0], back.directions[0]
        x, y = (at + direction * ((lens.film_position_mm - at[2]) / direction[2]))[:2]
        # float32 leaves 1e-4 mm; at the design wavelength instead, rays of the corners land 0.03 mm away.
        assert x == pytest.approx((0.5 - place[0, i]) * width, abs=1e-3)
        assert y == pytest.approx((place[1, i] - 0.5) * height, abs=1e-3)


def test_differentials_are_the_rays_of_the_next_pixels(mi: Any) -> None:
    sensor = sensor_of(mi, **DOUBLE_GAUSS)
    place, u = mi.Point2f([0.4, 0.7], [0.5, 0.3]), mi.Point2f([0.3, 0.6], [0.2, 0.9])
    ray, _ = sensor.sample_ray_differential(0.0, 0.5, place, u, True)
    right, _ = sensor.sample_ray(0.0, 0.5, place + mi.Vector2f(1 / COLUMNS, 0), u, True)
    down, _ = sensor.sample_ray(0.0, 0.5, place + mi.Vector2f(0, 1 / ROWS), u, True)
    for a, b in ((ray.o_x, right.o), (ray.d_x, right.d), (ray.o_y, down.o), (ray.d_y, down.d)):
        np.testing.assert_allclose(np.array(a), np.array(b), atol=1e-6)
    assert bool(ray.has_differentials)


def test_parameters_of_the_scene_turn_the_rings(mi: Any) -> None:
    changed = sensor_of(mi, **DOUBLE_GAUSS)
    parameters = mi.traverse(changed)
    for name, value in (("f_number", 8.0), ("focus_distance_m", 0.9), ("exposure_time_s", 0.5)):
        parameters[name] = value
    parameters.update()
    loaded = sensor_of(mi, lens="double-gauss-50mm", f_number=8.0, focus_distance_m=0.9, exposure_time_s=0.5)
    a, b = (sampled(mi, sensor, 4) for sensor in (changed, loaded))
    np.testing.assert_allclose(a[2], b[2], rtol=1e-5)
    np.testing.assert_allclose(np.array(a[0].d), np.array(b[0].d), atol=1e-6)


def test_xml_says_the_same_as_a_dictionary(mi: Any) -> None:
    xml = (
        '<scene version="3.0.0"><sensor type="realcam"><string name="lens" value="tessar-50mm"/>'
        '<float name="f_number" value="8"/><float name="film_width_mm" value="24"/>'
        '<film type="hdrfilm"><integer name="width" value="30"/><integer name="height" value="20"/></film>'
        "</sensor></scene>"
    )
    sensor = mi.load_string(xml).sensors()[0]
    assert "tessar-50mm" in str(sensor) and "f/8" in str(sensor) and "24 x 16 mm" in str(sensor)


def message_of(mi: Any, **properties: Any) -> str:
    with pytest.raises(Exception) as caught:  # Mitsuba wraps what a sensor raises
        sensor_of(mi, **properties)
    return str(caught.value)


def test_what_cannot_be_expressed_is_named(mi: Any, tmp_path: Any) -> None:
    tessar = rc.Lens.load("tessar-50mm")
    toroid = tessar.with_surface(2, form="toroid", radius_of_curvature_x_mm=80.0)
    tilted = tessar.with_surface(0, tilt_deg=(1.0, 0.0, 0.0))
    for name, lens in (("toroid", toroid), ("tilted", tilted)):
        lens.save(tmp_path / f"{name}.toml")
    assert 'surface 3 of lens "tessar-50mm" is of the form "toroid"' in message_of(
        mi, lens=str(tmp_path / "toroid.toml")
    )
    assert "surface 1" in message_of(mi, lens=str(tmp_path / "tilted.toml"))
    assert "needs a lens" in message_of(mi)
    assert "no-such-lens" in message_of(mi, lens="no-such-lens")
    assert "not both" in message_of(mi, lens="tessar-50mm", exposure_time_s=1.0, shutter_close=1.0)
    assert "scene_unit_m" in message_of(mi, lens="tessar-50mm", to_world=mi.ScalarTransform4f().scale(2))
