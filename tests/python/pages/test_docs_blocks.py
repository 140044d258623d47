"""The Python blocks of the pages run, in their order, with the names and files that the sentences around them mean."""

from __future__ import annotations

import ast
import math
import re
import shutil
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc
from matplotlib.figure import Figure

from ..scenes import quad, scene_of
from ..sky_files import write_radiance

ROOT = Path(__file__).resolve().parents[3]
PAGES = sorted(path for path in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
BLOCK = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)


def blocks_of(page: Path) -> list[tuple[int, str]]:
    """First lines, counted from 1, and texts."""
    text = page.read_text(encoding="utf-8")
    return [(text.count("\n", 0, match.start(1)) + 1, match[1]) for match in BLOCK.finditer(text)]


def imports_of(code: str) -> set[str]:
    nodes = [node for node in ast.walk(ast.parse(code)) if isinstance(node, (ast.Import, ast.ImportFrom))]
    return {(node.module or "") if isinstance(node, ast.ImportFrom) else node.names[0].name for node in nodes}


def what_is_missing(code: str) -> str:
    absent = [name for name in imports_of(code) if find_spec(name.split(".")[0]) is None]
    if not absent and "torch" in imports_of(code) and not any("cuda" in device.name for device in rc.devices()):
        absent = ["a GPU"]
    return ", ".join(absent)


@pytest.fixture
def names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Names that the pages assume: a scene, a camera, a picture. Also creates files in the current folder."""
    render, accuracy_cost = rc.render, rc.accuracy_cost

    def small(camera: rc.Camera) -> rc.Camera:
        width, height = camera.film.resolution
        return camera.replace(film=camera.film.replace(resolution=(24, max(1, 24 * height // width))))

    # The blocks ask for pictures that take minutes. What they say is the same of a picture of few pixels and samples.
    def rendered(scene: rc.Scene, camera: rc.Camera, *settings: Any, **words: Any) -> rc.Image:
        few = {"max_spp": 16} if words.get("spp") == "auto" else {"spp": 2}
        return render(scene, small(camera), *settings, **{**words, **few, "progress": False})

    def cost(scene: rc.Scene, camera: rc.Camera) -> rc.AccuracyCost:
        return accuracy_cost(scene, camera, size=12, max_spp=4, reference_spp=4, samplings=False)

    monkeypatch.setattr(rc, "render", rendered)
    monkeypatch.setattr("realcam.shot.render", rendered)
    monkeypatch.setattr(rc, "accuracy_cost", cost)
    monkeypatch.chdir(tmp_path)

    scene = scene_of(quad((0, 0, -2), 1, diffuse=0.5), quad((0, 1, -1.5), 0.2, up=(0, 0, 1), emission=5000))
    scene = scene.with_instance(scene_of(quad((0, 0, 0), 0.1, diffuse=0.5)), np.eye(4), name="ball")
    scene = scene.with_environment(100)
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    camera = rc.Camera(lens, film=rc.Film(36, 24, (24, 16)))
    tessar = rc.Lens.load("tessar-50mm")
    here, there = np.eye(4), np.eye(4)
    there[0, 3] = 0.1

    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    for name in ("terrace.glb", "scene.glb"):
        shutil.copy(ROOT / "scenes" / "demo.glb", tmp_path / name)
    terrace = 'format = 1\nscene = "terrace.glb"\nresolution = [24, 16]\nspp = 2\nexposure_time_s = 0.02\n'
    (tmp_path / "terrace.toml").write_text(terrace)
    write_radiance(tmp_path / "evening.hdr", np.full((4, 8, 3), 20.0))
    # Some lens with a glass that no catalogue has.
    foreign = tmp_path / "US05331467-1.zmx"
    tessar.with_surface(0, material="N-BK7").save(foreign)
    named = foreign.read_text(encoding="utf-8").replace("N-BK7", "E-LAFH3", 1)
    assert "E-LAFH3" in named
    foreign.write_text(named, encoding="utf-8")
    return {
        "rc": rc, "np": np, "math": math, "scene": scene, "night": scene, "lens": lens, "camera": camera,
        "another": camera, "zoom": rc.Lens.load("zoom-80-200mm"), "axes": Figure().add_subplot(),
        "first": tessar.surfaces[0], "second": tessar.surfaces[1], "chair": scene_of(quad((0, 0, 0), 0.1)),
        "matrix": here, "here": here, "there": there, "points_m": np.array([[0.1, 0.2, -2.0], [0, 0, -2.0]]),
        "origins_mm": np.array([[0, 1.0, -10.0]]), "directions": np.array([[0, 0, 1.0]]),
        "image": rendered(scene, camera, layers="all"),
    }  # fmt: skip


@pytest.mark.picture_files
@pytest.mark.filterwarnings("ignore")  # of coatings that no file knows, and of pictures of two samples
@pytest.mark.parametrize("page", [page for page in PAGES if blocks_of(page)], ids=lambda page: page.stem)
def test_blocks_run(page: Path, names: dict[str, Any]) -> None:
    skipped = []
    for line, code in blocks_of(page):
        if missing := what_is_missing(code):
            skipped.append(f"line {line} wants {missing}")
            continue
        # Blank lines make a traceback show the line numbers of the page.
        exec(compile("\n" * (line - 1) + code, str(page), "exec"), names)
    if skipped:
        pytest.skip("; ".join(skipped))
