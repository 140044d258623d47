"""A build without CUDA and the plug-in for GPUs: what is of no use is told in one sentence, and the CPU goes on."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from realcam import _core

from ..programs import PYTHON, loads_cuda_plugins

# Plug-ins that are built with the C++ tests. The GPU of the first is one that it has no code for.
PLUGINS = Path(_core.__file__).resolve().parents[1] / "tests"
NO_CODE, OTHER_VERSION = PLUGINS / "cuda_plugin.so", PLUGINS / "cuda_plugin_of_another_version.so"


def run(command: list[str], plugin: object, *words: object) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "REALCAM_CUDA_PLUGIN": str(plugin)}
    return subprocess.run([*command, *map(str, words)], capture_output=True, text=True, env=environment)


@pytest.fixture(scope="module", autouse=True)
def no_cuda_inside() -> None:
    if not loads_cuda_plugins():
        pytest.skip("this build has the CUDA backend inside, and loads no plug-in")


def wants(plugin: Path) -> Path:
    if not plugin.is_file():
        pytest.skip("the plug-ins of the tests are not built: they come with the C++ tests")
    return plugin


@pytest.fixture(params=["none", "not there", "no plug-in", "another version"])
def useless(request: pytest.FixtureRequest) -> tuple[object, str]:
    """A path, and what is said of it."""
    if request.param == "another version":
        return wants(OTHER_VERSION), "was built for realcam 9.8.7 (build of the tests); this is realcam "
    return {
        "none": ("", "pip install realcam[cuda]"),
        "not there": ("/nowhere/plugin.so", "cannot be loaded: /nowhere/plugin.so"),
        "no plug-in": ("libm.so.6", "undefined symbol: realcam_cuda_stamp"),
    }[request.param]


def test_devices_says_why_there_is_no_gpu(useless: tuple[object, str]) -> None:
    plugin, why = useless
    done = run(PYTHON, plugin, "devices")
    assert done.returncode == 0
    assert [line.split()[0] for line in done.stdout.splitlines()] == ["cpu"]
    (line,) = done.stderr.splitlines()
    assert line.startswith("realcam: no GPU: ")
    assert why in line


def test_a_gpu_that_is_asked_for_is_an_error(useless: tuple[object, str], tmp_path: Path) -> None:
    plugin, why = useless
    scene = tmp_path / "triangle.obj"
    scene.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    expected = ["--lens", "double-gauss-50mm", "--device", "cuda", "-o", tmp_path / "picture.png"]
    done = run(PYTHON, plugin, "render", scene, *expected)
    (line,) = done.stderr.splitlines()
    assert (done.returncode, line[:16]) == (2, "realcam: error: ")
    assert why in line
    code = "import realcam as rc; rc.Lens.load('double-gauss-50mm').trace([(0, 0, -9)], [(0, 0, 1)], device='cuda')"
    done = run([sys.executable, "-c", code], plugin)
    *_, last = done.stderr.splitlines()
    assert last.startswith("realcam.DeviceError: ")
    assert why in last


PICTURE = """
import warnings, realcam as rc
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    mesh = ([(-1, -1, -3), (1, -1, -3), (0, 1, -3)], [(0, 1, 2)])
    scene = rc.Scene.from_arrays(*mesh).with_environment(100)
    camera = rc.Camera(rc.Lens.load("double-gauss-50mm"), film=rc.Film(36, 24, (6, 4)), exposure_time_s=0.01)
    for _ in range(2):
        rc.render(scene, camera, effects=(), spp=1)
print(*(str(one.message) for one in told), sep="\\n")
"""


def test_the_cpu_goes_on_and_tells_it_once(useless: tuple[object, str]) -> None:
    plugin, why = useless
    done = run([sys.executable, "-c", PICTURE], plugin)
    assert (done.returncode, done.stderr) == (0, "")
    told = done.stdout.strip()
    if plugin:
        assert told.startswith("the CPU is used: ")
        assert why in told
        assert "\n" not in told
    else:
        assert told == ""  # nobody promised a GPU


def test_a_gpu_without_code_is_told_and_passed_over() -> None:
    """The exception that says so is thrown in the plug-in, and caught outside."""
    done = run([sys.executable, "-c", PICTURE], wants(NO_CODE))
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.strip() == "the CPU is used: the tests have no code for the GPU"
    listed = run(PYTHON, NO_CODE, "devices")
    assert "GPU of the tests (compute capability 6.1" in listed.stdout
    assert listed.stderr == ""


@pytest.mark.parametrize("beginning", ["", "import sys; sys.path.insert(0, '')\n"])
@pytest.mark.parametrize("is_namespace", [True, False])
def test_libraries_in_the_current_folder_are_not_loaded(tmp_path: Path, is_namespace: bool, beginning: str) -> None:
    """Nor by a notebook, whose path begins with its folder."""
    for package, library in (("realcam_cuda13", "librealcam_cuda13.so"), ("pyoidn", "libOpenImageDenoise.so.2")):
        (tmp_path / package).mkdir()
        (tmp_path / package / library).write_bytes(b"")
        if not is_namespace:
            (tmp_path / package / "__init__.py").write_text("")
    script = (
        f"{beginning}from realcam.installation import cuda_plugin, denoiser_library\n"
        "print([denoiser_library(), cuda_plugin()])"
    )
    environment = {name: value for name, value in os.environ.items() if name != "REALCAM_OIDN"}
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, env=environment, check=True
    )
    assert str(tmp_path) not in done.stdout
