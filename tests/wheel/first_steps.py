"""First steps of a new user with the wheel: install it, `python -m realcam demo`, `realcam view`, open its page.

In an empty root (tests/wheel/in_empty_root.sh): python3 first_steps.py WHEEL, in a folder where `venv` may be made.
Needs only Python. Prints the wall-clock time and the processor time of each step.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PYTHON = Path("venv/bin/python").absolute()
# Uses the package websockets, which the server depends on. Prints the size of the page's first picture.
LOOK = r"""
import re, struct, sys, urllib.request
from websockets.sync.client import connect
url = sys.argv[1]
page = urllib.request.urlopen(url, timeout=60).read().decode()
path = re.search(r"/realcam/stream/[\w-]+", page)[0]
with connect(url.rstrip("/").replace("http", "ws") + path, max_size=1 << 26, proxy=None) as stream:
    while isinstance(message := stream.recv(timeout=60), str):
        pass
jpeg = message[4 + struct.unpack("<I", message[:4])[0] :]
assert jpeg[:2] == b"\xff\xd8", jpeg[:20]
print(len(jpeg), "bytes of JPEG")
"""


@contextmanager
def timed(what: str) -> Iterator[None]:
    def processors() -> float:
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    begin, used = time.monotonic(), processors()
    yield
    print(f"{what}: {time.monotonic() - begin:.1f} s, of processors {processors() - used:.1f} s", flush=True)


def python(*words: object) -> None:
    subprocess.run([PYTHON, *map(str, words)], check=True)


def view() -> None:
    """The bench until its page has shown a picture."""
    command = [PYTHON, "-m", "realcam", "view", "--no-browser", "--port", "8642"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as bench:
        try:
            assert bench.stdout is not None
            said = bench.stdout.readline()
            assert said.startswith("realcam: the lens bench is at http"), said
            python("-c", LOOK, said.split()[-1])
        finally:
            bench.terminate()


def main(wheel: str) -> None:
    with timed("install"):
        subprocess.run([sys.executable, "-m", "venv", "venv"], check=True)
        python("-m", "pip", "install", "--quiet", f"{wheel}[view]")
    with timed("demo"):
        python("-m", "realcam", "demo", "--output", "demo")
    with timed("view"):
        view()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")


if __name__ == "__main__":
    main(*sys.argv[1:])
