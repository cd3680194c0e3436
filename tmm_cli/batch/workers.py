"""Workers for independent jobs: this process, several processes, or a Dask cluster."""

from __future__ import annotations

import logging
import re
import signal
import socket
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from functools import cache, partial
from hashlib import blake2b
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import tmm_cli
from tmm_cli.language import CourseNotation, _, course, speaking
from tmm_cli.problem import ProblemError, quote

RETRIES = 3  # of a failed job of a cluster
ANSWER_TIMEOUT = 10  # s: limit for an answer of the scheduler, and for a worker to appear
POLL = 0.02  # s
SCHEDULER = re.compile(
    r"(?:tcp://)?(?:\[[\da-fA-F:.%]+\]|[\w.-]+):\d{1,5}"
)  # TLS needs certificates, which are not read

Job = Callable[[], Any]  # may be pickled
Stopped = Callable[[], bool]
JobRunner = Callable[
    [Sequence[Job], Stopped], Iterator[tuple[int, Any]]
]  # numbers of jobs and their results, in order of completion


def run_here(jobs: Sequence[Job], stopped: Stopped) -> Iterator[tuple[int, Any]]:
    """Run jobs one after another in this process."""
    for number, job in enumerate(jobs):
        if stopped():
            return
        yield number, job()


def in_processes(count: int) -> JobRunner:
    """Return a function that runs jobs in this many processes.

    If the run is stopped, the jobs that have already been started are completed.
    """
    return partial(_processes, count)


def _processes(count: int, jobs: Sequence[Job], stopped: Stopped) -> Iterator[tuple[int, Any]]:
    count = min(count, len(jobs))
    if count < 2:
        yield from run_here(jobs, stopped)
        return
    with ProcessPoolExecutor(count, get_context("spawn"), initialize_worker) as pool:
        futures = {pool.submit(speaking, course(), job): number for number, job in enumerate(jobs)}
        for future in as_completed(futures):
            if not future.cancelled():
                try:
                    yield futures[future], future.result()
                except BrokenProcessPool:
                    raise ProblemError(
                        _("the operating system stopped a worker process, perhaps for lack of memory"),
                        allowed="--jobs 1",
                    ) from None
            if stopped():
                pool.shutdown(wait=False, cancel_futures=True)


def initialize_worker() -> None:
    """Ignore Ctrl-C, which the main process handles, and numerical runtime warnings."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore", RuntimeWarning)


def on_cluster(address: str) -> JobRunner:
    """Return a function that runs jobs on the workers of a Dask scheduler. Jobs of lost workers are run again."""
    return partial(_cluster, address)


def _cluster(address: str, jobs: Sequence[Job], stopped: Stopped) -> Iterator[tuple[int, Any]]:
    try:
        distributed: Any = import_module("distributed")  # only partly typed
    except ImportError:
        raise ProblemError(
            _("running on a cluster requires the package `distributed`"), allowed="pip install 'tmm-cli[cluster]'"
        ) from None
    for library in ("distributed", "asyncio"):
        logging.getLogger(library).setLevel(logging.CRITICAL)  # failures are reported by this function
    if not SCHEDULER.fullmatch(address):  # distributed would wait, and complain at the end of the program
        raise ProblemError(
            _("this is not a valid address of a Dask scheduler"), found=quote(address), allowed="tcp://host:8786"
        )
    try:
        _wait_for_greeting(address)
        client = distributed.Client(address, timeout=ANSWER_TIMEOUT, set_as_default=False)
    except (OSError, ValueError, OverflowError):
        raise ProblemError(
            _("no Dask scheduler answers at this address"), found=quote(address), allowed="tcp://host:8786"
        ) from None
    with client:
        _refuse_other_programs(client, address)
        futures = {
            client.submit(_run_with_same_program, program_digest(), course(), job, retries=RETRIES, pure=False): number
            for number, job in enumerate(jobs)
        }
        for future in _iterate_finished(
            client, distributed.as_completed(futures, loop=client.loop), len(futures), address
        ):
            yield futures[future], _fetch_result(client, future, address)
            if stopped():
                return


def _fetch_result(client: Any, future: Any, address: str) -> Any:
    """Fetch the result of a finished job, even if its worker was lost meanwhile.

    Raises:
        ProblemError: no worker is left.
    """
    while True:
        try:
            return future.result(timeout=ANSWER_TIMEOUT)
        except TimeoutError:
            if not client.nthreads():
                raise _no_workers_error(address) from None


def _wait_for_greeting(address: str) -> None:
    """Wait until the Dask scheduler answers; a Dask client would wait forever for an address without a scheduler.

    Raises:
        OSError: no scheduler answers.
    """
    host, __, port = address.removeprefix("tcp://").rpartition(":")
    with socket.create_connection((host.strip("[]"), int(port)), timeout=ANSWER_TIMEOUT) as connection:
        if not connection.recv(1):
            raise ConnectionError


def _iterate_finished(client: Any, completed: Any, count: int, address: str) -> Iterator[Any]:
    """Yield futures as they finish.

    Raises:
        ProblemError: there has been no worker for too long.
    """
    worked = queried = time.monotonic()
    while count:
        batch = completed.next_batch(block=False)
        count -= len(batch)
        yield from batch
        now = time.monotonic()
        if batch:
            worked = now
            continue
        if now - queried > ANSWER_TIMEOUT / 10:
            queried = now
            worked = now if client.nthreads() else worked
            if now - worked > ANSWER_TIMEOUT:
                raise _no_workers_error(address)
        time.sleep(POLL)


def _refuse_other_programs(client: Any, address: str) -> None:
    """Check that all workers have the same version of the program, since another version might mark differently.

    Raises:
        ProblemError: a worker has another version.
    """

    def version_there() -> tuple[str, str]:  # pickled by value: the worker may have no such function
        try:
            module = import_module("tmm_cli.batch.workers")
            return import_module("tmm_cli").__version__, module.program_digest()
        except (ImportError, AttributeError):
            return "", ""

    try:
        client.wait_for_workers(1, timeout=ANSWER_TIMEOUT)
        versions = client.run(version_there)
    except TimeoutError:
        raise _no_workers_error(address) from None
    expected = (tmm_cli.__version__, program_digest())
    other = next(((worker, reported) for worker, reported in versions.items() if reported != expected), None)
    if other is not None:
        worker, (version, digest) = other
        installed = (
            f"tmm {version} ({digest[:8]})"
            if version
            else _("tmm is not installed there, or its version is too old for this check")
        )
        raise ProblemError(
            _("a worker of the cluster has a different version of tmm"),
            found=f"{worker}: {installed}",
            allowed=_("{version} on each worker of the cluster").format(
                version=f"tmm {expected[0]} ({expected[1][:8]})"
            ),
        )


def _no_workers_error(address: str) -> ProblemError:
    return ProblemError(_("the Dask scheduler has no workers"), found=quote(address), allowed=f"dask worker {address}")


def _run_with_same_program(program: str, spoken: CourseNotation, job: Job) -> Any:
    """Run a job on a worker after checking its version again, since workers may join later.

    Raises:
        ProblemError: the worker has another version.
    """
    if program_digest() != program:
        raise ProblemError(_("a worker of the cluster has a different version of tmm"))
    return speaking(spoken, job)


@cache
def program_digest() -> str:
    """Return a hash of the program and its translations, to detect a version that might mark differently."""
    folder = Path(tmm_cli.__file__).parent
    files = sorted(folder.rglob("*.[pm][yo]"), key=lambda file: file.relative_to(folder).as_posix())
    digest = blake2b(digest_size=16)
    for file in files:
        digest.update(file.relative_to(folder).as_posix().encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()
