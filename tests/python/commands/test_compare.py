"""realcam compare: the same framing and brightness with other apertures, lenses and zoom positions, on one sheet."""

from __future__ import annotations

import json
import math
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
import realcam as rc
from realcam.cli.sheet import _wrapped, save_sheet
from realcam.cli.variations import variations

from ..programs import Command
from ..scenes import quad, scene_of

FOCUS_M = 1.5


def shot(lens: str = "double-gauss-50mm", focus_m: float = FOCUS_M) -> rc.Shot:
    """The camera looks down from the side at a board about the origin, on which it is focused."""
    eye = FOCUS_M * np.array([0.6, 0.0, 0.8])
    camera = rc.Camera(
        rc.Lens.load(lens).stopped_down(4).focused(focus_m), film=rc.Film(36, 24, (90, 60)), position=tuple(eye),
        look_at=(0, 0, 0), exposure_time_s=1 / 100,
    )  # fmt: skip
    return rc.Shot(scene_of(quad((0, 0, 0), 3, diffuse=0.5)).with_environment(100), camera)


@pytest.fixture
def shot_file(tmp_path: Path) -> Path:
    (tmp_path / "quad.obj").write_text("v -1 -1 -3\nv 1 -1 -3\nv 1 1 -4\nv -1 1 -4\nf 1 2 3 4\n")
    (tmp_path / "shot.toml").write_text('format = 1\nscene = "quad.obj"\nlens = "tessar-50mm"\nfocus_m = 3.0\n')
    return tmp_path / "shot.toml"


def edges_px(camera: rc.Camera) -> np.ndarray:
    """Horizontal pixel coordinates of two points of the subject, 0.4 m to both sides of the axis."""
    right = np.array([0.8, 0.0, -0.6])
    return camera.project(np.stack([-0.4 * right, 0.4 * right]), through="chief")[:, 0]


@pytest.mark.parametrize("lens", ["wide-24mm", "tessar-50mm", "sonnar-180mm", "heliar-100mm"])
def test_lenses_show_the_subject_as_wide_as_the_shot_does(lens: str) -> None:
    before = shot()
    (after,) = variations(before, "lens", [lens])
    camera = after.shot.camera
    assert camera.lens.name == lens
    # Angles at the film's edge decide, and distortion of a few percent shows nearer to the middle.
    np.testing.assert_allclose(np.ptp(edges_px(camera)), np.ptp(edges_px(before.camera)), rtol=0.04)
    np.testing.assert_allclose(edges_px(camera).mean(), 45, atol=1)  # the middle stays there
    assert camera.lens.focus_distance_m == pytest.approx(np.linalg.norm(camera.position), rel=1e-3)  # on the subject


def test_zoom_positions_frame_alike_from_farther_away() -> None:
    before = shot("zoom-70-200mm")
    found = variations(before, "zoom", before.camera.lens.zoom_positions)
    distances = [np.linalg.norm(one.shot.camera.position) for one in found]
    assert distances == sorted(distances)
    assert distances[-1] > 2 * distances[0]  # 194 mm against 72
    for one in found:
        np.testing.assert_allclose(np.ptp(edges_px(one.shot.camera)), np.ptp(edges_px(before.camera)), rtol=0.04)


def test_apertures_keep_place_and_light() -> None:
    found = variations(shot(), "f_number", ["4", "8", "16"])
    assert [one.label for one in found] == ["f/4", "f/8", "f/16"]
    for one, f_number in zip(found, (4, 8, 16), strict=True):
        camera = one.shot.camera
        assert camera.position == shot().camera.position
        # Light falls with the square of the f-number.
        assert camera.exposure_time_s == pytest.approx(0.01 * (f_number / 4) ** 2, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("shutter", "1", "expected f_number, lens or zoom"),
        ("f_number", "x", "is not a number"),
        ("f_number", "nan", "is not a number"),
        ("f_number", "0.5", "opens to"),
        ("lens", "no-such", "unknown lens"),
        ("lens", "fisheye-6mm-220deg", "too wide"),
        ("zoom", "70mm", "does not zoom"),
    ],
)
def test_bad_values_are_refused(name: str, value: str, words: str) -> None:
    with pytest.raises(rc.RealcamError, match=words):
        variations(shot(), name, [value])


def test_a_subject_is_wanted_to_frame_alike() -> None:
    with pytest.raises(rc.InputError, match="focused at infinity"):
        variations(shot(focus_m=math.inf), "lens", ["tessar-50mm"])


def test_a_sheet_has_every_pixel_of_its_pictures(tmp_path: Path) -> None:
    image = rc.render(shot().scene, shot().camera, spp=4, effects=())
    save_sheet([("f/4 $", image), ("f/8", image), ("f/16", image)], tmp_path / "sheet.png", columns=2)
    sheet = np.round(255 * matplotlib.image.imread(tmp_path / "sheet.png")[:, :, :3])
    width = image.depth.shape[1]
    assert 2 * width < sheet.shape[1] < 2.5 * width + 80
    codes = image.developed()
    # Wherever a row of the sheet equals the picture's first row, all the picture's rows follow.
    starts = [
        (y, x)
        for y in range(sheet.shape[0] - len(codes) + 1)
        for x in range(sheet.shape[1] - width + 1)
        if (sheet[y, x : x + width] == codes[0]).all()
    ]
    assert len(starts) == 3
    assert all((sheet[y : y + len(codes), x : x + width] == codes).all() for y, x in starts)
    with pytest.raises(rc.InputError, match="at least one picture"):
        save_sheet([], tmp_path / "none.png")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--vary", "f_number"], "NAME=VALUE"),
        (["--vary", "f_number=2,,4"], "NAME=VALUE"),
        (["--vary", "f_number=4", "--theme", "pink"], "theme"),
    ],
)
def test_the_command_says_what_is_wrong_in_one_line(
    options: list[str], words: str, shot_file: Path, command: Command
) -> None:
    run = command("compare", shot_file, "-o", shot_file.with_name("sheet.png"), *options)
    assert run.returncode == 2
    assert words in run.stderr
    assert len(run.stderr.splitlines()) == 1
    assert not shot_file.with_name("sheet.png").exists()


def test_the_command_writes_the_sheet_and_says_what_was_taken(shot_file: Path, command: Command) -> None:
    sheet = shot_file.with_name("sheet.png")
    words = ["--vary", "f_number=4,8", "--size", "24", "--noise-codes", "20", "--seconds", "5", "--json"]
    run = command("compare", shot_file, "-o", sheet, *words)
    rows = json.loads(run.stdout)
    assert [row["label"] for row in rows] == ["f/4", "f/8"]
    assert rows[1]["exposure_time_s"] == pytest.approx(4 * rows[0]["exposure_time_s"], rel=1e-3)
    assert matplotlib.image.imread(sheet).shape[1] > 2 * 24


def test_labels_break_after_commas() -> None:
    """Between a number and its unit, or within the name of a lens, a line ends only where a phrase is too long."""
    lines = _wrapped("double-gauss-50mm, 50.4 mm, f/2.1, from 1.05 m", 36).split("\n")
    assert [line.replace("\N{NO-BREAK SPACE}", " ") for line in lines] == [
        "double-gauss-50mm, 50.4 mm, f/2.1,",
        "from 1.05 m",
    ]
