"""Requests that a page makes and does not wait for, because it is closed or loaded again meanwhile."""

from __future__ import annotations

import logging

from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_log = logging.getLogger(__name__)

_CLIENT_CLOSED_REQUEST = 499  # nginx's number for it; nobody reads the answer


class LeftRequests:
    """ASGI middleware that ends the answers to requests whose client has gone.

    What is not answered, half answered, or fails because there is no client any more (Socket.IO finds a request
    without a method), the middleware of NiceGUI around this would report as an error of the server.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        is_left = is_begun = is_ended = False

        async def heard() -> Message:
            nonlocal is_left
            message = await receive()
            is_left |= message["type"] == "http.disconnect"
            return message

        async def said(message: Message) -> None:
            nonlocal is_begun, is_ended
            is_begun = True
            is_ended = message["type"] != "http.response.start" and not message.get("more_body", False)
            await send(message)

        try:
            await self._app(scope, heard, said)
        except Exception as error:
            if is_begun or not is_left:
                raise
            _log.debug("%s was left before it was answered", scope["path"], exc_info=error)
        if is_left and not is_begun:
            await Response(status_code=_CLIENT_CLOSED_REQUEST)(scope, receive, send)
        elif is_left and not is_ended:
            await send({"type": "http.response.body", "body": b""})
