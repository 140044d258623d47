"""Options that the commands about lenses share."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from .._core import InputError, Lens, lens_names
from . import options
from .completions import completion_of

LensName = Annotated[
    str,
    typer.Argument(
        help="A bundled lens (see `realcam lens list`) or a lens file",
        metavar="LENS",
        autocompletion=completion_of("LENS"),
    ),
]
LensNames = Annotated[
    list[str] | None,
    typer.Argument(
        help="Lenses, bundled or files [all that are bundled]", metavar="LENS", autocompletion=completion_of("LENS")
    ),
]
Rays = Annotated[int, typer.Option(metavar="N", help="Rays of each bundle", min=0, max=101)]
RaysFrom = Annotated[
    str,
    typer.Option(
        "--rays-from", metavar="WHERE", help="object: bundles of points of it; film: what points of the film send out"
    ),
]
Fields = Annotated[
    str,
    typer.Option("--fields", metavar="SHARES", help="Field points, relative to the height of the film's corner"),
]
FieldsDeg = Annotated[
    str | None,
    typer.Option(
        "--fields-deg", metavar="DEGREES", help="Field points as angles in front of the lens, in degrees, instead"
    ),
]
ThemeName = Annotated[str, typer.Option("--theme", metavar="NAME", help="light or dark")]
Zoom = Annotated[
    str | None, typer.Option("--zoom", metavar="NAME", help="Zoom position, by its name in `realcam lens info`")
]


LensPath = Annotated[
    list[str] | None,
    typer.Option(
        "--lens-path",
        help="A folder whose lens files are known by their names; may be repeated [REALCAM_LENS_PATH]",
        metavar="DIR",
    ),
]


@dataclass(frozen=True)
class File:
    """How the file of a lens is read."""

    glass: Annotated[
        list[str] | None,
        typer.Option(
            "--glass",
            help="A glass that the lens's file names and no catalogue has, or several: NAME=n_d,V_d or NAME=schott:F4; "
            "may be repeated",
            metavar="NAME=N,V",
        ),
    ] = None
    glass_catalogue: Annotated[
        list[str] | None,
        typer.Option(
            "--glass-catalogue",
            help="A catalogue of glasses (.agf) for those that the lens's file names; may be repeated",
            metavar="FILE",
        ),
    ] = None
    lens_path: LensPath = None
    force: Annotated[
        bool, typer.Option("--force", help="Leave out what the lens's file has that there is no model of, and name it")
    ] = False
    pbrt_thickness: Annotated[
        str | None,
        typer.Option(
            "--pbrt-thickness",
            help="Where a thickness in a .dat file stands: after or before the surface of its row [by the first row]",
            metavar="WHERE",
        ),
    ] = None

    def lens(self, name: str) -> Lens:
        return self.lens_and_light(name)[0]

    def lens_and_light(self, name: str) -> tuple[Lens, list[float], list[float]]:
        """The lens, and the field angles in degrees and the wavelengths in nm that another program's file states."""
        add_to_lens_path(self.lens_path)
        return Lens._load_with_light(
            name,
            glass=options.glasses(self.glass or ()),
            force=self.force,
            pbrt_thickness=self.pbrt_thickness,
            glass_catalogue=self.glass_catalogue,
        )


@dataclass(frozen=True)
class Rings:
    """How the rings of a lens are set."""

    f_number: Annotated[
        float | None, typer.Option("--f-number", metavar="N", help="Close the diaphragm to this f-number")
    ] = None
    focus: Annotated[
        str | None, typer.Option("--focus", metavar="METRES", help="Object plane to film in metres, or inf")
    ] = None
    zoom: Zoom = None

    def set(self, lens: Lens) -> Lens:
        focus_m = None if self.focus is None else options.number(self.focus, "--focus", "a number of metres or inf")
        return lens.with_rings(zoom=self.zoom, f_number=self.f_number, focus_m=focus_m)


@dataclass(frozen=True)
class Look:
    """How lenses are drawn."""

    wavelengths: Annotated[
        str | None,
        typer.Option("--wavelengths", metavar="NM", help="Wavelengths of the rays in nm: 486,588,656 [the lens's]"),
    ] = None
    radius_colours: Annotated[
        bool,
        typer.Option(
            "--radius-colours", help="Colour surfaces by the sign of their radius: blue positive, red negative"
        ),
    ] = False
    marks: Annotated[
        bool, typer.Option("--marks", help="Mark pupils (EP, XP), principal planes (H, H') and focal points (F, F')")
    ] = False
    theme: ThemeName = "light"
    width: Annotated[
        int, typer.Option("--width", metavar="PIXELS", help="Width of the picture in pixels", min=200, max=20000)
    ] = 1600

    def arguments(self) -> dict[str, Any]:
        """Keyword arguments for the functions of realcam.drawing."""
        return {
            "wavelengths_nm": numbers(self.wavelengths, "--wavelengths"),
            "radius_colours": self.radius_colours,
            "marks": self.marks,
            "theme": self.theme,
            "width_px": self.width,
        }


SUFFIXES = (".toml", ".zmx", ".seq", ".len", ".dat", ".json", ".roa")  # of supported lens files


def add_to_lens_path(folders: Sequence[str] | None) -> None:
    """Puts folders before those of REALCAM_LENS_PATH. Raises InputError."""
    for folder in folders or ():
        if not Path(folder).is_dir():
            raise InputError(f"--lens-path: {folder} is no folder")
    before = os.environ.get("REALCAM_LENS_PATH")
    if folders:
        os.environ["REALCAM_LENS_PATH"] = ":".join([*folders, *([before] if before else [])])


def lens_files_on_path() -> dict[str, Path]:
    """Lens files in the folders of REALCAM_LENS_PATH by name, as Lens.load finds them."""
    files: dict[str, Path] = {}
    for folder in filter(None, os.environ.get("REALCAM_LENS_PATH", "").split(":")):
        for path in sorted(Path(folder).iterdir()) if Path(folder).is_dir() else ():
            if path.suffix.lower() in SUFFIXES and path.is_file():
                files.setdefault(path.stem, path)
    return {name: files[name] for name in sorted(files.keys() - lens_names())}


def output_of(name: str, suffix: str) -> Path:
    """A file here, by what the user called the lens: the name that stands in a lens's file may be any text."""
    file = Path(name)
    stem = file.stem if file.suffix.lower() in SUFFIXES else file.name
    return Path(f"{stem or 'lens'}{suffix}")


def check_not_the_lens(target: Path, *names: str) -> None:
    """Raises InputError where what is written would go over the file of a lens that it is about."""
    for name in names:
        if Path(name).is_file() and target.exists() and target.samefile(name):
            raise InputError(f"{target}: is the lens file itself; choose another name")


def numbers(text: str | None, option: str) -> list[float] | None:
    """Numbers with commas between them. Raises InputError."""
    return None if text is None else [options.number(word.strip(), option) for word in text.split(",")]


def seconds(text: str) -> float:
    """A time, 0.008 or 1/125. Raises InputError."""
    above, slash, below = text.partition("/")
    value = options.number(above, "--exposure-time")
    divisor = options.number(below, "--exposure-time") if slash else 1.0
    if divisor == 0:
        raise InputError(f'--exposure-time: "{text}" divides by 0')
    return value / divisor
