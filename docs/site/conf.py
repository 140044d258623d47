"""How Sphinx makes the site. docs/site/build.py lays the pages out, and starts it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import realcam as rc

project = "realcam"
author = "realcam contributors"
copyright = author
version = release = rc.__version__
root_doc = "index"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx_gallery.gen_gallery"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
include_patterns = [
    "*.md", "docs/**", "benchmarks/**", "lenses/**", "sensors/**", "tutorials/**", "api/**", "cpp-api/**", "gallery/**",
    "effects/**",
]  # fmt: skip
exclude_patterns = ["tutorial_sources"]
# Otherwise sought beside the pages.
templates_path = [str(Path(__file__).parent / "templates")]

# Links within a page lead to headings by the names that GitHub gives them.
myst_heading_anchors = 4
# Indented blocks of pages are input and output of a terminal.
highlight_language = "none"

html_theme = "furo"
html_title = "realcam"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = [("slider.js", {"defer": "defer"})]
html_show_sourcelink = False
html_copy_source = False

autosummary_generate = True
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
# Otherwise `realcam.Lens` would stand in front of each of its methods.
add_module_names = False
toc_object_entries_show_parents = "hide"

sphinx_gallery_conf = {
    "examples_dirs": "tutorial_sources",
    "gallery_dirs": "tutorials",
    "filename_pattern": r"\.py$",
    "abort_on_example_error": True,
    "capture_repr": ("_repr_html_",),
    "download_all_examples": False,
    "min_reported_time": 1e9,
    "write_computation_times": False,
    "show_signature": False,
    "remove_config_comments": True,
}

_ITEM = re.compile(r"(?P<names>\*{0,2}[a-z]\w*(?:, \*{0,2}[a-z]\w*)*): (?P<text>.*)")


def plain_text_as_rst(app: Any, what: str, name: str, obj: object, options: Any, lines: list[str]) -> None:
    """The docstrings are plain text: paragraphs, and paragraphs that begin with names of arguments and a colon."""
    shown: list[str] = []
    in_item = False
    for line in lines:
        item = _ITEM.fullmatch(line)
        in_item = bool(item) or (in_item and bool(line.strip()))
        if line.startswith("    "):  # code
            shown += [line] if shown and shown[-1].startswith("    ") else ["", "::", "", line]
        elif item:
            shown += ["", f"- **{escaped(item['names'])}**: {escaped(item['text'])}"]
        else:
            shown.append(f"  {escaped(line.strip())}" if in_item else escaped(line))
    lines[:] = shown


def escaped(text: str) -> str:
    return re.sub(r"([\\*`|_])", r"\\\1", text)


def as_on_the_site(app: Any, name: str, source: list[str]) -> None:
    """In the repository a tutorial is a program; on the site it is the page that sphinx-gallery makes of it. Results of
    benchmarks are tables without a title."""
    if name.startswith("benchmarks/"):
        source[0] = f"---\norphan: true\n---\n\n# {name}\n\n{source[0]}"
    source[0] = re.sub(r"\(((?:\.\./)*)examples/tutorials/(\w+)\.py\)", r"(\1tutorials/\2.rst)", source[0])


def setup(app: Any) -> None:
    app.connect("autodoc-process-docstring", plain_text_as_rst)
    app.connect("source-read", as_on_the_site)
