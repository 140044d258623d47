"""Requests that a page does not wait for."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("starlette")

from realcam.viewer.server.left_requests import LeftRequests

from .processes import run_apart


async def fails(scope: Any, receive: Any, send: Any) -> None:
    await receive()
    raise RuntimeError("No response returned.")


def hear(message: str) -> None:
    async def receive() -> dict[str, Any]:
        return {"type": message}

    async def send(message: dict[str, Any]) -> None:
        pass

    run_apart(LeftRequests(fails)({"type": "http", "path": "/"}, receive, send))


def test_a_request_that_is_left_may_fail() -> None:
    hear("http.disconnect")


def test_others_may_not() -> None:
    with pytest.raises(RuntimeError):
        hear("http.request")
