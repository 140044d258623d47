"""./run in a folder that was moved after its build, and which wheels it makes."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


def run(*command: object) -> str:
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stderr


def forget_what_was_moved(folder: Path) -> str:
    """Runs the clean-up that ./run does before it sets up (`help` only defines its functions). Returns the output."""
    return run("bash", "-c", 'source "$0" help && forget_what_was_moved build/dev', folder / "run")


@pytest.fixture
def built(tmp_path: Path) -> Path:
    """A repository after its build: a CMake build tree and a virtual environment, both real, and little in them."""
    if not all(map(shutil.which, ("bash", "cmake", "ninja"))):
        pytest.skip("./run wants bash, cmake and ninja")
    folder = tmp_path / "a folder"
    folder.mkdir()
    shutil.copy(ROOT / "run", folder)
    (folder / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(built LANGUAGES NONE)\n")
    run("cmake", "-G", "Ninja", "-S", folder, "-B", folder / "build/dev")
    run(sys.executable, "-m", "venv", "--without-pip", folder / ".venv")
    return folder


def elsewhere(folder: Path) -> Path:
    """A path that ends like the old one, which is then found in it."""
    new = Path(f"{folder.parent}/backup{folder}")
    new.parent.mkdir(parents=True)
    return new


def is_set_up(folder: Path) -> bool:
    return (folder / "build/dev/CMakeCache.txt").exists() and (folder / ".venv/bin/activate").exists()


def test_a_folder_that_stayed_keeps_its_build(built: Path) -> None:
    """The folder is given by its own path and by a link."""
    link = built.with_name("link")
    link.symlink_to(built)
    for path in (built, link):
        assert forget_what_was_moved(path) == ""
        assert is_set_up(built)


def test_a_folder_that_was_moved_is_set_up_anew(built: Path) -> None:
    new = elsewhere(built)
    built.rename(new)
    said = forget_what_was_moved(new)
    assert f"built in {built};" in said and f"made as {built}/.venv;" in said
    assert not (new / "build/dev").exists() and not (new / ".venv").exists()
    assert forget_what_was_moved(new) == ""


def test_a_copy_is_set_up_anew_and_its_original_kept(built: Path) -> None:
    new = elsewhere(built)
    shutil.copytree(built, new, symlinks=True)
    assert forget_what_was_moved(new)
    assert not (new / "build/dev").exists() and not (new / ".venv").exists()
    assert is_set_up(built)


def test_a_wheel_is_made_for_each_python_that_is_installed(built: Path) -> None:
    (built / "tools").mkdir()
    pythons = "3.10 /opt/python3.10\n3.11 \n3.12 /a folder/python3.12\n"
    (built / "tools/make_wheel.py").write_text(f"print({pythons!r}, end='')")
    stubs = 'install_packages() { :; }; install_python() { :; }; make_wheel() { say "for $1"; }'
    said = run("bash", "-c", f'source "$0" help; {stubs}; run_wheel all', built / "run")
    assert re.findall(r"(?:for|no Python) .*", said) == [
        "for /opt/python3.10",
        "no Python 3.11 is installed here",
        "for /a folder/python3.12",
    ]
