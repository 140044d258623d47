"""The lens bench against the rules of WCAG 2.2, levels A and AA, that axe-core can look at: contrast, names, roles."""

from __future__ import annotations

import pytest

pytest.importorskip("nicegui")
playwright = pytest.importorskip("playwright.sync_api")
axe = pytest.importorskip("axe_playwright_python.sync_playwright")

from .bench_pages import CHROMIUM, BenchPage, until  # noqa: E402

pytestmark = [pytest.mark.picture_files, pytest.mark.skipif(CHROMIUM is None, reason="no chromium")]

RULES = {"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"], "resultTypes": ["violations"]}
THEMES = ("Light", "Dark")
SIZES = ((1400, 1000), (390, 800))  # of a desktop and of a telephone


def check(bench: BenchPage) -> None:
    found = [
        f"{rule['id']}: {node['html'][:200]}\n{node['failureSummary']}"
        for rule in axe.Axe().run(bench.page, options=RULES).response["violations"]
        for node in rule["nodes"]
    ]
    if found:
        pytest.fail("\n\n".join(found), pytrace=False)


def use(bench: BenchPage, theme: str) -> None:
    bench.test_id("theme").get_by_text(theme).click()
    until(
        lambda: "body--dark" in (bench.page.locator("body").get_attribute("class") or ""),
        lambda is_dark: is_dark == (theme == "Dark"),
        f"the {theme} page",
    )
    bench.page.wait_for_timeout(500)  # colours change by and by


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("theme", THEMES)
def test_the_page_follows_the_rules(bench: BenchPage, theme: str, size: tuple[int, int]) -> None:
    bench.page.set_viewport_size({"width": size[0], "height": size[1]})
    use(bench, theme)
    check(bench)


@pytest.mark.parametrize("theme", THEMES)
def test_so_does_a_page_that_tells_of_a_problem(bench: BenchPage, theme: str) -> None:
    use(bench, theme)
    bench.edit(1, "radius_mm", "1")
    bench.test_id("problem").wait_for()
    check(bench)


@pytest.mark.parametrize("theme", THEMES)
def test_so_does_the_gallery(bench: BenchPage, theme: str) -> None:
    use(bench, theme)
    bench.page.get_by_role("button", name="Gallery").click()
    bench.page.locator(".rc-gallery img").first.wait_for()
    bench.page.wait_for_timeout(500)  # it is faded in
    check(bench)
