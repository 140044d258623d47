"""realcam demo: the first picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .._core import Camera, InputError
from ..progress import progress_bar
from ..render import render
from ..shot import read_shot
from ..summary import summary
from . import options


def demo(
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the pictures; made where it is missing.")
    ] = Path("realcam-demo"),
    spp: Annotated[int, typer.Option(help="Samples per pixel.", min=1, max=2**24)] = 48,
) -> None:
    """Photograph the demo scene through a double Gauss, and once more through an ideal thin lens."""
    from ..draw import save_cross_section  # brings matplotlib, which other commands need not load

    shot = read_shot(_scenes_folder() / "demo.toml")
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{output}: the folder cannot be made: {error.strerror}") from None
    camera = shot.camera
    with options.stoppable():
        with progress_bar("photographing") as bar:
            image = render(shot.scene, camera, spp=spp, progress=bar)
        image.save(output / "demo.png")
        image.save(output / "demo.exr")
        with progress_bar("thin lens, for comparison") as bar:
            ideal = render(shot.scene, _as_thin_lens(camera), spp=max(1, spp // 4), progress=bar)
        ideal.save(output / "demo-thin-lens.png")
        save_cross_section(camera.lens, output / "lens.png")
    typer.echo(summary(image))
    for name, what in (
        ("demo.png", "the photograph"),
        ("demo.exr", "its film exposure in lux seconds, and depth"),
        ("demo-thin-lens.png", "the same through an ideal lens: no vignetting, no aberrations"),
        ("lens.png", "the lens and its rays"),
    ):
        typer.echo(f"{'picture':<11}{output / name}: {what}")


def _as_thin_lens(camera: Camera) -> Camera:
    return Camera(
        camera.lens,
        film=camera.film,
        position=camera.position,
        look_at=camera.look_at,
        up=camera.up,
        exposure_time_s=camera.exposure_time_s,
        iso=camera.iso,
        model="thin",
    )


def _scenes_folder() -> Path:
    """Beside the package where it is installed, in the repository where it is not."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "scenes", package.parents[1] / "scenes"):
        if (folder / "demo.toml").is_file():
            return folder
    raise InputError("the demo scene is missing from this installation")
