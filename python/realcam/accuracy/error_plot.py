"""Error over time, in one plot for each group of levels."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import SubFigure
from matplotlib.ticker import LogLocator

from ..analysis import style
from ..analysis.fields import Doubles
from .measurements import LevelMeasurements

# Ratio of the longest time to which the lines are extrapolated to the longest measured time.
EXTRAPOLATION = 16.0


def draw_errors(figure: SubFigure, levels: tuple[LevelMeasurements, ...]) -> None:
    """Draws one plot per group of levels. The recommended level is in every plot, for comparison."""
    groups = list(dict.fromkeys(level.group for level in levels))
    rows = 2 if len(groups) > 3 else 1
    grid = figure.subplots(rows, -(-len(groups) // rows), sharex=True, sharey=True, squeeze=False)
    end = EXTRAPOLATION * max(level.pictures[-1].seconds for level in levels)
    for cell in grid.ravel()[len(groups) :]:
        cell.set_axis_off()
    plots = [
        (axes, group, [level for level in levels if level.group == group or level.is_recommended])
        for axes, group in zip(grid.ravel(), groups, strict=False)
    ]
    for axes, group, shown in plots:
        _draw_frontier(axes, levels)
        for number, level in enumerate(shown):
            _draw_line(axes, level, _colour(level, number), end)
        axes.set(xscale="log", yscale="log", title=group)
        style.plain_decades(axes.yaxis)
        style.plain_decades(axes.xaxis)
        axes.xaxis.set_major_locator(LogLocator())
    for axes in grid[-1]:
        axes.set_xlabel("seconds of samples")
    for axes in grid[:, 0]:
        axes.set_ylabel("error / codes")
    grid[0, 0].set_xlim(right=end)
    grid[0, 0].plot([], [], ":", color=style.GREY, label="continued, as noise falls and bias stays")
    grid[0, 0].legend(loc="lower left")
    # Last, because the positions of names depend on the axis limits, which all plots share.
    for axes, _, shown in plots:
        _name_lines(axes, shown, end)


def recommendation(levels: tuple[LevelMeasurements, ...], reason: str) -> str:
    """Returns a text on the recommended level, with the reason for it and the errors of all groups.

    The text is empty if the level was not measured.
    """
    best = next((level for level in levels if level.is_recommended), None)
    if best is None:
        return ""
    end = EXTRAPOLATION * max(level.pictures[-1].seconds for level in levels)
    least: dict[str, float] = {}
    for level in levels:
        if level is not best:
            least[level.group] = min(least.get(level.group, np.inf), level.error_after(end))
    others = ", ".join(f"{error:.2g} ({group})" for group, error in least.items())
    return (
        f"Recommended: {best.name}. {reason}.\n"
        f"After {end:.2g} s its error is {best.error_after(end):.2g} codes, that of the others at least {others}"
    )


def _colour(level: LevelMeasurements, number: int) -> str:
    return style.text_colour() if level.is_recommended else style.field_colour(number)


def _draw_line(axes: Axes, level: LevelMeasurements, colour: str, end: float) -> None:
    seconds, errors = zip(*((picture.seconds, picture.rmse) for picture in level.pictures), strict=True)
    width = 2.5 if level.is_recommended else 1.2
    axes.plot(seconds, errors, marker="o", color=colour, markersize=2 + width, linewidth=width)
    later = np.geomspace(seconds[-1], end, 50)
    axes.plot(later, [level.error_after(time) for time in later], ":", color=colour, linewidth=width)


def _name_lines(axes: Axes, levels: list[LevelMeasurements], end: float) -> None:
    """Writes the names to the right of the axes, at the height of the lines' ends, without overlap."""
    low, high = axes.get_ylim()
    heights = np.log([level.error_after(end) / low for level in levels]) / np.log(high / low)
    order = np.argsort(heights)
    positions = _spread(heights[order], 0.13)
    for position, number in zip(positions, order, strict=True):
        level = levels[number]
        axes.annotate(
            textwrap.fill(level.name, 20),
            (1, heights[number]),
            (1.03, position),
            xycoords="axes fraction",
            textcoords="axes fraction",
            va="center",
            color=_colour(level, int(number)),
            weight="bold" if level.is_recommended else "normal",
            fontsize=7,
            linespacing=0.9,
            arrowprops={"arrowstyle": "-", "linewidth": 0.4, "color": style.GREY, "relpos": (0, 0.5), "shrinkB": 0},
        )


def _spread(positions: Doubles, min_distance: float) -> Doubles:
    """Moves sorted positions apart to at least a minimum distance, in one upward and one downward pass."""
    moved: Doubles = positions.copy()
    for k in range(1, len(moved)):
        moved[k] = max(moved[k], moved[k - 1] + min_distance)
    moved[-1] = min(moved[-1], max(1.0, positions[-1]))
    for k in range(len(moved) - 2, -1, -1):
        moved[k] = min(moved[k], moved[k + 1] - min_distance)
    return moved


def _draw_frontier(axes: Axes, levels: tuple[LevelMeasurements, ...]) -> None:
    """Draws the smallest error that any level has reached by each time."""
    lines = [np.log([(p.seconds, p.rmse) for p in level.pictures]).T for level in levels]
    times = np.linspace(min(line[0, 0] for line in lines), max(line[0, -1] for line in lines), 400)
    errors = [np.interp(times, line[0], line[1], left=np.inf) for line in lines]
    best = np.minimum.accumulate(np.min(errors, axis=0))
    axes.plot(np.exp(times), np.exp(best), color=style.GREY, linewidth=6, alpha=0.25, zorder=0, label="the best of all")
