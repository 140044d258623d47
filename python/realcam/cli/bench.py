"""The command `realcam bench`: runs benchmarks on this machine. They are in benchmarks/ of the source repository."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from .._core import InputError, devices
from .options import Threads, known_word


def bench(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            help="lens-rays, lens-setup, pass-share, camera-models, frame, sensor; gpu-lens-rays, gpu-hits, gpu-paths, "
            "gpu-frames, gpu-objects [all]",
            metavar="BENCHMARK",
            show_default=False,
        ),
    ] = None,
    threads: Threads = 0,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, with machine and commit")] = False,
) -> None:
    """Measure rays through the lens, pupil set-up, sampling efficiency, a frame and a sensor on this machine."""
    folder = Path(__file__).resolve().parents[3] / "benchmarks"
    if not (folder / "cpu_benchmarks.py").is_file():
        raise InputError("the benchmarks are in the source repository, where ./run bench starts them")
    sys.path.insert(0, str(folder))
    from cpu_benchmarks import CPU_BENCHMARKS
    from gpu_benchmarks import GPU_BENCHMARKS
    from machine import machine

    benchmarks = CPU_BENCHMARKS | GPU_BENCHMARKS
    has_gpu = any(device.name.startswith("cuda") for device in devices())
    selected = names or list(benchmarks if has_gpu else CPU_BENCHMARKS)
    selected = [known_word(name, benchmarks, "benchmark") for name in selected]
    results: dict[str, object] = {}
    status = Console(stderr=True)
    for name in selected:
        with status.status(f"measuring {name}"):
            results[name] = benchmarks[name](threads)
        if not as_json:
            _print(name, results[name], benchmarks[name].__doc__ or "")
    if as_json:
        typer.echo(json.dumps({"machine": machine(), "threads": threads, "results": results}, indent=2))


def _print(name: str, result: object, description: str) -> None:
    typer.echo(f"{name}: {description}")
    for key, value in (result if isinstance(result, dict) else {}).items():
        if isinstance(value, dict):
            for inner, figure in value.items():
                text = ", ".join(f"{k} {v}" for k, v in figure.items()) if isinstance(figure, dict) else figure
                typer.echo(f"  {key} {inner}: {text}")
        else:
            typer.echo(f"  {key}: {value}")
