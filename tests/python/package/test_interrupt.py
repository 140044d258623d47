"""Ctrl-C ends long calls of the optics within a second, with KeyboardInterrupt."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

# Each takes a second or more, and is called until somebody stops it.
CALLS = {
    "wavefront": "lens.wavefront(5.0, pattern='rings', samples=2048)",
    "spot": "lens.spot(5.0, pattern='rings', samples=2048)",
    "psf": "lens.psf(5.0, size=2048)",
    "aim": "lens.aim(places)",
    "trace": "lens.trace(o, d, start='scene')",
    "rays": "rc.Camera(lens, film=rc.Film(36, 24, (1000, 1000))).generate_rays(spp=50)",
}
PROGRAM = """
import time
import numpy as np
import realcam as rc
lens = rc.Lens.load("double-gauss-50mm")
rng = np.random.default_rng(0)
places = rng.uniform(-0.7, 0.7, (20_000_000, 2)) if {aim} else None
o = rng.uniform(-5, 5, (10_000_000, 3)) if {trace} else None
d = o * [0.01, 0.01, 0] + [0, 0, 1] if {trace} else None
print("begins", flush=True)
try:
    while True:
        {call}
except KeyboardInterrupt:
    print("stopped", time.clock_gettime(time.CLOCK_MONOTONIC), flush=True)
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c_ends_the_call(name: str) -> None:
    program = PROGRAM.format(call=CALLS[name], trace=name == "trace", aim=name == "aim")
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begins\n"
        time.sleep(0.4)
        sent = time.clock_gettime(time.CLOCK_MONOTONIC)
        process.send_signal(signal.SIGINT)
        answer = process.stdout.readline().split()
        process.wait(timeout=30)
    assert answer[0] == "stopped", answer
    assert float(answer[1]) - sent < 1.0
    assert process.returncode == 0
