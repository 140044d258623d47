"""Fog: pictures through lenses against closed forms, on each device, and what is said of it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import programs
from ..scenes import quad, scene_of, sky, sphere

DOUBLE_GAUSS = rc.Lens.load("double-gauss-50mm").stopped_down(4)
FILM = rc.Film(36, 24, (48, 32))


def camera(**more: object) -> rc.Camera:
    return rc.Camera(DOUBLE_GAUSS, film=FILM, **{"position": (0, 0, 0), "exposure_time_s": 1} | more)


def pixels(scene: rc.Scene, shot: rc.Camera, device: str, **settings: object) -> np.ndarray:
    """(H, W, 3), float64."""
    values = {"effects": (), "spp": 64, "max_bounces": 0} | settings
    return rc.render(scene, shot, device=device, **values).pixels.astype(np.float64)  # type: ignore[arg-type]


def dark(*positions_m: tuple[float, float, float], candela: float = 1e4) -> rc.Scene:
    """Point lights before nothing; the triangle that a scene must have lies far behind the camera."""
    behind = np.array([[0.0, 0.0, 1e5], [1.0, 0.0, 1e5], [0.0, 1.0, 1e5]])
    scene = rc.Scene.from_arrays(behind, [[0, 1, 2]])
    for position_m in positions_m:
        scene = scene.with_point_light(position_m, (candela,) * 3)
    return scene


@pytest.mark.parametrize("light_tracing", ["weighted", "off", "alone"])
def test_a_lamp_fades_with_its_distance(light_tracing: str, device: str) -> None:
    """Beer-Lambert, for the samples that start at the film and those that start at the lamp. The film lies 0.1 m behind
    the front of the lens, so that the 40 m are known to 0.3%: 0.4% of the light. Noise: a lamp of 4 x 4 pixels, 1024
    samples each."""
    extinction = (0.01, 0.02, 0.05)
    lamp = scene_of(quad((0, 0, -40), 1.2, emission=1000.0))
    settings = {"light_tracing": light_tracing, "spp": 1024}
    clear = pixels(lamp, camera(), device, **settings).sum(axis=(0, 1))
    faded = pixels(lamp.with_air(extinction_per_m=extinction, albedo=0), camera(), device, **settings).sum(axis=(0, 1))
    np.testing.assert_allclose(faded / clear, np.exp(-40 * np.array(extinction)), rtol=0.01)


@pytest.mark.parametrize("effects", [(), ("ghosts",), ("dispersion",), ("dispersion", "diffraction")])
def test_images_and_ghosts_of_a_point_light_fade(effects: tuple[str, ...], device: str) -> None:
    """Both are traced from the light, and the samples of both pictures are the same but for the factor; rounding to
    units of fixed point is below 1e-3."""
    light = dark((3.0, 1.0, -50.0), candela=1e6)
    shot = rc.Camera(DOUBLE_GAUSS.with_coating("bare"), film=FILM, position=(0, 0, 0), exposure_time_s=1)
    clear = pixels(light, shot, device, effects=effects)
    faded = pixels(light.with_air(extinction_per_m=0.02, albedo=0), shot, device, effects=effects)
    expected = np.exp(-0.02 * (np.linalg.norm((3, 1, 50))))
    # From the lens's front, 0.1 m nearer.
    assert faded.sum() / clear.sum() == pytest.approx(expected, rel=5e-3)


def test_a_sun_shines_through_the_air_above_the_scene(device: str) -> None:
    """A white ground under a sun at the zenith and 30 m of air, seen from 10 m above it."""
    ground = scene_of(quad((0, -10, 0), 200, up=(0, 0, -1), diffuse=1.0)).with_sun((0, -1, 0), (1000, 1000, 1000))
    above = camera(position=(0, 0, 0), look_at=(0, -10, 0), up=(0, 0, -1), model="pinhole")
    clear = pixels(ground, above, device)
    foggy = pixels(ground.with_air(extinction_per_m=0.02, albedo=0, margin_m=30), above, device)
    middle = (slice(14, 18), slice(22, 26))
    # A pinhole's film is 0.05 m above the pinhole, and the rays of the middle are up to 2 degrees oblique.
    assert foggy[middle].mean() / clear[middle].mean() == pytest.approx(np.exp(-0.02 * 40), rel=3e-3)
    # By default the air ends half of the visibility above the ground: the optical depth to the sun is 1.956.
    default = pixels(ground.with_air(200, albedo=0), above, device)
    assert default[middle].mean() / clear[middle].mean() == pytest.approx(np.exp(-1.956 - 3.912 / 20), rel=3e-3)


def test_the_glow_of_a_lamp_is_the_integral_along_the_view(device: str) -> None:
    """Single scattering of a point light that is out of the picture, in every pixel: quadrature along the pixels' rays
    of the integral of extinction albedo p(theta) I exp(-extinction (t + d)) / d^2 over t."""
    extinction, albedo, g, at = 0.08, 0.7, 0.4, np.array([0.0, 6.0, -8.0])
    scene = dark(tuple(at)).with_air(extinction_per_m=extinction, albedo=albedo, anisotropy=g)
    shot = camera(model="pinhole")
    seen = pixels(scene, shot, device, spp=256)
    # A pinhole at the origin of the rays; the field of the film is 36 mm at the lens's image distance.
    half = 18 / shot.lens.first_order().effective_focal_length_mm
    columns, rows = np.meshgrid((np.arange(48) + 0.5) / 24 - 1, 1 - (np.arange(32) + 0.5) / 16)
    directions = np.stack([half * columns, half * rows * 2 / 3, -np.ones_like(columns)], axis=-1)
    cosine = 1 / np.linalg.norm(directions, axis=-1, keepdims=True)
    directions *= cosine
    # Gauss-Legendre in the angle at which the lamp sees the ray, where the integrand is smooth.
    nodes, weights = np.polynomial.legendre.leggauss(128)
    nearest = directions @ at
    height = np.sqrt(at @ at - nearest**2)
    first = np.arctan2(-nearest, height)
    angle = first[..., None] + (np.pi / 2 - first)[..., None] * (nodes + 1) / 2
    distance, t = height[..., None] / np.cos(angle), nearest[..., None] + height[..., None] * np.tan(angle)
    cos_theta = -np.sin(angle)
    phase = (1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * cos_theta) ** 1.5)
    integrand = phase * np.exp(-extinction * (t + distance)) / height[..., None]
    radiance = extinction * albedo * 1e4 * (integrand * weights).sum(axis=-1) * (np.pi / 2 - first) / 2
    # The irradiance of a pinhole's film goes with cos^4; compared relative to the mean.
    ratio = seen.mean(axis=2) / (radiance * cosine[..., 0] ** 4)
    # 256 samples: equiangular samples have some 50% of noise, 3% of a pixel; 4 x 4 pixels 0.8%.
    blocks = ratio.reshape(8, 4, 12, 4).mean(axis=(1, 3))
    np.testing.assert_allclose(blocks / blocks.mean(), 1, atol=0.04)


def test_clear_air_is_no_air(device: str) -> None:
    room = sky(100.0)
    assert np.array_equal(pixels(room, camera(), device), pixels(room.with_air(), camera(), device))


def test_the_planner_follows_the_light_in_fog_and_says_what_it_adds(device: str) -> None:
    """A sphere with bright walls in thick air: many scatterings; the air changes nothing there if it does not absorb,
    and much if it does."""
    room = sphere(5, 12, rc.Material(diffuse=(0, 0, 0), emission=(3, 3, 3)), inward=True)
    thick = room.with_air(extinction_per_m=0.5, albedo=0.95, anisotropy=0)
    plan = rc.plan(thick, camera(), effects=(), device=device)
    row = next(d for d in plan.decisions if d.effect == "air")
    assert plan.max_bounces >= 4
    assert row.is_kept and row.unit == "codes" and row.size > 1
    assert not [d for d in rc.plan(room, camera(), effects=(), device=device).decisions if d.effect == "air"]


def test_a_shot_file_has_air(tmp_path: Path) -> None:
    (tmp_path / "quad.obj").write_text("v -1 -1 -5\nv 1 -1 -5\nv 1 1 -5\nv -1 1 -5\nf 1 2 3 4\n")
    start = 'format = 1\nscene = "quad.obj"\nposition_m = [0, 0, 0]\nexposure_time_s = 1\nenvironment_cd_m2 = 10\n'

    def shot(text: str, **changes: object) -> rc.Shot:
        (tmp_path / "shot.toml").write_text(start + text)
        return rc.Shot.load(tmp_path / "shot.toml", **changes)

    def seen(shot: rc.Shot) -> np.ndarray:
        return pixels(shot.scene, camera(), "cpu", spp=4)

    clear = shot("").scene
    full = "[air]\nextinction_per_m = [0.1, 0.2, 0.3]\nalbedo = 0.9\nanisotropy = -0.2\nmargin_m = 7\n"
    in_python = clear.with_air(extinction_per_m=(0.1, 0.2, 0.3), albedo=0.9, anisotropy=-0.2, margin_m=7)
    assert np.array_equal(seen(shot(full)), pixels(in_python, camera(), "cpu", spp=4))
    by_visibility = pixels(clear.with_air(50), camera(), "cpu", spp=4)
    for text, changes in [
        ("[air]\nvisibility_m = 50\n", {}),
        ("air = 50\n", {}),
        ("", {"air": 50}),
        (full, {"air": {"visibility_m": 50}}),
    ]:
        assert np.array_equal(seen(shot(text, **changes)), by_visibility)
    # A visibility replaces the extinction alone.
    other_visibility = clear.with_air(50, albedo=0.9, anisotropy=-0.2, margin_m=7)
    for text in (full, full.replace("extinction_per_m = [0.1, 0.2, 0.3]", "visibility_m = 9")):
        assert np.array_equal(seen(shot(text, air=50)), pixels(other_visibility, camera(), "cpu", spp=4))
    with pytest.raises(rc.InputError, match=r"^the visibility must be a positive number of metres$"):
        shot(full, air=-1)
    for text, message in {
        "air = 0\n": "shot.toml:6: the visibility must be a positive number of metres",
        'air = "thick"\n': "shot.toml:6:",
        "[air]\n": 'shot.toml:6: expected either "visibility_m" or "extinction_per_m"',
        "[air]\nvisibility_m = 5\nextinction_per_m = 1\n": "expected either",
        "[air]\nvisibility_m = 5\nalbedo = 2\n": "the air's albedo must lie between 0 and 1",
        "[air]\nvisibility_m = 5\nfog = 2\n": "shot.toml:8:",
    }.items():
        with pytest.raises(rc.InputError) as error:
            shot(text)
        assert message in str(error.value) and "\n" not in str(error.value)


def test_invalid_air_is_refused() -> None:
    room = sky()
    for arguments, message in [
        ({"visibility_m": -1}, "the visibility must be a positive number"),
        ({"visibility_m": float("nan")}, "the visibility must be a positive number"),
        ({"visibility_m": 5, "extinction_per_m": 1}, "exclude each other"),
        ({"extinction_per_m": (1, -1, 0)}, "the air's extinction must lie between 0 and 1e6 per metre"),
        ({"extinction_per_m": "thick"}, "extinction_per_m must be a number or"),
        ({"visibility_m": 5, "albedo": 1.5}, "the air's albedo must lie between 0 and 1"),
        ({"visibility_m": 5, "anisotropy": 1}, "the air's anisotropy must lie between -0.99 and 0.99"),
        ({"visibility_m": 5, "margin_m": -1}, "the air's margin must lie between 0 and 1e12 m"),
    ]:
        with pytest.raises(rc.InputError, match=message):
            room.with_air(**arguments)  # type: ignore[arg-type]


@pytest.mark.picture_files
@pytest.mark.parametrize(("file", "albedo"), [("quad.obj", 1), ("shot.toml", 0.5)])
def test_the_command_takes_a_visibility_and_reports_the_air(tmp_path: Path, file: str, albedo: float) -> None:
    shot = 'format = 1\nscene = "quad.obj"\n[air]\nextinction_per_m = 3\nalbedo = 0.5\n'
    (tmp_path / "shot.toml").write_text(shot)
    (tmp_path / "quad.obj").write_text("v -1 -1 -5\nv 1 -1 -5\nv 1 1 -5\nv -1 1 -5\nf 1 2 3 4\n")
    words = [
        "render",
        file,
        "-o",
        "a.png",
        "--visibility",
        "39.12",
        "--resolution",
        "12x8",
        "--spp",
        "1",
        "--json",
    ]
    done = subprocess.run(
        [*programs.PYTHON, *words, "--device", "cpu"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    air = json.loads(done.stdout)["air"]
    assert air["extinction_per_m"] == pytest.approx([0.1] * 3)
    assert air["albedo"] == [albedo] * 3


@pytest.mark.slow
def test_the_light_is_that_of_mitsuba() -> None:
    """benchmarks/fog_against_mitsuba.py: each part of the picture within 1%, and the noise of the difference."""
    pytest.importorskip("mitsuba", reason="Mitsuba is not installed: pip install 'realcam[mitsuba]'")
    program = Path(__file__).resolve().parents[3] / "benchmarks" / "fog_against_mitsuba.py"
    done = subprocess.run([sys.executable, program, "--spp", "4096"], capture_output=True, text=True, check=True)
    figures = json.loads(done.stdout)
    for part in ("whole", "parts"):
        noise = np.array(figures[f"noise_of_{part}"])
        # Eight pictures of each program give the noise itself to some 25%.
        assert (np.abs(figures[part]) < 0.01 + 4 * noise).all()
