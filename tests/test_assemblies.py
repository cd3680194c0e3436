"""All real assemblies of a group: how many there are, that none is missed, and how `tmm kinematics` shows them."""

from __future__ import annotations

import pytest

from tmm_cli import solve
from tmm_cli.problem.build import build
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import read_text

THREE_EQUAL_LEGS = """tmm: 1
points: {O: [0, 0], C: [300, 0], D: [300, 200]}
links:
  1: {points: [O, A], length: 100}
  2: {points: {P: [0, 0], Q: [200, 0], R: [200, 200]}}
  3: {points: [A, P], length: 100}
  4: {points: [C, Q], length: 100}
  5: {points: [D, R], length: 100}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0 deg}
"""


def problem(text):
    return build(read_text(text, "case.yaml"))


def test_the_search_ends_where_a_group_moves_by_itself():
    """Three parallel legs of one length carry a link that can go round a circle: its assemblies have no end."""
    with pytest.raises(ProblemError, match="links 2, 3, 4 and 5"):
        solve(problem(THREE_EQUAL_LEGS), "kinematics")
