"""Drawing by all cores, with a progress bar."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context

from tmm_cli.cli.common import bars
from tmm_cli.draw.formats import Job, Written, here
from tmm_cli.errors import _
from tmm_cli.grading.workers import begin

FEW = 6  # jobs that are done before other processes have started


def by_all_cores(jobs: Sequence[Job], *, quiet: bool = False) -> Iterable[tuple[Written, set[str]]]:
    """What the jobs give, in their order; a few are done in this process. quiet: without a bar."""
    count = min(os.cpu_count() or 1, len(jobs))
    if count < 2 or len(jobs) < FEW:
        yield from here(jobs)
        return
    done = 0
    with bars(quiet) as shown, ProcessPoolExecutor(count, get_context("spawn"), begin) as pool:
        task = shown.add_task(_("drawn"), total=len(jobs))
        futures = [pool.submit(job) for job in jobs]
        try:
            for future in futures:
                yield future.result()
                done += 1
                shown.advance(task)
        except BrokenProcessPool:  # ended from outside, perhaps for want of memory
            yield from here(jobs[done:])
        finally:  # stopped: what is in work comes to its end
            pool.shutdown(wait=False, cancel_futures=True)
