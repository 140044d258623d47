"""Runs many mutations in a child process. If a signal or the time limit ends the child, it leaves the index of the
mutation, and the next child continues behind it.

A fuzz program is `sys.exit(main(__doc__, __file__, Target(...)))`, and is called as

PROGRAM [COUNT] [--seed N] [--folder FOLDER]: COUNT mutations in all. Each is a function of seed and number, so that a
run can be repeated.
PROGRAM replay FILE...: reads what was saved of a finding.

REALCAM_CORE is the path of an extension to use in place of the package's own, such as one that has sanitizers.
"""

from __future__ import annotations

import argparse
import importlib.abc
import importlib.machinery
import importlib.util
import os
import pickle
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

LONGEST_S = 60  # in user mode, so that other programs do not count; a thousand times the usual time of a case


@dataclass(frozen=True)
class Target:
    """A fuzz target. A case is any picklable value."""

    name: str
    seeds: Callable[[], list[Any]]
    case_of: Callable[[list[Any], int, int], Any]  # arguments: seeds, random seed, index
    read: Callable[[Any], tuple[str, str]]  # "read", "refused" or "broken", and the reason if it is broken


class CoreFinder(importlib.abc.MetaPathFinder):
    """Loads the extension of another build in place of the package's own."""

    def __init__(self, file: str) -> None:
        self.file = file

    def find_spec(
        self, name: str, path: object = None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        return importlib.util.spec_from_file_location(name, self.file) if name == "realcam._core" else None


def prepare() -> None:
    if os.environ.get("REALCAM_CORE"):
        sys.meta_path.insert(0, CoreFinder(os.environ["REALCAM_CORE"]))
    here = Path(__file__).resolve().parent
    sys.path[:0] = [str(here), str(here.parent / "python" / "package")]


def finding(target: Target, folder: Path, seed: int, number: int) -> Path:
    return folder / f"{target.name}-{seed}-{number}.pkl"


def work(target: Target, first: int, last: int, seed: int, folder: Path) -> None:
    """Reads the cases from `first` to `last`. Prints their outcomes as a line for another program to parse."""
    cases = target.seeds()
    counts: Counter[str] = Counter()
    with (folder / f"at-{seed}").open("wb", buffering=0) as at:
        for number in range(first, last):
            at.seek(0)
            at.write(b"%20d" % number)
            case = target.case_of(cases, seed, number)
            signal.setitimer(signal.ITIMER_VIRTUAL, LONGEST_S)
            outcome, why = target.read(case)
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            counts[outcome] += 1
            if outcome == "broken":
                file = finding(target, folder, seed, number)
                file.write_bytes(pickle.dumps(case))
                print(f"{file}: {why}", file=sys.stderr, flush=True)
    print(counts["read"], counts["refused"], counts["broken"])


def drive(program: str, target: Target, count: int, seed: int, folder: Path) -> int:
    folder.mkdir(parents=True, exist_ok=True)
    start, first, broken = time.monotonic(), 0, 0
    at = folder / f"at-{seed}"
    at.unlink(missing_ok=True)
    totals: Counter[str] = Counter()
    while first < count:
        command = [sys.executable, program, "--work", str(first), str(count), "--seed", str(seed)]
        done = subprocess.run([*command, "--folder", str(folder)], stdout=subprocess.PIPE, text=True)
        if done.returncode == 0:
            for name, text in zip(("read", "refused", "broken"), done.stdout.split(), strict=True):
                totals[name] += int(text)
            break
        number = int(at.read_bytes() or b"-1") if at.exists() else -1
        if number < first:
            print("the seeds themselves cannot be made", file=sys.stderr)
            return 1
        broken += 1
        file = finding(target, folder, seed, number)
        save = [sys.executable, program, "--save", str(number), str(file), "--seed", str(seed)]
        subprocess.run(save, check=True)
        ended = f"signal {-done.returncode}" if done.returncode < 0 else f"exit code {done.returncode}"
        print(f"{file}: the process ended with {ended}", file=sys.stderr, flush=True)
        first = number + 1
        if broken >= 20:
            break
    broken += totals["broken"]
    seconds = time.monotonic() - start
    print(
        f"{target.name}: {count} mutations with seed {seed} in {seconds:.0f} s; of those since the last signal "
        f"{totals['read']} read, {totals['refused']} refused; {broken} broken"
    )
    return 1 if broken else 0


def main(doc: str, program: str, target: Target) -> int:
    if sys.argv[1:2] == ["replay"]:
        prepare()
        outcomes = [(file, *target.read(pickle.loads(Path(file).read_bytes()))) for file in sys.argv[2:]]
        for file, outcome, why in outcomes:
            print(f"{file}: {outcome} {why}".rstrip())
        return int(any(outcome == "broken" for _, outcome, _ in outcomes))
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("count", nargs="?", type=float, default=1e4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=Path("build/fuzz"))
    parser.add_argument("--work", nargs=2, type=int, help=argparse.SUPPRESS)
    parser.add_argument("--save", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work or options.save:
        prepare()
    if options.work:
        work(target, *options.work, options.seed, options.folder)
        return 0
    if options.save:
        case = target.case_of(target.seeds(), options.seed, int(options.save[0]))
        Path(options.save[1]).write_bytes(pickle.dumps(case))
        return 0
    return drive(program, target, int(options.count), options.seed, options.folder)
