"""Who is let in to the lens bench, and which files are reached through it."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

import pytest
import realcam as rc

pytest.importorskip("starlette")

from realcam.viewer.server.access import BodyLimit, Folders, Gate, is_local
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # about the name under which httpx is going to come
    from starlette.testclient import TestClient

TOKEN = "a-token-of-the-test"


def client(token: str | None, base: str = "http://127.0.0.1:8080") -> TestClient:
    async def page(request: Request) -> PlainTextResponse:
        body = await request.body()
        return PlainTextResponse(f"page {len(body)}")

    async def stream(socket: WebSocket) -> None:
        await socket.accept()
        await socket.send_text("stream")
        await socket.close()

    app = Starlette(routes=[Route("/{path:path}", page, methods=["GET", "POST"]), WebSocketRoute("/stream", stream)])
    return TestClient(Gate(BodyLimit(app, 4_000_000), token), base_url=base)


def opens(client: TestClient, path: str = "/stream", headers: dict[str, str] | None = None) -> bool:
    try:
        with client.websocket_connect(path, headers=headers or {}) as socket:
            return socket.receive_text() == "stream"
    except WebSocketDisconnect as end:
        assert end.code == 1008
        return False


def test_a_token_by_query_then_by_cookie() -> None:
    browser = client(TOKEN, "http://192.168.1.5:8080")
    assert browser.get("/").status_code == 403
    assert "page" not in browser.get("/").text
    assert not opens(browser)
    first = browser.get(f"/?token={TOKEN}")
    assert (first.status_code, first.text) == (200, "page 0")
    cookie = first.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert browser.get("/other").status_code == 200  # the browser's cookie
    assert opens(browser, headers={"cookie": f"realcam_token={TOKEN}"})
    assert opens(client(TOKEN), f"/stream?token={TOKEN}")


@pytest.mark.parametrize(
    "given", ["", "wrong", TOKEN[:-1], TOKEN + "x", TOKEN.upper(), "\u00e9", "%00", "%ff", "a" * 5000]
)
def test_wrong_tokens(given: str) -> None:
    browser = client(TOKEN)
    refused = browser.get("/", params={"token": given}) if "%" not in given else browser.get(f"/?token={given}")
    assert refused.status_code == 403
    assert "set-cookie" not in refused.headers
    assert not opens(browser, f"/stream?token={given}" if given.isascii() else "/stream")


@pytest.mark.parametrize(
    "cookie", ["realcam_token=", "realcam_token=wrong", "=", ";;;", "realcam_token", "a[b]=c; realcam_token=x", '\\"=,']
)
def test_wrong_cookies(cookie: str) -> None:
    assert client(TOKEN).get("/", headers={"cookie": cookie}).status_code == 403
    assert not opens(client(TOKEN), headers={"cookie": cookie})


@pytest.mark.parametrize(
    "origin", ["http://elsewhere.example", "http://127.0.0.1:9090", "null", "http://[", "file://", "nonsense"]
)
@pytest.mark.parametrize("token", [None, TOKEN])
def test_pages_of_other_sites_are_kept_out(origin: str, token: str | None) -> None:
    query = f"?token={token}" if token else ""
    assert client(token).get(f"/{query}", headers={"origin": origin}).status_code == 403
    assert not opens(client(token), f"/stream{query}", headers={"origin": origin})


def test_no_site_shows_it_in_a_frame_or_learns_the_token() -> None:
    for answer in (client(TOKEN).get(f"/?token={TOKEN}"), client(TOKEN).get("/?token=wrong"), client(None).get("/x")):
        assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
        assert answer.headers["x-frame-options"] == "DENY"
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == "no-referrer"
        assert answer.headers["cross-origin-resource-policy"] == "same-origin"


@pytest.mark.parametrize("token", [None, TOKEN])
@pytest.mark.parametrize(
    ("site", "mode", "dest", "is_admitted"),
    [
        ("cross-site", "no-cors", "image", False),
        ("cross-site", "navigate", "iframe", False),
        ("cross-site", "cors", "empty", False),
        ("same-site", "no-cors", "script", False),  # of another port of this machine
        ("cross-site", "navigate", "document", True),  # a link in a mail
        ("same-origin", "cors", "empty", True),
        ("none", "navigate", "document", True),  # typed
    ],
)
def test_what_other_sites_ask_for_in_passing(
    token: str | None, site: str, mode: str, dest: str, is_admitted: bool
) -> None:
    headers = {"Sec-Fetch-Site": site, "Sec-Fetch-Mode": mode, "Sec-Fetch-Dest": dest}
    answer = client(token).get(f"/?token={TOKEN}", headers=headers)
    assert answer.status_code == (200 if is_admitted else 403)


def test_its_own_page_is_let_in() -> None:
    own = {"origin": "http://127.0.0.1:8080"}
    assert client(None).get("/", headers=own).status_code == 200
    # Starlette's test client asks for "testserver" on sockets, whatever its address.
    assert opens(client(None), headers={**own, "host": "127.0.0.1:8080"})


@pytest.mark.parametrize(
    ("host", "is_admitted"),
    [
        ("127.0.0.1:8080", True),
        ("localhost:8080", True),
        ("[::1]:8080", True),
        ("rebound.example:8080", False),
        ("127.0.0.1.rebound.example", False),
        ("192.168.1.5:8080", False),
        ("", False),
        ("[", False),
        ("[::1", False),
        ("[nonsense]", False),
        ("127.0.0.1@elsewhere.example", False),
    ],
)
def test_names_that_a_site_points_at_this_machine(host: str, is_admitted: bool) -> None:
    assert (client(None).get("/", headers={"host": host}).status_code == 200) == is_admitted
    assert opens(client(None), headers={"host": host}) == is_admitted


def test_which_addresses_only_this_machine_reaches() -> None:
    assert [is_local(host) for host in ("127.0.0.1", "127.9.9.9", "::1", "localhost")] == [True] * 4
    assert [is_local(host) for host in ("0.0.0.0", "::", "192.168.1.5", "example.com", "")] == [False] * 5


def test_a_request_is_bounded() -> None:
    """An upload is a lens file: no page of ours sends more than a few megabytes at once."""
    browser = client(None)
    assert browser.post("/", content=b"x" * 2_000_000).text == "page 2000000"
    assert browser.post("/", content=b"x" * 20_000_000).status_code == 413
    # Nor where it does not say how much will come.
    chunks = (b"x" * 100_000 for _ in range(200))
    assert browser.post("/", content=chunks).status_code == 413
    assert browser.get("/").status_code == 200


# Files.


@pytest.fixture
def folders(tmp_path: Path) -> Folders:
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "secret.toml").write_text("secret")
    (tmp_path / "in" / "below").mkdir(parents=True)
    (tmp_path / "second").mkdir()
    (tmp_path / "in" / "lens.toml").write_text("")
    (tmp_path / "in" / "link").symlink_to(tmp_path / "outside")
    (tmp_path / "in" / "link.toml").symlink_to(tmp_path / "outside" / "secret.toml")
    (tmp_path / "in" / "fine.toml").symlink_to(tmp_path / "in" / "lens.toml")
    (tmp_path / "in" / "loop").symlink_to(tmp_path / "in" / "loop")
    return Folders([tmp_path / "in", tmp_path / "second"])


def test_files_in_the_folders(folders: Folders, tmp_path: Path) -> None:
    assert folders.inside("a.png") == tmp_path / "in" / "a.png"
    assert folders.inside("below/a.png") == tmp_path / "in" / "below" / "a.png"
    assert folders.inside("below/../a.png") == tmp_path / "in" / "a.png"
    assert folders.inside(str(tmp_path / "second" / "a.png")) == tmp_path / "second" / "a.png"
    assert folders.inside("../second/a.png") == tmp_path / "second" / "a.png"
    assert folders.inside("fine.toml") == tmp_path / "in" / "lens.toml"


@pytest.mark.parametrize(
    "name",
    [
        *("", "../outside/secret.toml", "below/../../outside/secret.toml", "/etc/passwd", "link/secret.toml"),
        *("link/new.png", "link.toml", "a\0b.png", "loop", "loop/a.png", "~/a.png/../../../x", "../in-not/a.png"),
        *("..", "../..", "//etc/passwd"),
    ],
)
def test_files_out_of_the_folders(folders: Folders, name: str) -> None:
    with pytest.raises(rc.InputError):
        folders.inside(name)


def test_a_name_that_is_too_long_is_an_error(folders: Folders) -> None:
    with pytest.raises(rc.InputError, match="cannot be the name"):
        folders.inside("\ud800.png")
    for name in ("a" * 5000, "a/" * 5000):
        with pytest.raises((rc.InputError, OSError)):  # as late as it is written, by systems that do not look
            folders.inside(name).write_bytes(b"")


def test_links_that_lead_out_are_not_listed(folders: Folders) -> None:
    assert [path.name for path in folders.files([".toml"])] == ["fine.toml", "lens.toml"]


def test_folders_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(rc.InputError, match="is not a folder"):
        Folders([tmp_path / "missing"])
    (tmp_path / "file").write_text("")
    with pytest.raises(rc.InputError, match="is not a folder"):
        Folders([tmp_path / "file"])
    assert os.fspath(Folders([tmp_path]).first)
