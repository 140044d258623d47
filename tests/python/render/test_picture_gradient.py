"""rc.render_gradient: its parameters and units, beside central differences of pictures with common random numbers. The
core's own tests (test_picture_gradient.cpp) have closed forms. Each estimate has 16 seeds, whose spread is its standard
error; 4.5 of these are allowed, and the seeds are fixed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc
from numpy.typing import NDArray
from realcam.derivatives.picture import ring_rates

from ..device_memory import needs_gpu
from ..scenes import quad, scene_of, shifted, sky

SEEDS = 16
ERRORS = 4.5


def stripes(occluder: bool = True) -> rc.Scene:
    """Stripes of random colours at 3 m, and an edge at 1.4 m that hides some of them."""
    random = np.random.default_rng(3)
    quads = [quad((-1.15 + 0.1 * i, 0, -3), 0.05, 1.5, emission=random.uniform(0.2, 2, 3)) for i in range(24)]
    if occluder:
        right, up = (np.cos(0.3), np.sin(0.3), 0.0), (-np.sin(0.3), np.cos(0.3), 0.0)
        middle = -1.2 * np.array(right) + (0, 0, -1.4)
        quads.append(quad(middle, 1.5, 1.5, right=right, up=up))
    return scene_of(*quads)


def corner_camera(f_number: float = 4.0) -> rc.Camera:
    """A few pixels of the double Gauss, off its axis, where rims vignette."""
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0).stopped_down(f_number)
    return rc.Camera(lens, film=rc.Film(0.8, 0.8, (8, 8), shift_mm=(10, 6)), exposure_time_s=1.0)


ADJOINT = np.random.default_rng(5).normal(size=(8, 8, 3))


def estimate(of_seed: Callable[[int], NDArray[np.float64]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean over the seeds, and its standard error."""
    values = np.array([of_seed(seed) for seed in range(SEEDS)], float)
    return values.mean(0), values.std(0, ddof=1) / np.sqrt(SEEDS)


def film(scene: rc.Scene, camera: rc.Camera, spp: int, seed: int, filter: str, device: str) -> NDArray[np.float64]:
    """Picture from samples that count for all pixels whose filters they reach."""
    settings = rc.RenderSettings(filter=filter, effects=(), max_bounces=0)
    return rc._core._PictureGradient(scene, camera, settings, [], device).picture(seed=seed, spp=spp).astype(float)


def difference(
    scene: rc.Scene, below: rc.Camera, above: rc.Camera, step: float, device: str, *, spp: int, filter: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Central difference of sum(ADJOINT * picture) between cameras 2 steps apart."""

    def of_seed(seed: int) -> NDArray[np.float64]:
        to, start = (film(scene, camera, spp, 1000 + seed, filter, device) for camera in (above, below))
        return np.asarray(((to - start) * ADJOINT).sum() / (2 * step))

    return estimate(of_seed)


def changed(camera: rc.Camera, parameter: str, step: float) -> rc.Camera:
    """The camera, which must be at the origin, with a parameter changed."""
    lens, shift = camera.lens, camera.film.shift_mm
    angle = np.radians(step)
    if parameter in ("right_m", "up_m", "backward_m"):
        move = step * np.eye(3)[("right_m", "up_m", "backward_m").index(parameter)]
        return camera.replace(position=tuple(move), look_at=tuple(move - (0, 0, 1)))
    if parameter == "pitch_deg":
        return camera.replace(look_at=(0, np.sin(angle), -np.cos(angle)))
    if parameter == "yaw_deg":
        return camera.replace(look_at=(-np.sin(angle), 0, -np.cos(angle)))
    if parameter == "roll_deg":
        return camera.replace(up=(-np.sin(angle), np.cos(angle), 0))
    if parameter == "film_shift_right_mm":
        return camera.replace(film=camera.film.replace(shift_mm=(shift[0] + step, shift[1])))
    if parameter == "film_shift_up_mm":
        return camera.replace(film=camera.film.replace(shift_mm=(shift[0], shift[1] + step)))
    if parameter == "focus_distance_m":
        return camera.replace(lens=lens.focused(lens.focus_distance_m + step))
    if parameter == "focal_length_mm":
        focal_length = lens.focused(np.inf).first_order().effective_focal_length_mm
        return camera.replace(lens=lens.zoomed(focal_length + step))
    if parameter == "rim_scale":
        return rc.CameraParameters(camera, "rim_scale").camera_at([1 + step])
    assert parameter == "f_number"
    return camera.replace(lens=lens.stopped_down(lens.f_number + step))


# Steps move the light on the film by at most 0.06 pixels: with an adjoint that is independent from pixel to pixel, the
# error of a difference is about (3 x step in pixels)^2 / 6 of it, 0.5%.
STEPS = {
    "right_m": 2e-4,
    "up_m": 2e-4,
    "backward_m": 1e-3,
    "pitch_deg": 0.005,
    "yaw_deg": 0.005,
    "roll_deg": 0.02,
    "film_shift_right_mm": 0.005,
    "film_shift_up_mm": 0.005,
    "focus_distance_m": 0.05,
    "f_number": 0.05,
    "focal_length_mm": 0.2,
    "rim_scale": 3e-3,
}


def check_against_differences(
    scene: rc.Scene, camera: rc.Camera, filter: str, spp: int, parameters: list[str], device: str
) -> None:
    found, error = estimate(
        lambda seed: rc.render_gradient(
            scene, camera, parameters, ADJOINT, filter=filter, device=device, spp=spp, seed=seed, max_bounces=0
        )
    )
    for i, parameter in enumerate(parameters):
        step = STEPS[parameter]
        wanted, wanted_error = difference(
            scene,
            changed(camera, parameter, -step),
            changed(camera, parameter, step),
            step,
            device,
            spp=2 * spp,
            filter=filter,
        )
        z = (found[i] - wanted) / np.hypot(error[i], wanted_error)
        assert abs(z) < ERRORS, f"{parameter}: {found[i]} +- {error[i]}, wanted {wanted} +- {wanted_error}"


def test_rings_pose_and_film_equal_differences(device: str) -> None:
    parameters = ["focus_distance_m", "f_number", "yaw_deg", "film_shift_right_mm"]
    check_against_differences(stripes(), corner_camera(), "tent", 48, parameters, device)


def zoom_camera() -> rc.Camera:
    """A few pixels of a zoom lens, off its axis."""
    lens = rc.Lens.load("zoom-70-200mm").zoomed(90.0).focused(3.0).stopped_down(4.0)
    return rc.Camera(lens, film=rc.Film(0.8, 0.8, (8, 8), shift_mm=(10, 6)), exposure_time_s=1.0)


def test_the_zoom_ring_equals_differences(device: str) -> None:
    check_against_differences(stripes(occluder=False), zoom_camera(), "tent", 64, ["focal_length_mm"], device)


def test_exposure_is_proportional_to_its_time(device: str) -> None:
    scene, camera = stripes(), corner_camera()
    wanted = film(scene, camera, 16, 0, "tent", device)  # in one second
    gradient = rc.render_gradient(scene, camera, "exposure_time_s", ADJOINT, spp=16, max_bounces=0, device=device)
    assert gradient[0] == pytest.approx((ADJOINT * wanted).sum(), rel=1e-5)
    if device == "cpu":
        pictures = rc.render_gradient(
            scene, camera, ["exposure_time_s", "f_number"], spp=16, max_bounces=0, device=device
        )
        assert np.allclose(pictures[0], wanted, rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("filter", ["tent", "gaussian"])
@pytest.mark.parametrize("f_number", [2.2, 4.0])
@pytest.mark.parametrize("occluder", [False, True])
def test_all_parameters_equal_differences(filter: str, f_number: float, occluder: bool, device: str) -> None:
    parameters = [parameter for parameter in STEPS if parameter != "focal_length_mm"]
    check_against_differences(stripes(occluder), corner_camera(f_number), filter, 512, parameters, device)


def test_control_variate_changes_the_noise_but_not_the_mean(device: str) -> None:
    scene, camera = stripes(), corner_camera()
    parameters = ["up_m", "focus_distance_m", rc.Variable.radius(0)]

    def with_control(spp: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return estimate(
            lambda seed: rc.render_gradient(
                scene, camera, parameters, ADJOINT, spp=32, seed=seed, control_spp=spp, max_bounces=0, device=device
            )
        )

    (mean, error), (plain_mean, plain_error) = with_control(8), with_control(0)
    assert np.all(np.abs(mean - plain_mean) < ERRORS * np.hypot(error, plain_error))


def test_control_variate_serves_the_pose_alone(device: str) -> None:
    scene, camera = stripes(), corner_camera()
    parameters = ["focus_distance_m", "f_number", "film_shift_up_mm", rc.Variable.radius(0), "up_m"]

    def gradients(control_spp: int) -> NDArray[np.float64]:
        return np.array(
            [
                rc.render_gradient(
                    scene, camera, parameters, ADJOINT, spp=4, seed=seed, control_spp=control_spp, device=device
                )
                for seed in range(4)
            ]
        )

    found, plain = gradients(4), gradients(0)
    # The samples are the same; the adjoint at a film point is rounded to float32.
    close = np.abs(found - plain).max(0) < 1e-5 * np.abs(plain).max(0)
    assert list(close) == [True, True, True, True, False]


def test_forward_is_the_transpose_of_reverse() -> None:
    scene, camera = stripes(), corner_camera()
    parameters = ["right_m", "f_number", "focus_distance_m", rc.Variable.thickness(1)]
    settings = {"spp": 4, "control_spp": 4, "max_bounces": 0, "device": "cpu"}
    pictures = rc.render_gradient(scene, camera, parameters, **settings)
    assert pictures.shape == (4, 8, 8, 3)
    reverse = rc.render_gradient(scene, camera, parameters, ADJOINT, **settings)
    sizes = np.abs(pictures * ADJOINT).sum((1, 2, 3))
    # Pictures, and the adjoint at a film point, are rounded to float32.
    assert np.all(np.abs((pictures * ADJOINT).sum((1, 2, 3)) - reverse) < 1e-5 * sizes)


def test_a_direction_is_the_sum_of_its_parameters() -> None:
    scene, camera = stripes(), corner_camera()
    gap = rc.Variable.thickness(1)
    directions = [{"focus_distance_m": 2.0, gap: -3.0}, "focus_distance_m", gap]
    both, focus, thickness = rc.render_gradient(scene, camera, directions, ADJOINT, spp=4, max_bounces=0)
    assert both == pytest.approx(2 * focus - 3 * thickness, abs=1e-9 * max(abs(focus), abs(thickness)))


def test_even_light_has_no_derivative_by_pose(device: str) -> None:
    # The control variate is the radiance itself.
    gradient = rc.render_gradient(sky(), corner_camera(), ["right_m", "up_m", "yaw_deg"], ADJOINT, spp=4, device=device)
    assert np.all(np.abs(gradient) < 1e-4)


def fisheye_camera() -> rc.Camera:
    """A few pixels at the border of a fisheye's picture."""
    lens = rc.Lens.load("fisheye-6mm-220deg").focused(1).stopped_down(8)
    return rc.Camera(lens, film=rc.Film(0.8, 0.8, (8, 8), shift_mm=(11.1, 0.7)), exposure_time_s=1.0)


def test_even_light_has_none_at_a_fisheyes_border(device: str) -> None:
    """Interior and boundary cancel. Rays that leave the steep first surface by its rim, 110 degrees from the axis,
    cross the rim's plane on the other side of the rim."""
    camera = fisheye_camera()
    parameters = ["right_m", "backward_m"]
    found, error = estimate(
        lambda seed: rc.render_gradient(
            sky(), camera, parameters, np.ones((8, 8, 3)), spp=64, seed=seed, control_spp=0, device=device
        )
    )
    assert np.all(np.abs(found) < ERRORS * error)
    settings = rc.RenderSettings(effects=(), filter="tent")
    boundary = rc._core._PictureGradient(sky(), camera, settings, [], device).reverse(
        np.ones((8, 8, 3)), None, seed=0, spp=1, outline_spp=64, terms="boundary"
    )
    # The boundary of one of the two parameters alone is many standard errors: the test can fail.
    assert abs(1000 * boundary[8]) > 20 * error[1]


@pytest.mark.parametrize(("camera", "scale"), [(lambda: corner_camera(2.2), 0.95), (fisheye_camera, 1.0)])
def test_the_scale_of_rims_equals_differences(camera: Callable[[], rc.Camera], scale: float, device: str) -> None:
    """In even light, all of it comes from the boundary. When the rim of the fisheye's steep first surface grows, it
    also moves along z."""
    family, step = rc.CameraParameters(camera(), "rim_scale"), 1e-3
    found, error = estimate(
        lambda seed: family.gradient(
            sky(), [scale], np.ones((8, 8, 3)), spp=1, outline_spp=128, seed=seed, device=device
        )
    )

    def of_seed(seed: int) -> NDArray[np.float64]:
        above, below = (family.render(sky(), [scale + h], spp=1024, seed=seed, device=device) for h in (step, -step))
        return np.asarray((above.astype(float) - below).sum() / (2 * step))

    wanted, wanted_error = estimate(of_seed)
    # The error of the step is of the order of its square.
    assert abs(found[0] - wanted) < ERRORS * np.hypot(error[0], wanted_error) + 1e-5 * wanted
    assert found[0] > 50 * max(error[0], wanted_error)


def window_camera(shift_mm: float) -> rc.Camera:
    """A stop of 5 mm radius 40 mm in front of the film, and a window of 4 mm radius 30 mm in front of it."""
    stop = rc.Stop(clear_semi_diameter_mm=5.0, thickness_mm=10.0)
    window = rc.Surface(type="aperture", clear_semi_diameter_mm=4.0)
    lens = rc.Lens(surfaces=[stop, window], film_distance_mm=30.0)
    return rc.Camera(lens, film=rc.Film(0.04, 0.04, (4, 4), shift_mm=(shift_mm, 0)), exposure_time_s=1.0)


@pytest.mark.parametrize("field_mm", [0.0, 2.0, 6.0, 12.0, 20.0])
def test_the_area_of_a_cats_eye_grows_with_the_rims(field_mm: float, device: str) -> None:
    """Seen from the film, the window is a circle in the plane of the stop. Even light gains the directions behind its
    arc within the stop."""
    found, error = estimate(
        lambda seed: rc.render_gradient(
            sky(),
            window_camera(field_mm),
            "rim_scale",
            np.ones((4, 4, 3)),
            spp=16,
            outline_spp=64,
            seed=seed,
            device=device,
        )
    )
    centre, radius = -field_mm * (40 / 30 - 1), 4.0 * 40 / 30
    angle = 2 * np.pi * (np.arange(200_000) + 0.5) / 200_000
    x, y = centre + radius * np.cos(angle), radius * np.sin(angle)
    squared_cosine = 1 / (1 + ((x - field_mm) ** 2 + y**2) / 40**2)
    gain = 2 * np.pi * radius**2 * np.mean((x**2 + y**2 < 5**2) * squared_cosine**2) / 40**2
    # The field varies by 0.04 mm over the picture, about a mean that is exact to second order.
    assert abs(found[0] - 48 * gain) <= ERRORS * error[0] + 1e-4 * 48 * gain
    assert error[0] <= 0.05 * 48 * gain


def tilted() -> rc.Camera:
    """corner_camera with a lens that has no symmetry: an element is decentred, and the last surface tilted."""
    camera = corner_camera()
    lens = camera.lens.with_surface(2, decentre_mm=(0.2, -0.1, 0.0), returns=True)
    return camera.replace(lens=lens.with_surface(10, tilt_deg=(0.5, 0.3, 0.0)))


def with_aspheres() -> rc.Camera:
    lens = rc.Lens.load("phone-4mm").focused(2.0)
    return rc.Camera(lens, film=rc.Film(0.4, 0.4, (8, 8), shift_mm=(1, 0.7)), exposure_time_s=1.0)


@needs_gpu
@pytest.mark.parametrize("bounces", [0, 3])
@pytest.mark.parametrize("effects", [(), ("dispersion",)])
@pytest.mark.parametrize("camera", [corner_camera, tilted, with_aspheres])
def test_devices_agree(camera: Callable[[], rc.Camera], effects: tuple[str, ...], bounces: int) -> None:
    """With the same seed, samples differ by roundings alone, which may bring a few of them to another surface: less
    than a tenth of their noise. With other seeds, the means differ by their noise."""
    scene, taken_by = stripes(), camera()
    variables = [rc.Variable.radius(1), rc.Variable.thickness(2), rc.Variable.index(3), rc.Variable.decentre(3)]
    parameters = ["right_m", "backward_m", "yaw_deg", "film_tilt_x_deg", "focus_distance_m", *variables]

    def on(device: str, first: int = 0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return estimate(
            lambda seed: rc.render_gradient(
                scene,
                taken_by,
                parameters,
                ADJOINT,
                spp=32,
                seed=first + seed,
                device=device,
                effects=effects,
                max_bounces=bounces,
            )
        )

    (mean, error), (same, _), (other, other_error) = on("cpu"), on("cuda"), on("cuda", 100)
    assert np.all(np.abs(same - mean) < 0.1 * error)
    assert np.all(np.abs(other - mean) < ERRORS * np.hypot(error, other_error))


@needs_gpu
def test_a_gpu_gives_the_same_bits_again() -> None:
    def gradient() -> NDArray[np.float64]:
        return rc.render_gradient(stripes(), corner_camera(), ["up_m", rc.Variable.radius(0)], ADJOINT, device="cuda")

    assert np.array_equal(gradient(), gradient())


@needs_gpu
def test_what_gpus_do_not_support_is_refused_in_one_line() -> None:
    with pytest.raises(rc.InputError, match=r"in forward mode run on the CPU: use device=\"cpu\"$"):
        rc.render_gradient(sky(), corner_camera(), "up_m", device="cuda")
    lens = rc.Lens.load("anamorphic-31mm").focused(2.0)
    camera = rc.Camera(lens, film=rc.Film(0.8, 0.8, (8, 8)))
    with pytest.raises(rc.InputError, match=r"do not support freeform surfaces, and lens .* has one"):
        rc.render_gradient(sky(), camera, "up_m", ADJOINT, device="cuda")
    rc.render_gradient(sky(), camera, "up_m", ADJOINT, spp=1)  # the CPU is chosen


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"filter": "box"}, "need a smooth pixel filter"),
        ({"filter": "lanczos"}, 'filter must be box, tent or gaussian; it is "lanczos"'),
        ({"effects": "ghosts"}, "do not support the effect ghosts"),
        ({"spp": "auto"}, "take no noise goal"),
        ({"control_spp": -1}, "control_spp is -1; expected a whole number from 0 to 16777216"),
        ({"control_spp": 2.5}, "control_spp is 2.5; expected a whole number"),
        ({"control_spp": True}, "control_spp is True; expected a whole number"),
        ({"control_spp": -1, "parameters": "focus_distance_m"}, "control_spp is -1"),
        ({"outline_spp": -1}, "outline_spp must lie between 1 and 16777216"),
        ({"parameters": "zoom"}, "unknown parameter 'zoom'"),
        ({"parameters": []}, "at least one"),
        ({"parameters": ["up_m", "up_m"]}, "must be distinct"),
        ({"adjoint": np.zeros((8, 8))}, "must be an array of shape (8, 8, 3)"),
    ],
)
def test_what_is_not_supported_is_refused_by_name(keywords: dict[str, object], message: str) -> None:
    arguments: dict[str, object] = {"parameters": "up_m", "adjoint": ADJOINT, **keywords}
    with pytest.raises(rc.InputError) as error:
        rc.render_gradient(sky(), corner_camera(), **arguments)  # type: ignore[arg-type]
    assert message in str(error.value)


def test_rings_at_their_ends_are_refused() -> None:
    camera = corner_camera()
    wide_open = camera.replace(lens=rc.Lens.load("double-gauss-50mm"))
    with pytest.raises(rc.InputError, match="does not exist wide open"):
        rc.render_gradient(sky(), wide_open, "f_number", ADJOINT)
    with pytest.raises(rc.InputError, match="does not exist at infinity"):
        rc.render_gradient(sky(), wide_open, "focus_distance_m", ADJOINT)
    with pytest.raises(rc.InputError, match="needs a zoom lens"):
        rc.render_gradient(sky(), camera, "focal_length_mm", ADJOINT)
    hole = rc.Lens(surfaces=[rc.Stop(clear_semi_diameter_mm=0.1)], film_distance_mm=20.0)
    with pytest.raises(rc.InputError, match="rim_scale needs a surface besides the stop"):
        rc.render_gradient(sky(), camera.replace(lens=hole), "rim_scale", ADJOINT)
    zoom = zoom_camera()
    with pytest.raises(rc.InputError, match="at the ends of the zoom range"):
        shortest = zoom.lens.zoomed(0).stopped_down(8)
        rc.render_gradient(sky(), zoom.replace(lens=shortest), "focal_length_mm", ADJOINT)


@pytest.mark.parametrize("stops_below_wide_open", [1e-4, 2e-3, 0.1])
def test_the_stop_ring_is_exact_beside_its_open_end(stops_below_wide_open: float) -> None:
    """The f-number at infinity is inversely proportional to the radius of the diaphragm."""
    lens = rc.Lens.load("cooke-triplet-50mm").focused(2)
    lens = lens.stopped_down(lens.f_number * (1 + stops_below_wide_open))
    of_distances, of_stop = ring_rates(lens, "f_number")
    assert not of_distances
    assert of_stop == pytest.approx(-lens.stop_semi_diameter_mm / lens.f_number, rel=1e-8)


def test_the_focusing_ring_has_a_derivative_at_its_near_end() -> None:
    """Beside the slope of a polynomial through settings of the ring."""
    lens = rc.Lens.load("telephoto-200mm-inner-focus")
    nearest = lens.nearest_focus_m
    of_distances, _ = ring_rates(lens.focused(nearest), "focus_distance_m")
    settings = nearest * (1 + 0.1 * np.arange(12) / 11)
    for variable, rate in of_distances.items():
        values = [variable.of(lens.focused(setting).surfaces[variable.surface]) for setting in settings]
        slope = np.polynomial.Polynomial.fit(settings, values, 8).deriv()(nearest)
        assert rate == pytest.approx(slope, rel=1e-6)


def test_exposure_time_of_a_moving_scene_is_refused() -> None:
    still = scene_of(quad((0, 0, -2), 1, emission=1.0))
    moving = (
        sky()
        .with_instance(still, np.eye(4), name="quad")
        .moved("quad", [shifted(), shifted(x=0.1)], times_s=[0.0, 1.0])
    )
    with pytest.raises(rc.InputError, match="in which nothing moves"):
        rc.render_gradient(moving, corner_camera(), "exposure_time_s", ADJOINT)
