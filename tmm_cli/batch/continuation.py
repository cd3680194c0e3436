"""Initial guesses for Newton's method in groups whose operations are traced.

Tracing records the operations once, so that they can be repeated quickly for many positions. Groups that have no closed
form then take a fixed number of Newton steps, which requires good initial guesses.

For one linkage the guesses come from a table that is made once, from the path found by continuation: cubic Hermite
polynomials through the unknowns and their derivatives, with errors of about 1e-12. For many variants the unknowns are
continued from the first linkage to each variant, and then along the driver range.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.batch.trace_program import TraceProgram
from tmm_cli.batch.traced_arrays import TracedArray, trace_function
from tmm_cli.batch.variant import split_columns
from tmm_cli.mechanics.groups import (
    BranchTrace,
    ClosedFormSolver,
    GroupSolver,
    LinkStates,
    NewtonSolver,
    UnrolledNewton,
    link_states,
)
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import CONVERGED, SAME_STATE, Real

TABLE_PIECES = 1440  # per revolution of the driver, or in its whole range
TABLE_NEWTON_STEPS = 4  # Newton steps at each node of the table

Placeholders = Sequence[Any]


def unroll_groups(linkage: Linkage, kernels: Sequence[GroupSolver]) -> tuple[GroupSolver, ...]:
    """Replace each group solver that iterates by one with a fixed number of Newton steps, which can be traced.

    Raises:
        NotUnrolledError: a group cannot be solved in this way.
    """
    states = link_states(linkage, kernels, np.array([linkage.sketch.at]), 0)
    geared = {link for mesh in linkage.meshes for link in (mesh.i, mesh.j, mesh.carrier)}
    return tuple(
        UnrolledNewton.from_newton(kernel, states.poses, states.drives, geared)
        if isinstance(kernel, NewtonSolver)
        else kernel
        for kernel in kernels
    )


def count_initial_guesses(kernels: Sequence[GroupSolver]) -> int:
    """Return the number of initial guesses that the groups need together."""
    return sum(len(kernel.free) for kernel in kernels if isinstance(kernel, UnrolledNewton) and not kernel.linear)


def with_initial_guesses(
    kernels: Sequence[GroupSolver], placeholders: Placeholders, steps: int | None = None
) -> tuple[GroupSolver, ...]:
    """Distribute initial guesses to the groups that are solved by Newton's method.

    Args:
        kernels: the group solvers.
        placeholders: initial guesses of all these groups, one after another.
        steps: number of Newton steps; None for the default.
    """
    prepared, at = [], 0
    for kernel in kernels:
        if isinstance(kernel, UnrolledNewton) and not kernel.linear:
            guesses = tuple(placeholders[at : at + len(kernel.free)])
            kernel = replace(kernel, starts=guesses, steps=steps or kernel.steps)
            at += len(guesses)
        prepared.append(kernel)
    return tuple(prepared)


def newton_converged(states: LinkStates) -> Any:
    """Return True at positions where the fixed number of Newton steps was enough in all groups."""
    converged: Any = np.ones(np.shape(states.q), dtype=bool)
    for kernel, at in zip(states.kernels, states.placements, strict=True):
        if isinstance(kernel, UnrolledNewton):
            converged = converged & (at.residual < 0)
    return converged


def accumulated_angles_agree(states: LinkStates) -> Any:
    """Return True at positions where the number of full turns of links is certain.

    This is checked for links on which gears depend, in groups with a closed form; their tables of accumulated angles
    are used.
    """
    agree: Any = np.ones(np.shape(states.q), dtype=bool)
    for kernel, at in zip(states.kernels, states.placements, strict=True):
        if isinstance(kernel, ClosedFormSolver) and kernel.winding is not None:
            agree = agree & kernel.winding.sure(kernel.group.links, at.poses, states.q)
    return agree


def free_unknowns(states: LinkStates) -> Mapping[str, Any]:
    """Return the unknowns that Newton's method solves for, in all groups without a closed form.

    Returns:
        A mapping with the unknowns x0, x1, ..., their derivatives v0, v1, ... with respect to the driver coordinate,
        and "sure", a mask of the positions at which Newton's method has converged.
    """
    unknowns: dict[str, Any] = {"sure": newton_converged(states)}
    number = 0
    for kernel in states.kernels:
        if isinstance(kernel, UnrolledNewton) and not kernel.linear:
            links = kernel.group.links
            components = [p for link in links for p in _components(states.poses[link].x, states.poses[link].unwrapped)]
            rates = [p for link in links for p in _components(states.first[link].v, states.first[link].w)]
            for x, v in zip(kernel.values(components), kernel.values(rates), strict=True):
                unknowns |= {f"x{number}": x, f"v{number}": v}
                number += 1
    return unknowns


def _components(vector: Any, angle: Any) -> tuple[Any, Any, Any]:
    return vector.real, vector.imag, angle


@dataclass(frozen=True)
class InitialGuessTable:
    """Unknowns of a group as cubic polynomials of the driver coordinate, on intervals of equal width.

    Attributes:
        low: driver coordinate at the beginning of the first interval.
        step: width of the intervals.
        pieces: coefficients, (4, unknowns, intervals).
        gain: increase of the unknowns over all intervals if the motion is cyclic, else None.
    """

    low: float
    step: float
    pieces: Real
    gain: Real | None

    @classmethod
    def of(cls, q: Real, x: Real, v: Real, *, closed: bool) -> InitialGuessTable:
        """Build the table from unknowns x and derivatives v, (unknowns, nodes), at evenly spaced driver coordinates.

        Unknowns that could not be found are nan.
        """
        h = float(q[1] - q[0])
        a, b, left, right = x[:, :-1], x[:, 1:], h * v[:, :-1], h * v[:, 1:]
        pieces = np.stack([a, left, 3 * (b - a) - 2 * left - right, 2 * (a - b) + left + right])
        return cls(float(q[0]), h, pieces, x[:, -1:] - x[:, :1] if closed else None)

    def __call__(self, q: Real) -> Real:
        """Return the unknowns at driver coordinates, (unknowns, ...); nan outside the table."""
        intervals = self.pieces.shape[-1]
        share = (q - self.low) / self.step
        number = np.floor(share)
        if self.gain is None:
            number = np.clip(number, 0.0, intervals - 1.0)
            beyond: Any = np.where((share < 0) | (share > intervals), np.nan, 0.0)
        else:
            whole = np.floor(number / intervals)
            beyond = whole * self.gain.reshape(-1, *[1] * np.ndim(q))
        share = share - number
        a, b, c, d = self.pieces.take(
            (number if self.gain is None else number - whole * intervals).astype(np.intp), axis=2
        )
        for coefficient in (c, b, a):
            d *= share
            d += coefficient
        unknowns: Real = d + beyond
        return unknowns


class InitialGuesses:
    """Initial guesses for all groups of one linkage. Call it with driver coordinates to get the guesses there."""

    def __init__(self, linkage: Linkage, kernels: Sequence[GroupSolver]) -> None:
        """Tabulate the unknowns of the groups that are solved by a fixed number of Newton steps."""
        iterated = [kernel for kernel in kernels if isinstance(kernel, UnrolledNewton) and not kernel.linear]
        traces = [kernel.trace for kernel in iterated if kernel.trace is not None]
        self.tables: list[InitialGuessTable] = []
        if not iterated:
            return
        closing = _closing_program(linkage, kernels)
        first = 0
        for kernel, trace in zip(iterated, traces, strict=True):
            q = _table_coordinates(trace, turns=linkage.driver.kind == "turn")
            closed = closing(
                q, *(x for k, t in zip(iterated, traces, strict=True) for x in _unknowns_from_trace(k, t, q))
            )
            numbers = range(first, first + len(kernel.free))
            unsolved = np.where(closed["sure"], 0.0, np.nan)
            x, v = (np.stack([closed[f"{letter}{k}"] + unsolved for k in numbers]) for letter in "xv")
            self.tables.append(InitialGuessTable.of(q, x, v, closed=trace.closed))
            first += len(kernel.free)

    def __call__(self, q: Real) -> list[Real]:
        return [x for table in self.tables for x in table(q)]


def _closing_program(linkage: Linkage, kernels: Sequence[GroupSolver]) -> TraceProgram:
    """Make a program that improves rough initial guesses of the groups at driver coordinates by Newton's method."""

    def stages(q: TracedArray, *stands: TracedArray) -> Mapping[str, Any]:
        guessed = with_initial_guesses(kernels, stands, TABLE_NEWTON_STEPS)
        return free_unknowns(link_states(linkage, guessed, q, 1, blank=False))  # type: ignore[arg-type]

    return trace_function(stages, *[2] * (1 + count_initial_guesses(kernels)))


def _table_coordinates(trace: BranchTrace, *, turns: bool) -> Real:
    """Return the driver coordinates, evenly spaced along the traced path of a group, for its table of initial
    guesses.
    """
    low, high = float(trace.q[0]), float(trace.q[-1])
    count = TABLE_PIECES * max(1, round((high - low) / (2 * np.pi))) if turns else TABLE_PIECES
    return low + (high - low) * np.arange(count + 1) / count


def _unknowns_from_trace(kernel: UnrolledNewton, trace: BranchTrace, q: Real) -> list[Real]:
    """Estimate the free unknowns of a group at driver coordinates q from its branch trace.

    A branch trace lists states of the group along the driver range. The free unknowns are those that Newton's method
    solves for; the other unknowns follow from them explicitly.
    """
    state, _ = trace.start(q)
    parts = [state.x.real, state.x.imag, state.unwrapped]
    return [parts[column % 3][:, column // 3] for column in kernel.free]


# Initial guesses for many variants at once: each is continued from the first linkage, then along its driver range.
#
# At the sketched position the numbers change from those of the first linkage to those of each variant. From there all
# variants are continued along their driver ranges, up and down at once: predicted from derivatives, and
# corrected by replaying a trace. A step with too large a correction, or across a dead position, is halved; a variant
# whose quarter steps fail too ends there.


LARGEST_CORRECTION = 0.1  # rad, or sizes of the group: a larger Newton correction may lead to another assembly
CORRECTOR_STEPS = 3  # Newton steps after which an acceptable correction has converged
MOST_ROUNDS = 12  # steps from the first linkage to a variant
FIRST_SHARE = 1 / 16  # first step towards a variant; the rest is then tried in one step
NODE_TOLERANCE = 1e-9  # of a step: closer to a node the next node, which may be missing, is not needed
SHORTEST_STEP = 0.25  # of a full step
STEPS_PER_TURN, LEAST_TURNS = 24, 0.5  # continuation steps per revolution of the driver; least number of revolutions
VARIANT_NEWTON_STEPS = 2  # Newton steps from initial guesses on such paths

LinkageMaker = Callable[[Sequence[Any]], Linkage]  # a linkage for numbers, each (variants, 1)


@dataclass(frozen=True)
class ContinuedPaths:
    """Unknowns of variants at evenly spaced driver coordinates: n steps below and n steps above the sketch.

    Values are nan where the continuation failed.

    Attributes:
        at: driver coordinate of the sketch.
        x, v: unknowns and their derivatives with respect to the driver coordinate, (unknowns, variants, 2 n + 1).
        steps: step lengths below and above the sketch, (variants, 1); 0 if no steps were made in that direction.
        gain: increase of the unknowns over a cycle, (unknowns, variants, 1); None if the motion does not repeat.
    """

    at: float
    x: Real
    v: Real
    steps: tuple[Real, Real]
    gain: Real | None

    def take(self, rows: Real) -> ContinuedPaths:
        """Return the paths of the selected variants."""
        gain = None if self.gain is None else self.gain[:, rows]
        down, up = self.steps
        return replace(self, x=self.x[:, rows], v=self.v[:, rows], steps=(down[rows], up[rows]), gain=gain)

    def of(self, selected: slice) -> ContinuedPaths:
        """Return the paths of the selected unknowns."""
        return replace(
            self, x=self.x[selected], v=self.v[selected], gain=None if self.gain is None else self.gain[selected]
        )

    def __call__(self, q: Real) -> list[Real]:
        """Return initial guesses at driver coordinates (variants, positions), one array for each unknown."""
        unknowns, variants, nodes_per_variant = self.x.shape
        n, (down, up) = nodes_per_variant // 2, self.steps
        q = np.broadcast_to(q, (variants, q.shape[-1])) - self.at
        whole: Any = 0.0
        if self.gain is not None:
            whole = np.floor((q + n * down) / (2 * n * up))
            q = q - whole * (2 * n * up)
        step = np.where(q < 0, down, up)
        share = q / np.where(step > 0, step, 1.0)
        k = np.clip(np.floor(share + NODE_TOLERANCE), -n, n - 1)
        t = share - k
        flat = (k + n).astype(np.intp) + nodes_per_variant * np.arange(variants)[:, None]
        x, v = (nodes.reshape(unknowns, -1) for nodes in (self.x, self.v))
        a, b = x.take(flat, axis=1), x.take(flat + 1, axis=1)
        # step of the interval; the one from -1 to 0 is part of the downward path
        left, right = (step * v.take(f, axis=1) for f in (flat, flat + 1))
        guesses = a + t * (left + t * (3 * (b - a) - 2 * left - right + t * (2 * (a - b) + left + right)))
        guesses = np.where(np.abs(t) <= NODE_TOLERANCE, a, guesses)  # at a node; the next may be missing
        if self.gain is not None:
            guesses = np.where(whole == 0, guesses, guesses + whole * self.gain)
        return list(guesses)


class Continuation:
    """Continuation of the unknowns from a first linkage to variants, and along the driver range.

    At the position of the sketch, the numbers (lengths and other data) are changed gradually from those of the first
    linkage to those of each variant. From there the driver moves up and down its range, for all variants at once. A
    step is predicted from the derivatives and corrected by Newton's method, with traced operations. A step is halved if
    the correction is too large or leads to the other side of a dead position. If steps of a quarter fail too, the path
    of the variant ends.
    """

    def __init__(
        self, varied: LinkageMaker, first: Sequence[float], linkage: Linkage, kernels: Sequence[GroupSolver]
    ) -> None:
        self.first, self.at, count = np.array(first, dtype=float), linkage.sketch.at, len(first)
        self.own = [kernel for kernel in kernels if isinstance(kernel, UnrolledNewton) and not kernel.linear]
        unknown = [(kernel, column) for kernel in self.own for column in kernel.free]
        self.x = np.array([_unknown_at_sketch(kernel, column) for kernel, column in unknown])
        self.scale = np.array([1.0 if column % 3 == 2 else float(kernel.size) for kernel, column in unknown])
        self.turning = np.array([column % 3 == 2 for _, column in unknown])

        def stages(*data: TracedArray) -> Mapping[str, Any]:
            other = varied(data[:count])
            rebound = with_initial_guesses(
                [_with_loose_tolerance(kernel.rebind(other)) for kernel in kernels], data[count + 1 :], CORRECTOR_STEPS
            )
            states = link_states(other, rebound, data[count], 1, blank=False)  # type: ignore[arg-type]
            dets = {
                f"det{k}": at.det
                for k, at in enumerate(
                    at
                    for kernel, at in zip(rebound, states.placements, strict=True)
                    if isinstance(kernel, UnrolledNewton) and not kernel.linear
                )
            }
            return {**free_unknowns(states), **dets}

        self.program = trace_function(stages, *[1] * (count + 1 + count_initial_guesses(kernels)))
        _, self.signs = self._correct(self.first[None, :], np.array([self.at]), self.x[:, None], None)

    def _correct(self, numbers: Real, q: Real, x: Real, signs: Real | None) -> tuple[Real, Real]:
        """Correct the unknowns x of variants by Newton's method.

        signs: signs of the Jacobian determinants of the groups in the first linkage, (groups, 1). Variants that do
        not converge, or whose determinants have other signs, become nan.

        Returns:
            Unknowns and derivatives, (2, unknowns, variants), and the signs of the determinants, (groups,
            variants).
        """
        data = [*split_columns(numbers), q[:, None], *(unknown[:, None] for unknown in x)]
        outputs = self.program(*data)
        dets = np.sign([outputs.part(f"det{k}")[:, 0] for k in range(len(self.own))])
        sound = (
            outputs.part("sure")[:, 0] if signs is None else outputs.part("sure")[:, 0] & np.all(dets == signs, axis=0)
        )
        parts = np.stack([outputs.part(f"{unknown}{k}")[:, 0] for unknown in "xv" for k in range(len(x))])
        corrected = parts.reshape(2, *x.shape)
        corrected[0, :, ~sound] = np.nan
        return corrected, dets

    def _is_small_correction(self, corrected: Real, start: Real) -> Real:
        """Return True for the variants whose correction was small, (variants,)."""
        with np.errstate(invalid="ignore"):
            near: Real = np.max(np.abs(corrected - start) / self.scale[:, None], axis=0) < LARGEST_CORRECTION
        return near

    def continue_at_sketch(self, numbers: Real) -> Real:
        """Continue the unknowns to variants with these numbers (variants, n), at the position of the sketch.

        Returns:
            Unknowns and derivatives, (2, unknowns, variants); nan where the continuation failed.
        """
        variants = len(numbers)
        current = np.repeat(np.stack([self.x, np.full_like(self.x, np.nan)])[:, :, None], variants, axis=2)
        progress, stride = np.zeros(variants), np.full(variants, FIRST_SHARE)
        slope = np.zeros_like(current[0])
        for _ in range(MOST_ROUNDS):
            share = np.minimum(progress + stride, 1.0)
            start = current[0] + slope * (share - progress)
            between = self.first + share[:, None] * (numbers - self.first)
            corrected, _ = self._correct(between, np.full(variants, self.at), start, self.signs)
            good = self._is_small_correction(corrected[0], start) & (progress < 1)
            moved = np.where(good, share - progress, 1.0)
            slope = np.where(good, (corrected[0] - current[0]) / moved, slope)
            current = np.where(good, corrected, current)
            stride = np.where(good, np.where(progress > 0, 2 * stride, 1.0), stride / 2)
            progress = np.where(good, share, progress)
            if np.all(progress == 1):
                break
        return np.where(progress == 1, current, np.nan)

    def __call__(self, numbers: Real, low: Real, high: Real, count: int, *, closed: bool) -> ContinuedPaths:
        """Continue variants over their driver ranges.

        Args:
            numbers: numbers of the variants, (variants, n).
            low, high: ends of the driver ranges, (variants, 1).
            count: largest number of steps.
            closed: True if the motion repeats after the range; the range is then centred on the sketch.
        """
        if closed:
            half = (high - low) / 2
            low, high = self.at - half, self.at + half
        n = -(-count // 2) if closed else count
        ends = np.stack([low[:, 0], high[:, 0]]) - self.at
        ends[0], ends[1] = np.minimum(ends[0], 0.0), np.maximum(ends[1], 0.0)
        x, v = self._continue_in_steps(numbers, self.continue_at_sketch(numbers), ends / n, n)
        gain = None
        if closed:
            gain = x[:, :, -1:] - x[:, :, :1]
            around = np.where(self.turning[:, None, None], 2 * np.pi * np.round(gain / (2 * np.pi)), 0.0)
            with np.errstate(invalid="ignore"):
                other = np.any(np.abs(gain - around) > SAME_STATE * self.scale[:, None, None], axis=(0, 2))
            x[:, other] = np.nan  # after one cycle the assembly is different
        return ContinuedPaths(self.at, x, v, (-ends[0][:, None] / n, ends[1][:, None] / n), gain)

    def _continue_in_steps(self, numbers: Real, sketched: Real, steps: Real, n: int) -> Real:
        """Continue the unknowns and derivatives from the position of the sketch.

        steps: step lengths down and up, (2, variants).

        Returns:
            Unknowns and derivatives, (2, unknowns, variants, 2 n + 1).
        """
        variants = len(numbers)
        sides = [side for side in (0, 1) if np.any(steps[side])]  # directions in which there are steps
        numbers_by_side = np.tile(numbers, (len(sides), 1))
        h = np.concatenate([steps[side] for side in sides])
        current = np.tile(sketched, (1, 1, len(sides)))
        paths = np.full((*current.shape, n + 1), np.nan)
        paths[..., 0] = current
        bend = np.zeros_like(current[0])
        progress, step_share = np.zeros(len(h)), np.ones(len(h))  # number of steps
        active = np.isfinite(current[0, 0])
        while np.any(active):
            step = h * step_share
            start = current[0] + step * (current[1] + step / 2 * bend)
            corrected, _ = self._correct(numbers_by_side, self.at + h * progress + step, start, self.signs)
            good = self._is_small_correction(corrected[0], start) & active
            with np.errstate(invalid="ignore", divide="ignore"):
                bend = np.where(good & (step != 0), (corrected[1] - current[1]) / step, bend)
            current = np.where(good, corrected, current)
            progress = progress + step_share * good
            whole = np.flatnonzero(good & (progress == np.floor(progress)))
            paths[:, :, whole, progress[whole].astype(np.intp)] = current[:, :, whole]
            step_share = np.where(
                good,
                np.where(progress == np.floor(progress), np.minimum(1.0, 2 * step_share), step_share),
                step_share / 2,
            )
            active = active & (progress < n) & (step_share >= SHORTEST_STEP)
        nowhere = np.full((*sketched.shape, n), np.nan)
        side = {k: paths[:, :, row * variants : (row + 1) * variants] for row, k in enumerate(sides)}
        down = side[0][..., :0:-1] if 0 in side else nowhere
        up = side[1][..., 1:] if 1 in side else nowhere
        return np.concatenate([down, sketched[..., None], up], axis=-1)


def _with_loose_tolerance(kernel: GroupSolver) -> GroupSolver:
    """Return the group solver with the tolerance that suffices for initial guesses."""
    return replace(kernel, enough=CONVERGED) if isinstance(kernel, UnrolledNewton) else kernel


def _unknown_at_sketch(kernel: UnrolledNewton, column: int) -> float:
    """Return a free unknown of a group at the position of the sketch."""
    assert kernel.start is not None
    x, angle = kernel.start.x[0, column // 3], kernel.start.unwrapped[0, column // 3]
    return float((x.real, x.imag, angle)[column % 3])
