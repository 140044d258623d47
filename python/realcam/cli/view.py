"""realcam view: the lens bench in the browser."""

from __future__ import annotations

import secrets
from pathlib import Path
from typing import Annotated

import typer

from .._core import InputError
from ..shot import Shot
from .demo import scenes_folder


def view(
    shot: Annotated[Path | None, typer.Argument(help="Shot file; the demo if left out.", show_default=False)] = None,
    folder: Annotated[
        list[Path] | None,
        typer.Option(help="Folder that the page may read and write, besides the current one.", show_default=False),
    ] = None,
    host: Annotated[str, typer.Option(help="Address to serve at.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to serve at.", min=1, max=65535)] = 8080,
    allow_network: Annotated[
        bool, typer.Option("--allow-network", help="Serve at an address that other machines reach; makes a token.")
    ] = False,
    token: Annotated[str, typer.Option(help="The token that pages have to give.", show_default=False)] = "",
    connect: Annotated[
        str, typer.Option(help="HOST:PORT of a machine that photographs (--photograph).", show_default=False)
    ] = "",
    photograph: Annotated[
        bool, typer.Option("--photograph", help="Serve no page, but photograph for others, which --connect to here.")
    ] = False,
    device: Annotated[str, typer.Option(help="auto, cpu, cuda, cuda:1 ...; see `realcam devices`.")] = "auto",
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
) -> None:
    """Photograph a scene in the browser: turn the rings, edit the lens, and see the picture follow."""
    try:
        from ..viewer.access import is_local
        from ..viewer.remote import serve_pictures
        from ..viewer.server import ServerSettings, serve
    except ImportError as error:
        raise InputError(f"the lens bench needs {error.name}; pip install realcam[view] brings it") from None
    if not is_local(host) and not allow_network:
        raise InputError(f"--host {host}: other machines reach this address; --allow-network allows that")
    if photograph:
        secret = token or secrets.token_urlsafe(24)
        typer.echo(f"realcam: photographing for realcam view --connect {host}:{port} --token {secret}")
        serve_pictures(host, port, secret, device)
    path = scenes_folder() / "demo.toml" if shot is None else shot
    serve(
        Shot.load(path, device="cpu" if connect else device),
        ServerSettings(
            source=path,
            folders=(Path.cwd(), *(folder or ())),
            host=host,
            port=port,
            device=device,
            token=token,
            connect=_address(connect, token),
            shows_browser=browser,
        ),
    )


def _address(text: str, token: str) -> tuple[str, int] | None:
    if not text:
        return None
    host, colon, port = text.rpartition(":")
    if not (host and colon and port.isdigit()):
        raise InputError(f'--connect: "{text}": HOST:PORT is wanted')
    if not token:
        raise InputError("--connect: --token is wanted, as the other machine has printed it")
    return host.strip("[]"), int(port)
