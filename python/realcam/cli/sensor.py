"""The commands `realcam sensor ...`, which describe sensors, and `realcam expose`, which simulates one."""

from __future__ import annotations

import math
import os
import warnings
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from .._core import Film, InputError, Sensor, sensor_names
from ..json_values import json_text
from ..number_text import number_text, percent_text
from . import options
from .completions import completion_of

app = typer.Typer(help="List and describe image sensors.", rich_markup_mode=None)

SensorName = Annotated[
    str,
    typer.Argument(
        help="A bundled sensor (see `realcam sensor list`) or a sensor file",
        metavar="SENSOR",
        autocompletion=completion_of("SENSOR"),
    ),
]


@app.command("list")
def list_sensors(as_json: options.AsJson = False) -> None:
    """List the bundled sensors."""
    names = sensor_names()
    if as_json:
        typer.echo(json_text([{"name": name, "title": Sensor.load(name).title} for name in names]))
        return
    for name in names:
        typer.echo(f"{name:{max(map(len, names))}}  {Sensor.load(name).title}")


@app.command("info")
def info(name: SensorName, as_json: options.AsJson = False) -> None:
    """Print the properties of a sensor, their source, and what had to be assumed."""
    sensor = Sensor.load(name)
    lowest, highest = sensor.iso_range()
    if as_json:
        values = {key: getattr(sensor, key) for key, value in vars(Sensor).items() if isinstance(value, property)}
        typer.echo(json_text({**values, "iso_range": None if lowest == 0 else (lowest, highest)}))
        return
    rows = {
        "pixels": "any" if sensor.resolution is None else f"{sensor.resolution[0]} x {sensor.resolution[1]}",
        "pixel pitch": "the film's" if sensor.pixel_pitch_um is None else f"{sensor.pixel_pitch_um:g} um",
        "filters": sensor.color_filter_array or "none",
        "ISO": "any" if lowest == 0 else f"{math.ceil(lowest)} to {math.floor(highest)}",
        "gain": "by the ISO"
        if lowest == 0
        else f"{sensor.gain_dn_per_e:g} DN/e, and up to {sensor.largest_gain_db:g} dB",
        "converter": f"{sensor.adc_bits} bit, black at {sensor.black_level_dn:g} DN",
        "converter noise": f"{sensor.converter_noise_dn:g} DN",
        "saturation capacity": f"{number_text(sensor.saturation_capacity_e, 6)} e",
        "read noise": f"{sensor.read_noise_e:g} e",
        "row noise": f"{sensor.row_noise_e:g} e",
        "dark current": f"{sensor.dark_current_e_per_s:g} e/s at {sensor.dark_current_temperature_c:g} degrees C",
        "DSNU, PRNU": f"{sensor.dsnu_e:g} e, {percent_text(sensor.prnu_percent / 100)}",
        "hot pixels": f"{percent_text(sensor.hot_pixel_share)}, {sensor.hot_pixel_current_e_per_s:g} e/s",
    }
    typer.echo(sensor.title or sensor.name)
    for what, value in rows.items():
        typer.echo(f"  {what:20} {value}")
    typer.echo(f"  {'source':20} {sensor.source}")
    for assumption in sensor.assumptions:
        typer.echo(f"  {'assumed':20} {assumption}")


def expose(
    film: Annotated[
        Path, typer.Argument(help="Exposure of the film: an .exr file written by `realcam render`", metavar="FILM")
    ],
    output: Annotated[
        list[Path],
        options.output("Raw values as .dng or .npy, developed picture as .png, .jpg, .tif or .webp; may be repeated"),
    ],
    sensor: Annotated[
        str,
        typer.Option(
            metavar="SENSOR",
            help="A bundled sensor (`realcam sensor list`) or a sensor file",
            autocompletion=completion_of("SENSOR"),
        ),
    ] = "ideal",
    iso: Annotated[
        float | None, typer.Option(metavar="ISO", help="Sensitivity as an ISO number [the picture's]")
    ] = None,
    seed: Annotated[
        int, typer.Option(metavar="N", help="Seed of the noise of this exposure", min=0, max=2**32 - 1)
    ] = 0,
    serial: Annotated[
        int, typer.Option(metavar="N", help="Seed of the sensor's fixed pattern", min=0, max=2**32 - 1)
    ] = 0,
    temperature: Annotated[
        float | None,
        typer.Option(metavar="CELSIUS", help="Temperature in degrees Celsius [that of the sensor's dark current]"),
    ] = None,
    tone: Annotated[
        str, typer.Option(metavar="CURVE", help="Tone curve of the developed picture: linear (clipped) or film")
    ] = "linear",
    demosaic: Annotated[
        str, typer.Option(metavar="NAME", help="Demosaicing of the developed picture: menon, malvar or bilinear")
    ] = "menon",
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Simulate a sensor in the place of a film: raw values with its noise, and a picture developed from them."""
    from ..demosaicing import METHODS
    from ..files import check_target
    from ..image_file import DEVELOPED, read_film
    from ..raw_image import exposed_film

    for path in output:
        check_target(path)
        if path.exists() and path.samefile(film):
            raise InputError(f"{path}: is the film itself; the raw picture needs another name")
        if path.suffix.lower() not in (".dng", ".npy", *DEVELOPED):
            raise InputError(f"{path}: expected .dng, .npy (raw) or .png, .jpg, .tif, .webp (developed)")
    for option, word, known in (("--tone", tone, ("linear", "film")), ("--demosaic", demosaic, METHODS)):
        if word not in known:
            raise InputError(f'{option}: "{word:.60}" is unknown; expected {", ".join(known)}')
    loaded_sensor = Sensor.load(sensor)
    pixels, entries = read_film(film)
    if loaded_sensor.angular_response:
        warnings.warn(
            "the film's file does not contain the position of the exit pupil; the sensor's angular response is ignored",
            stacklevel=1,
        )
    raw = exposed_film(
        loaded_sensor,
        pixels,
        _film_of(film, entries, pixels),
        exposure_time_s=_number(film, entries, "realcam:exposure_time_s"),
        iso=_number(film, entries, "realcam:iso") if iso is None else iso,
        illuminant=entries.get("realcam:illuminant", ""),
        temperature_c=temperature,
        seed=seed,
        serial=serial,
        metadata=entries,
    )
    for path in output:
        raw.save(path, tone=tone, demosaic=demosaic)
    saturated = float(np.mean(raw.mosaic >= raw.white_level_dn))  # fraction of the pixels
    if as_json:
        figures = {
            "sensor": loaded_sensor.name,
            "iso": raw.iso,
            "gain_dn_per_e": raw.gain_dn_per_e,
            "black_level_dn": raw.black_level_dn,
            "white_level_dn": raw.white_level_dn,
            "full_share": saturated,
            "assumptions": loaded_sensor.assumptions,
            "files": [os.fsencode(path).decode(errors="replace") for path in output],
        }
        typer.echo(json_text(figures))
    if as_json or quiet:
        return
    typer.echo(
        f"{loaded_sensor.name}, ISO {raw.iso:.4g}: {raw.gain_dn_per_e:.4g} DN/e, black {raw.black_level_dn:g}, "
        f"white {number_text(raw.white_level_dn)} DN, {percent_text(saturated)} of the pixels full"
    )
    for assumption in loaded_sensor.assumptions:
        typer.echo(f"assumed: {assumption}")
    for path in output:
        options.say_written(path)


def _film_of(path: Path, entries: dict[str, str], pixels: np.ndarray) -> Film:
    """Returns the film that a file's metadata describe. Raises InputError if its size is missing."""
    size = entries.get("realcam:film_mm", "").split("x")
    try:
        width, height = (float(word) for word in size)
    except ValueError:
        raise InputError(f"{path}: does not state the size of its film; expected an .exr of `realcam render`") from None
    return Film(width, height, (pixels.shape[1], pixels.shape[0]))


def _number(path: Path, entries: dict[str, str], name: str) -> float:
    """Returns a positive number of a file's metadata. Raises InputError if it is missing or invalid."""
    text = entries.get(name, "")
    try:
        number = float(text)
    except ValueError:
        raise InputError(f"{path}: has no {name}; expected an .exr of `realcam render`") from None
    if not 0 < number < math.inf:
        raise InputError(f"{path}: {name} must be a positive number; it is {text!r:.60}")
    return number
