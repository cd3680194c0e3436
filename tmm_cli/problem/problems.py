"""A problem, ready for the stages: the linkage and what is asked of it; or a task that will give its lengths."""

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
    """What the block `synthesis` of a file gave; names: of its parameters, standard name to that in the file."""

    task: str
    outcome: SynthesisOutcome
    names: Mapping[str, str]


@dataclass(frozen=True)
class Problem:
    """A problem file that has been read.

    name: of the file, without its ending; lever_limit: allowed difference of the lever, a share of one; source: what
    errors found later are located with; extended: makes the same as double-doubles from the decimals of the file.
    pressure_limits: largest pressure angles on sliding and on turning links (rad); limits_set: whether the file gave
    them (then to exceed them is a failed check). bare_speed: whether the first driver's speed has no unit.
    reference: of the mechanism in a list; shows: properties by their words, whose values are read by `values`. wheels:
    what is asked of intermittent motion. note_style: how the course writes its notes.
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
        """Itself: no task has to be solved for it, or none any more (see TaskProblem)."""
        return self


@dataclass(frozen=True, eq=False)
class TaskProblem:
    """A problem some of whose numbers a task of synthesis is to find. They are found once, when something needs them.

    find: solves the task; draft: the same links and pairs with any numbers for what is to be found, None where the file
    refuses these. Both raise ProblemError.
    """

    name: str
    title: str
    units: UnitSystem
    description: str
    find: Callable[[], Problem] = field(repr=False)
    draft: Callable[[], Problem | None] = field(repr=False)

    @cached_property
    def whole(self) -> Problem:
        """The problem with what its task found."""
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
    """A problem file with `structure.spatial` that has been read; beside the chain what was told of it.

    output: the link to be held; local: local freedoms Wm; wanted: mobility Wo. None: not told.
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
