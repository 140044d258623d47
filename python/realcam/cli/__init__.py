"""The commands that are Python. The package realcam_command hands the others to the extension."""

from __future__ import annotations

import sys
import warnings
from typing import Any, NoReturn

import typer

from .. import __version__
from .._core import LensFileError, RealcamError, one_line
from . import bench, cost, demo, lens, sensor, view
from .help_texts import finish_help
from .options import add_command_in_cpp, advice_on

# click's, which newer versions of typer bring along under a private name.
_UsageError: Any = typer.BadParameter.__bases__[0]

app = typer.Typer(
    help="Photographs 3D scenes through real lenses.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # defaults in the help stand in [brackets]
    context_settings={"help_option_names": ["-h", "--help"]},  # of all commands below, too
)
add_command_in_cpp(app, "render", "Photograph a scene through a lens.")
add_command_in_cpp(app, "plan", "Say which effects a shot calls for, and why.")
app.add_typer(lens.app, name="lens")
add_command_in_cpp(app, "devices", "List what this machine can render with.")
app.add_typer(sensor.app, name="sensor")
app.command("expose")(sensor.expose)
app.command("demo")(demo.demo)
app.command("bench")(bench.bench)
app.command("cost")(cost.cost)
app.command("view")(view.view)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"realcam {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: bool = typer.Option(False, "--version", callback=_print_version, is_eager=True, help="Print the version."),
) -> None:
    pass


def run() -> None:
    """Runs the command line; the user's mistakes end in one line on stderr and exit code 2, Ctrl-C in 130."""
    warnings.showwarning = _show_warning
    warnings.simplefilter("always", UserWarning)
    command = typer.main.get_command(app)
    finish_help(command)
    try:
        sys.exit(command(sys.argv[1:] or ["--help"], prog_name="realcam", standalone_mode=False))
    except _UsageError as error:
        _fail(_usage_message(error))
    except LensFileError as error:
        _fail(str(error) + advice_on(error))
    except RealcamError as error:
        _fail(str(error))
    except OSError as error:
        _fail(f"{error.filename or 'file'}: {error.strerror or error}")
    except MemoryError:
        _fail("out of memory; fewer pixels or a smaller scene are wanted")
    except (KeyboardInterrupt, typer.Abort):
        print("realcam: stopped", file=sys.stderr)
        sys.exit(130)


def _usage_message(error: Any) -> str:
    """What is wrong, what was meant, and where the options stand."""
    context = error.ctx
    commands = getattr(context.command, "commands", None) if context else None
    where = f"{context.command_path if context else 'realcam'} --help lists the {'commands' if commands else 'options'}"
    near = getattr(error, "possibilities", None)
    if near:
        meant = " or ".join(sorted(near))
        return f"{error.message.rstrip('.')} (did you mean {meant}?) ({where})"
    if commands and error.format_message().startswith("Missing command"):
        return f"a command is missing; {', '.join(commands)} are known ({where})"
    return f"{error.format_message()} ({where})"


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"realcam: warning: {one_line(str(message))}", file=sys.stderr)


def _fail(message: str) -> NoReturn:
    print(f"realcam: error: {one_line(message)}", file=sys.stderr)
    sys.exit(2)
