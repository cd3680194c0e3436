"""Who does the work: this process, several of them, or a Dask cluster."""

from __future__ import annotations

import signal
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from importlib import import_module
from multiprocessing import get_context
from typing import Any

from tmm_cli.language import _, language, speaking
from tmm_cli.problem.errors import ProblemError, quote

RETRIES = 3  # of what a cluster failed at
ANSWERS = 10  # s within which a scheduler answers

Job = Callable[[], Any]  # may be pickled
Stopped = Callable[[], bool]
Way = Callable[[Sequence[Job], Stopped], Iterator[tuple[int, Any]]]  # numbers of jobs and what they gave, as it comes


def here(jobs: Sequence[Job], stopped: Stopped) -> Iterator[tuple[int, Any]]:
    """One after the other."""
    for number, job in enumerate(jobs):
        if stopped():
            return
        yield number, job()


def processes(count: int) -> Way:
    """In so many processes; when stopped, what they have begun comes to its end."""
    return partial(_processes, count)


def _processes(count: int, jobs: Sequence[Job], stopped: Stopped) -> Iterator[tuple[int, Any]]:
    count = min(count, len(jobs))
    if count < 2:
        yield from here(jobs, stopped)
        return
    with ProcessPoolExecutor(count, get_context("spawn"), begin) as pool:
        futures = {pool.submit(speaking, language(), job): number for number, job in enumerate(jobs)}
        for future in as_completed(futures):
            if not future.cancelled():
                try:
                    yield futures[future], future.result()
                except BrokenProcessPool:
                    raise ProblemError(_("a process of the work was ended"), allowed="--jobs 1") from None
            if stopped():
                pool.shutdown(wait=False, cancel_futures=True)


def begin() -> None:
    """Ctrl-C reaches all processes: the first one tells the others. What has no value is told in words."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore", RuntimeWarning)


def cluster(address: str) -> Way:
    """On the workers of a Dask scheduler, which gives the work of a lost one to the others."""
    return partial(_cluster, address)


def _cluster(address: str, jobs: Sequence[Job], stopped: Stopped) -> Iterator[tuple[int, Any]]:
    try:
        distributed: Any = import_module("distributed")  # typed in part alone
    except ImportError:
        raise ProblemError(_("a cluster needs distributed"), allowed="pip install 'tmm-cli[cluster]'") from None
    try:
        client = distributed.Client(address, timeout=ANSWERS, set_as_default=False)
    except (OSError, ValueError):
        raise ProblemError(_("no scheduler answers there"), found=quote(address), allowed="tcp://host:8786") from None
    with client:
        futures = {
            client.submit(speaking, language(), job, retries=RETRIES, pure=False): number
            for number, job in enumerate(jobs)
        }
        for future in distributed.as_completed(futures, loop=client.loop):
            yield futures[future], future.result()
            if stopped():
                return
