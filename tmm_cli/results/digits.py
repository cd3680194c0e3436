"""Bounds by rounding and sensitivity to the data for every number of the tables and of result.json.

Ordinarily the margins of the groups say how many digits are true (accuracy.margins), and only positions where that is
less than a table prints are judged. When digits are asked for all are: tables and result.json are made by their own
functions from the results in double-doubles and from those with changed lengths too, and compared one by one; so no
quantity can be forgotten, and none needs a formula of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

import numpy as np

from tmm_cli.accuracy.digits import PAPER, Digits, is_angle, judged
from tmm_cli.accuracy.margins import FEWEST, relative, sizes
from tmm_cli.accuracy.searches import blur, searched
from tmm_cli.accuracy.wide import Wide, coarsely
from tmm_cli.analysis.extended import near_dead
from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.kinematics.motion import FIXED
from tmm_cli.language import N_, _, numeral, translated
from tmm_cli.linkage import FRAME
from tmm_cli.plans.record import sheet_scale
from tmm_cli.quantities import NUMBER, Dimension
from tmm_cli.results.as_json import numbers
from tmm_cli.results.cells import cells, keys_of, parallel, reader
from tmm_cli.results.coarse import by_margins
from tmm_cli.results.table import Column, Table
from tmm_cli.tolerances import ROUNDOFF
from tmm_cli.vectors import Real, Record, mapped

DENSE = 361  # places of a trajectory
WHOLE = (*FIXED - {"where"}, "mechanism", "problem", "inputs", "structure")  # fields that hold no array over positions
LONG = 720  # positions: of a longer cycle only so many are judged, and all that are near dead ones
PARTS = {"bound": N_("± rounding"), "lengths": N_("± lengths"), "paper": N_("± paper")}


@dataclass(frozen=True)
class AccuracyReport:
    """How far the numbers of results are to be trusted: those at positions, and those that were searched for.

    relative: bounds at all positions as shares of the largest of each kind (`sizes`). chosen: positions that were
    judged; there: results at them; digits: of their numbers by key. full: whether sensitivities are wanted too. found
    judges what was searched for when a table of it is shown.
    """

    results: Results
    relative: Real
    sizes: Mapping[Dimension, float]
    found: Callable[[], Digits]
    chosen: Real
    there: Results
    digits: Digits
    full: bool

    def with_bounds(self, tables: Iterable[Table]) -> Iterator[Table]:
        """Tables with the bounds that were found, one after the other; with all digits last the table of the worst."""
        worst: list[tuple[str | float, ...]] = []
        for table in map(self.table, tables):
            rows = list(_worst(table)) if self.full else []
            worst += [(table.name, *row) for row in rows]
            yield replace(table, notes=(*table.notes, _note(rows))) if rows else table
        if self.full:
            yield self.summary(worst)

    def table(self, table: Table) -> Table:
        """The same table, its numbers with their bounds and sensitivities."""
        keys = keys_of(table, len(self.relative))
        columns = [
            replace(column, **self._parts(table, k, None if keys is None else keys[k]))
            for k, column in enumerate(table.columns)
        ]
        return replace(table, columns=tuple(columns))

    def _parts(self, table: Table, k: int, keys: list[Hashable] | None) -> dict[str, Any]:
        """The bounds of the k-th column, and its sensitivities if wanted. keys: of its rows at one position, if any."""
        column, single = table.columns[k], (False, table.name, k)
        if column.dimension is None or (keys is None and single not in self.found().bound):
            return {}
        if keys is not None and self.chosen.size and keys[0] not in self.digits.bound:  # a law of motion, as it is
            return {}
        wanted = tuple(PARTS) if self.full else ("bound",)
        if keys is None:
            return {part: getattr(self.found(), part)[single] for part in wanted}
        near = np.searchsorted(self.chosen, np.arange(len(self.relative))).clip(max=len(self.chosen) - 1)
        found = {part: self._judged(part, keys)[near] for part in wanted if self.chosen.size}
        if self.chosen.size < len(near):
            rough = by_margins(self.results, self.relative, self.sizes, table, column).reshape(len(near), -1)
            rough[self.chosen] = found["bound"][self.chosen] if self.chosen.size else rough[self.chosen]
            found["bound"] = rough
        return {part: values.ravel() for part, values in found.items()}

    def _judged(self, part: str, keys: list[Hashable]) -> Real:
        """What was judged, (chosen positions, rows)."""
        nothing = np.full(len(self.chosen), np.nan)
        return np.stack([getattr(self.digits, part).get(key, nothing) for key in keys], axis=1)

    def summary(self, rows: Sequence[tuple[str | float, ...]]) -> Table:
        """Table by table and column by column: the largest bound, digits to be trusted, sensitivities."""
        words = (_("table"), _("column"))
        figures = (_("bound by rounding"), _("true digits"), _("change by 0.1 % of lengths, %"),
                   _("change by 0.5 mm on paper, %"))  # fmt: skip
        columns = [Column(header, [row[k] for row in rows]) for k, header in enumerate(words)]
        for k, header in enumerate(figures, len(words)):
            columns.append(Column(header, [float(f"{row[k]:.2g}") for row in rows], NUMBER, digits=2))
        title = _("Digits to be trusted: the worst of each column, relative to its largest value")
        return Table("digits", title, tuple(columns), notes=(_scale(self.digits.mu),))

    def json(self) -> dict[str, Any] | None:
        """The section `digits` of result.json: bounds and sensitivities in the places of their values; if wanted."""
        if not self.full:
            return None
        content = dict(numbers(self.there))
        named: dict[str, Any] = {"scale": self.digits.mu, "number": list(self.there.numbers)}
        for part in PARTS:
            values = {**getattr(self.digits, part), **getattr(self.found(), part)}
            named[part] = parallel(content, {key[1:]: v for key, v in values.items()}) or {}
        return named


def taken(record: Record, chosen: Real, count: int) -> Record:
    """A record of arrays over so many positions with the chosen ones only; all that are in a finer one are chosen."""

    def of_chosen(path: str, leaf: Any) -> Any:
        return leaf[..., chosen] if isinstance(leaf, np.ndarray) and leaf.shape[-1:] == (count,) else leaf

    return mapped(of_chosen, record, skip=WHOLE)


def accuracy(results: Results, full: bool = False, shown: Collection[str] = ()) -> AccuracyReport:
    """How far all numbers of results that have a motion are to be trusted; full: each of them judged.

    shown: tables that alone are shown; nothing is judged then that is in result.json only.
    """
    motion, count = results.motion, len(results.numbers)
    assert motion is not None
    with np.errstate(all="ignore"):
        mu = _mu(results) if full else float("nan")
        wide = Wide(results) if full else coarsely(results)
        found = cache(lambda: searched(results, reader(results, full and not shown), wide, mu))
        start = blur(results, wide)
        share = relative(results, start)
        asked = share > FEWEST
        if full:
            asked[:: -(-count // LONG)] = True
            asked[-1:] = True
        if np.any(asked):
            asked |= near_dead(motion) if motion.where is None else motion.where | near_dead(motion)
        chosen, there, digits = np.flatnonzero(asked), results, Digits(mu=mu)
        if 0 < len(chosen) < count:
            there = replace(taken(results, chosen, count), numbers=tuple(results.numbers[k] for k in chosen))
        if len(chosen):
            away = start + 3 * ROUNDOFF * np.abs(motion.q[chosen])
            digits = judged(there, partial(cells, shown=shown), mu=mu, blur=away)
    for key, bound in digits.bound.items():
        if is_angle(key):  # no direction is farther from another one than half a turn: that far tells nothing
            digits.bound[key] = np.where(bound >= np.pi, np.inf, bound)
    return AccuracyReport(results, share, sizes(results), found, chosen, there, digits, full)


def _worst(table: Table) -> Iterator[tuple[str, float, float, float, float]]:
    """Of each column with digits: header, largest bound relative to its largest value, true digits, changes in %.

    Of a table in which every row has a unit of its own, the same of each row, beside the largest value of that unit.
    """
    units = np.array(table.columns[-1].values) if table.columns[-1].header == "unit" else None
    for column in table.columns:
        if column.bound is None:
            continue
        parts = np.stack([column.array, *(getattr(column, part) for part in PARTS)])
        rows = [(slice(None), slice(None), column.header)]
        if units is not None:
            rows = [(slice(k, k + 1), units == unit, table.columns[0].values[k]) for k, unit in enumerate(units)]
        for own, alike, name in rows:
            (size,), (bound, share, paper) = _most(parts[:1, alike]), _most(parts[1:, own])
            if size > 0 and bound < size:  # else it is nothing but rounding
                true = np.floor(-np.log10(2 * max(bound / size, ROUNDOFF)))
                yield translated(name), bound / size, true, 100 * share / size, 100 * paper / size


def _most(values: Real) -> Real:
    """The largest number of each row; nan where there is none."""
    values = np.abs(values)
    sound = np.isfinite(values)
    return np.where(sound.any(axis=1), np.max(values, axis=1, where=sound, initial=0.0), np.nan)


def _note(rows: Sequence[tuple[str, float, float, float, float]]) -> str:
    """What to know of the worst columns of a table."""
    bound, share, paper = (max(rows, key=lambda row: 0.0 if np.isnan(row[k]) else row[k]) for k in (1, 3, 4))
    if not share[3] > 0:
        return _("Rounding: at most {bound} of the largest value of a column.").format(bound=numeral(bound[1], ".1e"))
    return _(
"Rounding: at most {bound} of the largest value of a column. Lengths 0.1 % off: up to "
"{lengths} % ({by_lengths}); 0.5 mm on paper: up to {paper} % ({by_paper})."
).format(bound=numeral(bound[1], ".1e"), lengths=numeral(share[3], ".2g"), by_lengths=share[0],
        paper=numeral(paper[4], ".2g"), by_paper=paper[0],
    )  # fmt: skip


def _scale(mu: float) -> str:
    return _(
        "± lengths: when every length is 0.1 % off; ± paper: when every coordinate is {mm} mm "
        "off on paper at {mu} m a mm, where the mechanism fits on A4. Worst cases, to first "
        "order."
    ).format(mm=PAPER, mu=numeral(mu, ".10g"))


def _mu(results: Results) -> float:
    """Scale (m a mm) at which the mechanism fits on a sheet with all its trajectories."""
    motion, linkage = at_positions(results, results.closely(DENSE), 0), results.linkage
    places = [complex(linkage.local(FRAME, h.point)) for h in linkage.hinges if FRAME in h.links]
    for name in linkage.moving:
        for point in linkage.links[name].points:
            way = motion.spot(point)
            way = way[np.isfinite(way)]
            if way.size:
                places += [complex(most(way.real), most(way.imag)) for most in (np.min, np.max)]
    return sheet_scale(places)[1]


def beside(table: Table) -> Table:
    """The table with bound and sensitivities of every number beside it."""
    columns: list[Column] = []
    for k, column in enumerate(table.columns):
        columns.append(column)
        if column.bound is not None and (k > 1 or table.columns[0].header != "position"):
            for part, header in PARTS.items():
                columns.append(Column(header, getattr(column, part), column.dimension, digits=2, unit=column.unit))
    return replace(table, columns=tuple(columns))
