"""Search of the built site, by the index that Sphinx has written for it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

# Words that users have searched for, and the page that answers them. Pages with the words in headings come first.
PAGES = {
    "glass black": "docs/troubleshooting",
    "grain": "docs/troubleshooting",
    "blurred": "docs/troubleshooting",
    "Ctrl-C": "docs/troubleshooting",
    "image simulation": "docs/image-simulation",
    "headless Blender": "docs/blender",
}
NAMES = ("Lens.focused", "image_simulation", "Shot.load")


def not_found(folder: Path) -> Iterator[str]:
    """A line for each of PAGES and NAMES that the search of the site in a folder does not find."""
    text = (folder / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text[text.index("(") + 1 : text.rindex(")")])
    for query, page in PAGES.items():
        words = [word.lower() for word in re.split(r"\W+", query) if len(word) > 2]  # the search ignores shorter ones
        if page not in index["docnames"] or not all(
            index["docnames"].index(page) in _holders(index["titleterms"], word) for word in words
        ):
            yield f'the search for "{query}" does not lead to a heading of {page}'
    names = [f".{prefix}.{entry[4]}" for prefix, entries in index["objects"].items() for entry in entries]
    for name in NAMES:
        if not any(full.endswith(f".{name}") for full in names):
            yield f'the search for "{name}" does not lead to the API'


def _holders(terms: dict[str, Any], word: str) -> set[int]:
    """The numbers of the pages that have a word in a heading. The index holds stems: "simul" for "simulation"."""
    found: set[int] = set()
    for stem, pages in terms.items():
        if len(stem) > 2 and word.startswith(stem):
            found.update(pages if isinstance(pages, list) else [pages])
    return found
