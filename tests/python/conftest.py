"""The devices that the tests render with, and signals as a terminal's programs have them."""

from __future__ import annotations

import signal
import subprocess
from importlib.util import find_spec
from typing import TYPE_CHECKING

import pytest
import realcam as rc
from realcam_command.main import main

if TYPE_CHECKING:
    from .programs import Command

# A shell's background jobs ignore Ctrl-C, and so would the programs that tests start and interrupt.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(params=sorted({device.name.split(":")[0] for device in rc.devices()}))
def device(request: pytest.FixtureRequest) -> str:
    """cpu, and cuda where this machine has a GPU, in turn: `device` of rc.render."""
    return str(request.param)


@pytest.fixture
def backend(device: str) -> str:
    """Name of the device's backend in measurements."""
    return {"cpu": "Embree", "cuda": "CUDA"}.get(device, device)


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Command:
    """`realcam WORDS...` in this process: one of its own takes half a second to start."""

    def run(*words: object) -> subprocess.CompletedProcess[str]:
        monkeypatch.setattr("sys.argv", ["realcam", *map(str, words)])
        handler = signal.getsignal(signal.SIGINT)
        try:
            with pytest.raises(SystemExit) as ended:
                main()
        finally:
            signal.signal(signal.SIGINT, handler)
        return subprocess.CompletedProcess(words, int(ended.value.code or 0), *capfd.readouterr())

    return run


def pytest_runtest_setup(item: pytest.Item) -> None:
    if item.get_closest_marker("picture_files"):
        if not hasattr(rc._core, "_read_film"):
            pytest.skip("this build of realcam has no picture files")
        if find_spec("OpenImageIO") is None:
            pytest.skip("picture files need the package OpenImageIO")
