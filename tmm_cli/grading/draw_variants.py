"""Random variants of a task. They are feasible and differ from one another, and their answers cover the whole range."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from tmm_cli.batch import (
    Question,
    Task,
    Variant,
    VariantFamily,
    build_family,
    parameter_values,
    read_free_parameters,
    split_families,
)
from tmm_cli.grading.record import VariantTable
from tmm_cli.grading.run import read_parameter_values
from tmm_cli.grading.sheet import RightAnswers, compute_right_answers
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.forces import table_lengths
from tmm_cli.mechanics.groups import LinkStates, link_states
from tmm_cli.mechanics.kinematics import Strokes, driven_links, driving_pair_names, pressure_angle
from tmm_cli.mechanics.numerics import END_OF_SLOT, SAME_ASSEMBLY, Real, Vector
from tmm_cli.reports import warn_of_load_tables
from tmm_cli.synthesis import solve

SCAN = 48  # places in a turn of the driver: extremes between them are found by parabolas

Held = tuple[str, str]  # a link and the pairs in which it is driven


@dataclass(frozen=True)
class VariantRequirements:
    """Requirements on every variant, derived from the mechanism of the problem file.

    Attributes:
        turns: crank revolutions in a full cycle; 0 if the driver does not rotate fully.
        strokes: number of strokes of the output in a cycle.
        limits: largest permitted pressure angles (rad), by link and pair.
    """

    turns: int
    strokes: int
    limits: Mapping[Held, float]

    def check(self, family: VariantFamily) -> Real:
        """Return the reason why each variant is rejected, (variants,); an empty text for a feasible variant."""
        linkage = family.linkage
        low = np.min(family.q, axis=1, keepdims=True)
        if self.turns:
            q = low + np.linspace(0, 2 * np.pi * self.turns, SCAN * self.turns + 1)
        else:
            q = low + (np.max(family.q, axis=1, keepdims=True) - low) * np.linspace(0, 1, SCAN + 1)
        states = link_states(linkage, family.kernels, q, 0)
        alike = family.strokes is None or _count_strokes(family.strokes) == self.strokes
        with np.errstate(all="ignore"):
            found = [
                (np.all(states.moving, axis=1), _("the mechanism cannot be assembled in some positions")),
                (family.sound & alike, _("the output link moves differently than in the problem file")),
                *_check_margins(states),
                *_check_slots(states),
                *self._check_pressures(states),
            ]
        holds, sentences = zip(*found, strict=True)
        wrong = [~np.broadcast_to(one, len(q)) for one in holds]
        return np.asarray(np.select(wrong, sentences, "").astype(object))

    def _check_pressures(self, states: LinkStates) -> Iterator[tuple[Real, str]]:
        for kernel, at in zip(states.kernels, states.placements, strict=True):
            for lead in driven_links(kernel.group):
                limit = self.limits.get((lead[0], driving_pair_names(lead)))
                if limit is not None:
                    beyond = _("the pressure angle exceeds {limit} deg")
                    told = beyond.format(limit=numeral(np.degrees(limit), ".4g"))
                    yield _refine_maximum(pressure_angle(states, kernel, at, lead)) <= limit, told


def check_load_tables(task: Task, table: VariantTable) -> Iterator[str]:
    """Yield a warning for each load table whose last argument differs from the stroke of some variants.

    Raises:
        ProblemError: The table or the task is wrong.
    """
    linkage = task.problem.whole.linkage
    if not any(load.table is not None and load.table.against == "stroke" for load in linkage.loads):
        return
    dimensions, columns = read_parameter_values(task, table, list(table.rows))
    reach: dict[str, list[tuple[float, float]]] = {}
    for __, family in split_families(lambda numbers: task.make(table.names, dimensions, numbers), columns):
        if isinstance(family, VariantFamily):
            for load, last, stroke in table_lengths(family.linkage, family.strokes):
                rows = np.broadcast_arrays(np.ravel(last), np.ravel(stroke), np.zeros(len(family)))
                reach.setdefault(load.name, []).extend(zip(rows[0].tolist(), rows[1].tolist(), strict=True))
    yield from warn_of_load_tables(linkage, task.units, reach)


def derive_requirements(task: Task) -> VariantRequirements:
    """Derive the requirements on variants from the mechanism of the problem file.

    Raises:
        ProblemError: The mechanism of the file cannot be moved.
    """
    results = solve(task.problem, "kinematics")
    mechanism, problem = results.mechanism, results.problem
    limits = {
        (one.link, one.pair): one.allowed if problem.limits_set[not one.slides] else max(one.allowed, one.largest)
        for one in mechanism.pressure
    }
    full = mechanism.driver_range.full and problem.linkage.driver.kind == "turn"
    return VariantRequirements(mechanism.driver_range.turns if full else 0, _count_strokes(mechanism.strokes), limits)


def _count_strokes(strokes: Strokes | None) -> int:
    return 0 if strokes is None else len(strokes.strokes)


def _check_margins(states: LinkStates) -> Iterator[tuple[Real, str]]:
    for kernel, at in zip(states.kernels, states.placements, strict=True):
        margin = np.broadcast_to(at.margin, states.q.shape)
        yield -_refine_maximum(-margin) > kernel.near, _("the mechanism comes close to a dead position")


def _check_slots(states: LinkStates) -> Iterator[tuple[Real, str]]:
    driven = {driver.joint for driver in states.linkage.drivers if driver.kind == "slide"}
    for slide in states.linkage.slides:
        if slide.ends is not None and slide.name not in driven:
            first, last = (states.linkage.local(slide.carrier, name) for name in slide.ends)
            length = np.ravel(abs(last - first))
            run = np.broadcast_to(states.run(slide), states.q.shape)
            beyond = np.maximum(_refine_maximum(run) - length, _refine_maximum(-run))
            yield beyond <= END_OF_SLOT * length, _("a sliding block leaves its slot")


def _refine_maximum(values: Real) -> Real:
    """Return the maximum of each row, (variants,), refined by a parabola through the neighbouring samples."""
    k = np.argmax(values, axis=1)[:, None]
    last = values.shape[1] - 1
    before, top, after = (np.take_along_axis(values, np.clip(k + n, 0, last), 1)[:, 0] for n in (-1, 0, 1))
    bend = 2 * top - before - after
    inside = (k[:, 0] > 0) & (k[:, 0] < last) & (bend > 0)
    return top + np.where(inside, (before - after) ** 2 / (8 * np.where(inside, bend, 1.0)), 0.0)


# Drawing variants of a task that are sound, unlike one another, and spread over what comes out of them.
#
# Candidates are drawn and judged in chunks, as arrays. A pool of those that are sound is put in an order in which
# each lies farthest, in what is asked of it, from all before it. Numbered variants are the pool from its beginning. A
# student of a list goes through the pool in an order of his own, which hangs on the seed and his name alone, and has
# the first that nobody before him has.


CHUNK = 2_000  # candidates at once
TRIED = 20_000  # candidates of a pool at most
SLOWLY = 300  # likewise, where each is moved alone
ENOUGH = 2_000  # sound candidates of a pool
POOL = 1_000  # variants of a pool at most
POOLS = 20  # after so many the rest of the students have none
CLOSE = 3.0  # times what is allowed anyway: an answer on which drawing errors act more can hardly be judged
MOSTLY = 0.75  # of what is asked is to be better than that


@dataclass(frozen=True)
class CheckedCandidates:
    """Candidates for variants, checked against the requirements.

    Attributes:
        why: reason of rejection, "" for a feasible candidate, (candidates,).
        rows: indices of the feasible candidates.
        values: right answers of the feasible candidates, (feasible, answers); if the task requests no answers, the
            values of their parameters.
        allowed: tolerances of the answers, SI, same shape.
    """

    why: Real
    rows: Real
    values: Vector
    allowed: Real


class VariantGenerator:
    """Generator of random variants of a task.

    Attributes:
        names: names of the parameters that vary.
        size: number of all possible combinations of their values.
        tried: number of candidates checked so far.
        rejected: number of rejected candidates by reason.

    Raises:
        ProblemError: The task cannot be varied.
    """

    def __init__(self, task: Task) -> None:
        self.task, self.requirements = task, derive_requirements(task)
        self.free = read_free_parameters(task)
        self.names = tuple(choice.name for choice in self.free)
        self.dimensions = tuple(choice.dimension for choice in self.free)
        self.numbers = [parameter_values(task, choice) for choice in self.free]
        self.asked: tuple[Question, ...] = task.asked if task.blocks.grading else ()
        own = [task.number(v, d) for v, d in zip(task.values_in_file(self.names), self.dimensions, strict=True)]
        self.own = np.array([own])
        self.size = math.prod(len(choice.texts) for choice in self.free)
        self.rejected: Counter[str] = Counter()
        self.tried = 0
        base = build_family(self._make, np.concatenate([self.own, self.own]))
        self.alone = base is None or not bool(np.all(base.sound))

    def _make(self, values: Sequence[Any]) -> Variant:
        return self.task.make(self.names, self.dimensions, values)

    def table_cells(self, picks: Real) -> tuple[str, ...]:
        """Return the parameter values of a candidate as table cells.

        picks: for each parameter, the index of its value in the list of permitted values.
        """
        return tuple(choice.texts[k] for choice, k in zip(self.free, picks.tolist(), strict=True))

    def check(self, picks: Real) -> CheckedCandidates:
        """Check candidates against the requirements on variants.

        Args:
            picks: Indices of the parameter values, (candidates, parameters).

        Raises:
            ProblemError: A candidate is not a valid problem.
        """
        columns = np.stack([values[picks[:, k]] for k, values in enumerate(self.numbers)], axis=1)
        why = np.full(len(columns), "", dtype=object)
        rows, found = [np.zeros(0, dtype=int)], [(np.zeros((0, len(self.asked) or len(self.free))),) * 2]
        for at, family in self._build_families(columns):
            if isinstance(family, LinkageError):
                why[at] = _("the mechanism cannot be assembled in some positions")
                continue
            own = self.requirements.check(family)
            sound = np.flatnonzero(own == "")
            if self.asked and sound.size:
                wanted = compute_right_answers(family.take(sound), self.asked)
                good = _find_well_conditioned(wanted)
                own[sound[~good]] = _(
                    "the requested quantities are too sensitive to errors in the lengths of the links"
                )
                found.append((wanted.value[good], (wanted.allowed * wanted.scale)[good]))
                sound = sound[good]
            elif sound.size:
                found.append((columns[at[sound]], np.zeros((len(sound), len(self.free)))))
            rows.append(at[sound])
            why[at] = own
        values, allowed = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return CheckedCandidates(why, np.concatenate(rows), values.astype(complex), allowed)

    def _build_families(self, columns: Real) -> Iterator[tuple[Real, VariantFamily | LinkageError]]:
        """Yield families of candidates: the indices of the candidates, and the family or the error that prevents its
        solution.

        All candidates form one family that has the assembly of the task file. If such a family cannot be built, every
        candidate forms a family of its own.
        """
        if not self.alone:
            family = build_family(self._make, np.concatenate([self.own, columns]))
            if family is not None:
                yield np.arange(len(columns)), family.take(np.arange(1, len(family)))
                return
        for row, own in enumerate(columns):
            yield from ((np.array([row]), family) for _rows, family in split_families(self._make, own[None]))

    def draw_pools(self, seed: int) -> Iterator[Iterator[Real]]:
        """Yield several sets (pools) of feasible candidates, each as an iterator.

        The iterator always continues with the candidate whose answers differ most from those of all candidates before.
        """
        for number in range(POOLS):
            random = np.random.default_rng([seed, number])
            tried = SLOWLY if self.alone else TRIED
            lengths = [len(values) for values in self.numbers]
            every = self.size <= tried
            if every and number:
                return
            if every:
                picks = random.permutation(np.stack(np.unravel_index(np.arange(int(self.size)), lengths), axis=1))
            else:
                drawn = np.stack([random.integers(0, n, tried) for n in lengths], axis=1)
                picks = drawn[np.sort(np.unique(drawn, axis=0, return_index=True)[1])]
            yield self._draw_pool(picks)

    def _draw_pool(self, picks: Real) -> Iterator[Real]:
        parts: list[CheckedCandidates] = []
        for first in range(0, len(picks), CHUNK):
            parts.append(self.check(picks[first : first + CHUNK]))
            self.rejected.update(why for why in parts[-1].why.tolist() if why)
            self.tried += len(parts[-1].why)
            if sum(len(part.rows) for part in parts) >= ENOUGH:
                break
        rows = np.concatenate([part.rows + CHUNK * n for n, part in enumerate(parts)])
        values, allowed = (np.concatenate([getattr(p, name) for p in parts]) for name in ("values", "allowed"))
        return (picks[rows[row]] for row in _order_by_distance(values, allowed, self.rejected))

    def keeps_assembly(self, picks: Real) -> bool:
        """Return True if the variant, as a problem file of its own, has the same assembly as the file of the task."""
        if not self._has_same_assembly(picks):
            self.rejected[_("solved from a separate problem file, this variant would be assembled differently")] += 1
            return False
        return True

    def _has_same_assembly(self, picks: Real) -> bool:
        row = np.array([[values[k] for values, k in zip(self.numbers, picks, strict=True)]])
        alone = next(split_families(self._make, row))[1]
        if isinstance(alone, LinkageError):
            return False
        if self.alone:
            return True
        _rows, family = next(self._build_families(row))
        assert isinstance(family, VariantFamily)
        one, other = (link_states(f.linkage, f.kernels, alone.q[:, :1], 0).poses for f in (alone, family))
        return all(bool(np.allclose(one[link].z, other[link].z, atol=SAME_ASSEMBLY)) for link in one)


def draw_numbered_variants(variety: VariantGenerator, seed: int, count: int) -> VariantTable:
    """Draw variants numbered from 1.

    Args:
        variety: Generator of variants.
        seed: Seed of the random numbers; the same seed gives the same variants.
        count: Number of variants.

    Returns:
        Table with `count` variants, or fewer if there are not enough different ones.

    Raises:
        ProblemError: The task cannot be varied.
    """
    every = (picks for pool in variety.draw_pools(seed) for picks in pool if variety.keeps_assembly(picks))
    rows = {variety.table_cells(picks): None for picks in islice(every, count)}
    return VariantTable(variety.names, {str(n + 1): row for n, row in enumerate(rows)})


def draw_student_variants(variety: VariantGenerator, seed: int, students: Sequence[str]) -> VariantTable:
    """Draw a different variant for each student.

    Args:
        variety: Generator of variants.
        seed: Seed of the random numbers. A student's variant depends on the seed and the name only, unless it is taken
            already.
        students: Names of the students; the first in the list choose first.

    Returns:
        Table of the variants; without the last students if there are not enough different variants.

    Raises:
        ProblemError: The task cannot be varied.
    """
    found: dict[str, tuple[str, ...]] = {}
    taken: set[tuple[str, ...]] = set()
    for number, pool in enumerate(variety.draw_pools(seed)):
        every = list(islice(pool, POOL))
        for student in students:
            if student in found:
                continue
            key = hashlib.sha256(f"{seed} {number} {student}".encode()).digest()
            order = np.random.default_rng(int.from_bytes(key)).permutation(len(every))
            free = (k for k in order if variety.table_cells(every[k]) not in taken and variety.keeps_assembly(every[k]))
            own = next(free, None)
            if own is not None:
                found[student] = variety.table_cells(every[own])
                taken.add(found[student])
        if len(found) == len(students):
            break
    return VariantTable(variety.names, {student: found[student] for student in students if student in found})


def _find_well_conditioned(found: RightAnswers) -> Real:
    """Return True for each variant most of whose answers have not much more than the usual tolerance, (variants,).

    In such a variant small drawing errors do not change most answers noticeably.
    """
    tolerance = np.array([one.tolerance for one in found.asked])
    exact = np.array([one.quantity.against == "exact" for one in found.asked])
    return np.asarray(np.mean((found.allowed <= CLOSE * tolerance) | exact, axis=1) >= MOSTLY)


def _order_by_distance(values: Vector, allowed: Real, rejected: Counter[str]) -> Iterator[int]:
    """Yield row indices in such an order that each row lies as far as possible from all rows before it.

    Distances are relative to the range of each value. A row that agrees with an earlier row within the tolerances is
    dropped and counted in `rejected`.
    """
    if not len(values):
        return
    size = np.nanmax(values.real, axis=0) - np.nanmin(values.real, axis=0) + np.ptp(values.imag, axis=0)
    varies = size > 0
    places = values[:, varies] / size[varies]
    far = np.full(len(values), np.inf)
    row = 0
    while far[row] > 0:
        yield row
        apart = np.abs(places - places[row])
        far = np.minimum(far, np.sqrt(np.sum(apart**2, axis=1)))
        alike = ~np.any(np.abs(values - values[row]) > allowed, axis=1) & (far > 0)
        rejected[_("the answers coincide with those of another variant")] += int(np.count_nonzero(alike)) - int(
            alike[row]
        )
        far[alike] = 0
        far[row] = 0
        row = int(np.argmax(far))
