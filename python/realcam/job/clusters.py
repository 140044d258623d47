"""Dask executors, with a scheduler on this machine or elsewhere."""

from __future__ import annotations

import concurrent.futures
import logging
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from .._core import InputError
from ..installation import imported

_TIMEOUT_S = 20  # for the connection to a scheduler


@contextmanager
def dask_executor(*, workers: int, scheduler: str | None = None) -> Iterator[concurrent.futures.Executor]:
    """An executor whose processes each take one unit at a time.

    scheduler: address of a running scheduler, "tcp://head:8786" or a scheduler file (.json), whose workers are used;
    None: `workers` processes of this machine. Raises InputError if Dask is missing or no scheduler answers.
    """
    distributed = imported("distributed", "cluster")
    with ExitStack() as stack:
        # The job itself reports workers that come and go.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        try:
            if scheduler is not None and scheduler.endswith(".json"):
                Path(scheduler).stat()  # fails at once if the file is missing; Dask would wait for it
                source: Any = {"scheduler_file": scheduler}
            elif scheduler is not None:
                source = {"address": scheduler}
            else:
                cluster = distributed.LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    processes=True,
                    memory_limit=0,  # scenes are large, and Dask would kill and restart workers over and over
                    dashboard_address=None,
                    silence_logs=logging.CRITICAL,
                )
                source = {"address": stack.enter_context(cluster)}
            client = stack.enter_context(distributed.Client(**source, timeout=_TIMEOUT_S, set_as_default=False))
        except (OSError, TimeoutError, ValueError) as error:
            location = scheduler or "this machine"
            raise InputError(f"{location}: no Dask scheduler answers there: {_line_of(error)}") from None
        except RuntimeError as error:  # a process was ended before it was ready
            raise InputError(f"this machine: Dask's worker processes did not start: {_line_of(error)}") from None
        yield client.get_executor(pure=False)


def has_dask() -> bool:
    """True if Dask is installed."""
    return find_spec("distributed") is not None


def _line_of(error: BaseException) -> str:
    """First line of an error's message, or its type."""
    text = error.strerror if isinstance(error, FileNotFoundError) else str(error)
    return (text or "").strip().partition("\n")[0] or type(error).__name__
