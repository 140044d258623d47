"""The extension for Blender, its zip file everywhere and its panel in bpy, where that is installed."""

from __future__ import annotations

import ast
import json
import re
import sys
import types
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc
from realcam.blender import write_extension
from realcam.cli import app as cli
from typer.testing import CliRunner


@pytest.fixture(scope="module")
def extension(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("extension") / "lenses.zip"
    left_out: list[str] = []
    tilted = rc.Lens.load("tessar-50mm").tilted(x_deg=2.0)
    keys = write_extension(path, [rc.Lens.load("singlet-100mm"), tilted], left_out=left_out.append)
    assert keys == ["singlet-100mm"]
    assert len(left_out) == 1 and "surface 1 is tilted" in left_out[0]
    return path


def test_the_zip_is_an_extension_without_wheels(extension: Path) -> None:
    with zipfile.ZipFile(extension) as archive:
        names = archive.namelist()
        assert not [name for name in names if name.endswith((".whl", ".so", ".pyc"))]
        manifest = archive.read("blender_manifest.toml").decode()
        for key in ("schema_version", "id", "version", "name", "tagline", "maintainer", "type", "license"):
            assert re.search(rf"^{key} = ", manifest, re.M), key
        # Blender refuses a longer tagline, and one that ends with a full stop.
        tagline = re.search(r'^tagline = "(.*)"', manifest, re.M)[1]  # type: ignore[index]
        assert len(tagline) <= 64 and tagline[-1].isalnum()
        for name in names:
            if name.endswith(".py"):
                ast.parse(archive.read(name), name)
        lens = json.loads(archive.read("lenses/lenses.json"))["singlet-100mm"]
        assert lens["focal_length_mm"] == pytest.approx(101.5018, abs=1e-3)  # lenses/README.md
        assert b"shader realcam_singlet_100mm(" in archive.read("lenses/singlet-100mm.osl")
        assert len([name for name in names if name.startswith("presets/camera/")]) == 1


def test_the_command(tmp_path: Path) -> None:
    target = tmp_path / "lenses.zip"
    result = CliRunner().invoke(cli.app, ["lens", "blender", "singlet-100mm", "-o", str(target)])
    assert result.exit_code == 0, result.output
    assert zipfile.is_zipfile(target)
    with pytest.raises(rc.ImageFileError, match=r"expected \.zip"):
        write_extension(tmp_path / "lenses.tar", [rc.Lens.load("singlet-100mm")])
    with pytest.raises(rc.InputError, match="none of the lenses"):
        write_extension(target, [rc.Lens.load("singlet-100mm").tilted(x_deg=1.0)])


@pytest.fixture
def scene(extension: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    bpy = pytest.importorskip("bpy", reason="bpy is installed apart (docs/blender.md)")
    folder = tmp_path / "realcam_lenses"
    zipfile.ZipFile(extension).extractall(folder)
    monkeypatch.syspath_prepend(tmp_path)
    # bpy lacks the module with which Blender lists a shader's parameters; the panel sets them by name.
    monkeypatch.setitem(sys.modules, "oslquery", types.SimpleNamespace(OSLQuery=lambda path: None))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    import realcam_lenses  # type: ignore[import-not-found]

    realcam_lenses.register()
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = 60, 40
    scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = 256, False, False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(tmp_path / "picture.exr")
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (1, 1, 1, 1)
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    yield scene
    realcam_lenses.unregister()
    sys.modules.pop("realcam_lenses")


def test_cycles_takes_pictures_through_the_lens_of_the_panel(scene: Any, tmp_path: Path) -> None:
    import bpy

    rings = scene.camera.data.realcam
    rings.film, rings.lens = "lens", "singlet-100mm"
    rings.keep_brightness = rings.dispersion = False
    rings.f_number = 8.0
    assert scene.camera.data.type == "CUSTOM"
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(tmp_path / "picture.exr"))
    light = np.array(image.pixels[:]).reshape(40, 60, 4)[18:22, 28:32, 1].mean()
    lens = rc.Lens.load("singlet-100mm").focused(10.0).stopped_down(8)
    # 4096 samples; nearly all pass.
    assert light == pytest.approx(lens.film_pupil().irradiance, rel=5e-3)


def test_the_focus_follows_an_object(scene: Any, tmp_path: Path) -> None:
    import bpy

    data = scene.camera.data
    scene.camera.location = (1.0, 2.0, 3.0)
    scene.camera.rotation_euler = (0.0, np.pi / 2, 0.0)  # looks along -x
    data.realcam.lens = "singlet-100mm"
    # The shader paints the distance in metres that it focuses at, instead of light.
    text = data.custom_shader
    painted = text.as_string().replace("throughput = brightness * film;", "throughput = color(object, 1, 0);")
    assert painted != text.as_string()
    text.from_string(painted)
    data.custom_shader = None
    data.custom_shader = text
    target = bpy.data.objects.new("target", None)
    scene.collection.objects.link(target)
    data.dof.focus_object = target
    scene.cycles.samples = 8

    def focus_m() -> float:
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(str(tmp_path / "picture.exr"))
        pixels = np.array(image.pixels[:]).reshape(-1, 4)
        bpy.data.images.remove(image)
        # Mean over the rays that pass.
        return float(pixels[:, 0].sum() / pixels[:, 1].sum())

    for frame, x in ((1, -3.0), (11, -9.0)):
        target.location = (x, 2.5, 3.5)
        target.keyframe_insert("location", frame=frame)
    for frame, x in ((1, -3.0), (11, -9.0)):
        scene.frame_set(frame)
        assert focus_m() == pytest.approx(1.0 - x, rel=1e-4)
    # An object that hangs on another one; and a scene in tenths of metres.
    target.animation_data_clear()
    parent = bpy.data.objects.new("parent", None)
    scene.collection.objects.link(parent)
    target.parent, target.location, parent.location = parent, (0.0, 0.0, 0.0), (-49.0, 2.0, 3.0)
    scene.unit_settings.scale_length = 0.1
    data.realcam.f_number = 8.0
    assert focus_m() == pytest.approx(5.0, rel=1e-4)
    data.dof.focus_object = None
    data.dof.focus_distance = 20.0
    assert focus_m() == pytest.approx(2.0, rel=1e-4)


def test_a_lens_is_compiled_whatever_the_engine(scene: Any, tmp_path: Path) -> None:
    import bpy

    # Blender begins with EEVEE, which compiles no cameras.
    scene.render.engine = "BLENDER_EEVEE"
    scene.camera.data.realcam.lens = "singlet-100mm"
    scene.camera.data.realcam.dispersion = False
    assert scene.render.engine == "BLENDER_EEVEE"
    scene.render.engine = "CYCLES"
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(tmp_path / "picture.exr"))
    # A white world is white in the middle, but for the extension of 1% by which the lens is focused at 10 m.
    assert np.array(image.pixels[:]).reshape(40, 60, 4)[18:22, 28:32, 1].mean() == pytest.approx(0.98, rel=0.01)


def test_keys_of_the_ring_and_units_reach_the_shader(scene: Any, tmp_path: Path) -> None:
    import bpy

    rings = scene.camera.data.realcam
    rings.lens, rings.keep_brightness = "singlet-100mm", False
    for frame, f_number in ((1, 16.0), (2, 32.0)):
        rings.f_number = f_number
        rings.keyframe_insert("f_number", frame=frame)
    scene.unit_settings.scale_length = 0.01
    scene.frame_start, scene.frame_end, scene.cycles.samples = 1, 2, 64
    scene.render.filepath = str(tmp_path / "frame")
    bpy.ops.render.render(animation=True)
    light = [np.array(bpy.data.images.load(str(tmp_path / f"frame000{i}.exr")).pixels[:]).sum() for i in (1, 2)]
    light = np.subtract(light, 60 * 40)  # of the channel of opacity
    # The area of the stop is a fourth; and pupils as small as that are not cut anywhere.
    assert light[0] / light[1] == pytest.approx(4, rel=0.02)
    assert scene.camera.data.cycles_custom["metres_per_unit"] == pytest.approx(0.01)


def test_files_keep_their_lens_when_the_extension_gets_more_of_them(scene: Any, monkeypatch: Any) -> None:
    from realcam_lenses import settings

    scene.camera.data.realcam.lens = "singlet-100mm"
    # A lens that comes first, as an extension with more of them has it.
    more = {"a": {"title": "a", "source": ""}, **settings.lenses()}
    monkeypatch.setattr(settings, "lenses", lambda: more)
    settings._MENU.clear()
    assert scene.camera.data.realcam.lens == "singlet-100mm"


def test_the_ring_turns_by_third_stops(scene: Any) -> None:
    import bpy

    data = scene.camera.data
    data.realcam.lens = "singlet-100mm"
    widest = rc.Lens.load("singlet-100mm").first_order().f_number
    data.realcam.f_number = 8.0
    with bpy.context.temp_override(camera=data):
        for clicks, expected in ((1, 9.0), (1, 10.1), (-3, 7.1), (-30, widest)):
            bpy.ops.camera.realcam_turn_ring(clicks=clicks)
            assert data.realcam.f_number == pytest.approx(expected, abs=0.06)
            assert data.cycles_custom["f_number"] == pytest.approx(data.realcam.f_number)


def test_the_way_back(scene: Any, tmp_path: Path) -> None:
    import bpy
    from mathutils import Vector
    from realcam_lenses import export

    scene.camera.location = (1.0, -4.0, 2.0)
    scene.camera.rotation_euler = (1.1, 0.0, 0.2)
    bpy.ops.mesh.primitive_cube_add()
    scene.camera.data.realcam.lens = "singlet-100mm"
    target = tmp_path / "shot.toml"
    export.write_shot(scene, target)
    shot = rc.Shot.load(target)
    # Blender's z is up, glTF's and realcam's y.
    x, y, z = scene.camera.location
    assert shot.camera.position == pytest.approx((x, z, -y), abs=1e-5)
    forwards = scene.camera.matrix_world.to_quaternion() @ Vector((0, 0, -1))
    looked = np.subtract(shot.camera.look_at, shot.camera.position)
    assert looked / np.linalg.norm(looked) == pytest.approx((forwards.x, forwards.z, -forwards.y), abs=1e-5)
    assert shot.camera.lens.name == "singlet-100mm"
    assert scene.camera.data.type == "CUSTOM"
