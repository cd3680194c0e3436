"""The problems of the bank and their sheets, drawn once for all tests of a run."""

from __future__ import annotations

from functools import cache

from models import PROBLEMS

from tmm_cli import load, solve
from tmm_cli.draw import sheets
from tmm_cli.draw.drawing import Drawing
from tmm_cli.problem.record import ChainProblem

NAMES = sorted(path.stem for path in PROBLEMS.glob("*.yaml"))


@cache
def drawn(name: str) -> dict[str, Drawing]:
    """The sheets of a problem that are drawings, by their stems."""
    problem = load(PROBLEMS / f"{name}.yaml")
    if isinstance(problem, ChainProblem):
        return {}
    return {stem: drawing for stem, drawing in sheets(solve(problem)) if isinstance(drawing, Drawing)}
