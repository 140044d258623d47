"""The way from other threads to the server's loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any


def call_on_loop(loop: asyncio.AbstractEventLoop, function: Callable[..., Any], *arguments: Any) -> None:
    """From any thread, also while the server is going down: then nobody listens any more."""
    with suppress(RuntimeError):
        loop.call_soon_threadsafe(function, *arguments)
