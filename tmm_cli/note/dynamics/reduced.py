"""The reduced inertia and the reduced moment of a position, link by link and load by load."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.language import _
from tmm_cli.note.blocks import Block, said
from tmm_cli.note.dynamics.words import INERTIA, MOMENT, Here
from tmm_cli.note.expression import EXACT, Expression, Found, Function, Leaf, Sum, added, evaluate, signed
from tmm_cli.plans.bodies import load_symbols
from tmm_cli.plans.record import Symbol
from tmm_cli.tolerances import NO_VECTOR


def explained(here: Here) -> Iterable[Block]:
    """What is reduced, and how."""
    link = here.motion.linkage.driver.link
    yield said(
        _("The machine is replaced by its driving link {link}, to which all masses and all loads are reduced; what "
          "moves or acts in the sense of its rotation is positive. The reduced moment of inertia {J} has the kinetic "
          "energy of all links, the reduced moment {M} has the power of all loads. Both follow from ratios of "
          "velocities, which do not depend on how fast the driving link turns."),
        link=link, J=INERTIA, M=MOMENT,
    )  # fmt: skip


def inertia(here: Here) -> Iterable[Block]:
    """Masses at the squares of the ratios of speeds."""
    terms = [term for link in here.motion.linkage.moving for term in _of_link(here, link)]
    if not terms:
        return
    yield said(
        _("Position {number}: the reduced moment of inertia, {m} being the mass of a link, {v} the velocity of its "
          "centre of mass, {J} its moment of inertia about this centre and {omega} its angular velocity:"),
        number=here.number, m=Symbol("m"), v=Symbol("v", "S"), J=Symbol("J", "S"), omega=Symbol("ω"),
    )  # fmt: skip
    yield Found(INERTIA, _sum(terms), here.of(here.steady.machine.inertia), _("kg·m²"))


def _of_link(here: Here, name: str) -> Iterable[Expression]:
    motion, link, omega = here.motion, here.motion.linkage.links[name], here.speed
    speed = Leaf(Symbol("v", f"S{name}"), abs(complex(motion.centre(name).v[here.k])))
    turned = Leaf(Symbol("ω", name), abs(float(motion.link(name).omega[here.k])))
    yield Leaf(Symbol("m", name), float(np.ravel(link.mass)[0])) * (speed / omega) ** 2
    inertia = Leaf(Symbol("J", f"S{name}"), float(np.ravel(link.inertia)[0]))
    yield inertia if turned.symbol == omega.symbol else inertia * (turned / omega) ** 2


def moment(here: Here) -> Iterable[Block]:
    """Powers of all loads over the speed of the driving link."""
    terms = [term for load in here.subject.results.loads if load.kind != "inertia" for term in _of_load(here, load)]
    if not terms:
        return
    yield said(
        _("The reduced moment of the loads, {v} being the velocity of the point in which a force acts, {alpha} the "
          "angle between the two, and a couple acting with or against the angular velocity of its link:"),
        v=Symbol("v"), alpha=Symbol("α"),
    )  # fmt: skip
    whole = _sum(terms) / here.speed
    yield Found(MOMENT, whole, here.of(here.steady.machine.moment), _("N·m"))


def _of_load(here: Here, load: Applied) -> Iterable[Expression]:
    k, motion = here.k, here.motion
    force, couple = load_symbols(load)
    pull, turned = complex(load.force[k]), float(load.moment[k])
    speed = complex(motion.point(load.link, load.at).v[k])
    if pull and speed:
        in_centre = load.kind == "weight"
        own = Leaf(Symbol("v", f"S{load.link}" if in_centre else force.plain), abs(speed))
        angle, factors = abs(float(np.angle(pull / speed))), Leaf(force, abs(pull)) * own
        if min(angle, np.pi - angle) < NO_VECTOR:
            yield signed(1 - angle, factors)
        else:
            cosine = Function("cos", Leaf(Symbol("α", force.plain), angle, angle=True))
            yield factors * cosine
    omega = float(motion.link(load.link).omega[k])
    if turned and omega:
        own = Leaf(Symbol("ω", load.link), abs(omega))
        yield signed(turned * omega, Leaf(couple, abs(turned)) * own)


def _sum(terms: list[Expression]) -> Sum:
    """Without terms that are nothing beside the others."""
    sizes = [abs(evaluate(term, EXACT)) for term in terms]
    return added(term for term, size in zip(terms, sizes, strict=True) if size > NO_VECTOR * max(sizes))
