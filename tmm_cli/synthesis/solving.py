"""Public API: load, solve and prepare problems.

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

    A synthesis task is solved only when the dimensions that it finds are needed: by `solve`, `prepare`, `linkage`.
    """
    return build_any_problem(read_file(path))


def solve(
    problem: Problem | TaskProblem,
    stage: Literal["structure", "kinematics", "forces"] = "forces",
    positions: Sequence[int] | None = None,
    of: Sequence[str] = (),
) -> Results:
    """Compute a problem up to a stage, at all positions of the file or at those numbered. Raises ProblemError.

    of: names of points, links and centres of mass (E, 5, S3); only the groups that these depend on are solved.
    """
    whole = problem.whole
    with translate_errors(whole):
        results = pipeline.solve(inputs_of(whole), stage, positions, of, whole)
    if not whole.request.centres or results.motion is None or of:
        return results
    from tmm_cli.mechanics.analysis import with_centres  # few files ask for them

    return with_centres(results)


def structure_of(problem: Problem | TaskProblem) -> Results:
    """Compute the structure alone; a synthesis task is solved only if lengths are needed. Raises ProblemError."""
    draft = problem.draft() if isinstance(problem, TaskProblem) else None
    if draft is not None:
        try:
            return pipeline.solve(replace(inputs_of(draft), sized=False), "structure", problem=draft)
        except LinkageError:
            pass  # the placeholder lengths may be the cause: solve with the real ones
    return solve(problem, "structure")


def inputs_of(problem: Problem) -> Inputs:
    """Return the inputs of the computing stages for a problem."""
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
    """Inputs as double-doubles, built on first use; a class, so that results can be sent to other processes."""

    problem: Callable[[], Problem]

    def __call__(self) -> Inputs:
        return self._made

    @cached_property
    def _made(self) -> Inputs:
        return inputs_of(self.problem())


def count(problem: ChainProblem) -> ChainResults:
    """Count links, pairs and mobility of a problem that specifies its chain by pairs only."""
    return ChainResults(problem, count_chain(problem.chain, problem.output, problem.local, problem.wanted))


def redrive(problem: Problem | TaskProblem, link: str) -> Problem:
    """Return the problem with another link on the frame as the driver, from the same sketch. Raises ProblemError.

    Everything tied to the driver of the file is dropped: law of motion, balancing, wheels, loads by its angle.
    """
    whole = problem.whole
    with translate_errors(whole):
        linkage = with_driver(whole.linkage, link)
    loads = tuple(
        load for load in linkage.loads if load.window is None and (load.table is None or load.table.against == "stroke")
    )
    linkage, request = replace(linkage, loads=loads, turns=1), replace(whole.request, places=(), start=0.0)
    return replace(
        whole, linkage=linkage, request=request, extended=None, dynamics=None, balancing=None, wheels=(), shows={}
    )


def prepare(problems: Sequence[Problem | TaskProblem] | Problem | TaskProblem) -> Batch:
    """Prepare problems that differ only in their numbers, to be solved together at any driver coordinates.

    Loads of a working stroke act always, unless there is only one problem. Raises ProblemError.
    """
    from tmm_cli.batch import prepare_batch  # late: loads the traced calculation

    several = [member.whole for member in (problems if isinstance(problems, Sequence) else (problems,))]
    for member in several:
        refuse_variable_speed(member.linkage.driver.law is not None, member.dynamics is not None)
    with translate_errors(several[0]):
        strokes = pipeline.solve(inputs_of(several[0]), "kinematics").strokes if len(several) == 1 else None
        return prepare_batch([problem.linkage for problem in several], strokes=strokes)
