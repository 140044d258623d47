"""Makes a wheel of realcam that runs where nothing of it is installed: `./run wheel`, and the workflow of wheels.

It holds the shared libraries that the extension needs, and their licences. With --cuda it is the wheel realcam-cuda13,
the plug-in for GPUs.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLATFORM = "manylinux_2_34_x86_64"
# Debian's files refer to it. They name the GPL, too: for the packaging, and for files that are no part of the library.
APACHE = Path("/usr/share/common-licenses/Apache-2.0")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="where the wheel goes")
    parser.add_argument("--cuda", action="store_true", help="the plug-in for GPUs, which nvcc compiles")
    parser.add_argument("--repair", type=Path, metavar="WHEEL", help="a wheel that is built already")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        built = arguments.repair or build(Path(scratch, "built"), arguments.cuda)
        repaired = repair(built, Path(scratch, "repaired"))
        print(with_licences(repaired, Path(scratch, "open"), arguments.folder))


def run(*words: str | Path) -> str:
    return subprocess.run([*map(str, words)], check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT).stdout


def build(folder: Path, cuda: bool) -> Path:
    """With the packages of this Python, so that CMake's build folder serves the next time, too."""
    if cuda:
        asked = {
            "CMAKE_CUDA_ARCHITECTURES": os.environ.get("REALCAM_CUDA_ARCHITECTURES", ""),
            "REALCAM_CUDA_FAST_COMPILE": os.environ.get("REALCAM_CUDA_FAST_COMPILE", ""),
        }
        settings = [f"cmake.define.{name}={value}" for name, value in asked.items() if value]
    else:
        sets = os.environ.get("REALCAM_INSTRUCTION_SETS", "v2;v3;v4")
        settings = ["cmake.define.REALCAM_CUDA=OFF", f"cmake.define.REALCAM_INSTRUCTION_SETS={sets}"]
    words = [word for setting in settings for word in ("--config-settings", setting)]
    pip_wheel = ["-m", "pip", "wheel", "./cuda13" if cuda else ".", "--no-deps", "--no-build-isolation"]
    run(sys.executable, *pip_wheel, "--wheel-dir", folder, *words)
    return next(folder.glob("*.whl"))


def repair(wheel: Path, folder: Path) -> Path:
    run(sys.executable, "-m", "auditwheel", "repair", "--plat", PLATFORM, "--wheel-dir", folder, wheel)
    return next(folder.glob("*.whl"))


def with_licences(wheel: Path, scratch: Path, folder: Path) -> Path:
    """The same wheel with the licences of the libraries that came in."""
    run(sys.executable, "-m", "wheel", "unpack", wheel, "--dest", scratch)
    package = next(scratch.iterdir())
    licences = next(package.glob("*.dist-info")) / "licenses"
    for library in sorted(package.glob("*.libs/*.so*")):
        name = re.sub(r"-[0-9a-f]{8}(?=\.so)", "", library.name)  # auditwheel's mark
        for licence in licences_of(name):
            target = licences / name.partition(".so")[0] / licence.name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(licence, target)
    run(sys.executable, "-m", "wheel", "pack", package, "--dest-dir", folder)
    return folder / wheel.name


def licences_of(library: str) -> list[Path]:
    """The files of the system's package that a library is from, and those that they refer to."""
    local = Path("/usr/local/share/licenses", library.partition(".so")[0])
    if local.is_dir():  # tools/wheel_libraries.sh
        return sorted(local.iterdir())
    name = library.partition(".so")[0]
    found = next((line.split()[-1] for line in run("ldconfig", "-p").splitlines() if f"\t{name}.so" in line), None)
    if found is None:
        sys.exit(f"{library}: ldconfig knows no such library; whose licence it has cannot be told")
    path = Path(found).resolve()
    if shutil.which("dpkg-query"):
        # Before usr was one folder with the root, packages had the shorter name.
        owned = run("dpkg-query", "--search", f"*{path.name}").partition(":")[0]
        own = [Path("/usr/share/doc", owned, "copyright")]
    else:
        owned = run("rpm", "--query", "--file", path, "--queryformat", "%{NAME}").strip()
        own = sorted(Path("/usr/share/licenses", owned).iterdir())
    return [*own, *([APACHE] if any(str(APACHE) in licence.read_text() for licence in own) else [])]


if __name__ == "__main__":
    main()
