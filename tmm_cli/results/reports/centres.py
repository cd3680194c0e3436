"""Instantaneous centres in the positions in detail, and the mechanical advantage over the cycle."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.kinematics.centres import Centre
from tmm_cli.kinematics.output import output_run
from tmm_cli.language import N_, Phrase, _
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table

DEAD = 1e-9  # of the largest ratio of speeds: where an output is so slow it stands


def name(links: tuple[str, str]) -> str:
    """P13 of links 1 and 3."""
    return "P" + ("" if all(len(link) == 1 for link in links) else ",").join(links)


def tables(results: Results) -> Iterable[Table]:
    """A row a centre; then what the driver's moment or force does at the outputs."""
    found = [(k, centre) for k, here in (results.centres or {}).items() for centre in here]
    places = [centre.place for __, centre in found]
    away = [None if c.direction is None else float(np.angle(c.direction) % np.pi) for __, c in found]
    columns = (
        Column(N_("position"), [str(results.numbers[k]) for k, __ in found]),
        Column(N_("centre"), [name(centre.links) for __, centre in found]),
        Column(N_("x"), [None if p is None else p.real for p in places], LENGTH),
        Column(N_("y"), [None if p is None else p.imag for p in places], LENGTH),
        Column(N_("at infinity, at an angle of"), away, ANGLE),
        Column(N_("found by"), [_way(centre) for __, centre in found]),
    )
    note = _("P13 is the point in which links 1 and 3 move alike; 0 is the frame.")
    yield Table("centres", _("Instantaneous centres"), columns, notes=(note,))
    yield from _advantage(results)


def _way(centre: Centre) -> str:
    if centre.pair:
        return _("pair {pair}").format(pair=centre.pair)
    if centre.place is None and centre.direction is None:
        return _("the links do not move beside one another")
    if not centre.lines:
        return _("velocities")
    lines = [" ".join(map(name, line)) for line in centre.lines]
    return lines[0] if len(lines) == 1 else _("{one} and {other}").format(one=lines[0], other=lines[1])


def _advantage(results: Results) -> Iterable[Table]:
    """Moment or force of each output over the driver's, without weights, inertia and friction."""
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    columns = []
    for link in results.mechanism.outputs if not linkage.others else ():
        slope = np.abs(output_run(motion, link)[1])
        bounded = slope > DEAD * np.max(slope, where=np.isfinite(slope), initial=0.0)
        gained = np.where(bounded, 1 / np.where(bounded, slope, 1.0), np.nan)
        columns.append(Column(Phrase(N_("of {link}, SI"), link=link), gained, NUMBER))
    if columns:
        note = _(
            "What an output can overcome, by the moment or force of the driver: N*m or N for one N*m or N; without "
            "weights, inertia and friction. At the ends of a stroke it has no bound."
        )
        table = (*driver_columns(results), *columns)
        yield Table("advantage", _("Mechanical advantage"), table, notes=(note,))
