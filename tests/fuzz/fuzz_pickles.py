"""Changes pickles of all kinds of values, and reads them: each must become a value, or an InputError in one line.

fuzz_pickles.py [COUNT] [--seed N] [--folder FOLDER]: COUNT mutations in all, over the kinds in turn. Each is a function
of seed and number, so that a run can be repeated. A process of its own does the work; one that a signal ends, or that
takes too long, leaves the number it was at, and the next one goes on behind it.
fuzz_pickles.py replay FILE...: reads what was saved of a finding.

`./run fuzz pickles` runs it with an extension that has sanitizers: REALCAM_CORE is the path of that extension.
"""

from __future__ import annotations

import argparse
import importlib.abc
import importlib.machinery
import importlib.util
import os
import pickle
import random
import signal
import subprocess
import sys
import time
import traceback
from collections import Counter
from pathlib import Path
from types import ModuleType
from typing import Any

LONGEST_S = 60  # a thousand times what one takes


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
    sys.path[:0] = [str(here), str(here.parent / "python")]


def read(case: tuple[Any, ...]) -> tuple[str, str]:
    """What became of it ("read", "refused" or "broken"), and why that is broken."""
    import realcam as rc
    from look_at import look_at
    from realcam import pickling

    kind, arguments = case
    try:
        if kind == "restored":
            value = pickling.restored(*arguments)
        else:
            value = object.__new__(getattr(rc, kind))
            value.__setstate__(arguments)
    except rc.InputError as error:
        one_line = "\n" not in str(error) and len(str(error)) < 2500
        return ("refused", "") if one_line else ("broken", "a message of several lines, or a long one")
    except BaseException:
        return "broken", traceback.format_exc(limit=-3)
    try:
        look_at(value)
    except BaseException:
        return "broken", f"once read: {traceback.format_exc(limit=-3)}"
    return "read", ""


def seeds() -> list[tuple[Any, ...]]:
    """What pickles of all kinds hold: the arguments of `restored`, or the fields of a value that is Python's."""
    from picklable_values import ALL_MAKERS
    from realcam import pickling

    cases: list[tuple[Any, ...]] = []
    for kind, makers in sorted(ALL_MAKERS.items()):
        for make in makers:
            function, arguments, *state = make().__reduce_ex__(4)
            cases.append(("restored", arguments) if function is pickling.restored else (kind, state[0]))
    return cases


def case_of(cases: list[tuple[Any, ...]], seed: int, number: int) -> tuple[Any, ...]:
    from mutate_state import OTHERS, mutated

    draw = random.Random(seed * 2**40 + number)
    kind, arguments = cases[number % len(cases)]
    if kind == "restored":
        name, *versions, state = arguments
        if draw.random() < 0.02:
            at, head = draw.randrange(3), [name, *versions]
            head[at] = draw.choice((*OTHERS, mutated((head[at],), draw)))
            return kind, (*head, state)
        return kind, (name, *versions, mutated(state, draw))
    field = draw.choice(sorted(arguments))
    if draw.random() < 0.2:
        return kind, draw.choice((*OTHERS, {k: v for k, v in arguments.items() if k != field}))
    return kind, {**arguments, field: mutated(arguments[field], draw)}


def work(first: int, last: int, seed: int, folder: Path) -> None:
    """Prints what became of all: a line that a program reads."""
    cases = seeds()
    counts: Counter[str] = Counter()
    with (folder / f"at-{seed}").open("wb", buffering=0) as at:
        for number in range(first, last):
            at.seek(0)
            at.write(b"%20d" % number)
            case = case_of(cases, seed, number)
            signal.alarm(LONGEST_S)
            outcome, why = read(case)
            signal.alarm(0)
            counts[outcome] += 1
            if outcome == "broken":
                file = folder / f"pickle-{seed}-{number}.pkl"
                file.write_bytes(pickle.dumps(case))
                print(f"{file}: {why}", file=sys.stderr, flush=True)
    print(counts["read"], counts["refused"], counts["broken"])


def drive(count: int, seed: int, folder: Path) -> int:
    folder.mkdir(parents=True, exist_ok=True)
    start, first, broken = time.monotonic(), 0, 0
    at = folder / f"at-{seed}"
    at.unlink(missing_ok=True)
    totals: Counter[str] = Counter()
    while first < count:
        command = [sys.executable, __file__, "--work", str(first), str(count), "--seed", str(seed)]
        done = subprocess.run([*command, "--folder", str(folder)], stdout=subprocess.PIPE, text=True)
        if done.returncode == 0:
            for name, text in zip(("read", "refused", "broken"), done.stdout.split(), strict=True):
                totals[name] += int(text)
            break
        number = int(at.read_bytes() or b"-1") if at.exists() else -1
        if number < first:
            print("the values themselves cannot be made", file=sys.stderr)
            return 1
        broken += 1
        file = folder / f"pickle-{seed}-{number}.pkl"
        save = [sys.executable, __file__, "--save", str(number), str(file), "--seed", str(seed)]
        subprocess.run(save, check=True)
        ended = f"signal {-done.returncode}" if done.returncode < 0 else f"exit code {done.returncode}"
        print(f"{file}: the process ended with {ended}", file=sys.stderr, flush=True)
        first = number + 1
        if broken >= 20:
            break
    broken += totals["broken"]
    seconds = time.monotonic() - start
    print(
        f"pickles: {count} mutations with seed {seed} in {seconds:.0f} s; of those since the last signal "
        f"{totals['read']} read, {totals['refused']} refused; {broken} broken"
    )
    return 1 if broken else 0


def main() -> int:
    if sys.argv[1:2] == ["replay"]:
        prepare()
        outcomes = [(file, *read(pickle.loads(Path(file).read_bytes()))) for file in sys.argv[2:]]
        for file, outcome, why in outcomes:
            print(f"{file}: {outcome} {why}".rstrip())
        return int(any(outcome == "broken" for _, outcome, _ in outcomes))
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("count", nargs="?", type=float, default=1e4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=Path("build/fuzz"))
    parser.add_argument("--work", nargs=2, type=int, help=argparse.SUPPRESS)
    parser.add_argument("--save", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work or options.save:
        prepare()
    if options.work:
        work(*options.work, options.seed, options.folder)
        return 0
    if options.save:
        Path(options.save[1]).write_bytes(pickle.dumps(case_of(seeds(), options.seed, int(options.save[0]))))
        return 0
    return drive(int(options.count), options.seed, options.folder)


if __name__ == "__main__":
    sys.exit(main())
