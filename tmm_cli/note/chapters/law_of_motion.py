"""The law of motion: the machine reduced to its driver, what drives it, the flywheel, speed and acceleration."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, Ref, paragraph, said
from tmm_cli.note.context import Subject
from tmm_cli.note.dynamics import driving, flywheel, law, reduced
from tmm_cli.note.dynamics.words import Here
from tmm_cli.note.tables import rows_of
from tmm_cli.results.reports import walk
from tmm_cli.results.reports.cycle import signs

TABLES = ("dynamics", "law-of-motion")


def blocks(subject: Subject) -> Iterable[Block]:
    """Of steady running."""
    every = [Here(subject, k) for k in subject.detail]
    here = every[0]
    yield Heading(_("Law of motion"))
    yield Heading(_("Reduced moments"), 2)
    yield from reduced.explained(here)
    for one in every:
        yield from reduced.inertia(one)
        yield from reduced.moment(one)
    yield from subject.figures(
        "law", _("Reduced moments, works and energies are shown in figure {figure}."),
        _("Reduced moments, works and energies over the cycle"), only="law-moments",
    )  # fmt: skip
    yield Heading(_("Driving moment"), 2)
    yield from driving.mean(here)
    for one in every:
        yield from driving.motor(one)
    flies = here.steady.law.flywheel > 0
    yield Heading(_("Flywheel") if flies else _("Fluctuation of speed"), 2)
    yield from flywheel.speeds(here)
    yield from flywheel.diagram(here)
    yield from subject.figures(
        "energy-mass", _("The energy-mass diagram is shown in figure {figure}."), _("Energy-mass diagram")
    )
    if flies:
        for part in (flywheel.by_tangents, flywheel.by_mertsalov, flywheel.on_shaft, flywheel.size):
            yield from part(here)
    yield Heading(_("Speed and acceleration of the driving link"), 2)
    yield from law.energy_at_start(here)
    for one in every:
        yield from law.position(one, explained=one is here)
    yield from law.time(here)
    yield from subject.figures(
        "law", _("The law of motion is shown in figure {figure}."), _("Law of motion of the driving link"),
        only="law-motion",
    )  # fmt: skip
    if here.running.sense < 0:
        yield paragraph(signs(subject.results.linkage))
    yield from tables(subject)


def tables(subject: Subject) -> Iterable[Block]:
    """What was found, and the law of motion at every position."""
    found = list(walk(subject.results, TABLES))
    sentences = _("What was found is put together in table {table}."), _("The law of motion is given in table {table}.")
    for table, sentence in zip(found, sentences, strict=True):
        yield said(sentence, table=Ref(table.name))
        yield rows_of(subject, table, key=table.name, zeros=table.name == "law-of-motion")
