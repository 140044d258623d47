"""realcam render: photograph a scene."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any, Optional

import typer

from .. import _core, image_file
from .._core import Camera, Film, InputError, Scene
from ..progress import progress_bar
from ..render import render as take_picture
from ..summary import summary
from . import options

CAMERA, SCENE, PICTURE = "Camera", "Scene", "Picture"


def say(text: str) -> None:
    """A remark for the person at the terminal; stdout is for results."""
    print(f"realcam: {text}", file=sys.stderr)


def render(
    scene: Annotated[str, typer.Argument(help="The scene: .obj (with .mtl), .gltf, .glb or .ply.", metavar="SCENE")],
    output: Annotated[
        list[Path], typer.Option("--output", "-o", help="Picture to write, .png or .exr; may be repeated.")
    ],
    lens: Annotated[
        str, typer.Option(help="Bundled lens (`realcam lens list`) or .toml file.", rich_help_panel=CAMERA)
    ] = "double-gauss-50mm",
    film: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(help="Film in mm, WxH [the lens's, in the shape of the resolution].", rich_help_panel=CAMERA),
    ] = None,
    resolution: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(help="Pixels, WxH [960 along the longer side].", rich_help_panel=CAMERA),
    ] = None,
    position: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(
            help="Middle of the film, metres, X,Y,Z [in front of look-at along +z, the scene fills the film].",
            rich_help_panel=CAMERA,
        ),
    ] = None,
    look_at: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(help="Point in the middle of the picture, X,Y,Z [middle of the scene].", rich_help_panel=CAMERA),
    ] = None,
    up: Annotated[str, typer.Option(help="Direction that is up in the picture.", rich_help_panel=CAMERA)] = "0,1,0",
    focus: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(
            help="Object plane to film in metres, or inf [the first surface on the axis].",
            rich_help_panel=CAMERA,
        ),
    ] = None,
    f_number: Annotated[
        Optional[float],  # noqa: UP045
        typer.Option("--f-number", help="Close the diaphragm to f/N [wide open].", rich_help_panel=CAMERA),
    ] = None,
    exposure_time: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(
            help="Seconds, such as 1/125 [metered: the average lands on middle grey].", rich_help_panel=CAMERA
        ),
    ] = None,
    iso: Annotated[float, typer.Option(help="Sensitivity.", rich_help_panel=CAMERA)] = 100,
    model: Annotated[str, typer.Option(help="full, thick, thin or pinhole.", rich_help_panel=CAMERA)] = "full",
    scale: Annotated[float, typer.Option(help="Metres per unit of the scene's file.", rich_help_panel=SCENE)] = 1,
    environment: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(
            help="Light all around: cd/m^2, or a latitude-longitude picture [the scene's; daylight if none].",
            rich_help_panel=SCENE,
        ),
    ] = None,
    spp: Annotated[int, typer.Option(help="Samples per pixel.", min=1, max=2**24, rich_help_panel=PICTURE)] = 64,
    seed: Annotated[
        int, typer.Option(help="Of the random numbers.", min=0, max=2**32 - 1, rich_help_panel=PICTURE)
    ] = 0,
    max_bounces: Annotated[
        int,
        typer.Option(
            help="Light that bounces this often is seen; 0: direct light only.", min=0, max=64, rich_help_panel=PICTURE
        ),
    ] = 1,
    tone: Annotated[
        str, typer.Option(help="Of .png: film (soft highlights) or linear.", rich_help_panel=PICTURE)
    ] = "film",
    threads: Annotated[int, typer.Option(help="0: all.", min=0, max=4096, rich_help_panel=PICTURE)] = 0,
    device: Annotated[
        str, typer.Option(help="auto (a GPU if there is one), cpu, cuda, or cuda:1.", rich_help_panel=PICTURE)
    ] = "auto",
) -> None:
    """Photograph a scene through a lens."""
    for path in output:
        image_file.check_writable(path)
    _core.develop([0.0], iso, tone)  # a misspelt tone curve is told now, not after the picture
    camera = _unplaced_camera(lens, film, resolution, f_number, iso, model)
    if exposure_time is not None:
        camera = _with_time(camera, options.number(exposure_time, "--exposure-time"))
    view: dict[str, Any] = {
        "position": None if position is None else options.numbers(position, ",", 3, "--position"),
        "look_at": None if look_at is None else options.numbers(look_at, ",", 3, "--look-at"),
        "up": options.numbers(up, ",", 3, "--up"),
        "focus_distance_m": None if focus is None else options.number(focus, "--focus"),
    }
    loaded = _load(scene, scale, environment)
    with options.stoppable():
        camera = camera.framing(loaded, **view)
        if environment is None and not loaded.has_light:
            loaded = loaded.with_daylight(camera)
            say(
                "the scene holds no light; it gets daylight: a sun of 80 klux from the upper left, a sky of 5000 cd/m^2"
            )
        if exposure_time is None:
            camera = camera.metered(loaded, device=device, max_bounces=max_bounces)
            say("no exposure time is given; the average of the picture is brought to middle grey")
        with progress_bar("photographing") as bar:
            image = take_picture(
                loaded,
                camera,
                spp=spp,
                device=device,
                seed=seed,
                max_bounces=max_bounces,
                threads=threads,
                progress=bar,
            )
        for path in output:
            image.save(path, tone)
    typer.echo(summary(image))
    for path in output:
        typer.echo(f"{'picture':<11}{path}")


def _unplaced_camera(
    name: str, film: str | None, resolution: str | None, f_number: float | None, iso: float, model: str
) -> Camera:
    lens = options.lens(name, None, f_number)
    size = None if film is None else options.numbers(film, "x", 2, "--film")
    pixels = None if resolution is None else options.numbers(resolution, "x", 2, "--resolution")
    if pixels is not None and not all(p.is_integer() for p in pixels):
        raise InputError(f'--resolution is "{resolution}"; whole numbers of pixels are wanted')
    chosen = Film.for_lens(lens, size, None if pixels is None else tuple(int(p) for p in pixels))
    return Camera(lens, film=chosen, iso=iso, model=model)


def _with_time(camera: Camera, seconds: float) -> Camera:
    return Camera(camera.lens, film=camera.film, iso=camera.iso, model=camera.model, exposure_time_s=seconds)


def _load(path: str, scale: float, environment: str | None) -> Scene:
    scene = Scene.load(path, scale=scale)
    for warning in scene.warnings:
        say(f"warning: {warning}")
    if environment is None:
        return scene
    try:
        return scene.with_environment(options.number(environment, "--environment"))
    except InputError:
        if not Path(environment).exists():
            raise InputError(f'--environment is "{environment}"; cd/m^2 or a picture is wanted') from None
    return scene.with_environment(image_file.read_environment(environment))
