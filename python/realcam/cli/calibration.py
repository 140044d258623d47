"""The commands `realcam calibration ...`, which show, convert and use calibrations of cameras."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from .._core import InputError
from ..json_values import json_text
from . import options

app = typer.Typer(help="Show and convert calibrations of cameras.", rich_markup_mode=None)

File = Annotated[Path, typer.Argument(help="A calibration file; docs/calibration.md lists the formats", metavar="FILE")]


def camera_option(default: str) -> Any:
    return typer.Option("--camera", metavar="NAME", help=f"One of several cameras of the file [{default}]")


CameraNames = Annotated[str | None, camera_option("all of them")]
Size = Annotated[
    Any,
    options.parsed(options.size, "--size", "WxH", "Size of the picture in pixels, for formats that do not state it"),
]


@app.command("show")
def show(file: File, camera: CameraNames = None, size: Size = None, as_json: options.AsJson = False) -> None:
    """Print the cameras of a calibration file."""
    from ..calibration import Calibration

    if camera is None:
        found = Calibration.load_all(file, size=size)
    else:
        found = {camera: Calibration.load(file, camera, size=size)}
    if as_json:
        typer.echo(
            json_text(
                [
                    {
                        "camera": name,
                        "format": calibration.format,
                        "model": calibration.model,
                        "size": calibration.size,
                        "camera_matrix": calibration.camera_matrix,
                        "largest_angle_deg": calibration.largest_angle_deg,
                        "extrinsics": calibration.extrinsics,
                        "pictures": len(calibration.poses),
                    }
                    for name, calibration in found.items()
                ]
            )
        )
        return
    for name, calibration in found.items():
        K = calibration.camera_matrix
        rows = {
            "format": calibration.format,
            "model": calibration.model,
            "size": f"{calibration.size[0]} x {calibration.size[1]} pixels",
            "fx, fy": f"{K[0, 0]:.6g}, {K[1, 1]:.6g} pixels",
            "cx, cy": f"{K[0, 2]:.6g}, {K[1, 2]:.6g} pixels; the first pixel's centre is (0.5, 0.5)",
            "largest angle": f"{calibration.largest_angle_deg:.4g} degrees off the axis",
            **({"transforms": ", ".join(calibration.extrinsics)} if calibration.extrinsics else {}),
            **({"pictures": f"{len(calibration.poses)} with poses"} if calibration.poses else {}),
        }
        typer.echo(name)
        for what, value in rows.items():
            typer.echo(f"  {what:14} {value}")


@app.command("convert")
def convert(
    file: File,
    output: Annotated[Path, typer.Argument(help="The file to write, such as camera_info.yaml", metavar="OUT")],
    camera: CameraNames = None,
    size: Size = None,
    to: Annotated[str | None, typer.Option(metavar="FORMAT", help="Format of the output [by its name]")] = None,
    quiet: options.Quiet = False,
) -> None:
    """Convert a calibration file to another format."""
    from ..calibration import Calibration

    if camera is None:
        Calibration.save_all(output, Calibration.load_all(file, size=size), to)
    else:
        Calibration.load(file, camera, size=size).save(output, to)
    options.say_written(output, quiet)


@app.command("undistort")
def undistort(
    file: File,
    picture: Annotated[Path, typer.Argument(help="A picture of this camera", metavar="PICTURE")],
    output: Annotated[Path, options.output("The picture to write")],
    camera: Annotated[str | None, camera_option("the only one")] = None,
    size: Size = None,
    quiet: options.Quiet = False,
) -> None:
    """Write the picture that a pinhole camera would take. Pixels that the camera does not see are black."""
    import numpy as np

    from ..analysis.image_simulation import srgb_codes
    from ..calibration import Calibration
    from ..files import check_target
    from ..image_file import DEVELOPED, read_picture, write_codes

    check_target(output, DEVELOPED)
    values = read_picture(picture)
    height, width = values.shape[:2]
    calibration = Calibration.load(file, camera, size=size)
    if calibration.size != (width, height):
        raise InputError(
            f"{picture}: has {width} x {height} pixels, but the calibration is of {calibration.size[0]} x "
            f"{calibration.size[1]}"
        )
    write_codes(srgb_codes(np.nan_to_num(calibration.undistort(values)).astype(np.float32)), output, {})
    options.say_written(output, quiet)
