"""Progress bars on stderr; silent if it is not a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn


@contextmanager
def progress_bar(title: str, is_shown: bool = True) -> Iterator[Callable[[float], bool]]:
    """Yields a function to call with the finished fraction, 0 to 1, which returns True."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not (is_shown and console.is_terminal)) as bars:
        task = bars.add_task(title, total=1.0)

        def report(done: float) -> bool:
            bars.update(task, completed=done)
            return True

        yield report
