"""A disabled effect leaves the GPU's code identical to code without that effect.

The kernel without effects is compiled twice: from the sources, and from a copy from which the effects were removed with
all their data in the camera. Both must have the same instructions; only the offsets of arguments may differ.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.pictures  # nvcc compiles for ten seconds
ROOT = Path(__file__).parents[2]
KERNEL = """
#include "cuda/kernels/render_kernel_template.hpp"
namespace realcam::render_kernel_detail {
template __global__ void render<LensKind::plain, SceneKind::plain, 0, false>(const __grid_constant__ RenderJob, int);
}
"""
# File -> (pattern, replacement) pairs that remove the effects from it. Each pattern must match exactly once.
CUTS = {
    "camera/effects/effect_views.hpp": [
        (r"    Effects effects;.*?\n\n", ""),
        (r"(?<=int surfaces, Move&& move\) \{\n).*?(?=    \}\n\};)", "        (void)surfaces, (void)move;\n"),
    ],
    "camera/ray_request.hpp": [(r"    if constexpr \(effects\.have_wavelengths\(\)\) draw_wavelengths.*?\n", "")],
    "camera/effects/effects.hpp": [(r"kCompiledEffects\[\] = \{[^;]*\};", "kCompiledEffects[] = {{}};")],
    "camera/effects/rays_with_effects.hpp": [
        (r'#include "diffraction/diffracted_rays.hpp"', '#include "../models/generate_rays.hpp"'),
        (r"template <int N, Effects effects>\n    requires\(effects\.diffraction\).*?\n\};\n", ""),
        (r"/// generate_rays_from for a full lens with.*?(?=/// generate_rays_from with effects)", ""),
        (r"    if constexpr \(may_lack_coatings.*?    \} else \{\n(.*?;\n).*?    \}\n\}\n", r"\1}\n"),
        (r"std::conditional_t<.*?>;", "NoWavelengths;"),
    ],
    "render/path/advance_path.hpp": [
        (r"    if constexpr \(effects\.have_wavelengths\(\)\) draw_wavelengths.*?\n", ""),
        (r"    // Rays that the edges of the aperture diffract.*?\n    \}\n", ""),
    ],
    "render/film/film_control_variates.hpp": [
        (r"/// True if samples also count for.*?(?=\}  // namespace realcam\n)", ""),
    ],
    "render/path/path_state.hpp": [
        (r"template <int N>\nstruct SharedResults.*?(?=template <int N, Effects effects>)", ""),
        (r"    \[\[no_unique_address\]\] .* shared;\n(.*\n){2}", ""),
    ],
    "render/path/render_samples.hpp": [
        (r"/// Converts the light of a sample.*?(?=/// Takes one block)", ""),
        (r"    if constexpr \(effects\.have_wavelengths\(\)\)\n.*?(?=\}\n\n\}  // namespace)", ""),
    ],
    "cuda/kernels/render_kernel_template.hpp": [
        (r"/// Adds a contribution from a neighbouring pixel.*?(?=/// Number of samples)", ""),
        (r"    if constexpr \(effects\.have_wavelengths\(\)\) \{.*?\n    \}\n", ""),
        (r"    const bool shares = .*?;\n", ""),
        (r"            if constexpr \(effects\.share_pixels\(\)\)\n.*\n", ""),
        (r"        if \(shares\) \{.*?\} else \{\n(.*?)        \}\n", r"\1"),
    ],
    "render/ghosts/splat_ghosts.hpp": [
        (r"/// Deflects light that geometrical optics would bring to .*?(?=\}  // namespace splat_ghosts_detail)", ""),
        (r"template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths.*?\n\}\n", ""),
    ],
}


def without_effects(to: Path) -> None:
    shutil.copytree(ROOT / "cpp", to)
    for name, cuts in CUTS.items():
        text = (to / name).read_text()
        for pattern, instead in cuts:
            text, count = re.subn(pattern, instead, text, count=1, flags=re.DOTALL if ".*?" in pattern else 0)
            assert count == 1, f"{name}: nothing to cut where {pattern} is looked for"
        (to / name).write_text(text)


def instructions(include: Path, folder: Path) -> list[str]:
    source, out = folder / "kernel.cu", folder / "kernel.ptx"
    source.write_text(KERNEL)
    command = ["nvcc", "-ptx", "-O3", "-DNDEBUG", "-arch=sm_90", "--expt-relaxed-constexpr", "-std=c++20"]
    subprocess.run([*command, f"-I{include}", "-o", str(out), str(source)], check=True, capture_output=True)
    body = out.read_text().split(".visible .entry", 1)[1]
    # An argument's place, and its size; names that the compiler has made of a file's name.
    body = re.sub(r"(_param_\d+)(\[\d+\]|\+\d+)", r"\1", body)
    body = re.sub(r"(ld\.param.*)\+-?\d+\]", r"\1]", body)
    # Likewise of an argument that is read by its address.
    for register in set(re.findall(r"mov\.b64 \t(%rd\d+), \S*_param_\d+;", body)):
        body = re.sub(rf"(add\.s64 \t%rd\d+, {register}, )\d+;", r"\1;", body)
    return body.splitlines()[2:]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("nvcc") is None, reason="nvcc is not on the path")
def test_the_kernel_without_effects_is_the_same_where_there_are_none(tmp_path: Path) -> None:
    without_effects(tmp_path / "cpp")
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    assert instructions(ROOT / "cpp", tmp_path / "a") == instructions(tmp_path / "cpp", tmp_path / "b")
