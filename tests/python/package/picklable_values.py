"""One or several of each kind of value that can be pickled: for tests of values, and for `./run fuzz pickles`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import realcam as rc
from realcam import _core


def floor_scene() -> rc.Scene:
    corners = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)]
    return rc.Scene.from_arrays(corners, [(0, 2, 1), (0, 3, 2)])


def lens() -> rc.Lens:
    return rc.Lens.load("double-gauss-50mm").focused(1.5).stopped_down(4)


def camera() -> rc.Camera:
    return rc.Camera(lens(), film=rc.Film(36, 24, (12, 8)), position=(0, 1, 2), look_at=(0, 0, 0), iso=400)


def scene() -> rc.Scene:
    chair = floor_scene()
    matrices = np.stack([np.eye(4)] * 3)
    matrices[:, 0, 3] = [1, 2, 3]
    return (
        floor_scene()
        .with_instance(chair, matrices, name="chair")
        .with_sun((0, -1, 0), (1, 2, 3))
        .with_environment(np.arange(24.0).reshape(2, 4, 3))
    )


def session() -> rc.Session:
    return rc.Session(floor_scene().with_environment(100), camera(), effects=(), device="cpu")


def image() -> rc.Image:
    return rc.render(floor_scene().with_environment(100), camera(), effects=(), spp=2, device="cpu")


ORIGINS, DIRECTIONS = np.full((4, 3), (0.0, 0.0, 80.0)), np.array([[0, 0.01 * i, -1] for i in range(4)])


# Each made twice is equal, and differs from its neighbour here.
def calibrated_geometry(**more: Any) -> Any:
    """Directions at the corners of two cells: those of a pinhole camera."""
    x, y = np.meshgrid([-0.3, 0.0, 0.3], [0.2, -0.2])
    directions = np.stack([x, y, -np.ones_like(x)], axis=-1)
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return _core.CalibratedGeometry(
        film=rc.Film(),
        margin=0.1,
        directions=directions,
        max_angle_deg=20.0,
        positions=np.full((3, 3, 2), 0.5, np.float32),
        pinhole=(1.4, 2.1, 0.0, 0.5, 0.5),
        **more,
    )


def ray_pair_table(**more: Any) -> Any:
    """Ideal thin lens of 55 mm in focus at infinity, 5 mm in front of the last vertex; its rim is the stop."""
    linear, discs = np.zeros((1, 3, 2), np.float32), np.zeros((1, 4, 2), np.float32)
    linear[0, 0] = -1, 11  # point on the lens, 1.1 p - 0.1 x, with x and p in units of 10 mm
    linear[0, 1] = -10 / 55, 0  # direction, that of the film point through the centre of the lens
    discs[0, 0] = linear[0, 0] / 4
    values: dict[str, Any] = {
        "name": "ideal",
        "wavelength_nm": 550,
        "length_mm": 10,
        "film_distance_mm": 50,
        "focus_distance_m": np.inf,
        "film_mm": (10, 10),
        "film_radius_mm": 10,
        "last_radius_mm": 10,
        "plane_mm": 5,
        "degree": 0,
        "coefficients": linear,
        "discs": discs,
    }
    return _core.RayPairTable(**{**values, **more})


MAKERS: dict[str, list[Callable[[], Any]]] = {
    "Glass": [lambda: rc.Glass.named("N-BK7"), lambda: rc.Glass.constant(1.5), lambda: rc.Glass.table([(500, 1.5)])],
    "Surface": [
        lambda: lens().surfaces[0],
        lambda: lens().surfaces[0].replace(coating="bare"),
        lambda: rc.Stop(clear_semi_diameter_mm=3),
    ],
    "Coating": [
        lambda: rc.Coating.named("quarter_wave"),
        lambda: rc.Coating.quarter_wave(1.45),
        lambda: rc.Coating(metal="silver"),
        lambda: rc.Coating(reflectance=0.9),
        lambda: rc.Coating(
            [rc.CoatingLayer("N-BK7", thickness_nm=50)], name="a name that nobody would type twice, long"
        ),
    ],
    "CoatingLayer": [
        lambda: rc.CoatingLayer(1.38, thickness_nm=90),
        lambda: rc.CoatingLayer(1.38 + 1j, thickness_nm=90),
    ],
    "CoatingResponse": [
        lambda: rc.Coating().response(0, 550, inside=1.5),
        lambda: rc.Coating().response(0, 550, inside=1.6),
    ],
    "Lens": [lens, lambda: lens().with_coating("bare"), lambda: lens().focused(2), lambda: lens().stopped_down(8)],
    "FirstOrder": [lambda: lens().first_order(), lambda: lens().stopped_down(8).first_order()],
    "EffectInfo": [lambda: rc.effects()[0], lambda: rc.effects()[1]],
    "RenderSettings": [
        lambda: rc.RenderSettings(spp="auto", effects="dispersion", illuminant="A", layers="all"),
        lambda: rc.RenderSettings(),
    ],
    "CalibratedGeometry": [
        lambda: calibrated_geometry(),
        lambda: calibrated_geometry(gain=np.ones((2, 3), np.float32), defined=np.ones((4, 4), bool)),
    ],
    "RayPairTable": [lambda: ray_pair_table(), lambda: ray_pair_table(focus_distance_m=2.0)],
    "Film": [lambda: rc.Film(), lambda: rc.Film(resolution=(960, 641))],
    "CameraKey": [
        lambda: rc.CameraKey(1, focus_m=2, f_number=4, interpolation="smooth"),
        lambda: rc.CameraKey(1, focus_m=2, f_number=4),
        lambda: rc.CameraKey(1, lens=lens(), blades=6, film_shift_mm=(1, 2)),
        lambda: rc.CameraKey(1, blades=7),
    ],
    "Shake": [
        lambda: rc.Shake(rms_deg=0.1, seed=2),
        lambda: rc.Shake(rms_deg=0.1),
        lambda: rc.Shake(curve=[(0, (0.1, 0, 0), (0, 0, 0)), (1, (0, 0, 0), (0, 0, 1))]),
    ],
    "Camera": [camera, lambda: rc.Camera(lens())],
    "Material": [lambda: rc.Material(), lambda: rc.Material(emission=(1, 0, 0))],
    "Scene": [scene, floor_scene, lambda: scene().moved("chair 1", np.eye(4))],
    "Meridian": [lambda: lens().meridians()[0], lambda: lens().stopped_down(8).meridians()[0]],
    "FilmPupil": [lambda: lens().film_pupil(), lambda: lens().film_pupil((0, 9))],
    "Spot": [lambda: lens().spot(10), lambda: lens().spot(10, samples=3), lambda: lens().spot(11)],
    "Wavefront": [lambda: lens().wavefront(10, samples=8), lambda: lens().wavefront(11, samples=8)],
    "PSF": [lambda: lens().psf(10, size=16), lambda: lens().psf(11, size=16), lambda: lens().psf(10, 500, size=16)],
    "Seidel": [lambda: lens().seidel(10), lambda: lens().seidel(11)],
    "Ghost": [lambda: lens().ghost(4, 2), lambda: lens().ghost(4, 1)],
    "AimedRays": [lambda: lens().aim([(0, 0), (0, 0.5)]), lambda: lens().aim([(0, 0), (0, 0.6)])],
    "TraceResult": [lambda: lens().trace(ORIGINS, DIRECTIONS), lambda: lens().trace(ORIGINS, 2 * DIRECTIONS[::-1])],
    "CameraRays": [lambda: camera().generate_rays(), lambda: camera().generate_rays(seed=1)],
    "Sensor": [
        lambda: rc.Sensor.load(),
        lambda: rc.Sensor.load("sony-imx900-mono"),
        lambda: rc.Sensor.load().replace(adc_bits=14),
    ],
    "RayBundle": [
        lambda: lens().bundle(10, arms=8, nodes=2),
        lambda: lens().bundle(11, arms=8, nodes=2),
    ],
    "RigCamera": [
        lambda: rc.RigCamera(camera()),
        lambda: rc.RigCamera(camera(), rc.Sensor.load(), ((500, 1), (600, 1))),
    ],
    "Rig": [
        lambda: rc.Rig({"a": camera()}),
        lambda: rc.Rig.stereo(camera(), baseline_m=0.1),
        lambda: rc.Rig({"a": camera()}, np.stack([np.eye(4)] * 2), (0, 1)),
    ],
    "RawImage": [lambda: rc.Sensor.load().expose(image()), lambda: rc.Sensor.load().expose(image(), seed=1)],
    "FilmPart": [lambda: session().expose((2, 1, 3, 4), 0, 2), lambda: session().expose((2, 1, 3, 4), 2, 2)],
    "Image": [
        image,
        lambda: rc.render(floor_scene().with_environment(100), camera(), effects=(), spp=2, seed=1, device="cpu"),
    ],
    "OpticalFlow": [
        lambda: rc.OpticalFlow(np.zeros((2, 3, 2), np.float32), np.ones((2, 3), bool)),
        lambda: rc.OpticalFlow(np.zeros((2, 3, 2), np.float32), np.zeros((2, 3), bool)),
    ],
}


def plan() -> rc.Plan:
    return rc.plan(floor_scene().with_environment(100), camera(), device="cpu")


# All of them: also those that take a while, or are never the same again.
ALL_MAKERS: dict[str, list[Callable[[], Any]]] = {
    **MAKERS,
    "RenderStats": [lambda: image().stats],
    "Device": [lambda: rc.devices()[0]],
    "Plan": [plan],
    "PlanDecision": [lambda: plan().decisions[0]],
}
