"""The tiers of tests, one of which `-m laws`, `-m pictures` or `-m browser` chooses.

laws: optics and light, and the rules of the source; no pictures of scenes, no browser. browser: the lens bench.
pictures: all else, with those tests of the other files that are marked so. The labels of ctest are the same.
What is slow for what it shows is marked so besides, and runs with `./run test all` alone.
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

# Deaths of processes, signals, servers, what stands in pages and examples: minutes, of which one witness each is quick.
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
    """Files that have none of the tests that `-m laws` or `-m browser` asks for are not read: it takes some seconds."""
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
