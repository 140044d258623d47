"""Executors of Dask, which has schedulers for this machine, for clusters and for what is set up elsewhere."""

from __future__ import annotations

import concurrent.futures
import logging
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from .._core import InputError
from ..extras import imported

_ANSWERS_WITHIN_S = 20


@contextmanager
def dask_executor(
    *, workers: int, threads: int = 1, scheduler: str | None = None, batch_system: str | None = None
) -> Iterator[concurrent.futures.Executor]:
    """An executor whose processes each take one unit at a time.

    scheduler: the address of one that runs already, "tcp://head:8786" or a scheduler file, .json; workers counts for
    nothing then. batch_system: "slurm" or "pbs", whose workers are jobs of it, as the user's settings of dask-jobqueue
    describe them. None: so many processes of this machine, each with so many threads.
    Raises InputError where Dask is missing or no scheduler answers.
    """
    distributed = imported("distributed", "cluster")
    with ExitStack() as stack:
        # Workers that come and go are told of by the job itself.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        try:
            if scheduler is not None and scheduler.endswith(".json"):
                Path(scheduler).stat()  # for which Dask would wait
                source: Any = {"scheduler_file": scheduler}
            elif scheduler is not None:
                source = {"address": scheduler}
            elif batch_system is not None:
                source = {"address": stack.enter_context(_batch_cluster(batch_system, workers))}
            else:
                cluster = distributed.LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    processes=True,
                    memory_limit=0,  # scenes are large, and a worker that is ended for it comes again and again
                    dashboard_address=None,
                    silence_logs=logging.CRITICAL,
                )
                source = {"address": stack.enter_context(cluster)}
            client = stack.enter_context(distributed.Client(**source, timeout=_ANSWERS_WITHIN_S, set_as_default=False))
        except InputError:  # which is a ValueError
            raise
        except (OSError, TimeoutError, ValueError) as error:
            where = scheduler or batch_system or "this machine"
            raise InputError(f"{where}: no Dask scheduler answers there: {_line_of(error)}") from None
        except RuntimeError as error:  # a process was ended before it was ready
            raise InputError(f"this machine: Dask's worker processes did not start: {_line_of(error)}") from None
        yield client.get_executor(pure=False)


def has_dask() -> bool:
    return find_spec("distributed") is not None


def _batch_cluster(batch_system: str, workers: int) -> Any:
    kinds = {"slurm": "SLURMCluster", "pbs": "PBSCluster"}
    if batch_system not in kinds:
        raise InputError(f'unknown batch system "{batch_system:.40}"; one of {", ".join(kinds)} is wanted')
    kind = getattr(imported("dask_jobqueue", "cluster"), kinds[batch_system])
    try:
        cluster = kind()
    except ValueError:  # its message is an example of Python
        raise InputError(
            f"{batch_system}: dask-jobqueue has to know the cores and the memory of a worker; "
            f"jobqueue: {batch_system}: with cores and memory is wanted in ~/.config/dask/jobqueue.yaml"
        ) from None
    cluster.scale(workers)
    # dask-jobqueue swallows what the batch system answers, and waits for ever.
    ends = time.monotonic() + _ANSWERS_WITHIN_S
    while not any(job.job_id for job in cluster.workers.values()):
        if time.monotonic() > ends:
            with suppress(AssertionError):  # closing asserts that all jobs were accepted
                cluster.close()
            raise InputError(
                f"{batch_system}: no job of a worker was accepted in {_ANSWERS_WITHIN_S} s; cores, memory and queue of "
                f"jobqueue: {batch_system}: in ~/.config/dask/jobqueue.yaml have to be what the cluster offers"
            )
        time.sleep(0.1)
    return cluster


def _line_of(error: BaseException) -> str:
    text = error.strerror if isinstance(error, FileNotFoundError) else str(error)
    return (text or "").strip().partition("\n")[0] or type(error).__name__
