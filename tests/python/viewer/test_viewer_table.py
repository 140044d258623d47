"""The table of the lens, while the user types into it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")

from .bench_pages import CHROMIUM, BenchPage, until

pytestmark = [
    pytest.mark.picture_files,
    pytest.mark.skipif(CHROMIUM is None, reason="no chromium"),
]


def test_what_is_being_typed_stays_while_the_lens_changes(bench: BenchPage) -> None:
    cell = bench.cell(0, "radius_mm")
    cell.fill("27.")
    bench.send({"type": "edit", "surface": 1, "field": "thickness_mm", "value": 0.2})
    until(lambda: bench.cell(1, "thickness_mm").input_value(), lambda v: v == "0.2", "another surface")
    assert cell.input_value() == "27."
    cell.press_sequentially("5")
    cell.press("Enter")
    until(lambda: bench.cell(0, "radius_mm").input_value(), lambda v: v == "27.5", "edited")


HOLD_LENSES = """
() => {
    const stream = [...realcamStreams.values()][0], notify = stream.notify.bind(stream), held = [];
    stream.notify = (type, message) => (type === "lens" ? held.push(message) : notify(type, message));
    window.releaseLenses = () => { delete stream.notify; held.forEach((view) => notify("lens", view)); };
}
"""


def test_what_was_entered_stays_until_the_server_has_answered(bench: BenchPage) -> None:
    """Text typed then replaces the selection, although the answer redraws the cell."""
    cell = bench.cell(0, "thickness_mm")
    bench.page.evaluate(HOLD_LENSES)
    cell.fill("4.20")
    cell.press("Enter")
    bench.page.wait_for_timeout(100)
    assert cell.input_value() == "4.20"
    bench.picture()  # by now the answer is there
    cell.press("Control+a")
    bench.page.evaluate("releaseLenses()")
    until(cell.input_value, lambda value: value == "4.2", "as the table writes it")
    cell.press_sequentially("4.5")
    assert cell.input_value() == "4.5"
    cell.press("Enter")
    until(bench.button("Undo").is_enabled, bool, "edited")
    bench.button("Undo").click()
    until(cell.input_value, lambda value: value == "4.2", "undone")


def test_what_cannot_be_stays_to_be_mended_until_its_cell_is_left(bench: BenchPage) -> None:
    cell = bench.cell(2, "radius_mm")
    before = cell.input_value()
    bench.edit(2, "radius_mm", "1")
    bench.test_id("problem").wait_for()
    assert cell.input_value() == "1"
    cell.press("Tab")
    until(cell.input_value, lambda value: value == before, "as the lens has it")


def test_another_copy_is_of_the_grade_that_is_chosen(bench: BenchPage) -> None:
    """A radius is within the grade's 0.5% or 0.01% of that of the drawing (test_viewer_bench.py has more)."""
    cell, button = bench.cell(0, "radius_mm"), bench.button("Make a production sample")

    def after(action: Callable[[], None]) -> str:
        before = cell.input_value()
        action()
        return until(cell.input_value, lambda value: value != before, "another lens")

    drawn, picture = cell.input_value(), bench.picture()
    commercial = after(button.click)
    assert float(commercial) == pytest.approx(float(drawn), rel=5.01e-3)
    assert np.abs(bench.picture().astype(float) - picture).max() > 8
    assert bench.page.get_by_role("img", name="Section of").is_visible()
    bench.page.get_by_label("Tolerance class").select_option("high")
    assert float(after(button.click)) == pytest.approx(float(drawn), rel=1.01e-4)
    assert after(bench.button("Undo").click) == commercial
