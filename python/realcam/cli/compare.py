"""The command `realcam compare`: a shot at several apertures, with several lenses or at several zoom positions."""

from __future__ import annotations

import signal
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import Annotated

import typer

from .._core import Camera, Cancelled, InputError
from ..denoiser import GUIDES
from ..image import Image
from ..json_values import json_text
from ..number_text import counted, number_text
from ..progress import progress_bar
from ..shot import Shot, shot_with_words
from . import lens_options, options
from .command_words import plain_number
from .grouped_options import grouped
from .shot_options import shot_options, words_of
from .variations import Variation, variations

ShotOptions = shot_options(without=("resolution", "layers"))


@grouped
def compare(
    shot: options.ShotName,
    vary: Annotated[
        str,
        typer.Option(
            metavar="NAME=VALUE,...", help="What varies: f_number=2,4,8, lens=NAME,... (or files), or zoom=POSITION,..."
        ),
    ],
    output: Annotated[Path, options.output("The sheet, as .png, .jpg, .tif, .webp, .svg or .pdf")],
    changes: ShotOptions,  # type: ignore[valid-type]
    size: Annotated[
        int, typer.Option(metavar="PIXELS", help="Size of the longer side of each picture in pixels", min=8, max=4096)
    ] = 480,
    columns: Annotated[int, typer.Option(metavar="N", help="Number of pictures in a row", min=1, max=100)] = 3,
    denoise: Annotated[bool, typer.Option("--denoise", help="Denoise the pictures (realcam[denoise])")] = False,
    theme: lens_options.ThemeName = "light",
    device: options.Device = "auto",
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Take a shot several times with the same framing, brightness and noise, and put the pictures on one sheet.

    All pictures have the brightness of the shot, also with --f-number.
    """
    from ..drawing.figure_files import check_figure_target
    from ..drawing.themes import theme_named
    from .sheet import save_sheet  # brings matplotlib, which other commands need not load

    check_figure_target(output)
    theme_named(theme)
    name, equals, values = vary.partition("=")
    if not equals or not all(values.split(",")):
        raise InputError(f'--vary: "{vary:.60}": expected NAME=VALUE,..., such as f_number=2,4,8')
    name = name.replace("-", "_")
    words = words_of(changes)
    f_number = words.pop("f_number", None)
    if f_number is not None and name == "f_number":
        raise InputError("--f-number cannot be combined with --vary f_number")
    base_shot = shot_with_words(shot, words, device)
    if f_number is not None:
        base_shot = variations(base_shot, "f_number", [f_number])[0].shot
    settings = base_shot.settings.with_(layers=GUIDES) if denoise else base_shot.settings
    pictures: list[tuple[str, Image]] = []
    kind = "F_NUMBER" if name == "f_number" else ""
    varied = variations(base_shot, name, [plain_number(value, kind) for value in values.split(",")])
    check_figure_target(output)  # again: the input files, which must not be overwritten, are known only now
    with interrupt_noted() as is_interrupted:
        for variation in varied:
            suppressed_warning = ""  # about noise, most of which the denoiser removes
            varied_shot = Shot(base_shot.scene, sized(variation, size), settings, base_shot.tone)
            with (
                warnings.catch_warnings(record=True) as caught,
                progress_bar(variation.label, is_shown=not quiet) as bar,
                suppress(Cancelled),
            ):
                warnings.simplefilter("always")

                def report(fraction: float, bar: Callable[[float], bool] = bar) -> bool:
                    return bar(fraction) and not is_interrupted()

                image = varied_shot.render(device=device, progress=report, on_stop="keep")
                suppressed_warning = image.shortfall if denoise else ""
                pictures.append((variation.label, image.denoised() if denoise else image))
            for warning in caught:
                if not suppressed_warning or str(warning.message) != suppressed_warning:
                    warnings.warn(f"{variation.label}: {warning.message}", stacklevel=1)
            if is_interrupted():
                break
        if not pictures:
            raise KeyboardInterrupt
        save_sheet(pictures, output, columns, tone=base_shot.tone, theme=theme)
    if as_json:
        rows = [
            {
                "label": label,
                "lens": image.camera.lens.name,
                "f_number": image.camera.lens.f_number,
                "focus_m": image.camera.lens.focus_distance_m,
                "position_m": list(image.camera.position),
                "exposure_time_s": image.camera.exposure_time_s,
                "spp": image.spp,
                "shortfall": image.shortfall,
            }
            for label, image in pictures
        ]
        typer.echo(json_text(rows))
    elif not quiet:
        for label, image in pictures:
            typer.echo(f"{label}, {number_text(image.camera.exposure_time_s, 3)} s, {counted(image.spp, 'sample')}")
        options.say_written(output)

    if is_interrupted():
        if len(pictures) < len(varied):
            warnings.warn(f"the sheet has {len(pictures)} of {len(varied)} pictures", stacklevel=1)
        raise KeyboardInterrupt


def sized(variation: Variation, longer_side_px: int) -> Camera:
    """Returns the variation's camera with fewer or more pixels on the same film."""
    camera = variation.shot.camera
    scale = longer_side_px / max(camera.film.resolution)
    width, height = (max(1, round(scale * side)) for side in camera.film.resolution)
    return camera.replace(film=camera.film.replace(resolution=(width, height)))


@contextmanager
def interrupt_noted() -> Iterator[Callable[[], bool]]:
    """Yields a function that returns True once Ctrl-C was pressed. A second Ctrl-C raises KeyboardInterrupt."""
    seen: list[int] = []

    def note(number: int, _: FrameType | None) -> None:
        seen.append(number)
        signal.signal(signal.SIGINT, signal.default_int_handler)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield lambda: bool(seen)
    finally:
        signal.signal(signal.SIGINT, before)
