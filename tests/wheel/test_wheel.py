"""The wheel as distributed: its contents, its requirements of the system, and its licences.

`./run wheel` makes it and names it in REALCAM_WHEEL.
"""

from __future__ import annotations

import os
import re
import stat
import zipfile
from io import BytesIO
from pathlib import Path

import pytest

elffile = pytest.importorskip("elftools.elf.elffile", reason="pyelftools comes with realcam[wheel]")
auditwheel_policy = pytest.importorskip("auditwheel.policy", reason="auditwheel comes with realcam[wheel]")

if "REALCAM_WHEEL" not in os.environ:
    pytest.skip("REALCAM_WHEEL names no wheel", allow_module_level=True)
WHEEL = Path(os.environ["REALCAM_WHEEL"])
FILES = zipfile.ZipFile(WHEEL)

# Libraries that the wheel may contain, and their licences. GPL libraries are excluded, in every version, with or
# without exceptions.
LICENCES = {
    "libembree3": "Apache-2.0",
    "libembree4": "Apache-2.0",
    "libtbb": "Apache-2.0",
    "libpng16": "libpng",
    "libdraco": "Apache-2.0",
    "libmeshoptimizer": "MIT",
}
POLICY = next(
    policy
    for policy in auditwheel_policy.WheelPolicies(
        libc=auditwheel_policy.Libc.GLIBC, arch=auditwheel_policy.Architecture.x86_64
    )
    if policy.name == "manylinux_2_34_x86_64"
)


def libraries() -> dict[str, elffile.ELFFile]:
    """All files of the wheel that are ELF, whatever they are called."""
    contents = {name: FILES.read(name) for name in FILES.namelist()}
    return {name: elffile.ELFFile(BytesIO(data)) for name, data in contents.items() if data[:4] == b"\x7fELF"}


LIBRARIES = libraries()
EXTENSION = next(name for name in LIBRARIES if re.fullmatch(r"realcam/_core\..*\.so", name))


def needed(library: elffile.ELFFile) -> set[str]:
    dynamic = library.get_section_by_name(".dynamic")
    return {tag.needed for tag in dynamic.iter_tags("DT_NEEDED")}


def plain_name(file: str) -> str:
    """Name of a library without auditwheel's hash and its version: libdraco of realcam.libs/libdraco-0a1b2c3d.so.7."""
    return re.sub(r"(-[0-9a-f]{8})?\.so.*", "", Path(file).name)


def test_its_name_says_where_it_runs() -> None:
    assert WHEEL.name.endswith("-manylinux_2_34_x86_64.whl")
    assert WHEEL.stat().st_size <= 30e6


def test_there_is_one_extension_and_no_program() -> None:
    own = {name for name in LIBRARIES if not name.startswith("realcam.libs/")}
    assert own == {EXTENSION}
    for name, library in LIBRARIES.items():
        assert library.get_section_by_name(".interp") is None, f"{name} is a program"
    # Shared libraries are marked as programs by auditwheel; other files are not.
    others = [info for info in FILES.infolist() if info.filename not in LIBRARIES]
    assert not [info.filename for info in others if (info.external_attr >> 16) & stat.S_IXUSR]


def test_all_that_it_needs_is_inside_or_in_the_policy() -> None:
    inside = {Path(name).name for name in LIBRARIES}
    for name, library in LIBRARIES.items():
        assert needed(library) <= inside | set(POLICY.whitelist) | {"ld-linux-x86-64.so.2"}, name


def test_no_symbol_is_newer_than_the_policy() -> None:
    for name, library in LIBRARIES.items():
        section = library.get_section_by_name(".gnu.version_r")
        for _, entries in section.iter_versions():
            for entry in entries:
                kind, _, version = entry.name.partition("_")
                assert kind != "GLIBC" or tuple(map(int, version.split("."))) <= (2, 34), f"{name}: {entry.name}"


def test_every_library_inside_has_a_licence_that_allows_it() -> None:
    """The closure: a library that one of these brings along is in the wheel, too, or the policy has it."""
    for name in LIBRARIES:
        if name == EXTENSION:
            continue
        library = plain_name(name)
        assert library in LICENCES, f"{library} is new: which licence has it?"
        texts = [file for file in FILES.namelist() if f".dist-info/licenses/{library}/" in file]
        assert texts, f"{library}: its licence is not in the wheel"
        assert not any("GPL" in Path(text).name for text in texts)
        expected = {"Apache-2.0": b"Apache License", "libpng": b"libpng", "MIT": b"without restriction"}[
            LICENCES[library]
        ]
        assert any(expected in FILES.read(text) for text in texts)


def test_what_realcam_demo_wants_is_inside() -> None:
    assert {"realcam/scenes/demo.glb", "realcam/scenes/demo.toml", "realcam/_core.pyi", "realcam/py.typed"} <= set(
        FILES.namelist()
    )


def test_compressed_meshes_can_be_read() -> None:
    """Without these libraries CMake builds a wheel all the same, which then refuses such files."""
    assert {"libdraco", "libmeshoptimizer"} <= {plain_name(name) for name in LIBRARIES}
