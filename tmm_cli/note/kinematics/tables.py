"""Tables of all positions: the output, angular velocities and accelerations of links; diagrams over the cycle."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Figure, Line, Ref, Rows, listed, said, tabled
from tmm_cli.note.context import Subject
from tmm_cli.note.kinematics.driver import output
from tmm_cli.note.kinematics.on_paper import unit
from tmm_cli.note.tables import over_positions
from tmm_cli.plans.record import Symbol
from tmm_cli.results.reports.cycle import output_motion, states
from tmm_cli.tolerances import NO_VECTOR
from tmm_cli.vectors import Real, largest, without_rounding

BESIDE = 6  # columns of what links turn with in one table


Column = tuple[Line, Real]  # head, values of a quantity in all positions in the unit of its head


def tables(subject: Subject) -> Iterable[Block]:
    """What is found in all positions in the same way."""
    results, motion = subject.results, subject.motion
    for link in results.mechanism.outputs:
        letters = ("φ", "ω", "ε") if results.linkage.output_swings(link) else ("s", "v", "a")
        units = ("°", unit("ω"), unit("ε")) if letters[0] == "φ" else (_("m"), unit("v"), unit("a"))
        columns = []
        for letter, per, (__, values, ___) in zip(letters, units, output_motion(results, motion, link), strict=True):
            own = without_rounding(values, largest(values))
            columns.append(((Symbol(letter, link), f", {per}"), np.degrees(own) if per == "°" else own))
        caption = _("Motion of the output, {output}").format(output=output(subject, link))
        text = _("The motion of the output in all positions is given in table {table}.")
        yield from tabled(text, _table(subject, caption, columns, f"output-{link}"))
    yield from _turning(subject)
    for stem, drawing in subject.drawings("diagrams").items():
        if stem.startswith("diagrams"):
            yield said(_("The diagrams of motion are shown in figure {figure}."), figure=Ref(stem))
            yield Figure(_("Diagrams of motion over the cycle"), drawing, stem)
        elif stem.startswith("pressure"):
            yield said(_("The pressure angles are shown in figure {figure}."), figure=Ref(stem))
            yield Figure(_("Pressure angles over the cycle"), drawing, stem)


def _turning(subject: Subject) -> Iterable[Block]:
    """Of the links, in one table if it is not too wide."""
    velocities, accelerations = _rates(subject, "ω", "omega"), _rates(subject, "ε", "epsilon")
    if velocities and accelerations and len(velocities) + len(accelerations) <= BESIDE:
        text = _("The angular velocities and accelerations of the links are given in table {table}.")
        caption = _("Angular velocities and accelerations of the links")
        yield from tabled(text, _table(subject, caption, [*velocities, *accelerations], "rates"))
        return
    if velocities:
        rows = _table(subject, _("Angular velocities of the links"), velocities, "omega")
        yield from tabled(_("The angular velocities of the links are given in table {table}."), rows)
    if accelerations:
        rows = _table(subject, _("Angular accelerations of the links"), accelerations, "epsilon")
        yield from tabled(_("The angular accelerations of the links are given in table {table}."), rows)


def _rates(subject: Subject, letter: str, what: str) -> list[Column]:
    """Of links that turn, in one column those that turn as one; without what is the same in all positions."""
    motion = subject.motion
    every = {link: np.asarray(getattr(motion.link(link), what), float) for link in motion.linkage.moving}
    most = max(map(largest, every.values()), default=0.0)
    together: list[tuple[list[str], Real]] = []
    for link, values in every.items():
        if not largest(values) > NO_VECTOR * most:
            continue
        own = next((links for links, one in together if largest(values - one) <= NO_VECTOR * most), None)
        if own is None:
            together.append(([link], without_rounding(values, most)))
        else:
            own.append(link)
    varied = [(links, v) for links, v in together if len(v) == 1 or np.nanmax(v) - np.nanmin(v) > NO_VECTOR * most]
    return [
        ((*listed((Symbol(letter, link) for link in links), " = "), f", {unit(letter)}"), values)
        for links, values in varied
    ]


def _table(subject: Subject, caption: str, columns: Sequence[Column], key: str) -> Rows:
    """A row a position, with the places of the drivers; what cannot be computed is said in the last column."""
    every, told = (*_places(subject), *columns), states(subject.results)
    texts = [
        (head, [subject.shown(float(value)) if np.isfinite(value) else "–" for value in values])
        for head, values in every
    ]
    return over_positions(subject, caption, [*texts, *([((_("state"),), told)] if any(told) else [])], key)


def _places(subject: Subject) -> Iterable[Column]:
    """Of the drivers; of a crank within a turn, or within the turns of a cycle of loads."""
    results = subject.results
    several, cycle = bool(results.linkage.others), 2 * np.pi * results.linkage.turns
    for driver in results.linkage.drivers:
        value = np.asarray(subject.motion.drives[driver.link].value, float)
        link = driver.link if several else ""
        if driver.kind == "slide":
            yield ((Symbol("s", link or driver.link), f", {_('m')}"), value)
            continue
        full = results.driver_range is not None and results.driver_range.full
        yield ((Symbol("φ", link), ", °"), np.degrees(np.mod(value, cycle) if full else value))
