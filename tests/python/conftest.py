"""The devices that the tests render with."""

from __future__ import annotations

import pytest
import realcam as rc


@pytest.fixture(params=[line.split(":")[0] for line in rc.devices()])
def device(request: pytest.FixtureRequest) -> str:
    """Each device of this machine in turn, as `device` of rc.render."""
    return str(request.param)


@pytest.fixture
def backend(device: str) -> str:
    """What a measurement calls it."""
    return {"cpu": "Embree", "cuda": "CUDA"}.get(device, device)
