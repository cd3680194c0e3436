"""Calls that may exhaust the memory or abort, in one process that is started again after its end."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import ParamSpec, TypeVar

if sys.platform != "win32":
    import resource

P = ParamSpec("P")
T = TypeVar("T")


class ProcessEndedError(Exception):
    """The process ended before it answered."""


class GuardedProcess:
    """A process for calls, one after another; it starts with the first call.

    memory: bytes of address space that the process may take, where the system has such a limit (POSIX).
    """

    def __init__(self, memory: int) -> None:
        self._memory = memory
        self._pool: ProcessPoolExecutor | None = None

    def call(self, function: Callable[P, T], *args: P.args, **named: P.kwargs) -> T:
        """What the function returns, or the exception that it raises; both are pickled.

        Raises:
            ProcessEndedError: the process was ended, for example for want of memory. The next call starts another one.
        """
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, get_context("spawn"), _limit, (self._memory,))
        try:
            return self._pool.submit(function, *args, **named).result()
        except BrokenProcessPool:
            self._pool.shutdown(wait=False)
            self._pool = None
            raise ProcessEndedError from None


def _limit(memory: int) -> None:
    """Limit the memory of this process and silence its last words; Ctrl-C is for the first process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    if sys.platform != "win32":
        __, most = resource.getrlimit(resource.RLIMIT_AS)
        limit = memory if most == resource.RLIM_INFINITY else min(memory, most)
        resource.setrlimit(resource.RLIMIT_AS, (limit, most))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
