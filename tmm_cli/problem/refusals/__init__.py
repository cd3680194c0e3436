"""What a stage refuses, in the words and at the place of the file: a file for a subject, a function for a refusal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from tmm_cli.errors import LinkageError
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.record import Problem
from tmm_cli.problem.refusals import assembly, cycle, dynamics, names
from tmm_cli.problem.refusals.wording import worded

__all__ = ["assembly", "cycle", "dynamics", "in_words_of", "names", "refusal"]


@contextmanager
def in_words_of(problem: Problem) -> Iterator[None]:
    """What a stage refuses inside is said in the terms of the file. Raises ProblemError."""
    try:
        yield
    except LinkageError as error:
        raise refusal(error, problem) from None


def refusal(error: LinkageError, problem: Problem) -> ProblemError:
    """A stage's refusal in the words and at the place of the file."""
    found = worded(error, problem)
    return found.located(problem.file, problem.source) if problem.file else found
