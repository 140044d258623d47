"""The wheel of the GPU plug-in: its contents, its requirements of the system, and its version stamp.

`./run wheel cuda` makes it and names it in REALCAM_CUDA_WHEEL; so does `./run wheel test`, where realcam is its wheel.
"""

from __future__ import annotations

import ctypes
import os
import re
import subprocess
import sys
import zipfile
from io import BytesIO
from pathlib import Path

import pytest

if "REALCAM_CUDA_WHEEL" not in os.environ:
    pytest.skip("REALCAM_CUDA_WHEEL names no wheel", allow_module_level=True)
WHEEL = Path(os.environ["REALCAM_CUDA_WHEEL"])
VERSION = WHEEL.name.split("-")[1]
FILES = zipfile.ZipFile(WHEEL)
LIBRARY = "realcam_cuda13/librealcam_cuda13.so"


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Path(FILES.extract(LIBRARY, tmp_path_factory.mktemp("wheel")))


def test_its_name_says_where_it_runs() -> None:
    assert re.fullmatch(r"realcam_cuda13-[\d.]+-py3-none-manylinux_2_34_x86_64\.whl", WHEEL.name)
    assert WHEEL.stat().st_size <= 90e6


def test_it_is_one_library_with_its_licences() -> None:
    found = {name for name in FILES.namelist() if FILES.read(name)[:4] == b"\x7fELF"}
    assert found == {LIBRARY}
    assert b"NVIDIA" in FILES.read("realcam_cuda13/CUDA-EULA.txt")


def test_it_needs_the_system_alone_and_shows_two_functions() -> None:
    """The CUDA runtime is linked statically; the driver is loaded when the first GPU is requested."""
    elffile = pytest.importorskip("elftools.elf.elffile", reason="pyelftools comes with realcam[wheel]")
    elf = elffile.ELFFile(BytesIO(FILES.read(LIBRARY)))
    needed = {tag.needed for tag in elf.get_section_by_name(".dynamic").iter_tags("DT_NEEDED")}
    system = {"libstdc++.so.6", "libm.so.6", "libgcc_s.so.1", "libc.so.6", "ld-linux-x86-64.so.2"}
    assert needed <= system
    symbols = elf.get_section_by_name(".dynsym").iter_symbols()
    shown = {s.name for s in symbols if s["st_shndx"] != "SHN_UNDEF" and s["st_info"]["bind"] == "STB_GLOBAL"}
    assert shown == {"realcam_cuda_stamp", "realcam_cuda_backend"}


def test_it_asks_for_realcam_of_its_version() -> None:
    lines = FILES.read(f"realcam_cuda13-{VERSION}.dist-info/METADATA").decode().splitlines()
    assert f"Requires-Dist: realcam=={VERSION}" in lines


def test_its_stamp_is_of_this_version(library: Path) -> None:
    stamp = ctypes.CDLL(str(library)).realcam_cuda_stamp
    stamp.restype = ctypes.c_char_p
    assert re.fullmatch(rf"{re.escape(VERSION)} \(build [0-9a-f]{{12}}\)", stamp().decode())


def test_without_a_driver_the_cpu_goes_on(library: Path) -> None:
    """No GPU is visible, whether or not this machine has one."""
    pytest.importorskip("realcam", reason="realcam is not built here", exc_type=ImportError)
    environment = {**os.environ, "REALCAM_CUDA_PLUGIN": str(library), "CUDA_VISIBLE_DEVICES": ""}
    command = [sys.executable, "-m", "realcam", "devices"]
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert done.returncode == 0
    assert [line.split()[0] for line in done.stdout.splitlines()] == ["cpu"]
    assert re.fullmatch(r"realcam: no GPU: there is no NVIDIA (driver|GPU).*\n", done.stderr)
