"""The server of the lens bench: slow links, lost connections, strangers, several windows, and rest."""

from __future__ import annotations

import random
import socket
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("nicegui")
playwright = pytest.importorskip("playwright.sync_api")
websockets = pytest.importorskip("websockets.sync.client")

from websockets.exceptions import ConnectionClosed, InvalidStatus  # noqa: E402

from . import bench_shots  # noqa: E402
from .bench_pages import CHROMIUM, BenchPage, Server, fetch, served_panels, until  # noqa: E402

pytestmark = [pytest.mark.picture_files, pytest.mark.skipif(CHROMIUM is None, reason="no chromium")]


@pytest.fixture
def own(tmp_path: Path) -> Iterator[Server]:
    """A server for one test, which is stopped also where closing a page of it finds something wrong."""
    yield from served_panels(tmp_path, width=240)


@pytest.fixture
def own_without_pools(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    """Like `own`, but glibc returns freed memory, so that the process's memory is the memory in use.

    Otherwise tables of 12 MB leave holes in the heaps of the server's threads, which may grow by up to 65 MB.
    """
    monkeypatch.setenv("GLIBC_TUNABLES", "glibc.malloc.arena_max=1:glibc.malloc.mmap_threshold=262144")
    yield from served_panels(tmp_path, width=240)


def stream_path(bench: BenchPage) -> str:
    return str(bench.page.evaluate("[...window.realcamStreams.keys()][0]"))


def stream(server: Server, path: str, **options: object) -> websockets.ClientConnection:
    address = f"{server.url.replace('http', 'ws')}{path.lstrip('/')}"
    return websockets.connect(address, max_size=1 << 26, proxy=None, **options)


@pytest.mark.slow
def test_two_windows_do_not_disturb_each_other(browser: playwright.Browser, server: Server, bench: BenchPage) -> None:
    before, focal = bench.picture().mean(), bench.figure("effective_focal_length_mm")
    other = BenchPage(browser, server.url)
    try:
        other.edit(0, "radius_mm", "27")
        other.turn("shutter", "ArrowRight", 6)
        until(lambda: other.figure("effective_focal_length_mm"), lambda f: f != focal, "edited")
        assert other.picture().mean() > 1.2 * before
        assert bench.figure("effective_focal_length_mm") == focal
        assert bench.picture().mean() == pytest.approx(before, rel=0.02)
        assert bench.text("shutter-text") == "Shutter 1/50 s"
    finally:
        other.close()
    bench.turn("shutter", "ArrowRight", 3)  # and lives on when the other has gone
    assert bench.picture().mean() > 1.1 * before


MALFORMED = [  # test_viewer_messages.py has more
    "nonsense",
    '{"type": "orbit", "x": NaN, "y": 0}',
    '{"type": "turn", "ring": "barrel", "steps": 1}',
    b"\x00\x01\x02",
    "[" * 60_000,
    "x" * 100_000,  # more than a message may have
    "x" * 3_000_000,  # more than the server reads
]


def test_malformed_messages_end_the_connection_and_no_more(bench: BenchPage, server: Server) -> None:
    path = stream_path(bench)
    # One page at a time has a window's stream: this one does not take it back from the stranger meanwhile.
    bench.page.evaluate("[...window.realcamStreams.values()][0].connect = () => {}")
    for message in MALFORMED:
        with pytest.raises(ConnectionClosed) as end, stream(server, path) as line:
            line.send(message)
            for _ in range(1000):
                line.recv(timeout=30)
        assert end.value.rcvd is not None, message[:80]
        assert end.value.rcvd.code in (1008, 1009), message[:80]
    bench.page.evaluate("() => { const s = [...window.realcamStreams.values()][0]; delete s.connect; s.connect(); }")
    until(lambda: bench.page.locator(".rc-lost").count(), lambda count: count == 0, "the page comes back")
    bench.picture()
    assert server.process.poll() is None


@pytest.mark.slow
def test_a_page_can_be_loaded_again_and_again(bench: BenchPage, server: Server) -> None:
    """Oftener than windows are kept at once: those whose page has gone make room."""
    for _ in range(5):  # of which the server keeps four, and one is there before
        bench.page.goto(server.url)
        assert not bench.page.get_by_text("Too many windows").is_visible()
    bench.until_there()
    bench.picture()


def test_addresses_that_lead_elsewhere(server: Server) -> None:
    for path in (
        "realcam/../../../../etc/passwd",
        "realcam/%2e%2e/%2e%2e/server.py",
        "realcam/..%2f..%2fserver.py",
        "realcam//etc/passwd",
        "../server.py",
        "realcam/page.css/../../server.py",
    ):
        with socket.create_connection(("127.0.0.1", server.port), 20) as line:  # as it is: clients tidy paths up
            line.sendall(f"GET /{path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode())
            answer = b"".join(iter(lambda: line.recv(65536), b""))
        assert answer.split()[1] in (b"404", b"403", b"400"), path
        assert b"root:" not in answer
        assert b"def serve" not in answer


def test_what_is_no_http(server: Server) -> None:
    for garbage in (b"\x00" * 1000, b"GET\r\n\r\n", b"GET / HTTP/1.1\r\n" + b"x: y\r\n" * 20_000 + b"\r\n"):
        with socket.create_connection(("127.0.0.1", server.port), 20) as line:
            try:
                line.sendall(garbage)
                line.shutdown(socket.SHUT_WR)
                while line.recv(65536):
                    pass
            except OSError:
                continue
    assert server.answers()


@pytest.mark.slow
def test_requests_that_are_left_are_no_errors(browser: playwright.Browser, server: Server) -> None:
    """Requests are abandoned as by a page that is closed while it loads."""
    paths = ["", "realcam-lenses/fisheye-6mm-220deg.svg", "_nicegui_ws/socket.io/?EIO=4&transport=polling"]
    for k in range(12):
        with socket.create_connection(("127.0.0.1", server.port), 20) as line:
            line.sendall(f"GET /{paths[k % 3]} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
            time.sleep(0.0025 * k)
    for k in range(3):
        page = browser.new_page()
        page.goto(server.url, wait_until="commit")
        time.sleep(0.3 * k)
        page.close()
    time.sleep(1)  # until all requests have come to their ends
    assert server.answers()
    assert server.complaints() == []


def test_other_sites_are_refused(server: Server, bench: BenchPage) -> None:
    for headers in ({"Host": "rebound.example"}, {"Origin": "http://elsewhere.example"}):
        request = urllib.request.Request(server.url, headers=headers)
        with pytest.raises(urllib.error.HTTPError, match="403"):
            fetch(request)
    with pytest.raises(InvalidStatus), stream(server, stream_path(bench), origin="http://elsewhere.example"):
        pass
    # The stream of a window that does not exist.
    with pytest.raises(ConnectionClosed) as end, stream(server, "/realcam/stream/none") as line:
        line.recv(timeout=30)
    assert end.value.rcvd is not None
    assert end.value.rcvd.code == 4404


def test_uploads_are_bounded(server: Server, bench: BenchPage, tmp_path: Path) -> None:
    (tmp_path / "large.zmx").write_bytes(b"x" * 3_000_000)
    files = bench.page.locator("[data-testid=upload] input[type=file]")
    files.set_input_files(tmp_path / "large.zmx")
    bench.page.get_by_text("of at most 2 MiB").wait_for()
    # Clients that bypass the page cannot upload it either.
    body = b"x" * 20_000_000
    request = urllib.request.Request(f"{server.url}_nicegui/client/x/upload/1", data=body, method="POST")
    with pytest.raises((urllib.error.HTTPError, OSError)) as refused:
        fetch(request)
    assert getattr(refused.value, "code", 413) == 413


@pytest.mark.slow
def test_a_token_is_wanted_from_other_machines(browser: playwright.Browser, tmp_path: Path) -> None:
    shot = bench_shots.write_panels_shot(tmp_path)
    server = Server(shot, "--host", "0.0.0.0", "--allow-network", "--token", "a-token-of-the-test", "--quiet")
    try:
        with pytest.raises(urllib.error.HTTPError, match="403"):
            fetch(server.url)
        with pytest.raises(InvalidStatus), stream(server, "/realcam/stream/none"):
            pass
        bench = BenchPage(browser, f"{server.url}?token=a-token-of-the-test")
        try:
            bench.picture()
        finally:
            bench.close()
    finally:
        server.stop()
    assert server.said == ""


def test_a_dead_connection_does_not_keep_the_frames(bench: BenchPage, server: Server) -> None:
    """A link that breaks without a word leaves the server with a socket that acknowledges nothing."""
    before = bench.picture().astype(int)
    bench.page.evaluate("window.first = [...realcamStreams.values()][0].socket")
    with stream(server, stream_path(bench)) as dead:
        dead.recv(timeout=30)  # takes over, and never acknowledges
        until(
            lambda: bench.page.evaluate(
                "() => { const s = [...realcamStreams.values()][0].socket; return s !== first && s.readyState; }"
            ),
            lambda state: state == 1,
            "back",
        )
        bench.send({"type": "orbit", "x": 0.2, "y": 0})
        assert np.abs(bench.picture() - before).mean() > 10


@pytest.mark.slow
def test_rest_costs_nothing(browser: playwright.Browser, own: Server) -> None:
    """On a server of its own: windows that other tests have left may still plan or measure."""
    page = BenchPage(browser, own.url)
    try:
        page.picture()
        time.sleep(3)  # plots, depth of field
        used = []
        for _ in range(15):
            before, start, threads = own.cpu_s(), time.monotonic(), own.thread_cpu_s()
            time.sleep(2)
            used.append((own.cpu_s() - before) / (time.monotonic() - start))
            if used[-1] < 0.02:
                break
        after = own.thread_cpu_s()
        busy = {name: round(seconds - threads.get(name, 0.0), 2) for name, seconds in after.items()}
        # The page's own socket is asked now and then whether it lives.
        assert min(used) < 0.02, (used, {name: seconds for name, seconds in busy.items() if seconds})
    finally:
        page.close()


@pytest.mark.slow
def test_a_server_that_dies_and_comes_again(browser: playwright.Browser, own: Server) -> None:
    bench = BenchPage(browser, own.url)
    try:
        before = bench.picture().astype(int)
        own.kill()
        bench.page.get_by_text("Connection lost").first.wait_for()
        assert (bench.shown() == before).all()  # the last picture stays
        bench.page.evaluate("window.isOfTheDeadServer = true")
        own.start()
        # The server knows neither window nor page. Both the stream and NiceGUI then load the page again, and one of
        # them may break off what the other has begun.
        bench.page.wait_for_function("!window.isOfTheDeadServer")
        bench.until_there()
        bench.send({"type": "orbit", "x": 0.2, "y": 0})
        assert np.abs(bench.picture() - before).mean() > 10
        bench.complaints.clear()  # the browser says of each try that nobody answered
    finally:
        bench.close()


class SlowLink:
    """A TCP proxy that limits the bytes per second from the server to the browser, or stops them altogether."""

    def __init__(self, port: int) -> None:
        self.to_port, self.bytes_per_s = port, float("inf")
        self.is_open = threading.Event()
        self.is_open.set()
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port = self._listening.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        self._listening.close()

    def _accept(self) -> None:
        while True:
            try:
                here, _ = self._listening.accept()
                there = socket.create_connection(("127.0.0.1", self.to_port))
            except OSError:
                return
            for line in (here, there):  # a slow line buffers little
                line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 16384)
            threading.Thread(target=self._pass, args=(there, here, True), daemon=True).start()
            threading.Thread(target=self._pass, args=(here, there, False), daemon=True).start()

    def _pass(self, source: socket.socket, target: socket.socket, is_slow: bool) -> None:
        try:
            while content := source.recv(8192):
                if is_slow:
                    time.sleep(len(content) / self.bytes_per_s)
                    self.is_open.wait()
                target.sendall(content)
        except OSError:
            pass
        for line in (source, target):
            with_end = line.fileno() >= 0
            if with_end:
                line.close()


@pytest.mark.slow
def test_a_slow_link_shows_the_newest_frame_and_recovers(browser: playwright.Browser, own: Server) -> None:
    link = SlowLink(own.port)
    bench = BenchPage(browser, f"http://127.0.0.1:{link.port}/")

    def seen() -> list[dict]:
        return bench.page.evaluate("window.seenFrames")

    try:
        bench.picture()
        bench.page.evaluate(
            """() => {
                window.seenFrames = [];
                [...realcamStreams.values()][0].on('frame', f => seenFrames.push(f.header));
            }"""
        )
        link.bytes_per_s = 10_000
        link.is_open.clear()
        for _ in range(60):
            bench.send({"type": "orbit", "x": 0.004, "y": 0})
            time.sleep(0.02)
        fetch(f"{own.url}tests/asked/{stream_path(bench).split('/')[-1]}")  # until all are done
        link.is_open.set()
        frames = until(seen, lambda f: f and f[-1]["is_final"], "the last picture")
        serials = [frame["serial"] for frame in frames]
        assert serials == sorted(serials)
        # One was under way while the link was shut. Of the others those that waited were out of date.
        assert len(set(serials)) < 6
        # The last picture may have been made before the first was acknowledged, so that the next one shows it.
        bench.send({"type": "orbit", "x": 0.05, "y": 0})
        until(seen, lambda f: any(frame["jpeg_quality"] < 80 for frame in f[len(frames) :]), "a coarser frame")
        link.bytes_per_s = float("inf")
        bench.send({"type": "orbit", "x": 0.05, "y": 0})
        # The last frame comes at the best quality, although the user does nothing more.
        until(
            lambda: [(f["serial"], f["jpeg_quality"], f["is_final"]) for f in seen()[-3:]],
            lambda last: last[-1][1] == 90 and last[-1][2],
            "the best",
        )
    finally:
        link.close()
        bench.close()


def random_message(chance: random.Random) -> dict:
    kind = chance.choice(
        # Focus and meter are rare, because they wait for a picture of a lens that takes a second to prepare.
        [*["orbit", "orbit", "pan", "dolly", "hover", "edit", "edit", "edit", "edit"] * 3, "focus", "meter"]
        if chance.random() < 0.6
        else ["insert", "remove", "swap", "undo", "redo", "turn", "turn", "switch"]
    )
    surface = chance.randrange(14)
    if kind in ("orbit", "pan"):
        return {"type": kind, "x": chance.gauss(0, 0.1), "y": chance.gauss(0, 0.1)}
    if kind == "dolly":
        return {"type": kind, "steps": chance.choice([-1, 1, -1, 1, 20, -20])}
    if kind in ("focus", "meter", "hover"):
        return {"type": kind, "u": chance.random(), "v": chance.random()}
    if kind == "edit":
        field, value = chance.choice(
            [
                ("radius_mm", chance.choice([chance.gauss(0, 40), chance.gauss(0, 1), 0, "", "1e9", 1e-9])),
                ("thickness_mm", chance.choice([chance.uniform(0, 8), -1, 0, 1e6])),
                ("semi_diameter_mm", chance.choice([chance.uniform(0, 14), 0, -1, 1e4])),
                ("conic", chance.gauss(0, 1)),
                ("glass", chance.choice(["", "air", "1.5168, 64.2", "1.9", "schott:N-BK7", "1", "0.1", "nonsense"])),
                ("a4", chance.gauss(0, 1e-5)),
            ]
        )
        return {"type": kind, "surface": surface, "field": field, "value": value, "gesture": chance.randrange(200)}
    if kind == "swap":
        return {"type": kind, "surface": surface, "other": surface + chance.choice([-1, 1])}
    if kind == "turn":
        return {"type": kind, "ring": chance.choice(["aperture", "shutter", "iso"]), "steps": chance.randint(-4, 4)}
    if kind == "switch":
        effect = chance.choice(["dispersion", "coatings", "ghosts", "diffraction"])
        return {"type": kind, "effect": effect, "state": chance.choice(["auto", "on", "off"])}
    return {"type": kind, "surface": surface}


@pytest.mark.slow
def test_hundreds_of_random_edits_and_moves(browser: playwright.Browser, own_without_pools: Server) -> None:
    bench = BenchPage(browser, own_without_pools.url)
    chance = random.Random(15)
    memory = []
    try:
        bench.picture()
        for k in range(200):
            bench.send(random_message(chance))
            if k % 5 == 4:
                bench.page.wait_for_timeout(60)
            if k % 20 == 19:
                bench.page.wait_for_timeout(250)
                memory.append(own_without_pools.memory_mb())
        # Messages are done in their order: when the last two are, nothing waits that would edit the next lens.
        for steps, engraved in ((100, "ISO 25600"), (-100, "ISO 50")):
            bench.send({"type": "turn", "ring": "iso", "steps": steps})
            until(lambda: bench.text("iso-text"), lambda text, iso=engraved: text == iso, "all is done", 240)
        # The user's next action is carried out and shown.
        bench.choose_lens("tessar-50mm")

        def seen() -> tuple[float, list[str]]:
            return bench.figure("effective_focal_length_mm"), bench.test_id("problem").all_text_contents()

        until(seen, lambda now: abs(now[0] - 49.94) < 0.01, "another lens")
    finally:
        bench.close()
    # At these moments 12 MB of tables may be there or not. A frame of 0.6 MB lost at each step would be 70 MB.
    assert memory[-1] - memory[3] < 20, memory
