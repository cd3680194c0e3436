"""The kinematics: drivers and positions, velocities and accelerations of the positions in detail, tables of all."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, Heading, said
from tmm_cli.note.context import Subject
from tmm_cli.note.kinematics.accelerations import accelerations
from tmm_cli.note.kinematics.driver import drivers, place_here, positions, speed_here
from tmm_cli.note.kinematics.on_paper import Here
from tmm_cli.note.kinematics.tables import tables
from tmm_cli.note.kinematics.velocities import velocities
from tmm_cli.note.kinematics.words import name_of
from tmm_cli.plans.vector_equations import Along, Step, steps


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
            _("Velocities are found from plans: first for the driving links, then for the groups in the order of the "
              "structural formula. A vector underlined twice is known in magnitude and direction, one underlined once "
              "in direction only.")
        )  # fmt: skip
        slid = next((e for step in every for e in step.equations if isinstance(e, Along)), None)
        if slid is not None:
            yield said(
                _("The point of a guide that coincides with the stone in this position is named after the link of the "
                  "guide: {under} of link {link} lies at {point}; its distances to other points of the link are those "
                  "in this position."),
                under=name_of(slid.base), link=slid.slide.carrier, point=slid.point.at,
            )  # fmt: skip
    yield place_here(here)
    yield from speed_here(here)
    yield from subject.figures(
        "velocity", _("The plan of velocities is shown in figure {figure}."),
        _("Plan of velocities, position {number}").format(number=number), here.k,
    )  # fmt: skip
    yield from velocities(here, every)
    yield Heading(_("Accelerations, position {number}").format(number=number), 2)
    if here.first:
        yield said(
            _("The acceleration of a point relative to another point of its link has a normal component, directed "
              "towards that other point, and a tangential one, perpendicular to the line between them.")
        )  # fmt: skip
        if any(isinstance(e, Along) for step in every for e in step.equations):
            yield said(
                _("The acceleration of a stone relative to the coincident point of the guide has a component along the "
                  "guide and, if the guide turns, the Coriolis component, whose direction is that of the relative "
                  "velocity turned through 90° in the sense of the guide's rotation.")
            )  # fmt: skip
    yield from subject.figures(
        "acceleration", _("The plan of accelerations is shown in figure {figure}."),
        _("Plan of accelerations, position {number}").format(number=number), here.k,
    )  # fmt: skip
    yield from accelerations(here, every)
