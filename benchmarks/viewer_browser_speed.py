"""Frame rate of the lens bench in the browser: of the picture, and of the lens drawing during a drag.

    python benchmarks/viewer_browser_speed.py [--shot SHOT] [--size 1400 1000]

Needs playwright and Debian's chromium, which draws on the cores of the server, without a GPU.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, sync_playwright
from realcam.cli.demo import scenes_folder
from viewer_speed import free_port

SECONDS = 6.0  # duration of a drag

# JavaScript that moves the mouse in each animation frame of the page, as smoothly as a hand at 60 Hz, without another
# process. Its arguments: CSS selector of the dragged element, duration in s, and amplitudes of the movement in pixels.
# Returns rates per second.
MOVE = """([selector, seconds, dx, dy]) => new Promise((done) => {
  const target = document.querySelector(selector), box = target.getBoundingClientRect();
  const x0 = box.left + box.width / 2, y0 = box.top + box.height / 2;
  const send = (type, x, y) => target.dispatchEvent(new PointerEvent(type, {
    pointerId: 1, isPrimary: true, bubbles: true, button: 0, clientX: x, clientY: y,
  }));
  for (const element of [target, ...document.querySelectorAll('.rc-section')]) element.setPointerCapture = () => {};
  const stream = [...window.realcamStreams.values()][0], section = document.querySelector('.rc-section');
  const shapeOf = () => section.querySelector('.rc-dragged')?.getAttribute('points') + '|' +
    [...section.querySelectorAll('.rc-face polyline')].map((line) => line.getAttribute('points')).join();
  const begun = performance.now(), shownBefore = stream.framesShown;
  let drawn = 0, changed = 0, lenses = 0, before = shapeOf();
  const end = stream.on('lens', () => { lenses += 1; });
  send('pointerdown', x0, y0);
  const step = (now) => {
    const t = (now - begun) / 1000, shape = shapeOf();
    drawn += 1;
    changed += shape !== before;
    before = shape;
    if (t < seconds) {
      send('pointermove', x0 + dx * Math.sin(2 * t), y0 + dy * Math.sin(2 * t));
      requestAnimationFrame(step);
    } else {
      send('pointerup', x0, y0);
      end();
      const per_s = (n) => Number((n / t).toFixed(1));
      done({ browser_frames_per_s: per_s(drawn), pictures_per_s: per_s(stream.framesShown - shownBefore),
        outlines_per_s: per_s(changed), lenses_per_s: per_s(lenses) });
    }
  };
  requestAnimationFrame(step);
})"""


def measure(page: Page) -> dict[str, Any]:
    """Rates while the camera orbits, and while a surface of the lens is dragged."""
    page.locator("canvas.rc-canvas").wait_for()
    page.wait_for_function("[...window.realcamStreams?.values() ?? []][0]?.framesShown > 3")
    time.sleep(3)
    results = {"orbit": page.evaluate(MOVE, ["canvas.rc-canvas", SECONDS, 150, 10])}
    time.sleep(2)
    page.locator('polyline.rc-hit[data-surface="0"]').first.dispatch_event("pointerdown")
    results["drag of a face"] = page.evaluate(MOVE, ['[data-handle="radius_mm"]', SECONDS, 3, 0])
    return results


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shot", type=Path, default=scenes_folder() / "demo.toml")
    parser.add_argument(
        "--size", type=int, nargs=2, default=(1400, 1000), help="size of the browser's window in pixels"
    )
    options = parser.parse_args()
    port = free_port()
    command = [sys.executable, "-m", "realcam", "view", str(options.shot), "--no-browser", "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server, sync_playwright() as driver:
        try:
            assert server.stdout and "lens bench" in server.stdout.readline()
            browser = driver.chromium.launch(
                executable_path=shutil.which("chromium"), args=["--no-sandbox", "--no-proxy-server"]
            )
            page = browser.new_page(viewport={"width": options.size[0], "height": options.size[1]})
            page.goto(f"http://127.0.0.1:{port}/")
            print(json.dumps({"cores": os.cpu_count(), **measure(page)}, indent=1))
            browser.close()
        finally:
            server.terminate()


if __name__ == "__main__":
    main()
