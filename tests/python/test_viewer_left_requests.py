"""Requests that a page does not wait for."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

pytest.importorskip("starlette")

from realcam.viewer.left_requests import LeftRequests

START = {"type": "http.response.start", "status": 200, "headers": []}
HALF = {"type": "http.response.body", "body": b"half", "more_body": True}
END = {"type": "http.response.body", "body": b""}


def answers(*messages: dict[str, Any], then: Exception | None = None) -> Any:
    """An application that listens, sends some of an answer, and fails where it is told to."""

    async def app(scope: Any, receive: Any, send: Any) -> None:
        await receive()
        for message in messages:
            await send(message)
        if then:
            raise then

    return app


def said(app: Any, heard: str) -> list[dict[str, Any]]:
    """What goes to the client that such a message came from."""
    sent: list[dict[str, Any]] = []

    async def receive() -> dict[str, Any]:
        return {"type": heard}

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    asyncio.run(LeftRequests(app)({"type": "http", "path": "/"}, receive, send))
    return sent


@pytest.mark.parametrize("app", [answers(), answers(then=KeyError("REQUEST_METHOD"))], ids=["nothing", "a failure"])
def test_what_is_left_is_answered(app: Any) -> None:
    sent = said(app, "http.disconnect")
    assert [message["type"] for message in sent] == ["http.response.start", "http.response.body"]
    assert sent[0]["status"] == 499


@pytest.mark.parametrize("begun", [[START], [START, HALF]])
def test_an_answer_that_is_given_up_is_ended(begun: list[dict[str, Any]]) -> None:
    assert said(answers(*begun), "http.disconnect") == [*begun, END]


@pytest.mark.parametrize("heard", ["http.request", "http.disconnect"])
def test_whole_answers_stay_as_they_are(heard: str) -> None:
    assert said(answers(START, HALF, END), heard) == [START, HALF, END]


@pytest.mark.parametrize(("begun", "heard"), [([], "http.request"), ([START], "http.disconnect")])
def test_failures_of_ours_are_told(begun: list[dict[str, Any]], heard: str) -> None:
    with pytest.raises(KeyError, match="ours"):
        said(answers(*begun, then=KeyError("ours")), heard)
