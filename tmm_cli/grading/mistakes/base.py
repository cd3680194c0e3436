"""A typical mistake: what would have come out with it, by the same stages."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Self

from tmm_cli.batch import Family
from tmm_cli.grading.solution import Solution
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Quantity
from tmm_cli.mechanics.forces import Applied
from tmm_cli.mechanics.groups import Kernel
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import Real


@dataclass(frozen=True)
class Mistake:
    """One case of a mistake, e.g. that the normal part of link 3 was left out. It changes one of these, or several.

    name: in tables and statistics; sentence: for the student, whole. Both may have fields of the mistake.
    """

    name: ClassVar[str]
    sentence: ClassVar[str]
    solves: ClassVar[bool] = True  # whether the stages must run again; else it changes what is written down alone
    price: ClassVar[float] = 0.0  # squares of standard errors that it must explain more than others, as it fits so much

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        """All of its cases that this task has."""
        yield cls()

    @property
    def told(self) -> str:
        """The sentence with the fields of this case."""
        return _(self.sentence).format(**vars(self))

    @property
    def called(self) -> str:
        """The name with the fields of this case."""
        return _(self.name).format(**vars(self))

    def family(self, family: Family) -> Family:
        """The variants as the student took them."""
        return family

    def kernel(self, kernel: Kernel, family: Family) -> Kernel:
        """A group as the student solved it."""
        return kernel

    def motion(self, motion: Motion) -> Motion:
        """The motion as the student found it."""
        return motion

    def load(self, load: Applied, motion: Motion, family: Family) -> Applied:
        """What the student let act in the place of a load."""
        return load

    def value(self, quantity: Quantity, values: Real, solution: Solution) -> Real:
        """What the student wrote down of the values (variants, positions) that the stages gave."""
        return values
