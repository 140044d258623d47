"""Links of the built site to files and headings that are not there. Sphinx sees those of pages, but none in HTML."""

from __future__ import annotations

from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class _Page(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.targets: set[str] = set()
        self.names = {"", "top"}  # where a page begins
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.targets.add(value)
            elif name in ("id", "name") and value:
                self.names.add(value)


def broken_links(folder: Path) -> Iterator[str]:
    """A line for each. Links to other sites are not followed."""
    pages = {page.resolve(): _Page(page.read_text(encoding="utf-8")) for page in sorted(folder.rglob("*.html"))}
    for path, page in pages.items():
        for target in sorted(page.targets):
            link = urlsplit(target)
            if link.scheme or link.netloc:
                continue
            file = (path.parent / unquote(link.path)).resolve() if link.path else path
            if not file.exists():
                yield f"{path.relative_to(folder.resolve())}: there is no {target}"
            elif file in pages and unquote(link.fragment) not in pages[file].names:
                yield f"{path.relative_to(folder.resolve())}: there is no heading {target}"
