"""Changes configurations of OpenColorIO and their look-up tables, and makes views of them: each must become a view, or
an error in one line.

See many_mutations.py. It needs the package opencolorio (realcam[color]).
"""

from __future__ import annotations

import random
import re
import sys
import tempfile
import traceback
from functools import cache
from pathlib import Path

from many_mutations import Target, main
from text_mutations import mutated

CONFIG = """ocio_profile_version: 2
environment: {SHOT: a}
search_path: luts:.
strictparsing: true
roles: {default: lin, scene_linear: lin, aces_interchange: aces, cie_xyz_d65_interchange: xyz}
file_rules:
  - !<Rule> {name: cg, pattern: "*_cg", extension: exr, colorspace: lin}
  - !<Rule> {name: Default, colorspace: aces}
view_transforms:
  - !<ViewTransform>
    name: plain
    from_scene_reference: !<BuiltinTransform> {style: UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD}
displays:
  screen:
    - !<View> {name: out, colorspace: out, looks: warm}
    - !<View> {name: shown, view_transform: plain, display_colorspace: xyz}
active_displays: [screen]
active_views: [out, shown]
looks:
  - !<Look> {name: warm, process_space: lin, transform: !<CDLTransform> {slope: [1.1, 1, 0.9]}}
display_colorspaces:
  - !<ColorSpace>
    name: xyz
    from_display_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1], style: mirror, direction: inverse}
colorspaces:
  - !<ColorSpace>
    name: aces
    to_scene_reference: !<MatrixTransform> {}
  - !<ColorSpace>
    name: lin
    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}
  - !<ColorSpace>
    name: log
    from_scene_reference: !<LogTransform> {base: 2, direction: forward}
  - !<ColorSpace>
    name: out
    from_scene_reference: !<GroupTransform>
      children:
        - !<ColorSpaceTransform> {src: aces, dst: log}
        - !<RangeTransform> {min_in_value: 0, max_in_value: 1, min_out_value: 0, max_out_value: 1}
        - !<FileTransform> {src: NAME, interpolation: best}
"""
TABLES = {
    "a.cube": "TITLE \"t\"\nLUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n"
    + "".join(f"{r} {g} {b}\n" for b in (0, 1) for g in (0, 1) for r in (0, 1)),
    "a.spi1d": "Version 1\nFrom 0 1\nLength 3\nComponents 1\n{\n0\n0.4\n1\n}\n",
    "a.spi3d": "SPILUT 1.0\n3 3\n2 2 2\n"
    + "".join(f"{r} {g} {b} {r} {g} {b}\n" for r in (0, 1) for g in (0, 1) for b in (0, 1)),
    "a.csp": "CSPLUTV100\n1D\n\n2\n0 1\n0 1\n2\n0 1\n0 1\n2\n0 1\n0 1\n\n2\n0 0 0\n1 1 1\n",
    "a.3dl": "0 512 1023\n" + "".join(f"{r} {g} {b}\n" for r in (0, 512, 1023) for g in (0, 512, 1023)
                                      for b in (0, 512, 1023)),
    "a.clf": '<?xml version="1.0" encoding="UTF-8"?>\n<ProcessList id="a" compCLFversion="3">\n'
    '<LUT1D id="l" inBitDepth="32f" outBitDepth="32f"><Array dim="2 1">\n0\n1\n</Array></LUT1D>\n'
    '<Matrix id="m" inBitDepth="32f" outBitDepth="32f"><Array dim="3 3">\n1 0 0\n0 1 0\n0 0 1\n</Array></Matrix>\n'
    "</ProcessList>\n",
    "a.cc": '<ColorCorrection id="c"><SOPNode><Slope>1 1 1</Slope><Offset>0 0 0</Offset><Power>1 1 1</Power></SOPNode>'
    "<SatNode><Saturation>1</Saturation></SatNode></ColorCorrection>\n",
}  # fmt: skip
WORD = re.compile(r"\w+")
EXTREMES = ["0", "-1", "1e38", "nan", "inf", "2", "4000000000", "1e-40", "65", "x", ""]


def seeds() -> list[tuple[str, str, str]]:
    """Text of a configuration, name and text of its table."""
    return [(CONFIG.replace("NAME", name), name, text) for name, text in TABLES.items()]


def case_of(cases: list[tuple[str, str, str]], seed: int, number: int) -> tuple[str, str, str]:
    draw = random.Random(f"{seed} {number}")
    config, name, table = cases[number % len(cases)]
    for _ in range(draw.randint(1, 4)):
        if draw.random() < 0.5:
            config = mutated(config, draw, WORD, EXTREMES)
        else:
            table = mutated(table, draw, WORD, EXTREMES)
    return config, name, table


@cache
def scratch() -> tempfile.TemporaryDirectory[str]:
    """Kept until the process ends."""
    folder = tempfile.TemporaryDirectory(prefix="realcam-fuzz-")
    Path(folder.name, "luts").mkdir()
    return folder


def read(case: tuple[str, str, str]) -> tuple[str, str]:
    import numpy as np
    import realcam as rc
    from realcam.ocio import opened

    config, name, table = case
    folder = Path(scratch().name)
    (folder / "c.ocio").write_text(config, encoding="utf-8")
    (folder / "luts" / name).write_text(table, encoding="utf-8")
    light = np.array([[[0.1, 0.2, 0.3], [np.nan, -1, np.inf]]], np.float32)
    try:
        config_ = opened(str(folder / "c.ocio"))
        config_.conversion_to_rec709("file_rules", "/a/sky_cg.exr")(np.full((1, 3), 0.5, np.float32))
        for display, views in config_.views.items():
            for view in views:
                shown = rc.OcioView(str(folder / "c.ocio"), display, view)
                if shown.developed(light, 100).shape != (1, 2, 3) or shown.is_srgb not in (True, False):
                    return "broken", "a picture of another shape"
    except rc.RealcamError as error:
        message = str(error)
        is_long = "\n" in message or len(message) > 2500
        return ("broken", f"a message of several lines, or a long one: {message}") if is_long else ("refused", "")
    except BaseException:
        return "broken", traceback.format_exc(limit=-3)
    return "read", ""


if __name__ == "__main__":
    sys.exit(main(__doc__ or "", __file__, Target("ocio", seeds, case_of, read)))
