"""Many positions of a linkage, or many linkages of one kind, at once: the stages written on a tape and played back.

The tape holds what the ordinary stages do for this linkage, without what its numbers and the wanted results make
superfluous; it is worth its writing (some milliseconds) from thousands of positions on. Groups that are found by
iteration take a fixed number of Newton's steps on it, from starts that are read from a table of their way; positions
where these were not enough are solved by the ordinary stages.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.batch.continuation import (
    EACH_TURN,
    STEPS_OF_VARIANTS,
    Marches,
    Starts,
    Ways,
    started,
    sure,
    unrolled,
    wants,
    wound,
)
from tmm_cli.batch.trace_program import Outputs, Program
from tmm_cli.batch.trace_terms import Term
from tmm_cli.batch.traced_arrays import DependsOnData, record
from tmm_cli.batch.variant import changed, parts, varying
from tmm_cli.mechanics.analysis import values
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble
from tmm_cli.mechanics.forces import Reactions, applied, react, solve_friction
from tmm_cli.mechanics.groups import (
    ClosedFormSolver,
    DriverMotion,
    DriverState,
    GroupSolver,
    NotUnrolledError,
    drives_at,
)
from tmm_cli.mechanics.kinematics import Motion, Strokes, compute_motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.mechanics.structure import Structure

Wanted = Callable[[Motion, Reactions | None], Mapping[str, Any]]
CHECKS = ("placed", "moving", "margin")
SURE, WOUND = "sure", "wound"  # where Newton's steps were enough on a tape, where wheels turn as its tables say
TOLD = (*CHECKS, SURE, WOUND)
TIME = DriverMotion(0.0, 1.0, 0.0, 1)  # when the parameter of the motion is the time itself


def everything(motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
    """Motion of all named points, centres of mass and links, all reactions, what balances the drivers.

    Keys: `A.x`, `A.v`, `A.a` (m, m/s, m/s2), `S2.x` ..., `2.omega`, `2.epsilon`, `R.A` (force on the pair's second
    link, N), `M.x` (couple in a guide, N m), `T.1` (balancing moment or force).
    """
    found: dict[str, Any] = {}
    for quantity, name, value in values(motion, reactions, first=True):
        if quantity.dimension != ANGLE:  # of a link its points tell it
            found[f"{quantity.symbol}.{name}" if quantity.symbol else f"{name}.{quantity.name}"] = value
    return found


@dataclass(frozen=True)
class Batch:
    """Linkages of one kind, ready to be solved at places of their driver; all assembled as the first one is.

    program is None where they cannot be written on a tape; checks tells where they can be assembled. columns: what
    varies, (variants, 1). starts: of Newton's steps at places of the driver, (positions,) or (variants, positions).
    """

    linkages: tuple[Linkage, ...]
    structure: Structure
    kernels: tuple[GroupSolver, ...]
    wanted: Wanted
    forces: bool
    strokes: Strokes | None
    program: Program | None
    checks: Program | None = None
    columns: tuple[Real, ...] = ()
    starts: Callable[[Real], list[Real]] | None = None
    others: dict[int, tuple[GroupSolver, ...]] = field(
        default_factory=dict
    )  # groups of linkages that were looked at alone

    def __call__(self, q: Real) -> Outputs | Mapping[str, Real]:
        """What was wanted, by name, at q (rad or m): (positions,), or (variants, positions) with places of their own.

        Results are (variants, positions), or (positions,) of one linkage. Where `sound` says no they mean nothing.
        """
        return self._one_by_one(q) if self.program is None else self._played(self.program, q)

    def sound(self, q: Real) -> Outputs | Mapping[str, Real]:
        """Where the linkages can be assembled, `placed`, and where they are not dead either, `moving`.

        `margin` is the least distance of a group from a dead position, 1 at best: a result has lost about as many of
        its 16 digits as it has zeros. What these results are in truth is told by `solve`, with bounds, not here.
        """
        return self._one_by_one(q) if self.checks is None else self._played(self.checks, q)

    def closed(self, q: Real) -> Real:
        """Where the tape alone closes all groups, and needs no other stages, at q."""
        if self.checks is None:
            return np.zeros(np.shape(q), dtype=bool)
        q = np.asarray(q, dtype=float)
        found = self.checks.only(*({SURE} & set(self.checks.outputs)))(
            *self.columns, q, *(self.starts(q) if self.starts else ())
        )
        return found[SURE] if SURE in found else np.ones(found.several_shape, dtype=bool)

    def _played(self, program: Program, q: Real) -> Outputs:
        """What a program gives, and the rest of it by the ordinary stages."""
        q = np.asarray(q, dtype=float)
        found = program(*self.columns, q, *(self.starts(q) if self.starts else ()))
        if SURE not in found:
            return found
        sure, found = np.reshape(found.part(SURE), found.several_shape), found.without(SURE)
        for k in np.flatnonzero(~np.all(sure, axis=1)).tolist():
            found = found.put(k, ~sure[k], self._solved(k, (q[k] if q.ndim > 1 else q)[~sure[k]]))
        return found

    def _solved(self, k: int, q: Real) -> Mapping[str, Real]:
        """One of the linkages by the ordinary stages."""
        linkage = self.linkages[k]
        if k not in self.others:
            self.others[k] = self.kernels if k == 0 else assemble(linkage, self.structure.rebind(linkage))
        found = solved(linkage, self.structure, self.others[k], q, self.wanted, self.forces, self.strokes)
        return {name: np.broadcast_to(value, np.shape(q)) for name, value in found.items() if name not in (SURE, WOUND)}

    def _one_by_one(self, q: Real) -> Mapping[str, Real]:
        found = [self._solved(k, q[k] if np.ndim(q) > 1 else q) for k in range(len(self.linkages))]
        if len(found) == 1:
            return found[0]
        return {name: np.stack([one[name] for one in found]) for name in found[0]}


def prepare_batch(
    linkages: Sequence[Linkage] | Linkage,
    wanted: Wanted = everything,
    *,
    forces: bool = True,
    own_places: bool = False,
    strokes: Strokes | None = None,
) -> Batch:
    """Linkages that differ in their numbers only, ready to be solved for what is asked.

    forces: whether that needs reactions. own_places: whether each variant will be solved at places of its own.
    strokes: those of a single linkage, if its loads act in them; without strokes such loads act always.
    Raises NotAlikeError, ValueError (loads by the strokes of several linkages), and what assembly raises.
    """
    linkages = (linkages,) if isinstance(linkages, Linkage) else tuple(linkages)
    first = linkages[0]
    by_stroke = [x.name for x in first.loads if x.table is not None and x.table.against in ("stroke", "crank turn")]
    if by_stroke and (strokes is None or len(linkages) > 1):
        raise ValueError(f"load {by_stroke[0]}: a table by the strokes needs the strokes of one linkage")
    structure = analyse_mobile_structure(first)
    kernels = assemble(first, structure)
    # several drivers pass through the places of the sketch together: a tape knows that of the first linkage
    apart = bool(first.others) and any(linkage.sketch.at != first.sketch.at for linkage in linkages)
    alone = Batch(linkages, structure, kernels, wanted, forces, strokes, None)
    lines = None if apart or first.friction else straight(first, kernels)
    if lines is None:
        return alone
    columns, together = parts(varying(linkages))
    if len(linkages) > 1 and not columns:  # all the same
        columns = [np.zeros((len(linkages), 1))]
    many = len(columns)
    steps = STEPS_OF_VARIANTS if many else None

    def varied(data: Sequence[Any]) -> Linkage:
        return changed(first, together(*data)) if columns else first

    def stages(*data: Any) -> Mapping[str, Any]:
        linkage = varied(data[:many])
        own = tuple(kernel.rebind(linkage) for kernel in lines) if columns else lines
        own = started(own, data[many + 1 :], steps)
        return solved(linkage, structure, own, data[many], wanted, forces, strokes, blank=False)

    axes = (*[1] * many, 3 if own_places else 2, *[3 if many else 2] * wants(lines))
    try:
        whole = record(stages, *axes, data=dict(enumerate(columns)))
    except DependsOnData:  # laws of cams
        return alone
    starts: Callable[[Real], list[Real]] | None = None
    if wants(lines):
        starts = ways_of(varied, columns, first, lines) if columns else Starts(first, lines)
    own = (SURE,) if isinstance(whole.outputs[SURE][0], Term) else ()
    checks = whole.only(*CHECKS, *own)
    program = whole.only(*(name for name in whole.outputs if name not in TOLD), *own)
    return replace(alone, program=program, checks=checks, columns=tuple(columns), starts=starts)


def ways_of(
    varied: Callable[[Sequence[Any]], Linkage], columns: Sequence[Real], first: Linkage, lines: Sequence[GroupSolver]
) -> Ways:
    """Ways of all linkages as far as that of the first one goes."""
    numbers = np.hstack(list(columns))
    traces = [kernel.followed for kernel in lines if kernel.followed is not None]
    low, high = max(trace.q[0] for trace in traces), min(trace.q[-1] for trace in traces)
    turns = (high - low) / (2 * np.pi) if first.driver.kind == "turn" else 1.0
    closed = all(trace.closed for trace in traces)
    ones = np.ones((len(numbers), 1))
    march = Marches(varied, numbers[0].tolist(), first, lines)
    return march(numbers, low * ones, high * ones, int(np.ceil(EACH_TURN * turns)), closed=closed)


def straight(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> tuple[GroupSolver, ...] | None:
    """The groups as a tape can hold them; None where it cannot."""
    if any(kernel.way is not None for kernel in kernels if isinstance(kernel, ClosedFormSolver)):
        return None
    try:
        return unrolled(linkage, kernels)
    except NotUnrolledError:
        return None


def solved(
    linkage: Linkage,
    structure: Structure,
    kernels: tuple[GroupSolver, ...],
    q: Any,
    wanted: Wanted,
    forces: bool,
    strokes: Strokes | None,
    *,
    blank: bool = True,
    start: Any = None,
) -> Mapping[str, Any]:
    """The stages with time as the parameter of the motion, so that no transfer function needs be scaled.

    start: where the driver's law begins (rad or m); in the sketch when left out.
    """
    lead = linkage.driver
    law = DriverMotion(linkage.sketch.at if start is None else start, lead.rate, lead.acceleration, lead.sense)
    speed = law.speed(q)
    drives = {
        link: DriverState(
            d.value, d.first * speed, d.second * speed * speed + d.first * (lead.sense * lead.acceleration)
        )
        for link, d in drives_at(linkage, q).items()
    }
    motion = compute_motion(linkage, kernels, q, TIME, blank=blank, drives=drives)
    reactions = reactions_of(motion, structure, strokes) if forces else None
    margin = reduce(np.minimum, [at.margin for at in motion.placements], np.ones(np.shape(q)))
    checks = {"placed": motion.placed, "moving": motion.moving, "margin": margin}
    turns = wound(motion)
    return {**wanted(motion, reactions), **checks, SURE: sure(motion) & turns, WOUND: turns}


def reactions_of(motion: Motion, structure: Structure, strokes: Strokes | None) -> Reactions:
    """The force plan under all that acts, friction too."""
    acting = applied(motion, strokes)
    free = react(motion, structure, acting)
    if not motion.linkage.friction:
        return free
    return solve_friction(motion, structure, acting, free).reactions
