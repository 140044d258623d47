"""Files for render farms: job-array scripts for Slurm and PBS, and an Open Job Description template."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class FarmPath:
    """A path in a command, which is a parameter of an Open Job Description template.

    name: of the parameter. kind: "DIRECTORY" or "FILE". flow: "IN", "OUT" or "INOUT".
    """

    name: str
    path: Path
    kind: str = "DIRECTORY"
    flow: str = "INOUT"


@dataclass(frozen=True)
class FarmWork:
    """Commands that divide work among the tasks of a render farm.

    folder: the folder that the tasks share. command: words after `realcam` of the command with the option --part.
    arguments: its further words. finish: all words of the command that follows when every part is done.
    """

    folder: Path
    command: Sequence[str]
    arguments: Sequence[str | FarmPath]
    finish: Sequence[str | FarmPath]


def work_of_job(folder: Path) -> FarmWork:
    """Returns the commands of a job in a folder."""
    job, output = FarmPath("JobFolder", folder), FarmPath("Output", folder / "pictures", flow="OUT")
    return FarmWork(folder, ("job", "work"), (job,), ("job", "finish", job, "--output", output, "--quiet"))


def array_script(batch_system: str, work: FarmWork, tasks: int) -> str:
    """Returns a script for Slurm's `sbatch` or PBS's `qsub`: an array of tasks, each with its part of the work.

    batch_system: "slurm" or "pbs". tasks: number of tasks.
    """
    directives, task, threads = _ARRAYS[batch_system]
    words = [str(word.path.absolute()) if isinstance(word, FarmPath) else word for word in work.arguments]
    # A directive is a bash comment, so it ends at the end of the line regardless of quotes.
    return f"""#!/bin/bash
{directives.format(name=_job_name(work.folder), tasks=tasks)}
# Cores, memory, GPUs and the queue are those of the command line, or the cluster's defaults.
exec realcam {shlex.join(work.command)} --quiet --part "{task}/{tasks}" --threads "{threads}" {shlex.join(words)}
"""


def openjd_template(work: FarmWork, tasks: int) -> str:
    """Returns a job template of Open Job Description 2023-09 as JSON, with the steps Work and Finish.

    tasks: number of tasks of the step Work.
    Raises InputError for a word that the format cannot express: it has no escape for the braces of its expressions.
    """
    parameters: dict[str, FarmPath] = {}

    def texts(words: Sequence[str | FarmPath]) -> list[str]:
        parameters.update({word.name: word for word in words if isinstance(word, FarmPath)})
        return [f"{{{{Param.{word.name}}}}}" if isinstance(word, FarmPath) else _literal(word) for word in words]

    def step(name: str, arguments: list[str], **more: object) -> dict[str, object]:
        return {"name": name, **more, "script": {"actions": {"onRun": {"command": "realcam", "args": arguments}}}}

    part = ["--quiet", "--part", f"{{{{Task.Param.Task}}}}/{tasks}"]
    steps = [
        step(
            "Work",
            [*work.command, *part, *texts(work.arguments)],
            parameterSpace={"taskParameterDefinitions": [{"name": "Task", "type": "INT", "range": f"1-{tasks}"}]},
        ),
        step("Finish", texts(work.finish), dependencies=[{"dependsOn": "Work"}]),
    ]
    template = {
        "specificationVersion": "jobtemplate-2023-09",
        "name": _job_name(work.folder),
        "parameterDefinitions": [_definition(parameter) for parameter in parameters.values()],
        "steps": steps,
    }
    return json.dumps(template, indent=2) + "\n"


def _definition(parameter: FarmPath) -> dict[str, str]:
    """Returns the definition of a path parameter. Raises InputError for a path that the format cannot express."""
    return {
        "name": parameter.name,
        "type": "PATH",
        "objectType": parameter.kind,
        "dataFlow": parameter.flow,
        "default": _literal(str(parameter.path.absolute())),
    }


def _literal(text: str) -> str:
    """Returns a text of a template. Raises InputError for one that the format cannot express."""
    if "{{" in text or "}}" in text or not text.isprintable():
        raise InputError(
            f"{text!a:.100}: a text for Open Job Description must not have double braces or control characters; "
            "choose another one"
        )
    return text


def _job_name(folder: Path) -> str:
    """Job name without characters that are special to shells, Slurm or Open Job Description."""
    return "realcam-" + re.sub(r"[^A-Za-z0-9._-]+", "_", folder.name)[:80]
