"""Access control: clients of the server, and files that it may read and write."""

from __future__ import annotations

import hmac
import ipaddress
from collections.abc import MutableMapping, Sequence
from http.cookies import SimpleCookie
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ..._core import InputError

_COOKIE = "realcam_token"
_HEADERS = (
    (b"content-security-policy", b"frame-ancestors 'none'; base-uri 'self'; object-src 'none'"),
    (b"x-frame-options", b"DENY"),  # frame-ancestors for older browsers: prevents clickjacking
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),  # the page's address contains the token
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
)


def is_local(host: str) -> bool:
    """True if only programs on this machine can reach the address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Gate:
    """ASGI middleware in front of all pages, files and sockets. Its response headers prevent embedding by other sites.

    token: required as ?token= or as the cookie that this class sets; None: every program on this machine is admitted.
    In that case the Host and Origin headers exclude other sites shown in the user's browser: a site can point its own
    name at 127.0.0.1 (DNS rebinding), but cannot change the name that the browser sends.
    """

    def __init__(self, app: ASGIApp, token: str | None = None) -> None:
        self._app, self._token = app, token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        by_query = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        is_admitted = self._is_admitted(headers, by_query)
        response_headers = list(_HEADERS)
        if is_admitted and self._token and by_query:
            response_headers.append(
                (b"set-cookie", f"{_COOKIE}={self._token}; HttpOnly; SameSite=Strict; Path=/".encode())
            )

        async def send_with_headers(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*(message.get("headers") or []), *response_headers]
            await send(message)

        app = self._app if is_admitted else _refuse
        await app(scope, receive, send_with_headers)

    def _is_admitted(self, headers: Headers, by_query: str) -> bool:
        # Rejects requests of other sites' pages, except for navigation by a link.
        is_link = headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
        if headers.get("sec-fetch-site") in ("cross-site", "same-site") and not is_link:
            return False
        host, origin = headers.get("host", ""), headers.get("origin")
        try:
            if origin and urlsplit(origin).netloc != host:
                return False
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:  # brackets without a valid IPv6 address
            return False
        if self._token is None:
            return "@" not in host and is_local(name)
        cookies = SimpleCookie(headers.get("cookie", ""))
        token = by_query or (cookies[_COOKIE].value if _COOKIE in cookies else "")
        return hmac.compare_digest(token.encode(), self._token.encode())


async def _refuse(scope: Scope, receive: Receive, send: Send) -> None:
    """ASGI application that answers with 403, or closes a WebSocket."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    text = "realcam: use the address with the token that the server has printed\n"
    await PlainTextResponse(text, status_code=403)(scope, receive, send)


class BodyLimit:
    """ASGI middleware that rejects requests of more than `max_bytes` bytes.

    The page's own limit for uploads is enforced only by browsers.
    """

    def __init__(self, app: ASGIApp, max_bytes: int) -> None:
        self._app, self._max_bytes = app, max_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        length = Headers(scope=scope).get("content-length", "")
        if length.isdecimal() and int(length) > self._max_bytes:
            await PlainTextResponse("realcam: too large\n", status_code=413)(scope, receive, send)
            return
        received = 0

        async def counted() -> Message:
            nonlocal received
            message = await receive()
            received += len(message.get("body", b""))
            if received > self._max_bytes:
                raise HTTPException(413)  # raised in the code that reads the request, so that it is answered
            return message

        await self._app(scope, counted, send)


class Folders:
    """Folders specified when the server was started; pages can read and write only these."""

    def __init__(self, folders: Sequence[Path]) -> None:
        self._folders = [folder.resolve() for folder in folders]
        for folder in self._folders:
            if not folder.is_dir():
                raise InputError(f"{folder} is not a folder")

    @property
    def first(self) -> Path:
        """Folder at which relative paths start."""
        return self._folders[0]

    def files(self, suffixes: Sequence[str]) -> list[Path]:
        """Files of all folders with one of the suffixes, without subfolders."""
        return sorted(
            path
            for folder in self._folders
            for path in folder.iterdir()
            if path.suffix.lower() in suffixes and path.is_file() and self._holds(path.resolve())
        )

    def inside(self, name: str) -> Path:
        """Resolves a path in one of the folders; a relative path starts at the first.

        Raises InputError for a path outside of them, also if it is reached by a link.
        """
        if not name or "\0" in name:
            raise InputError("expected a file name")
        try:
            path = (self.first / name).resolve()
        except (OSError, RuntimeError, ValueError):  # a link to itself; an invalid file name
            raise InputError(f'"{name!a:.80}" cannot be the name of a file') from None
        if not self._holds(path):
            raise InputError(f'"{name[-80:]}" is outside the folders that the server was started with')
        return path

    def _holds(self, path: Path) -> bool:
        return any(path.is_relative_to(folder) for folder in self._folders)
