"""The lens bench as its users have it: a server in a process of its own, and a browser that shows its page."""

from __future__ import annotations

import base64
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from .bench_shots import WIDTH, write_panels_shot

T = TypeVar("T")

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
WAIT_S = 60.0  # for what takes a second on a quiet machine
VIEWPORT = {"width": 1400, "height": 1000}


def free_port() -> int:
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return int(listening.getsockname()[1])


def until(get: Callable[[], T], is_right: Callable[[T], object], what: str, seconds: float = WAIT_S) -> T:
    """Polls `get` until `is_right` accepts its value, and returns that value."""
    begun = time.monotonic()
    while True:
        value = get()
        if is_right(value):
            return value
        waited = time.monotonic() - begun
        if waited > seconds:
            raise AssertionError(f"{what}: after {seconds:g} s still {value!r:.400}")
        time.sleep(min(0.01 + 0.2 * waited, 0.2))  # what comes late is asked for seldom


def fetch(request: str | urllib.request.Request, seconds: float = 30.0) -> bytes:
    """Raises HTTPError and OSError. Asks no proxy, whatever the environment says."""
    with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(request, timeout=seconds) as answer:
        return bytes(answer.read())


def launched(driver: Any) -> Iterator[Any]:
    """Debian's Chromium, as long as a fixture lasts."""
    started = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--no-proxy-server"])
    yield started
    started.close()


_PROGRAM = f"import sys; sys.path.append({str(Path(__file__).parent)!r}); import bench_server; bench_server.run()"
# A picture takes a sixteenth of the samples that it takes for users, and windows that pages have left are soon closed.
_SETTINGS = {"noise_codes": 4.0, "most_windows": 4}


def _cpu_s(stat: Path) -> float:
    """Processor time of a process or thread, from its file in /proc. Raises FileNotFoundError if it has ended."""
    fields = stat.read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Server:
    """`realcam view` on a shot, in the shot's folder. settings: fields of ServerSettings."""

    def __init__(self, shot: Path, *options: str, port: int | None = None, **settings: float) -> None:
        self.shot, self.options = shot, (*options, json.dumps(_SETTINGS | settings))
        self.port = port or free_port()
        self.log = shot.parent / f"server-{self.port}.log"
        self.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/"

    @property
    def said(self) -> str:
        return self.log.read_text()

    def start(self) -> None:
        command = [sys.executable, "-c", _PROGRAM, "view", self.shot.name, "--no-browser", "--port", str(self.port)]
        # NiceGUI has a mode for tests that are run within it, which this variable turns on.
        environment = {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"}
        # Opened for appending, so that a restarted server does not erase a traceback of the first one.
        with self.log.open("a") as log:
            self.process = subprocess.Popen(
                [*command, *self.options],
                cwd=self.shot.parent,
                env=environment,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        until(self.answers, bool, "the server does not answer", 120)

    def answers(self) -> bool:
        assert self.process.poll() is None, self.said
        try:
            fetch(f"{self.url}realcam/page.css", 5)
        except urllib.error.HTTPError:
            return True  # that a token is wanted is an answer, too
        except OSError:
            return False
        return True

    def kill(self) -> None:
        """Ends the server as a crash would."""
        self.process.kill()
        self.process.wait()

    def stop(self, seconds: float = 60.0) -> None:
        """Ends the server as Ctrl-C does."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(seconds)
            except subprocess.TimeoutExpired:
                self.kill()
                raise AssertionError(f"the server does not end:\n{self.said[-3000:]}") from None

    def cpu_s(self) -> float:
        """Processor time, of all threads and of its own processes."""
        total = 0.0
        for line in subprocess.check_output(["ps", "-e", "-o", "pid=,ppid="], text=True).splitlines():
            pid, parent = map(int, line.split())
            if self.process.pid in (pid, parent):
                with suppress(FileNotFoundError):
                    total += _cpu_s(Path(f"/proc/{pid}/stat"))
        return total

    def thread_cpu_s(self) -> dict[str, float]:
        """Processor time of its own threads, by number and name; those of libraries have no name."""
        names = json.loads(fetch(f"{self.url}tests/threads"))
        seconds = {}
        for task in Path(f"/proc/{self.process.pid}/task").iterdir():
            with suppress(FileNotFoundError):
                seconds[f"{task.name} {names.get(task.name, '')}"] = _cpu_s(task / "stat")
        return seconds

    def memory_mb(self) -> float:
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status).group(1)) / 1024

    def complaints(self) -> list[str]:
        return [
            line for line in self.said.splitlines() if re.search(r"Traceback|ERROR|CRITICAL|Exception|Error:", line)
        ]


# The serials of the pictures that were asked for last. By then the page has sent all that it sends by and by: what the
# mouse does, once for each picture that the browser draws, and what a ring or a number does, each 100 ms at most. Of
# timers the one that was set later and for longer ends later.
_ASKED = """
async () => {
    await new Promise(requestAnimationFrame);
    await new Promise((done) => setTimeout(done, 110));
    const key = [...realcamStreams.keys()][0].split("/").pop();
    return (await fetch(`/tests/asked/${key}`)).json();
}
"""
# The serials after the last frame has been acknowledged; null before. The server answers a slow acknowledgement with
# the same picture as a better JPEG, which has a serial of its own.
_ASKED_IN_THE_END = """
async () => {
    const key = [...realcamStreams.keys()][0].split("/").pop();
    return (await fetch(`/tests/asked_in_the_end/${key}`)).json();
}
"""
# The canvas, if it shows these pictures and they are done.
_SHOWN = """
(asked) => {
    const { shown } = [...realcamStreams.values()][0];
    for (const [slot, serial] of Object.entries(asked))
        if (!(shown[slot]?.is_final && shown[slot].serial >= serial)) return null;
    const c = document.querySelector(".rc-canvas");
    const data = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
    let text = "";
    for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
    return [c.width, c.height, btoa(text)];
}
"""


# Focused, the body is where the Tab key begins.
_TO_THE_TOP = """
() => {
    scrollTo(0, 0);
    document.body.tabIndex = -1;
    document.body.focus();
    document.body.removeAttribute("tabindex");
}
"""
# Clicks the tab of the panel that holds an element.
_REVEAL = """
([element]) => {
    const panel = element?.closest("[role=tabpanel]");
    if (panel && panel.style.display === "none") document.getElementById(panel.getAttribute("aria-labelledby")).click();
}
"""
_LOOK = """
() => {
    const all = (selector, of) => [...document.querySelectorAll(selector)].map(of);
    const lasting = ["compare", "refine to", "plot", "save-what", "save-name"];
    const isLasting = (e) => lasting.includes(e.closest("[data-testid]")?.dataset.testid);
    const typed = "input:not([type=file], [type=checkbox], [type=radio], .hidden)";
    const inputs = all(`${typed}, select:not([data-effect])`, (e) => e);
    return {
        camera: [
            ...["focus-text", "aperture-text", "shutter-text", "iso-text", "effective_focal_length_mm", "f_number"]
                .map((name) => document.querySelector(`[data-testid="${name}"]`)?.textContent),
            ...inputs.map((e) => e.value),
            ...all("[aria-checked]", (e) => e.ariaChecked),
            ...all(".rc-lens button", (e) => e.disabled),
            ...all("[role=alert]", (e) => e.textContent),
        ],
        lasting: [
            document.body.className,
            document.querySelector('[data-testid="said"]').textContent,
            ...inputs.filter(isLasting).map((e) => e.value),
            ...all("input[type=checkbox], input[type=radio]", (e) => e.checked),
            ...all(".q-dialog, dialog[open]", (e) => e.className),
        ],
    };
}
"""


class BenchPage:
    """A window on a server. Refuses to be left with an exception in the page's scripts."""

    def __init__(self, browser: Any, url: str = "", **settings: Any) -> None:
        self.context = browser.new_context(viewport=VIEWPORT, **settings)
        self.page = self.context.new_page()
        self.page.set_default_timeout(1000 * WAIT_S)
        self.complaints: list[str] = []
        self.first_look: dict[str, list[Any]] | None = None  #: of a page that may be brought back to it
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", self._hear)
        if url:
            self.open(url)

    def _hear(self, message: Any) -> None:
        if message.type == "error":
            self.complaints.append(message.text)

    def open_anew(self, url: str) -> None:
        """Opens the page as for a new user, but with compiled scripts, which takes half the time."""
        path = self.page.evaluate("[...(window.realcamStreams?.keys() ?? [])][0]")
        self.page.goto(f"{url}realcam/page.css")  # of the page's origin, and without scripts
        if path:
            fetch(f"{url}tests/left/{path.split('/')[-1]}")
        self.page.evaluate("sessionStorage.clear()")
        self.page.mouse.move(0, 0)
        self.page.set_viewport_size(VIEWPORT)
        self.complaints.clear()
        self.open(url)
        until(lambda: self.text("effective_focal_length_mm"), bool, "the lens")
        self.first_look = self.look()

    def open(self, url: str) -> None:
        self.page.goto(url)
        self.until_there()

    def bring_back(self, state: dict[str, Any]) -> bool:
        """Camera, lens and effects (see bench_state) as they were when the page was opened: in a tenth of the time that
        this takes. Whether the page then looks as at first: this brings nothing else back.
        """
        assert self.first_look is not None
        self.page.set_viewport_size(VIEWPORT)
        self.page.get_by_role("tab", name="Lens").evaluate("tab => tab.click()")  # a dialog may be before it
        self.page.mouse.move(0, 0)
        self.page.evaluate(_TO_THE_TOP)
        if self.look()["lasting"] != self.first_look["lasting"]:
            return False
        self.send({"type": "restore", "state": state})
        self.picture()
        try:
            until(self.look, lambda look: look == self.first_look, "as at first", 3)
        except AssertionError:
            return False
        return True

    def until_there(self) -> None:
        """Until the page that is being loaded shows its first picture."""
        until(lambda: (self.status, self.complaints), lambda seen: "pixels" in seen[0], "no picture comes")
        # Until it has drawn a page once, a browser heeds no mouse on it.
        self.page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def close(self) -> None:
        self.context.close()
        self.check()

    def check(self) -> None:
        assert self.complaints == [], self.complaints

    # Reading the state of the page.

    def revealed(self, found: Any) -> Any:
        """A locator, after the tab of its panel was clicked if that is not the one that is shown."""
        found.evaluate_all(_REVEAL)  # unlike evaluate, does not wait for an element that is not there, or goes
        return found

    def test_id(self, name: str) -> Any:
        return self.revealed(self._named(name))

    def button(self, name: str) -> Any:
        return self.revealed(self.page.get_by_role("button", name=name, include_hidden=True))

    def _named(self, name: str) -> Any:
        return self.page.locator(f'[data-testid="{name}"]')

    def text(self, name: str) -> str:
        return self._named(name).text_content() or ""

    @property
    def status(self) -> str:
        return "".join(self._named("status").all_text_contents())

    def picture(self) -> np.ndarray:
        """The picture of all that was done on this page before, as soon as nothing will be added: (H, W, 3) codes."""
        asked, before = self.page.evaluate(_ASKED), None
        while asked != before:
            width, height, content = until(
                lambda asked=asked: self.page.evaluate(_SHOWN, asked), bool, f"the picture ({self.status}) of {asked}"
            )
            before, asked = asked, until(lambda: self.page.evaluate(_ASKED_IN_THE_END), bool, "no acknowledgement")
        return np.frombuffer(base64.b64decode(content), np.uint8).reshape(height, width, 4)[..., :3]

    def shown(self) -> np.ndarray:
        """Pixels that the canvas shows now, possibly of an unfinished picture: (H, W, 3) codes."""
        width, height, content = self.page.evaluate(_SHOWN, {})
        return np.frombuffer(base64.b64decode(content), np.uint8).reshape(height, width, 4)[..., :3]

    def look(self) -> dict[str, list[Any]]:
        """How the controls of the page stand. "lasting" are some that bring_back cannot bring back."""
        return self.page.evaluate(_LOOK)

    def figure(self, name: str) -> float:
        text = self.text(name).split()[0]
        return float("nan") if text == "-" else float(text)

    def until_text(self, name: str, is_right: Callable[[str], object]) -> str:
        return until(lambda: self.text(name), is_right, name)

    # Acting on the page.

    @property
    def canvas(self) -> Any:
        return self.page.locator(".rc-canvas")

    def click_picture(self, u: float, v: float) -> None:
        box = self.canvas.bounding_box()
        self.canvas.click(position={"x": u * box["width"], "y": v * box["height"]})

    def hover(self, u: float, v: float) -> None:
        """Moves the mouse over a point of the picture, which is scrolled into view."""
        box = self.canvas.bounding_box()
        self.canvas.hover(position={"x": u * box["width"], "y": v * box["height"]})

    def turn(self, name: str, key: str, times: int = 1) -> None:
        """Turns a ring by the keyboard."""
        for _ in range(times):
            self.test_id(name).press(key)

    def choose(self, name: str, text: str) -> None:
        """An entry of a list."""
        self.revealed(self.page.locator(f'.q-field:has([data-testid="{name}"])')).click()
        option = self.page.locator(".q-menu .q-item").filter(has_text=re.compile(rf"^\s*{re.escape(text)}\s*$"))
        option.click()
        self.page.locator(".q-menu").wait_for(state="detached")

    def choose_lens(self, name: str) -> None:
        """One of the list of bundled lenses."""
        self.test_id("lens").fill(name)
        self.page.locator(".q-menu .q-item").get_by_text(name, exact=True).click()

    def choose_what_to_save(self, what: str, name: str) -> None:
        """Waits for the name that the server proposes: it would replace one that is filled in before it."""
        field = self.test_id("save-name")
        if self.page.locator('.q-field:has([data-testid="save-what"]) .q-field__native span').inner_text() != what:
            proposed = {"picture": "picture.png", "shot": "shot.toml", "lens": "lens.toml"}[what]
            self.choose("save-what", what)
            until(field.input_value, lambda shown: shown == proposed, "the name that is proposed")

        def filled() -> str:
            field.fill(name)
            return str(field.input_value())

        # A list takes the focus back some time after it has closed. What is typed at that moment goes nowhere.
        until(filled, lambda shown: shown == name, "the name that is filled in")

    def cell(self, surface: int, field: str) -> Any:
        return self.revealed(self.page.locator(f'[data-cell="{surface}-{field}"]'))

    def edit(self, surface: int, field: str, value: str) -> None:
        self.cell(surface, field).fill(value)
        self.cell(surface, field).press("Enter")

    def send(self, message: Any) -> None:
        """Over the page's own WebSocket, as its components do."""
        self.page.evaluate("m => [...window.realcamStreams.values()][0].send(m)", message)


def served_panels(folder: Path, *, width: int = WIDTH, **settings: float) -> Iterator[Server]:
    """A server of the shot of three panels, as long as a fixture lasts; nothing may have gone wrong in it."""
    started = Server(write_panels_shot(folder, width=width), **settings)
    yield started
    started.stop()
    assert started.complaints() == [], started.complaints()
