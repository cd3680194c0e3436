"""Where Newton's steps on a tape begin: tables along the driver's way, of groups that are found by iteration.

A table is made once, from the trace that continuation has left: between its places the unknowns are cubic polynomials
with the group's own rates at both ends (Hermite), which miss by some 1e-12.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.groups.base import Closed, Kernel
from tmm_cli.groups.branch_trace import BranchTrace
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.sequence import LinkStates, link_states
from tmm_cli.groups.unrolled import Unrolled
from tmm_cli.linkage import Linkage
from tmm_cli.tape import Program, TracedArray, record
from tmm_cli.vectors import Real

EACH = 1440  # places of a table in a turn of the driver, or in its whole range
STEPS = 4  # of Newton's method from the trace's own nodes to places of a table

Stands = Sequence[Any]


def unrolled(linkage: Linkage, kernels: Sequence[Kernel]) -> tuple[Kernel, ...]:
    """The groups with those that are found by iteration as straight lines. Raises NotUnrolledError."""
    there = link_states(linkage, kernels, np.array([linkage.sketch.at]), 0)
    geared = {link for mesh in linkage.meshes for link in (mesh.i, mesh.j, mesh.carrier)}
    return tuple(
        Unrolled.from_newton(kernel, there.poses, there.drives, geared) if isinstance(kernel, Newton) else kernel
        for kernel in kernels
    )


def wants(kernels: Sequence[Kernel]) -> int:
    """How many starts the groups take."""
    return sum(len(kernel.free) for kernel in kernels if isinstance(kernel, Unrolled) and not kernel.linear)


def started(kernels: Sequence[Kernel], stands: Stands, steps: int | None = None) -> tuple[Kernel, ...]:
    """The groups with their starts, one after another; steps: of Newton's method, if not the usual ones."""
    found, at = [], 0
    for kernel in kernels:
        if isinstance(kernel, Unrolled) and not kernel.linear:
            own = tuple(stands[at : at + len(kernel.free)])
            kernel = replace(kernel, starts=own, steps=steps or kernel.steps)
            at += len(own)
        found.append(kernel)
    return tuple(found)


def sure(states: LinkStates) -> Any:
    """Where the steps on a tape have closed all groups that take such."""
    found: Any = np.ones(np.shape(states.q), dtype=bool)
    for kernel, at in zip(states.kernels, states.placements, strict=True):
        if isinstance(kernel, Unrolled):
            found = found & (at.residual < 0)
    return found


def wound(states: LinkStates) -> Any:
    """Where turns of wheels are those of the tables that groups in closed form have."""
    found: Any = np.ones(np.shape(states.q), dtype=bool)
    for kernel, at in zip(states.kernels, states.placements, strict=True):
        if isinstance(kernel, Closed) and kernel.winding is not None:
            found = found & kernel.winding.sure(kernel.group.links, at.poses, states.q)
    return found


def unknowns(states: LinkStates) -> Mapping[str, Any]:
    """Free unknowns x and their rates v by the driver's place, numbered; and where they are `sure`."""
    found: dict[str, Any] = {"sure": sure(states)}
    number = 0
    for kernel in states.kernels:
        if isinstance(kernel, Unrolled) and not kernel.linear:
            links = kernel.group.links
            places = [p for link in links for p in _parts(states.poses[link].x, states.poses[link].unwrapped)]
            rates = [p for link in links for p in _parts(states.first[link].v, states.first[link].w)]
            for x, v in zip(kernel.values(places), kernel.values(rates), strict=True):
                found |= {f"x{number}": x, f"v{number}": v}
                number += 1
    return found


def _parts(vector: Any, angle: Any) -> tuple[Any, Any, Any]:
    return vector.real, vector.imag, angle


@dataclass(frozen=True)
class Table:
    """Unknowns of a group at places of the driver: polynomials (4, unknowns, pieces), of equal pieces from low on.

    gain: what they grow by in a cycle of that many pieces, where the way is closed; else None.
    """

    low: float
    step: float
    pieces: Real
    gain: Real | None

    @classmethod
    def of(cls, q: Real, x: Real, v: Real, *, closed: bool) -> Table:
        """From unknowns and rates (unknowns, places) at even places; nan where they are not known."""
        h = float(q[1] - q[0])
        a, b, one, other = x[:, :-1], x[:, 1:], h * v[:, :-1], h * v[:, 1:]
        pieces = np.stack([a, one, 3 * (b - a) - 2 * one - other, 2 * (a - b) + one + other])
        return cls(float(q[0]), h, pieces, x[:, -1:] - x[:, :1] if closed else None)

    def __call__(self, q: Real) -> Real:
        """Unknowns at places, (unknowns, ...); nan beyond the ends."""
        many = self.pieces.shape[-1]
        share = (q - self.low) / self.step
        number = np.floor(share)
        if self.gain is None:
            number = np.clip(number, 0.0, many - 1.0)
            beyond: Any = np.where((share < 0) | (share > many), np.nan, 0.0)
        else:
            whole = np.floor(number / many)
            beyond = whole * self.gain.reshape(-1, *[1] * np.ndim(q))
        share = share - number
        a, b, c, d = self.pieces.take((number if self.gain is None else number - whole * many).astype(np.intp), axis=2)
        for part in (c, b, a):
            d *= share
            d += part
        found: Real = d + beyond
        return found


class Starts:
    """Starts of all groups of a linkage at any places of its driver."""

    def __init__(self, linkage: Linkage, kernels: Sequence[Kernel]) -> None:
        """kernels: as straight lines."""
        own = [kernel for kernel in kernels if isinstance(kernel, Unrolled) and not kernel.linear]
        traces = [kernel.trace for kernel in own if kernel.trace is not None]
        self.tables: list[Table] = []
        if not own:
            return
        closing = _closing(linkage, kernels)
        first = 0
        for kernel, trace in zip(own, traces, strict=True):
            q = _places(trace, turns=linkage.driver.kind == "turn")
            found = closing(q, *(x for k, t in zip(own, traces, strict=True) for x in _traced(k, t, q)))
            numbers = range(first, first + len(kernel.free))
            lost = np.where(found["sure"], 0.0, np.nan)
            x, v = (np.stack([found[f"{part}{k}"] + lost for k in numbers]) for part in "xv")
            self.tables.append(Table.of(q, x, v, closed=trace.closed))
            first += len(kernel.free)

    def __call__(self, q: Real) -> list[Real]:
        return [x for table in self.tables for x in table(q)]


def _closing(linkage: Linkage, kernels: Sequence[Kernel]) -> Program:
    """Unknowns by places of the driver and starts that may be far."""

    def stages(q: TracedArray, *stands: TracedArray) -> Mapping[str, Any]:
        return unknowns(link_states(linkage, started(kernels, stands, STEPS), q, 1, blank=False))  # type: ignore[arg-type]

    return record(stages, *[2] * (1 + wants(kernels)))


def _places(trace: BranchTrace, *, turns: bool) -> Real:
    """Even places along a trace."""
    low, high = float(trace.q[0]), float(trace.q[-1])
    count = EACH * max(1, round((high - low) / (2 * np.pi))) if turns else EACH
    return low + (high - low) * np.arange(count + 1) / count


def _traced(kernel: Unrolled, trace: BranchTrace, q: Real) -> list[Real]:
    """Free unknowns near places of a trace."""
    state, _ = trace.start(q)
    parts = [state.x.real, state.x.imag, state.unwrapped]
    return [parts[column % 3][:, column // 3] for column in kernel.free]
