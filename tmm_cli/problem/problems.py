"""Problems ready for analysis: a planar linkage with its request, a linkage with a synthesis task, or a spatial
chain.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from tmm_cli.mechanics.linkage import Linkage, Request
from tmm_cli.mechanics.structure import SpatialChain
from tmm_cli.problem.errors import Tree
from tmm_cli.problem.schema import NoteStyle, SheetTexts, ShownKeys
from tmm_cli.problem.units import UnitSystem
from tmm_cli.problem.values import ValueReader

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import WheelTask
    from tmm_cli.mechanics.dynamics import BalancingTask, RunTask, SteadyTask
    from tmm_cli.synthesis import SynthesisOutcome


@dataclass(frozen=True)
class Synthesised:
    """Result of the block `synthesis`. names: standard name of each parameter to its name in the file."""

    task: str
    outcome: SynthesisOutcome
    names: Mapping[str, str]


@dataclass(frozen=True)
class Problem:
    """A problem file that has been read.

    name: file name without extension; lever_limit: allowed relative difference of the Zhukovsky lever; source: file by
    which later errors are located; extended: builds the same problem in double-doubles from the decimals of the file;
    pressure_limits: largest pressure angles on sliding and on rotating links (rad); limits_set: whether the file gave
    them (exceeding them is then a failed check); bare_speed: whether the first driver's speed has no unit;
    reference: name of the mechanism in a list; shows: requested properties by their captions, evaluated by `values`;
    wheels: tasks of intermittent motion; note_style: style of the calculation note.
    """

    name: str
    title: str
    linkage: Linkage
    request: Request
    units: UnitSystem
    lever_limit: float = 0.05
    description: str = ""
    file: str = ""
    pressure_limits: tuple[float, float] = (math.radians(30), math.radians(45))
    limits_set: tuple[bool, bool] = (False, False)
    bare_speed: bool = False
    title_texts: SheetTexts = field(default_factory=SheetTexts)
    note_style: NoteStyle = field(default_factory=NoteStyle)
    dynamics: SteadyTask | RunTask | None = None
    balancing: BalancingTask | None = None
    reference: str = ""
    shows: Mapping[str, ShownKeys] = field(default_factory=dict, compare=False, repr=False)
    values: ValueReader | None = field(default=None, compare=False, repr=False)
    source: Tree | None = field(default=None, compare=False, repr=False)
    synthesis: Synthesised | None = field(default=None, compare=False, repr=False)
    extended: Callable[[], Problem] | None = field(default=None, compare=False, repr=False)
    wheels: tuple[WheelTask, ...] = field(default=(), compare=False, repr=False)

    @property
    def whole(self) -> Problem:
        """The problem itself, as it has no synthesis task left to solve (see TaskProblem)."""
        return self


@dataclass(frozen=True, eq=False)
class TaskProblem:
    """A problem with numbers to be found by a synthesis task. The task is solved once, on first use.

    find: solves the task; draft: same links and pairs with placeholder numbers, None if the file refuses these.
    Both raise ProblemError.
    """

    name: str
    title: str
    units: UnitSystem
    description: str
    find: Callable[[], Problem] = field(repr=False)
    draft: Callable[[], Problem | None] = field(repr=False)

    @cached_property
    def whole(self) -> Problem:
        """The problem with the results of its task."""
        return self.find()

    @property
    def linkage(self) -> Linkage:
        return self.whole.linkage

    @property
    def request(self) -> Request:
        return self.whole.request

    @property
    def synthesis(self) -> Synthesised | None:
        return self.whole.synthesis


@dataclass(frozen=True)
class ChainProblem:
    """A problem file with `structure.spatial` that has been read.

    output: link held fixed for the manoeuvrability; local: local mobilities Wm; wanted: required mobility Wo.
    None: not given.
    """

    name: str
    title: str
    chain: SpatialChain
    output: str | None
    local: int | None
    wanted: int | None
    units: UnitSystem
    description: str = ""
    reference: str = ""
    shows: Mapping[str, ShownKeys] = field(default_factory=dict, compare=False)
    source: Tree | None = field(default=None, compare=False, repr=False)
