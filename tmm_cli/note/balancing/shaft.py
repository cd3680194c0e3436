"""Masses on a shaft, and those in one or two planes that balance them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import Rotor
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.note.blocks import Block, said
from tmm_cli.note.context import Subject
from tmm_cli.note.expression import Expression, Found, Function, Leaf, added

PLANES = ("I", "II")


def blocks(subject: Subject, rotor: Rotor, corrections: Vector) -> Iterable[Block]:
    """In the second plane what leaves no couple about the first one, then in the first what leaves no force."""
    two = len(rotor.planes) > 1
    static = _("A shaft is balanced statically when the vectors {D} = m·r of all its masses add up to nothing.")
    dynamic = _(
        "A shaft is balanced dynamically when the vectors {D} = m·r of all its masses add up to nothing, and "
        "their moments about one of the planes too; {alpha} is the angle of a mass, {z} its place along the "
        "shaft."
    )
    yield said(dynamic if two else static, D=Symbol("D"), alpha=Symbol("α"), z=Symbol("z"))
    if two:
        yield from _mass(subject, rotor, corrections, 1)
    yield from _mass(subject, rotor, corrections, 0)


def _mass(subject: Subject, rotor: Rotor, corrections: Vector, k: int) -> Iterable[Block]:
    found, name = complex(corrections[k]), PLANES[k]
    own = Symbol("D", name)
    yield said(_("In plane {plane}:"), plane=name)
    parts = []
    for axis, function, take in (("x", "cos", np.real), ("y", "sin", np.imag)):
        whole: Expression = -added(_share(rotor, number, function, moment=k > 0) for number in range(len(rotor.sizes)))
        if k:
            whole = whole / _gap(Symbol("z", name), rotor.planes[k].at, rotor)
        elif len(rotor.planes) > 1:
            whole = whole - Leaf(Symbol("D", f"{PLANES[1]}{axis}"), float(take(corrections[1])))
        parts.append(Leaf(Symbol("D", f"{name}{axis}"), float(take(found))))
        yield Found(parts[-1].symbol, whole, parts[-1].value, _("kg·m"))
    yield Found(own, Function("sqrt", added(part**2 for part in parts)), abs(found), _("kg·m"))
    if abs(found):
        direction = subject.text(float(np.degrees(np.angle(found) % (2 * np.pi))))
        yield said(_("Its angle is {angle}°."), angle=direction)
    radius = rotor.planes[k].radius
    if radius:
        mass = Leaf(own, abs(found)) / Leaf(Symbol("r", name), radius)
        yield Found(Symbol("m", name), mass, abs(found) / radius, _("kg"))


def _share(rotor: Rotor, number: int, function: str, *, moment: bool) -> Expression:
    """Of a mass, along an axis; moment: about the first plane."""
    size, index = complex(rotor.sizes[number]), str(number + 1)
    angle = Leaf(Symbol("α", index), float(np.angle(size) % (2 * np.pi)), angle=True)
    share = Leaf(Symbol("D", index), abs(size)) * Function(function, angle)
    return share * _gap(Symbol("z", index), float(rotor.at[number]), rotor) if moment else share


def _gap(symbol: Symbol, at: float, rotor: Rotor) -> Expression:
    """How far beyond the first plane, m."""
    return Leaf(symbol, at) - Leaf(Symbol("z", PLANES[0]), rotor.planes[0].at)
