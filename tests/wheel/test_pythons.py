"""The Pythons that ./run wheel all makes wheels for."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]
if not (ROOT / "tools").is_dir():
    pytest.skip("wants the repository's tools", allow_module_level=True)


@pytest.fixture
def make_wheel() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_wheel", ROOT / "tools" / "make_wheel.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def program(path: Path, script: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


def test_a_python_is_taken_for_what_it_says_it_is(
    make_wheel: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, pyenv = tmp_path / "bin", tmp_path / "pyenv"
    program(path / "python3.10", "echo 'pyenv: python3.10: command not found' >&2; exit 127")
    program(path / "python3.11", "echo 11 /opt/with a space/python3.11")
    program(path / "python3.12", "echo 13 /opt/python3.13")  # a link to another version
    program(path / "python3.13", "exit 1")  # without headers
    (path / "python3.14").write_text("no program")
    program(pyenv / "versions/3.10.4/bin/python3.10", "echo 10 /pyenv/python3.10")
    program(pyenv / "versions/3.11.1/bin/python3.11", "echo 11 /pyenv/python3.11")
    program(pyenv / "versions/3.13t.0/bin/python3.13", "echo 13 /pyenv/python3.13t")
    monkeypatch.setenv("PATH", f"{path}:/nowhere")
    monkeypatch.setenv("PYENV_ROOT", str(pyenv))
    monkeypatch.setattr(make_wheel, "MINORS", range(10, 15))
    taken = {10: "/pyenv/python3.10", 11: "/opt/with a space/python3.11"}
    assert make_wheel.installed_pythons() == {10: "", 11: "", 12: "", 13: "", 14: ""} | taken


def test_this_python_is_known(make_wheel: ModuleType) -> None:
    minor = sys.version_info[1]
    assert make_wheel.executable_of(Path(sys.executable), minor) in ("", sys.executable)  # "": without headers
    assert make_wheel.executable_of(Path(sys.executable), minor + 1) == ""
    assert make_wheel.executable_of(Path("/nowhere/python3.10"), 10) == ""


def test_the_workflow_has_the_same_pythons(make_wheel: ModuleType) -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    built = re.search(r"^build = \[(.*)\]", text, re.MULTILINE)
    assert built and re.findall(r"cp3(\d+)-", built[1]) == [str(minor) for minor in make_wheel.MINORS]
    assert f'requires-python = ">=3.{make_wheel.MINORS[0]}"' in text
