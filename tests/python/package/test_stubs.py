"""The stub of the extension is that of its bindings, and the package passes mypy in strict mode."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
import realcam
from realcam import _core

ROOT = Path(__file__).resolve().parents[3]
STUB = Path(realcam.__file__).with_name("_core.pyi")


def run(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False)


def test_the_stub_is_packaged() -> None:
    assert STUB.is_file()
    assert STUB.with_name("py.typed").is_file()


def test_the_stub_is_that_of_the_bindings() -> None:
    pytest.importorskip("pybind11_stubgen", reason="pybind11-stubgen comes with the dev extra")
    result = run("tools/make_stub.py", "--check")
    assert result.returncode == 0, result.stdout + result.stderr


def test_all_that_the_package_offers_exists() -> None:
    assert len(realcam.__all__) == len(set(realcam.__all__))
    for name in realcam.__all__:
        assert hasattr(realcam, name), name


def test_every_public_function_says_what_it_does() -> None:
    """pybind11's signature, and at least one line of text."""
    for name in vars(_core):
        if name.startswith("_"):
            continue
        thing = getattr(_core, name)
        text = inspect.getdoc(thing) or ""
        lines = text.splitlines()
        assert len(lines) >= (1 if isinstance(thing, type) else 2), name


# What pybind11 makes of every class, which no stub says.
PYBIND11 = re.compile(r"metaclass differs$|__init__ is inconsistent, stub does not have \*args parameter")


@pytest.mark.slow
def test_stubtest_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    """mypy's own comparison of stub and module: names, kinds, and types of constants."""
    pytest.importorskip("mypy", reason="mypy comes with the dev extra")
    monkeypatch.setenv("MYPYPATH", str(ROOT / "python"))
    result = run("-m", "mypy.stubtest", "realcam._core", "--concise")
    lines = [line for line in result.stdout.splitlines() if line and not PYBIND11.search(line)]
    assert not lines, "\n".join(lines)
    # It ran: pybind11's own differences are there.
    assert "realcam._core.Camera" in result.stdout, result.stdout + result.stderr
