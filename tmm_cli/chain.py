"""The one stage that a chain given by pairs alone has: its count."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.problem.chain import ChainProblem
from tmm_cli.structure.spatial import Findings, examine


@dataclass(frozen=True)
class ChainResults:
    """What was counted of a chain; it has no dimensions, so nothing else is computed."""

    problem: ChainProblem
    chain: Findings


def count_chain(problem: ChainProblem) -> ChainResults:
    """Count the chain of a problem."""
    return ChainResults(problem, examine(problem.chain, problem.output, problem.local, problem.wanted))
