"""Response of the lens bench: frames per second while the camera moves, and latency from a control to its first frame.

    python benchmarks/viewer_speed.py [--device cpu] [--shot SHOT] [--resolution 640 640] [--idle] [-o out.json]

A child process serves a bench over its WebSocket, and this process communicates with it as the page does: renderer,
JPEG encoder and socket are measured, but not the browser.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import pickle
import socket
import statistics
import struct
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import realcam as rc
import uvicorn
from realcam.cli.demo import scenes_folder
from realcam.shot import Shot
from realcam.viewer.lens_bench import LensBench
from realcam.viewer.page.window import Window
from starlette.applications import Starlette
from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocket
from websockets.asyncio.client import ClientConnection, connect

MOVING_S = 4.0  # duration of the movement
CONTROLS = 40  # number of measured changes for each control


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Page:
    """Client side of the stream, as in stream.js."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.texts: list[dict[str, Any]] = []
        self.bytes = 0

    async def send(self, **message: Any) -> None:
        await self.connection.send(json.dumps(message))

    async def frame(self) -> dict[str, Any]:
        """Receives the next frame, acknowledges it, and returns its header."""
        while True:
            content = await self.connection.recv()
            if isinstance(content, str):
                self.texts.append(json.loads(content))
                continue
            (length,) = struct.unpack_from("<I", content)
            header: dict[str, Any] = json.loads(content[4 : 4 + length])
            self.bytes += len(content)
            await self.connection.send(f"ack {header['slot']} {header['serial']}")
            return header


async def frames_per_second(page: Page) -> dict[str, float]:
    """Frame rate while the camera orbits by 120 mouse movements per second."""

    async def drag() -> None:
        for k in range(100_000):
            await page.send(type="orbit", x=0.002 if k % 240 < 120 else -0.002, y=0)
            await asyncio.sleep(1 / 120)

    dragging = asyncio.create_task(drag())
    await page.frame()
    begin = time.perf_counter()
    frames, pixels, samples = 0, 0, 0
    while time.perf_counter() - begin < MOVING_S:
        header = await page.frame()
        frames, pixels, samples = frames + 1, header["width"], header["samples"]
    seconds = time.perf_counter() - begin
    dragging.cancel()
    return {"frames_per_s": frames / seconds, "width": pixels, "samples_per_frame": samples}


async def latencies(page: Page, message: Any) -> dict[str, float]:
    """Latency from a control to the first frame that shows its effect, while the picture is being refined.

    message: returns the message of the k-th change.
    """
    times = []
    header = await page.frame()
    for k in range(CONTROLS):
        until = time.perf_counter() + 0.2
        while time.perf_counter() < until:  # refinement, which the next control interrupts
            try:
                header = await asyncio.wait_for(page.frame(), max(0.01, until - time.perf_counter()))
            except TimeoutError:
                break
        serial = header["serial"]
        begin = time.perf_counter()
        await page.send(**message(k))
        while header["serial"] <= serial:
            header = await page.frame()
        times.append(1000 * (time.perf_counter() - begin))
    return {"median_ms": statistics.median(times), "p95_ms": statistics.quantiles(times, n=20)[-1]}


def cpu_seconds(process: int) -> float:
    """CPU time of a process, by its id."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def measure(port: int, process: int, shows_idle: bool) -> dict[str, Any]:
    """Measures the server at a port. process: its id. shows_idle: measures its CPU load at rest as well."""
    results: dict[str, Any] = {}
    async with connect(f"ws://127.0.0.1:{port}/", max_size=None) as connection:
        page = Page(connection)
        for _ in range(3):
            await page.frame()
        results["moving"] = await frames_per_second(page)
        results["orbit"] = await latencies(page, lambda k: {"type": "orbit", "x": 0.01 if k % 2 else -0.01, "y": 0})
        for ring in ("aperture", "shutter"):
            results[ring] = await latencies(
                page, lambda k, ring=ring: {"type": "turn", "ring": ring, "steps": 1 if k % 2 else -1}
            )
        results["radius"] = await latencies(
            page, lambda k: {"type": "edit", "surface": 0, "field": "radius_mm", "value": 29.5 if k % 2 else 29.6}
        )
        if shows_idle:
            header = await page.frame()
            while not header["is_final"]:
                header = await page.frame()
            await asyncio.sleep(3)
            before = cpu_seconds(process)
            await asyncio.sleep(10)
            results["idle_cpu_percent"] = 10 * (cpu_seconds(process) - before)
    return results


def serve(shot: Shot, device: str, port: int) -> None:
    """Serves a bench's WebSocket without its page."""

    async def stream(socket: WebSocket) -> None:
        window = Window(LensBench(shot, device=device))
        await window.stream.serve(socket)

    uvicorn.run(Starlette(routes=[WebSocketRoute("/", stream)]), port=port, log_level="warning")


def shot_of(path: Path | None) -> Shot:
    """Loads a shot file, or a pickled Shot for machines that cannot read its scene; None: the demo shot."""
    if path is None:
        path = scenes_folder() / "demo.toml"
    if path.suffix == ".pickle":
        shot: Shot = pickle.loads(path.read_bytes())
        return shot
    return Shot.load(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--shot", type=Path, help="shot file, or a pickled Shot [the demo]")
    parser.add_argument(
        "--resolution", type=int, nargs=2, help="width and height of the picture in pixels; the film keeps its width"
    )
    parser.add_argument("--plain", action="store_true", help="render without effects instead of the planned ones")
    parser.add_argument("--idle", action="store_true", help="wait until the picture is done, and measure the idle CPU")
    parser.add_argument("--serve", type=int, help=argparse.SUPPRESS)
    parser.add_argument("-o", "--output", type=Path)
    options = parser.parse_args()
    if options.serve:
        shot = shot_of(options.shot)
        if options.resolution:
            width, height = options.resolution
            wide = shot.camera.film.width_mm
            film = shot.camera.film.replace(height_mm=wide * height / width, resolution=(width, height))
            shot = replace(shot, camera=shot.camera.replace(film=film))
        if options.plain:
            shot = replace(shot, settings=shot.settings.with_(effects=()))
        serve(shot, options.device, options.serve)
        return
    port = free_port()
    with subprocess.Popen([sys.executable, __file__, "--serve", str(port), *sys.argv[1:]]) as server:
        try:
            for _ in range(600):
                try:
                    socket.create_connection(("127.0.0.1", port), timeout=1).close()
                    break
                except OSError:
                    time.sleep(0.1)
            results = asyncio.run(measure(port, server.pid, options.idle))
        finally:
            server.terminate()
    names = [str(d) for d in rc.devices() if d.name.startswith("cpu" if options.device == "cpu" else "cuda")]
    text = json.dumps({"device": (names or [str(rc.devices()[0])])[0], "cores": os.cpu_count(), **results}, indent=1)
    print(text)
    if options.output:
        options.output.write_text(text + "\n")


if __name__ == "__main__":
    main()
