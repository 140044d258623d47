"""The rules of the house: which folder of cpp/ may include which, and what the core must not know."""

import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

CPP = Path(__file__).resolve().parents[2] / "cpp"

CORE = ("math", "optics", "camera", "scene", "render")
BACKENDS = ("embree", "cuda")

# Folder -> the folders that it may include, besides itself and the headers of cpp/ itself.
MAY_INCLUDE = {
    "": set(),
    "math": set(),
    "optics": {"math"},
    "scene": {"math"},
    "camera": {"math", "optics"},
    "render": {"math", "optics", "scene", "camera"},
    "plan": {*CORE},
    "bvh": {"math", "scene"},
    "embree": {*CORE, "bvh"},
    "cuda": {*CORE, "bvh"},
    "devices": {*CORE, *BACKENDS},
    "io": {*CORE},
    "image_io": {*CORE, "io"},
    "shot": {*CORE, "io"},
    # OpenImageIO is linked by the executable and by an extension of its own, which is loaded when it is needed.
    "bindings": {*CORE, *BACKENDS, "plan", "devices", "io", "shot"},
    "picture_bindings": {*CORE, "io", "image_io"},
    "app": {*CORE, *BACKENDS, "plan", "devices", "io", "shot", "image_io"},
}

# What both extensions do when Python ends stays in one place.
MAY_INCLUDE_TOO = {"picture_bindings/pictures_module.cpp": {"bindings/unlocked.hpp"}}

# Headers of the core that own memory or raise errors, and so stay on the host. The others run on every
# device, and include none of these.
HOST_ONLY = {
    "bvh/binary_tree.hpp",
    "bvh/build_wide_bvh.hpp",
    "bvh/collapse.hpp",
    "bvh/reinsertion.hpp",
    "bvh/scene_bvh.hpp",
    "camera/camera.hpp",
    "camera/default_film.hpp",
    "camera/diffraction_tables.hpp",
    "camera/effect_tables.hpp",
    "camera/entry_search.hpp",
    "camera/field_of_view.hpp",
    "camera/film_spectrum.hpp",
    "camera/ghost_tables.hpp",
    "camera/illuminant.hpp",
    "camera/last_setup.hpp",
    "camera/lens_map.hpp",
    "camera/mean_ray.hpp",
    "camera/picture_angle.hpp",
    "camera/picture_map.hpp",
    "camera/pinhole_camera.hpp",
    "camera/projection.hpp",
    "camera/pupil_sampling.hpp",
    "camera/sensor.hpp",
    "camera/sensor_color.hpp",
    "camera/sensor_response.hpp",
    "camera/sight_lines.hpp",
    "camera/spectra.hpp",
    "camera/starburst_tables.hpp",
    "checkpoint.hpp",
    "error.hpp",
    "keep_going.hpp",
    "math/append_alias_table.hpp",
    "math/append_cdf.hpp",
    "math/fit_polynomial.hpp",
    "math/least_squares.hpp",
    "math/motion.hpp",
    "math/odd_curve.hpp",
    "math/uniform_keys.hpp",
    "optics/analysis/aim_all.hpp",
    "optics/analysis/aperture_diffraction.hpp",
    "optics/trace/asphere_start.hpp",
    "optics/lens/axial_share.hpp",
    "optics/lens/best_focus.hpp",
    "optics/analysis/bundle_quadrature.hpp",
    "optics/prescription/clearance.hpp",
    "optics/coating/coated_faces.hpp",
    "optics/coating/coated_surface.hpp",
    "optics/prescription/coating.hpp",
    "optics/prescription/coating_checks.hpp",
    "optics/prescription/coating_material.hpp",
    "optics/prescription/crossing.hpp",
    "optics/lens/exposure.hpp",
    "optics/analysis/field_rays.hpp",
    "optics/analysis/film_bundle.hpp",
    "optics/analysis/film_chief_ray.hpp",
    "optics/ghost/film_mirror.hpp",
    "optics/coating/fit_coatings.hpp",
    "optics/lens/focus.hpp",
    "optics/ghost/ghost.hpp",
    "optics/ghost/ghost_coatings.hpp",
    "optics/prescription/glass.hpp",
    "optics/prescription/glass_resonances.hpp",
    "optics/trace/iris_shape.hpp",
    "optics/prescription/known_wavelengths.hpp",
    "optics/lens/lens_changes.hpp",
    "optics/prescription/lens_checks.hpp",
    "optics/trace/lens_dispersion.hpp",
    "optics/lens/lens_edits.hpp",
    "optics/trace/lens_path.hpp",
    "optics/lens/lens_polynomial.hpp",
    "optics/prescription/lens_system.hpp",
    "optics/prescription/metals.hpp",
    "optics/prescription/named_coatings.hpp",
    "optics/analysis/object_point.hpp",
    "optics/lens/paraxial.hpp",
    "optics/analysis/plane_wave_sum.hpp",
    "optics/analysis/plane_waves.hpp",
    "optics/analysis/point_bundle.hpp",
    "optics/coating/polarised_ray.hpp",
    "optics/analysis/psf.hpp",
    "optics/analysis/psf_measures.hpp",
    "optics/analysis/psf_pupil.hpp",
    "optics/pupil/pupil.hpp",
    "optics/pupil/pupil_edges.hpp",
    "optics/pupil/pupil_lens.hpp",
    "optics/pupil/pupil_outline.hpp",
    "optics/pupil/pupil_outline_search.hpp",
    "optics/pupil/pupil_pattern.hpp",
    "optics/pupil/pupil_row_search.hpp",
    "optics/pupil/pupil_search.hpp",
    "optics/pupil/pupil_tracer.hpp",
    "optics/analysis/ray_aiming.hpp",
    "optics/trace/ray_loop.hpp",
    "optics/analysis/scene_bundle.hpp",
    "optics/analysis/seidel.hpp",
    "optics/analysis/spot.hpp",
    "optics/analysis/traced_bundle.hpp",
    "optics/prescription/surface.hpp",
    "optics/coating/thin_film.hpp",
    "optics/analysis/trace_path.hpp",
    "optics/analysis/transmission.hpp",
    "optics/analysis/wavefront.hpp",
    "optics/lens/zoom.hpp",
    "optics/lens/zoom_range.hpp",
    "render/adaptive_sampling.hpp",
    "render/axis_crossings.hpp",
    "render/daylight.hpp",
    "render/default_view.hpp",
    "render/effect_names.hpp",
    "render/film_sums.hpp",
    "render/gap_finder.hpp",
    "render/image.hpp",
    "render/layer_film.hpp",
    "render/layers.hpp",
    "render/learning_passes.hpp",
    "render/left_out_motion.hpp",
    "render/live_frame.hpp",
    "render/live_view.hpp",
    "render/metering.hpp",
    "render/motion_vectors.hpp",
    "render/noise_goal.hpp",
    "render/plan_thresholds.hpp",
    "render/progress.hpp",
    "render/render_settings.hpp",
    "render/rings.hpp",
    "render/room.hpp",
    "render/run_with_progress.hpp",
    "render/scene_change.hpp",
    "render/scene_pieces.hpp",
    "render/session.hpp",
    "render/surface_ids.hpp",
    "render/surroundings.hpp",
    "render/take_picture.hpp",
    "render/vast_sheets.hpp",
    "scene/assembly.hpp",
    "scene/bounding_box.hpp",
    "scene/build_light_tree.hpp",
    "scene/code_light.hpp",
    "scene/environment_change.hpp",
    "scene/emission_mean.hpp",
    "scene/instance_names.hpp",
    "scene/light_tables.hpp",
    "scene/material_names.hpp",
    "scene/render_space_mesh.hpp",
    "scene/render_space_scene.hpp",
    "scene/scene.hpp",
    "scene/scene_arrays.hpp",
    "scene/scene_camera.hpp",
    "scene/scene_checks.hpp",
    "scene/split_triangles.hpp",
    "scene/texture_levels.hpp",
}

NOT_IN_CORE = {
    "the CUDA runtime": r"\bcuda[A-Z]\w*|#\s*include\s*[<\"]cuda|<<<",
    "Embree": r"\brtc[A-Z]\w*|\bRTC[A-Z]\w*|#\s*include\s*<embree",
    "TBB": r"\btbb::|\boneapi::|#\s*include\s*<(tbb|oneapi)/",
    "pybind11": r"\bpybind11\b",
    "the console": r"#\s*include\s*<(iostream|print)>|\b(f|v)?printf\s*\(|\bputs\s*\(",
    "files": r"#\s*include\s*<(fstream|filesystem)>|\bfopen\b|\bFILE\b",
}
NOT_ON_DEVICE = (
    r"#\s*include\s*<(vector|string|map|memory|functional|stdexcept)>|\bstd::(vector|string)\b"
    r"|\bthrow\b|\btry\s*\{|\bcatch\s*\("
)

SOURCES = sorted(path for path in CPP.rglob("*") if path.suffix in {".hpp", ".cpp", ".cu", ".cuh"})


def name_of(path: Path) -> str:
    return path.relative_to(CPP).as_posix()


def folder_of(path: Path) -> str:
    parts = path.relative_to(CPP).parts
    return parts[0] if len(parts) > 1 else ""


# Traversal runs on every device; what builds its tree is a host library.
CORE_SOURCES = [
    path for path in SOURCES if folder_of(path) in {"", *CORE} or (folder_of(path) == "bvh" and path.suffix == ".hpp")
]


@cache
def code_of(path: Path) -> str:
    """The text without comments; line breaks stay, so that positions keep their line."""
    comment = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)

    def keep(match: re.Match[str]) -> str:
        text = match.group()
        return text if text.startswith('"') else "\n" * text.count("\n")

    return comment.sub(keep, path.read_text(encoding="utf-8"))


@cache
def included_by(path: Path) -> list[Path]:
    """The files of cpp/ that `path` includes, whichever of the include folders a name starts from."""
    found = []
    for name in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', code_of(path), re.MULTILINE):
        for candidate in (path.parent / name, CPP / name, CPP / name.removeprefix("realcam/")):
            if candidate.is_file() and CPP in candidate.resolve().parents:
                found.append(candidate.resolve())
                break
    return found


def uses(paths: Iterable[Path], pattern: str, meaning: str) -> list[str]:
    """What a message says of each place where the code of one of `paths` matches."""
    return [
        f"{name_of(path)}:{code_of(path).count(chr(10), 0, match.start()) + 1} {meaning}: {match.group()}"
        for path in paths
        for match in re.finditer(pattern, code_of(path))
    ]


def fail_for(offenders: list[str]) -> None:
    assert not offenders, "\n" + "\n".join(offenders)


def test_there_is_something_to_check() -> None:
    assert any(folder_of(path) == "math" for path in SOURCES)
    assert any(included_by(path) for path in SOURCES)


def test_every_folder_has_a_rule() -> None:
    assert {folder_of(path) for path in SOURCES} <= set(MAY_INCLUDE)


def test_includes_follow_the_rules() -> None:
    offenders = []
    for path in SOURCES:
        allowed = {"", folder_of(path)} | MAY_INCLUDE[folder_of(path)]
        too = MAY_INCLUDE_TOO.get(name_of(path), set())
        offenders += [
            f"{name_of(path)} includes {name_of(other)}, but may include {sorted(allowed - {''})} only"
            for other in included_by(path)
            if folder_of(other) not in allowed and name_of(other) not in too
        ]
    fail_for(offenders)


def test_core_knows_no_platform() -> None:
    fail_for([line for what, pattern in NOT_IN_CORE.items() for line in uses(CORE_SOURCES, pattern, f"knows {what}")])


def test_device_code_neither_allocates_nor_throws() -> None:
    on_device = [path for path in CORE_SOURCES if name_of(path) not in HOST_ONLY]
    fail_for(
        uses(on_device, NOT_ON_DEVICE, "is not host-only, and uses")
        + [
            f"{name_of(path)} is not host-only, and includes {name_of(other)}, which is"
            for path in on_device
            for other in included_by(path)
            if name_of(other) in HOST_ONLY
        ]
    )


def test_one_folder_knows_embree() -> None:
    fail_for(uses((path for path in SOURCES if folder_of(path) != "embree"), NOT_IN_CORE["Embree"], "knows Embree"))


def test_one_file_has_what_must_be_in_one_place() -> None:
    offenders = []
    for pattern, where, home in (
        # It also brings back the one that was; others would leave the caller's thread with another GPU than it had.
        (r"cudaSetDevice", "", "cuda/current_device."),
        (r"__CUDACC__", "", "platform."),
        # It counts the work under way, for which Python's end has to wait: bindings take Unlocked.
        (r"gil_scoped_release", "bindings/", "bindings/unlocked."),
    ):
        paths = [path for path in SOURCES if name_of(path).startswith(where) and not name_of(path).startswith(home)]
        offenders += uses(paths, pattern, f"uses what only {home}* may use")
    fail_for(offenders)
