"""`realcam view` as the tests start it (bench_pages.Server): with settings for which it has no options, and with
addresses that tell when all that a page has asked for is done, and that close its window.

A module of its own, so that the server's own processes, which are begun anew, import none of it.
"""

from __future__ import annotations

import asyncio
import json
import sys
import threading
from functools import partial

from nicegui import app
from realcam.viewer.server import server
from realcam.viewer.server.windows import Windows
from realcam_command.main import main

_opened: list[Windows] = []


class _TestedWindows(Windows):
    def __init__(self, most: int) -> None:
        super().__init__(most)
        _opened.append(self)


@app.get("/tests/asked/{key}")
async def asked(key: str) -> dict[str, int]:
    """The serials of the pictures that a window has asked for last, by their slots."""
    window = _opened[0].get(key)
    assert window is not None
    # Earlier messages of the page came by other sockets. Each iteration of the event loop takes them a step towards the
    # thread of the window's actions: from the socket through a protocol's parser, its queue and a task or two.
    for _ in range(50):
        await asyncio.sleep(0)
    while len(window.stream.inbox):
        await asyncio.sleep(0.01)
    return await window.do(lambda: window.bench.requested_serials)


@app.get("/tests/asked_in_the_end/{key}")
async def asked_in_the_end(key: str) -> dict[str, int] | None:
    """The requested serials as in `asked`, once the page has acknowledged all frames; None before."""
    window = _opened[0].get(key)
    assert window is not None
    if window.stream._sent or window.stream._frames:
        return None
    return await window.do(lambda: window.bench.requested_serials)


@app.get("/tests/left/{key}")
async def left(key: str) -> None:
    """Closes the window of a page that has gone. It would refine its picture for half a minute yet."""
    window = _opened[0].get(key)
    if window is not None:
        _opened[0]._close(window)


@app.get("/tests/threads")
async def threads() -> dict[str, str]:
    """The names of Python's threads, by the numbers that the system gives them."""
    return {str(thread.native_id): thread.name for thread in threading.enumerate()}


def run() -> None:
    """The last argument of the command line are fields of ServerSettings, as JSON."""
    server.ServerSettings = partial(server.ServerSettings, **json.loads(sys.argv.pop()))  # type: ignore[misc, assignment]
    server.Windows = _TestedWindows  # type: ignore[misc]
    main()
