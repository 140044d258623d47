"""Glass whose interior scatters light: pictures on each device, its properties, files, and what is said of it."""

from __future__ import annotations

import base64
import json
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..scenes import pinhole, quad, radiance, scene_of, sphere

Colour = tuple[float, float, float]


def milk(
    scattering: Colour = (3, 4, 5), absorption: Colour = (0, 0, 0), *, g: float = 0.5, ior: float = 1.4
) -> rc.Scene:
    """A ball of 0.5 m around the origin."""
    inside = {"absorption": absorption, "scattering": scattering, "scattering_anisotropy": g}
    return sphere(0.5, 16, rc.Material(diffuse=(0, 0, 0), transmission=1, ior=ior, **inside), inward=False)


CAMERA = pinhole(position=(0, 0, 2.5), look_at=(0, 0, 0))


@pytest.mark.parametrize("ior", [1.0, 1.4])
def test_glass_that_only_scatters_is_invisible_in_uniform_light(ior: float, device: str) -> None:
    """Each pixel is known to the noise of the paths that Russian roulette keeps; the mean of the 384 pixels, with 256
    samples each, to about 0.1%."""
    picture = radiance(milk(ior=ior).with_environment(1.0), CAMERA, spp=256, max_bounces=64, device=device)
    np.testing.assert_allclose(picture.mean(axis=(0, 1)), 1, atol=5e-3)
    np.testing.assert_allclose(picture[7:9, 11:13].mean(axis=(0, 1)), 1, atol=0.05)


def test_the_interior_attenuates_by_absorption_and_scattering(device: str) -> None:
    """Beer-Lambert through a ball without refraction: with one bounce, at its front, only the sky behind the ball is
    visible through it. The chords of the 2 x 2 pixels of the middle are 0.99 to 1 m long, and flat triangles shorten
    them by up to 1%."""
    absorption, scattering = (0.1, 0.3, 0.5), (0.4, 0.1, 1.0)
    picture = radiance(
        milk(scattering, absorption, ior=1).with_environment(1.0), CAMERA, spp=64, max_bounces=1, device=device
    )
    expected = np.exp(-0.985 * (np.array(absorption) + scattering))
    np.testing.assert_allclose(picture[7:9, 11:13].mean(axis=(0, 1)), expected, rtol=0.02)


def test_a_lamp_in_milky_glass_makes_all_of_it_glow(device: str) -> None:
    """Energy balance in each channel: a ball of albedo 1 without refraction radiates the power of the lamp in its
    centre. By symmetry, the light of the ball's image equals that of the lamp alone, up to the light that returns to
    the black lamp, which has 1/400 of the ball's cross-section, and the ball's size: its front is nearer, and (0.5 /
    2.5)^2 is 4%."""
    lamp = sphere(0.025, 8, rc.Material(diffuse=(0, 0, 0), emission=(1e4, 1e4, 1e4)), inward=False)
    film = rc.Film(36, 24, (48, 32))
    camera = pinhole(film, position=(0, 0, 2.5), look_at=(0, 0, 0))
    settings = {"effects": (), "max_bounces": 48, "device": device}
    glow = rc.render(milk((1, 2, 3), ior=1).with_instance(lamp), camera, spp=512, **settings).pixels.sum(axis=(0, 1))
    alone = rc.render(lamp, camera, spp=512, **settings).pixels.sum(axis=(0, 1))
    np.testing.assert_allclose(glow / alone, 1, atol=0.06)


def test_properties_of_the_interior() -> None:
    material = rc.Material(transmission=1, absorption=(1, 2, 3), scattering=(4, 5, 6), scattering_anisotropy=0.25)
    assert material.scattering == (4, 5, 6)
    assert material.scattering_anisotropy == 0.25
    assert pickle.loads(pickle.dumps(material)) == material
    assert material != rc.Material(transmission=1, absorption=(1, 2, 3), scattering=(4, 5, 6))
    assert rc.Material.metallic_roughness(scattering=(4, 5, 6)).scattering == (4, 5, 6)
    triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    for arguments, message in [
        ({"scattering": (-1, 0, 0)}, "absorption, scattering and their sum must be finite and not negative"),
        ({"scattering": (3e38, 0, 0), "absorption": (3e38, 0, 0)}, "their sum must be finite"),
        ({"scattering_anisotropy": 1}, "the anisotropy of scattering must lie between -0.99 and 0.99"),
    ]:
        with pytest.raises(rc.InputError, match=message):
            rc.Scene.from_arrays(*triangle, materials=[rc.Material(transmission=1, **arguments)])  # type: ignore[arg-type]


def test_thin_and_opaque_surfaces_have_no_interior() -> None:
    """Bit by bit, as without the property."""
    floor = quad((0, 0, 0), 0.6, diffuse=0.5)
    for common in ({"thin": True, "transmission": 0.5}, {"transmission": 0}):
        pictures = [
            rc.render(
                scene_of((floor[0], rc.Material(diffuse=(0.5,) * 3, **common, **more))).with_environment(1.0),
                CAMERA,
                spp=4,
                device="cpu",
                effects=(),
            ).pixels
            for more in ({}, {"scattering": (5, 6, 7)})
        ]
        assert np.array_equal(*pictures)


def test_a_shot_file_has_scattering_glass(tmp_path: Path) -> None:
    (tmp_path / "a.mtl").write_text("newmtl a\nKd 1 1 1\n")
    (tmp_path / "quad.obj").write_text(
        "mtllib a.mtl\nv -1 -1 -5\nv 1 -1 -5\nv 1 1 -5\nv -1 1 -5\nusemtl a\nf 1 2 3 4\n"
    )
    start = 'format = 1\nscene = "quad.obj"\nposition_m = [0, 0, 0]\n[material.a]\ntransmission = 1\n'
    shot = tmp_path / "shot.toml"
    shot.write_text(start + "scattering = [1, 2, 3]\nscattering_anisotropy = -0.5\n")
    material = next(iter(rc.Shot.load(shot).scene.materials.values()))
    assert (material.scattering, material.scattering_anisotropy) == ((1, 2, 3), -0.5)
    shot.write_text(start + "scattering = 2\n")
    assert next(iter(rc.Shot.load(shot).scene.materials.values())).scattering == (2, 2, 2)
    shot.write_text(start + "scattering_anisotropy = 2\n")
    with pytest.raises(rc.InputError, match="the anisotropy of scattering must lie between"):
        rc.Shot.load(shot)


def gltf_material(folder: Path, scatter: dict[str, object], thickness: float = 1) -> rc.Material:
    """The material of a file of one triangle; its volume has an extinction of ln 2, 2 ln 2 and 3 ln 2 per metre."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    volume = {"thicknessFactor": thickness, "attenuationDistance": 1, "attenuationColor": [0.5, 0.25, 0.125]}
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": volume,
        "KHR_materials_volume_scatter": scatter,
    }
    uri = "data:application/octet-stream;base64," + base64.b64encode(points.tobytes()).decode()
    path = folder / "m.gltf"
    path.write_text(
        json.dumps(
            {
                "asset": {"version": "2.0"},
                "extensionsUsed": list(extensions),
                "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
                "materials": [{"extensions": extensions}],
                "buffers": [{"uri": uri, "byteLength": 36}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
            }
        )
    )
    scene = rc.Scene.load(path)
    assert not scene.warnings
    return next(iter(scene.materials.values()))


def spherical_albedo(albedo: float) -> float:
    """Reflected fraction of uniform light on a semi-infinite medium that scatters isotropically: 1 - 2 sqrt(1 - albedo)
    times the first moment of Chandrasekhar's H function (Radiative Transfer, 1960)."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    mu, weights = 0.5 * (nodes + 1), 0.5 * weights
    h = np.ones_like(mu)
    for _ in range(500):
        h = 1 / (np.sqrt(1 - albedo) + 0.5 * albedo * (weights * mu * h / (mu + mu[:, None])).sum(axis=1))
    return float(1 - 2 * np.sqrt(1 - albedo) * (weights * mu * h).sum())


def test_gltf_files_have_scattering_volumes(tmp_path: Path) -> None:
    """KHR_materials_volume_scatter: the colour is the albedo of multiple scattering of a deep medium. Kulla and Conty's
    fit is compared with the albedo that it stands for, which it meets within 0.03."""
    colour = (0.2, 0.5, 0.9)
    material = gltf_material(tmp_path, {"multiscatterColorFactor": colour})
    extinction = np.add(material.absorption, material.scattering)
    np.testing.assert_allclose(extinction, np.log(2) * np.arange(1, 4), rtol=1e-6)
    albedo = np.array(material.scattering) / extinction
    np.testing.assert_allclose([spherical_albedo(a) for a in albedo], colour, atol=0.03)
    # The similarity relation (van de Hulst 1980): the same albedo of multiple scattering for equal (1 - albedo) / (1 -
    # g albedo).
    forward = gltf_material(tmp_path, {"multiscatterColorFactor": colour, "scatterAnisotropy": 0.6})
    assert forward.scattering_anisotropy == pytest.approx(0.6)
    other = np.array(forward.scattering) / extinction
    np.testing.assert_allclose((1 - other) / (1 - 0.6 * other), 1 - albedo, rtol=1e-4)
    for factor in (0, 1):
        ends = gltf_material(tmp_path, {"multiscatterColorFactor": [factor] * 3})
        np.testing.assert_allclose(ends.scattering, factor * extinction, rtol=1e-6)
    assert gltf_material(tmp_path, {"scatterAnisotropy": 1}).scattering_anisotropy == pytest.approx(0.99)
    assert gltf_material(tmp_path, {"multiscatterColorFactor": colour}, thickness=0).scattering == (0, 0, 0)


def test_the_planner_says_what_scattering_glass_adds(device: str) -> None:
    scene = milk().with_environment(1.0).with_point_light((3, 3, 3), (50, 50, 50))
    lamp = quad((0, 2, 0), 0.5, right=(-1, 0, 0), up=(0, 0, -1), emission=30.0)
    plan = rc.plan(scene.with_instance(scene_of(lamp)), CAMERA, effects=(), device=device)
    row = next(d for d in plan.decisions if d.effect == "scattering_glass")
    assert row.is_kept and row.unit == "codes" and row.size > 1
    assert plan.max_bounces >= 4
    clear = milk((0, 0, 0)).with_environment(1.0)
    assert "scattering_glass" not in [d.effect for d in rc.plan(clear, CAMERA, effects=(), device=device).decisions]


@pytest.mark.slow
def test_the_light_is_that_of_mitsuba() -> None:
    """benchmarks/fog_against_mitsuba.py: the light of the whole picture within 1%, and that of its parts within 1% and
    the noise of the difference."""
    pytest.importorskip("mitsuba", reason="Mitsuba is not installed: pip install 'realcam[mitsuba]'")
    program = Path(__file__).resolve().parents[3] / "benchmarks" / "fog_against_mitsuba.py"
    done = subprocess.run(
        [sys.executable, program, "--scene", "glass", "--spp", "4096"], capture_output=True, text=True, check=True
    )
    figures = json.loads(done.stdout)
    for part in ("whole", "parts"):
        noise = np.array(figures[f"noise_of_{part}"])
        assert (np.abs(figures[part]) < 0.01 + 4 * noise).all()
