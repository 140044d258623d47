"""Options that the commands about lenses share."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from .._core import InputError, Lens, lens_names
from ..files import LENS_SUFFIXES
from . import options
from .completions import completion_of
from .shot_options import ring_option


def lens_argument(help: str) -> Any:
    return typer.Argument(help=help, metavar="LENS", autocompletion=completion_of("LENS"))


LENS_HELP = "A bundled lens (see `realcam lens list`) or a lens file"
LensName = Annotated[str, lens_argument(LENS_HELP)]
LensNames = Annotated[list[str] | None, lens_argument("Bundled lenses or lens files [all bundled lenses]")]
Rays = Annotated[int, typer.Option(metavar="N", help="Number of rays per field point", min=0, max=101)]
RaysFrom = Annotated[
    str,
    typer.Option("--rays-from", metavar="WHERE", help="Origin of the rays: object: object points; film: film points"),
]


def fields_option(help: str) -> Any:
    return options.parsed(options.numbers, "--fields-deg", "DEGREES", help)


def wavelengths_option(help: str) -> Any:
    return options.parsed(options.numbers, "--wavelengths", "NM", help)


ThemeName = Annotated[str, typer.Option("--theme", metavar="NAME", help="Colour theme: light or dark")]
Zoom = Annotated[str | None, ring_option("zoom")]
LensPath = Annotated[
    list[str] | None,
    typer.Option(
        "--lens-path",
        help="Folder in which lenses are found by name; may be repeated [REALCAM_LENS_PATH]",
        metavar="DIR",
    ),
]


@dataclass(frozen=True)
class File:
    """Options for reading a lens file."""

    glass: Annotated[
        list[str] | None,
        typer.Option(
            help="Definition of a glass in the lens file that no catalogue, or more than one, contains: NAME=n_d,V_d "
            "or NAME=schott:F4; may be repeated",
            metavar="NAME=N,V",
        ),
    ] = None
    glass_catalogue: Annotated[
        list[str] | None,
        typer.Option(
            help="Glass catalogue (.agf) that takes precedence over the bundled ones; may be repeated", metavar="FILE"
        ),
    ] = None
    lens_path: LensPath = None
    force: Annotated[
        bool, typer.Option("--force", help="Ignore unsupported features of the lens file, with a warning")
    ] = False
    pbrt_thickness: Annotated[
        str | None,
        typer.Option(
            help="Whether a thickness in a .dat file lies after or before the surface of its row [detected from "
            "the first row]",
            metavar="WHERE",
        ),
    ] = None

    def lens(self, name: str) -> Lens:
        return self.lens_and_light(name)[0]

    def lens_and_light(self, name: str) -> tuple[Lens, list[float], list[float]]:
        """Returns the lens, and the field angles in degrees and the wavelengths in nm that another program's file
        specifies."""
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
    """Options for the aperture, focus and zoom rings of a lens: arguments of Lens.with_rings."""

    f_number: Annotated[float | None, ring_option("f_number")] = None
    focus_m: Annotated[float | None, ring_option("focus_m")] = None
    zoom: Zoom = None

    def set(self, lens: Lens) -> Lens:
        return lens.with_rings(**asdict(self))


@dataclass(frozen=True)
class Look:
    """Options for drawing lenses."""

    wavelengths: Annotated[
        Sequence[float] | None, wavelengths_option("Wavelengths of the rays in nm, separated by commas [the lens's]")
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
    width: Annotated[int, typer.Option(metavar="PIXELS", help="Width of the picture in pixels", min=200, max=20000)] = (
        1600
    )

    def arguments(self) -> dict[str, Any]:
        """Returns keyword arguments for the functions of realcam.drawing."""
        return {
            "wavelengths_nm": self.wavelengths,
            "radius_colours": self.radius_colours,
            "marks": self.marks,
            "theme": self.theme,
            "width_px": self.width,
        }


def add_to_lens_path(folders: Sequence[str] | None) -> None:
    """Inserts folders in front of those of REALCAM_LENS_PATH. Raises InputError if one does not exist."""
    for folder in folders or ():
        if not Path(folder).is_dir():
            raise InputError(f"--lens-path: {folder} is not a folder")
    previous = os.environ.get("REALCAM_LENS_PATH")
    if folders:
        os.environ["REALCAM_LENS_PATH"] = ":".join([*folders, *([previous] if previous else [])])


def lens_files_on_path() -> dict[str, Path]:
    """Returns the lens files in the folders of REALCAM_LENS_PATH by name; of several with a name, the one that
    Lens.load finds."""
    files: dict[str, Path] = {}
    for folder in filter(None, os.environ.get("REALCAM_LENS_PATH", "").split(":")):
        for path in sorted(Path(folder).iterdir()) if Path(folder).is_dir() else ():
            if path.suffix.lower() in LENS_SUFFIXES and path.is_file():
                files.setdefault(path.stem, path)
    return {name: files[name] for name in sorted(files.keys() - lens_names())}


def default_output(name: str, suffix: str) -> Path:
    """Returns a file name in the current folder for output about a lens. name: lens as the user typed it, because the
    name in a lens file may be any text."""
    file = Path(name)
    stem = file.stem if file.suffix.lower() in LENS_SUFFIXES else file.name
    return Path(f"{stem or 'lens'}{suffix}")


def check_not_the_lens(target: Path, *names: str) -> None:
    """Raises InputError if the output file is the file of one of these lenses."""
    for name in names:
        if Path(name).is_file() and target.exists() and target.samefile(name):
            raise InputError(f"{target}: is the lens file itself; choose another name")
