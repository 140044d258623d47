"""An extension that cannot be loaded ends in one sentence, for Python and for the command line."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import realcam
from realcam.import_advice import advised

PACKAGES = Path(realcam.__file__).parents[1]


@pytest.mark.parametrize(
    ("said", "wanted"),
    [
        # As glibc's loader says it.
        ("/lib/x86_64-linux-gnu/libm.so.6: version `GLIBC_2.34' not found (required by _core.so)", "glibc 2.34 or"),
        ("/lib64/libstdc++.so.6: version `GLIBCXX_3.4.29' not found (required by _core.so)", "glibc 2.34 or later"),
        ("cannot import name '_core' from partially initialized module 'realcam'", "is not built for Python 3."),
    ],
)
def test_a_sentence_says_what_to_do(said: str, wanted: str) -> None:
    text = str(advised(ImportError(said)))
    assert wanted in text
    assert "build" in text.partition(";")[2]
    assert "\n" not in text


def test_other_errors_stay() -> None:
    error = ImportError("undefined symbol: x")
    assert advised(error) is error


COMMAND = "from realcam_command.main import main; main()"


@pytest.mark.parametrize("words", [["-c", "import realcam"], ["-m", "realcam"], ["-c", COMMAND, "devices"]])
def test_a_package_without_its_extension_says_so(tmp_path: Path, words: list[str]) -> None:
    for name in ("realcam", "realcam_command"):
        shutil.copytree(PACKAGES / name, tmp_path / name, ignore=shutil.ignore_patterns("*.so"))
    # Without the packages of this Python, among which realcam is.
    done = subprocess.run([sys.executable, "-S", *words], capture_output=True, text=True, cwd=tmp_path)
    *trace, last = done.stderr.splitlines()
    assert done.returncode != 0
    assert "realcam is not built for Python 3." in last
    if COMMAND in words:
        assert (done.returncode, trace) == (2, [])
        assert last.startswith("realcam: error: ")
