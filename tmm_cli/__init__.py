"""The library door of the course-project calculator: `load` a problem file, `solve` it.

    from tmm_cli import load, solve

    results = solve(load("problems/shaper.yaml"))
    results.reactions.balance.moment      # N m, one value a position
    results.motion.named("E").a           # m/s2, complex: x + iy

or, for many places of the driver and many variants at once, `prepare` it:

    batch = prepare([load(path) for path in paths])
    batch(places)["T.1"]                  # N m, (variants, places)

Everything is in SI and radians. Bad input raises `tmm_cli.problem.errors.ProblemError`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from tmm_cli.batch import Batch
    from tmm_cli.pipeline import Results
    from tmm_cli.problem.record import Problem

__version__ = "0.1.0"
__all__ = ["__version__", "load", "prepare", "redrive", "solve"]


def load(path: str) -> Problem:
    """Read, check and build a problem file. Raises ProblemError."""
    from tmm_cli.problem.build import load as read  # inside, so that importing the package stays cheap

    return read(path)


def solve(
    problem: Problem,
    stage: Literal["structure", "kinematics", "forces"] = "forces",
    positions: Sequence[int] | None = None,
    of: Sequence[str] = (),
) -> Results:
    """Compute up to a stage, at all positions of the file or at those numbered. Raises ProblemError.

    of: points, links, centres of mass (E, 5, S3) that alone are asked for; only groups on the way to them are solved.
    """
    from tmm_cli.pipeline import solve as compute
    from tmm_cli.refused import Refused

    try:
        return compute(problem, stage, positions, of)
    except Refused as error:
        from tmm_cli.problem.refusals import refusal

        raise refusal(error, problem) from None


def redrive(problem: Problem, link: str) -> Problem:
    """The same problem driven by another link on the frame, from the same sketch. Raises ProblemError."""
    from tmm_cli.drive import redriven
    from tmm_cli.refused import Refused

    try:
        return redriven(problem, link)
    except Refused as error:
        from tmm_cli.problem.refusals import refusal

        raise refusal(error, problem) from None


def prepare(problems: Sequence[Problem] | Problem) -> Batch:
    """Problems that differ in their numbers only, to be solved at any places of the driver (tmm_cli.batch.everything).

    Loads of a working stroke act always, unless there is one problem alone. Raises ProblemError.
    """
    from tmm_cli.batch import prepare as ready
    from tmm_cli.pipeline import solve as compute
    from tmm_cli.problem.record import Problem
    from tmm_cli.refused import Refused

    several = (problems,) if isinstance(problems, Problem) else tuple(problems)
    try:
        strokes = compute(several[0], "kinematics").strokes if len(several) == 1 else None
        return ready([problem.linkage for problem in several], strokes=strokes)
    except Refused as error:
        from tmm_cli.problem.refusals import refusal

        raise refusal(error, several[0]) from None
