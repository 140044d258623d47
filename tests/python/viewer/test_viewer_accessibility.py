"""The lens bench against the rules of WCAG 2.2, levels A and AA, that axe-core can look at: contrast, names, roles."""

from __future__ import annotations

import pytest

pytest.importorskip("nicegui")
playwright = pytest.importorskip("playwright.sync_api")
axe = pytest.importorskip("axe_playwright_python.sync_playwright")

from .bench_pages import CHROMIUM, VIEWPORT, BenchPage, until  # noqa: E402

pytestmark = [pytest.mark.picture_files, pytest.mark.skipif(CHROMIUM is None, reason="no chromium")]

RULES = {"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"], "resultTypes": ["violations"]}
THEMES = ("Light", "Dark")


def check(bench: BenchPage) -> None:
    # Quasar's bar, which has no name, for the requests of the page's first second.
    bench.page.locator(".q-loading-bar[role=progressbar]").wait_for(state="detached")
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


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.slow
def test_the_page_follows_the_rules(bench: BenchPage, theme: str) -> None:
    """Checks the page at telephone size, on a desktop while it reports a problem, and with the gallery open."""
    bench.page.set_viewport_size({"width": 390, "height": 800})
    use(bench, theme)
    check(bench)
    bench.page.set_viewport_size(VIEWPORT)
    bench.edit(1, "radius_mm", "1")
    bench.test_id("problem").wait_for()
    check(bench)
    # Blank pictures replace the drawings of lenses: their content does not matter, and drawing all takes some seconds.
    blank = {"body": '<svg xmlns="http://www.w3.org/2000/svg"/>', "content_type": "image/svg+xml"}
    bench.page.route("**/realcam-lenses/*", lambda route: route.fulfill(**blank))
    bench.button("Gallery").click()
    bench.page.locator(".rc-gallery img").first.wait_for()
    bench.page.wait_for_timeout(500)  # it is faded in
    check(bench)
    bench.page.unroute_all()
