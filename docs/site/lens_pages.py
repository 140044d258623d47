"""A page for each bundled lens: photograph, drawing, figures, MTF and prescription; and a gallery of all of them.

What stands in the folder is kept while it is younger than the lens's file and than these programs. After a change of
the simulation itself, remove the folder.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import lens_pictures
import realcam as rc
from realcam.analysis import lens_tables
from realcam.drawing import save_cross_section
from written import is_newer, remove_others, stand_in_for, write_text

ROOT = Path(__file__).resolve().parents[2]
# Angles of view over the diagonal, below which a lens is in the group.
GROUPS = (
    ("Long lenses", 30.0, "less than 30°"),
    ("Normal lenses", 56.0, "30° to 56°"),
    ("Wide angles", 100.0, "56° to 100°"),
    ("Very wide angles and fisheyes", math.inf, "more than 100°"),
)


def row(*cells: object) -> str:
    return "| " + " | ".join(map(str, cells)) + " |"


def page_of(lens: rc.Lens, name: str) -> str:
    title = lens.title or name
    zoom = (
        f"Zoom positions are {', '.join(lens.zoom_positions)}; this page shows {lens.zoom_position}.\n\n"
        if lens.zoom_positions
        else ""
    )
    lines = [
        f"# {title}\n",
        f'`rc.Lens.load("{name}")` or `--lens {name}`. Source: {lens.source}.\n',
        f"{zoom}![The demo scene through this lens]({name}.jpg)\n",
        "The subject of the demo shot, wide open, as large on the film as the lens's angle allows.\n",
        f"![Cross-section of {title} with rays]({name}.svg)\n",
        "## Figures\n",
        row("figure", ""),
        row("---", "---"),
        *(row(*cells) for cells in lens_tables.first_order(lens)),
        "\n## Contrast\n",
        f"![MTF of {title} over the field]({name}-mtf.svg)\n",
        "Focused at infinity. [The page on analysis](../docs/analysis.md) has more plots.\n",
        "## Prescription\n",
        "The last thickness is the distance to the film. A positive radius has its centre on the film's side.\n",
        row(*lens_tables.PRESCRIPTION),
        row("---:", "---", "---:", "---:", "---", "---:"),
        *(row(*cells) for cells in lens_tables.prescription(lens)),
        "\nAspheric coefficients and glass are in the lens's file ([format](../lenses/README.md)).",
    ]
    return "\n".join(lines) + "\n"


def index_of(lenses: dict[str, rc.Lens]) -> str:
    angles = {name: rc.Camera(lens).field_of_view_deg.diagonal for name, lens in lenses.items()}
    lines = [
        "# Gallery of lenses\n",
        "The bundled lenses, wide open before the subject of the demo shot, from narrow to wide angles. "
        "Each picture leads to drawing, figures, MTF and prescription.\n",
    ]
    least = 0.0
    for title, below, words in GROUPS:
        names = sorted((name for name in lenses if least <= angles[name] < below), key=angles.__getitem__)
        least = below
        if not names:
            continue
        lines += [f"## {title}\n", f"{words[0].upper()}{words[1:]} over the diagonal.\n", "```{container} lens-gallery"]
        for name in names:
            data = lenses[name].first_order()
            focal_length, f_number = (
                lens_tables.number(value, 3) for value in (data.effective_focal_length_mm, data.f_number)
            )
            figures = f"{focal_length} mm, f/{f_number}, {angles[name]:.0f}°"
            lines.append(f"- [![]({name}.jpg) {lenses[name].title or name}]({name}.md) {figures}")
        lines.append("```\n")
    return "\n".join([*lines, "```{toctree}\n:hidden:\n", *lenses, "```"]) + "\n"


def write(folder: Path, names: Sequence[str] | None = None, *, has_pictures: bool = True) -> None:
    """Writes what is missing or older than its sources, with index.md as the first page. names: None is all lenses.
    has_pictures: otherwise no picture is made, and empty ones stand where there are none."""
    folder.mkdir(parents=True, exist_ok=True)
    shot = rc.Shot.load(lens_pictures.SHOT)
    lenses = {name: rc.Lens.load(name) for name in names or rc.lens_names()}
    for name, lens in lenses.items():
        file = ROOT / "lenses" / f"{name}.toml"
        pictures = photograph, drawing, mtf = tuple(folder / f"{name}{end}" for end in (".jpg", ".svg", "-mtf.svg"))
        if not has_pictures:
            stand_in_for(pictures)
        elif not all(is_newer(made, (Path(lens_pictures.__file__), file)) for made in pictures):
            save_cross_section(lens, drawing, width_px=1000)
            lens_pictures.save_mtf(lens, mtf)
            lens_pictures.save_photograph(lens, shot, photograph)
        if not is_newer(folder / f"{name}.md", (Path(__file__), file)):
            (folder / f"{name}.md").write_text(page_of(lens, name), encoding="utf-8")
    remove_others(folder, {"index", *lenses})
    write_text(folder / "index.md", index_of(lenses))
