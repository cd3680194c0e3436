"""Public API: load, solve and prepare problems.

All values are in SI units and radians. Invalid input raises `tmm_cli.problem.errors.ProblemError`.
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
    """Read and check a problem file.

    A synthesis task is solved later, when its dimensions are needed: by `solve`, `prepare` or the attribute `linkage`.

    Args:
        path: path of the file.

    Raises:
        ProblemError: the file is invalid.
    """
    return build_any_problem(read_file(path))


def solve(
    problem: Problem | TaskProblem,
    stage: Literal["structure", "kinematics", "forces"] = "forces",
    positions: Sequence[int] | None = None,
    of: Sequence[str] = (),
) -> Results:
    """Compute a problem up to a stage.

    Args:
        problem: problem, as returned by `load`.
        stage: last stage to compute.
        positions: numbers of the positions to compute; None for all positions of the file.
        of: names of points, links and centres of mass (E, 5, S3). If given, only the Assur groups on which these depend
            are solved.

    Raises:
        ProblemError: the mechanism cannot be computed.
    """
    whole = problem.whole
    with translate_errors(whole):
        results = pipeline.solve(inputs_of(whole), stage, positions, of, whole)
    if not whole.request.centres or results.motion is None or of:
        return results
    from tmm_cli.mechanics.analysis import with_centres  # few files ask for them

    return with_centres(results)


def structure_of(problem: Problem | TaskProblem) -> Results:
    """Compute only the structure of a mechanism.

    A synthesis task is solved only if the structure depends on its lengths.

    Raises:
        ProblemError: the mechanism is invalid.
    """
    draft = problem.draft() if isinstance(problem, TaskProblem) else None
    if draft is not None:
        try:
            return pipeline.solve(replace(inputs_of(draft), sized=False), "structure", problem=draft)
        except LinkageError:
            pass  # the placeholder lengths may be the cause: solve with the real ones
    return solve(problem, "structure")


def inputs_of(problem: Problem) -> Inputs:
    """Return the input data of the analysis for a problem."""
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
    """Function object that builds the input data of the analysis with double-double numbers, when it is first called.

    It is a class and not a closure, so that results can be sent to other processes.
    """

    problem: Callable[[], Problem]

    def __call__(self) -> Inputs:
        return self._made

    @cached_property
    def _made(self) -> Inputs:
        return inputs_of(self.problem())


def count(problem: ChainProblem) -> ChainResults:
    """Compute the mobility of a spatial chain, which its problem file describes only by links and pairs."""
    return ChainResults(problem, count_chain(problem.chain, problem.output, problem.local, problem.wanted))


def redrive(problem: Problem | TaskProblem, link: str) -> Problem:
    """Return the problem with another link on the frame as the driver, assembled from the same sketch.

    Everything that depends on the original driver is removed: law of motion, balancing, intermittently driven wheels,
    and loads that depend on the driver angle.

    Args:
        problem: problem, as returned by `load`.
        link: name of the new driver.

    Raises:
        ProblemError: the link cannot be the driver.
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

    Loads limited to a working stroke act at all positions if there are several problems.

    Args:
        problems: one problem or several, as returned by `load`.

    Raises:
        ProblemError: a problem is invalid, or its driver does not run at constant speed.
    """
    from tmm_cli.batch import prepare_batch  # late: loads the traced calculation

    several = [member.whole for member in (problems if isinstance(problems, Sequence) else (problems,))]
    for member in several:
        refuse_variable_speed(member.linkage.driver.law is not None, member.dynamics is not None)
    with translate_errors(several[0]):
        strokes = pipeline.solve(inputs_of(several[0]), "kinematics").strokes if len(several) == 1 else None
        return prepare_batch([problem.linkage for problem in several], strokes=strokes)
