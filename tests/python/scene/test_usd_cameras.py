"""Cameras of USD stages: their lens, rings and film as settings of a shot, and frames of a film."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("pxr")

from pxr import Sdf, Usd, UsdGeom, UsdLux, UsdUtils

from .test_usd_stages import stage_file


def test_camera_keeps_its_lens(tmp_path: Path) -> None:
    body = """def Cube "Box" { double size = 0.2; }
def Camera "Main" {
    double3 xformOp:translate = (0, 0, 2)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    float horizontalAperture = 0.24
    float verticalAperture = 0.16
    float fStop = 2.8
    custom string realcam:lens = "tessar-50mm"
    custom float realcam:focusM = 1.5
    float exposure:time = 0.5
    float exposure:iso = 200
    float exposure = 1
}"""
    path = stage_file(tmp_path, body)
    shot = rc.Shot.load(path, spp=1)
    camera = shot.camera
    assert "tessar" in camera.lens.name.lower()
    assert (camera.film.width_mm, camera.film.height_mm) == pytest.approx((24, 16))
    assert (camera.exposure_time_s, camera.iso) == (0.5, 400)
    assert [name for name, _, _ in shot.scene.cameras] == ["Main"]
    # Pixels are square, with the aspect ratio of a resolution in place of that of the apertures.
    film = rc.Shot.load(path, spp=1, resolution=(48, 48)).camera.film
    assert (film.width_mm, film.height_mm) == pytest.approx((24, 24))
    other = rc.Shot.load(path, spp=1, lens="double-gauss-50mm", f_number=4, iso=100).camera
    assert other.lens.f_number == pytest.approx(4, rel=1e-3)
    assert other.iso == 100


def camera_stage(path: Path) -> Usd.Stage:
    """A box before a camera whose settings the tests change."""
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 1)
    UsdGeom.Cube.Define(stage, "/Box").GetSizeAttr().Set(0.2)
    UsdGeom.Camera.Define(stage, "/Main").AddTranslateOp().Set((0, 0, 2))
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(24)
    return stage


def settings_over_time(path: Path) -> dict[float, tuple[float, float]]:
    """Focus and f-number of frames, by seconds."""
    shot = rc.Shot.load(path, spp=1)
    frames = shot.frames(range(1, 26, 6), frames_per_second=24)
    lenses = [frame.camera.lens for frame in frames.values()]
    return {0.25 * i: (lens.focus_distance_m, lens.f_number) for i, lens in enumerate(lenses)}


@pytest.mark.parametrize("focus, f_number", [("realcam:focusM", "realcam:fNumber"), ("focusDistance", "fStop")])
def test_rings_over_time_are_interpolated_as_usd_does(tmp_path: Path, focus: str, f_number: str) -> None:
    """A focus pull from 0.5 to 8 m: half of the way is 4.25 m, and 0.94 m for the mean of the inverses."""
    stage = camera_stage(tmp_path / "pull.usda")
    prim = stage.GetPrimAtPath("/Main")
    attributes = {name: prim.CreateAttribute(name, Sdf.ValueTypeNames.Float) for name in (focus, f_number)}
    for time, values in ((0, (0.5, 2.8)), (24, (8.0, 16.0))):
        for attribute, value in zip(attributes.values(), values, strict=True):
            attribute.Set(value, time)
    stage.Save()
    found = settings_over_time(tmp_path / "pull.usda")
    at_start, _ = found[0.0]
    offset = at_start - 0.5  # from the entrance pupil to the film, for USD's own attribute
    for time_s, (focus_m, number) in found.items():
        expected = [attribute.Get(24 * time_s) for attribute in attributes.values()]
        assert (focus_m - offset, number) == pytest.approx(expected, rel=2e-3)


def test_focus_distance_is_measured_to_the_entrance_pupil_of_the_opening_lens(tmp_path: Path) -> None:
    """focusDistance is measured from the camera's origin, the entrance pupil of the lens that is mounted when the
    shutter opens, in focus. The film stays through cuts, so that the plane in focus does, too."""
    path = tmp_path / "stage.usda"
    stage = camera_stage(path)
    prim = stage.GetPrimAtPath("/Main")
    prim.GetAttribute("focusDistance").Set(4.0)
    stage.Save()

    def check(camera: rc.Camera) -> None:
        # The iteration ends when the entrance pupil moves by less than 1e-9 m.
        assert camera.position[2] - camera.lens.focus_distance_m == pytest.approx(2 - 4, abs=1e-9)

    def check_lens(shot: rc.Shot, lens: rc.Lens) -> None:
        check(shot.camera)
        focused = lens.focused(shot.camera.lens.focus_distance_m)
        pupil_mm = focused.first_order().entrance_pupil_position_mm
        film_mm = sum(surface.thickness_mm for surface in focused.surfaces[:-1]) + focused.film_distance_mm
        assert shot.camera.position[2] == pytest.approx(2 + (film_mm - pupil_mm) / 1000, abs=1e-9)

    def shot_file(text: str) -> rc.Shot:
        (tmp_path / "shot.toml").write_text(f'format = 1\nscene = "stage.usda"\n{text}\n')
        return rc.Shot.load(tmp_path / "shot.toml", spp=1)

    check_lens(rc.Shot.load(path, spp=1), rc.Lens.load("double-gauss-50mm"))
    check_lens(rc.Shot.load(path, spp=1, lens="long-800mm"), rc.Lens.load("long-800mm"))
    check_lens(rc.Shot.load(path, spp=1, lens=rc.Lens.load("tessar-50mm")), rc.Lens.load("tessar-50mm"))
    zoom = rc.Lens.load("zoom-80-200mm")
    check_lens(shot_file('lens = "zoom-80-200mm"\nzoom = "200mm"'), zoom.zoomed(zoom.zoom_positions[-1]))
    zooming = 'lens = "zoom-80-200mm"\n[[key]]\ntime_s = 0\nfocal_length_mm = 190'
    check_lens(shot_file(zooming), zoom.zoomed(190.0))
    cut = '[[key]]\ntime_s = 1\nlens = "long-800mm"'
    check_lens(shot_file(f"shutter_opens_s = 1.5\n{cut}"), rc.Lens.load("long-800mm"))
    frames = shot_file(cut).frames([1, 25], frames_per_second=24).values()
    assert len({frame.camera.lens.name for frame in frames}) == 2
    for frame in frames:
        check(frame.camera)
    with pytest.raises(rc.InputError, match=r"shot.toml:3: .* has no focal lengths"):
        shot_file("[[key]]\ntime_s = 0\nfocal_length_mm = 50")
    assert rc.Shot.load(path, spp=1, lens="long-800mm", focus_m=7).camera.lens.focus_distance_m == pytest.approx(7)
    prim.CreateAttribute("realcam:lens", Sdf.ValueTypeNames.String).Set("tessar-50mm")
    prim.GetAttribute("focusDistance").Set(4.0, 0)
    prim.GetAttribute("focusDistance").Set(6.0, 24)
    stage.Save()
    check_lens(rc.Shot.load(path, spp=1), rc.Lens.load("tessar-50mm"))
    check_lens(rc.Shot.load(path, spp=1, lens="long-800mm"), rc.Lens.load("long-800mm"))
    last = rc.Shot.load(path, spp=1, lens="long-800mm").frames([25], frames_per_second=24)
    (camera,) = (frame.camera for frame in last.values())
    assert camera.position[2] - camera.lens.focus_distance_m == pytest.approx(2 - 6, abs=1e-9)


def test_realcams_attributes_precede_values_over_time_of_usds_own(tmp_path: Path) -> None:
    stage = camera_stage(tmp_path / "stage.usda")
    prim = stage.GetPrimAtPath("/Main")
    for time, focus, f_stop in ((0, 1, 4), (24, 3, 8)):
        prim.GetAttribute("focusDistance").Set(focus, time)
        prim.GetAttribute("fStop").Set(f_stop, time)
    for name, value in (("realcam:focusM", 1.5), ("realcam:fNumber", 5.6)):
        prim.CreateAttribute(name, Sdf.ValueTypeNames.Float).Set(value)
    stage.Save()
    for settings in settings_over_time(tmp_path / "stage.usda").values():
        assert settings == pytest.approx((1.5, 5.6), rel=1e-6)


def test_a_packed_stage_keeps_its_lens_file(tmp_path: Path) -> None:
    rc.Lens.load("tessar-50mm").save(tmp_path / "mine.toml")
    stage = camera_stage(tmp_path / "stage.usda")
    prim = stage.GetPrimAtPath("/Main")
    prim.CreateAttribute("realcam:lens", Sdf.ValueTypeNames.Asset).Set("./mine.toml")
    stage.Save()
    assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "stage.usda"), str(tmp_path / "stage.usdz"))
    (tmp_path / "mine.toml").unlink()
    lens = rc.Shot.load(tmp_path / "stage.usdz", spp=1).camera.lens
    assert lens.surfaces[:2] == rc.Lens.load("tessar-50mm").surfaces[:2]


def frames_of(path: Path, *words: str) -> str:
    """Takes a frame and returns the notices."""
    command = [sys.executable, "-m", "realcam", "render", str(path), "-o", str(path.parent / "f#.png"), "--frames", "1"]
    options = ["--spp", "1", "--resolution", "12x8", "--device", "cpu"]
    return subprocess.run([*command, *options, *words], check=True, capture_output=True, text=True).stderr


@pytest.mark.picture_files
def test_frames_of_a_packed_stage_with_a_sky(tmp_path: Path) -> None:
    """A film's frames compare the contents of all inputs, also of an .exr that is inside of the package."""
    oiio = pytest.importorskip("OpenImageIO")
    sky = oiio.ImageOutput.create(str(tmp_path / "sky.exr"))
    sky.open(str(tmp_path / "sky.exr"), oiio.ImageSpec(8, 4, 3, "float"))
    sky.write_image(np.full((4, 8, 3), 100, np.float32))
    sky.close()
    stage = camera_stage(tmp_path / "stage.usda")
    UsdLux.DomeLight.Define(stage, "/Sky").GetTextureFileAttr().Set("./sky.exr")
    stage.Save()
    assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "stage.usda"), str(tmp_path / "stage.usdz"))
    assert "exist already" not in frames_of(tmp_path / "stage.usdz")
    assert "exist already" in frames_of(tmp_path / "stage.usdz")


@pytest.mark.picture_files
def test_frames_are_taken_again_after_a_change_of_a_sublayer(tmp_path: Path) -> None:
    stage = camera_stage(tmp_path / "box.usda")
    stage.Save()
    path = stage_file(tmp_path, "", header="metersPerUnit = 1; subLayers = [@./box.usda@]")
    frames_of(path)
    assert "exist already" in frames_of(path)
    UsdGeom.Cube(stage.GetPrimAtPath("/Box")).CreateDisplayColorAttr([(0.1, 0.5, 0.1)])
    stage.Save()
    assert "taken again" in frames_of(path)


@pytest.mark.picture_files
@pytest.mark.slow
def test_frames_are_taken_again_with_another_variant_and_in_other_air(tmp_path: Path) -> None:
    stage = camera_stage(tmp_path / "stage.usda")
    variants = stage.GetPrimAtPath("/Box").GetVariantSets().AddVariantSet("colour")
    for name, colour in (("red", (0.8, 0.1, 0.1)), ("green", (0.1, 0.5, 0.1))):
        variants.AddVariant(name)
        variants.SetVariantSelection(name)
        with variants.GetVariantEditContext():
            UsdGeom.Cube(stage.GetPrimAtPath("/Box")).CreateDisplayColorAttr([colour])
    stage.Save()
    path = tmp_path / "stage.usda"
    options: tuple[str, ...] = ("--variants", "/Box{colour=red}", "--visibility", "20")
    frames_of(path, *options)
    assert "exist already" in frames_of(path, *options)
    for options in (("--variants", "/Box{colour=red}", "--visibility", "21"), ("--visibility", "21")):
        assert "taken again" in frames_of(path, *options)
