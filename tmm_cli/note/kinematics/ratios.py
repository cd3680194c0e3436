"""What higher pairs give: Willis' formula of toothed wheels, rolling on racks, a cam's law of motion."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.linkage import FRAME, Mesh
from tmm_cli.note.blocks import Block, Equation, said
from tmm_cli.note.expression import Constant, Expression, Found, Function, Leaf, Sum
from tmm_cli.note.kinematics.on_paper import Here, Vector, unit, zero
from tmm_cli.note.kinematics.words import sense
from tmm_cli.note.math import Fraction, Letter, row
from tmm_cli.pairs.base import axis
from tmm_cli.plans.record import Symbol
from tmm_cli.plans.vector_equations import Along, OnGuide, Ratio, Spot, Step

ONE = Constant(1)


def velocities(here: Here, step: Step, ratio: Ratio) -> Iterable[Block]:
    """Of a link, or in a sliding pair, from a higher pair."""
    mesh = ratio.mesh
    if mesh.kind == "gear":
        if here.first:
            yield from _willis(here, mesh)
        yield _wheel(here, mesh, ratio.link, "ω")
    elif mesh.kind == "rack":
        if here.first:
            text = _("Wheel {wheel} of radius {radius} rolls without sliding on the rack, so that")
            yield said(text, wheel=mesh.i, radius=Symbol("r", mesh.i))
        yield _rolls(here, step, ratio, "ω")
    else:
        if here.first:
            yield from _law(mesh)
        yield _follower(here, step, ratio, "ω")
    if here.omega.get(ratio.link):
        yield said(_("Link {link} turns {sense}."), link=ratio.link, sense=sense(here.omega[ratio.link]))


def accelerations(here: Here, step: Step, ratio: Ratio) -> Iterable[Block]:
    """The same of accelerations."""
    mesh = ratio.mesh
    if mesh.kind == "gear":
        yield _wheel(here, mesh, ratio.link, "ε")
    elif mesh.kind == "rack":
        yield _rolls(here, step, ratio, "ε")
    else:
        if here.first:
            text = _("The second derivative {second} of the law of motion gives")
            yield said(text, second=_derivative(mesh, 2))
        yield _follower(here, step, ratio, "ε")


def _turning(here: Here, link: str, letter: str) -> Leaf | None:
    """What a link turns with, with its sign; None of one that never does."""
    rates = here.omega if letter == "ω" else here.epsilon
    return Leaf(Symbol(letter, link), rates[link]) if link in rates else None


def _about(one: Leaf | None, other: Leaf | None) -> Expression | None:
    """One less the other."""
    if one is None or other is None:
        return one if other is None else -other
    return one - other


def _willis(here: Here, mesh: Mesh) -> Iterable[Block]:
    """The ratio of the wheels while their carrier rests."""
    linkage = here.motion.linkage
    a, b = (complex(axis(linkage, wheel, mesh.carrier)) for wheel in (mesh.i, mesh.j))
    pitch = (a - mesh.ratio * b) / (1 - mesh.ratio)
    radii = Leaf(Symbol("r", mesh.i), abs(pitch - a)) / Leaf(Symbol("r", mesh.j), abs(pitch - b))
    carried = _turning(here, mesh.carrier, "ω") is not None
    symbols = [Letter(Symbol("ω", link)) for link in (mesh.j, mesh.i)]
    if carried:
        carrier = Letter(Symbol("ω", mesh.carrier))
        over, under = (row(symbol, "−", carrier) for symbol in symbols)
        yield said(
            _(
                "Wheels {i} and {j} with pitch radii {ri} and {rj} are in mesh; their axes are on carrier "
                "{carrier}. By "
                "Willis' method all links are given the carrier's rotation backwards, so that it rests; then the ratio "
                "of the wheels is (positive counterclockwise)"
            ),
            i=mesh.i, j=mesh.j, carrier=mesh.carrier, ri=Symbol("r", mesh.i), rj=Symbol("r", mesh.j),
        )  # fmt: skip
    else:
        over, under = symbols
        yield said(
            _(
                "Wheels {i} and {j} with pitch radii {ri} and {rj} are in mesh; their ratio is (positive "
                "counterclockwise)"
            ),
            i=mesh.i,
            j=mesh.j,
            ri=Symbol("r", mesh.i),
            rj=Symbol("r", mesh.j),
        )
    yield Equation(row(Letter(_ratio(mesh)), "=", Fraction(over, under)))
    outer = mesh.ratio < 0
    yield Found(_ratio(mesh), -radii if outer else radii, mesh.ratio)
    yield said(_("The angular velocity sought follows from this:"))


def _ratio(mesh: Mesh) -> Symbol:
    return Symbol("u", mesh.j + mesh.i, "" if mesh.carrier == FRAME else f"({mesh.carrier})")


def _wheel(here: Here, mesh: Mesh, link: str, letter: str) -> Block:
    """What one of two wheels, or their carrier, turns with."""
    i, j, c = (_turning(here, one, letter) for one in (mesh.i, mesh.j, mesh.carrier))
    u, found = Leaf(_ratio(mesh), mesh.ratio), _turning(here, link, letter)
    if found is None:
        return zero(Symbol(letter, link))
    expression: Expression | None
    if link == mesh.carrier:
        expression = _less(j, u * i if i else None) / (ONE - u)
    else:
        relative = _about(i if link == mesh.j else j, c)
        assert relative is not None
        share: Expression = u * relative if link == mesh.j else relative / u
        own = i if link == mesh.j else j
        expression = share if c is None else c + share
        if own is None and c is not None:
            expression = c * (ONE - u if link == mesh.j else ONE / u)
    return Found(found.symbol, expression, found.value, unit(letter))


def _less(one: Expression | None, other: Expression | None) -> Expression:
    terms = ((sign, term) for sign, term in ((1, one), (-1, other)) if term is not None)
    return Sum(tuple(terms))


def _sliding(here: Here, step: Step, ratio: Ratio, letter: str) -> Vector:
    """The velocity, or acceleration, in the sliding pair of a rack or a follower."""
    name = ratio.mesh.slide
    linkage = here.motion.linkage
    slide = linkage.slide(name)
    own = next((e for e in step.equations if isinstance(e, Along | OnGuide) and e.slide.name == name), None)
    if isinstance(own, Along):
        return here.v.relative(own.point, own.base) if letter == "ω" else here.a.part(own.point, own.base, "r")
    point = own.point if own is not None else Spot(slide.point, slide.point, slide.runner)
    return here.v.of(point) if letter == "ω" else here.a.of(point)


def _rolls(here: Here, step: Step, ratio: Ratio, letter: str) -> Block:
    mesh = ratio.mesh
    run, radius = _sliding(here, step, ratio, letter), Leaf(Symbol("r", mesh.i), abs(mesh.ratio))
    wheel, carrier = (_turning(here, link, letter) for link in (mesh.i, mesh.carrier))
    turning = _about(wheel, carrier)
    if turning is None:
        return zero(run.symbol if ratio.slide is not None else Symbol(letter, ratio.link))
    own = unit("v" if letter == "ω" else "a")
    if ratio.slide is not None:
        return Found(run.symbol, radius * Function("abs", turning), run.size, own)
    alone = Symbol(letter, mesh.i if carrier is None else f"{mesh.i}{mesh.carrier}")
    value = abs((wheel.value if wheel else 0.0) - (carrier.value if carrier else 0.0))
    return Found(alone, run.leaf / radius, value, unit(letter))


def _law(mesh: Mesh) -> Iterable[Block]:
    run = _(
        "The law of motion of follower {follower} gives the derivative {first} of its run by the angle of cam {cam}:"
    )
    turn = _("The law of motion of follower {follower} gives the derivative {first} of its angle by that of cam {cam}:")
    yield said(run if mesh.slide else turn, follower=mesh.j, cam=mesh.i, first=_derivative(mesh, 1))


def _derivative(mesh: Mesh, order: int) -> Symbol:
    return Symbol(("s" if mesh.slide else "ψ") + ("′" if order == 1 else "″"))


def _follower(here: Here, step: Step, ratio: Ratio, letter: str) -> Block:
    mesh = ratio.mesh
    assert mesh.law is not None
    __, first, second = (float(value[here.k]) for value in mesh.law(here.motion.poses[mesh.i].turned))
    omega, epsilon = _turning(here, mesh.i, "ω"), _turning(here, mesh.i, "ε")
    assert omega is not None
    by_law = Leaf(_derivative(mesh, 1), first)
    expression: Expression = by_law * omega
    if letter == "ε":
        expression = Leaf(_derivative(mesh, 2), second) * omega**2
        if epsilon is not None:
            expression = expression + by_law * epsilon
    if mesh.slide:
        run = _sliding(here, step, ratio, letter)
        if not run.segment:
            return zero(run.symbol)
        return Found(run.symbol, Function("abs", expression), run.size, unit("v" if letter == "ω" else "a"))
    found = _turning(here, mesh.j, letter)
    if found is None or found.value == 0:
        return zero(Symbol(letter, mesh.j))
    return Found(found.symbol, expression, found.value, unit(letter))
