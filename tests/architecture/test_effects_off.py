"""A disabled effect costs nothing: the GPU's kernel without effects reads no data of any effect, and keeps no state.

The kernel is compiled to PTX, in which each access to a parameter has its offset in bytes. The kernel with dispersion
shows that the analysis finds such accesses.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.pictures  # nvcc compiles for ten seconds
ROOT = Path(__file__).parents[2]
# The assertions show that paths and their results keep nothing for effects.
KERNEL = """
#include "cuda/kernels/render_kernel_template.hpp"
namespace realcam::render_kernel_detail {
template __global__ void render<LensKind::plain, SceneKind::plain, number_of(EFFECTS), false>(
    const __grid_constant__ RenderJob, int);
static_assert(std::is_empty_v<WavelengthsWith<1, kNoEffects>>);
static_assert(sizeof(PathResultsWith<1, kNoEffects>) == sizeof(PathResults<1>));
extern "C" {
__device__ unsigned long long camera_begin = offsetof(RenderJob, camera), camera_size = sizeof(CameraView),
    effects_begin = offsetof(RenderJob, camera) + offsetof(CameraView, effects), effects_size = sizeof(EffectViews);
}
}
"""


def ptx_of(effects: str, folder: Path) -> str:
    source, out = folder / "kernel.cu", folder / "kernel.ptx"
    source.write_text(KERNEL)
    command = ["nvcc", "-ptx", "-O3", "-DNDEBUG", "-arch=sm_90", "--expt-relaxed-constexpr", "-std=c++20"]
    # 1427: offsetof of a class with a base, whose layout is not standardised but fixed by the platform.
    command += ["-diag-suppress", "1427", f"-DEFFECTS={effects}", f"-I{ROOT / 'cpp'}", "-o", str(out), str(source)]
    compiled = subprocess.run(command, check=False, capture_output=True, text=True)
    assert compiled.returncode == 0, compiled.stderr
    return out.read_text()


def constant(ptx: str, name: str) -> int:
    found = re.search(rf"\.u64 {name} = (\d+);", ptx)
    assert found, f"the PTX does not define {name}"
    return int(found[1])


def accesses(ptx: str) -> tuple[set[int], set[int]]:
    """Offsets in the kernel's first parameter: of the values that are read, and of the addresses that are used in any
    other instruction, such as a call."""
    kernel = re.search(r"\.visible \.entry .*?\n\}\n", ptx, re.DOTALL)
    parameter = kernel and re.search(r"\S+_param_0(?=\[)", kernel[0])
    assert kernel and parameter, "the PTX has no kernel with a parameter"
    offsets: dict[str, set[int]] = {parameter[0]: {0}}  # of addresses, by the register that holds them
    read: set[int] = set()
    used: set[int] = set()
    for operation, operands in re.findall(r"^\s*(?:@!?%p\d+\s+)?([a-z][\w.]*)\s+([^;]*);", kernel[0], re.MULTILINE):
        names = [name for name in re.findall(r"[%\w$]+", operands) if name in offsets]
        if not names:
            continue
        base = offsets[names[-1]]
        copy = re.fullmatch(r"(%rd\d+), [%\w$]+(?:, (-?\d+))?", operands)
        load = re.search(r"\[[%\w$]+(?:\+(-?\d+))?\]$", operands)
        if copy and operation.startswith(("mov", "cvta", "add")):
            offsets.setdefault(copy[1], set()).update(offset + int(copy[2] or 0) for offset in base)
        elif load and operation.startswith("ld."):
            read.update(offset + int(load[1] or 0) for offset in base)
        else:
            used.update(*(offsets[name] for name in names))
    return read, used


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("nvcc") is None, reason="nvcc is not on the path")
def test_the_kernel_without_effects_reads_none_of_their_data(tmp_path: Path) -> None:
    def reads_of_effects(effects: str) -> list[int]:
        ptx = ptx_of(effects, tmp_path)
        read, used = accesses(ptx)
        camera, size = constant(ptx, "camera_begin"), constant(ptx, "camera_size")
        begin, end = (first := constant(ptx, "effects_begin")), first + constant(ptx, "effects_size")
        assert any(camera <= offset < camera + size for offset in read), "the kernel reads nothing of the camera"
        # A function that were given the camera's address could read any part of it.
        assert not [offset for offset in used if camera <= offset < camera + size]
        return sorted(offset - begin for offset in read if begin <= offset < end)

    assert reads_of_effects("{}") == []
    assert reads_of_effects("{.dispersion=true}") != []
