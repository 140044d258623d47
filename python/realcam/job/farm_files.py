"""Files for render farms: job-array scripts for Slurm and PBS, and an Open Job Description template."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

from .._core import InputError

# By batch system: directives of the script with {name} and {tasks}, variable of the task's index from 1, and variable
# of its number of cores.
_ARRAYS = {
    "slurm": (
        "#SBATCH --job-name={name}\n#SBATCH --array=1-{tasks}\n#SBATCH --ntasks=1\n#SBATCH --requeue",
        "${SLURM_ARRAY_TASK_ID}",
        "${SLURM_CPUS_PER_TASK:-0}",
    ),
    "pbs": ("#PBS -N {name}\n#PBS -J 1-{tasks}\n#PBS -r y", "${PBS_ARRAY_INDEX}", "${NCPUS:-0}"),
}


def array_script(batch_system: str, folder: Path, tasks: int) -> str:
    """Returns a script for Slurm's `sbatch` or PBS's `qsub`: an array of tasks, each with its part of the job.

    batch_system: "slurm" or "pbs". folder: of the job. tasks: number of tasks.
    """
    directives, task, threads = _ARRAYS[batch_system]
    # A directive is a bash comment, so it ends at the end of the line regardless of quotes.
    return f"""#!/bin/bash
{directives.format(name=_job_name(folder), tasks=tasks)}
# Cores, memory, GPUs and the queue are those of the command line, or the cluster's defaults.
exec realcam job work --quiet --part "{task}/{tasks}" --threads "{threads}" {shlex.quote(str(folder.absolute()))}
"""


def openjd_template(folder: Path, tasks: int) -> str:
    """Returns a job template of Open Job Description 2023-09 as JSON, with the steps work and finish.

    folder: of the job. tasks: number of tasks of the step work.
    Raises InputError for a path that the format cannot express: it has no escape for the braces of its expressions.
    """
    path = str(folder.absolute())
    if "{{" in path or "}}" in path or not path.isprintable():
        raise InputError(
            f"{path!a:.100}: a path for Open Job Description must not have double braces or control characters; "
            "choose another folder"
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
                ["job", "work", "--quiet", "--part", f"{{{{Task.Param.Task}}}}/{tasks}", "{{Param.JobFolder}}"],
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
    """Job name without characters that are special to shells, Slurm or Open Job Description."""
    return "realcam-" + re.sub(r"[^A-Za-z0-9._-]+", "_", folder.name)[:80]
