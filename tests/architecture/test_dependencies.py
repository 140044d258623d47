"""Include rules of cpp/: the folders that each folder may include, and the libraries that the core must not use."""

import re
from collections.abc import Iterable
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

CPP = Path(__file__).resolve().parents[2] / "cpp"

CORE = ("math", "optics", "camera", "scene", "render")
BACKENDS = ("embree", "cuda")

# Folder -> other folders that it may include. Every folder may include itself and the headers directly in cpp/.
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
    "cuda_plugin": {"cuda"},
    "devices": {*CORE, *BACKENDS},
    "denoise": {*CORE},
    "io": {*CORE},
    "image_io": {*CORE, "io"},
    "shot": {*CORE, "io"},
    # The executable's part of image_io/openimageio.hpp; the extension's is in bindings.
    "openimageio": {"image_io"},
    "bindings": {*CORE, *BACKENDS, "plan", "devices", "denoise", "io", "shot", "image_io", "app"},
    "app": {*CORE, *BACKENDS, "plan", "devices", "denoise", "io", "shot", "image_io"},
}

# Layers of a folder's subfolders, lowest first: each may include only itself and those before it. An entry with a file
# suffix moves files to another layer than that of their folder.
ORDER = {
    # Views, which kernels read, contain one another: the camera's view contains those of its effects. So they form the
    # lowest layer, whichever folder they are in.
    "camera": (
        "*_view.hpp effects/effect_views.hpp effects/effects.hpp film/pixel_filter.hpp models/pixel_pupil.hpp",
        "film",
        "models",
        "effects effects/*",
        "",
        "projection",
        "sensor",
    ),
    "scene": ("", "textures", "geometry", "materials", "lights", "render_space"),
    "render": ("path", "layers", "settings", "ghosts", "lights", "film", "gradients", "framing", "session"),
    "cuda": ("device", "kernels", "session", "rays", ""),
    "bindings": ("bindings.hpp typed_object.hpp unlocked.*", "values", "lens", "camera", "scene", "pictures", ""),
    "optics": ("prescription", "trace", "coating", "pupil", "lens", "ghost", "analysis", "derivatives", "tolerance"),
    "io": ("files", "text", "lens", "lens/formats", "sensor", "scene", "mesh", "gltf", ""),
}

# Files that devices run, with the files that they include: they must neither own memory nor throw.
RUN_BY_DEVICES = ("embree/kernels.cpp", "bvh/traverse_scene.hpp", "render/gradients/gradient_film.hpp")

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


# The headers of bvh/ (traversal) run on every device; its sources, which build the tree, are a host library.
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
    """One line "file:line meaning: match" for each match of `pattern` in the code of `paths`."""
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
        offenders += [
            f"{name_of(path)} includes {name_of(other)}, but may include {sorted(allowed - {''})} only"
            for other in included_by(path)
            if folder_of(other) not in allowed
        ]
    fail_for(offenders)


def test_folders_within_a_folder_include_those_below_them() -> None:
    def place_of(path: Path) -> int:
        top, _, name = name_of(path).partition("/")
        folder = Path(name).parent.as_posix().removeprefix(".")
        for place, entries in enumerate(ORDER[top]):
            if any(fnmatch(name, entry) for entry in entries.split() if "." in entry):
                return place
        for place, entries in enumerate(ORDER[top]):
            if any(fnmatch(folder, entry) for entry in entries.split() or [""] if "." not in entry):
                return place
        raise AssertionError(f"{name_of(path)} is in a folder without a place in ORDER")

    fail_for(
        [
            f"{name_of(path)} includes {name_of(other)}, whose folder lies above its own"
            for path in SOURCES
            if folder_of(path) in ORDER
            for other in included_by(path)
            if folder_of(other) == folder_of(path) and place_of(other) > place_of(path)
        ]
    )


def test_core_knows_no_platform() -> None:
    fail_for([line for what, pattern in NOT_IN_CORE.items() for line in uses(CORE_SOURCES, pattern, f"knows {what}")])


def test_device_code_neither_allocates_nor_throws() -> None:
    on_device: set[Path] = set()
    waiting = [CPP / name for name in RUN_BY_DEVICES]
    while waiting:
        path = waiting.pop()
        on_device.add(path)
        waiting += set(included_by(path)) - on_device
    headers = sorted(path for path in on_device if path.suffix == ".hpp" and folder_of(path) not in BACKENDS)
    assert CPP / "optics/trace/lens_trace.hpp" in headers
    fail_for(uses(headers, NOT_ON_DEVICE, "runs on devices, and uses"))


def test_wheels_do_not_ask_for_a_newer_system() -> None:
    """glibc has had its hypot of two numbers since 2.35 alone: math/hypotenuse.hpp has one that is as good."""
    others = (path for path in SOURCES if path.name != "hypotenuse.hpp")
    fail_for(uses(others, r"std::hypot\([^,;]*,[^,;]*\)", "calls std::hypot of two numbers"))


def test_one_folder_knows_embree() -> None:
    fail_for(uses((path for path in SOURCES if folder_of(path) != "embree"), NOT_IN_CORE["Embree"], "knows Embree"))


def test_one_file_has_what_must_be_in_one_place() -> None:
    offenders = []
    for pattern, where, home in (
        # It also brings back the one that was; others would leave the caller's thread with another GPU than it had.
        (r"cudaSetDevice", "", "cuda/device/current_device."),
        (r"__CUDACC__", "", "platform."),
        # It counts the work under way, for which Python's end has to wait: bindings take Unlocked.
        (r"gil_scoped_release", "bindings/", "bindings/unlocked."),
    ):
        paths = [path for path in SOURCES if name_of(path).startswith(where) and not name_of(path).startswith(home)]
        offenders += uses(paths, pattern, f"uses what only {home}* may use")
    fail_for(offenders)
