"""Description of the machine, for records of benchmark results."""

from __future__ import annotations

import platform
import subprocess
import time
from pathlib import Path

from realcam import _core, devices

Result = dict[str, object]


def machine() -> Result:
    """Returns processor, system, devices, version, commit and date, without which results cannot be interpreted."""
    return {
        "processor": _processor(),
        "system": f"{platform.system()} {platform.release()}",
        "devices": [str(device) for device in devices()],
        "realcam": _core.__version__,
        "commit": _commit(),
        "date": time.strftime("%Y-%m-%d", time.gmtime()),
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def _commit() -> str | None:
    """The repository's commit; None without git."""
    command = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty", "--abbrev=12"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None
