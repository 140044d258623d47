"""Entry point of the commands in Python: the list of commands, and errors as one line."""

from __future__ import annotations

import sys
import warnings
from typing import NoReturn

import typer

from .. import __version__
from .._core import LensFileError, RealcamError, _record_inputs, one_line
from . import bench, calibration, compare, cost, dataset, demo, job, lens, sensor, view
from .commands_in_cpp import add_command_in_cpp
from .help_texts import finish
from .options import advice_on
from .usage_message import UsageError, usage_message

app = typer.Typer(
    help="Photographs 3D scenes through real lenses.",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # the help shows defaults in [brackets], which rich would take for markup
    context_settings={"help_option_names": ["-h", "--help"]},  # inherited by all subcommands
)
add_command_in_cpp(app, "render")
add_command_in_cpp(app, "plan")
app.add_typer(lens.app, name="lens")
add_command_in_cpp(app, "devices")
app.add_typer(sensor.app, name="sensor")
app.add_typer(calibration.app, name="calibration")
app.command("expose")(sensor.expose)
app.command("demo")(demo.demo)
app.command("bench")(bench.bench)
app.command("cost")(cost.cost)
app.command("compare")(compare.compare)
app.add_typer(job.app, name="job")
app.command("dataset")(dataset.dataset)
app.command("view")(view.view)


def _print_version(is_set: bool) -> None:
    if is_set:
        typer.echo(f"realcam {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: bool = typer.Option(False, "--version", callback=_print_version, is_eager=True, help="Print the version"),
) -> None:
    pass


def run() -> None:
    """Runs the command line of this process and exits: with 2 after an error, which is printed on stderr in one line,
    and with 130 after Ctrl-C."""
    warnings.showwarning = _show_warning
    warnings.simplefilter("always", UserWarning)
    command = typer.main.get_command(app)
    finish(command)
    _record_inputs(sys.argv[1:2] != ["view"])  # not for the bench, whose user may overwrite its input files
    try:
        sys.exit(command(sys.argv[1:] or ["--help"], prog_name="realcam", standalone_mode=False))
    except UsageError as error:
        _fail(usage_message(error))
    except LensFileError as error:
        _fail(str(error) + advice_on(error))
    except RealcamError as error:
        _fail(str(error))
    except OSError as error:
        _fail(f"{error.filename or 'file'}: {error.strerror or error}")
    except MemoryError:
        _fail("out of memory; use fewer pixels or a smaller scene")
    except (KeyboardInterrupt, typer.Abort):
        print("realcam: stopped", file=sys.stderr)
        sys.exit(130)
    finally:
        _record_inputs(False)


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"realcam: warning: {one_line(str(message))}", file=sys.stderr)


def _fail(message: str) -> NoReturn:
    print(f"realcam: error: {one_line(message)}", file=sys.stderr)
    sys.exit(2)
