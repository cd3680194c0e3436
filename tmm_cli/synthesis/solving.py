"""What the package offers: problems read, computed, driven by another link, prepared for many at once.

Everything is in SI and radians. Bad input raises `tmm_cli.problem.errors.ProblemError`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from tmm_cli.mechanics.analysis import Inputs, Results, pipeline, with_driver
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.structure import ChainResults, count_chain
from tmm_cli.problem import (
    ChainProblem,
    Problem,
    TaskProblem,
    build_any_problem,
    read_file,
    refuse_variable_speed,
    translate_errors,
)

if TYPE_CHECKING:
    from tmm_cli.batch import Batch


def load(path: str) -> Problem | TaskProblem:
    """Read and check a problem file. Raises ProblemError.

    A task of synthesis is solved when something needs the lengths that it finds: `solve`, `prepare`, `linkage`.
    """
    return build_any_problem(read_file(path))


def solve(
    problem: Problem | TaskProblem,
    stage: Literal["structure", "kinematics", "forces"] = "forces",
    positions: Sequence[int] | None = None,
    of: Sequence[str] = (),
) -> Results:
    """Compute up to a stage, at all positions of the file or at those numbered. Raises ProblemError.

    of: points, links, centres of mass (E, 5, S3) that alone are asked for; only groups on the way to them are solved.
    """
    whole = problem.whole
    with translate_errors(whole):
        results = pipeline.solve(inputs_of(whole), stage, positions, of, whole)
    if not whole.request.centres or results.motion is None or of:
        return results
    from tmm_cli.mechanics.analysis import with_centres  # few files ask for them

    return with_centres(results)


def structure_of(problem: Problem | TaskProblem) -> Results:
    """The structure alone: no task of synthesis is solved for it, unless it hangs on lengths. Raises ProblemError."""
    draft = problem.draft() if isinstance(problem, TaskProblem) else None
    if draft is not None:
        try:
            return pipeline.solve(replace(inputs_of(draft), sized=False), "structure", problem=draft)
        except LinkageError:
            pass  # perhaps for the numbers of the draft: with lengths it may move
    return solve(problem, "structure")


def inputs_of(problem: Problem) -> Inputs:
    """What the stages need of a problem."""
    extended = None if problem.extended is None else ExtendedInputs(problem.extended)
    return Inputs(
        problem.linkage,
        problem.request,
        problem.pressure_limits,
        problem.lever_limit,
        extended,
        dynamics=problem.dynamics,
        balancing=problem.balancing,
        wheels=problem.wheels,
    )


@dataclass(frozen=True)
class ExtendedInputs:
    """The same as double-doubles, made when first asked for; a class, so that results can go to other processes."""

    problem: Callable[[], Problem]

    def __call__(self) -> Inputs:
        return self._made

    @cached_property
    def _made(self) -> Inputs:
        return inputs_of(self.problem())


def count(problem: ChainProblem) -> ChainResults:
    """Count the chain of a problem that gives it by pairs alone."""
    return ChainResults(problem, count_chain(problem.chain, problem.output, problem.local, problem.wanted))


def redrive(problem: Problem | TaskProblem, link: str) -> Problem:
    """The same problem driven by another link on the frame, from the same sketch. Raises ProblemError.

    What hangs on the driver of the file is left out: its law of motion, balancing, wheels, loads by its angle.
    """
    whole = problem.whole
    with translate_errors(whole):
        linkage = with_driver(whole.linkage, link)
    loads = tuple(
        own for own in linkage.loads if own.window is None and (own.table is None or own.table.against == "stroke")
    )
    linkage, request = replace(linkage, loads=loads, turns=1), replace(whole.request, places=(), start=0.0)
    return replace(
        whole, linkage=linkage, request=request, extended=None, dynamics=None, balancing=None, wheels=(), shows={}
    )


def prepare(problems: Sequence[Problem | TaskProblem] | Problem | TaskProblem) -> Batch:
    """Problems that differ in their numbers only, to be solved at any places of the driver (variants.batch.everything).

    Loads of a working stroke act always, unless there is one problem alone. Raises ProblemError.
    """
    from tmm_cli.batch import prepare_batch as every_variant  # and the tape under it

    several = [one.whole for one in (problems if isinstance(problems, Sequence) else (problems,))]
    for one in several:
        refuse_variable_speed(one.linkage.driver.law is not None, one.dynamics is not None)
    with translate_errors(several[0]):
        strokes = pipeline.solve(inputs_of(several[0]), "kinematics").strokes if len(several) == 1 else None
        return every_variant([problem.linkage for problem in several], strokes=strokes)
