"""Report as one HTML page, which follows the browser's light or dark setting and has a print layout."""

from __future__ import annotations

import html
import re

import matplotlib
from matplotlib.transforms import Bbox

from ..drawing.web_page import inline_svg, page_top
from .report_facts import ReportFacts
from .report_plots import PAGE_IN, PLOTS_TOP, ReportPlots

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 66rem; margin: 2rem auto; padding: 0 1rem;
  background: var(--page); color: var(--text); }
h1 { margin-bottom: 0.2rem; } h1 + p { margin-top: 0; color: var(--quiet); }
h2 { margin: 2.5rem 0 0.5rem; }
svg { width: 100%; height: auto; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.15rem 0.5rem; text-align: right; white-space: nowrap; }
th { font-weight: 600; } thead th { border-bottom: 1px solid var(--faint); }
tbody tr:hover { background: var(--grid); }
.figures th, .figures td, .surfaces .text { text-align: left; }
.figures td { white-space: normal; }
.figures th { font-weight: normal; color: var(--quiet); padding-left: 0; }
.surfaces thead th { white-space: normal; vertical-align: bottom; }
.surfaces .sum td { border-top: 1px solid var(--faint); }
.wide { overflow-x: auto; }
@media screen and (max-width: 64rem) {
  .surfaces { font-size: 0.75rem; }
  .surfaces th, .surfaces td { padding: 0.15rem 0.3rem; }
}
.note { color: var(--quiet); font-size: 0.85rem; }
@page { size: A4; margin: 12mm; }
@media print {
  body { font-size: 9pt; max-width: none; margin: 0; padding: 0; }
  section + section { break-before: page; }
  h2 { margin-top: 1rem; break-after: avoid; }
  section + section h2 { margin-top: 0; }
  svg, tr { break-inside: avoid; } thead { display: table-header-group; }
  section > svg { max-height: 255mm; }
  table, .note { font-size: 7pt; } th, td { padding: 0.05rem 0.3rem; }
  .wide { overflow: visible; }
}
"""


def page_of(facts: ReportFacts, plots: ReportPlots, theme: str | None) -> bytes:
    """Content of the page. theme: None follows the browser's setting. The light theme must be current: its colours in
    the figures are replaced by the page's CSS variables."""
    with matplotlib.rc_context({"axes.grid": False}):
        drawing = "\n".join(
            inline_svg(plots.source.lens.draw(**options), f"lens{k or ''}") for k, options in enumerate(plots.drawings)
        )
    sections = "\n".join(
        f"<section>\n<h2>{html.escape(subject)}</h2>\n"
        f"{inline_svg(page, f'{number}', Bbox.from_bounds(0, 0, PAGE_IN[0], PLOTS_TOP * PAGE_IN[1]))}\n</section>"
        for number, (subject, page) in enumerate(plots.pages())
    )
    title, source = html.escape(facts.title), html.escape(facts.source)
    figures = "\n".join(
        f"<tr><th scope='row'>{html.escape(name)}</th><td>{html.escape(text)}</td></tr>" for name, text in facts.figures
    )
    return f"""{page_top(title, STYLE, theme)}
<p>{source}</p>
<section>
{drawing}
<table class="figures">
{figures}
</table>
<h2>Prescription{" and Seidel sums" if len(facts.columns) > facts.prescription_columns else ""}</h2>
<div class="wide">
{_surfaces(facts)}
</div>
<p class="note">{html.escape(facts.note)}</p>
</section>
{sections}
</html>
""".encode()


def _surfaces(facts: ReportFacts) -> str:
    """HTML table of the surfaces."""

    def cells(row: tuple[str, ...], opened: str, closed: str) -> str:
        parts = []
        for k, cell in enumerate(row):
            is_text = k < facts.prescription_columns and k in (1, 4)  # kind and glass
            with_index = re.sub("_([A-Zd]+)", r"<sub>\1</sub>", html.escape(cell))
            parts.append(f"<{opened}{' class=text' if is_text else ''}>{with_index}</{closed}>")
        return "".join(parts)

    rows = "\n".join(
        f"<tr{' class=sum' if row[1] == 'sum' else ''}>{cells(row, 'td', 'td')}</tr>" for row in facts.rows
    )
    head = f"<thead><tr>{cells(facts.columns, 'th scope=col', 'th')}</tr></thead>"
    return f'<table class="surfaces">\n{head}\n<tbody>\n{rows}\n</tbody>\n</table>'
