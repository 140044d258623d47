"""Lights of UsdLux on a white matte floor, compared with closed forms. A known illuminance is the measure."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

pytest.importorskip("pxr")

# Circles are polygons of 64 segments, whose area is 0.04% smaller; the rest of the tolerance covers noise.
TOLERANCE = 1e-3

FLOOR = """def Mesh "Floor" {
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(-90, 0, 90), (90, 0, 90), (90, 0, -90), (-90, 0, -90)]
    uniform token subdivisionScheme = "none"
    color3f[] primvars:displayColor = [(1, 1, 1)]
}
"""
DOWN = "float xformOp:rotateX = -90"  # takes -z, along which lights shine, to -y


def illuminance(folder: Path, light: str, height: float, turn: str = DOWN, metres: float = 1.0) -> float:
    """Returns the illuminance in lux on the floor below a light at this height, in units of the stage."""
    path = folder / "stage.usda"
    place = f"double3 xformOp:translate = (0, {height}, 0); {turn};"
    order = 'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateX"]'
    head, body = light.split("{", 1)
    path.write_text(
        f"#usda 1.0\n(metersPerUnit = {metres})\n{FLOOR}def {head} {{ {place} {order}; {body.rstrip().rstrip('}')} }}\n"
    )
    # A narrow view of the point below the light, past the light.
    film = rc.Film(0.1, 0.1, (4, 4))
    camera = scenes.pinhole(film, position=(60 * metres, 30 * metres, 0), look_at=(0, 0, 0))
    scene = rc.Scene.load(path)
    floor = folder / "floor.usda"
    floor.write_text(f"#usda 1.0\n(metersPerUnit = {metres})\n{FLOOR}")
    lit = rc.Scene.load(floor).with_sun((0, -1, 0), (1, 1, 1))
    options = {"effects": (), "max_bounces": 0}
    known = rc.render(lit, camera, spp=64, **options).pixels.astype(np.float64).mean()
    return float(rc.render(scene, camera, spp=8192, **options).pixels.astype(np.float64).mean() / known)


def rectangle_above(width: float, depth: float, height: float) -> float:
    """Illuminance per radiance below the middle of a parallel rectangle (Howell, factor B-3, four times)."""
    a, b = width / 2 / height, depth / 2 / height
    factor = (
        a / math.sqrt(1 + a * a) * math.atan(b / math.sqrt(1 + a * a))
        + b / math.sqrt(1 + b * b) * math.atan(a / math.sqrt(1 + b * b))
    ) / (2 * math.pi)
    return 4 * math.pi * factor


def cylinder_above(radius: float, length: float, height: float) -> float:
    """Illuminance per radiance below the middle of a horizontal cylinder, by quadrature over its side."""
    phi = (np.arange(2000) + 0.5) / 2000 * 2 * np.pi
    x = ((np.arange(1000) + 0.5) / 1000 - 0.5) * length
    normal = np.stack([np.zeros_like(phi), np.sin(phi), np.cos(phi)], axis=-1)
    points = np.concatenate([np.stack([np.full_like(phi, v), *(radius * normal[:, 1:].T)], axis=-1) for v in x])
    normals = np.tile(normal, (len(x), 1))
    towards = -(points + np.array([0, height, 0]))
    distance = np.linalg.norm(towards, axis=-1)
    emitted = np.einsum("ij,ij->i", normals, towards) / distance
    received = -towards[:, 1] / distance
    area = 2 * np.pi * radius * length / len(points)
    return float((np.maximum(emitted, 0) * received / distance**2).sum() * area)


@pytest.mark.parametrize(
    ("light", "height", "expected"),
    [
        ('SphereLight "L" { float inputs:radius = 1; float inputs:intensity = 100; }', 5, 100 * math.pi / 25),
        ('SphereLight "L" { float inputs:radius = 1; float inputs:intensity = 100; bool inputs:normalize = 1; }', 5, 1),
        (
            'DiskLight "L" { float inputs:radius = 2; float inputs:intensity = 10; float inputs:exposure = 3; }',
            4,
            80 * math.pi * 4 / 20,
        ),
        (
            'RectLight "L" { float inputs:width = 4; float inputs:height = 2; float inputs:intensity = 10; }',
            3,
            10 * rectangle_above(4, 2, 3),
        ),
        (
            'CylinderLight "L" { float inputs:radius = 0.5; float inputs:length = 4; float inputs:intensity = 10; }',
            3,
            10 * cylinder_above(0.5, 4, 3),
        ),
        (
            'SphereLight "L" { bool treatAsPoint = 1; float inputs:radius = 0.5; float inputs:intensity = 100; }',
            5,
            100 * math.pi * 0.25 / 25,
        ),
        ('DistantLight "L" { float inputs:intensity = 7; float inputs:angle = 0; }', 5, 7),
        ('DistantLight "L" { float inputs:intensity = 7; bool inputs:normalize = 1; }', 5, 7),
        (
            'DistantLight "L" { float inputs:intensity = 50000; float inputs:angle = 0.53; }',
            5,
            50000 * math.pi * math.sin(math.radians(0.265)) ** 2,
        ),
        ('DomeLight "L" { float inputs:intensity = 3; }', 5, 3 * math.pi),
    ],
)
def test_illuminance(tmp_path: Path, light: str, height: float, expected: float) -> None:
    assert illuminance(tmp_path, light, height) == pytest.approx(expected, rel=TOLERANCE)


def test_illuminance_does_not_depend_on_the_unit(tmp_path: Path) -> None:
    """A radiance is the same in any unit; a normalised light has its power per area of the stage's unit."""
    light = 'DiskLight "L" { float inputs:radius = 2; float inputs:intensity = 10; }'
    assert illuminance(tmp_path, light, 4, metres=0.01) == pytest.approx(10 * math.pi * 4 / 20, rel=TOLERANCE)


def test_spot_of_a_shaping_cone(tmp_path: Path) -> None:
    light = (
        'SphereLight "L" (prepend apiSchemas = ["ShapingAPI"]) { float inputs:radius = 0.1; '
        "float inputs:intensity = 100; float inputs:shaping:cone:angle = 20; }"
    )
    assert illuminance(tmp_path, light, 5) == pytest.approx(100 * math.pi * 0.01 / 25, rel=TOLERANCE)
    assert illuminance(tmp_path, light, 5, "float xformOp:rotateX = -60") == 0


def test_colour_temperature(tmp_path: Path) -> None:
    from pxr import UsdLux
    from realcam.usd.lights import radiance_of
    from realcam.usd.stage import open_stage

    path = tmp_path / "stage.usda"
    path.write_text(
        '#usda 1.0\ndef SphereLight "L" { color3f inputs:color = (1, 0.5, 1); float inputs:intensity = 2; '
        "bool inputs:enableColorTemperature = 1; float inputs:colorTemperature = 3200; }\n"
    )
    opened = open_stage(str(path))
    found = radiance_of(opened, opened.stage.GetPrimAtPath("/L"))
    expected = 2 * np.array([1, 0.5, 1]) * np.array(UsdLux.BlackbodyTemperatureAsRgb(3200))
    assert np.allclose(found, expected, rtol=1e-6)


def test_dome_picture_is_turned_as_usd_turns_it(tmp_path: Path) -> None:
    """The centre of a dome's picture lies at +z, and its right half at -x (OpenEXR's convention)."""
    import OpenImageIO as oiio

    pixels = np.zeros((64, 128, 3), np.float32)
    pixels[28:36, 92:100] = 1  # at three quarters of the width: -x
    output = oiio.ImageOutput.create(str(tmp_path / "sky.exr"))
    output.open(str(tmp_path / "sky.exr"), oiio.ImageSpec(128, 64, 3, "float"))
    output.write_image(pixels)
    output.close()
    for kind, expected in (("DomeLight", (-1, 0, 0)), ("tilted", (0, -1, 0))):
        order = 'uniform token[] xformOpOrder = ["xformOp:rotateZ"];'
        turn = f"float xformOp:rotateZ = 90; {order}" if kind == "tilted" else ""
        path = tmp_path / f"{kind}.usda"
        path.write_text(
            f'#usda 1.0\n(metersPerUnit = 1)\ndef Cube "Far" {{ double3 xformOp:translate = (0, 0, 900); '
            f'uniform token[] xformOpOrder = ["xformOp:translate"]; }}\ndef DomeLight "D" {{ {turn} '
            "asset inputs:texture:file = @sky.exr@; }\n"
        )
        up = (0, 0, 1) if expected[1] else (0, 1, 0)
        camera = scenes.pinhole(rc.Film(1, 1, (4, 4)), position=(0, 0, 0), look_at=expected, up=up)
        seen = scenes.radiance(rc.Scene.load(path), camera, spp=4)
        assert np.allclose(seen, 1, atol=1e-5)
