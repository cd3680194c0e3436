"""Drawing on all processor cores, with a progress bar."""

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

FORKS = sys.platform == "linux"  # a forked process starts with all modules that this one has loaded
LEAST_JOBS = 2 if FORKS else 4  # fewer jobs are finished before other processes have started

JobResult = TypeVar("JobResult")


def run_on_all_cores(jobs: Sequence[Callable[[], JobResult]], *, quiet: bool = False) -> Iterable[JobResult]:
    """Run jobs on all cores and yield their results in the order of the jobs.

    The worker processes begin with the last jobs while this process begins with the first.

    Args:
        jobs: functions without arguments.
        quiet: show no progress bar.
    """
    others = min(os.cpu_count() or 1, len(jobs)) - 1
    if others < 1 or len(jobs) < LEAST_JOBS:
        yield from run_in_process(jobs)
        return
    with ProcessPoolExecutor(others, get_context("fork" if FORKS else "spawn"), initialize_worker) as pool:
        futures = [
            pool.submit(speaking, course(), job) for job in reversed(jobs)
        ]  # before the progress bar starts its thread: a fork does not copy threads
        try:
            with progress_bars(quiet) as progress:
                task = progress.add_task(_("drawings finished"), total=len(jobs))
                for job, future in zip(jobs, reversed(futures), strict=True):
                    yield job() if future.cancel() else _fetch_result(future, job)
                    progress.advance(task)
        finally:  # after an interruption running jobs are completed
            pool.shutdown(wait=False, cancel_futures=True)


def _fetch_result(future: Future[JobResult], job: Callable[[], JobResult]) -> JobResult:
    """Return the result of a worker process; if the process was killed (e.g. for lack of memory), run the job here."""
    try:
        return future.result()
    except BrokenProcessPool:
        return job()
