"""The documentation's site (docs/site): every page is reached, and every public name is in the API.

`./run docs` builds it, where warnings are errors and links are checked.
"""

from __future__ import annotations

import importlib.util
import re
import subprocess
from fnmatch import fnmatch
from pathlib import Path
from types import ModuleType

import pytest
import realcam as rc

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "docs" / "site"


def module_of(name: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(SITE))
    spec = importlib.util.spec_from_file_location(name, SITE / f"{name}.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def entries(index: str) -> list[str]:
    """Of all tables of contents of a page, names of pages or patterns of them."""
    trees = re.findall(r"^```\{toctree\}\n(.*?)^```", index, re.DOTALL | re.MULTILINE)
    lines = [line for tree in trees for line in tree.splitlines() if line and not line.startswith(":")]
    return [re.sub(r".*<(.*)>", r"\1", line) for line in lines]  # without titles


def test_every_page_is_reached() -> None:
    listed = subprocess.run(
        ["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard", "*.md"], capture_output=True, text=True
    )
    if listed.returncode != 0:
        pytest.skip("only a clone knows which pages are the repository's")
    pages = {name.removesuffix(".md") for name in listed.stdout.splitlines() if (ROOT / name).is_file()}
    pages = {page for page in pages if not page.startswith((".github/", "docs/site/", "benchmarks/"))}
    reached = entries((SITE / "index.md").read_text(encoding="utf-8"))
    assert {page for page in pages if not any(fnmatch(page, entry) for entry in reached)} == set()
    made = ("api/", "tutorials/")
    strange = {entry for entry in reached if "*" not in entry and not entry.startswith(made)} - pages
    assert strange == set()


def test_every_public_name_is_in_the_api(monkeypatch: pytest.MonkeyPatch) -> None:
    groups = module_of("api_pages", monkeypatch).GROUPS
    names = [name for group in groups.values() for name in group]
    assert len(names) == len(set(names))
    assert set(names) == set(rc.__all__) - {"__version__", "analysis"}
