"""Problems ready for analysis: a planar linkage, a linkage with a synthesis task, or a spatial chain."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from tmm_cli.mechanics.linkage import Linkage, Request
from tmm_cli.mechanics.structure import SpatialChain
from tmm_cli.problem.blocks.sheet_keys import NoteStyle, SheetTexts
from tmm_cli.problem.errors import Tree
from tmm_cli.problem.schema import ShownKeys
from tmm_cli.problem.units import UnitSystem
from tmm_cli.problem.values import ValueReader

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import WheelTask
    from tmm_cli.mechanics.dynamics import BalancingTask, RunTask, SteadyTask
    from tmm_cli.synthesis import SynthesisOutcome


@dataclass(frozen=True)
class Synthesised:
    """Result of the block `synthesis`.

    Attributes:
        task: name of the synthesis task.
        outcome: solution of the task.
        names: name in the file of each parameter that the task determines, by its standard name.
    """

    task: str
    outcome: SynthesisOutcome
    names: Mapping[str, str]


@dataclass(frozen=True)
class Problem:
    """A problem file that has been read: the linkage, the requested positions and the tasks.

    Attributes:
        name: file name without extension.
        title: title of the problem.
        linkage: planar linkage.
        request: requested positions.
        units: units of the file.
        lever_limit: allowed relative difference between the balancing moments of force analysis and Zhukovsky lever.
        description: description of the problem.
        file: name of the file.
        pressure_limits: largest allowed pressure angles of sliding and of rotating links (rad).
        limits_set: for each of these limits, True if the file gives it. A run fails its checks only if such a limit is
            exceeded.
        bare_speed: True if the speed of the first driver has no unit.
        title_texts: texts of the title block.
        note_style: style of the calculation note.
        dynamics: task for the law of motion, or None.
        balancing: balancing task, or None.
        reference: name of the mechanism in a published list.
        shows: requested properties of the mechanism, by caption.
        values: reader of values with the parameters and units of the file.
        source: content of the file, used to find line and column of later errors.
        synthesis: result of the synthesis task, or None.
        extended: function that builds the same problem with double-double numbers from the decimals in the file.
        wheels: tasks of intermittent motion.
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
        """The problem itself; a TaskProblem returns here the problem with its task solved."""
        return self


@dataclass(frozen=True, eq=False)
class TaskProblem:
    """A problem in which a synthesis task determines some numbers. The task is solved on first use, and only once.

    Attributes:
        name: file name without extension.
        title: title of the problem.
        units: units of the file.
        description: description of the problem.
        find: function that solves the task and returns the complete problem. Raises ProblemError.
        draft: function that returns the same links and pairs with placeholder numbers, or None if the file is invalid
            with such numbers. Raises ProblemError.
    """

    name: str
    title: str
    units: UnitSystem
    description: str
    find: Callable[[], Problem] = field(repr=False)
    draft: Callable[[], Problem | None] = field(repr=False)

    @cached_property
    def whole(self) -> Problem:
        """The complete problem with the results of its task. Raises ProblemError."""
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
    """A problem file with `structure.spatial` that has been read: a spatial chain without dimensions.

    Attributes:
        name: file name without extension.
        title: title of the problem.
        chain: links and pairs.
        output: link that is held fixed to count the manoeuvrability (mobility of the other links); None if not given.
        local: number of local (idle) mobilities Wm; None if not given.
        wanted: required mobility Wo; None if not given.
        units: units of the file.
        description: description of the problem.
        reference: name of the mechanism in a published list.
        shows: requested properties of the chain, by caption.
        source: content of the file, used to find line and column of later errors.
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
