"""The kinematics: drivers and positions, velocities and accelerations of the positions in detail, tables of all."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.numerics import NO_VECTOR, Real, largest, without_rounding
from tmm_cli.mechanics.plans import Along, Step, steps
from tmm_cli.note.blocks import Block, Figure, Heading, Line, Ref, Rows, listed, said, tabled
from tmm_cli.note.context import Subject
from tmm_cli.note.kinematics.driver import drivers, output, place_here, positions, speed_here
from tmm_cli.note.kinematics.equations import name_of
from tmm_cli.note.kinematics.on_paper import Here, unit
from tmm_cli.note.kinematics.plans import accelerations, velocities
from tmm_cli.note.tables import over_positions
from tmm_cli.reports import output_motion, states

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


def blocks(subject: Subject) -> Iterable[Block]:
    """Of what moves."""
    results = subject.results
    if results.motion is None:
        return
    yield Heading(_("Kinematic analysis"))
    yield Heading(_("Driving links and positions"), 2)
    yield from drivers(subject)
    yield from positions(subject)
    every = steps(results.linkage, results.structure.all_groups)
    for k in subject.detail:
        yield from _position(Here(subject, k, k == subject.detail[0]), every)
    yield Heading(_("Kinematics of all positions"), 2)
    yield from tables(subject)


def _position(here: Here, every: list[Step]) -> Iterable[Block]:
    subject, number = here.subject, here.subject.called(here.k)
    yield Heading(_("Velocities, position {number}").format(number=number), 2)
    if here.first:
        yield said(
            _(
                "Velocities are found from plans: first for the driving links, then for the groups in the order of the "
                "structural formula. A vector underlined twice is known in magnitude and direction, one "
                "underlined once "
                "in direction only."
            )
        )
        slid = next((e for step in every for e in step.equations if isinstance(e, Along)), None)
        if slid is not None:
            yield said(
                _(
                    "The point of a guide that coincides with the stone in this position is named after the "
                    "link of the "
                    "guide: {under} of link {link} lies at {point}; its distances to other points of the link "
                    "are those "
                    "in this position."
                ),
                under=name_of(slid.base),
                link=slid.slide.carrier,
                point=slid.point.at,
            )
    yield place_here(here)
    yield from speed_here(here)
    yield from subject.figures(
        "velocity",
        _("The plan of velocities is shown in figure {figure}."),
        _("Plan of velocities, position {number}").format(number=number),
        here.k,
    )
    yield from velocities(here, every)
    yield Heading(_("Accelerations, position {number}").format(number=number), 2)
    if here.first:
        yield said(
            _(
                "The acceleration of a point relative to another point of its link has a normal component, directed "
                "towards that other point, and a tangential one, perpendicular to the line between them."
            )
        )
        if any(isinstance(e, Along) for step in every for e in step.equations):
            yield said(
                _(
                    "The acceleration of a stone relative to the coincident point of the guide has a component "
                    "along the "
                    "guide and, if the guide turns, the Coriolis component, whose direction is that of the relative "
                    "velocity turned through 90° in the sense of the guide's rotation."
                )
            )
    yield from subject.figures(
        "acceleration",
        _("The plan of accelerations is shown in figure {figure}."),
        _("Plan of accelerations, position {number}").format(number=number),
        here.k,
    )
    yield from accelerations(here, every)
