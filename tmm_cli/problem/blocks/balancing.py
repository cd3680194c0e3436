"""The block `balancing` of a problem file."""

from __future__ import annotations

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import BalancingTask, Place, Plane, Rotor
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.quantities import ANGLE, LENGTH, MASS
from tmm_cli.problem import schema
from tmm_cli.problem.blocks import keys_on_request as shapes
from tmm_cli.problem.units import ExtendedUnits
from tmm_cli.problem.values import Part, ValueReader, direction


def build_balancing(shape: schema.File, linkage: Linkage, values: ValueReader) -> BalancingTask | None:
    """What is asked of balancing, which is found in doubles alone."""
    given = shape.balancing
    if given is None or isinstance(values.units, ExtendedUnits):
        return None
    part = Part(given, ("balancing",), values)
    heavy = any(np.any(linkage.links[name].mass != 0) for name in linkage.moving)
    if not heavy and (given.counterweights or given.rotor is None):
        raise part.refusal("", _("nothing shakes: no link has a mass"), allowed=_("masses: {1: {mass: 2 kg, ...}}"))
    places = tuple(_place(name, own, linkage, values) for name, own in given.counterweights.items())
    share, along = 0.5, 1 + 0j
    if given.share is not None:
        share = values.fraction(given.share, part.at("share"), zero=True)
        guides = [slide for slide in linkage.slides if slide.carrier == FRAME]
        output = linkage.output_guide(linkage.output.link) if linkage.output is not None else None
        if not guides:
            raise part.refusal(
                "share",
                _("a share is of the force along a guide on the frame, and there is none"),
                str(given.share),
                _("no share: the force counts alike in all directions"),
            )
        along = direction((output if output in guides else guides[0]).direction)
    rotor = None if given.rotor is None else _rotor(given.rotor, values)
    return BalancingTask(places, share, along, rotor)


def _place(name: str, given: shapes.Counterweight, linkage: Linkage, values: ValueReader) -> Place:
    part = Part(given, ("balancing", "counterweights", name), values)
    values.known(name, linkage.moving, part.path, "link", key=True)
    if linkage.slides_on_frame(name):
        raise part.refusal("", _("a counterweight on a link that does not turn balances nothing"))
    points = linkage.links[name].points
    fixed = [p for p in points if any(h.point == p and {FRAME, name} <= set(h.links) for h in linkage.hinges)]
    about = points[(fixed or list(points))[0]] if given.about is None else part.place("about", points, name)
    radius = 0.0 if given.radius is None else part.positive("radius", LENGTH)
    if not radius and not any(about == points[p] for p in fixed):
        raise part.refusal(
            "radius",
            _("this counterweight moves with its link: its mass counts, and so its radius is wanted"),
            allowed=_("radius: 80 mm, or about: a hinge of this link on the frame"),
        )
    return Place(name, about, radius)


def _rotor(given: shapes.Rotor, values: ValueReader) -> Rotor:
    path = ("balancing", "rotor")
    sizes, at = [], []
    for k, one in enumerate(given.masses):
        part = Part(one, (*path, "masses", k), values)
        size = part.positive("mass", MASS) * part.positive("radius", LENGTH)
        sizes.append(size * direction(part.number("angle", ANGLE)))
        at.append(part.number("at", LENGTH))
    planes = []
    for k, own in enumerate(given.planes):
        part = Part(own, (*path, "planes", k), values)
        planes.append(Plane(part.number("at", LENGTH), 0.0 if own.radius is None else part.positive("radius", LENGTH)))
    if len(planes) > 1 and planes[0].at == planes[1].at:
        raise Part(given, path, values).refusal("planes", _("two different planes are wanted"), str(given.planes[1].at))
    return Rotor(np.array(sizes), np.array(at), tuple(planes))
