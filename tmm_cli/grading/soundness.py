"""Whether variants are fit for students: they turn, keep their stones in their slots, force no link across its way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.forces.given import reach_of_tables
from tmm_cli.grading.grade import numbers_of
from tmm_cli.grading.record import VariantTable
from tmm_cli.grading.task import Task
from tmm_cli.groups.sequence import LinkStates, link_states
from tmm_cli.kinematics.pressure import angle, followers, named
from tmm_cli.kinematics.strokes import Strokes
from tmm_cli.language import _, numeral
from tmm_cli.library import solve
from tmm_cli.results.warnings.forces import tables_of_many
from tmm_cli.tolerances import END_OF_SLOT
from tmm_cli.variants.family import Family, families
from tmm_cli.vectors import Real

SCAN = 48  # places in a turn of the driver: extremes between them are found by parabolas

Held = tuple[str, str]  # a link and the pairs in which it is driven


@dataclass(frozen=True)
class Faults:
    """What would be wrong with a variant, by the measure of the file's own.

    turns: of a full cycle; 0 where the driver does not turn fully. strokes: how many its output has. limits: largest
    pressure angles (rad): those that are allowed, or that of the file's own variant where it goes beyond one that the
    file does not set.
    """

    turns: int
    strokes: int
    limits: Mapping[Held, float]

    def of(self, family: Family) -> Real:
        """A sentence for every variant, "" where nothing is wrong."""
        linkage = family.linkage
        low = np.min(family.q, axis=1, keepdims=True)
        if self.turns:
            q = low + np.linspace(0, 2 * np.pi * self.turns, SCAN * self.turns + 1)
        else:
            q = low + (np.max(family.q, axis=1, keepdims=True) - low) * np.linspace(0, 1, SCAN + 1)
        states = link_states(linkage, family.kernels, q, 0)
        alike = family.strokes is None or _strokes(family.strokes) == self.strokes
        with np.errstate(all="ignore"):
            found = [
                (np.all(states.moving, axis=1), _("it cannot be assembled in all its positions")),
                (family.sound & alike, _("its output moves otherwise than that of the file")),
                *_margins(states),
                *_slots(states),
                *self._pressures(states),
            ]
        holds, sentences = zip(*found, strict=True)
        wrong = [~np.broadcast_to(one, len(q)) for one in holds]
        return np.asarray(np.select(wrong, sentences, "").astype(object))

    def _pressures(self, states: LinkStates) -> Iterator[tuple[Real, str]]:
        for kernel, at in zip(states.kernels, states.placements, strict=True):
            for lead in followers(kernel.group):
                limit = self.limits.get((lead[0], named(lead)))
                if limit is not None:
                    beyond = _("its pressure angle goes beyond {limit} deg")
                    told = beyond.format(limit=numeral(np.degrees(limit), ".4g"))
                    yield _top(angle(states, kernel, at, lead)) <= limit, told


def tables_apart(task: Task, table: VariantTable) -> Iterator[str]:
    """Load tables that do not end with the stroke of the variants of a table. Raises ProblemError."""
    linkage = task.problem.whole.linkage
    if not any(load.table is not None and load.table.against == "stroke" for load in linkage.loads):
        return
    dimensions, columns = numbers_of(task, table, list(table.rows))
    reach: dict[str, list[tuple[float, float]]] = {}
    for __, family in families(lambda numbers: task.make(table.names, dimensions, numbers), columns):
        if isinstance(family, Family):
            for load, last, stroke in reach_of_tables(family.linkage, family.strokes):
                rows = np.broadcast_arrays(np.ravel(last), np.ravel(stroke), np.zeros(len(family)))
                reach.setdefault(load.name, []).extend(zip(rows[0].tolist(), rows[1].tolist(), strict=True))
    yield from tables_of_many(linkage, task.units, reach)


def faults_of(task: Task) -> Faults:
    """Raises ProblemError where the file's own variant cannot be moved."""
    results = solve(task.problem, "kinematics")
    mechanism, problem = results.mechanism, results.problem
    limits = {
        (one.link, one.pair): one.allowed if problem.limits_set[not one.slides] else max(one.allowed, one.largest)
        for one in mechanism.pressure
    }
    full = mechanism.driver_range.full and problem.linkage.driver.kind == "turn"
    return Faults(mechanism.driver_range.turns if full else 0, _strokes(mechanism.strokes), limits)


def _strokes(strokes: Strokes | None) -> int:
    return 0 if strokes is None else len(strokes.strokes)


def _margins(states: LinkStates) -> Iterator[tuple[Real, str]]:
    for kernel, at in zip(states.kernels, states.placements, strict=True):
        margin = np.broadcast_to(at.margin, states.q.shape)
        yield -_top(-margin) > kernel.near, _("it comes near a dead position")


def _slots(states: LinkStates) -> Iterator[tuple[Real, str]]:
    driven = {driver.joint for driver in states.linkage.drivers if driver.kind == "slide"}
    for slide in states.linkage.slides:
        if slide.ends is not None and slide.name not in driven:
            first, last = (states.linkage.local(slide.carrier, name) for name in slide.ends)
            length = np.ravel(abs(last - first))
            run = np.broadcast_to(states.run(slide), states.q.shape)
            beyond = np.maximum(_top(run) - length, _top(-run))
            yield beyond <= END_OF_SLOT * length, _("a stone leaves its slot")


def _top(values: Real) -> Real:
    """The largest of each row, by a parabola through it and its neighbours."""
    k = np.argmax(values, axis=1)[:, None]
    last = values.shape[1] - 1
    before, top, after = (np.take_along_axis(values, np.clip(k + n, 0, last), 1)[:, 0] for n in (-1, 0, 1))
    bend = 2 * top - before - after
    inside = (k[:, 0] > 0) & (k[:, 0] < last) & (bend > 0)
    return top + np.where(inside, (before - after) ** 2 / (8 * np.where(inside, bend, 1.0)), 0.0)
