"""Shot files: what they say, and what is wrong with them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytestmark = pytest.mark.pictures
ROOT = Path(__file__).resolve().parents[2]
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
    lit = rc.render(shot.scene, camera, spp=1, max_bounces=0).pixels[10, 0]
    np.testing.assert_allclose(lit / lit[0], [1, 2, 3], rtol=1e-5)


def test_focus_and_stop(tmp_path: Path) -> None:
    base = 'format = 1\nscene = "quad.obj"\nposition_m = [0, 0, 3]\nlook_at_m = [0, 0, 0]\n'
    assert load(tmp_path, base + "focus_m = inf\n").camera.lens.focus_distance_m == np.inf
    assert load(tmp_path, base + 'focus_m = "auto"\n').camera.lens.focus_distance_m == pytest.approx(3)
    metered = load(tmp_path, base + "environment_cd_m2 = 100\n").camera.exposure_time_s
    assert (
        load(tmp_path, base + 'environment_cd_m2 = 100\nexposure_time_s = "auto"\n').camera.exposure_time_s == metered
    )
    assert load(tmp_path, base + "f_number = 8\n").camera.lens.first_order().f_number == pytest.approx(8)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "format = 1 is wanted"),
        ("format = 2", "format = 1 is wanted"),
        ("format = 1", "scene is missing"),
        ("format = 1\nscene = 3", r"shot\.toml:2: \"scene\" must be a text"),
        ("format = 1\nscene = ''", r":2: \"scene\" is empty"),
        ("format = 1\nscene = 'quad.obj'\nfoccus_m = 2", r':3: unknown key "foccus_m" \(did you mean "focus_m"\?\)'),
        (
            "format = 1\nscene = 'quad.obj'\nfocus_m = 'near'",
            r':3: "focus_m" must be a number of metres, inf',
        ),
        ("format = 1\nscene = 'quad.obj'\nfocus_m = nan", r':3: "focus_m" must be'),
        ("format = 1\nscene = 'quad.obj'\nscale = 0", r':3: "scale" must be a positive number'),
        ("format = 1\nscene = 'quad.obj'\nmodel = 'real'", r':3: "model" must be full, thick, thin or pinhole'),
        ("format = 1\nscene = 'quad.obj'\nresolution = [1.5, 2]", r':3: "resolution" wants whole numbers from 0 to'),
        ("format = 1\nscene = 'quad.obj'\nresolution = [1]", r':3: "resolution" must be an array of 2 numbers'),
        ("format = 1\nscene = 'quad.obj'\nspp = 0", r":3: spp must lie between"),
        ("format = 1\nscene = 'quad.obj'\nspp = 1e300", r':3: "spp" wants whole numbers from 0 to'),
        ("format = 1\nscene = 'quad.obj'\nseed = -1", r':3: "seed" wants whole numbers from 0 to'),
        ("format = 1\nscene = 'quad.obj'\nenvironment_cd_m2 = -1", r":3: .*between 0 and 1e20"),
        ("format = 1\nscene = 'quad.obj'\nenvironment_cd_m2 = [1, 2]", r":3: .*array of 3 numbers"),
        ("format = 1\nscene = 'quad.obj'\nenvironment = 'a'\nenvironment_cd_m2 = 1", ":4: .*exclude each other"),
        ("format = 1\nscene = 'quad.obj'\nenvironment = 'gone.hdr'", r"gone\.hdr: no such file"),
        ("format = 1\nscene = 'quad.obj'\ntexture = 'gone.png'", r"gone\.png: cannot be read as a texture"),
        ("format = 1\nscene = 'gone.obj'", r"gone\.obj: no such file"),
        ("format = 1\nscene = 'quad.obj'\nlens = 'gone'", "unknown lens"),
        ("format = 1\nscene = 'quad.obj'\nlayers = ['colour']", r'shot\.toml:3: unknown layer "colour"; all, or'),
        ("format = 1\nscene = 'quad.obj'\nlayers = 'all'", r':3: "layers" must be an array of texts'),
        ("format = 1\nscene = 'quad.obj'\nlayers = [1]", r':3: "layers" must be an array of texts'),
        ("format = 1\nscene = [", "shot.toml:2: not valid TOML"),
        ('format = 1\nscene = "a\\u0000b"', 'shot.toml:2: "scene" holds a null character'),
        ('format = 1\nscene = "a"\nlens = "tessar-50mm\\u0000"', 'shot.toml:3: "lens" holds a null character'),
        ('format = 1\nscene = "a"\nenvironment = "a\\u0000b"', 'shot.toml:3: "environment" holds a null character'),
    ],
)
def test_mistakes_name_file_and_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(rc.RealcamError, match=message) as error:
        load(tmp_path, text)
    assert "\n" not in str(error.value)


def test_what_is_no_shot_file(tmp_path: Path) -> None:
    with pytest.raises(rc.InputError, match=r"gone\.toml: no such file"):
        rc.Shot.load(tmp_path / "gone.toml")
    with pytest.raises(rc.InputError, match="is a folder"):
        rc.Shot.load(tmp_path)
    (tmp_path / "large.toml").write_bytes(b"#" * 2**21)
    with pytest.raises(rc.InputError, match="too large"):
        rc.Shot.load(tmp_path / "large.toml")
