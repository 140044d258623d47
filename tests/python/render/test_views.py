"""Views of OpenColorIO: beside its own processors, and configurations of strangers."""

from __future__ import annotations

import pickle
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..programs import EXECUTABLE, PYTHON, wants_executable
from ..scenes import quad, scene_of

ocio = pytest.importorskip("PyOpenColorIO")
oiio = pytest.importorskip("OpenImageIO")
pytestmark = pytest.mark.picture_files

STUDIO = "ocio://studio-config-v4.0.0_aces-v2.0_ocio-v2.5"
ACES_VIEW = "ACES 2.0 - SDR 100 nits (Rec.709)"

# A configuration of version 2, whose view "out" is the transform that a test needs.
CONFIG = """ocio_profile_version: 2
environment: {}
search_path: luts
strictparsing: true
roles: {default: lin, scene_linear: lin, aces_interchange: aces}
file_rules:
  - !<Rule> {name: cg, pattern: "*_cg", extension: exr, colorspace: lin}
  - !<Rule> {name: Default, colorspace: aces}
displays:
  screen:
    - !<View> {name: out, colorspace: out}
    - !<View> {name: plain, colorspace: lin}
active_displays: [screen]
active_views: [out, plain]
colorspaces:
  - !<ColorSpace>
    name: aces
    to_scene_reference: !<MatrixTransform> {}
  - !<ColorSpace>
    name: lin
    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}
  - !<ColorSpace>
    name: out
    from_scene_reference: TRANSFORM
"""


def config(folder: Path, transform: str, further_spaces: str = "") -> str:
    path = folder / "config.ocio"
    path.write_text(CONFIG.replace("TRANSFORM", transform) + further_spaces)
    return str(path)


def space(name: str, transform: str) -> str:
    return f"  - !<ColorSpace>\n    name: {name}\n    from_scene_reference: {transform}\n"


def processed(pixels: np.ndarray, iso: float, display: str, view: str, name: str = STUDIO) -> np.ndarray:
    """8-bit values by OpenColorIO's own processor and its own conversion to 8 bits, from its colour space for linear
    Rec. 709; middle grey, 10 lx s / ISO, is 0.18 there."""
    config = ocio.Config.CreateFromFile(name)
    processor = config.getProcessor("Linear Rec.709 (sRGB)", display, view, ocio.TRANSFORM_DIR_FORWARD)
    cpu = processor.getOptimizedCPUProcessor(ocio.BIT_DEPTH_F32, ocio.BIT_DEPTH_UINT8, ocio.OPTIMIZATION_DEFAULT)
    linear = (pixels.astype(np.float64) * iso * 0.018).astype(np.float32)
    codes = np.zeros(pixels.shape, np.uint8)
    height, width = pixels.shape[:2]
    cpu.apply(
        ocio.PackedImageDesc(linear, width, height, ocio.CHANNEL_ORDERING_RGB),
        ocio.PackedImageDesc(codes, width, height, ocio.CHANNEL_ORDERING_RGB, ocio.BIT_DEPTH_UINT8, 1, 3, 3 * width),
    )
    return codes


def assert_same_codes(codes: np.ndarray, expected: np.ndarray) -> None:
    """Floats that fall on the middle between two 8-bit values may be rounded to either: one value in 1,000, by one."""
    difference = np.abs(codes.astype(int) - expected)
    assert difference.max() <= 1
    assert np.mean(difference > 0) < 1e-3


@pytest.fixture(scope="module")
def image() -> rc.Image:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.5).stopped_down(5.6)
    camera = rc.Camera(lens, film=rc.Film(12, 9, (40, 30)), exposure_time_s=1 / 60, iso=400)
    upper = quad((0, 0.25, -2.5), 0.4, 0.25, emission=(300, 30, 5))
    lower = quad((0, -0.25, -2.5), 0.4, 0.25, emission=(5, 40, 900))
    return rc.render(scene_of(upper, lower), camera, effects=(), spp=4, seed=11)


def test_a_view_is_opencolorios_own(image: rc.Image) -> None:
    rng = np.random.default_rng(5)
    light = np.exp(rng.uniform(-9, 3, (300, 200, 3))).astype(np.float32)
    light[0, 0] = (-0.2, 0.5, 0.1)  # a colour outside of Rec. 709
    views = ocio.Config.CreateFromFile(STUDIO)
    for display in views.getDisplays():
        for name in views.getViews(display):
            view = rc.OcioView(STUDIO, display, name)
            assert_same_codes(view.developed(light, 250), processed(light, 250, display, name))
    view = rc.OcioView(STUDIO)
    assert (view.display, view.view) == ("sRGB - Display", ACES_VIEW)
    assert_same_codes(image.developed(view), processed(image.pixels, 400, view.display, view.view))
    assert len(np.unique(image.developed(view))) > 20


def test_no_light_overflows() -> None:
    """Without a limit, OpenColorIO makes infinite light black."""
    light = np.array([[[np.inf] * 3, [3e38] * 3, [np.nan] * 3, [-1] * 3]], np.float32)
    codes = rc.OcioView(STUDIO).developed(light, 100)
    np.testing.assert_array_equal(codes, [[[255] * 3, [255] * 3, [0] * 3, [0] * 3]])


def test_files_say_by_which_view_they_were_developed(image: rc.Image, tmp_path: Path) -> None:
    for display, is_srgb in (("sRGB - Display", True), ("Rec.1886 Rec.709 - Display", False)):
        view = rc.OcioView(STUDIO, display)
        image.save(tmp_path / "a.png", view)
        picture = oiio.ImageBuf(str(tmp_path / "a.png"))
        np.testing.assert_array_equal(picture.get_pixels(oiio.UINT8), image.developed(view))
        entries = {
            f"realcam:{name}": picture.spec().get_string_attribute(f"realcam:{name}")
            for name in ("ocio", "display", "view")
        }
        assert entries == view.metadata()
        assert not picture.spec().get_string_attribute("realcam:tone")
        assert (b"sRGB" in (tmp_path / "a.png").read_bytes()[:200]) == is_srgb
    raw = rc.Sensor.load("ideal").expose(image)
    raw.save(tmp_path / "raw.png", rc.OcioView(STUDIO))
    assert b"sRGB" in (tmp_path / "raw.png").read_bytes()[:200]


def test_views_are_values(image: rc.Image) -> None:
    view = rc.OcioView(STUDIO, "Rec.1886 Rec.709 - Display")
    assert pickle.loads(pickle.dumps(view)) == view
    assert view != rc.OcioView(STUDIO)
    assert view.views["sRGB - Display"][0] == ACES_VIEW
    with pytest.raises(rc.InputError, match="tone must be"):
        rc.Image(image.pixels, image.depth, image.camera, 4, 11, image.stats, tone=3)  # type: ignore[arg-type]


SHOT = """format = 1
scene = "quad.obj"
environment_cd_m2 = 500
resolution = [24, 16]
spp = 2
max_bounces = 1
effects = []
exposure_time_s = 0.01
"""
QUAD = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"


def shot_file(folder: Path, text: str = "") -> Path:
    (folder / "quad.obj").write_text(QUAD)
    (folder / "shot.toml").write_text(SHOT + text)
    return folder / "shot.toml"


def test_shot_files_options_and_keywords_have_views(tmp_path: Path) -> None:
    path = shot_file(tmp_path, f'ocio = "{STUDIO}"\n')
    picture = rc.photograph(path)
    expected = processed(picture.pixels, 100, "sRGB - Display", ACES_VIEW)
    picture.save(tmp_path / "python.png")
    for words, target in (([path], "file.png"), ([path, "--ocio", STUDIO, "--view", ACES_VIEW], "option.png")):
        done = subprocess.run([*PYTHON, "render", *map(str, words), "-o", tmp_path / target], capture_output=True)
        assert done.returncode == 0, done.stderr
    for name in ("python.png", "file.png", "option.png"):
        assert_same_codes(oiio.ImageBuf(str(tmp_path / name)).get_pixels(oiio.UINT8), expected)
    other = rc.photograph(path, display="Rec.1886 Rec.709 - Display", view="Un-tone-mapped")
    assert_same_codes(other.developed(), processed(other.pixels, 100, "Rec.1886 Rec.709 - Display", "Un-tone-mapped"))
    assert rc.photograph(path, tone="linear").tone == "linear"  # an option replaces the file's view


def test_a_configuration_beside_the_shot_file_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config(tmp_path, "!<MatrixTransform> {}")
    path = shot_file(tmp_path, 'ocio = "config.ocio"\nview = "plain"\n')
    monkeypatch.chdir("/")
    shot = rc.Shot.load(path)
    assert isinstance(shot.tone, rc.OcioView)
    assert (shot.tone.config, shot.tone.view) == (str(tmp_path / "config.ocio"), "plain")


def test_noise_goals_do_not_depend_on_the_view(tmp_path: Path) -> None:
    """A noise goal counts in sRGB values of the linear tone curve: the samples are the same under every view. Under the
    view of ACES 2.0 for sRGB a grey that is not brighter than white changes by at most 1.05 times as much."""
    path = shot_file(tmp_path)
    goal = {"spp": "auto", "noise_codes": 3, "max_spp": 64}
    np.testing.assert_array_equal(rc.photograph(path, **goal).pixels, rc.photograph(path, ocio=STUDIO, **goal).pixels)
    values = np.arange(256) / 255  # of sRGB (IEC 61966-2-1)
    linear = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    grey = np.repeat(linear.astype(np.float32)[:, None], 3, axis=1)
    config = ocio.Config.CreateFromFile(STUDIO)
    processor = config.getProcessor("Linear Rec.709 (sRGB)", "sRGB - Display", ACES_VIEW, ocio.TRANSFORM_DIR_FORWARD)
    processor.getDefaultCPUProcessor().applyRGB(grey)
    slopes = np.diff(255 * grey[:, 1])
    assert 1.0 < slopes.max() < 1.055
    assert slopes.min() > 0


# ACEScg by the Academy's S-2014-004 and Rec. 709, adapted by the Bradford transform: the matrix that renderers print.
ACESCG_FROM_REC709 = [
    [0.613097, 0.339523, 0.047379],
    [0.070194, 0.916354, 0.013452],
    [0.020616, 0.109570, 0.869815],
]


def test_exr_in_acescg(image: rc.Image, tmp_path: Path) -> None:
    for name, chromaticities in {
        "rec709": (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329),
        "acescg": (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767),
    }.items():
        path = tmp_path / f"{name}.exr"
        image.save(path, exr_color_space=name)
        picture = oiio.ImageBuf(str(path))
        stated = picture.spec().getattribute("chromaticities", oiio.TypeDesc("float[8]"))
        np.testing.assert_allclose(stated, chromaticities, rtol=1e-6)
        expected = image.pixels.astype(np.float64)
        if name == "acescg":
            expected = expected @ np.transpose(ACESCG_FROM_REC709)
        # Six decimals of the matrix.
        np.testing.assert_allclose(picture.get_pixels(oiio.FLOAT)[..., :3], expected, atol=2e-6 * image.pixels.max())
        # Rounding to float32, twice.
        np.testing.assert_allclose(rc.read_environment(path), image.pixels, rtol=1e-5, atol=1e-6 * image.pixels.max())
    colors = image.pixels.reshape(-1, 3).copy()
    config = ocio.Config.CreateFromFile(STUDIO)
    config.getProcessor("Linear Rec.709 (sRGB)", "ACEScg").getDefaultCPUProcessor().applyRGB(colors)
    written = oiio.ImageBuf(str(tmp_path / "acescg.exr")).get_pixels(oiio.FLOAT)[..., :3]
    np.testing.assert_allclose(written.reshape(-1, 3), colors, atol=2e-6 * colors.max())
    with pytest.raises(rc.InputError, match='exr_color_space must be rec709 or acescg; it is "xyz"'):
        image.save(tmp_path / "a.exr", exr_color_space="xyz")


def test_layers_of_colours_are_in_acescg(tmp_path: Path) -> None:
    path = shot_file(tmp_path)
    shot = rc.Shot.load(path, layers=["albedo", "normal", "variance"], exr_color_space="acescg")
    picture = shot.render()
    picture.save(tmp_path / "a.exr")
    read = oiio.ImageBuf(str(tmp_path / "a.exr"))
    names, values = read.spec().channelnames, read.get_pixels(oiio.FLOAT)

    def layer(name: str, parts: str = "RGB") -> np.ndarray:
        return np.stack([values[..., names.index(f"{name}.{part}")] for part in parts], axis=-1)

    albedo = picture.layers["albedo"] @ np.transpose(ACESCG_FROM_REC709)
    np.testing.assert_allclose(layer("Albedo"), albedo, atol=2e-6)
    np.testing.assert_array_equal(layer("Normal", "XYZ"), picture.layers["normal"])
    np.testing.assert_array_equal(layer("Variance"), picture.layers["variance"])
    unit = read.spec().get_string_attribute("realcam:unit")
    assert "linear ACEScg" in unit
    assert "Variance: (lux seconds)^2, of R, G, B in linear Rec. 709" in unit


def written(path: Path, pixels: np.ndarray) -> None:
    spec = oiio.ImageSpec(*pixels.shape[1::-1], pixels.shape[2], "float" if pixels.dtype == np.float32 else "uint8")
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec)
    assert output.write_image(pixels)
    output.close()


def rec709_from(name: str, color_space: str, color: tuple[float, float, float]) -> np.ndarray:
    """A colour by OpenColorIO's own processor, through the colour space that both configurations have."""
    config, standard = ocio.Config.CreateFromFile(name), ocio.Config.CreateFromFile("ocio://default")
    processor = ocio.Config.GetProcessorFromConfigs(config, color_space, standard, "Linear Rec.709 (sRGB)")
    return np.array(processor.getDefaultCPUProcessor().applyRGB(list(color)))


def mean_color(path: Path, **values: object) -> np.ndarray:
    """Colour of the film's centre, whose light is that of an even environment or of a matt quad in white light."""
    pixels = rc.photograph(path, film_mm=(6, 4), **values).pixels  # type: ignore[arg-type]
    center = pixels[6:10, 10:14].mean(axis=(0, 1))
    return center / center.sum()


def test_environments_are_converted_from_their_colour_space(tmp_path: Path) -> None:
    path = shot_file(tmp_path)
    color = (0.5, 0.45, 0.4)
    for name in ("sky.exr", "sky_cg.exr"):
        written(tmp_path / name, np.full((4, 8, 3), color, np.float32))
    away = {"position_m": (0, 0, 3), "look_at_m": (0, 0, 9), "focus_m": 5}

    def light(name: str, **values: object) -> np.ndarray:
        return mean_color(path, environment=str(tmp_path / name), **away, **values)

    own = config(tmp_path, "!<MatrixTransform> {}")
    cases = [
        ("sky.exr", {}, np.array(color)),
        ("sky.exr", {"ocio": STUDIO}, np.array(color)),  # a configuration alone changes no input
        ("sky.exr", {"ocio": STUDIO, "environment_color_space": "ACEScg"}, rec709_from(STUDIO, "ACEScg", color)),
        ("sky.exr", {"ocio": STUDIO, "environment_color_space": "ACEScct"}, rec709_from(STUDIO, "ACEScct", color)),
        ("sky.exr", {"ocio": own, "environment_color_space": "file_rules"}, rec709_from(own, "aces", color)),
        ("sky_cg.exr", {"ocio": own, "environment_color_space": "file_rules"}, rec709_from(own, "lin", color)),
    ]
    for name, values, expected in cases:
        expected = np.maximum(expected, 0)
        np.testing.assert_allclose(light(name, **values), expected / expected.sum(), rtol=1e-5, atol=1e-6)


def test_textures_of_colours_are_converted_and_no_others(tmp_path: Path) -> None:
    path = shot_file(tmp_path, 'texture = "t.png"\nposition_m = [0, 0, 3]\nlook_at_m = [0, 0, 0]\n')
    codes = (200, 90, 40)
    written(tmp_path / "t.png", np.full((4, 4, 3), codes, np.uint8))
    fractions = tuple(code / 255 for code in codes)
    for color_space in ("ACEScg", "sRGB Encoded AP1", "Raw"):
        expected = np.maximum(rec709_from(STUDIO, color_space, fractions), 0)
        found = mean_color(path, ocio=STUDIO, texture_color_space=color_space)
        np.testing.assert_allclose(found, expected / expected.sum(), rtol=1e-4)
    material = (
        '[material.m]\nmodel = "metallic_roughness"\nnormal_map = "t.png"\nmetallic_roughness_texture = "t.png"\n'
    )
    (tmp_path / "quad.mtl").write_text("newmtl m\nKd 0.5 0.5 0.5\n")
    (tmp_path / "quad.obj").write_text("mtllib quad.mtl\nusemtl m\n" + QUAD)
    (tmp_path / "shot.toml").write_text(SHOT + material)
    plain, converted = (rc.photograph(path, ocio=STUDIO, texture_color_space=name) for name in (None, "ACEScg"))
    np.testing.assert_array_equal(plain.pixels, converted.pixels)


def test_mistakes_are_one_line(tmp_path: Path) -> None:
    path = shot_file(tmp_path)
    own = config(tmp_path, "!<MatrixTransform> {}")
    for values, message in [
        ({"ocio": "ocio://nope"}, "ocio://nope: Could not find 'nope' in the built-in configurations"),
        ({"ocio": str(tmp_path / "none.ocio")}, "none.ocio: no such file"),
        ({"ocio": str(tmp_path)}, "is a folder"),
        ({"ocio": own, "view": "nope"}, "config.ocio: the display 'screen' has no view 'nope'; expected out, plain"),
        ({"ocio": own, "display": "nope"}, "config.ocio: no display 'nope'; expected screen"),
        ({"ocio": own, "texture_color_space": "x"}, "config.ocio: no colour space 'x'; expected aces, lin, out, or"),
        ({"ocio": own, "tone": "film"}, '"tone" and "ocio" exclude each other'),
        ({"view": "x"}, '"view" belongs to a configuration of OpenColorIO, and "ocio" names none'),
        ({"ocio": ""}, '"ocio" is empty'),
        ({"exr_color_space": "xyz"}, '"exr_color_space" must be rec709 or acescg; it is "xyz"'),
    ]:
        with pytest.raises(rc.InputError, match=re.escape(message)) as error:
            rc.Shot.load(path, **values)
        assert "\n" not in str(error.value)
    done = subprocess.run(
        [*PYTHON, "render", path, "-o", tmp_path / "a.png", "--view", "x"], capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (
        2,
        'realcam: error: --view belongs to a configuration of OpenColorIO, and "ocio" names none\n',
    )
    assert not (tmp_path / "a.png").exists()


@pytest.mark.parametrize("command", ["render", "plan"])
def test_without_the_extra_one_line_names_it(tmp_path: Path, command: str) -> None:
    path = shot_file(tmp_path)
    program = (
        "import sys; sys.modules['PyOpenColorIO'] = None; "
        "from realcam_command.main import main; sys.argv[0] = 'realcam'; sys.exit(main())"
    )
    words = [command, str(path), "--ocio", STUDIO] + (["-o", str(tmp_path / "a.png")] if command == "render" else [])
    done = subprocess.run([sys.executable, "-c", program, *words], capture_output=True, text=True)
    if command == "plan":  # develops nothing
        assert done.returncode == 0
        return
    assert (done.returncode, done.stderr) == (
        2,
        f"realcam: error: {STUDIO}: configurations need OpenColorIO: pip install realcam[color]\n",
    )


@wants_executable
def test_the_executable_says_who_has_views(tmp_path: Path) -> None:
    path = shot_file(tmp_path)
    words = ["render", path, "-o", tmp_path / "a.png", "--ocio", STUDIO]
    done = subprocess.run([*EXECUTABLE, *words], capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr == (
        f"realcam: error: {STUDIO}: this program has no OpenColorIO; the command of the Python package realcam[color] "
        "has it\n"
    )
    done = subprocess.run(
        [*EXECUTABLE, "render", path, "-q", "-o", tmp_path / "a.exr", "--exr-color-space", "acescg"],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    chromaticities = (
        oiio.ImageBuf(str(tmp_path / "a.exr")).spec().getattribute("chromaticities", oiio.TypeDesc("float[8]"))
    )
    np.testing.assert_allclose(chromaticities[:2], (0.713, 0.293), rtol=1e-6)


CUBE = "LUT_3D_SIZE 2\n" + "".join(f"{r} {g} {b}\n" for b in (0, 1) for g in (0, 1) for r in (0, 1))


def test_tables_of_a_configuration_are_found_beside_it(tmp_path: Path) -> None:
    (tmp_path / "luts").mkdir()
    (tmp_path / "luts" / "a.cube").write_text(CUBE)
    view = rc.OcioView(config(tmp_path, "!<FileTransform> {src: a.cube}"))
    # ACES2065-1 of 0.25 in each channel of Rec. 709 is 0.25: the matrices keep white.
    np.testing.assert_array_equal(view.developed(np.full((1, 1, 3), 0.25 / 1.8, np.float32), 100), [[[64, 64, 64]]])


def bomb(levels: int, count: int) -> tuple[str, str]:
    """A transform that refers to a colour space, which refers to another `count` times, and so on."""
    spaces = ""
    for level in range(levels):
        reference = f"!<ColorSpaceTransform> {{src: aces, dst: s{level + 1}}}"
        group = f"!<GroupTransform> {{children: [{', '.join([reference] * count)}]}}"
        spaces += space(f"s{level}", group if level + 1 < levels else "!<MatrixTransform> {}")
    return "!<ColorSpaceTransform> {src: aces, dst: s0}", spaces


@pytest.mark.parametrize(
    ("transform", "further", "message"),
    [
        ("!<FileTransform> {src: /dev/zero}", "", "/dev/zero: "),
        ("!<FileTransform> {src: pipe.cube}", "", "pipe.cube: "),
        ("!<FileTransform> {src: folder.cube}", "", "folder.cube: "),
        ("!<FileTransform> {src: huge.cube}", "", "huge.cube: has more than 128 MB"),
        ("!<FileTransform> {src: empty.cube}", "", "could not be loaded"),
        ("!<FileTransform> {src: /etc/passwd}", "", "could not be loaded"),
        ("!<FileTransform> {src: none.cube}", "", "none.cube' could not be located"),
        ("!<FileTransform> {src: claims.cube}", "", "could not be loaded"),
        (
            "!<ColorSpaceTransform> {src: aces, dst: b}",
            space("b", "!<ColorSpaceTransform> {src: aces, dst: out}"),
            "Cycle detected",
        ),
        (*bomb(5, 60), "has more than 10000 transforms"),
        ("!<GroupTransform> {children: [" * 5000 + "]}" * 5000, "", "Loading the OCIO profile failed"),
        ("!<ExponentTransform> {value: [.inf, 1, 1, 1]", "", "Loading the OCIO profile failed"),
    ],
)
def test_configurations_of_strangers(tmp_path: Path, transform: str, further: str, message: str) -> None:
    import os

    luts = tmp_path / "luts"
    luts.mkdir()
    os.mkfifo(luts / "pipe.cube")
    (luts / "folder.cube").mkdir()
    (luts / "empty.cube").touch()
    (luts / "claims.cube").write_text("LUT_3D_SIZE 4000\n0 0 0\n")
    with (luts / "huge.cube").open("wb") as file:
        file.truncate(129 << 20)
    path = config(tmp_path, transform, further)
    with pytest.raises(rc.InputError, match=re.escape(message)) as error:
        rc.OcioView(path)
    assert str(error.value).startswith(f"{path}: ")
    assert "\n" not in str(error.value)


def test_files_that_are_no_configuration(tmp_path: Path) -> None:
    for name, content in {
        "text.ocio": b"hello\n",
        "empty.ocio": b"",
        "binary.ocio": bytes(range(256)) * 20,
        "old.ocio": b"ocio_profile_version: 1\nroles: {default: l}\ndisplays:\n  m:\n    - !<View> {name: v, "
        b"colorspace: l}\ncolorspaces:\n  - !<ColorSpace>\n    name: l\n",
    }.items():
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(rc.InputError, match=f"^{re.escape(str(path))}: ") as error:
            rc.OcioView(str(path))
        assert "\n" not in str(error.value)


def test_a_job_keeps_its_view(tmp_path: Path) -> None:
    shot = rc.Shot.load(shot_file(tmp_path), ocio=STUDIO, exr_color_space="acescg")
    job = rc.Job.make(tmp_path / "job", {"a": shot})
    job.work()
    picture = job.image()
    assert (picture.tone, picture.exr_color_space) == (shot.tone, "acescg")
    np.testing.assert_array_equal(picture.developed(), shot.render().developed())
    own = rc.Shot.load(tmp_path / "shot.toml", ocio=config(tmp_path, "!<MatrixTransform> {}"))
    with pytest.raises(rc.InputError, match="a job stores no configuration files"):
        rc.Job.make(tmp_path / "other", {"a": own})
    assert not (tmp_path / "other").exists()


def test_frames_are_taken_again_under_another_view(tmp_path: Path) -> None:
    path = shot_file(tmp_path)
    config(tmp_path, "!<MatrixTransform> {}")

    def counts(*words: str) -> str:
        done = subprocess.run(
            [*PYTHON, "render", path, "-o", tmp_path / "f.####.png", "--frames", "1", *words],
            capture_output=True,
            text=True,
            cwd=tmp_path,
        )
        assert done.returncode == 0, done.stderr
        return done.stderr

    counts("--ocio", "config.ocio")
    assert "1 of 1 frames exist already" in counts("--ocio", "config.ocio")
    assert "were taken again" in counts("--ocio", "config.ocio", "--view", "plain")
    config(tmp_path, "!<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}")
    assert "were taken again" in counts("--ocio", "config.ocio", "--view", "plain")
