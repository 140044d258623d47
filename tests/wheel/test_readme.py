"""README.md as a newcomer follows it: its Python block and its commands, in an empty folder.

REALCAM_PYTHON names the Python that has realcam installed; otherwise it is the one that runs the test.
"""

from __future__ import annotations

import itertools
import os
import re
import resource
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

README = Path(__file__).resolve().parents[2] / "README.md"
PYTHON = os.environ.get("REALCAM_PYTHON", sys.executable)
CPU_S = 20
# Prints who denoised a picture.
DENOISER = """
import sys
import OpenImageIO
print(OpenImageIO.ImageBuf(sys.argv[1]).spec().getattribute("realcam:denoiser"))
"""


def python_block() -> str:
    (block,) = re.findall(r"^```python\n(.*?)^```", README.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    return str(block)


def commands() -> list[list[str]]:
    """Commands in the README's section about the command line, without comments."""
    section = README.read_text(encoding="utf-8").partition("\n## Command line\n")[2].partition("\n## ")[0]
    return [shlex.split(line, comments=True) for line in re.findall(r"^    (realcam .*)", section, re.MULTILINE)]


def run(words: Sequence[str], folder: Path) -> tuple[float, str]:
    """Runs a program in a folder, hidden from the repository. Returns its CPU seconds and its output."""
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "REALCAM_OIDN")}

    def used() -> float:
        times = resource.getrusage(resource.RUSAGE_CHILDREN)
        return times.ru_utime + times.ru_stime

    before = used()
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "warning" not in done.stderr, done.stderr
    return used() - before, done.stdout


def all_steps(folder: Path) -> float:
    """CPU seconds."""
    folder.mkdir()
    realcam = str(Path(PYTHON).parent / "realcam")
    programs = [[PYTHON, "-c", python_block()], *([realcam, *words[1:]] for words in commands())]
    return sum(run(words, folder)[0] for words in programs)


@pytest.mark.slow
@pytest.mark.picture_files
def test_the_first_steps_run_in_an_empty_folder_without_grain(tmp_path: Path) -> None:
    if run([PYTHON, "-c", "from realcam.installation import denoiser_library as d; print(d())"], tmp_path)[1] == "\n":
        pytest.skip("pictures are denoised, and the extra realcam[denoise] is not installed")
    seconds = all_steps(tmp_path / "first")
    if seconds > CPU_S:  # other programs on the machine can increase the CPU time
        seconds = min(seconds, all_steps(tmp_path / "second"))
    named = set(re.findall(r'save\("(.*?)"\)', python_block()))
    named |= {word for words in commands() for option, word in itertools.pairwise(words) if option == "-o"}
    assert {path.name for path in (tmp_path / "first").iterdir()} == named
    pictures = [name for name in named if name.endswith(".png")]
    assert len(pictures) >= 2
    for name in pictures:
        assert run([PYTHON, "-c", DENOISER, name], tmp_path / "first")[1].startswith("Open Image Denoise 2."), name
    assert seconds <= CPU_S


def test_the_readme_is_short() -> None:
    assert len(README.read_text(encoding="utf-8").splitlines()) <= 140
