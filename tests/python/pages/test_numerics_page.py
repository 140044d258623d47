"""docs/generated/numerics.md: what tools/write_numerics.py makes of measurements, and what it refuses."""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from ...centred_lenses import CENTRED

ROOT = Path(__file__).parents[3]
LINE = {
    "kind": "held",
    "section": "Surfaces",
    "what": "plane",
    "tried": "1000 rays",
    "backend": "core",
    "number_type": "float64",
    "worst": 0.5,
    "limit": 4.0,
    "unit": "ulp",
}
RUN = {"kind": "run", "commit": "abc", "date": "2026-11-20", "processor": "a CPU", "devices": ["Embree v4"]}


def measurement_file(
    folder: Path, *lines: dict | str, name: str = "measurements.jsonl", run: dict[str, object] = RUN
) -> Path:
    path = folder / name
    texts = (line if isinstance(line, str) else json.dumps(LINE | line) for line in (*lines, json.dumps(run)))
    path.write_text("".join(text + "\n" for text in texts), encoding="utf-8")
    return path


def write_page(folder: Path, *files: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, ROOT / "tools/write_numerics.py", *files, "--page", folder / "page.md"]
    return subprocess.run([*command, "--lens", "singlet-100mm"], capture_output=True, text=True)


@pytest.fixture
def tool(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(ROOT / "tools")
    return importlib.import_module("write_numerics")


def cells(page: str, case: str) -> list[str]:
    (row,) = (line for line in page.splitlines() if line.startswith(f"| {case} "))
    plain = row.replace("\N{NO-BREAK SPACE}", " ").replace("\N{MINUS SIGN}", "-")
    return [cell.strip() for cell in plain.strip("|").split("|")]


def test_page(tmp_path: Path) -> None:
    sphere = {"what": "sphere", "limit": 8}
    file = measurement_file(
        tmp_path,
        {"section": "Bundled lenses", "what": "image points", "number_type": "float32", "worst": 1e-7},
        {"worst": 0.25},
        {"number_type": "float32", "worst": 1},
        # A parametrised test: the worst counts.
        {"section": "Lenses", "what": "run", "worst": 1, "tried": "lens a"},
        {"section": "Lenses", "what": "run", "worst": 3, "tried": "lens b"},
        *({**sphere, "backend": b, "worst": w} for b, w in (("Embree v2", 2), ("CUDA", 1), ("Embree v3", 3))),
        *({**sphere, "backend": b, "number_type": "float32"} for b in ("Embree v2", "Embree v3")),
        {"kind": "broken", "what": "wrong root", "worst": 1e6},
        {"kind": "broken", "what": "wrong root", "worst": 1e5},
        '{"kind": "broken", "section": "Sums", "what": "no sum", "tried": "a sum", "backend": "core", '
        '"number_type": "float32", "worst": NaN, "limit": 1e-07, "unit": "relative"}',
    )
    run = write_page(tmp_path, file)
    assert run.returncode == 0, run.stderr
    page = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert [line[3:] for line in page.splitlines() if line.startswith("## ")] == [
        "Surfaces",
        "Lenses",
        "Bundled lenses",
        "Broken on purpose",
    ]
    assert "13 measurements" in page
    assert cells(page, "plane") == ["plane", "1 ≤ 4", "0.25 ≤ 4", "ulp", "1000 rays"]
    backends = "CUDA · Embree v2 · v3"
    (head,) = (line for line in page.splitlines() if "CUDA" in line)
    assert cells(head, "case") == ["case", f"float32, {backends}", f"float64, {backends}", "unit", "tried"]
    assert cells(page, "sphere")[1:3] == ["– · 0.5 · 0.5 ≤ 8", "1 · 2 · 3 ≤ 8"]
    assert cells(page, "run")[1:] == ["3 ≤ 4", "ulp", "lens b, the worst of 2"]
    # For a broken routine, the page shows the result that comes nearest to passing.
    assert cells(page, "wrong root")[1:5] == ["float64", "1e5", "4", "ulp"]
    assert cells(page, "no sum")[1:5] == ["float32", "NaN", "1e-7", "relative"]
    assert "](images/float32-error.png)" in page
    assert (tmp_path / "images/float32-error.png").read_bytes().startswith(b"\x89PNG")


def test_a_page_of_two_machines(tmp_path: Path) -> None:
    """Each machine has a backend that the other lacks; for shared backends, the figure nearest to its limit counts."""
    both = {"worst": 1.0}, {"worst": 3.0, "tried": "900 rays"}
    gpu = RUN | {"commit": "def", "devices": ["CUDA"]}
    of_cpu, of_gpu = (
        measurement_file(tmp_path, line, {"what": "sphere", "backend": backend}, name=f"{backend}.jsonl", run=run)
        for line, backend, run in zip(both, ("Embree v4", "CUDA"), (RUN, gpu), strict=True)
    )
    done = write_page(tmp_path, of_cpu, of_gpu)
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "\n- commit abc, 2026-11-20, a CPU, Embree v4\n- commit def, 2026-11-20, a CPU, CUDA\n" in page
    assert cells(page, "plane")[1:] == ["3 ≤ 4", "ulp", "900 rays, the worst of 2"]
    assert "float64, CUDA · Embree v4" in page
    assert "4 measurements" in page


def test_no_page_where_a_figure_does_not_hold(tmp_path: Path) -> None:
    run = write_page(tmp_path, measurement_file(tmp_path, {}, {"worst": 5}))
    assert run.returncode != 0
    assert "measurements.jsonl:2: past its limit: plane (float64, core): 5, limit 4 ulp" in run.stderr
    assert "Traceback" not in run.stderr
    assert not (tmp_path / "page.md").exists()


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ({"worst": float("nan")}, "past its limit"),
        ({"kind": "broken"}, "broken by intent, but within its limit"),
        ({"kind": "seen"}, 'unknown kind "seen"; expected held, broken or run'),
        ({"section": "Surface"}, 'unknown section "Surface"; the page has Surfaces, Rays,'),
        ({"unit": None}, "unit cannot be None"),
        ({"colour": "red"}, "not a measurement: .*colour"),
        ('{"kind": "run", "commit": "abc"}', "not a measurement: 'devices'"),
        ("worst 3", "not a measurement"),
    ],
)
def test_broken_input(tool: ModuleType, tmp_path: Path, line: dict | str, told: str) -> None:
    with pytest.raises(tool.measurements.MeasurementError, match=rf"measurements\.jsonl:2: {told}"):
        tool.measurements.read(measurement_file(tmp_path, {}, line))


def test_no_input(tool: ModuleType, tmp_path: Path) -> None:
    with pytest.raises(tool.measurements.MeasurementError, match="no measurements; tests write them if"):
        tool.measurements.read(measurement_file(tmp_path))
    (tmp_path / "nameless.jsonl").write_text(json.dumps(LINE) + "\n")
    with pytest.raises(tool.measurements.MeasurementError, match="the line about the machine is missing"):
        tool.measurements.read(tmp_path / "nameless.jsonl")
    with pytest.raises(tool.measurements.MeasurementError, match="No such file"):
        tool.measurements.read(tmp_path / "nothing.jsonl")


@pytest.mark.skipif("REALCAM_MEASUREMENTS" in os.environ, reason="the page is about to be written again")
def test_the_page_at_hand_is_the_tool_s(tool: ModuleType) -> None:
    page = tool.PAGE.read_text(encoding="utf-8")
    assert page.startswith(tool.INTRODUCTION)
    assert f"]({tool.PLOT.as_posix()})" in page
    assert (tool.PAGE.parent / tool.PLOT).is_file()
    assert all(f"image points of {name} " in page for name in CENTRED)
    headings = [line[3:] for line in page.splitlines() if line.startswith("## ") and "Broken" not in line]
    assert headings == [section for section in tool.measurements.SECTIONS if section in headings]
