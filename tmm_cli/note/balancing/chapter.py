"""Balancing: what shakes the frame, the counterweights that take it away, and a shaft with masses in planes."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import Balancing, steadily
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.numerics import NO_VECTOR
from tmm_cli.note.balancing import counterweights, shaft
from tmm_cli.note.blocks import Block, Heading, Inline, said
from tmm_cli.note.context import Subject
from tmm_cli.note.expression import Expression, Found, Function, Leaf, added
from tmm_cli.note.tables import rows_of
from tmm_cli.reports import walk

FORCE, MOMENT = Symbol("F"), Symbol("M")
X, Y = Symbol("F", "x"), Symbol("F", "y")


def blocks(subject: Subject) -> Iterable[Block]:
    """Of a file that asks for it."""
    found = subject.results.balancing
    if found is not None and (found.task.rotor is not None or found.cycle.shakes):
        yield Heading(_("Balancing"))
        if found.cycle.shakes:
            yield from _of_links(subject, found)
        if found.task.rotor is not None:
            yield Heading(_("Rotating masses"), 2)
            yield from shaft.blocks(subject, found.task.rotor, found.corrections)


def _of_links(subject: Subject, found: Balancing) -> Iterable[Block]:
    yield Heading(_("Shaking force and moment"), 2)
    yield from _explained(found)
    for k in subject.detail:
        yield from _position(subject, found, k)
    if found.cycle.counterweights:
        yield Heading(_("Counterweights"), 2)
        yield from counterweights.blocks(subject, found.cycle, found.task)
    text = _("The hodograph of the shaking force is shown in figure {figure}.")
    if found.cycle.counterweights:
        text = _("The hodographs of the shaking force before and after balancing are shown in figure {figure}.")
    yield from subject.figures("shaking", text, _("Hodograph of the shaking force"))
    yield from (rows_of(subject, table) for table in walk(subject.results, ("shaking",)))


def _explained(found: Balancing) -> Iterable[Block]:
    """What is summed up."""
    pivot: Inline = Symbol(found.pivot) if found.pivot else _("the origin")
    yield said(
        _(
            "At constant speed of the driving link the links act on the frame by their forces of inertia: by the force "
            "{F} and, about {pivot}, by the moment {M}. {m} is the mass of a link, {a} the acceleration of its "
            "centre of "
            "mass, {x} and {y} the coordinates of this centre from {pivot}, {J} the moment of inertia about it, "
            "{epsilon} the angular acceleration."
        ),
        F=FORCE,
        M=MOMENT,
        pivot=pivot,
        m=Symbol("m"),
        a=Symbol("a", "S"),
        x=Symbol("x", "S"),
        y=Symbol("y", "S"),
        J=Symbol("J", "S"),
        epsilon=Symbol("ε"),
    )


def _position(subject: Subject, found: Balancing, k: int) -> Iterable[Block]:
    """Parts of the force, its size, and the moment."""
    results = subject.results
    motion = steadily(results.mechanism, subject.motion.q[k : k + 1])
    about, along, across, moments = found.before.about, list[Expression](), list[Expression](), list[Expression]()
    largest = max(abs(complex(motion.centre(name).a[0])) for name in motion.linkage.moving)
    for name in motion.linkage.moving:
        link = motion.linkage.links[name]
        centre, mass = motion.centre(name), float(np.ravel(link.mass)[0])
        a, r = complex(centre.a[0]), complex(centre.x[0]) - about
        if mass and abs(a) > NO_VECTOR * largest:
            m = Leaf(Symbol("m", name), mass)
            ax, ay = Leaf(Symbol("a", f"S{name}x"), a.real), Leaf(Symbol("a", f"S{name}y"), a.imag)
            x, y = Leaf(Symbol("x", f"S{name}"), r.real), Leaf(Symbol("y", f"S{name}"), r.imag)
            along.append(m * ax)
            across.append(m * ay)
            moments.append(m * (x * ay - y * ax))
        inertia, epsilon = float(np.ravel(link.inertia)[0]), float(np.broadcast_to(motion.link(name).epsilon, 1)[0])
        if inertia and epsilon:
            moments.append(Leaf(Symbol("J", f"S{name}"), inertia) * Leaf(Symbol("ε", name), epsilon))
    if not moments:
        return
    yield said(_("Position {number}:"), number=subject.called(k))
    force = complex(found.before.force[k])
    x, y = Leaf(X, force.real), Leaf(Y, force.imag)
    yield Found(X, -added(along), x.value, _("N"))
    yield Found(Y, -added(across), y.value, _("N"))
    yield Found(FORCE, Function("sqrt", x**2 + y**2), abs(force), _("N"))
    yield Found(MOMENT, -added(moments), float(found.before.moment[k]), _("N·m"))
