"""Changes pickles of all kinds of values, and reads them: each must become a value, or an InputError in one line.

See many_mutations.py. `./run fuzz pickles` runs it with an extension that has sanitizers.
"""

from __future__ import annotations

import random
import sys
import traceback
from typing import Any

from many_mutations import Target, main


def read(case: tuple[Any, ...]) -> tuple[str, str]:
    """Reads a case. Returns "read", "refused" or "broken", and the reason if it is broken."""
    import realcam as rc
    from look_at import look_at
    from realcam import pickling

    try:
        value = pickling.restored(*case)
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
    """Contents of pickles of all kinds: the arguments of `restored`."""
    from picklable_values import ALL_MAKERS

    return [make().__reduce__()[1] for _, makers in sorted(ALL_MAKERS.items()) for make in makers]


def case_of(cases: list[tuple[Any, ...]], seed: int, number: int) -> tuple[Any, ...]:
    from mutate_state import OTHERS, mutated

    draw = random.Random(seed * 2**40 + number)
    *head, state = cases[number % len(cases)]
    if draw.random() < 0.02:
        at = draw.randrange(len(head))
        head[at] = draw.choice((*OTHERS, mutated((head[at],), draw)))
        return (*head, state)
    return (*head, mutated(state, draw))


if __name__ == "__main__":
    sys.exit(main(__doc__ or "", __file__, Target("pickles", seeds, case_of, read)))
