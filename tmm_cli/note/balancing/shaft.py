"""Masses on a shaft, and those in one or two planes that balance them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.dynamics.balancing_task import Rotor
from tmm_cli.language import _
from tmm_cli.note.blocks import Block, said
from tmm_cli.note.context import Subject
from tmm_cli.note.expression import Expression, Found, Function, Leaf, Sum
from tmm_cli.plans.record import Symbol
from tmm_cli.vectors import Vector

PLANES = ("I", "II")


def blocks(subject: Subject, rotor: Rotor, corrections: Vector) -> Iterable[Block]:
    """In the second plane what leaves no couple about the first one, then in the first what leaves no force."""
    two = len(rotor.planes) > 1
    static = _("A shaft is balanced statically when the vectors {D} = m·r of all its masses add up to nothing.")
    dynamic = _(
        "A shaft is balanced dynamically when the vectors {D} = m·r of all its masses add up to nothing, and their "
        "moments about one of the planes too; {alpha} is the angle of a mass, {z} its place along the shaft."
    )
    yield said(dynamic if two else static, D=Symbol("D"), alpha=Symbol("α"), z=Symbol("z"))
    if two:
        yield from _mass(subject, rotor, corrections, 1)
    yield from _mass(subject, rotor, corrections, 0)


def _mass(subject: Subject, rotor: Rotor, corrections: Vector, k: int) -> Iterable[Block]:
    found, name = complex(corrections[k]), PLANES[k]
    own = Symbol("D", name)
    yield said(_("In plane {plane}:"), plane=name)
    for axis, function, value in (("x", "cos", found.real), ("y", "sin", found.imag)):
        terms: list[tuple[int, Expression]] = []
        for number, (size, at) in enumerate(zip(rotor.sizes.tolist(), rotor.at.tolist(), strict=True), 1):
            angle = Leaf(Symbol("α", str(number)), float(np.angle(size) % (2 * np.pi)), angle=True)
            part: Expression = Leaf(Symbol("D", str(number)), abs(size)) * Function(function, angle)
            if k:
                part = part * _gap(Symbol("z", str(number)), float(at), rotor)
            terms.append((-1, part))
        whole: Expression = Sum(tuple(terms))
        if k:
            whole = whole / _gap(Symbol("z", PLANES[1]), rotor.planes[1].at, rotor)
        elif len(rotor.planes) > 1:
            other = complex(corrections[1])
            rest = Leaf(Symbol("D", f"{PLANES[1]}{axis}"), other.real if axis == "x" else other.imag)
            whole = Sum((*terms, (-1, rest)))
        yield Found(Symbol("D", f"{name}{axis}"), whole, value, _("kg·m"))
    parts = [Leaf(Symbol("D", f"{name}{axis}"), v) for axis, v in (("x", found.real), ("y", found.imag))]
    root = Function("sqrt", Sum(tuple((1, part**2) for part in parts)))
    yield Found(own, root, abs(found), _("kg·m"))
    if abs(found):
        direction = subject.text(float(np.degrees(np.angle(found) % (2 * np.pi))))
        yield said(_("Its angle is {angle}°."), angle=direction)
    radius = rotor.planes[k].radius
    if radius:
        mass = Leaf(own, abs(found)) / Leaf(Symbol("r", name), radius)
        yield Found(Symbol("m", name), mass, abs(found) / radius, _("kg"))


def _gap(symbol: Symbol, at: float, rotor: Rotor) -> Expression:
    """How far beyond the first plane, m."""
    return Leaf(symbol, at) - Leaf(Symbol("z", PLANES[0]), rotor.planes[0].at)
