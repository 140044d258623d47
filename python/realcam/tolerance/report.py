"""HTML report of a tolerance study."""

from __future__ import annotations

import html
import math
import os
from collections.abc import Iterable

from .. import files
from ..analysis import style
from ..drawing.themes import theme_named
from ..drawing.web_page import inline_svg, page_top
from ..html_tables import html_table
from ..number_text import percent_text
from .plots import MEASURES, study_figure, with_limit
from .study import SHARES, ToleranceStudy

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem;
  background: var(--page); color: var(--text); }
h1 { margin-bottom: 0.2rem; } h1 + p, .note { color: var(--quiet); }
svg { width: 100%; height: auto; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.15rem 0.6rem; text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 1px solid var(--faint); }
.wide { overflow-x: auto; }
@media print { body { font-size: 9pt; max-width: none; margin: 0; } svg, tr { break-inside: avoid; } }
"""
SHOWN_OFFENDERS = 12  # tolerances in the plot of the worst offenders
DEFAULT_LOSS = 0.02  # of mean MTF, for the inverse sensitivities


def save_tolerance_report(
    study: ToleranceStudy, path: str | os.PathLike[str], *, theme: str | None = None, loss: float = DEFAULT_LOSS
) -> None:
    """Writes the report. theme: "light" or "dark"; None follows the reader's browser. loss: loss of mean MTF for which
    the report lists the inverse sensitivities. Raises ImageFileError, and InputError for an unknown theme."""
    target = files.check_target(path, (".html",))
    if theme is not None:
        theme_named(theme)
    files.write_whole(target, page_of(study, theme, loss).encode())


def page_of(study: ToleranceStudy, theme: str | None, loss: float) -> str:
    """The report as an HTML page; arguments as for save_tolerance_report."""
    offenders = study.sensitivities()
    allowed = {}  # limits at which a tolerance alone costs `loss`
    if loss < study.nominal_measure("mtf"):
        allowed = {(t.kind, t.first, t.last): t.limit for t in study.inverse_sensitivities(loss)}
    with style.themed("light", 7.0):
        figure = inline_svg(study_figure(study, offenders[:SHOWN_OFFENDERS]), "tolerance")
    title = html.escape(f"{study.lens.title or study.lens.name or 'lens'}: tolerances")
    rows = [
        (
            with_limit(o),
            f"{o.mtf[0]:+.4f}",
            f"{o.mtf[1]:+.4f}",
            f"{o.lowest_mtf[0]:+.4f}",
            f"{o.lowest_mtf[1]:+.4f}",
            f"{1000 * max(o.spot_mm):+.2f}",
            f"{o.focal_length_mm[1]:+.4f}",
            _limit_text(allowed.get((o.tolerance.kind, o.tolerance.first, o.tolerance.last))),
        )
        for o in offenders
    ]
    sensitivities = html_table(
        rows, ["tolerance", "mean MTF −", "+", "worst field −", "+", "spot / µm", "focal length / mm", "allowed"]
    )
    quantiles = html_table(_quantiles(study), ["", "nominal", *(f"{percent_text(share)} below" for share in SHARES)])
    copies = f"{len(study)} {'copy' if len(study) == 1 else 'copies'}"
    stopped_note = "" if study.is_whole else " The study was stopped before all copies were evaluated."
    return f"""{page_top(title, STYLE, theme)}
<p>{copies}, seed {study.seed}; {html.escape(_compensators(study))}.{stopped_note}</p>
{figure}
<h2>Copies</h2>
<div class="wide">{quantiles}</div>
<h2>Each tolerance alone</h2>
<div class="wide">{sensitivities}</div>
<p class="note">Changes at the lower and the upper limit, with the compensators set; for a tolerance with a direction,
in the one with the larger loss. The change of the spot is the larger one, that of the focal length the one at the
upper limit. MTF is the geometric MTF at {study.frequencies_per_mm[study.middle_frequency]:.4g} periods per mm
times the diffraction limit. "Allowed": the limit at which a tolerance alone costs {loss:g} of the mean MTF.</p>
</html>
"""


def _quantiles(study: ToleranceStudy) -> Iterable[tuple[str, ...]]:
    """Yields the rows of the table of measures: label, nominal value, quantiles."""
    for name, label in MEASURES.items():
        scale, digits = (100, 3) if name == "distortion" else (1, 4)
        values = [study.nominal_measure(name), *study.quantiles(name)]
        yield (label, *(f"{scale * value:.{digits}f}" for value in values))


def _compensators(study: ToleranceStudy) -> str:
    """Description of the compensators."""
    chosen = study.compensators
    parts = ["refocused"] if chosen.refocus else []
    if chosen.film_tilt:
        parts.append("film tilted")
    if chosen.shift is not None:
        s = chosen.shift
        parts.append(f"surfaces {s.first + 1} to {s.last + 1} moved {s.direction} the axis")
    return ", ".join(parts) or "no compensators"


def _limit_text(value: float | None) -> str:
    """Text of an allowed limit; "any" for inf."""
    return "" if value is None else "any" if math.isinf(value) else f"{value:.3g}"
