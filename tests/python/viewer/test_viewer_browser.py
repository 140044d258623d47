"""The lens bench in a browser: every control changes picture or drawing as physics says."""

from __future__ import annotations

import re
import time
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("nicegui")
playwright = pytest.importorskip("playwright.sync_api")

from . import bench_shots  # noqa: E402
from .bench_pages import CHROMIUM, BenchPage, Server, until  # noqa: E402

pytestmark = [pytest.mark.picture_files, pytest.mark.skipif(CHROMIUM is None, reason="no chromium")]


sharp = bench_shots.sharpness


# The camera.


def test_closing_the_aperture_deepens_the_sharp_zone(bench: BenchPage) -> None:
    near, middle, far = sharp(bench.picture())
    assert middle > 1.7 * max(near, far)
    bench.test_id("automatic").click()
    bench.test_id("aperture").fill("15")
    bench.until_text("aperture-text", lambda text: text == "Aperture f/11")
    deep = sharp(bench.picture())
    assert min(deep) > 0.8 * max(deep)
    assert deep[0] > 1.7 * near
    assert deep[2] > 1.5 * far
    # Twice the f-number wants four times the time: 2.03 to 11.3 is five stops.
    text = bench.until_text("shutter-text", lambda text: "1/50" not in text)
    assert "automatic" in text


def test_focus_by_its_ring(bench: BenchPage) -> None:
    bench.turn("focus", "PageUp", 10)  # by forty steps each
    assert np.argmax(sharp(bench.picture())) == 2  # far
    bench.until_text("focus-text", lambda text: "∞" in text)


@pytest.mark.slow
def test_shutter_and_iso_brighten(bench: BenchPage) -> None:
    before = bench.picture().mean()
    bench.turn("shutter", "ArrowRight", 3)
    longer = bench.picture().mean()
    assert longer > 1.15 * before  # by a stop
    bench.until_text("shutter-text", lambda text: text == "Shutter 1/25 s")
    bench.turn("iso", "ArrowRight", 3)
    assert bench.picture().mean() > 1.1 * longer  # by another
    bench.until_text("iso-text", lambda text: text == "ISO 200")
    bench.turn("shutter", "ArrowLeft", 6)
    # A stop less of time for the one more of speed: the picture is as it was.
    assert bench.picture().mean() == pytest.approx(before, rel=0.03)


@pytest.mark.slow
def test_automatic_exposure_and_its_correction(bench: BenchPage) -> None:
    bench.test_id("automatic").click()
    metered = bench.picture().mean()
    bench.until_text("shutter-text", lambda text: "(automatic)" in text)
    bench.turn("iso", "ArrowRight", 6)
    assert bench.picture().mean() == pytest.approx(metered, rel=0.05)  # the time follows the speed
    bench.until_text("iso-text", lambda text: text == "ISO 400")
    correction = bench.page.get_by_label("Compensation (EV)")
    correction.fill("1")
    brighter = bench.picture().mean()
    assert brighter > 1.15 * metered  # by a stop
    correction.fill("-1")
    assert bench.picture().mean() < 0.75 * brighter  # darker by two


def test_metering_by_a_click(bench: BenchPage) -> None:
    bench.turn("shutter", "PageDown", 3)
    assert bench.picture().mean() < 20
    bench.page.get_by_role("radio", name="Meter").check()
    bench.click_picture(0.5, 0.5)
    assert bench.picture().mean() > 50
    bench.page.get_by_role("radio", name="Focus").check()  # as before, so that the next test need not load the page


def test_camera_models(bench: BenchPage) -> None:
    bench.choose("camera model", "pinhole")
    everywhere = sharp(bench.picture())
    assert min(everywhere) > 0.8 * max(everywhere)
    bench.choose("camera model", "thin lens")
    near, middle, _ = sharp(bench.picture())
    assert middle > 1.7 * near


def noise_of(status: str) -> float:
    return float(re.search(r"noise ([\d.]+) grey levels", status).group(1))


@pytest.mark.slow
def test_resolution_and_noise(bench: BenchPage) -> None:
    # With a seventh of the pixels, a frame may take more samples than 4 grey levels require, and so go below 2.
    bench.choose("resolution", "320 pixels across")
    assert bench.picture().shape == (213, 320, 3)
    assert bench.status.startswith("320 × 213")
    assert 2 < noise_of(bench.status) <= 4
    bench.choose("refine to", "2 grey levels")
    bench.picture()
    assert 0 < noise_of(bench.status) <= 2
    bench.choose("refine to", "4 grey levels (draft)")
    assert bench.picture().shape == (213, 320, 3)


def test_zoom_positions(bench: BenchPage) -> None:
    bench.choose_lens("zoom-25-50mm")
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: abs(f - 25.5) < 0.5, "the zoom is chosen")
    wide = bench.picture().astype(int)
    assert wide.shape[1] == bench_shots.WIDTH
    drawn = bench.page.locator("svg.rc-section").inner_html()
    bench.choose("zoom position", "49mm")
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: abs(f - 49) < 1, "zoomed in")
    assert bench.page.locator("svg.rc-section").inner_html() != drawn  # the groups have moved
    assert np.abs(bench.picture() - wide).mean() > 10


@pytest.mark.slow
def test_the_zoom_ring(bench: BenchPage) -> None:
    assert not bench.test_id("zoom").is_visible()
    bench.choose_lens("zoom-25-50mm")
    bench.until_text("zoom-text", lambda text: text == "Zoom 25.5 mm")
    wide = bench.picture().astype(int)
    bench.turn("zoom", "PageUp", 5)  # by tenths of its range
    middle = bench.until_text("zoom-text", lambda text: "35" in text)
    until(lambda: f"Zoom {bench.figure('effective_focal_length_mm'):g} mm", lambda text: text == middle, "drawn")
    assert np.abs(bench.picture() - wide).mean() > 10
    bench.canvas.press("Shift+Z")
    bench.until_text("zoom-text", lambda text: text < middle)
    bench.canvas.press("z")
    bench.until_text("zoom-text", lambda text: text == middle)
    ring = bench.test_id("zoom").bounding_box()
    along = [(ring["x"] + share * ring["width"], ring["y"] + 0.5 * ring["height"]) for share in (0.5, 0.7, 0.97)]
    bench.page.mouse.move(*along[0])
    bench.page.mouse.down()
    for place in along[1:]:
        bench.page.mouse.move(*place, steps=5)
    bench.page.mouse.up()
    bench.until_text("zoom-text", lambda text: text > "Zoom 47")
    bench.button("Undo").click()
    bench.until_text("zoom-text", lambda text: text == middle)  # the whole drag at once


@pytest.mark.slow
def test_a_wipe_between_two_settings(bench: BenchPage) -> None:
    bench.choose("compare", "these settings")
    before = bench.picture().mean()
    bench.turn("shutter", "ArrowRight", 6)
    wipe = bench.page.get_by_label("Position of the line between both pictures")
    wipe.fill("1")
    longer = bench.picture().mean()
    assert longer > 1.3 * before  # by four times the time
    wipe.fill("0")
    assert bench.picture().mean() == pytest.approx(before, rel=0.03)  # the settings of before
    wipe.fill("0.5")
    halves = np.split(bench.picture(), 2, axis=1)
    assert halves[0].mean() > 1.2 * halves[1].mean()
    assert np.mean([half.mean() for half in halves]) == pytest.approx((before + longer) / 2, rel=0.1)
    bench.choose("compare", "nothing")
    until(wipe.count, lambda count: count == 0, "no wipe")
    assert bench.picture().mean() == pytest.approx(longer, rel=0.03)


def test_a_thin_lens_to_compare_with(bench: BenchPage) -> None:
    before = bench.picture().mean()
    bench.choose("compare", "thin lens")
    bench.page.get_by_label("Position of the line between both pictures").fill("0")
    # It does not vignette: at the same f-number its corners are brighter.
    assert bench.picture().mean() > 1.02 * before
    bench.choose("compare", "nothing")


def test_peaking_clipping_and_the_histogram(bench: BenchPage) -> None:
    def marked() -> int:
        return bench.page.evaluate(
            """() => {
                const c = document.querySelector('.rc-marks');
                if (!c.width) return 0;
                const data = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
                return data.filter((x, i) => i % 4 == 3 && x).length;
            }"""
        )

    bench.page.get_by_label("Peaking").check()
    until(marked, lambda count: count > 100, "edges are marked")
    bench.page.get_by_label("Peaking").uncheck()
    bench.page.get_by_label("Clipping").check()
    until(marked, lambda count: count == 0, "nothing is clipped")
    bench.turn("shutter", "PageUp", 3)  # by tenths of its range
    until(marked, lambda count: count > 500, "much is clipped")
    until(lambda: bench.status, lambda text: "clipped" in text, "the status says so")
    bench.page.get_by_label("Clipping").uncheck()


SYNTHETIC = """
async ({noise, told, contrast}) => {
    const { marksOf } = await import("/realcam/exposure_marks.js");
    const width = 256, height = 192, image = new ImageData(width, height);
    let state = 1;
    const random = () => (state = (state * 1664525 + 1013904223) % 4294967296) / 4294967296;
    const gauss = () => Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
    for (let k = 0; k < width * height; ++k) {
        const isLight = ((k % width >> 4) + (Math.floor(k / width) >> 4)) % 2;
        const value = 128 + contrast * (isLight - 0.5) + noise * gauss();
        image.data.set([value, value, value, 255], 4 * k);
    }
    const marks = marksOf(image, { clipping: false, peaking: true, noise: told });
    let edges = 0, marked = 0, others = 0, wrong = 0;
    for (let y = 2; y < height - 2; ++y) for (let x = 2; x < width - 2; ++x) {
        const isEdge = [x, y].some((p) => p % 16 === 0 || p % 16 === 15), is = marks.data[4 * (y * width + x) + 3] > 0;
        if (isEdge) { edges += 1; marked += is; } else { others += 1; wrong += is; }
    }
    return [marked / edges, wrong / others];
}
"""


def test_peaking_marks_edges_and_no_noise(bench: BenchPage) -> None:
    """Normal noise exceeds four deviations in 6e-5 of the pixels, and together with neighbours in fewer."""
    for noise, told, contrast in (
        (20, [[20]], 0),
        (20, None, 130),
        (8, [[8]], 0),
        (4, [[4]], 130),
        (4, [[4, 4], [4, 4], [4, 4]], 130),
        (0, [[0]], 60),
    ):
        case = {"noise": noise, "told": told, "contrast": contrast}
        marked, wrong = bench.page.evaluate(SYNTHETIC, case)
        assert wrong < 1e-4, case
        assert marked > 0.9 if contrast and told else marked < 1e-4, case


# The lens.


def save(bench: BenchPage, what: str, name: str) -> None:
    bench.choose_what_to_save(what, name)
    bench.test_id("save").click()
    bench.until_text("said", lambda text: text == f"Wrote {name}")


def test_the_focal_length_of_an_edited_radius_is_that_of_the_lens_that_is_saved(
    bench: BenchPage, server: Server
) -> None:
    before = bench.figure("effective_focal_length_mm")
    bench.edit(0, "radius_mm", "27.5")
    shown = until(lambda: bench.figure("effective_focal_length_mm"), lambda f: abs(f - before) > 0.5, "edited")
    save(bench, "lens", "edited.toml")
    saved = rc.Lens.load(server.shot.parent / "edited.toml").first_order()
    assert shown == pytest.approx(saved.effective_focal_length_mm, abs=0.006)


def test_an_impossible_edit_and_back(bench: BenchPage) -> None:
    before = bench.picture()
    figure = bench.figure("effective_focal_length_mm")
    bench.edit(2, "radius_mm", "1")
    problem = until(lambda: bench.test_id("problem").all_text_contents(), bool, "told")[0]
    assert "surface 3" in problem
    assert bench.page.locator(".rc-table tr.rc-bad th").text_content().strip() == "3"
    assert np.array_equal(bench.picture(), before)
    assert bench.figure("effective_focal_length_mm") == figure
    bench.edit(2, "radius_mm", "19.5")
    until(bench.test_id("problem").count, lambda count: count == 0, "over")
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: f != figure, "edited")
    assert bench.page.locator(".rc-table tr.rc-bad").count() == 0


def test_undo_and_redo_by_buttons_and_keys(bench: BenchPage) -> None:
    undo, redo = (bench.button(name) for name in ("Undo", "Redo"))
    assert undo.is_disabled()
    cell = bench.cell(0, "thickness_mm")
    first = cell.input_value()
    for value in ("4", "4.5"):
        bench.edit(0, "thickness_mm", value)
        until(cell.input_value, lambda v, value=value: v == value, "edited")
        until(undo.is_enabled, bool, "can be undone")
    for action, value in (
        (undo.click, "4"),
        (lambda: bench.canvas.press("Control+z"), first),
        (redo.click, "4"),
        (lambda: bench.canvas.press("Control+y"), "4.5"),
    ):
        action()
        until(cell.input_value, lambda v, value=value: v == value, value)
    until(redo.is_disabled, bool, "nothing to redo")


@pytest.mark.slow
def test_the_film_is_in_the_drawing(bench: BenchPage) -> None:
    """However far it is behind the glass."""
    for name in ("telephoto-200mm-inner-focus", "singlet-100mm", "phone-4mm"):
        focal = rc.Lens.load(name).first_order().effective_focal_length_mm
        bench.choose_lens(name)
        until(lambda: bench.figure("effective_focal_length_mm"), lambda f, w=focal: abs(f - w) < 0.02 * w, name)
        drawing, film = (bench.page.locator(s).bounding_box() for s in ("svg.rc-section", "svg.rc-section .rc-film"))
        assert drawing["x"] <= film["x"] <= drawing["x"] + drawing["width"]
        assert drawing["y"] <= film["y"] + 1
        assert film["y"] + film["height"] <= drawing["y"] + drawing["height"] + 1


def names_in(gallery: object) -> set[str]:
    return set(gallery.locator("li button").evaluate_all("all => all.map((b) => b.ariaLabel)"))


OLD = {
    "angulon-210mm", "biotar-50mm", "heliar-100mm", "planar-50mm-1897", "sonnar-50mm", "view-camera-210mm"
}  # fmt: skip


@pytest.mark.slow
def test_lenses_are_found_in_the_gallery(bench: BenchPage) -> None:
    bench.button("Gallery").click()
    gallery = bench.test_id("gallery")
    assert names_in(gallery) == set(rc.lens_names())
    bench.test_id("gallery-search").fill("50mm GAUSS")
    assert names_in(gallery) == {"double-gauss-50mm", "double-gauss-50mm-fast"}
    bench.test_id("gallery-f-number").select_option("f/1.4 or faster")
    assert names_in(gallery) == {"double-gauss-50mm-fast"}  # f/1.45
    bench.test_id("gallery-search").fill("")
    bench.test_id("gallery-f-number").select_option("any")
    for choice, option, expected in (
        ("kind", "zoom", {name for name in rc.lens_names() if rc.Lens.load(name).zoom_positions}),
        ("focal-length", "from 135 mm", {n for n in rc.lens_names() if focal_length_mm(n) >= 135}),
        ("kind", "anamorphic", {"anamorphic-31mm", "anamorphic-65mm", "scope-adapter-50mm"}),
        ("year", "until 1949", OLD),
    ):
        bench.test_id(f"gallery-{choice}").select_option(option)
        assert names_in(gallery) == expected
        assert bench.text("gallery-count") == f"{len(expected)} of {len(rc.lens_names())}"
        bench.test_id(f"gallery-{choice}").select_option("any")
    bench.test_id("gallery-search").fill("no such lens")
    assert gallery.get_by_text("No lens matches these filters.").is_visible()
    bench.page.keyboard.press("Escape")
    assert not gallery.is_visible()
    before = bench.picture().astype(int)
    bench.button("Gallery").click()
    bench.test_id("gallery-search").fill("telephoto-250mm")
    bench.page.get_by_role("button", name="telephoto-250mm", exact=True).click()
    assert not gallery.is_visible()
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: abs(f - 250) < 5, "the lens is chosen")
    assert np.abs(bench.picture() - before).mean() > 10
    bench.button("Gallery").click()
    bench.test_id("gallery-search").fill("")
    gallery.get_by_role("button", name="Close").click()
    assert not gallery.is_visible()


def focal_length_mm(name: str) -> float:
    return float(rc.Lens.load(name).first_order().effective_focal_length_mm)


def test_the_question_mark_shows_mouse_and_keys(bench: BenchPage) -> None:
    table = bench.test_id("help")
    bench.page.keyboard.press("?")
    assert table.is_visible()
    assert "aperture ring" in table.inner_text()
    bench.page.keyboard.press("Escape")
    assert not table.is_visible()
    bench.page.get_by_role("button", name="Mouse and keys").click()
    assert table.is_visible()
    table.get_by_role("button", name="Close").click()
    bench.cell(0, "radius_mm").press("?")  # what is typed there is a number, or no number
    assert not table.is_visible()


TABS = {"Lens": "svg.rc-section", "Camera": "[data-testid=film]", "Effects": ".rc-effects", "Plots": ".rc-plot-box"}


def test_everything_is_reached_without_scrolling_far(bench: BenchPage) -> None:
    """The picture is as wide as its column, rings and panels begin in the first screen, and nothing sticks out."""
    page = bench.page
    for width, height in ((1440, 900), (1024, 768), (900, 800)):
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        picture, column = bench.canvas.bounding_box(), page.locator(".rc-column").first.bounding_box()
        assert picture["width"] == pytest.approx(column["width"], abs=1)
        assert bench.test_id("iso").bounding_box()["y"] < height
        for tab, content in TABS.items():
            page.get_by_role("tab", name=tab).click()
            box = page.locator(content).bounding_box()
            assert column["x"] + column["width"] < box["x"] < box["x"] + box["width"] <= width, tab
            assert box["y"] < height, tab
        page.get_by_role("tab", name="Lens").click()
        assert page.evaluate("document.documentElement.scrollHeight") < 2 * height


SMALL = """
() => [...document.querySelectorAll("button, input:not([type=file]), select, summary, [role=switch]")]
    .map((e) => e.closest("label, .q-field, [role=switch]") ?? e)
    .filter((e) => e.checkVisibility() && !e.closest(".hidden"))
    .map((e) => [e.outerHTML.slice(0, 120), e.getBoundingClientRect()])
    .filter(([, box]) => box.height && (box.height < 39.5 || box.width < 39.5)).map(([text]) => text)
"""


def test_on_a_telephone(bench: BenchPage) -> None:
    """The rings stand directly below the picture, the gallery has two lenses a row, fingers hit what they aim at."""
    page = bench.page
    page.set_viewport_size({"width": 390, "height": 844})
    picture, rings = bench.canvas.bounding_box(), page.locator(".rc-rings").bounding_box()
    assert 0 <= rings["y"] - picture["y"] - picture["height"] < 16
    for tab in (*TABS, "Save", "Lens"):
        page.get_by_role("tab", name=tab).click()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, tab
        assert page.evaluate(SMALL) == [], tab
    bench.button("Gallery").click()
    lefts = page.locator(".rc-gallery li").evaluate_all("all => all.map((e) => e.getBoundingClientRect().left)")
    assert len(set(lefts)) == 2
    assert page.evaluate(SMALL) == []
    page.keyboard.press("Escape")


def test_the_tabs_by_keys(bench: BenchPage) -> None:
    page = bench.page
    page.get_by_role("tab", name="Lens").focus()
    for key, shown in (("ArrowRight", "Camera"), ("ArrowLeft", "Lens"), ("ArrowLeft", "Save"), ("ArrowRight", "Lens")):
        page.keyboard.press(key)
        assert page.get_by_role("tab", selected=True).text_content() == shown
        assert page.get_by_role("tabpanel").count() == 1


def test_aspheric_coefficients_are_shown_whole(bench: BenchPage) -> None:
    bench.button("Gallery").click()
    bench.page.get_by_role("button", name="phone-4mm", exact=True).click()
    until(bench.page.locator('[data-cell*="-a"]').count, bool, "aspheric coefficients")
    cells = bench.page.locator('[data-cell*="-a"], [data-cell$="-conic"], [data-cell$="_mm"]')
    cut = cells.evaluate_all("all => all.filter((c) => c.scrollWidth > c.clientWidth).map((c) => c.value)")
    assert cut == []
    values = cells.evaluate_all("all => all.map((c) => c.value)")
    assert any("e-" in value for value in values)


@pytest.mark.slow
def test_blades_and_film_are_chosen(bench: BenchPage) -> None:
    bench.test_id("blades").fill("6")
    bench.test_id("blades").press("Enter")
    until(lambda: bench.page.evaluate("JSON.stringify(sessionStorage)"), lambda s: "blades = 6" in s, "six blades")
    bench.test_id("rounding").fill("0.5")
    bench.test_id("rounding").press("Enter")
    until(lambda: bench.page.evaluate("JSON.stringify(sessionStorage)"), lambda s: "rounding = 0.5" in s, "rounded")
    bench.test_id("blades").fill("2")
    bench.test_id("blades").press("Enter")
    until(bench.test_id("problem").count, lambda count: count == 1, "two blades are none")
    before = bench.picture().shape
    bench.choose("film", "17.3 × 13 mm (Micro Four Thirds)")
    assert bench.picture().shape[:2] == (round(120 * 13 / 17.3), 120)
    until(bench.test_id("film-width").input_value, lambda width: width == "17.3", "the film's width")
    bench.button("Undo").click()
    assert bench.picture().shape == before
    bench.test_id("film-width").fill("48")
    bench.test_id("film-width").press("Enter")
    assert bench.picture().shape[:2] == (60, 120)


def test_dragging_in_the_drawing(bench: BenchPage) -> None:
    for field in ("radius_mm", "thickness_mm", "semi_diameter_mm"):
        drag(bench, field)


def drag(bench: BenchPage, field: str) -> None:
    surface = 1 if field == "thickness_mm" else 0
    bench.cell(surface, "radius_mm").focus()
    handle = bench.page.locator(f'[data-handle="{field}"]')
    handle.scroll_into_view_if_needed()
    changed = 0  # a handle along the axis changes the thickness before its surface
    before, drawn = bench.cell(changed, field).input_value(), bench.page.locator("svg.rc-section").inner_html()
    figure = bench.figure("effective_focal_length_mm")
    box = handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    bench.page.mouse.move(x, y)
    bench.page.mouse.down()
    across, up = (0, 3) if field == "semi_diameter_mm" else (0.8, 0)  # pixels
    for step in range(1, 6):
        bench.page.mouse.move(x + across * step, y + up * step)
    bench.page.mouse.up()
    until(lambda: bench.cell(changed, field).input_value(), lambda value: value != before, "dragged")
    assert bench.page.locator("svg.rc-section").inner_html() != drawn
    if field != "semi_diameter_mm":
        until(lambda: bench.figure("effective_focal_length_mm"), lambda f: f != figure, "the figures")
    bench.button("Undo").click()  # all of the drag in one step
    until(lambda: bench.cell(changed, field).input_value(), lambda value: value == before, "undone")


def test_surfaces_are_inserted_and_deleted(bench: BenchPage) -> None:
    rows = bench.page.locator(".rc-table tbody tr")
    count = rows.count()
    bench.page.get_by_label("Insert a plate before surface 1", exact=True).click()
    until(rows.count, lambda now: now == count + 2, "a plate")
    bench.page.get_by_label("Delete surface 1", exact=True).click()
    until(rows.count, lambda now: now == count + 1, "a surface less")
    bench.button("Undo").click()
    until(rows.count, lambda now: now == count + 2, "undone")


def test_switching_an_effect_off_removes_it(bench: BenchPage) -> None:
    """The colours of a single lens, whose focal length is another for each."""
    bench.choose_lens("singlet-100mm")

    def colour(p: np.ndarray) -> float:
        """Mean difference of red and blue over blocks of 4 x 4 pixels; noise of 4 codes in each channel gives 1.1."""
        inner = p[8:-8, 8:-8].astype(float)
        return float(np.abs((inner[..., 0] - inner[..., 2]).reshape(16, 4, 26, 4).mean(axis=(1, 3))).mean())

    grey = colour(bench.picture())
    bench.revealed(bench.page.locator('[data-effect="dispersion"]')).select_option("on")
    assert colour(bench.picture()) > grey + 2.5
    bench.revealed(bench.page.locator('[data-effect="dispersion"]')).select_option("off")
    assert colour(bench.picture()) < grey + 1


def test_rays_of_the_point_under_the_mouse(bench: BenchPage) -> None:
    def rays() -> str:
        return str(bench.page.locator(".rc-rays-1").evaluate_all("g => g.map(e => e.innerHTML)"))

    bench.picture()
    before = rays()
    bench.hover(0.6, 0.5)
    until(rays, lambda now: now != before, "other rays")


def plot(bench: BenchPage) -> str:
    """SVG of the plot that is shown; empty while one is being drawn."""
    return "" if bench.test_id("plot-busy").is_visible() else str(bench.test_id("plot-svg").inner_html())


@pytest.mark.slow
def test_a_plot_is_of_its_title_and_of_the_lens_as_it_stands(bench: BenchPage) -> None:
    first = until(lambda: plot(bench), lambda svg: "<svg" in svg, "a plot")
    # The page itself notes what is shown while it is busy, which may be for less time than between two looks of a test.
    bench.page.evaluate(
        """() => {
            const [busy, svg] = ["busy", "svg"].map((name) => document.querySelector(`[data-testid="plot-${name}"]`));
            window.whileBusy = [];
            new MutationObserver(() => {
                if (!busy.classList.contains("hidden")) window.whileBusy.push(svg.innerHTML);
            }).observe(busy, { attributes: true });
        }"""
    )
    bench.choose("plot", "MTF")
    of_mtf = until(lambda: plot(bench), lambda svg: "<svg" in svg and shapes(svg) != shapes(first), "the MTF")
    while_busy = bench.page.evaluate("window.whileBusy")
    assert while_busy
    assert "<svg" not in while_busy[-1]  # nothing old under the new title
    before = bench.figure("effective_focal_length_mm")
    bench.edit(0, "radius_mm", "27.5")
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: abs(f - before) > 0.5, "edited")
    until(lambda: shapes(plot(bench)), lambda now: now and now != shapes(of_mtf), "of the edited lens")
    bench.button("Undo").click()
    until(lambda: shapes(plot(bench)), lambda now: now == shapes(of_mtf), "of the lens as before")


def shapes(svg: str) -> list[str]:
    """The paths of a plot, without names, which are drawn by lot."""
    return re.findall(r' d="([^"]*)"', svg)


@pytest.mark.slow
def test_a_closer_look(bench: BenchPage) -> None:
    until(lambda: plot(bench), lambda svg: "<svg" in svg, "a plot")
    for title in ("Ray fan", "MTF", "Distortion", "Relative illumination", "Pupil shapes"):
        before = bench.test_id("plot-svg").inner_html()
        bench.choose("plot", title)
        until(lambda: bench.test_id("plot-svg").inner_html(), lambda now, b=before: now != b, title)
        assert "rc-problem" not in bench.test_id("plot-svg").inner_html()
    bench.click_picture(0.1, 0.1)
    bench.until_text("plot-point", lambda text: "17.3 mm" in text)  # 0.4 of 36 and of 24 mm


# Files.


@pytest.mark.slow
def test_saving(bench: BenchPage, server: Server) -> None:
    bench.turn("aperture", "ArrowRight", 6)
    bench.until_text("aperture-text", lambda text: text == "Aperture f/4")
    for suffix in ("png", "jpg", "exr", "dng"):
        save(bench, "picture", f"saved.{suffix}")
        assert (server.shot.parent / f"saved.{suffix}").stat().st_size > 1000
    save(bench, "shot", "saved.toml")
    shot = rc.Shot.load(server.shot.parent / "saved.toml")
    assert shot.camera.lens.first_order().f_number == pytest.approx(4, rel=0.05)
    for name, why in (
        ("../outside.png", "outside the folders"),
        ("/tmp/outside.png", "outside the folders"),
        ("", "expected"),
        ("x" * 300 + ".png", "too long"),
    ):
        bench.choose_what_to_save("picture", name)

        def answer() -> str:
            """Message after another click, as by a user who sees no reaction; each is refused alike."""
            bench.test_id("save").click()
            return bench.text("said")

        until(answer, lambda text, why=why: why in text, f"why {name} is refused")
    save(bench, "picture", "again.png")
    assert not (server.shot.parent.parent / "outside.png").exists()


@pytest.mark.filterwarnings("ignore:not in the file")
@pytest.mark.slow
def test_the_button_asks_for_a_lens_file(bench: BenchPage, tmp_path: Path) -> None:
    (tmp_path / "mine.jpg").write_text("nonsense\n")
    for name in ("mine.jpg", "mine.zmx", "mine.seq", "mine.toml"):
        is_lens = name != "mine.jpg"
        if is_lens:
            rc.Lens.load("heliar-100mm").save(tmp_path / name)
        with bench.page.expect_file_chooser() as asked:
            bench.button("Open a lens file").click()
        asked.value.set_files(tmp_path / name)
        if is_lens:
            bench.until_text("said", lambda text, name=name: text == f"Opened {name}")
        else:
            bench.page.get_by_text("Not opened: expected a lens file").wait_for()


def test_one_file_is_opened_twice(bench: BenchPage, tmp_path: Path) -> None:
    """The file changes in between, as by an edit in another program: the second time its new content is read."""
    file = tmp_path / "mine.toml"
    for name in ("heliar-100mm", "tessar-50mm", "tessar-50mm"):
        rc.Lens.load(name).save(file)
        focal = rc.Lens.load(name).first_order().effective_focal_length_mm
        before = bench.figure("effective_focal_length_mm")
        with bench.page.expect_file_chooser() as asked:
            bench.button("Open a lens file").click()
        asked.value.set_files(file)
        until(lambda: bench.figure("effective_focal_length_mm"), lambda f, w=focal: abs(f - w) < 0.1, name)
        bench.until_text("said", lambda text: text == "Opened mine.toml")
        if abs(before - focal) < 0.1:
            assert bench.page.get_by_text("Not opened").count() == 0


def test_what_is_no_lens_file_is_told(bench: BenchPage, tmp_path: Path) -> None:
    before = bench.figure("effective_focal_length_mm")
    (tmp_path / "mine.zmx").write_text("nonsense\n")
    bench.page.locator("[data-testid=upload] input[type=file]").set_input_files(tmp_path / "mine.zmx")
    said = bench.until_text("said", lambda text: "mine.zmx" in text)
    assert "Opened" not in said
    assert "/tmp" not in said
    assert bench.figure("effective_focal_length_mm") == before


@pytest.mark.slow
def test_a_page_that_is_loaded_again_brings_back_what_it_had(bench: BenchPage) -> None:
    before = bench.figure("effective_focal_length_mm")
    bench.edit(0, "radius_mm", "27.5")
    edited = until(lambda: bench.figure("effective_focal_length_mm"), lambda f: abs(f - before) > 0.5, "edited")
    correction = bench.page.get_by_label("Compensation (EV)")
    correction.fill("-1")
    until(
        lambda: bench.page.evaluate("Object.values(sessionStorage).join()"),
        lambda kept: "27.5" in kept and '"compensation_ev":-1' in kept,
        "kept",
    )
    bench.page.reload()
    bench.until_there()
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: f == edited, "edited as before")
    until(correction.input_value, lambda value: value == "-1.00", "corrected as before")
    with bench.page.expect_navigation():
        bench.page.get_by_role("button", name="Start again").click()
    bench.until_there()
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: f == before, "as the shot file has it")


def test_the_magnifier_enlarges_what_the_page_shows(bench: BenchPage) -> None:
    """Four times as large as on the page: the middle of the magnifier is one colour where a pixel is that large."""
    bench.picture()
    bench.page.get_by_label("Magnifier").check()
    box = bench.canvas.bounding_box()
    bench.hover(0.5, 0.5)
    # The page shows a pixel as box.width / its width pixels, the magnifier as four times as many.
    seen = bench.page.evaluate(
        """() => {
            const c = document.querySelector('.rc-magnifier'), middle = c.width / 2;
            return Array.from(c.getContext('2d').getImageData(0, middle, c.width, 1).data);
        }"""
    )
    row = np.array(seen).reshape(-1, 4)[:, :3]
    side = 4 * box["width"] / bench_shots.WIDTH
    assert len(np.unique(row, axis=0)) <= len(row) / side + 2
    bench.page.get_by_label("Magnifier").uncheck()


# Without a mouse.


@pytest.mark.slow
def test_the_keyboard_alone(bench: BenchPage) -> None:
    page = bench.page
    reached = set()
    for _ in range(40):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.className.toString()"))
        if any("rc-canvas" in name for name in reached):
            break
    else:
        raise AssertionError(f"the picture is not reached: {reached}")
    page.keyboard.press("]")
    bench.until_text("aperture-text", lambda text: text == "Aperture f/2.2")
    page.keyboard.press("[")
    bench.until_text("aperture-text", lambda text: text == "Aperture f/2.03")
    page.keyboard.press(".")
    bench.until_text("shutter-text", lambda text: text == "Shutter 1/40 s")
    page.keyboard.press("i")
    bench.until_text("iso-text", lambda text: text == "ISO 125")
    page.keyboard.press("Shift+I")
    bench.until_text("iso-text", lambda text: text == "ISO 100")
    before = bench.picture().astype(int)
    for key in ("ArrowLeft", "ArrowUp", "Shift+ArrowRight", "+", "-", "+"):
        page.keyboard.press(key)
        after = bench.picture().astype(int)
        assert np.abs(after - before).mean() > 10, key
        before = after
    page.keyboard.press("f")
    bench.until_text("focus-text", lambda text: text != "Focus 1.2 m")
    for _ in range(9):
        page.keyboard.press(".")
    bench.until_text("shutter-text", lambda text: text == "Shutter 1/5 s")
    page.keyboard.press("m")
    bench.until_text("shutter-text", lambda text: text != "Shutter 1/5 s")


@pytest.mark.slow
def test_a_click_soon_after_a_movement_focuses(bench: BenchPage) -> None:
    """While the first frame of all pixels is taken, which here takes a second or more."""
    bench.choose("resolution", "1920 pixels across")
    until(lambda: bench.shown().shape[1], lambda width: width == 1920, "the size")
    for wait_s, u, distance in ((0.3, 1 / 6, 0.6), (0.9, 5 / 6, 20.0)):
        box = bench.canvas.bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        bench.page.mouse.move(x, y)
        bench.page.mouse.down()
        for step in range(8):
            bench.page.mouse.move(x + 3 * (step % 2), y + step)
            time.sleep(0.02)
        bench.page.mouse.move(x, y)
        bench.page.mouse.up()
        time.sleep(wait_s)
        bench.click_picture(u, 0.5)

        def is_near(text: str, expected: float = distance) -> bool:
            return abs(float(text.split()[1]) - expected) < 0.1 * expected

        bench.until_text("focus-text", is_near)
        assert bench.test_id("problem").count() == bench.test_id("picture-problem").count() == 0


def test_the_mouse_moves_the_camera(bench: BenchPage) -> None:
    before = bench.picture().astype(int)
    box = bench.canvas.bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    focus = bench.text("focus-text")
    bench.page.mouse.move(*middle)
    bench.page.mouse.down()
    bench.page.mouse.move(middle[0] + 60, middle[1] + 20, steps=5)
    bench.page.mouse.up()
    moved = bench.picture().astype(int)
    assert np.abs(moved - before).mean() > 10
    assert bench.text("focus-text") == focus  # no click
    bench.page.mouse.wheel(0, -300)
    assert np.abs(bench.picture() - moved).mean() > 10  # nearer
