"""Drawing on all cores, with a progress bar."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import TypeVar

from tmm_cli.batch import initialize_worker
from tmm_cli.cli.common import progress_bars
from tmm_cli.drawing.formats import run_in_process
from tmm_cli.language import _, course, speaking

FORKS = sys.platform == "linux"  # there a process begins as a copy of this one, with all that it has loaded
LEAST_JOBS = 2 if FORKS else 4  # jobs that are done before other processes have started

JobResult = TypeVar("JobResult")


def run_on_all_cores(jobs: Sequence[Callable[[], JobResult]], *, quiet: bool = False) -> Iterable[JobResult]:
    """Yield the results of jobs in their order, computed by all cores. quiet: no progress bar.

    Other processes start at the end of the list, while this one starts at its beginning.
    """
    others = min(os.cpu_count() or 1, len(jobs)) - 1
    if others < 1 or len(jobs) < LEAST_JOBS:
        yield from run_in_process(jobs)
        return
    with ProcessPoolExecutor(others, get_context("fork" if FORKS else "spawn"), initialize_worker) as pool:
        futures = [
            pool.submit(speaking, course(), job) for job in reversed(jobs)
        ]  # before the bar has its thread: threads are not copied
        try:
            with progress_bars(quiet) as progress:
                task = progress.add_task(_("drawn"), total=len(jobs))
                for job, future in zip(jobs, reversed(futures), strict=True):
                    yield job() if future.cancel() else _fetch_result(future, job)
                    progress.advance(task)
        finally:  # stopped: what is in work comes to its end
            pool.shutdown(wait=False, cancel_futures=True)


def _fetch_result(future: Future[JobResult], job: Callable[[], JobResult]) -> JobResult:
    """Result of another process; if that was killed, for instance by lack of memory, the job is done here."""
    try:
        return future.result()
    except BrokenProcessPool:
        return job()
