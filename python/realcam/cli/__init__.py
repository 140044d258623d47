"""The command line: `realcam`."""

from __future__ import annotations

import sys

import typer

from .. import __version__
from .._core import RealcamError, devices
from . import bench, demo, lens, render

app = typer.Typer(
    help="Photographs 3D scenes through real lenses.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # defaults in the help stand in [brackets]
)
app.add_typer(lens.app, name="lens")
app.command("render")(render.render)
app.command("demo")(demo.demo)
app.command("bench")(bench.bench)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"realcam {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: bool = typer.Option(False, "--version", callback=_print_version, is_eager=True, help="Print the version."),
) -> None:
    pass


@app.command("devices")
def list_devices() -> None:
    """List what this machine can render with."""
    for line in devices():
        typer.echo(line)


def main() -> None:
    """Runs the command line; the user's mistakes end in one line on stderr and exit code 2."""
    try:
        app()
    except RealcamError as error:
        _fail(str(error))
    except OSError as error:
        _fail(f"{error.filename or 'file'}: {error.strerror or error}")
    except MemoryError:
        _fail("out of memory; fewer pixels or a smaller scene are wanted")


def _fail(message: str) -> None:
    print(f"realcam: error: {message}", file=sys.stderr)
    sys.exit(2)
