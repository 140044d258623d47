"""Results of against_mitsuba_cpu.py as JSON, Markdown and a plot."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np

CAMERAS = {"pinhole": "pinhole", "thin": "thin lens", "full": "double Gauss, every surface"}
ERROR_GOALS = (0.03, 0.01, 0.003)


def stem(record: dict) -> str:
    """File name without suffix for a record of results."""
    processor = re.sub(r"\((R|TM)\)", "", record["machine"]["processor"])
    name = re.sub(r"[^a-z0-9]+", "-", processor.lower()).strip("-")
    return f"{name}-{record['threads']}-threads-against-mitsuba"


def seconds_to_error(points: list[dict], error: float) -> float | None:
    """CPU seconds to a relative mean square error, interpolated by a power law; None outside the measured errors."""
    errors = [point["relative_mse"] for point in points]
    if not min(errors) <= error <= max(errors):
        return None
    # Reversed, because errors decrease with the number of samples and np.interp needs increasing ones.
    log_errors, log_seconds = np.log(errors)[::-1], np.log([point["cpu_seconds"] for point in points])[::-1]
    return float(np.exp(np.interp(np.log(error), log_errors, log_seconds)))


def same_work_table(record: dict) -> list[str]:
    """Lines of the table of times for the same work."""
    lines = ["| camera | realcam, CPU s | Mitsuba, CPU s | pictures differ by |", "|---|---|---|---|"]
    for model, row in record["same_work"].items():
        lines.append(
            f"| {CAMERAS[model]} | {row['realcam_cpu_seconds']:.2f} | {row['mitsuba_cpu_seconds']:.2f} "
            f"| {abs(row['difference_of_means']):.2%} |"
        )
    return lines


def error_tables(programs: dict[str, list[dict]]) -> list[str]:
    """Lines of the tables of errors by sample count, and of times to errors."""
    counts = [point["spp"] for point in programs["realcam"]]
    lines = [
        "| relative MSE (after CPU s) | " + " | ".join(f"{spp} samples" for spp in counts) + " |",
        "|---" * (len(counts) + 1) + "|",
    ]
    for name, points in programs.items():
        cells = (f"{point['relative_mse']:.2g} ({point['cpu_seconds']:.2f})" for point in points)
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    lines += ["", "| CPU s to a relative MSE of | " + " | ".join(map(str, ERROR_GOALS)) + " |"]
    lines.append("|---" * (len(ERROR_GOALS) + 1) + "|")
    for name, points in programs.items():
        reached = (seconds_to_error(points, error) for error in ERROR_GOALS)
        cells = ("not measured" if seconds is None else f"{seconds:.2f}" for seconds in reached)
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def markdown(record: dict, plot: str) -> str:
    """The report. plot: file name of the plot."""
    machine, errors = record["machine"], record["error_over_time"]
    reference_spp = errors["thin"]["reference_spp"]
    last_points = [points[-1] for by_program in errors.values() for points in by_program["programs"].values()]
    farthest = max(abs(point["relative_mse"] - point["relative_variance"]) for point in last_points)
    lines = [
        f"{machine['processor']}, {record['threads']} threads; realcam {machine['commit']}, {machine['devices'][0]}; "
        f"Mitsuba {record['mitsuba']}; {machine['date']}. Made by benchmarks/against_mitsuba_cpu.py.",
        "",
        f"The same work: {record['triangles']} triangles, one area light and a sky, 640 x 640 x {record['spp']} "
        "samples of a camera ray and two shadow rays. Mitsuba uses `direct` with two emitter samples and none of the "
        "BSDF, and has the double Gauss as a sensor in Python. Least of 4 rounds in turns, without compilation:",
        "",
        *same_work_table(record),
        "",
        "Error over time: the same scene; each of Mitsuba's integrators with its best sampler (multijitter; ldsampler "
        "for two emitter samples).",
    ]
    for model, by_program in errors.items():
        lines += ["", f"Through the {CAMERAS[model]}:", "", *error_tables(by_program["programs"])]
    lines += [
        "",
        f"![Relative mean square error over CPU seconds]({plot})",
        "",
        "Squared differences are relative to the reference's square plus (1% of its mean)^2. The reference is realcam's"
        f" picture of {reference_spp} samples. The variance of each program's pictures among themselves, "
        f"which needs no reference, is the same as its error to {farthest:.1g} at the most samples.",
    ]
    return "\n".join(lines) + "\n"


def plot_errors(record: dict, path: Path) -> None:
    """Plots errors over CPU seconds, one axes for each camera."""
    import matplotlib.pyplot as plt

    errors = record["error_over_time"]
    figure, all_axes = plt.subplots(1, len(errors), figsize=(10, 4), sharey=True, layout="constrained")
    for axes, (model, by_program) in zip(all_axes, errors.items(), strict=True):
        for name, points in by_program["programs"].items():
            x, y = ([point[key] for point in points] for key in ("cpu_seconds", "relative_mse"))
            axes.loglog(x, y, "o-" if name == "realcam" else "s--", label=name)
        axes.set(xlabel="CPU seconds", title=f"Direct light: {CAMERAS[model]}")
        axes.grid(True, which="both", alpha=0.3)
    all_axes[0].set(ylabel="relative mean square error")
    all_axes[0].legend()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def write_report(record: dict, folder: Path) -> None:
    """Writes the files of a record into a folder, and prints the report."""
    folder.mkdir(parents=True, exist_ok=True)
    base = folder / stem(record)
    text = markdown(record, f"{base.name}.png")
    plot_errors(record, base.with_suffix(".png"))
    base.with_suffix(".json").write_text(json.dumps(record, indent=2) + "\n")
    base.with_suffix(".md").write_text(text)
    print(text)
