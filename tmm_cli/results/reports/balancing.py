"""Balancing: counterweights, what shakes the frame before and after, and masses on a shaft."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.balancing import Balancing
from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import N_, _
from tmm_cli.quantities import ANGLE, FORCE, MASS, MOMENT, NUMBER
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.reports.quality import Row, of_rows
from tmm_cli.results.table import Column, Table
from tmm_cli.tolerances import NO_FORCE


def tables(results: Results) -> Iterable[Table]:
    """What was found, then what shakes at every position."""
    found = results.balancing
    assert found is not None
    rows, notes = [*_counterweights(found), *_largest(found), *_rotor(results, found)], [*_notes(found)]
    yield Table("balancing", _("Balancing"), of_rows(rows, results), notes=tuple(notes))
    if found.cycle.shakes:
        yield _positions(results, found)


def _counterweights(found: Balancing) -> Iterable[Row]:
    for weight in found.cycle.counterweights:
        link = weight.place.link
        yield _("counterweight on link {link}: mass times radius, kg*m").format(link=link), weight.size, NUMBER
        yield _("its angle from the x axis of link {link}").format(link=link), weight.angle, ANGLE
        if weight.mass is not None:
            yield _("its mass at the radius of the file"), weight.mass, MASS


def _largest(found: Balancing) -> Iterable[Row]:
    if not found.cycle.shakes:
        return
    before, after = found.cycle.before, found.cycle.after
    yield _("largest shaking force"), np.nanmax(np.abs(before.force)), FORCE
    if found.cycle.counterweights:
        yield _("largest shaking force, balanced"), np.nanmax(np.abs(after.force)), FORCE
        yield _("share that is left, %"), 100 * found.cycle.left, NUMBER
    yield _("largest shaking moment"), np.nanmax(np.abs(before.moment)), MOMENT
    if found.cycle.counterweights:
        yield _("largest shaking moment, balanced"), np.nanmax(np.abs(after.moment)), MOMENT


def _rotor(results: Results, found: Balancing) -> Iterable[Row]:
    rotor = found.task.rotor
    if rotor is None:
        return
    rate = results.linkage.driver.rate
    for words, added in ((_("shaft"), None), (_("shaft, balanced"), found.corrections)):
        force, couple = (abs(part) * rate**2 for part in rotor.unbalance(added))
        yield _("{shaft}: centrifugal force").format(shaft=words), force, FORCE
        yield _("{shaft}: couple about the first plane").format(shaft=words), couple, MOMENT
    for number, (plane, size) in enumerate(zip(rotor.planes, found.corrections.tolist(), strict=True), 1):
        yield _("mass in plane {number}: mass times radius, kg*m").format(number=number), abs(size), NUMBER
        yield _("its angle"), float(np.mod(np.angle(size), 2 * np.pi)), ANGLE
        if plane.radius:
            yield _("its mass at the radius of the file"), abs(size) / plane.radius, MASS


def _notes(found: Balancing) -> Iterable[str]:
    if found.cycle.shakes:
        yield _("Shaking: forces of inertia of all links on the frame, over the cycle at constant speed of the driver.")
    if found.cycle.alike:
        yield _("Some counterweights could do what others do: of all ways to balance the least masses are shown.")
    if any(weight.mass is None for weight in found.cycle.counterweights):
        yield _("Where no radius is told, the counterweight's own moment of inertia is left out of the shaking moment.")


def _positions(results: Results, found: Balancing) -> Table:
    columns = driver_columns(results)
    told = [(found.before, "F x", "F y", "F", "M")]
    if found.cycle.counterweights:
        told.append((found.after, N_("F x, balanced"), N_("F y, balanced"), N_("F, balanced"), N_("M, balanced")))
    least = NO_FORCE * float(np.nanmax(np.abs(found.cycle.before.force)))
    for shaking, *headers in told:
        force = np.where(np.abs(shaking.force) < least, 0, shaking.force)  # rounding is none
        values = (force.real, force.imag, np.abs(force), shaking.moment)
        columns += [
            Column(h, v, MOMENT if v is shaking.moment else FORCE) for h, v in zip(headers, values, strict=True)
        ]
    note = _("M is about {pivot}, counterclockwise.").format(pivot=found.pivot or _("the origin"))
    return Table("shaking", _("Shaking force and moment on the frame"), tuple(columns), notes=(note,))
