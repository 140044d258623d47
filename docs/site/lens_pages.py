"""A page for each bundled lens: photograph, drawing, figures, MTF and prescription; and a gallery of all of them.

What stands in the folder is kept while it is younger than the lens's file and than these programs. After a change of
the simulation itself, remove the folder.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import lens_pictures
import realcam as rc
from realcam.draw import save_cross_section
from written import is_newer, remove_others, write_text

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


def number(value: float, digits: int = 4) -> str:
    """Without an exponent, which %g begins at 10 to the power of the digits."""
    return "∞" if math.isinf(value) else f"{value:.{max(digits, len(str(int(abs(value)))))}g}"


def glass(surface: rc.Surface) -> str:
    """The name of the glass behind a surface with its index, or the index and Abbe number that the file gives."""
    label = surface.material.label.strip("[]()")
    if not label or label[0].isdigit():
        return label
    return f"{label}, {surface.material.index(587.5618):.5f}"


def prescription(lens: rc.Lens) -> Iterator[str]:
    yield row("", "kind", "radius / mm", "thickness / mm", "glass, n_d", "semi-diameter / mm")
    yield row("---:", "---", "---:", "---:", "---", "---:")
    for index, surface in enumerate(lens.surfaces):
        kind = "" if surface.type == "refracting" else surface.type
        if surface.aspheric_coefficients or surface.conic:
            kind = f"{kind} asphere".strip()
        radius = "plane" if surface.curvature_per_mm == 0 else number(surface.radius_of_curvature_mm, 6)
        is_last = index == len(lens.surfaces) - 1
        thickness = lens.film_distance_mm if is_last else surface.thickness_mm
        yield row(
            index + 1, kind, radius, number(thickness, 6), glass(surface), number(surface.clear_semi_diameter_mm, 5)
        )


def pupil(position_mm: float, diameter_mm: float) -> str:
    if math.isinf(position_mm):
        return "at infinity: telecentric"
    side = "behind" if position_mm >= 0 else "before"
    return f"{number(abs(diameter_mm))} mm wide, {number(abs(position_mm))} mm {side} the front vertex"


def figures(lens: rc.Lens) -> Iterator[str]:
    data, photo = lens.first_order(), rc.photographic_figures(lens)
    angle = photo.angle_of_view_deg
    width, height = lens.film_mm
    yield row("figure", "")
    yield row("---", "---")
    yield row("focal length", f"{number(data.effective_focal_length_mm)} mm")
    bare = " where glass of unknown coatings is bare" if lens.unknown_coatings else ""
    yield row("wide open", f"f/{number(data.f_number, 3)}, T/{number(photo.t_stop, 3)}{bare}")
    yield row("film", f"{number(width)} x {number(height)} mm")
    yield row("angle of view", f"{angle.horizontal:.1f}° x {angle.vertical:.1f}°, diagonal {angle.diagonal:.1f}°")
    yield row("back focal distance", f"{number(data.back_focal_distance_mm)} mm")
    yield row("entrance pupil", pupil(data.entrance_pupil_position_mm, data.entrance_pupil_diameter_mm))
    yield row("exit pupil", pupil(data.exit_pupil_position_mm, data.exit_pupil_diameter_mm))
    if lens.nearest_focus_m > 0:
        yield row("nearest focus", f"{number(lens.nearest_focus_m, 3)} m")


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
        *figures(lens),
        "\n## Contrast\n",
        f"![MTF of {title} over the field]({name}-mtf.svg)\n",
        "Focused at infinity. [The page on analysis](../docs/analysis.md) has more plots.\n",
        "## Prescription\n",
        "The last thickness is the distance to the film. A positive radius has its centre on the film's side.\n",
        *prescription(lens),
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
            figures = (
                f"{number(data.effective_focal_length_mm, 3)} mm, f/{number(data.f_number, 3)}, {angles[name]:.0f}°"
            )
            lines.append(f"- [![]({name}.jpg) {lenses[name].title or name}]({name}.md) {figures}")
        lines.append("```\n")
    return "\n".join([*lines, "```{toctree}\n:hidden:\n", *lenses, "```"]) + "\n"


def write(folder: Path, names: Sequence[str] | None = None) -> None:
    """Writes what is missing or older than its sources, with index.md as the first page. names: None is all lenses."""
    folder.mkdir(parents=True, exist_ok=True)
    shot = rc.Shot.load(lens_pictures.SHOT)
    lenses = {name: rc.Lens.load(name) for name in names or rc.lens_names()}
    for name, lens in lenses.items():
        file = ROOT / "lenses" / f"{name}.toml"
        photograph, drawing, mtf = (folder / f"{name}{end}" for end in (".jpg", ".svg", "-mtf.svg"))
        if not all(is_newer(made, (Path(lens_pictures.__file__), file)) for made in (photograph, drawing, mtf)):
            save_cross_section(lens, drawing, width_px=1000)
            lens_pictures.save_mtf(lens, mtf)
            lens_pictures.save_photograph(lens, shot, photograph)
        if not is_newer(folder / f"{name}.md", (Path(__file__), file)):
            (folder / f"{name}.md").write_text(page_of(lens, name), encoding="utf-8")
    remove_others(folder, {"index", *lenses})
    write_text(folder / "index.md", index_of(lenses))
