"""The tiers of tests: `-m laws`, `-m pictures` or `-m browser` selects one.

laws: optics and light, and the rules of the source; no pictures of scenes, no browser. browser: the lens bench.
pictures: all other files, and tests of laws or browser files that are marked `pictures`. ctest uses the same labels.
Tests that take long for what they show are also marked `slow`, and only `./run test all` runs them.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from .measurement import write_run

FOLDERS_OF_LAWS = {"architecture", "calibration", "truth"}
# ruff: noqa: SIM905
LAWS = frozenset(
    """
    afocal analysis analysis_api bundled_lenses coatings device_rays diffraction dispersion distortion
    environment exposure glass_scale lens_api lens_edits lens_files lens_limits mapped_lens materials opacity
    optimisation phong projection properties psf ray_chunks roots samplings sensor_color sensor_emva1288 sensor_hard
    sensor_noise shading sums texture trace_api transmission transport vision
    """.split()
)

# Tests of dying processes, signals, servers, and of the code in pages and examples. They take minutes; each subject
# also has one quick test in another file.
SLOW = frozenset(
    """
    docs_blocks examples gpu_weather hostile_names inputs_stay interrupt notebook numerics_page pickled_states site
    stopping tutorials viewer_endings viewer_worker_process
    """.split()
)


def tier_of(path: Path) -> str:
    name = path.stem.removeprefix("test_")
    if name.startswith("viewer_"):
        return "browser"
    return "laws" if path.parent.name in FOLDERS_OF_LAWS or name in LAWS else "pictures"


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Skips files without tests of the tier that `-m laws` or `-m browser` selects: reading them takes some seconds."""
    asked = config.getoption("markexpr")
    is_of_another = collection_path.suffix == ".py" and tier_of(collection_path) != asked
    return True if asked in ("laws", "browser") and is_of_another else None


def pytest_configure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):  # once, and not in each of pytest-xdist's processes
        write_run()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if not item.get_closest_marker("pictures"):
            item.add_marker(tier_of(item.path))
        if item.path.stem.removeprefix("test_") in SLOW:
            item.add_marker("slow")
