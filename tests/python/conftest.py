"""The devices that the tests render with, and signals as a terminal's programs have them."""

from __future__ import annotations

import signal
from importlib.util import find_spec

import pytest
import realcam as rc

# A shell's background jobs ignore Ctrl-C, and so would the programs that tests start and interrupt.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(params=sorted({line.split(":")[0] for line in rc.devices()}))
def device(request: pytest.FixtureRequest) -> str:
    """cpu, and cuda where this machine has a GPU, in turn: `device` of rc.render."""
    return str(request.param)


@pytest.fixture
def backend(device: str) -> str:
    """What a measurement calls it."""
    return {"cpu": "Embree", "cuda": "CUDA"}.get(device, device)


def pytest_runtest_setup(item: pytest.Item) -> None:
    if item.get_closest_marker("pictures") and find_spec("realcam._pictures") is None:
        pytest.skip("this build of realcam has no OpenImageIO")
