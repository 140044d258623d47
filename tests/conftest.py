"""The tiers of tests, one of which `-m laws`, `-m pictures` or `-m browser` chooses.

laws: optics and light, and the rules of the source; no pictures of scenes, no browser. browser: the lens bench.
pictures: all else. The labels of ctest are the same.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from .measurement import write_run

FOLDERS_OF_LAWS = {"architecture", "truth"}
# ruff: noqa: SIM905
LAWS = frozenset(
    """
    afocal analysis analysis_api bundled_lenses coatings cross_section device_rays diffraction dispersion distortion
    environment exposure glass_scale lens_api lens_edits lens_files lens_limits mapped_lens materials opacity
    optimisation phong projection properties psf ray_chunks roots samplings sensor_color sensor_emva1288 sensor_hard
    sensor_noise shading sums texture trace_api transmission transport vision
    """.split()
)


def tier_of(path: Path) -> str:
    name = path.stem.removeprefix("test_")
    if name.startswith("viewer_"):
        return "browser"
    return "laws" if path.parent.name in FOLDERS_OF_LAWS or name in LAWS else "pictures"


def pytest_configure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):  # once, and not in each of pytest-xdist's processes
        write_run()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        item.add_marker(tier_of(item.path))
