"""Builds a self-contained wheel of realcam, for `./run wheel` and the workflow of wheels.

The wheel contains the shared libraries that the extension needs, and their licences. --cuda builds the wheel
realcam-cuda13, the plug-in for GPUs. --pythons lists the CPythons of this machine for which wheels can be built.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLATFORM = "manylinux_2_34_x86_64"
# The minor versions of CPython 3 that have wheels: those of tool.cibuildwheel in pyproject.toml.
MINORS = range(10, 15)
# Program that prints the minor version and the executable of a CPython with a GIL, headers and virtual environments,
# and fails in any other Python.
PROBE = """
import ensurepip, os, platform, sys, sysconfig, venv
os.stat(os.path.join(sysconfig.get_path("include"), "Python.h"))
assert platform.python_implementation() == "CPython" and not sysconfig.get_config_var("Py_GIL_DISABLED")
print(sys.version_info[1], sys.executable)
"""
# Licence to which Debian's copyright files refer. Their references to the GPL concern the packaging, and files that are
# not part of the libraries.
APACHE = Path("/usr/share/common-licenses/Apache-2.0")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", help="folder for the wheel")
    parser.add_argument(
        "--pythons", action="store_true", help="list the Pythons for which wheels can be built, and exit"
    )
    parser.add_argument("--python", default=sys.executable, help="Python for which the wheel is built")
    parser.add_argument("--cuda", action="store_true", help="build the plug-in for GPUs, which requires nvcc")
    parser.add_argument("--repair", type=Path, metavar="WHEEL", help="complete this wheel instead of building one")
    arguments = parser.parse_args()
    if arguments.pythons:
        for minor, python in installed_pythons().items():
            print(f"3.{minor}", python or "")
        return
    if arguments.folder is None:
        parser.error("the folder for the wheel is missing")
    arguments.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        built = arguments.repair or build(Path(scratch, "built"), arguments.python, arguments.cuda)
        repaired = repair(built, Path(scratch, "repaired"))
        print(with_licences(repaired, Path(scratch, "open"), arguments.folder))


def run(*command: str | Path, env: dict[str, str] | None = None) -> str:
    """Runs a command in the root folder, and returns its output. Raises CalledProcessError if it fails."""
    return subprocess.run([*map(str, command)], check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=env).stdout


def installed_pythons() -> dict[int, str]:
    """Returns the executable for each of MINORS, from PATH or pyenv; empty if there is none."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    found = {}
    for minor in MINORS:
        name = f"python3.{minor}"
        in_path = [Path(folder, name) for folder in os.environ.get("PATH", "").split(os.pathsep)]
        candidates = [*in_path, *sorted(pyenv.glob(f"versions/3.{minor}.*/bin/{name}"))]
        found[minor] = next(filter(None, (executable_of(each, minor) for each in candidates)), "")
    return found


def executable_of(python: Path, minor: int) -> str:
    """Executable of `python` if it is a CPython 3.`minor` for which a wheel can be built; otherwise empty."""
    if not os.access(python, os.X_OK):
        return ""
    output = subprocess.run([python, "-c", PROBE], capture_output=True, text=True).stdout.strip().partition(" ")
    return output[2] if output[0] == str(minor) else ""


def build(folder: Path, python: str, cuda: bool) -> Path:
    """Builds the wheel for a Python, with the packages of this one.

    All Pythons share CMake's build folder, in which only the bindings are compiled for each; scikit-build-core reuses
    the folder as long as its own location is the same.
    """
    if cuda:
        variables = {
            "CMAKE_CUDA_ARCHITECTURES": os.environ.get("REALCAM_CUDA_ARCHITECTURES", ""),
            "REALCAM_CUDA_FAST_COMPILE": os.environ.get("REALCAM_CUDA_FAST_COMPILE", ""),
        }
        settings = [f"cmake.define.{name}={value}" for name, value in variables.items() if value]
    else:
        sets = os.environ.get("REALCAM_INSTRUCTION_SETS", "v2;v3;v4")
        settings = [
            "build-dir=build/wheel",
            "cmake.define.REALCAM_CUDA=OFF",
            f"cmake.define.REALCAM_INSTRUCTION_SETS={sets}",
        ]
    options = [word for setting in settings for word in ("--config-settings", setting)]
    pip_wheel = ["-m", "pip", "wheel", "./cuda13" if cuda else ".", "--no-deps", "--no-build-isolation"]
    packages = {**os.environ, "PYTHONPATH": sysconfig.get_path("purelib")}
    run(python, *pip_wheel, "--wheel-dir", folder, *options, env=packages)
    return next(folder.glob("*.whl"))


def repair(wheel: Path, folder: Path) -> Path:
    """Adds the shared libraries to a wheel. Returns the new wheel in the folder."""
    run(sys.executable, "-m", "auditwheel", "repair", "--plat", PLATFORM, "--wheel-dir", folder, wheel)
    return next(folder.glob("*.whl"))


def with_licences(wheel: Path, scratch: Path, folder: Path) -> Path:
    """Adds the licences of the shared libraries to a wheel. scratch: folder for temporary files. Returns the new wheel
    in `folder`."""
    run(sys.executable, "-m", "wheel", "unpack", wheel, "--dest", scratch)
    package = next(scratch.iterdir())
    licences = next(package.glob("*.dist-info")) / "licenses"
    for library in sorted(package.glob("*.libs/*.so*")):
        name = re.sub(r"-[0-9a-f]{8}(?=\.so)", "", library.name)  # hash that auditwheel adds
        for licence in licences_of(name):
            target = licences / name.partition(".so")[0] / licence.name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(licence, target)
    run(sys.executable, "-m", "wheel", "pack", package, "--dest-dir", folder)
    return folder / wheel.name


def licences_of(library: str) -> list[Path]:
    """Licence files of the system's package of a library, and those to which they refer. library: file name. Exits if
    the library is not found."""
    local = Path("/usr/local/share/licenses", library.partition(".so")[0])
    if local.is_dir():  # tools/wheel_libraries.sh
        return sorted(local.iterdir())
    name = library.partition(".so")[0]
    found = next((line.split()[-1] for line in run("ldconfig", "-p").splitlines() if f"\t{name}.so" in line), None)
    if found is None:
        sys.exit(f"{library}: ldconfig does not list this library, so that its licence is unknown")
    path = Path(found).resolve()
    if shutil.which("dpkg-query"):
        # Packages from before the merge of /usr list the path without /usr.
        package = run("dpkg-query", "--search", f"*{path.name}").partition(":")[0]
        own = [Path("/usr/share/doc", package, "copyright")]
    else:
        package = run("rpm", "--query", "--file", path, "--queryformat", "%{NAME}").strip()
        own = sorted(Path("/usr/share/licenses", package).iterdir())
    return [*own, *([APACHE] if any(str(APACHE) in licence.read_text() for licence in own) else [])]


if __name__ == "__main__":
    main()
