"""Cross-sections of lenses: what they show of lenses at their limits, and which file they go to."""

from __future__ import annotations

import errno
import math
import os
import re
import struct
import time
from itertools import combinations
from pathlib import Path

import matplotlib.figure
import numpy as np
import pytest
import realcam as rc
import typer
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image, ImageChops, ImageStat
from realcam.cli import app as cli
from realcam.drawing import draw_cross_section, draw_states, save_cross_section, save_states, states_of
from realcam.drawing.inset import draw_inset
from realcam.drawing.style import Style
from realcam.drawing.themes import DARK, LIGHT, THEMES, colours_of_wavelengths
from typer.testing import CliRunner

from .test_cross_section import one_element

GAUSS = rc.Lens.load("double-gauss-50mm")
LENS_FILE = """format = 1
name = "{name}"
title = "{title}"
[[surface]]
radius_of_curvature_mm = 50.0
thickness_mm = 5.0
material = 1.5
clear_semi_diameter_mm = 10.0
[[surface]]
radius_of_curvature_mm = -50.0
thickness_mm = 1.0
clear_semi_diameter_mm = 10.0
[[surface]]
type = "stop"
clear_semi_diameter_mm = 5.0
"""


def lens_file(path: Path, name: str = "mine", title: str = "") -> Path:
    path.write_text(LENS_FILE.format(name=name, title=title))
    return path


@pytest.mark.parametrize("f_number", [4.0, 22.0, 1e3, 1e5])
def test_rays_pass_however_far_the_diaphragm_is_closed(f_number: float) -> None:
    axes = matplotlib.figure.Figure().add_subplot()
    section = draw_cross_section(GAUSS.stopped_down(f_number), axes, rays=7)
    rays = [line for line in axes.lines if line.get_gid() == "ray"]
    drawn = np.array([line.get_xydata() for line in rays])
    assert np.array_equal(drawn, np.concatenate([bundle.paths_mm for bundle in section.bundles])[:, :, [2, 1]])
    assert len(rays) == 21
    stop = GAUSS.vertices_mm[GAUSS.stop_index]
    radius = GAUSS.stopped_down(f_number).stop_semi_diameter_mm
    for line in rays:
        z, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        at_stop = np.flatnonzero(np.abs(z - stop) < 1e-9)
        assert len(at_stop) == 1
        assert abs(y[at_stop[0]]) <= radius


@pytest.mark.parametrize("title", ["$\\\\foo$", "$x", "a_b^c"])
def test_a_title_is_no_formula(tmp_path: Path, title: str) -> None:
    lens = rc.Lens.load(lens_file(tmp_path / "mine.toml", title=title))
    save_cross_section(lens, tmp_path / "out.svg")
    save_cross_section(lens, tmp_path / "out.png")
    axes = matplotlib.figure.Figure().add_subplot()
    draw_cross_section(lens, axes)
    assert axes.get_title().startswith(title.replace("\\\\", "\\"))


def test_a_name_with_control_characters_is_drawn_without_them(tmp_path: Path) -> None:
    lens = rc.Lens(surfaces=GAUSS.surfaces, name="a\0b\x1b[31m")
    save_cross_section(lens, tmp_path / "out.svg")
    assert "\0" not in (tmp_path / "out.svg").read_text()


def test_the_drawing_goes_where_the_user_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    file = lens_file(tmp_path / "trav.toml", name="../victim")
    result = CliRunner().invoke(cli.app, ["lens", "draw", str(file)])
    assert result.exit_code == 0, result.output
    assert [path.name for path in here.iterdir()] == ["trav.svg"]
    assert {path.name for path in tmp_path.iterdir()} == {"here", "trav.toml"}
    assert CliRunner().invoke(cli.app, ["lens", "draw", "tessar-50mm"]).exit_code == 0
    assert (here / "tessar-50mm.svg").is_file()


def test_an_image_that_is_lit_in_a_ring_alone_is_drawn(tmp_path: Path) -> None:
    save_cross_section(rc.Lens.load("mirror-telephoto-500mm"), tmp_path / "mirror.svg")


def test_a_drawing_follows_links_and_is_no_file_until_it_is_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "link.svg").symlink_to("file.svg")
    draw = matplotlib.figure.Figure.savefig
    there: list[str] = []

    def watched(figure: matplotlib.figure.Figure, *to: object, **settings: object) -> None:
        draw(figure, *to, **settings)
        there.extend(path.name for path in tmp_path.iterdir())

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", watched)
    save_cross_section(GAUSS, tmp_path / "link.svg")
    assert there == ["link.svg"]
    assert (tmp_path / "link.svg").is_symlink()
    assert "<svg" in (tmp_path / "file.svg").read_text()
    assert {path.name for path in tmp_path.iterdir()} == {"link.svg", "file.svg"}


def test_what_cannot_be_written_is_named_as_the_user_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe.svg")
    long = "x" * 300 + ".svg"
    for name, why in {
        "gone/a.svg": "the folder gone does not exist",
        "pipe.svg": "is a pipe or a device",
        long: "cannot be written: File name too long",
        "a\0b.svg": None,
    }.items():
        with pytest.raises(rc.InputError if why is None else rc.ImageFileError, match=why and f"^{name}: {why}"):
            save_cross_section(GAUSS, name)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", "/temporary")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(rc.ImageFileError, match=r"^a\.svg: cannot be written: No space left on device$"):
        save_cross_section(GAUSS, "a.svg")
    assert [path.name for path in tmp_path.iterdir()] == ["pipe.svg"]


def test_a_lens_file_is_not_drawn_over(tmp_path: Path) -> None:
    file = lens_file(tmp_path / "mine.svg")
    before = file.read_text()
    (tmp_path / "link.svg").symlink_to(file)
    commands = [
        ["draw", file, file],
        ["draw", file, tmp_path / "link.svg"],
        ["compare", file, "tessar-50mm", file],
        ["compare", "tessar-50mm", file, file],
        ["gallery", "tessar-50mm", file, file],
        ["plot", "distortion", file, file],
        ["convert", file, file],
        ["report", file, file],
    ]
    for *command, output in commands:
        result = CliRunner().invoke(cli.app, ["lens", *map(str, command), "-o", str(output)])
        assert isinstance(result.exception, rc.InputError), command
        assert str(result.exception) == f"{output}: is the lens file itself; choose another name"
    assert file.read_text() == before


def test_the_output_is_named_after_the_lens_without_its_suffix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    rc.Lens.load("singlet-100mm").save("mine.v2.zmx")
    for command, *options in (["draw"], ["report", "--wavelengths", "546"]):
        result = CliRunner().invoke(cli.app, ["lens", command, "mine.v2.zmx", *options])
        assert result.exit_code == 0, result.output
    assert {path.name for path in tmp_path.iterdir()} == {"mine.v2.zmx", "mine.v2.svg", "mine.v2.pdf"}


def words_in(path: Path) -> str:
    return " ".join(re.findall(r"<text[^>]*>([^<]*)</text>", path.read_text(encoding="utf-8")))


def test_every_format_is_written_in_its_size(tmp_path: Path) -> None:
    for name in ("a.svg", "b.svg", "a.pdf", "a.PNG"):
        save_cross_section(GAUSS, tmp_path / name, width_px=500)
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    width, _ = struct.unpack(">II", (tmp_path / "a.PNG").read_bytes()[16:24])
    assert width == 500
    pixels = Image.open(tmp_path / "a.PNG").convert("RGB")
    for suffix, most_codes in ((".tif", 0), (".TIFF", 0), (".webp", 0), (".jpg", 8), (".jpeg", 8)):
        save_cross_section(GAUSS, tmp_path / f"a{suffix}", width_px=500)
        difference = ImageChops.difference(Image.open(tmp_path / f"a{suffix}").convert("RGB"), pixels)
        assert ImageStat.Stat(difference).rms <= [most_codes] * 3, suffix
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    # Text that stays text can be searched and is small.
    assert "Double Gauss 50 mm f/2 (Tronnier)" in words_in(tmp_path / "a.svg")
    with pytest.raises(rc.ImageFileError, match=r"expected \.svg, \.png, \.pdf, .* or \.tiff"):
        save_cross_section(GAUSS, tmp_path / "a.gif")
    with pytest.raises(rc.InputError, match="200 to 20000"):
        save_cross_section(GAUSS, tmp_path / "a.png", width_px=10)


def test_faces_have_the_colour_of_their_radius() -> None:
    for name, theme in THEMES.items():
        axes = matplotlib.figure.Figure().add_subplot()
        section = draw_cross_section(GAUSS, axes, rays=0, radius_colours=True, theme=name)
        lines = [line for line in axes.lines if line.get_color() in (theme.positive, theme.negative)]
        assert len(lines) == len(section.faces)
        for line, face in zip(lines, section.faces, strict=True):
            assert np.array_equal(line.get_xydata(), face.parts[0])
            positive = GAUSS.surfaces[face.surface].radius_of_curvature_mm > 0
            assert line.get_color() == (theme.positive if positive else theme.negative)


def test_themes_can_be_read() -> None:
    """Contrast of at least 3 to 1 for lines and 4.5 to 1 for text with the page, as WCAG 2.1 asks."""

    def luminance(colour: str) -> float:
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
        return sum(w * p for w, p in zip((0.2126, 0.7152, 0.0722), linear, strict=True))

    def contrast(one: str, other: str) -> float:
        dark, light = sorted((luminance(one), luminance(other)))
        return (light + 0.05) / (dark + 0.05)

    for theme in (LIGHT, DARK):
        assert contrast(theme.text, theme.page) > 4.5
        for colour in (*theme.rays, theme.edge, theme.positive, theme.negative, theme.plane, theme.error, theme.faint):
            assert contrast(colour, theme.page) > 3
            assert contrast(colour, theme.glass) > 2  # lines go through both
        assert not {theme.positive, theme.negative, theme.error} & set(theme.rays)


def test_wavelengths_are_told_apart() -> None:
    for wavelengths in ((486.1, 587.6, 656.3), (450, 550, 650), (550, 555), (1000, 900, 800)):
        assert len(set(colours_of_wavelengths(wavelengths, LIGHT))) == len(wavelengths)


@pytest.mark.parametrize("lens", [GAUSS, GAUSS.stopped_down(22), rc.Lens.load("fisheye-6mm-220deg")])
def test_an_inset_shows_the_whole_spot_as_large_as_it_says(lens: rc.Lens) -> None:
    figure = matplotlib.figure.Figure(figsize=(4, 4), dpi=100)
    section = draw_cross_section(lens, figure.add_subplot())
    inches_per_mm = 0.05
    for field in section.fields:
        axes = figure.add_axes((0.1, 0.1, 0.5, 0.25))
        magnification = draw_inset(axes, section, field, Style(), inches_per_mm)
        assert magnification / 10 ** math.floor(math.log10(magnification)) in (1, 2, 5)
        low, high = axes.get_ylim()
        assert (high - low) * magnification * inches_per_mm == pytest.approx(1)  # inch
        (bundle,) = (bundle for bundle in section.bundles if bundle.field == field)
        heights = bundle.paths_mm[:, -1, 1]
        assert np.ptp(heights) < 2 / 3 * (high - low)
        assert np.ptp(heights) > 0.99 * 2 / 3 * (high - low) / 2.5  # a step further would be too large
        assert f"× {magnification:g}" in [text.get_text() for text in axes.texts]
        # Rays cross the film, at z = 0, where the arrays have them, about the middle of the spot.
        middle = 0.5 * (heights.min() + heights.max())
        lines = [line.get_xydata() for line in axes.lines[: len(heights)]]
        assert all(np.all(np.abs(line) <= (high - low) / 2 * np.array([9, 1 + 1e-9])) for line in lines)
        drawn = sorted(y + (0 - z) * (y2 - y) / (z2 - z) for (z, y), (z2, y2) in lines)
        assert np.allclose(drawn, np.sort(heights - middle), rtol=0, atol=1e-12)


def test_pupils_and_planes_are_marked_where_they_are(tmp_path: Path) -> None:
    save_cross_section(GAUSS, tmp_path / "near.svg", marks=True)
    assert {"EP", "XP", "H", "H'", "F", "F'"} <= set(words_in(tmp_path / "near.svg").split())
    save_cross_section(rc.Lens.load("mirror-telephoto-500mm"), tmp_path / "far.svg", marks=True)
    assert "outside: H at -1543 mm" in words_in(tmp_path / "far.svg")


@pytest.mark.parametrize("name", ["heliar-100mm", "angulon-210mm", "phone-4mm", "achromat-75mm", "landscape-100mm"])
@pytest.mark.parametrize("width_px", [700, 1600])
def test_labels_of_pupils_and_planes_do_not_lie_on_each_other(name: str, width_px: int) -> None:
    figure = rc.Lens.load(name).draw(marks=True, width_px=width_px)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    labels = [text for text in figure.axes[0].texts if re.fullmatch("EP|XP|H'?|F'?", text.get_text())]
    assert len(labels) >= 4
    boxes = [text.get_window_extent(canvas.get_renderer()) for text in labels]
    for a, b in combinations(boxes, 2):
        assert min(a.x1, b.x1) <= max(a.x0, b.x0) + 1 or min(a.y1, b.y1) <= max(a.y0, b.y0) + 1


def test_faces_that_cross_are_drawn_as_an_error() -> None:
    axes = matplotlib.figure.Figure().add_subplot()
    section = draw_cross_section(one_element(thickness_mm=1, rims_mm=(9, 9)), axes)
    red = [patch for patch in axes.patches if patch.get_facecolor()[:3] == (224 / 255, 0, 0)]
    assert len(red) == 2
    assert np.array_equal(red[0].get_xy()[:-1], section.overlaps[0].zones[0])
    assert any("error: surfaces 1 and 2 cross, by 0.633 mm" in text.get_text() for text in axes.texts)


def test_states_stand_below_each_other_with_their_films(tmp_path: Path) -> None:
    telephoto = rc.Lens.load("telephoto-200mm-inner-focus")
    states = states_of(telephoto)
    assert [lens.focus_distance_m for _, lens in states] == [math.inf, 2.5]
    figure = draw_states(states, insets=False)
    assert [axes.get_xlim() for axes in figure.axes] == [figure.axes[0].get_xlim()] * 2
    save_states(states, tmp_path / "states.svg")
    assert "focused at 2.5 m" in words_in(tmp_path / "states.svg")
    with pytest.raises(rc.InputError, match="no lens"):
        draw_states([])


def test_zoom_positions_are_the_states_of_a_zoom() -> None:
    zoom = rc.Lens.load("zoom-70-200mm")
    assert states_of(zoom) == [(f"{zoom.title}, {name}", zoom.zoomed(name)) for name in zoom.zoom_positions]


def test_a_ghost_shows_the_glass_that_moves() -> None:
    telephoto = rc.Lens.load("telephoto-200mm-inner-focus")
    axes = matplotlib.figure.Figure().add_subplot()
    near = telephoto.focused(2.5)
    draw_cross_section(telephoto, axes, rays=0, ghost=near)
    outlines = [patch for patch in axes.patches if not patch.get_fill()]
    assert len(outlines) == 2  # of ten elements
    # All surfaces in front of the focus group are fixed, so that the film keeps its position and so do their vertices.
    moved = near.vertices_mm[10] - telephoto.vertices_mm[10]
    first = next(patch for patch in axes.patches if patch.get_fill() and np.min(patch.get_xy()[:, 0]) > 100)
    assert np.allclose(outlines[0].get_xy() - first.get_xy(), (moved, 0), rtol=0, atol=1e-9)


@pytest.mark.parametrize("options", [["--fields-deg", "0,10"], ["--wavelengths", "486,656"], ["--rays-from", "film"],
                                     ["--states", "rows"], ["--marks", "--radius-colours", "--theme", "dark"],
                                     ["--no-insets", "--rays", "0"]])  # fmt: skip
def test_the_command_takes_options(tmp_path: Path, options: list[str]) -> None:
    target = tmp_path / "out.svg"
    result = CliRunner().invoke(cli.app, ["lens", "draw", "double-gauss-50mm", "-o", str(target), *options])
    assert result.exit_code == 0, result.output
    assert target.is_file()


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (["--theme", "pink"], 'theme "pink" is unknown; expected light or dark'),
        (["--states", "all"], "expected one, rows or ghost"),
        (["--fields", "0,x"], '--fields: "x" is not a number'),
        (["--states", "ghost"], "does not specify a nearest focus"),
        (["--states", "rows", "--focus", "2"], "cannot be combined with it"),
        (["--wavelengths", "5"], "between 100 and 20000 nm"),
    ],
)
def test_a_mistake_is_named(tmp_path: Path, options: list[str], why: str) -> None:
    command = ["lens", "draw", "double-gauss-50mm", "-o", str(tmp_path / "a.svg"), *options]
    result = CliRunner().invoke(cli.app, command, standalone_mode=False)
    assert isinstance(result.exception, (rc.InputError, typer.BadParameter))
    assert why in str(result.exception)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_drawing_takes_less_than_a_second(tmp_path: Path) -> None:
    """The best of five runs counts, because other programs may run; a drawing takes 0.3 s on an idle core."""
    seconds = []
    for _ in range(5):
        start = time.process_time()
        save_cross_section(GAUSS, tmp_path / "a.svg")
        seconds.append(time.process_time() - start)
    assert min(seconds) < 1


def test_titles_have_the_engraved_f_number_at_any_focus() -> None:
    """A group that has moved to focus makes another lens, whose own f-number is not the one of the ring."""
    from realcam.cli.options import title_of
    from realcam.drawing.style import data_of
    from realcam.section.section import cross_section

    name = next(n for n in rc.lens_names() if rc.Lens.load(n).focus_group is not None)
    lens = rc.Lens.load(name)
    near = lens.focused(max(1.05 * lens.nearest_focus_m, 1.0))
    assert near.first_order().f_number != pytest.approx(lens.f_number, rel=0.01)
    engraved = f"f/{lens.f_number:.3g}"
    assert title_of(near).endswith(engraved)
    assert engraved in data_of(near, cross_section(near))
