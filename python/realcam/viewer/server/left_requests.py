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
        is_disconnected = False

        async def watched_receive() -> Message:
            nonlocal is_disconnected
            message = await receive()
            is_disconnected |= message["type"] == "http.disconnect"
            return message

        try:
            await self._app(scope, watched_receive, send)
        except Exception as error:
            if not is_disconnected:
                raise
            _log.info("the client of %s disconnected before the response", scope["path"], exc_info=error)
