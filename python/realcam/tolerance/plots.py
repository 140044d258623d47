"""Plots of a tolerance study: yield, distributions of measures, and worst offenders."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..analysis import style
from .sensitivities import Sensitivity
from .study import ToleranceStudy

#: Labels of the measures of ToleranceStudy.measure.
MEASURES = {
    "mtf": "mean MTF",
    "lowest_mtf": "MTF of the worst field",
    "spot_mm": "largest RMS spot / mm",
    "focal_length_mm": "focal length / mm",
    "distortion": "largest distortion / %",
}


def plot_yield(study: ToleranceStudy, axes: Axes) -> None:
    """Plots the fraction of copies that reach an MTF or more, for the mean MTF and for the worst field."""
    share = 100 * (np.arange(len(study)) + 1) / len(study)
    for index, name in enumerate(("mtf", "lowest_mtf")):
        colour = style.field_colour(index)
        axes.plot(np.sort(study.measure(name))[::-1], share, color=colour, label=MEASURES[name])
        axes.axvline(study.nominal_measure(name), color=colour, linestyle=":", linewidth=0.9)
    axes.set_ylim(0, 102)
    axes.set_xlabel(f"MTF at {study.frequencies_per_mm[study.middle_frequency]:.4g}/mm (dotted: nominal)")
    axes.set_ylabel("copies at least as good / %")
    axes.set_title("Yield")
    axes.legend()


def plot_distribution(study: ToleranceStudy, name: str, axes: Axes) -> None:
    """Plots a histogram of a measure and marks its nominal value."""
    scale = 100 if name == "distortion" else 1
    values = scale * study.measure(name)
    axes.hist(values[np.isfinite(values)], bins=min(40, max(5, len(study) // 12)), color=style.BLUE)
    axes.axvline(scale * study.nominal_measure(name), color=style.text_colour(), linestyle=":", label="nominal")
    axes.set_xlabel(MEASURES[name])
    axes.set_ylabel("copies")
    axes.set_title(MEASURES[name].split(" /")[0])
    axes.legend()


def plot_fields(study: ToleranceStudy, axes: Axes) -> None:
    """Plots for each field the interquartile and the 5 to 95 % range of the MTF over the copies."""
    values = np.nan_to_num(study.figures.mtf[..., study.middle_frequency]).mean(2)
    positions = np.arange(values.shape[1])
    low, quarter, middle, three, high = np.quantile(values, [0.05, 0.25, 0.5, 0.75, 0.95], axis=0)
    axes.vlines(positions, low, high, color=style.BLUE, linewidth=1)
    axes.vlines(positions, quarter, three, color=style.BLUE, linewidth=5)
    axes.plot(positions, middle, "_", color=style.text_colour(), markersize=9, label="median")
    axes.plot(
        positions,
        np.nan_to_num(study.nominal.mtf[0, ..., study.middle_frequency]).mean(1),
        "x",
        color=style.RED,
        label="nominal",
    )
    axes.set_xticks(positions, [f"{x:.3g}°, {y:.3g}°" for x, y in study.fields_deg])
    axes.set_xlim(-0.5, len(positions) - 0.5)
    axes.set_ylim(0, None)
    axes.set_ylabel(f"MTF at {study.frequencies_per_mm[study.middle_frequency]:.4g}/mm")
    axes.set_title("Fields (x, y)")
    axes.legend()


def plot_offenders(offenders: list[Sensitivity], axes: Axes) -> None:
    """Plots the loss of mean MTF of each tolerance at its worse limit, the worst offender at the top."""
    positions = np.arange(len(offenders))[::-1]
    axes.barh(positions, [offender.loss for offender in offenders], color=style.RED, height=0.65)
    axes.set_yticks(positions, [with_limit(offender) for offender in offenders])
    axes.axvline(0, color=style.GREY, linewidth=0.6)
    axes.set_xlabel("loss of mean MTF")
    axes.set_title("Worst offenders")
    axes.grid(visible=False, axis="y")


def with_limit(offender: Sensitivity) -> str:
    """Label of a tolerance with its limit."""
    t = offender.tolerance
    return f"{t.label}, ±{t.limit:.3g}{'' if t.unit in ('', chr(39), '%') else ' '}{t.unit}"


def study_figure(study: ToleranceStudy, offenders: list[Sensitivity]) -> Figure:
    """Combines all plots of the study in one figure, in the current theme."""
    figure = style.new_figure(8.2, 9.4)
    rows = figure.add_gridspec(3, 2)
    plot_yield(study, figure.add_subplot(rows[0, 0]))
    plot_fields(study, figure.add_subplot(rows[0, 1]))
    plot_offenders(offenders, figure.add_subplot(rows[1, :]))
    for column, name in enumerate(("spot_mm", "focal_length_mm")):
        plot_distribution(study, name, figure.add_subplot(rows[2, column]))
    return figure
