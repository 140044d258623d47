"""Tables of texts in HTML."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence


def html_table(rows: Iterable[Sequence[str]], head: Sequence[str] = (), align: str | None = None) -> str:
    """Returns a <table> of escaped texts.

    head: titles of the columns. align: alignment of all cells; None leaves it to the style of the page.
    """
    style = "" if align is None else f' style="text-align: {align}"'

    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}{style}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    top = f"<thead>{line(head, 'th')}</thead>\n" if head else ""
    body = "\n".join(line(row, "td") for row in rows)
    return f"<table>{top}<tbody>\n{body}\n</tbody></table>"
