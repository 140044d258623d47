"""realcam render --frames ... -o film.mp4: frames that C++ writes as pictures, as a film."""

from __future__ import annotations

import argparse
import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

import numpy as np

from .. import _core
from .._core import InputError
from ..extras import imported
from ..files import check_target, make_folder
from ..video import write_video
from .options import frame_numbers, say_written


def render_films(words: list[str]) -> int:
    """What `realcam render` does with the words behind it, of which an output is a film; the exit code.

    The frames of "film.mp4" are pictures in the folder "film.mp4.frames" until the film is whole, so that a film that
    was stopped goes on where it was. Raises InputError, ImageFileError.
    """
    said, rest = _parser().parse_known_args(words)
    if not said.frames:
        raise InputError("--frames is missing: a film, .mp4, is made of frames, as of 1-240")
    if not hasattr(_core, "_run_command"):
        raise InputError("this build of realcam has no picture files, and takes no films")
    numbers = frame_numbers(said.frames)
    films = [Path(output) for output in said.output if _is_film(output)]
    imported("av", "video")  # before the work
    outputs = [output for output in said.output if not _is_film(output)]
    for film in films:
        check_target(film)
        folder = _folder_of(film)
        make_folder(folder)
        outputs.append(str(folder / "######.png"))
    fps = ["--fps", str(said.fps)]
    quiet = ["--quiet"] if said.quiet else []
    code = _render([*rest, *quiet, "--frames", said.frames, *fps, *(w for output in outputs for w in ("-o", output))])
    if code != 0:
        return code
    for film in films:
        write_video(film, _pictures(_folder_of(film), numbers), said.fps)
        shutil.rmtree(_folder_of(film))
        say_written(film, said.quiet)
    return 0


def _render(words: list[str]) -> int:
    """The command in C++, which takes signals itself."""
    before = signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        return _core._run_command([os.fsencode(word) for word in ("render", *words)])
    finally:
        signal.signal(signal.SIGINT, before)


def _is_film(output: str) -> bool:
    return output.lower().endswith(".mp4")


def _folder_of(film: Path) -> Path:
    return film.with_name(f"{film.name}.frames")


def _pictures(folder: Path, numbers: range) -> Iterator[np.ndarray]:
    av = imported("av", "video")
    for number in numbers:
        with av.open(str(folder / f"{number:06d}.png")) as picture:
            yield next(picture.decode(video=0)).to_ndarray(format="rgb24")


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise InputError(message)


def _parser() -> _Parser:
    parser = _Parser(add_help=False, allow_abbrev=False)
    parser.add_argument("-o", "--output", action="append", default=[])
    parser.add_argument("-q", "--quiet", action="store_true")
    parser.add_argument("--frames")
    parser.add_argument("--fps", type=float, default=24.0)
    return parser
