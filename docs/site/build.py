"""Builds the site of the documentation: ./run docs, or python docs/site/build.py -o FOLDER.

Sphinx reads build/docs/source, where the pages stand beside each other as they do in the repository, so that links
between them hold. What is made by programs (tutorials, the API, pages of lenses and effects) stands there, too.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from collections.abc import Callable
from pathlib import Path

import api_pages
import cpp_pages
import effect_pages
import lens_pages
from links import broken_links
from search import not_found
from sphinx.cmd.build import main as sphinx

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WORK = ROOT / "build" / "docs"
PAGES = WORK / "source"
# The pages, and the files that links of theirs lead to.
PATTERNS = (
    "*.md", "docs/*.md", "docs/decisions/*.md", "docs/generated/*.md", "docs/images/*", "docs/generated/images/*",
    "lenses/*.md", "sensors/*.md", "benchmarks/results/*.md", "benchmarks/results/*.png", "examples/*.py",
    "examples/tutorials/*.*", "tests/consumer/CMakeLists.txt",
)  # fmt: skip


def copy_changed(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    if not target.is_file() or target.stat().st_mtime != source.stat().st_mtime:
        shutil.copy2(source, target)


def lay_out(pages: Path) -> None:
    for pattern in PATTERNS:
        for gone in {path.relative_to(pages) for path in pages.glob(pattern) if path.is_file()}:
            if gone != Path("index.md") and not (ROOT / gone).is_file():
                (pages / gone).unlink()
        for path in ROOT.glob(pattern):
            copy_changed(path, pages / path.relative_to(ROOT))
    copy_changed(HERE / "index.md", pages / "index.md")
    # sphinx-gallery starts programs in their own folder, users start them in the repository's.
    tutorials = pages / "tutorial_sources"
    shutil.rmtree(tutorials, ignore_errors=True)
    for path in (ROOT / "examples" / "tutorials").iterdir():
        copy_changed(path, tutorials / path.name)
    for name in ("scenes", "examples", "build/dev"):
        (tutorials / name).parent.mkdir(exist_ok=True)
        (tutorials / name).symlink_to(ROOT / name)


def timed(what: str, make: Callable[[], object]) -> None:
    start = time.monotonic()
    make()
    print(f"{what}: {time.monotonic() - start:.0f} s", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "out" / "docs", help="folder of the site")
    parser.add_argument(
        "--no-pictures",
        action="store_true",
        help="for writers of pages: take no photographs and start no tutorials; empty pictures stand for missing ones",
    )
    arguments = parser.parse_args()
    has_pictures = not arguments.no_pictures
    lay_out(PAGES)
    timed("API", lambda: api_pages.write(PAGES / "api"))
    timed("C++", lambda: cpp_pages.write(PAGES / "cpp-api"))
    timed("lenses", lambda: lens_pages.write(PAGES / "gallery", has_pictures=has_pictures))
    timed("effects", lambda: effect_pages.write(PAGES / "effects", has_pictures=has_pictures))
    words: list[str | Path] = [] if has_pictures else ["-D", "plot_gallery=0"]  # read by sphinx-gallery
    words += ["-W", "--keep-going", "-q", "-b", "html", "-c", HERE, "-d", WORK / "doctrees", PAGES, arguments.output]
    status = sphinx([str(word) for word in words])
    broken = [] if status else [*broken_links(arguments.output), *not_found(arguments.output)]
    print(*broken, sep="\n", end="\n" if broken else "", file=sys.stderr)
    if status == 0 and not broken:
        print(f"The site is in {arguments.output}: open index.html")
    return int(status or bool(broken))


if __name__ == "__main__":
    sys.exit(main())
