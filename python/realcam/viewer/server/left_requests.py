"""Requests abandoned by their client, because the page was closed or reloaded."""

from __future__ import annotations

import logging

from starlette.types import ASGIApp, Message, Receive, Scope, Send

_log = logging.getLogger(__name__)


class LeftRequests:
    """Outermost ASGI middleware, which tolerates failures of requests whose client has disconnected.

    NiceGUI's middleware and Socket.IO then raise exceptions, because a response or request is missing, which would be
    logged as errors of the server.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        is_left = False

        async def heard() -> Message:
            nonlocal is_left
            message = await receive()
            is_left |= message["type"] == "http.disconnect"
            return message

        try:
            await self._app(scope, heard, send)
        except Exception as error:
            if not is_left:
                raise
            _log.info("%s was left before it was answered", scope["path"], exc_info=error)
