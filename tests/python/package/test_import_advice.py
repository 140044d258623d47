"""An extension that cannot be loaded ends in one sentence, for Python and for the command line."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import realcam
from realcam.installation import advised

PACKAGES = Path(realcam.__file__).parents[1]


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        # Messages of glibc's loader.
        ("/lib/x86_64-linux-gnu/libm.so.6: version `GLIBC_2.34' not found (required by _core.so)", "glibc 2.34 or"),
        ("/lib64/libstdc++.so.6: version `GLIBCXX_3.4.29' not found (required by _core.so)", "glibc 2.34 or later"),
        ("cannot import name '_core' from partially initialized module 'realcam'", "is not built for Python 3."),
    ],
)
def test_a_sentence_says_what_to_do(said: str, expected: str) -> None:
    text = str(advised(ImportError(said)))
    assert expected in text
    assert "build" in text.partition(";")[2]
    assert "\n" not in text


def test_other_errors_stay() -> None:
    error = ImportError("undefined symbol: x")
    assert advised(error) is error


VIEW = ["nicegui", "simplejpeg", "tomlkit"]
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


@pytest.mark.parametrize(
    ("missing", "words", "expected"),
    [
        *((name, ["view"], f"the lens bench needs {name}; pip install realcam[view] installs it") for name in VIEW),
        ("OpenImageIO", ["render", "scene.obj", "--lens", "double-gauss-50mm", "--spp", "1", "-o", "a.png"],
         "picture files need the package OpenImageIO; pip install OpenImageIO installs it"),
    ],
)  # fmt: skip
def test_a_missing_package_is_told_with_what_brings_it(
    tmp_path: Path, missing: str, words: list[str], expected: str
) -> None:
    """The packages of realcam[denoise] and realcam[raw] are tested in test_denoiser.py and test_sensor_hard.py."""
    (tmp_path / "scene.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    code = f"import sys; sys.modules[{missing!r}] = None; {COMMAND}"
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, cwd=tmp_path)
    *_, last = done.stderr.splitlines()
    assert done.returncode == 2
    assert last.startswith("realcam: error: ")
    assert expected in last
    assert not (tmp_path / "a.png").exists()
