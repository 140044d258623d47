"""Calls from other threads to the server's event loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any


def call_on_loop(loop: asyncio.AbstractEventLoop, function: Callable[..., Any], *arguments: Any) -> None:
    """Schedules a call on the loop. May be called from any thread. Has no effect while the server is shutting down."""
    with suppress(RuntimeError):
        loop.call_soon_threadsafe(function, *arguments)
