"""The devices that the tests render with, and signals as a terminal's programs have them."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Iterator
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import pytest
import realcam as rc
from realcam_command.main import main

if TYPE_CHECKING:
    from .bench_pages import BenchPage, Server
    from .programs import Command

# A shell's background jobs ignore Ctrl-C, and so would the programs that tests start and interrupt.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(params=sorted({device.name.split(":")[0] for device in rc.devices()}))
def device(request: pytest.FixtureRequest) -> str:
    """cpu, and cuda where this machine has a GPU, in turn: `device` of rc.render."""
    return str(request.param)


@pytest.fixture
def backend(device: str) -> str:
    """What a measurement calls it."""
    return {"cpu": "Embree", "cuda": "CUDA"}.get(device, device)


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Command:
    """`realcam WORDS...` in this process: one of its own takes half a second to start."""

    def run(*words: object) -> subprocess.CompletedProcess[str]:
        monkeypatch.setattr("sys.argv", ["realcam", *map(str, words)])
        handler = signal.getsignal(signal.SIGINT)
        try:
            with pytest.raises(SystemExit) as ended:
                main()
        finally:
            signal.signal(signal.SIGINT, handler)
        return subprocess.CompletedProcess(words, int(ended.value.code or 0), *capfd.readouterr())

    return run


# What tests of the lens bench share; those that ask for it say where nicegui, playwright or chromium is missing.
# Servers, browsers and their first pages take seconds to begin.


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
    """Of a bench that shows the server's shot."""
    from realcam.viewer.bench_state import state_of
    from realcam.viewer.camera_controls import CameraControls
    from realcam.viewer.effect_switches import Switches

    shot = rc.Shot.load(server.shot)
    return state_of(CameraControls.of(shot.camera), Switches.of_shot(shot.settings.effects).of)


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


def pytest_runtest_setup(item: pytest.Item) -> None:
    if item.get_closest_marker("picture_files"):
        if not hasattr(rc._core, "_read_film"):
            pytest.skip("this build of realcam has no picture files")
        if find_spec("OpenImageIO") is None:
            pytest.skip("picture files need the package OpenImageIO")
