"""Files for render farms that run command lines: an array of Slurm's, and a template of Open Job Description."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

from .._core import InputError

# All tasks are alike: each takes the units that nobody has in hand, until there are none.
_WORK = ("job", "work", "--here", "--quiet")


def sbatch_script(folder: Path, tasks: int) -> str:
    """What `sbatch` takes: so many tasks that work on the same folder."""
    path = str(folder.absolute())
    # A comment of bash ends with its line, whatever is quoted in it.
    return f"""#!/bin/bash
#SBATCH --job-name={_job_name(folder)}
#SBATCH --array=1-{tasks}
#SBATCH --ntasks=1
# Cores, memory, GPUs and the partition are those of the command line or of the cluster: sbatch --cpus-per-task=16 ...
#SBATCH --requeue
exec realcam {" ".join(_WORK)} --threads "${{SLURM_CPUS_PER_TASK:-0}}" {shlex.quote(path)}
"""


def openjd_template(folder: Path, tasks: int) -> str:
    """A job template of Open Job Description 2023-09 as JSON: work, then finish.

    Raises InputError for a path that the format cannot hold: it has no escape for the brackets of its expressions.
    """
    path = str(folder.absolute())
    if "{{" in path or "}}" in path or not path.isprintable():
        raise InputError(
            f"{path!a:.100}: Open Job Description takes no path with double braces or control characters; another "
            "folder is wanted"
        )
    output = {
        "name": "Output",
        "type": "PATH",
        "objectType": "DIRECTORY",
        "dataFlow": "OUT",
        "default": str(Path(path, "pictures")),
    }
    job = {
        "name": "JobFolder",
        "type": "PATH",
        "objectType": "DIRECTORY",
        "dataFlow": "INOUT",
        "default": path,
    }

    def step(name: str, arguments: list[str], **more: object) -> dict[str, object]:
        return {"name": name, **more, "script": {"actions": {"onRun": {"command": "realcam", "args": arguments}}}}

    template = {
        "specificationVersion": "jobtemplate-2023-09",
        "name": _job_name(folder),
        "parameterDefinitions": [job, output],
        "steps": [
            step(
                "Work",
                [*_WORK, "{{Param.JobFolder}}"],
                parameterSpace={"taskParameterDefinitions": [{"name": "Task", "type": "INT", "range": f"1-{tasks}"}]},
            ),
            step(
                "Finish",
                ["job", "finish", "{{Param.JobFolder}}", "--output", "{{Param.Output}}", "--quiet"],
                dependencies=[{"dependsOn": "Work"}],
            ),
        ],
    }
    return json.dumps(template, indent=2) + "\n"


def _job_name(folder: Path) -> str:
    """A name without characters that shells, Slurm or Open Job Description give a meaning."""
    return "realcam-" + re.sub(r"[^A-Za-z0-9._-]+", "_", folder.name)[:80]
