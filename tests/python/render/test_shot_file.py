"""Shot files: what they say, and what is wrong with them."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..scenes import quad, scene_of

pytestmark = pytest.mark.picture_files
ROOT = Path(__file__).resolve().parents[3]
QUAD = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"


def load(folder: Path, text: str) -> rc.Shot:
    (folder / "quad.obj").write_text(QUAD)
    (folder / "shot.toml").write_text(text)
    return rc.Shot.load(folder / "shot.toml")


def test_the_demo_is_a_shot() -> None:
    shot = rc.Shot.load(ROOT / "scenes" / "demo.toml")
    assert shot.camera.lens.name == "double-gauss-50mm"
    assert shot.camera.position == (0, 0.25, 1.1)
    assert shot.camera.film.resolution == (960, 640)
    assert shot.camera.exposure_time_s == 0.025
    assert shot.camera.lens.focus_distance_m == pytest.approx(1.05)
    assert shot.scene.has_light


def test_every_key_is_heard(tmp_path: Path) -> None:
    text = (ROOT / "lenses" / "tessar-50mm.toml").read_text()
    (tmp_path / "my.toml").write_text(re.sub("(?m)^name = .*", 'name = "my"', text))
    shot = load(
        tmp_path,
        """
        format = 1
        scene = "quad.obj"
        scale = 2
        environment_cd_m2 = [1, 2, 3]
        lens = "./my.toml"
        film_mm = [20, 10]
        resolution = [40, 20]
        position_m = [0, 1, 5]
        look_at_m = [0, 1, 0]
        up = [1, 0, 0]
        model = "pinhole"
        exposure_time_s = 2
        iso = 50
        spp = 3
        seed = 4
        max_bounces = 0
        tone = "linear"
        layers = ["normal", "depth"]
        """,
    )
    camera = shot.camera
    assert shot.scene.bounds_m == ((-2, -2, 0), (2, 2, 0))
    assert (camera.lens.name, camera.model, camera.iso, camera.exposure_time_s) == ("my", "pinhole", 50, 2)
    assert (camera.film.width_mm, camera.film.height_mm, camera.film.resolution) == (20, 10, (40, 20))
    assert (camera.position, camera.look_at, camera.up) == ((0, 1, 5), (0, 1, 0), (1, 0, 0))
    assert (shot.spp, shot.seed, shot.max_bounces, shot.tone) == (3, 4, 0, "linear")
    assert shot.layers == ("depth", "normal")
    assert set(shot.render().layers) == {"depth", "normal"}
    lit = rc.render(shot.scene, camera, effects=(), spp=1, max_bounces=0).pixels[10, 0]
    np.testing.assert_allclose(lit / lit[0], [1, 2, 3], rtol=1e-5)


def test_values_may_be_words_of_the_command_line(tmp_path: Path) -> None:
    shot = load(
        tmp_path,
        "format = 1\nscene = 'quad.obj'\nexposure_time_s = '1/125'\nposition_m = '0,0.5,4'\nlook_at_m = '0,0,0'\n"
        "focus_m = 'inf'\nresolution = '60x40'\nspp = '4'\neffects = 'dispersion,ghosts'\nlayers = 'depth'\n",
    )
    assert shot.camera.exposure_time_s == 1 / 125
    assert shot.camera.position == (0, 0.5, 4)
    assert shot.camera.lens.focus_distance_m == math.inf
    assert shot.camera.film.resolution == (60, 40)
    assert (shot.spp, shot.effects, shot.layers) == (4, ("dispersion", "ghosts"), ("depth",))


def test_thresholds_and_threads_of_a_shot(tmp_path: Path) -> None:
    scene = "format = 1\nscene = 'quad.obj'\nexposure_time_s = 0.01\n"
    draft = load(tmp_path, scene + "quality = 'draft'\nthreshold_px = 3\nthreads = 2\n").settings
    assert (draft.threshold_px, draft.threshold_codes, draft.threads) == (3, 4, 2)
    (tmp_path / "shot.toml").write_text(scene + "threshold_px = 3\n")
    again = rc.Shot.load(tmp_path / "shot.toml", quality="reference").settings  # in place of what the file says
    assert (again.threshold_px, again.threshold_codes) == (0.1, 0.25)


def test_focus_and_stop(tmp_path: Path) -> None:
    base = 'format = 1\nscene = "quad.obj"\nposition_m = [0, 0, 3]\nlook_at_m = [0, 0, 0]\n'
    assert load(tmp_path, base + "focus_m = inf\n").camera.lens.focus_distance_m == np.inf
    assert load(tmp_path, base + 'focus_m = "auto"\n').camera.lens.focus_distance_m == pytest.approx(3)
    metered = load(tmp_path, base + "environment_cd_m2 = 100\n").camera.exposure_time_s
    assert (
        load(tmp_path, base + 'environment_cd_m2 = 100\nexposure_time_s = "auto"\n').camera.exposure_time_s == metered
    )
    assert load(tmp_path, base + "f_number = 8\n").camera.lens.first_order().f_number == pytest.approx(8)


def test_blades(tmp_path: Path) -> None:
    base = 'format = 1\nscene = "quad.obj"\nexposure_time_s = 1\nf_number = 8\n'
    shot = load(tmp_path, base + "blades = 7\nblade_rounding = 0.3\nblade_rotation_deg = 15\n")
    lens = shot.camera.lens
    assert (lens.iris_blades, lens.iris_rounding) == (7, 0.3)
    assert lens.iris_rotation_deg == pytest.approx(15)
    assert lens.first_order().f_number == pytest.approx(8)
    assert rc.render(shot.scene, shot.camera, effects=(), spp=1).metadata()["realcam:blades"] == "7"
    for line, required in (
        ("blades = 2", r"shot\.toml:5: the iris has 2 blades; expected 0 \(round\) or 3 to 24"),
        ("blade_rounding = 1.5", r"shot\.toml:5: the rounding of the iris"),
        ("blade_rotation_deg = 10", "the diaphragm of double-gauss-50mm is round"),
    ):
        with pytest.raises(rc.InputError, match=required):
            load(tmp_path, base + line + "\n")


TEAPOT = "v 0 0 0\nv 1 0 0\nv 0 2 0\nvt 0 0\nf 1/1 2/1 3/1\n"
PLACED = """
format = 1
scene = "quad.obj"
position_m = [0, 0, 5]
exposure_time_s = 1

[[object]]
file = "part.obj"
position_m = [1, 2, 3]
rotation_deg = [0, 90, 90]
stretch = [1, 2, 1]
scale = 0.5
material = "brass"

[[object]]
file = "part.obj"
name = "other"
matrix = [1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1]

[material.brass]
model = "metallic_roughness"
base_color = [0.9, 0.7, 0.3]
metallic = 1
roughness = 0.25
emission = 3

[[light]]
type = "spot"
position_m = [0, 0, 3]
direction = [0, 0, -2]
intensity_cd = [10, 20, 30]

[[light]]
type = "sun"
direction = [0, -1, 0]
illuminance_lux = 5
"""


def test_objects_are_put_into_the_scene(tmp_path: Path) -> None:
    (tmp_path / "part.obj").write_text(TEAPOT)
    scene = load(tmp_path, PLACED).scene
    (first, place), (second, other) = scene.instances
    assert (first, second) == ("part", "other")
    # About y by 90 degrees and then about z by 90: x goes to -z and stays; y to itself and to -x; z to x and to y.
    expected = np.array([[0, -2, 0, 1], [0, 0, 1, 2], [-1, 0, 0, 3], [0, 0, 0, 1]])
    np.testing.assert_allclose(place, expected, atol=1e-15)
    np.testing.assert_allclose(other, np.array([[1, 0, 0, 4], [0, 1, 0, 5], [0, 0, 1, 6], [0, 0, 0, 1]]))
    # In metres: corners (0.5, 0, 0) and (0, 1, 0) of the one, (1, 0, 0) and (0, 2, 0) of the other.
    low, high = scene.bounds_m
    np.testing.assert_allclose(low, (-1, -1, 0))
    np.testing.assert_allclose(high, (5, 7, 6))


def test_the_lights_of_a_shot_are_those_of_python(tmp_path: Path) -> None:
    (tmp_path / "part.obj").write_text(TEAPOT)
    shot = load(tmp_path, PLACED)
    by_hand = rc.Scene.load(tmp_path / "quad.obj").with_spot_light((0, 0, 3), (0, 0, -1), (10, 20, 30))
    brass = rc.Material.metallic_roughness(base_color=(0.9, 0.7, 0.3), metallic=1, roughness=0.25, emission=(3, 3, 3))
    part = rc.Scene.load(tmp_path / "part.obj", scale=0.5).with_material(0, brass)
    by_hand = by_hand.with_sun((0, -1, 0), (5, 5, 5)).with_instance(part, shot.scene.instances[0][1])
    other = rc.Scene.load(tmp_path / "part.obj")
    by_hand = by_hand.with_instance(other, shot.scene.instances[1][1])
    camera = shot.camera.replace(film=rc.Film(36, 24, (30, 20)))
    expected = rc.render(by_hand, camera, effects=(), spp=8, device="cpu").pixels
    np.testing.assert_array_equal(rc.render(shot.scene, camera, effects=(), spp=8, device="cpu").pixels, expected)
    assert expected.max() > 0


def test_a_material_takes_the_place_of_those_of_its_name(tmp_path: Path) -> None:
    (tmp_path / "m.mtl").write_text("newmtl wood\nKd 1 0 0\nnewmtl glass\nKd 0 1 0\n")
    obj = QUAD.replace("f 1 2 3 4", "mtllib m.mtl\nvt 0 0\nusemtl wood\nf 1/1 2/1 3/1\nusemtl glass\nf 1/1 3/1 4/1")
    (tmp_path / "two.obj").write_text(obj)
    rc.render(
        rc.Scene.load(tmp_path / "two.obj").with_environment(1),
        rc.Camera(rc.Lens.load("tessar-50mm")),
        effects=(),
        spp=1,
    )
    text = """
        format = 1
        scene = "two.obj"
        exposure_time_s = 1
        [material.glass]
        transmission = 1
        ior = 1.7
        diffuse = 0
        """
    shot = load(tmp_path, text)
    assert list(shot.scene.materials) == ["wood", "glass"]
    glass = shot.scene.materials["glass"]
    assert (glass.transmission, glass.diffuse, glass.model) == (1, (0, 0, 0), "phong")
    assert glass.ior == pytest.approx(1.7)
    assert shot.scene.materials["wood"].diffuse == (1, 0, 0)


def test_textures_of_a_material_are_files(tmp_path: Path) -> None:
    (tmp_path / "part.obj").write_text(TEAPOT)
    lens = rc.Lens.load("tessar-50mm")
    rc.render(rc.Scene.load(tmp_path / "part.obj").with_environment(1), rc.Camera(lens), effects=(), spp=1).save(
        tmp_path / "t.png"
    )
    text = PLACED.replace("emission = 3", 'texture = "t.png"\nopacity_texture = "t.png"')
    assert load(tmp_path, text).scene.triangle_count == 4
    with pytest.raises(rc.InputError, match=r"shot\.toml:20: the material's object has no texture coordinates"):
        load(tmp_path, text.replace('file = "part.obj"', 'file = "quad.obj"'))
    with pytest.raises(rc.InputError, match=r"none\.png: cannot be read as a texture"):
        load(tmp_path, text.replace("t.png", "none.png"))


# Lines appended to the first two lines of a shot with a scene, and the expected error message.
MISTAKES = [
    ("foccus_m = 2", r':3: unknown key "foccus_m" \(did you mean "focus_m"\?\)'),
    ("focus_m = 'near'", r':3: "focus_m" must be a number of metres, inf'),
    ("focus_m = nan", r':3: "focus_m" must be'),
    ("scale = 0", r':3: "scale" must be a positive number'),
    ("model = 'real'", r':3: "model" must be full, .* or pinhole'),
    ("resolution = [1.5, 2]", r':3: "resolution" must be a whole number from 0 to'),
    ("resolution = [1]", r':3: "resolution" must be an array of 2 numbers'),
    ("spp = 0", r':3: "spp" must be a whole number from 1 to 16777216, or auto'),
    ("spp = 4\nseconds = 3", r':3: .*need spp "auto"'),
    ("environment_cd_m2 = -1", r":3: .*between 0 and 1e20"),
    ("environment_cd_m2 = [1, 2]", r":3: .*array of 3 numbers"),
    ("environment = 'a'\nenvironment_cd_m2 = 1", ":4: .*exclude each other"),
    ("environment = 'gone.hdr'", r"gone\.hdr: no such file"),
    ("texture = 'gone.png'", r"gone\.png: cannot be read as a texture"),
    ("lens = 'gone'", "unknown lens"),
    ("layers = ['colour']", r'shot\.toml:3: "layers": unknown layer "colour"; expected all, or'),
    ("layers = [1]", r':3: "layers" must be an array of texts'),
    ('lens = "tessar-50mm\\u0000"', 'shot.toml:3: "lens" holds a null character'),
    ('environment = "a\\u0000b"', 'shot.toml:3: "environment" holds a null character'),
    ("[[object]]\nname = 'x'", r":3: file is missing"),
    ("[[object]]\nfile = 'none.obj'", r"none\.obj: .*no such file"),
    ("[[object]]\nfile = 'quad.obj'\npositoin_m = [1, 2, 3]", r':5: .* "positoin_m" \(did you mean "position_m"'),
    ("[[object]]\nfile = 'quad.obj'\nstretch = 0", r":3: a transform must keep three directions"),
    ("[[object]]\nfile = 'quad.obj'\nmaterial = 'bras'\n[material.brass]", r":3: .* no table \[material\.bras\]"),
    ("[object]\nfile = 'quad.obj'", r":3: expected tables \[\[object\]\]"),
    ("material = 3", r":3: expected tables \[material\.NAME\]"),
    ("[material.brass]\nmodel = 'phong'", r':3: the scene has no material "brass"'),
    ("[material.a]\nmodel = 'disney'", r':4: "model" must be phong or metallic_roughness'),
    ("[material.a]\nmetallic = 1", r':4: unknown key "metallic"'),
    ("[material.a]\nmodel = 'metallic_roughness'\nroughness = 2", r":3: .*between 0 and 1"),
    ("[material.a]\nopacity = -1", r":3: .*between 0 and 1"),
    ("[[light]]\ntype = 'lamp'", r':4: "type" must be "point", "spot" or "sun"'),
    ("[[light]]\ntype = 'point'\nposition_m = [0, 0, 0]", r':3: "intensity_cd" is missing'),
    ("[[light]]\ntype = 'point'\nintensity_cd = 1", r':3: "position_m" is missing'),
    ("[[light]]\ntype = 'sun'\ndirection = [0, 0, 0]\nilluminance_lux = 1", r':5: "direction" must be a vector'),
    ("[[light]]\ntype = 'sun'\ndirection = [0, 1, 0]\nilluminance_lux = -1", r":3: .*illuminance"),
    (
        "[[light]]\ntype = 'spot'\nposition_m = [0, 0, 0]\ndirection = [0, 1, 0]\nintensity_cd = 1\n"
        "outer_cone_deg = 95",
        r":3: .*cones",
    ),
]
# The whole of a file.
NO_SHOTS = [
    ("", "expected format = 1"),
    ("format = 2", "expected format = 1"),
    ("format = 1", "scene is missing"),
    ("format = 1\nscene = 3", r"shot\.toml:2: \"scene\" must be a text"),
    ("format = 1\nscene = ''", r":2: \"scene\" is empty"),
    ("format = 1\nscene = 'gone.obj'", r"gone\.obj: no such file"),
    ("format = 1\nscene = [", "shot.toml:2: not valid TOML"),
    ('format = 1\nscene = "a\\u0000b"', 'shot.toml:2: "scene" holds a null character'),
]


@pytest.mark.parametrize(
    ("text", "message"),
    [*((f"format = 1\nscene = 'quad.obj'\n{text}", message) for text, message in MISTAKES), *NO_SHOTS],
)
def test_mistakes_name_file_and_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(rc.RealcamError, match=message) as error:
        load(tmp_path, text)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "settings"),
    [
        ("", {"spp": "auto", "noise_codes": 2, "seconds": 60}),
        ("noise_codes = 3", {"spp": "auto", "noise_codes": 3}),
        ("seconds = 5", {"spp": "auto", "noise_codes": 2, "seconds": 5}),
        ("max_spp = 50", {"spp": "auto", "noise_codes": 2, "seconds": 60, "max_spp": 50}),
        ("spp = 'auto'", {"spp": "auto", "noise_codes": 1}),
        ("spp = 7", {"spp": 7}),
    ],
)
def test_where_the_samples_end(text: str, settings: dict[str, object], tmp_path: Path) -> None:
    """The stopping rules are those of docs/sampling.md."""
    shot = load(tmp_path, f"format = 1\nscene = 'quad.obj'\n{text}")
    assert shot.settings == rc.RenderSettings(**settings)


def test_what_is_no_shot_file(tmp_path: Path) -> None:
    with pytest.raises(rc.InputError, match=r"gone\.toml: no such file"):
        rc.Shot.load(tmp_path / "gone.toml")
    with pytest.raises(rc.InputError, match="is a folder"):
        rc.Shot.load(tmp_path)
    (tmp_path / "large.toml").write_bytes(b"#" * 2**21)
    with pytest.raises(rc.InputError, match="too large"):
        rc.Shot.load(tmp_path / "large.toml")


def test_a_shot_is_rendered_with_all_its_settings() -> None:
    scene = scene_of(quad((0, 0, -3), 3, diffuse=0.6)).with_environment(1.0)
    view = rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, (6, 4)), exposure_time_s=1)
    settings = rc.RenderSettings(effects=(), max_bounces=1, spp=1, threads=1, seed=3)
    shot = rc.Shot(scene, view, settings)
    assert shot.render(device="cpu").settings == settings
    assert shot.render(device="cpu", threads=2).settings == settings.with_(threads=2)


def test_another_lens_need_not_be_as_fast_as_the_one_of_the_shot(tmp_path: Path) -> None:
    """Values that a shot states for its own lens are no error for another lens; values given with that lens are."""
    text = "format = 1\nscene = 'quad.obj'\nlens = 'double-gauss-50mm'\nf_number = 2.1\nfilm_mm = [36, 24]\n"
    load(tmp_path, text + "exposure_time_s = 0.01\n")
    slow = rc.Lens.load("heliar-100mm")
    for lens in ("heliar-100mm", slow):
        with pytest.warns(UserWarning, match=r"opens to f/4\.5, and the shot has f/2\.1: it is wide open"):
            shot = rc.Shot.load(tmp_path / "shot.toml", lens=lens)
        assert shot.camera.lens.wide_open() == shot.camera.lens
    with pytest.raises(rc.InputError, match=r"f/2\.1 is faster than lens"):
        rc.Shot.load(tmp_path / "shot.toml", lens="heliar-100mm", f_number=2.1)
    with pytest.warns(UserWarning) as told:
        rc.Shot.load(tmp_path / "shot.toml", lens="phone-4mm")
    assert any("is made for a film of" in str(warning.message) for warning in told)


def test_an_engraved_f_number_is_wide_open() -> None:
    """double-gauss-50mm is called f/2 and opens to f/2.03."""
    lens = rc.Lens.load("double-gauss-50mm")
    assert lens.stopped_down(2) == lens.wide_open()
    with pytest.raises(rc.InputError, match=r"f/1\.9 is faster"):
        lens.stopped_down(1.9)
