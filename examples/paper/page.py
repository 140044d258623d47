"""All experiments on one page of HTML that needs no other file."""

from __future__ import annotations

import html
import os
from collections.abc import Callable, Sequence
from pathlib import Path

from realcam import ImageFileError, InputError, files
from realcam.drawing.web_page import page_top
from realcam.html_tables import html_table

from . import aberrations, depth_of_field, distortion, double_gauss, interaction, pixel_pupil, snell, speed
from .experiment import Experiment

EXPERIMENTS: dict[str, Callable[[str], Experiment]] = {
    "lens-table": double_gauss.experiment,
    "snell": snell.experiment,
    "aberrations": aberrations.experiment,
    "distortion": distortion.experiment,
    "depth-of-field": depth_of_field.experiment,
    "speed": speed.experiment,
    "interaction": interaction.experiment,
    "pixel-pupil": pixel_pupil.experiment,
}

STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; }
body { color: var(--text); background: var(--page); }
figure { margin: 0; }
figcaption { font-size: 13px; color: var(--quiet); }
.figures { display: flex; flex-wrap: wrap; gap: 1em; align-items: end; }
svg { max-width: 100%; height: auto; }
table { border-collapse: collapse; margin: 1em 0; }
td, th { padding: 0.2em 0.8em; text-align: left; border-bottom: 1px solid var(--grid); vertical-align: top; }
@media print { body { font-size: 9pt; margin: 0; } figure, tr { break-inside: avoid; }
  h2 { break-after: avoid; } }
"""


def save_page(
    path: str | os.PathLike[str],
    *,
    device: str = "auto",
    only: Sequence[str] = (),
    progress: Callable[[str], None] | None = None,
) -> None:
    """Does the experiments, or `only` some of them, and writes the page (.html).

    progress: called with the name of each before it begins. Raises ImageFileError, and InputError for a name that is
    none.
    """
    target = Path(path)
    if target.suffix.lower() != ".html":
        raise ImageFileError(f"{target}: unknown suffix; expected .html")
    unknown = [name for name in only if name not in EXPERIMENTS]
    if unknown:
        raise InputError(f'unknown experiment "{unknown[0]}"; {", ".join(EXPERIMENTS)} are known')
    files.check_target(target)
    sections = []
    for name in only or EXPERIMENTS:
        if progress is not None:
            progress(name)
        sections.append(_section(name, EXPERIMENTS[name](device)))
    files.write_whole(target, _page(sections).encode())


def _section(name: str, experiment: Experiment) -> str:
    parts = [f'<section id="{name}">\n<h2>{html.escape(experiment.title)}</h2>']
    parts += [f"<p>{html.escape(text)}</p>" for text in experiment.text]
    if experiment.figures:
        figures = (
            f"<figure>{figure.markup}<figcaption>{html.escape(figure.caption)}</figcaption></figure>"
            for figure in experiment.figures
        )
        parts.append('<div class="figures">' + "\n".join(figures) + "</div>")
    if experiment.rows:
        if any(row.paper for row in experiment.rows):
            rows = [(row.quantity, row.paper, row.here) for row in experiment.rows]
            parts.append(html_table(rows, ("", "paper", "here")))
        else:
            parts.append(html_table([(row.quantity, row.here) for row in experiment.rows], ("", "here")))
    return "\n".join([*parts, "</section>"])


def _page(sections: list[str]) -> str:
    return f"""{page_top("The experiments of Liu and Hsu (2013), with realcam", STYLE, None)}
<p>D. S.-M. Liu and C.-W. Hsu, "Ray-Tracing Based Interactive Camera Simulation", MVA 2013. What the paper shows is
named by its figure and equation numbers; where it prints a number, that stands beside the one measured here.</p>
{chr(10).join(sections)}
</html>
"""
