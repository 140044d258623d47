"""Requests that a page makes and does not wait for, because it is closed or loaded again meanwhile."""

from __future__ import annotations

import logging

from starlette.types import ASGIApp, Message, Receive, Scope, Send

_log = logging.getLogger(__name__)


class LeftRequests:
    """ASGI middleware around all others, by which a request whose client has gone may fail.

    NiceGUI's middleware and Socket.IO find no answer then, or no request, and what they raise would stand in the log as
    an error of the server.
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
