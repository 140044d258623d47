"""The documentation's site (docs/site): every page is reached, and every public name is in the API.

`./run docs` builds it, where warnings are errors and links are checked.
"""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
from fnmatch import fnmatch
from pathlib import Path
from types import ModuleType

import matplotlib.image
import pytest
import realcam as rc
from realcam.denoiser import opened

ROOT = Path(__file__).resolve().parents[3]
SITE = ROOT / "docs" / "site"


def module_of(name: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(SITE))
    spec = importlib.util.spec_from_file_location(name, SITE / f"{name}.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def entries(index: str) -> list[str]:
    """Page names, or patterns of page names, in all tables of contents of a page."""
    trees = re.findall(r"^```\{toctree\}\n(.*?)^```", index, re.DOTALL | re.MULTILINE)
    lines = [line for tree in trees for line in tree.splitlines() if line and not line.startswith(":")]
    return [re.sub(r".*<(.*)>", r"\1", line) for line in lines]  # without titles


def test_every_page_is_reached() -> None:
    if not (ROOT / ".git").exists():
        pytest.skip("only a clone knows which pages are the repository's")
    listed = subprocess.run(
        ["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard", "*.md"], capture_output=True, text=True, check=True
    )
    pages = {name.removesuffix(".md") for name in listed.stdout.splitlines() if (ROOT / name).is_file()}
    pages = {page for page in pages if not page.startswith((".github/", "docs/site/", "benchmarks/", "cuda13/"))}
    reached = entries((SITE / "index.md").read_text(encoding="utf-8"))
    assert {page for page in pages if not any(fnmatch(page, entry) for entry in reached)} == set()
    made = ("api/", "cpp-api/", "tutorials/", "gallery/", "effects/")
    strange = {entry for entry in reached if "*" not in entry and not entry.startswith(made)} - pages
    assert strange == set()


def test_every_public_name_is_in_the_api(monkeypatch: pytest.MonkeyPatch) -> None:
    groups = module_of("api_pages", monkeypatch).GROUPS
    names = [name for group in groups.values() for name in group]
    assert len(names) == len(set(names))
    assert set(names) == set(rc.__all__) - {"__version__", "analysis"}


def test_broken_links_are_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "a.html").write_text(
        '<h1 id="here">A</h1><a href="#here"></a><a href="sub/b.html#there"></a><a href="https://example.org/x"></a>'
        '<img src="gone.png"><a href="sub/b.html#gone"></a><a href="sub/b.html"></a><img src="data:image/png;base64,x">'
    )
    (tmp_path / "sub" / "b.html").write_text('<p id="there"></p><a href="../a.html#here"></a><a href="../c.html"></a>')
    assert list(module_of("links", monkeypatch).broken_links(tmp_path)) == [
        "a.html: there is no gone.png",
        "a.html: there is no heading sub/b.html#gone",
        "sub/b.html: there is no ../c.html",
    ]


def test_what_the_search_does_not_find_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    search = module_of("search", monkeypatch)
    monkeypatch.setattr(search, "PAGES", {"glass black": "docs/a", "Ctrl-C": "docs/a", "simulations": "docs/b"})
    monkeypatch.setattr(search, "NAMES", ("Lens.focused", "Lens.load"))
    index = {
        "docnames": ["docs/a", "docs/b"],
        "titleterms": {"glass": [0, 1], "black": 1, "ctrl": 0, "simul": [1]},
        "objects": {"realcam.Lens": [[0, 1, 1, "", "focused"]], "realcam": [[0, 1, 1, "", "Lens"]]},
    }
    (tmp_path / "searchindex.js").write_text(f"Search.setIndex({json.dumps(index)})")
    assert list(search.not_found(tmp_path)) == [
        'the search for "glass black" does not lead to a heading of docs/a',
        'the search for "Lens.load" does not lead to the API',
    ]


HEADER = """#pragma once
namespace REALCAM_NAMESPACE {

/// A lens, in mm.
/// Has `surfaces`.
struct Lens {
    int surfaces = 3;       ///< from 0
    Range range{1, 2};
    explicit Lens(int count) : surfaces(count), range{} { check(count); }
    REALCAM_INLINE double f() const { return count_ > 0 ? 1.0 / count_ : 0.0; }
    Lens& operator+=(const Lens& other) {
        surfaces += other.surfaces;
        return *this;
    }
    struct Part {
        int first() const { return 1; }
    };

private:
    int count_ = 0;
};

namespace lens_detail {
/// Not for users.
int hidden();
}  // namespace lens_detail

int without_a_comment();

/// Throws InputError; text with "{".
template <class T, int N = 3>
inline T focus(const Lens& lens, T metres = T(1)) {
    for (int i = 0; i < N; ++i) metres += "}"[0];
    return metres;
}

/// In mm.
inline constexpr double kFilm[] = {36, 24};

}  // namespace REALCAM_NAMESPACE
"""


def test_headers_of_cpp_are_read_as_they_stand(monkeypatch: pytest.MonkeyPatch) -> None:
    lens, focus, film = module_of("cpp_pages", monkeypatch).items_of(HEADER)
    assert (lens.name, lens.text) == ("Lens", "A lens, in mm.\nHas `surfaces`.")
    words = " ".join(lens.declaration.split())
    assert words == (
        "struct Lens { int surfaces = 3; ///< from 0 Range range{1, 2}; explicit Lens(int count); "
        "double f() const; Lens& operator+=(const Lens& other); struct Part { int first() const; }; };"
    )
    assert " ".join(focus.declaration.split()) == (
        "template <class T, int N = 3> inline T focus(const Lens& lens, T metres = T(1));"
    )
    assert focus.name == "focus"
    assert (film.name, film.declaration) == ("kFilm", "inline constexpr double kFilm[] = {36, 24};")


@pytest.mark.skipif(not (ROOT / "cpp").is_dir(), reason="wants the C++ sources")
def test_the_api_of_cpp_has_all_folders_of_the_core(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    cpp_pages = module_of("cpp_pages", monkeypatch)
    cpp_pages.write(tmp_path)
    folders = {path.parent.relative_to(ROOT / "cpp") for path in (ROOT / "cpp" / "optics").rglob("*.hpp")}
    assert {str(folder) for folder in folders} <= set(cpp_pages.folders())
    text = (tmp_path / "realcam-optics-lens.md").read_text(encoding="utf-8")
    assert "LensSystem focused(const LensSystem& lens, double focus_distance);" in text
    for page in tmp_path.glob("*.md"):
        for block in re.findall(r"^```cpp\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE):
            code = re.sub(r"//.*", "", block)
            assert code.count("{") == code.count("}"), block
            assert code.count("(") == code.count(")"), block
            assert not re.search(r"\breturn\b", code), block


def links(page: Path) -> set[str]:
    return set(re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")))


def missing_links(folder: Path) -> set[str]:
    """Link targets in a folder's pages that exist neither in the folder nor in the repository. The site puts these
    pages beside `docs`."""
    targets = {target for page in folder.glob("*.md") for target in links(page)}
    return {target for target in targets if not (folder / target).is_file() and not (SITE.parent / target).is_file()}


@pytest.fixture
def denoiser() -> None:
    try:
        opened("cpu")
    except rc.InputError:
        pytest.skip("photographs are denoised, and the extra realcam[denoise] is not installed")


@pytest.mark.slow
def test_pages_of_lenses_are_complete(monkeypatch: pytest.MonkeyPatch, denoiser: None, tmp_path: Path) -> None:
    tomlkit = pytest.importorskip("tomlkit", reason="lens files are read without realcam")
    pages, pictures = module_of("lens_pages", monkeypatch), module_of("lens_pictures", monkeypatch)
    monkeypatch.setattr(pages, "lens_pictures", pictures)
    monkeypatch.setattr(pictures, "LONGER_SIDE_PX", 48)
    monkeypatch.setattr(pictures, "SAMPLES", 1)
    (tmp_path / "gone.md").write_text("of a lens that is no longer there")
    names = ("tessar-50mm", "fisheye-6mm-220deg")
    pages.write(tmp_path, names)
    assert {page.stem for page in tmp_path.glob("*.md")} == {"index", *names}
    assert missing_links(tmp_path) == set()
    assert {f"{name}.md" for name in names} <= links(tmp_path / "index.md")
    for name in names:
        surfaces = tomlkit.parse((ROOT / "lenses" / f"{name}.toml").read_text(encoding="utf-8")).unwrap()["surface"]
        text = (tmp_path / f"{name}.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| \d+ \|.*", text, re.MULTILINE)
        assert len(rows) == len(surfaces)
        for row, surface in zip(rows, surfaces, strict=True):
            if "radius_of_curvature_mm" in surface:
                assert float(row.split("|")[3]) == pytest.approx(
                    surface["radius_of_curvature_mm"], rel=1e-5
                )  # six digits are shown
        assert {"## Figures", "## Contrast", "## Prescription"} <= set(text.splitlines())
    # Pages that are newer than their sources are not rewritten.
    before = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    pages.write(tmp_path, names)
    assert {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()} == before


def test_pages_without_pictures_have_empty_ones_until_the_next_build(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "tessar-50mm.jpg").write_bytes(b"a photograph")
    module_of("lens_pages", monkeypatch).write(tmp_path, ["tessar-50mm"], has_pictures=False)
    assert missing_links(tmp_path) == set()
    assert (tmp_path / "tessar-50mm.jpg").read_bytes() == b"a photograph"
    module_of("effect_pages", monkeypatch).write(tmp_path, ["coatings"], has_pictures=False)
    assert missing_links(tmp_path) == set()
    is_newer = module_of("written", monkeypatch).is_newer
    for name in ("tessar-50mm.svg", "tessar-50mm-mtf.svg", "coatings-without.png", "coatings-with.png"):
        assert not is_newer(tmp_path / name, [ROOT / "LICENSE"])


@pytest.mark.slow
def test_a_page_of_an_effect_is_complete(monkeypatch: pytest.MonkeyPatch, denoiser: None, tmp_path: Path) -> None:
    pages, pictures = module_of("effect_pages", monkeypatch), module_of("effect_pictures", monkeypatch)
    assert set(pictures.PAIRS) == {effect.name for effect in rc.effects()}
    monkeypatch.setattr(pages, "effect_pictures", pictures)
    monkeypatch.setattr(pictures, "SIZE", (48, 32))
    pages.write(tmp_path, ["coatings"])
    assert {page.stem for page in tmp_path.glob("*.md")} == {"index", "coatings"}
    assert missing_links(tmp_path) == set()
    assert {"coatings-without.png", "coatings-with.png", "../docs/coatings.md"} <= links(tmp_path / "coatings.md")
    without, with_effect = (matplotlib.image.imread(tmp_path / f"coatings-{end}.png") for end in ("without", "with"))
    # Ten surfaces of bare glass take a tenth of the light and more.
    assert with_effect.mean() < without.mean()
