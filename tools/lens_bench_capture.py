"""Records the animation of the README and docs/lens-bench.md: a page of the lens bench, controlled by a script.

    python tools/lens_bench_capture.py FOLDER

Writes lens-bench.webp. Needs playwright, Debian's chromium and Pillow. Takes some minutes on two cores, because every
picture is refined.
"""

from __future__ import annotations

import io
import re
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

SIZE = {"width": 1440, "height": 900}
SAMPLES = 6  # per pixel of a picture at rest, which is shown denoised
STEP_MS = 260  # duration of a frame during a movement
REST_MS = 1400  # duration of a frame at rest
WIDTH = 860  # width of the animation in pixels


class Capture:
    """Screenshots of a page with the duration of each in the animation."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.frames: list[tuple[Image.Image, int]] = []

    def wait_for(self, samples: int) -> None:
        """Waits until the picture at full resolution has this number of samples per pixel."""
        status = self.page.get_by_test_id("status")
        time.sleep(0.4)
        while True:
            text = status.text_content() or ""
            found = re.search(r"(\d+) samples", text)
            if found and "preview" not in text and int(found[1]) >= samples:
                return
            time.sleep(0.1)

    def add_frame(self, milliseconds: int, samples: int = SAMPLES) -> None:
        """Adds a frame with this duration once the picture has this number of samples."""
        self.wait_for(samples)
        picture = Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")
        self.frames.append((picture, milliseconds))

    def add_movement(self, steps: int, act: Callable[[], None], samples: int = SAMPLES // 3) -> None:
        """Calls `act` and adds a frame for each step of a movement, and finally a frame at rest."""
        for _ in range(steps):
            act()
            self.add_frame(STEP_MS, samples)
        self.add_frame(REST_MS)

    def save(self, path: Path) -> None:
        """Writes the animation as .webp."""
        height = round(WIDTH * SIZE["height"] / SIZE["width"])
        small = [frame.resize((WIDTH, height), Image.Resampling.LANCZOS) for frame, _ in self.frames]
        times = [milliseconds for _, milliseconds in self.frames]
        small[0].save(path, save_all=True, append_images=small[1:], duration=times, loop=0, quality=60, method=6)


def act_out(capture: Capture) -> None:
    """Stops down and opens the lens, focuses on the background and back, changes a radius of curvature, and undoes
    it."""
    page = capture.page
    page.get_by_role("tab", name="Camera").click()
    page.get_by_test_id("resolution").click()
    page.get_by_role("option", name="480 pixels across").click()
    page.get_by_role("tab", name="Lens").click()
    capture.add_frame(REST_MS)
    canvas = page.locator("canvas.rc-canvas")
    canvas.focus()
    capture.add_movement(9, lambda: page.keyboard.press("]"))
    capture.add_movement(9, lambda: page.keyboard.press("["))
    box = canvas.bounding_box()
    assert box
    page.mouse.click(box["x"] + 0.55 * box["width"], box["y"] + 0.3 * box["height"])
    capture.add_frame(REST_MS)
    page.mouse.click(box["x"] + 0.44 * box["width"], box["y"] + 0.65 * box["height"])
    capture.add_frame(REST_MS)
    page.locator('polyline.rc-hit[data-surface="2"]').first.dispatch_event("pointerdown")
    handle = page.locator('[data-handle="radius_mm"]').bounding_box()
    assert handle
    x, y = handle["x"] + handle["width"] / 2, handle["y"] + handle["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    step = iter(range(1, 100))
    capture.add_movement(6, lambda: page.mouse.move(x - 0.6 * next(step), y))
    page.mouse.up()
    page.get_by_role("button", name="Undo").click()
    capture.add_frame(REST_MS)


def main() -> None:
    folder = Path(sys.argv[1])
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "realcam", "view", "--no-browser", "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server, sync_playwright() as playwright:
        try:
            assert server.stdout and "lens bench" in server.stdout.readline()
            browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox"])
            page = browser.new_page(viewport=SIZE, color_scheme="dark")
            page.goto(f"http://127.0.0.1:{port}/")
            capture = Capture(page)
            act_out(capture)
            capture.save(folder / "lens-bench.webp")
            browser.close()
        finally:
            server.terminate()


if __name__ == "__main__":
    main()
