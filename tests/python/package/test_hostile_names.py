"""Names are data: texts that mean something to a format are written by its writer and read back as texts."""

from __future__ import annotations

import ast
import json
import re
import shlex
import subprocess
import warnings
import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
import realcam as rc
import tomllib
from realcam.cli.dataset import work_of_dataset
from realcam.drawing.figure_files import figure_bytes
from realcam.job.farm_files import FarmWork, array_script, openjd_template, work_of_job
from realcam.osl.shader import _heading

TEXTS = [
    # quotes, escapes and the ends of literals
    '"', "'", '"""', "'''", "\\", "\\\\", '\\"', "x\\", "a'; import os; y='", '"; x = "1', "x' + str(1) + 'y", "{key}",
    "%s %d", "\\x41", "\\u0041", "\\N{BULLET}", "r'x'", "f{1+1}",
    # ends of lines, and lines of each format after them
    "a\nb", "a\r\nb", "a\rb", "a\x0bb", "a\x0cb", "a\x85b", "a\u2028b", "a\u2029b", "a\n[[surface]]\nthickness_mm = 1",
    "a\nSURF 9\n  GLAS EVIL", "a'\nGO\nS 1 2 3", "a\ntouch evil", "a\n#SBATCH --wrap=evil", "a\n}\nshader evil()",
    # shells, templates and expressions
    "$(touch evil)", "`touch evil`", "${HOME}", "$HOME", "a; touch evil", "a && b", "a | b", "a > b", "*?[a]", "~",
    "-rf", "--help", "{{Param.JobFolder}}", "}}", "{{", "!history", "#comment", "// comment", "/* a */", "*/",
    # XML, HTML, TeX
    "<script>alert(1)</script>", "</text>", "&amp;", "&#0;", "]]>", "<!--", "$\\frac{1}{0}$", "_^",
    # paths, and characters without a picture
    "../../evil", "/etc/evil", "..", "C:\\evil", "a/b", "\x7f", "\x01", "\t", "\ufffe", "\u202e", "\ufeff",
    "\U0001f600",
]  # fmt: skip


def visible(text: str) -> str:
    """The text as line-based formats store it: each control character becomes a blank."""
    return "".join(" " if ord(c) < 32 or 127 <= ord(c) < 160 else c for c in text)


@pytest.fixture(scope="module")
def lens() -> rc.Lens:
    return rc.Lens.load("singlet-100mm")


@pytest.fixture(scope="module")
def lens_named(lens: rc.Lens, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], rc.Lens | None]:
    """Lenses whose name, title and source are a text, from files that spell it in escapes. Skipped texts are those
    that the reader refuses: no lens has a name with control characters."""
    path = tmp_path_factory.mktemp("named") / "lens.toml"
    lens.save(path)
    rest = re.sub(r"(?m)^(name|title|source) = .*\n", "", path.read_text())

    def named(text: str) -> rc.Lens | None:
        spelled = '"' + "".join(f"\\U{ord(c):08x}" for c in text) + '"'
        path.write_text(f"name = {spelled}\ntitle = {spelled}\nsource = {spelled}\n{rest}")
        if visible(text) != text:
            with pytest.raises(rc.LensFileError, match="control characters"):
                rc.Lens.load(path)
            return None
        return rc.Lens.load(path)

    return named


def test_there_are_enough_texts() -> None:
    assert len(set(TEXTS)) == len(TEXTS) >= 60


@pytest.mark.parametrize("suffix", [".toml", ".zmx", ".seq", ".json", ".roa"])
def test_lens_files(lens_named: Callable[[str], rc.Lens | None], tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"lens{suffix}"

    def written(text: str) -> rc.Lens | None:
        lens = lens_named(text)
        if lens is not None:
            lens.save(path)
        return None if lens is None else rc.Lens.load(path)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        expected = written("plain")
        assert expected is not None
        for text in TEXTS:
            found = written(text)
            if found is None:
                continue
            assert found.surfaces == expected.surfaces, text
            # Titles of Zemax may stand in quotes, and CODE V's cannot hold their own.
            same = {".zmx": text.strip(' "'), ".seq": text.replace("'", "`").strip()}.get(suffix, text)
            assert (found.title.strip(' "') if suffix == ".zmx" else found.title) == same


@pytest.mark.parametrize("kind", ["job", "dataset"])
def test_scripts_of_schedulers(tmp_path: Path, kind: str) -> None:
    script = tmp_path / "job.sh"
    for text in TEXTS:
        folder = tmp_path / text
        recipe = tmp_path / f"{text}.toml"
        work: FarmWork = work_of_job(folder) if kind == "job" else work_of_dataset(recipe, folder, 5, text)
        paths = [str(path.absolute()) for path in ((folder,) if kind == "job" else (folder, recipe))]
        script.write_bytes(array_script("slurm", work, 3).encode())
        lines = script.read_bytes().decode().split("\n")
        head = [line for line in lines[1:6] if line.startswith("#")]
        assert len(head) == 5
        assert re.fullmatch(r"#SBATCH --job-name=realcam-[\w.-]*", lines[1], re.ASCII)
        assert lines[6].startswith(f"exec realcam {kind} ")
        subprocess.run(["bash", "-n", script], check=True)
        words = shlex.split("\n".join(lines[6:]), comments=False)
        assert words[-len(paths) :] == paths
        if kind == "dataset":
            assert words[words.index("--device") + 1] == text
        try:
            template = json.loads(openjd_template(work, 3))
        except rc.InputError as error:
            assert "\n" not in str(error)
            assert "{{" in text or "}}" in text or not text.isprintable()
            continue
        assert "{{" not in template["name"]
        defaults = [parameter["default"] for parameter in template["parameterDefinitions"]]
        assert defaults == (paths if kind == "dataset" else [*paths, str(folder.absolute() / "pictures")])
        assert all("{{" not in path and path.isprintable() for path in defaults)


def test_shaders(lens_named: Callable[[str], rc.Lens | None]) -> None:
    for text in TEXTS:
        lens = lens_named(text)
        if lens is None:
            continue
        *lines, last = _heading(lens).split("\n")
        assert last == ""
        assert len(lines) == 3
        for line in lines:
            assert line.splitlines() == [line]
            assert line.startswith("// ")
            assert not line.endswith("\\")


def test_the_extension_of_blender(
    lens_named: Callable[[str], rc.Lens | None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from realcam.blender import extension_file

    monkeypatch.setattr(extension_file, "shader_text", lambda lens: _heading(lens))
    path = tmp_path / "lenses.zip"
    for text in TEXTS:
        lens = lens_named(text)
        if lens is None:
            continue
        (key,) = extension_file.write_extension(path, [lens])
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            (preset,) = (name for name in names if name.startswith("presets/"))
            code = archive.read(preset).decode()
            about = json.loads(archive.read("lenses/lenses.json"))
        for name in names:
            assert Path("x", name).resolve().is_relative_to(Path("x").resolve())
            assert "\\" not in name and ".." not in Path(name).parts
        assert f"lenses/{key}.osl" in names
        assert len(Path(f"lenses/{key}.osl").parts) == 2
        statements = ast.parse(code).body
        assert [type(s) for s in statements] == [ast.Import, ast.Assign, ast.Assign]
        assert ast.literal_eval(statements[2].value) == key  # type: ignore[attr-defined]
        assert about[key]["name"] == about[key]["title"] == text


def test_the_shot_files_of_blender(monkeypatch: pytest.MonkeyPatch) -> None:
    source = Path(rc.__file__).parent / "blender" / "extension" / "export.py"
    (function,) = (node for node in ast.parse(source.read_text()).body if getattr(node, "name", "") == "_toml_text")
    space: dict[str, Any] = {"json": json}
    exec(compile(ast.Module([function], []), str(source), "exec"), space)
    for text in TEXTS:
        assert tomllib.loads(f"a = {space['_toml_text'](text)}\nb = 1") == {"a": text, "b": 1}


def test_figures() -> None:
    from matplotlib.figure import Figure

    figure = Figure((4, 40))
    for i, text in enumerate(TEXTS):
        figure.text(0.1, i / len(TEXTS), text, parse_math=False)
    root = ElementTree.fromstring(figure_bytes(figure, ".svg"))
    found = " ".join("".join(node.itertext()) for node in root.iter() if node.tag.endswith("}text"))
    assert not [node for node in root.iter() if "script" in node.tag]
    for text in ("<script>alert(1)</script>", "&amp;", "]]>", "$\\frac{1}{0}$"):
        assert text in found


def test_pages() -> None:
    class Tags(HTMLParser):
        def __init__(self) -> None:
            super().__init__()
            self.tags: set[str] = set()

        def handle_starttag(self, tag: str, attrs: object) -> None:
            self.tags.add(tag)

    from realcam.html_tables import html_table

    page = Tags()
    page.feed(html_table([[text, text] for text in TEXTS], ["a", "b"]))
    assert page.tags == {"table", "thead", "tbody", "tr", "th", "td"}


def test_reports(lens_named: Callable[[str], rc.Lens | None], tmp_path: Path) -> None:
    """A report shows the name in its text, in attributes and in figures; all texts at once, for its time."""
    printable = [text for text in TEXTS if visible(text) == text]
    lens = lens_named(" ".join(printable))
    assert lens is not None
    rc.analysis.save_report(lens, tmp_path / "report.html", fields_deg=[0, 1, 2])
    page = (tmp_path / "report.html").read_text()

    class Scripts(HTMLParser):
        found = ""

        def handle_data(self, data: str) -> None:
            self.found += data if self.lasttag != "script" else ""
            assert self.lasttag != "script" or "alert(1)" not in data

    reader = Scripts()
    reader.feed(page)
    assert "<script>alert(1)</script>" in reader.found


def test_colmap(tmp_path: Path) -> None:
    """Fields of its lines are apart by spaces: a name that has any, or an end of a line, is refused."""
    camera = rc.Camera(rc.Lens.load("singlet-100mm"), film=rc.Film(36, 24, (30, 20)))
    for text in TEXTS:
        if any(c.isspace() for c in text):
            with pytest.raises(rc.InputError, match="COLMAP"):
                rc.save_colmap(tmp_path / "model", {text: camera}, "pinhole")
            continue
        rc.save_colmap(tmp_path / "model", {text: camera}, "pinhole")
        lines = [line for line in (tmp_path / "model/images.txt").read_bytes().split(b"\n") if line[:1] != b"#"]
        fields = lines[0].split(b" ")
        assert len(fields) == 10
        assert fields[9].decode() == text


def test_calibrations(lens_named: Callable[[str], rc.Lens | None]) -> None:
    film = rc.Film(36, 24, (30, 20))
    fits = [rc.fit_camera_model(rc.Camera(rc.Lens.load("singlet-100mm"), film=film), "pinhole")]
    for text in TEXTS:
        lens = lens_named(text)
        if lens is None:
            continue
        label = rc.camera_json(rc.Camera(lens, film=film), fits)
        assert json.loads(json.dumps(label))["lens"]["name"] == text
