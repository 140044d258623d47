"""The command `realcam demo`: renders a bundled scene through a double Gauss and through a thin lens."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from .._core import Lens
from ..bundled_scenes import scenes_folder
from ..denoiser import is_installed
from ..files import make_folder
from . import options


def demo(
    output: Annotated[
        Path,
        options.output("Folder for the pictures; created if it is missing", "FOLDER"),
    ] = Path("realcam-demo"),
    spp: Annotated[
        int | None,
        typer.Option(metavar="N", help="Samples per pixel; 24 if denoised, 48 if not", min=1, max=2**24),
    ] = None,
    denoise: Annotated[
        bool | None,
        typer.Option(help="Denoise the pictures; the default if realcam[denoise] is installed"),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Photograph the demo scene through a double Gauss, and once more through an ideal thin lens."""
    from ..drawing.lens_drawings import save_cross_section  # brings matplotlib, which other commands need not load

    shot = scenes_folder() / "demo.toml"
    denoises = is_installed() if denoise is None else denoise
    samples = spp or (24 if denoises else 48)
    denoise_option = ["--denoise"] if denoises else []
    new_folders = [folder for folder in (output, *output.parents) if not folder.exists()]
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))  # so that finally clauses run
    make_folder(output)
    try:
        _render(shot, samples, quiet, output / "demo.png", output / "demo.exr", *denoise_option)
        _render(shot, max(1, samples // 4), quiet, output / "demo-thin-lens.png", "--model", "thin", *denoise_option)
        # The lens as in the demo shot: wide open and at close focus.
        save_cross_section(Lens.load("double-gauss-50mm").focused(1.05), output / "lens.png")
    finally:
        for folder in new_folders:
            with suppress(OSError):
                folder.rmdir()  # fails, and is ignored, if something was written
    for name, what in (
        ("demo.png", "the photograph, denoised" if denoises else "the photograph"),
        ("demo.exr", "its film exposure in lux seconds, and depth"),
        ("demo-thin-lens.png", "the same through an ideal lens: no vignetting, no aberrations"),
        ("lens.png", "the lens and its rays"),
    ):
        if not quiet:
            typer.echo(f"{output / name}: {what}")
    if denoise is None and not denoises and not quiet:
        typer.echo("pip install realcam[denoise] installs a denoiser, which removes the remaining noise")


def _render(shot: Path, spp: int, quiet: bool, *arguments: Path | str) -> None:
    """Runs `realcam render` as a subprocess, which reports its own errors and receives Ctrl-C from the terminal.

    arguments: paths of output files, and words of the command line. Exits with the subprocess's code if it fails.
    """
    words = [word if isinstance(word, str) else f"--output={word}" for word in arguments]
    # Runs this package, not a module of the same name in the current folder.
    python = [sys.executable, *(["-P"] if sys.version_info >= (3, 11) else []), "-m", "realcam"]
    paths = os.pathsep.join([str(Path(__file__).resolve().parents[2]), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "PYTHONPATH": paths.rstrip(os.pathsep)}
    command = [*python, "render", str(shot), "--spp", str(spp), *words, *(["--quiet"] if quiet else [])]
    with subprocess.Popen(command, env=environment) as program:
        try:
            while True:
                with suppress(KeyboardInterrupt):
                    code = program.wait()
                    break
        finally:
            if program.poll() is None:
                program.terminate()
    if code != 0:
        sys.exit(code if code > 0 else 128 - code)  # -N: killed by signal N, which shells report as 128 + N
