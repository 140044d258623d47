"""The way from other threads to the server's loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any


def call_on_loop(loop: asyncio.AbstractEventLoop, function: Callable[..., Any], *arguments: Any) -> None:
    """May be called from any thread. While the server is going down, the call is dropped."""
    with suppress(RuntimeError):
        loop.call_soon_threadsafe(function, *arguments)
