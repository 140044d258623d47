"""Fixtures of the tests of the lens bench. A test that uses one says if nicegui, playwright or chromium is missing.

Servers, browsers and their first pages take seconds to begin.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from typing import TYPE_CHECKING, Any

import pytest
import realcam as rc

if TYPE_CHECKING:
    from realcam.viewer.lens_bench import LensBench

    from .bench_pages import BenchPage, Server
    from .watched_loop import Watched


@pytest.fixture
def bench_of() -> Iterator[Callable[..., LensBench]]:
    """Benches of shots, which are closed when the test ends."""
    from realcam.viewer.lens_bench import LensBench

    with ExitStack() as made:
        yield lambda shot, **options: made.enter_context(closing(LensBench(shot, device="cpu", **options)))


@pytest.fixture(scope="session")
def spheres() -> rc.Scene:
    from frame_scene import frame_scene

    return frame_scene(spheres=5, boxes=5)


@pytest.fixture
def watched(spheres: rc.Scene) -> Iterator[Watched]:
    from .watched_loop import Watched

    made = Watched(spheres)
    yield made
    made.loop.close()


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """`realcam view` on a shot of three panels."""
    from .bench_pages import served_panels

    yield from served_panels(tmp_path_factory.mktemp("bench"))


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """While it is there its loop counts as running on this thread: asyncio.run needs another (run_apart)."""
    from playwright.sync_api import sync_playwright

    from .bench_pages import launched

    with sync_playwright() as driver:
        yield from launched(driver)


@pytest.fixture(scope="session")
def kept_page(browser: Any) -> Iterator[BenchPage]:
    """Opened by each test, so that a server that fails one fails no other."""
    from .bench_pages import BenchPage

    page = BenchPage(browser)
    yield page
    page.context.close()  # each test has checked it; the server may be gone by now


@pytest.fixture(scope="session")
def first_state(server: Server) -> dict[str, Any]:
    """The state of a bench that shows the server's shot, before any change."""
    from realcam.viewer.bench_state import state_of
    from realcam.viewer.camera_controls import CameraControls
    from realcam.viewer.effect_switches import Switches

    shot = rc.Shot.load(server.shot)
    return state_of(CameraControls.of(shot.camera), Switches.from_shot(shot.settings.effects).states)


@pytest.fixture
def bench(
    kept_page: BenchPage, server: Server, first_state: dict[str, Any], request: pytest.FixtureRequest
) -> Iterator[BenchPage]:
    """A page of it that looks as at first, with a window of its own on the server; perhaps that of the test before."""
    if not (kept_page.first_look and kept_page.bring_back(first_state)):
        kept_page.open_anew(server.url)
    first_look, kept_page.first_look = kept_page.first_look, None
    failed = request.session.testsfailed
    yield kept_page
    kept_page.check()
    assert server.complaints() == [], server.complaints()
    if request.session.testsfailed == failed:
        kept_page.first_look = first_look
