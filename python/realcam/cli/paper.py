"""realcam paper: the source paper's experiments again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Optional

import typer

from .options import check_known


def paper(
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="The page, .html.")] = Path(
        "paper.html"
    ),
    device: Annotated[
        str, typer.Option(metavar="DEVICE", help="auto (a GPU if there is one), cpu, cuda, or cuda:1.")
    ] = "auto",
    only: Annotated[
        Optional[list[str]],  # noqa: UP045
        typer.Option(
            "--only",
            metavar="NAME",
            help="One experiment by its name, as the page's sections have it; may be repeated.",
        ),
    ] = None,
) -> None:
    """Do the experiments of Liu and Hsu (2013) again and write them on a page, figure by figure."""
    from ..paper import EXPERIMENTS, save_page  # brings matplotlib, which other commands need not load

    for name in only or ():
        check_known(name, EXPERIMENTS, "experiment")
    save_page(output, device=device, only=only or (), progress=lambda name: typer.echo(name, err=True))
    typer.echo(f"wrote {output}")
