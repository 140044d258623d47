"""Tables of the commands `realcam lens photo` and `realcam lens compare`."""

from __future__ import annotations

import math

import typer

from .._core import FieldOfView
from ..number_text import number_text
from ..photography import DepthOfField, LensSummary, PhotographicFigures, SharpRange

Rows = list[tuple[str, str]]


def photo_rows(figures: PhotographicFigures) -> Rows:
    """Returns the rows, (name, value), of the table that `lens photo` prints."""
    f, dof, breath = figures, figures.depth_of_field, figures.breathing
    formula, real = "  by formula", "  by real rays"
    rows: Rows = [
        ("focus", _metres(f.focus_distance_m)),
        ("focal length", _focal_length(f)),
        ("f-number", f"f/{number_text(f.f_number, 3)}"),
        ("T-stop", f"T/{number_text(f.t_stop, 3)}"),
        (
            "working f-number",
            f"f/{number_text(f.working_f_number, 3)}; N (1 + m / p) is "
            f"f/{number_text(f.working_f_number_by_formula, 3)}",
        ),
        ("magnification", _magnification(f.magnification)),
        ("angle of view", "horizontal, vertical, diagonal"),
        (real, _angles(f.angle_of_view_deg)),
        (formula, _angles(f.angle_of_view_by_formula_deg)),
    ]
    if breath is not None:
        assumed = " (assumed: magnification 1/10)" if breath.is_assumed else ""
        rows += [
            ("breathing", f"{breath.change_percent:+.2f}% in the diagonal angle of view, from infinity to "
                          f"{_metres(breath.nearest_focus_m)}{assumed}"),
        ]  # fmt: skip
    rows += [
        ("depth of field", f"for a blur of {number_text(1000 * dof.circle_of_confusion_mm)} um"),
        (real, _range(dof)),
        (formula, _sharp(dof.formula)),
        ("  2 N c (m + 1) / m^2", _metres(dof.approximate_depth_m)),
        ("hyperfocal distance", ""),
        (real, _metres(dof.real_hyperfocal_m)),
        (formula, _metres(dof.formula_hyperfocal_m)),
        ("blur in focus", f"{number_text(1000 * dof.blur_in_focus_mm, 3)} um, by aberrations"),
    ]
    if f.exposure is not None:
        e = f.exposure
        rows += [
            (
                "exposure value",
                f"EV {e.ev:.2f} at {number_text(e.exposure_time_s)} s; for light of EV100 {e.ev100:.2f}",
            ),
            ("  by T-stop", f"for light of EV100 {e.ev100_at_film:.2f}, with the lens's losses and extension"),
        ]
    return rows


def summary_rows(summary: LensSummary) -> Rows:
    """Returns the rows, (name, value), of a lens in the table of `lens compare`; all lenses have the same names."""
    f, dof = summary.figures, summary.figures.depth_of_field
    rows: Rows = [
        ("focus", _metres(f.focus_distance_m)),
        ("focal length", _focal_length(f)),
        ("f-number, T-stop", f"f/{number_text(f.f_number, 3)}, T/{number_text(f.t_stop, 3)}"),
        ("working f-number", f"f/{number_text(f.working_f_number, 3)}"),
        ("film", f"{summary.lens.film_mm[0]:g} x {summary.lens.film_mm[1]:g} mm"),
        ("elements, front to film", f"{summary.element_count}, {number_text(summary.length_mm)} mm"),
        ("angle of view h, v, d", _angles(f.angle_of_view_deg)),
        ("breathing", "none known" if f.breathing is None else f"{f.breathing.change_percent:+.2f}%"),
        ("circle of confusion", f"{number_text(1000 * dof.circle_of_confusion_mm)} um"),
        ("depth of field, rays", _range(dof)),
        ("depth of field, formula", _sharp(dof.formula)),
        ("hyperfocal, rays", _metres(dof.real_hyperfocal_m)),
        ("hyperfocal, formula", _metres(dof.formula_hyperfocal_m)),
    ]
    for figures in summary.fields:
        share, angle_deg = figures.field.share, figures.field.angle_deg
        where = f"{number_text(angle_deg, 3)}°" if share is None else f"{share:g}"
        rows.append(
            (
                f"RMS spot at {where}, {summary.lens.wavelength_nm:.0f} nm",
                f"{number_text(figures.rms_spot_radius_um, 3)} um ({number_text(figures.field.film_height_mm, 3)} mm)",
            )
        )
        if figures.mtf_tangential is None or figures.mtf_sagittal is None:
            continue
        for k, frequency in enumerate(summary.mtf_frequencies_per_mm):
            both = f"{figures.mtf_tangential[k]:.2f} tangential, {figures.mtf_sagittal[k]:.2f} sagittal"
            rows.append((f"  MTF at {frequency:g}/mm", both))
    return rows


def print_columns(titles: list[str], rows: list[Rows]) -> None:
    """Prints tables side by side, whose rows have the same names. titles: heading of each table's column of values."""
    names = [name for name, _ in rows[0]]
    columns = [[title, *(value for _, value in column)] for title, column in zip(titles, rows, strict=True)]
    widths = [max(map(len, ["", *names])), *(max(map(len, column)) for column in columns)]
    for line in zip(["", *names], *columns, strict=True):
        typer.echo("  ".join(f"{text:{width}}" for text, width in zip(line, widths, strict=True)).rstrip())


def _focal_length(figures: PhotographicFigures) -> str:
    here, far = figures.focal_length_mm, figures.focal_length_at_infinity_mm
    text, text_here = number_text(far), number_text(here)
    return f"{text} mm" if text_here == text else f"{text} mm; {text_here} mm as focused"


def _metres(value: float) -> str:
    """Formats a length in metres; nan means that there is none."""
    if math.isnan(value):
        return "none"
    return number_text(value) + (" m" if math.isfinite(value) else "")


def _range(dof: DepthOfField) -> str:
    if math.isnan(dof.real.near_m):
        return f"nothing is sharp: {number_text(1000 * dof.blur_in_focus_mm, 3)} um in focus"
    return _sharp(dof.real)


def _sharp(sharp: SharpRange) -> str:
    return f"{_metres(sharp.near_m)} to {_metres(sharp.far_m)}, {_metres(sharp.depth_m)}"


def _angles(angles: FieldOfView) -> str:
    return ", ".join(map(number_text, angles)) + " deg"


def _magnification(m: float) -> str:
    return "0" if m == 0 else f"{number_text(m)} (1:{number_text(1 / m, 3)})"
