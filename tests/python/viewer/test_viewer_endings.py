"""How the lens bench's server and its processes end, and what they do to each other."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("nicegui")
playwright = pytest.importorskip("playwright.sync_api")

from . import bench_shots  # noqa: E402
from .bench_pages import CHROMIUM, BenchPage, Server, fetch, served_panels, until  # noqa: E402
from .processes import is_there  # noqa: E402

pytestmark = [pytest.mark.picture_files, pytest.mark.skipif(CHROMIUM is None, reason="no chromium")]


def workers(server: Server) -> list[int]:
    found = []
    for line in subprocess.check_output(["ps", "-e", "-ww", "-o", "pid=,ppid=,args="], text=True).splitlines():
        pid, parent, command = line.split(maxsplit=2)
        if int(parent) == server.process.pid and "spawn_main" in command:
            found.append(int(pid))
    return found


def threads(server: Server) -> int:
    return len(list(Path(f"/proc/{server.process.pid}/task").iterdir()))


def has_plot(bench: BenchPage) -> bool:
    return "<svg" in bench.test_id("plot-svg").inner_html()


@pytest.fixture
def own(tmp_path: Path) -> Iterator[Server]:
    yield from served_panels(tmp_path, width=240)


@pytest.fixture
def forgetful(tmp_path: Path) -> Iterator[Server]:
    """Keeps a window whose page has gone for three seconds only."""
    yield from served_panels(tmp_path, reconnect_s=3)


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_it_ends_at_once_and_nothing_is_left(browser: playwright.Browser, own: Server, end: signal.Signals) -> None:
    """A page is open, and the server plots, plans, measures and refines for it."""
    bench = BenchPage(browser, own.url)
    try:
        until(lambda: workers(own), lambda found: len(found) == 2, "both processes")
        bench.choose("refine to", "half a grey level (fine)")
        bench.choose("plot", "MTF")
        bench.button("Measure the levels of simulation").click()
        time.sleep(0.5)
        left = workers(own)
        own.process.send_signal(end)
        # Ending takes 0.3 s on a quiet machine; the former fault made it wait for the work in progress.
        own.process.wait(6)
        until(lambda: [pid for pid in left if is_there(pid)], lambda pids: not pids, "processes are left", 6)
    finally:
        bench.context.close()  # without a look at what the browser says, which is that nobody answers


def test_a_plotting_process_that_is_killed_comes_again(bench: BenchPage, server: Server) -> None:
    until(lambda: has_plot(bench), bool, "the first plot")
    for title in ("MTF", "Distortion"):
        for pid in workers(server):
            os.kill(pid, signal.SIGKILL)
        bench.choose("plot", title)
        bench.test_id("plot-busy").wait_for(state="hidden")
        until(lambda: has_plot(bench), bool, title)


def test_a_plot_that_is_not_done_keeps_nobody(browser: playwright.Browser, forgetful: Server) -> None:
    """The plot belongs to a window that is closed meanwhile."""
    bench, other = BenchPage(browser, forgetful.url), BenchPage(browser, forgetful.url)
    stopped: list[int] = []
    try:
        until(lambda: has_plot(other), bool, "the first plot")
        stopped = workers(forgetful)
        for pid in stopped:
            os.kill(pid, signal.SIGSTOP)  # as on a machine that is busy
        other.choose("plot", "Ray fan")
        other.test_id("plot-busy").wait_for()
        before = threads(forgetful)
        other.close()

        def answered() -> int:
            begun = time.monotonic()
            fetch(f"{forgetful.url}realcam/page.css", 10)
            assert time.monotonic() - begun < 5
            return threads(forgetful)

        # A window has ten threads; the one that waits for the plot remains.
        until(answered, lambda now: now < before - 5, "the window is closed")
        for _ in range(3):
            answered()
            time.sleep(0.5)
        text = bench.text("iso-text")
        bench.turn("iso", "ArrowRight", 3)
        bench.until_text("iso-text", lambda now: now != text)
    finally:
        for pid in stopped:
            os.kill(pid, signal.SIGCONT)
        bench.close()


def test_lens_files_that_hurt_their_reader_keep_nobody(bench: BenchPage, tmp_path: Path) -> None:
    for name, content in (
        ("dots.toml", b"a." * 500_000 + b"b = 1"),
        ("ampersands.seq", b"RDM;LEN\n" + b"x&\n" * 600_000),
    ):
        (tmp_path / name).write_bytes(content)
        bench.page.locator("[data-testid=upload] input[type=file]").set_input_files(tmp_path / name)
        before = bench.text("iso-text")
        bench.turn("iso", "ArrowRight")
        bench.until_text("iso-text", lambda text, before=before: text != before)
        bench.until_text("said", lambda text, name=name: name in text and "Opened" not in text)


def test_a_port_in_use_is_told_in_one_line(tmp_path: Path) -> None:
    shot = bench_shots.write_panels_shot(tmp_path)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        command = [sys.executable, "-m", "realcam", "view", str(shot), "--no-browser", "--port", str(port)]
        ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert ended.returncode == 2
    assert ended.stdout == ""
    assert len(ended.stderr.splitlines()) == 1
    assert f"127.0.0.1:{port}" in ended.stderr
    assert "in use" in ended.stderr


def test_what_is_no_event_of_a_page_is_one_line_of_the_log(server: Server) -> None:
    websockets = pytest.importorskip("websockets.sync.client")
    page = fetch(server.url).decode()
    client = page.split("/_nicegui/client/")[1].split("/")[0]
    address = f"ws://127.0.0.1:{server.port}/_nicegui_ws/socket.io/?client_id={client}&EIO=4&transport=websocket"
    address += "&document_id=d&tab_id=t&next_message_id=0&implicit_handshake=true"
    with websockets.connect(address, proxy=None) as line:
        line.recv(timeout=30)
        line.send("40")
        line.recv(timeout=30)
        for k in range(60):
            event = f'{{"id":{k},"client_id":"{client}","listener_id":"x","args":["\\"\\\\ud800"]}}'
            line.send(f'42["event",{event}]')
        line.send('42["event",{}]')
        line.send('42["handshake",5]')
        time.sleep(1)
    until(lambda: server.said, lambda said: "could not be understood" in said, "one line")
