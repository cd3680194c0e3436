"""`tmm bench grading`: how long a group takes and how that grows, how often mistakes are named rightly."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import tmm_cli
from tmm_cli.bench.groups import Group, family_of, group, write
from tmm_cli.bench.measured import CLOCK, Measured, slack, words
from tmm_cli.errors import _
from tmm_cli.grading.diagnose import diagnose
from tmm_cli.grading.draw_variants import Variety
from tmm_cli.grading.following import following
from tmm_cli.grading.own_answers import own_answer
from tmm_cli.grading.sheet import Written, predicted
from tmm_cli.grading.solution import solve
from tmm_cli.results.table import Table
from tmm_cli.vectors import Vector

SIZES, REDUCED_SIZES, LARGEST = (2_000, 10_000), (100, 500), 100_000  # students
OF = 10_000  # students that the targets of time and memory are for
SECONDS, START, MEMORY, SOLVING, GROWTH = 60.0, 3.0, 1000.0, 0.05, 1.1  # s; s of beginning; MB; share; power
WRONG = (0.2, 0.05)  # shares of students with one mistake, with two
SHEETS, REDUCED_SHEETS = 1000, 60
CHAINS, REDUCED_CHAINS = 500, 40
CANDIDATES, REDUCED_CANDIDATES, PER_SECOND = 10_000, 2_000, 10_000.0
RATES = {0: (0.0, 0.0), 1: (0.95, 0.01), 2: (0.80, 0.02)}  # least rightly, most wrongly, by the mistakes made
AT_STUDENTS = _("{what}, {students} students: {found}, target {target}")


@dataclass(frozen=True)
class Graded:
    """A group graded by the command, from files to files: s by the clock and of all processors, MB of all processes
    together. solving: the share of solving the variants."""

    students: int
    seconds: float
    processor: float
    memory: float | None
    solving: float

    def missed(self, slack: float) -> list[str]:
        """What is missed when targets are so many times as wide. Times and memory of fewer students may be as much
        less, but for what it takes to begin."""
        part = min(1.0, self.students / OF)
        limits = (
            (_("seconds"), self.seconds, SECONDS * max(part, self.students / OF) + START),
            (_("MB"), self.memory or 0.0, MEMORY if self.students <= OF else np.inf),
            (_("share of solving"), self.solving, SOLVING),
        )
        return [
            AT_STUDENTS.format(what=what, students=self.students, found=f"{found:.3g}", target=f"{limit:.3g}")
            for what, found, limit in limits if found > limit * slack
        ]  # fmt: skip
