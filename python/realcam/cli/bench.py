"""realcam bench: measure this machine."""

from __future__ import annotations

import json
from typing import Annotated, Optional

import typer
from rich.console import Console

from .._core import devices
from .options import check_known


def bench(
    names: Annotated[
        Optional[list[str]],  # noqa: UP045
        typer.Argument(
            help="lens-rays, lens-setup, pass-share, camera-models, frame, sensor; gpu-lens-rays, gpu-hits, gpu-paths, "
            "gpu-frames, gpu-objects [all].",
            metavar="BENCHMARK",
            show_default=False,
        ),
    ] = None,
    threads: Annotated[int, typer.Option(metavar="N", help="0: all.", min=0, max=4096)] = 0,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON, with machine and commit.")] = False,
) -> None:
    """Measure rays through the lens, pupil set-up, sampling efficiency, a frame and a sensor on this machine."""
    from ..bench import BENCHMARKS, GPU_BENCHMARKS, machine

    has_gpu = any(line.startswith("cuda") for line in devices())
    wanted = names or [name for name in BENCHMARKS if has_gpu or name not in GPU_BENCHMARKS]
    for name in wanted:
        check_known(name, BENCHMARKS, "benchmark")
    results: dict[str, object] = {}
    status = Console(stderr=True)
    for name in wanted:
        with status.status(f"measuring {name}"):
            results[name] = BENCHMARKS[name](threads)
        if not as_json:
            _print(name, results[name], BENCHMARKS[name].__doc__ or "")
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
