"""Environments from Radiance and OpenEXR files. The truth is what these formats say of their numbers."""

from __future__ import annotations

import itertools
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes
from ..sky_files import rgbe, write_exr, write_exr_parts, write_radiance

# Powers of two, which mantissas of 8 bits hold exactly; each row and column differs.
SKY = (2.0 ** np.random.default_rng(7).integers(-3, 4, (8, 16, 1))) * np.array([1.0, 0.5, 0.25])
SKY[0, :12] = SKY[0, 0]

# Linear Rec. 709 from XYZ under D65 (IEC 61966-2-1), and Bradford's matrix (Lam 1985).
REC709_FROM_XYZ = np.array(
    [[3.2404542, -1.5371385, -0.4985314], [-0.969266, 1.8760108, 0.041556], [0.0556434, -0.2040259, 1.0572252]]
)
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
ACES_AP0 = (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767)
ACES_AP1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)


def read(path: Path) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return rc.read_environment(path)


def xyz_of(x: float, y: float) -> np.ndarray:
    return np.array([x / y, 1, (1 - x - y) / y])


def xyz_from(chromaticities: tuple[float, ...]) -> np.ndarray:
    """Columns: XYZ of the primaries, scaled so that their sum is the white of Y = 1 (SMPTE RP 177)."""
    pairs = np.reshape(chromaticities, (4, 2))
    primaries = np.column_stack([(x, y, 1 - x - y) for x, y in pairs[:3]])
    return primaries * np.linalg.solve(primaries, xyz_of(*pairs[3]))


def adapted(chromaticities: tuple[float, ...]) -> np.ndarray:
    """Matrix to Rec. 709 from colours of these primaries, with chromatic adaptation of the white (Bradford)."""
    from_xyz = xyz_from(chromaticities)
    cones = BRADFORD @ xyz_of(0.3127, 0.3290) / (BRADFORD @ from_xyz.sum(axis=1))
    return REC709_FROM_XYZ @ np.linalg.inv(BRADFORD) @ np.diag(cones) @ BRADFORD @ from_xyz


# Lines of fewer than eight pixels are never packed by channels.
@pytest.mark.parametrize(
    ("packed", "width"), [("flat", 5), ("pixels", 5), *itertools.product(("flat", "channels", "pixels"), (16, 700))]
)
def test_radiance_pixels_flat_and_in_both_kinds_of_runs(tmp_path: Path, packed: str, width: int) -> None:
    sky = np.repeat(SKY, 50, axis=1)[:, :width]
    sky[2] = sky[2, 0]  # a run of a whole line
    write_radiance(tmp_path / "sky.hdr", sky, packed=packed)
    np.testing.assert_array_equal(read(tmp_path / "sky.hdr"), sky)


def test_exposure_and_colour_correction_are_divided_out(tmp_path: Path) -> None:
    lines = ["EXPOSURE=2.0", "SOFTWARE=x", "COLORCORR= 1 2 4", "\tEXPOSURE=100", "EXPOSURE=  0.25 ", "COLORCORR=2 2 1"]
    write_radiance(tmp_path / "sky.hdr", SKY, lines=lines)
    np.testing.assert_allclose(read(tmp_path / "sky.hdr"), SKY / (0.5 * np.array([2, 4, 4])), rtol=1e-6)
    for wrong in ("EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=nan", "EXPOSURE=x", "EXPOSURE=1e300", "COLORCORR=1 1"):
        write_radiance(tmp_path / "wrong.hdr", SKY, lines=[wrong])
        with pytest.raises(rc.ImageFileError, match=wrong.split("=")[0]) as error:
            rc.read_environment(tmp_path / "wrong.hdr")
        assert "\n" not in str(error.value)


@pytest.mark.parametrize(("x", "y", "by_columns"), list(itertools.product("+-", "+-", (False, True))))
def test_radiance_pictures_from_every_corner(tmp_path: Path, x: str, y: str, by_columns: bool) -> None:
    """-Y +X is the usual one: the first line on top, its first pixel left."""
    stored = SKY[:: -1 if y == "+" else 1, :: 1 if x == "+" else -1]
    resolution = f"{x}X 16 {y}Y 8" if by_columns else f"{y}Y 8 {x}X 16"
    lines = stored.swapaxes(0, 1) if by_columns else stored
    write_radiance(tmp_path / "sky.hdr", lines, resolution=resolution, packed="channels")
    np.testing.assert_array_equal(read(tmp_path / "sky.hdr"), SKY)


def test_radiance_colours_in_xyz_and_of_other_primaries(tmp_path: Path) -> None:
    xyz = SKY @ np.linalg.inv(REC709_FROM_XYZ).T
    write_radiance(tmp_path / "sky.hdr", xyz, kind="xyze", packed="channels")
    # A mantissa of 8 bits is off by 1/128 of the largest of three at most.
    np.testing.assert_allclose(read(tmp_path / "sky.hdr"), SKY, atol=0.03 * SKY.max(), rtol=0.05)
    write_radiance(tmp_path / "aces.hdr", SKY, lines=["PRIMARIES=" + " ".join(map(str, ACES_AP1))])
    np.testing.assert_allclose(read(tmp_path / "aces.hdr"), SKY @ adapted(ACES_AP1).T, rtol=1e-3)


def test_what_is_no_radiance_picture(tmp_path: Path) -> None:
    write_radiance(tmp_path / "good.hdr", SKY, packed="channels")
    good = (tmp_path / "good.hdr").read_bytes()
    for wrong, why in {
        good[:-3]: "ends early",
        good[:30]: "header has no end",
        good.replace(b"-Y 8", b"-Y x"): "size",
        good.replace(b"+X 16", b"+Y 16"): "one axis twice",
        good.replace(b"-Y 8", b"-Y 99999999"): "size",
        good.replace(b"rle_rgbe", b"rle_cmyk"): "expected 32-bit_rle_rgbe or 32-bit_rle_xyze",
        good.replace(b"+X 16", b"+X 17"): "another length",
    }.items():
        (tmp_path / "wrong.hdr").write_bytes(wrong)
        with pytest.raises(rc.ImageFileError, match=why) as error:
            rc.read_environment(tmp_path / "wrong.hdr")
        assert "\n" not in str(error.value)
    pixels = rgbe(SKY[:1]).tobytes()
    (tmp_path / "run.hdr").write_bytes(b"#?RGBE\n\n-Y 1 +X 16\n" + b"\1\1\1\5" + pixels)
    with pytest.raises(rc.ImageFileError, match="a run is longer"):
        rc.read_environment(tmp_path / "run.hdr")
    (tmp_path / "bare.hdr").write_bytes(b"#?RGBE\n\n-Y 1 +X 16\n" + pixels)
    np.testing.assert_array_equal(read(tmp_path / "bare.hdr"), SKY[:1])


@pytest.mark.parametrize("chromaticities", [ACES_AP0, ACES_AP1, (0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290)])
def test_openexr_colours_of_other_primaries(tmp_path: Path, chromaticities: tuple[float, ...]) -> None:
    write_exr(tmp_path / "sky.exr", SKY + 1, chromaticities=chromaticities)
    measured = read(tmp_path / "sky.exr")
    np.testing.assert_allclose(measured, (SKY + 1) @ adapted(chromaticities).T, rtol=1e-3)
    # Grey stays grey, whatever its white was.
    write_exr(tmp_path / "grey.exr", np.full((1, 2, 3), 7.0), chromaticities=chromaticities)
    np.testing.assert_allclose(read(tmp_path / "grey.exr"), 7, rtol=2e-3)


def test_openexr_colours_in_xyz_and_in_rec_709(tmp_path: Path) -> None:
    for white in ((1 / 3, 1 / 3), (0, 0), (0.3127, 0.329)):
        # Whatever they name for white, X, Y and Z are what they are.
        xyz = SKY @ np.linalg.inv(REC709_FROM_XYZ).T
        write_exr(tmp_path / "sky.exr", xyz, chromaticities=(1, 0, 0, 1, 0, 0, *white))
        np.testing.assert_allclose(read(tmp_path / "sky.exr"), SKY, rtol=2e-3)
    write_exr(tmp_path / "sky.exr", SKY, chromaticities=(0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329))
    np.testing.assert_array_equal(read(tmp_path / "sky.exr"), SKY)
    for wrong in ((0.3,) * 8, (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0), (float("nan"),) * 8):
        write_exr(tmp_path / "wrong.exr", SKY, chromaticities=wrong)
        with pytest.raises(rc.ImageFileError, match="chromaticities"):
            rc.read_environment(tmp_path / "wrong.exr")


def test_the_display_window_is_the_picture(tmp_path: Path) -> None:
    """Pixels outside of the data window are black, and data beyond the display window is cropped, wherever they lie."""
    for data, display in (
        ((0, 0), (0, 0, 15, 15)),
        ((0, 0), (0, -8, 15, 7)),
        ((-3, 5), (-5, 2, 20, 16)),
        ((100, 50), (102, 53, 109, 55)),
        ((0, 0), (-4, 3, 9, 30)),
    ):
        write_exr(tmp_path / "sky.exr", SKY, data=data, display=display)
        expected = np.zeros((display[3] - display[1] + 1, display[2] - display[0] + 1, 3))
        for row, column in np.ndindex(expected.shape[:2]):
            y, x = display[1] + row - data[1], display[0] + column - data[0]
            if 0 <= y < 8 and 0 <= x < 16:
                expected[row, column] = SKY[y, x]
        np.testing.assert_array_equal(read(tmp_path / "sky.exr"), expected)
    write_exr(tmp_path / "sky.exr", SKY, data=(0, 0), display=(50, 50, 60, 60))
    with pytest.raises(rc.ImageFileError, match="outside of its display window"):
        rc.read_environment(tmp_path / "sky.exr")


def test_small_negative_numbers_count_as_0_with_a_warning(tmp_path: Path) -> None:
    sky = SKY.copy()
    sky[3, 2] = (-0.0001, 0.5, 1)
    sky[5, 1] = (-0.25, 0.5, 4)
    write_exr(tmp_path / "sky.exr", sky)
    with pytest.warns(UserWarning, match=r"2 pixels are negative, the first in row 3, column 2: \(-0.0001, 0.5, 1\)"):
        measured = rc.read_environment(tmp_path / "sky.exr")
    np.testing.assert_array_equal(measured, np.maximum(sky, 0).astype(np.float32))
    scene = rc.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).with_environment(tmp_path / "sky.exr")
    assert any("2 pixels are negative" in warning for warning in scene.warnings)
    for wrong, why in ((-1000.0, "negative"), (np.nan, "invalid"), (np.inf, "invalid"), (-np.inf, "invalid")):
        sky[0, 0] = wrong
        write_exr(tmp_path / "wrong.exr", sky)
        with pytest.raises(rc.ImageFileError, match=why):
            rc.read_environment(tmp_path / "wrong.exr")


# OpenEXR's cube map: direction of each of the six faces, then its right and up directions as seen from inside.
FACES = [
    ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
    ((-1, 0, 0), (0, 0, -1), (0, 1, 0)),
    ((0, 1, 0), (1, 0, 0), (0, 0, 1)),
    ((0, -1, 0), (1, 0, 0), (0, 0, -1)),
    ((0, 0, 1), (-1, 0, 0), (0, 1, 0)),
    ((0, 0, -1), (1, 0, 0), (0, 1, 0)),
]


def light_in(direction: np.ndarray) -> np.ndarray:
    """Smooth, and different along all axes."""
    return 2 + direction @ np.array([[1, 0.2, 0], [0, 1, 0.3], [0.5, 0, 1]])


def directions_of(height: int, width: int) -> np.ndarray:
    """Pixel directions of realcam's environment maps: row 0 up, the middle column towards -z, +x to its right."""
    polar = np.pi * (np.arange(height) + 0.5)[:, None] / height
    azimuth = 2 * np.pi * ((np.arange(width) + 0.5) / width - 0.5)
    up = np.broadcast_to(np.cos(polar), (height, width))
    return np.stack([np.sin(polar) * np.sin(azimuth), up, -np.sin(polar) * np.cos(azimuth)], axis=-1)


def test_openexr_cube_maps(tmp_path: Path) -> None:
    size = 33
    steps = np.linspace(-1, 1, size)  # the middles of the outer pixels lie on the edges
    right, up = np.meshgrid(steps, -steps)
    squares = []
    for axes in FACES:
        forward, to_right, upwards = (np.array(axis) for axis in axes)
        ray_direction = forward + right[..., None] * to_right + up[..., None] * upwards
        squares.append(light_in(ray_direction / np.linalg.norm(ray_direction, axis=-1, keepdims=True)))
    write_exr(tmp_path / "cube.exr", np.concatenate(squares), envmap=1)
    measured = read(tmp_path / "cube.exr")
    assert measured.shape == (66, 132, 3)
    # Bilinear between samples of a smooth function, 1/16 apart on a cube: an eighth of the second difference.
    np.testing.assert_allclose(measured, light_in(directions_of(66, 132)), atol=2e-3)
    write_exr(tmp_path / "cube.exr", np.concatenate(squares[:5]), envmap=1)
    with pytest.raises(rc.ImageFileError, match="six squares"):
        rc.read_environment(tmp_path / "cube.exr")


def test_openexr_latitude_longitude_maps_have_plus_z_in_the_middle(tmp_path: Path) -> None:
    """OpenEXR: longitude 0 is +z, and 90 degrees, a quarter to the left of the middle, +x."""
    own = light_in(directions_of(8, 16))
    turned = light_in(directions_of(8, 16) * (-1, 1, -1))
    write_exr(tmp_path / "sky.exr", turned, envmap=0)
    np.testing.assert_allclose(read(tmp_path / "sky.exr"), own, rtol=1e-6)


def test_rotation_and_scale_of_an_environment(tmp_path: Path) -> None:
    write_exr(tmp_path / "sky.exr", SKY)
    triangle = rc.Scene.from_arrays([[0, 0, 1e5], [1, 0, 1e5], [0, 1, 1e5]], [[0, 1, 2]])
    # A camera that looks along -x sees what lay towards -z, turned by 90 degrees.
    camera, aside = scenes.pinhole(), scenes.pinhole(look_at=(-1, 0, 0))
    ahead = rc.render(triangle.with_environment(tmp_path / "sky.exr"), camera, effects=(), spp=4, max_bounces=0)
    turned = triangle.with_environment(tmp_path / "sky.exr", scale=3, rotation_deg=90)
    seen = rc.render(turned, aside, effects=(), spp=4, max_bounces=0)
    np.testing.assert_allclose(seen.pixels, 3 * ahead.pixels, rtol=1e-5)
    # A rotation by half a column averages adjacent columns, and keeps the total light.
    half = triangle.with_environment(SKY, rotation_deg=360 / 32)
    assert half == triangle.with_environment((SKY + np.roll(SKY, -1, axis=1)) / 2)
    assert triangle.with_environment(5, scale=2, rotation_deg=33) == triangle.with_environment(10)
    for wrong in ({"scale": 0}, {"scale": float("nan")}, {"rotation_deg": float("inf")}):
        with pytest.raises(rc.InputError, match="environment's"):
            triangle.with_environment(5, **wrong)


def test_shot_files_turn_and_brighten_an_environment(tmp_path: Path) -> None:
    write_exr(tmp_path / "sky.exr", SKY)
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    text = 'format = 1\nscene = "a.obj"\nexposure_time_s = 1\n'
    (tmp_path / "shot.toml").write_text(
        f'{text}environment = "sky.exr"\nenvironment_scale = 2\nenvironment_rotation_deg = -90\n'
    )
    expected = rc.Scene.load(tmp_path / "a.obj").with_environment(np.roll(2 * SKY, 4, axis=1))
    assert rc.Shot.load(tmp_path / "shot.toml").scene == expected
    for line, why in {
        "environment_scale = 2": ':4: "environment_scale" changes an environment',
        "environment_rotation_deg = 2": ':4: "environment_rotation_deg" changes an environment',
        "environment_cd_m2 = 1\nenvironment_scale = -2": ":5: the environment's scale",
    }.items():
        (tmp_path / "shot.toml").write_text(text + line)
        with pytest.raises(rc.InputError, match=why):
            rc.Shot.load(tmp_path / "shot.toml")


def test_textures_of_other_primaries(tmp_path: Path) -> None:
    """An OBJ's texture in ACES's colours, under an even sky."""
    colour = np.array([0.5, 0.25, 0.125])
    write_exr(tmp_path / "a.exr", np.broadcast_to(colour, (2, 2, 3)), chromaticities=ACES_AP1)
    (tmp_path / "a.mtl").write_text("newmtl a\nKd 1 1 1\nmap_Kd a.exr\n")
    (tmp_path / "a.obj").write_text(
        "mtllib a.mtl\nusemtl a\nv -9 -9 -2\nv 9 -9 -2\nv 0 9 -2\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    )
    scene = rc.Scene.load(tmp_path / "a.obj")
    np.testing.assert_allclose(
        next(iter(scene.materials.values())).texture[0, 0, :3], adapted(ACES_AP1) @ colour, rtol=1e-3
    )


def test_films_with_metadata_that_is_no_text(tmp_path: Path) -> None:
    texts = {"realcam:film_mm": b"36x24", "realcam:exposure_time_s": b"0.01", "realcam:iso": b"100"}
    write_exr(tmp_path / "film.exr", SKY, texts={**texts, "realcam:lens": b"\xff\xfe"})
    from realcam.image_file import read_film

    with pytest.raises(rc.ImageFileError, match=r'film.exr: its metadata "realcam:lens" is not valid UTF-8'):
        read_film(tmp_path / "film.exr")


def layer(prefix: str, light: np.ndarray) -> dict[str, np.ndarray]:
    return {prefix + name: np.float32(light[..., i]) for i, name in enumerate("RGB")}


OTHER = np.full(SKY.shape, 7.0)
GREY = {"Z": np.float32(OTHER[..., 0])}
CRYPTO = {f"crypto00.{name}": np.float32(OTHER[..., 0]) for name in "rgba"}


@pytest.mark.parametrize(
    "parts",
    [
        [("depth", GREY), ("beauty", layer("", SKY))],
        [("crypto", CRYPTO), ("light", layer("", SKY))],
        [("albedo", layer("", OTHER)), ("rgba", layer("", SKY))],
        [("", {**layer("albedo.", OTHER), **layer("beauty.", SKY)})],
        [("", {**layer("ViewLayer.AO.", OTHER), **layer("ViewLayer.Combined.", SKY)})],
        [("", {**layer("beauty.", OTHER), **layer("", SKY)})],
        [("", {"Id.R": np.uint32(OTHER[..., 0]), **GREY}), ("only", layer("only.", SKY))],
    ],
    ids=["depth", "crypto", "albedo part", "albedo layer", "blender", "root", "one"],
)
def test_the_light_of_several_parts_and_layers(tmp_path: Path, parts: list[tuple[str, dict[str, np.ndarray]]]) -> None:
    write_exr_parts(tmp_path / "sky.exr", parts)
    np.testing.assert_array_equal(read(tmp_path / "sky.exr"), SKY)


def test_a_layer_is_chosen_where_several_could_be_the_light(tmp_path: Path) -> None:
    path = tmp_path / "sky.exr"
    write_exr_parts(path, [("", {**layer("left.", OTHER), **layer("right.", SKY)})])
    with pytest.raises(rc.ImageFileError, match=r'several layers: "left", "right"; .*environment_layer'):
        rc.read_environment(path)
    np.testing.assert_array_equal(rc.read_environment(path, layer="RIGHT"), SKY)
    triangle = rc.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert triangle.with_environment(path, layer="right") == triangle.with_environment(SKY)
    with pytest.raises(rc.ImageFileError, match=r'no layer "up"; its layers are "left", "right"'):
        rc.read_environment(path, layer="up")
    with pytest.raises(rc.InputError, match="layer requires that the environment is an OpenEXR file"):
        triangle.with_environment(1, layer="right")
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    text = 'format = 1\nscene = "a.obj"\nexposure_time_s = 1\nenvironment_layer = "right"\n'
    (tmp_path / "shot.toml").write_text(text + 'environment = "sky.exr"\n')
    assert rc.Shot.load(tmp_path / "shot.toml").scene == rc.Scene.load(tmp_path / "a.obj").with_environment(SKY)
    (tmp_path / "shot.toml").write_text(text)
    with pytest.raises(rc.InputError, match=':4: "environment_layer" chooses'):
        rc.Shot.load(tmp_path / "shot.toml")


def test_whole_numbers_are_no_light(tmp_path: Path) -> None:
    write_exr_parts(tmp_path / "sky.exr", [("", {name: np.full((2, 4), 3, np.uint32) for name in "RGB"})])
    with pytest.raises(rc.ImageFileError, match="whole numbers"):
        rc.read_environment(tmp_path / "sky.exr")


def test_webp_textures_and_zeros_behind_a_glb_s_json(tmp_path: Path) -> None:
    """Green of 16 x 8 texels in lossless WebP, by EXT_texture_webp without a fallback, in a padded GLB."""
    import json

    import OpenImageIO as oiio

    spec = oiio.ImageSpec(16, 8, 3, "uint8")
    spec.attribute("compression", "lossless")
    output = oiio.ImageOutput.create("webp")
    assert output.open(str(tmp_path / "a.webp"), spec)
    assert output.write_image(np.full((8, 16, 3), (0, 255, 0), np.uint8))
    output.close()
    corners = (
        np.float32([[-1, -1, 0], [1, -1, 0], [1, 1, 0]]).tobytes() + np.float32([[0, 0], [1, 0], [1, 1]]).tobytes()
    )
    document = {
        "asset": {"version": "2.0"},
        "extensionsRequired": ["EXT_texture_webp"],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"extensions": {"EXT_texture_webp": {"source": 0}}}],
        "images": [{"uri": "a.webp"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": kind, "count": 3, "byteOffset": begin}
            for kind, begin in (("VEC3", 0), ("VEC2", 36))
        ],
        "bufferViews": [{"buffer": 0, "byteLength": len(corners)}],
        "buffers": [{"byteLength": len(corners)}],
    }
    text = json.dumps(document).encode()
    text += b"\0" * (4 + -len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(corners), b"BIN\0") + corners
    (tmp_path / "a.glb").write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    scene = rc.Scene.load(tmp_path / "a.glb")
    assert not scene.warnings
    np.testing.assert_array_equal(
        next(iter(scene.materials.values())).texture[..., :3], np.full((8, 16, 3), (0, 255, 0))
    )
