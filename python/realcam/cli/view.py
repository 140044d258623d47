"""The command `realcam view`: starts the lens bench in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .._core import InputError
from ..bundled_scenes import scenes_folder
from . import options
from .grouped_options import grouped
from .shot_options import shot_options, words_of

# A shot saved by the bench contains all of these options.
ShotOptions = shot_options(
    panels=("Camera", "Scene"),
    also=("ocio", "display", "view", "environment_color_space", "texture_color_space"),
)


@grouped
def view(
    changes: ShotOptions,  # type: ignore[valid-type]
    shot: Annotated[Path | None, typer.Argument(help=f"{options.SHOT_HELP} [demo]", metavar="SCENE")] = None,
    folder: Annotated[
        list[Path] | None,
        typer.Option(help="Additional folder that the page may read and write", show_default=False),
    ] = None,
    host: Annotated[str, typer.Option(help="Address to serve at")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to serve at", min=1, max=65535)] = 8080,
    allow_network: Annotated[
        bool, typer.Option("--allow-network", help="Serve at an address that other machines can reach; creates a token")
    ] = False,
    token: Annotated[str, typer.Option(help="Token that pages must present", show_default=False)] = "",
    device: options.Device = "auto",
    browser: Annotated[bool, typer.Option(help="Open the browser")] = True,
    quiet: options.Quiet = False,
) -> None:
    """Photograph a scene in the browser: turn the rings, edit the lens, and see the picture follow."""
    try:
        from ..viewer.server.access import is_local
        from ..viewer.server.server import ServerSettings, check_port, serve
        from ..viewer.shot_source import ShotSource
    except ImportError as error:
        raise InputError(f"the lens bench needs {error.name}; pip install realcam[view] installs it") from None
    if not is_local(host) and not allow_network:
        raise InputError(f"--host {host}: other machines can reach this address; --allow-network permits this")
    if quiet and not (is_local(host) or token):
        raise InputError("--quiet hides the token that --allow-network creates; specify one with --token")
    check_port(host, port)  # before reading the scene, which may take long
    path = scenes_folder() / "demo.toml" if shot is None else shot
    source, opened = ShotSource.opened(path, device, words_of(changes))
    folders = (Path.cwd(), *(folder or ()))
    settings = ServerSettings(folders, host, port, device, token, shows_browser=browser, tells_address=not quiet)
    serve(opened, source, settings)
