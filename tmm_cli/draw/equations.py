"""Equations of moments in letters, then with numbers, then what they give; tables of forces and arms."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.draw.beneath import Table, figure
from tmm_cli.errors import _
from tmm_cli.plans.bodies import Acting
from tmm_cli.plans.moments import MomentEquation, Term
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import LENGTH
from tmm_cli.tolerances import NO_MOMENT


def written(equation: MomentEquation) -> Iterable[str]:
    """The sum in letters; then what it gives, in letters, with numbers (N, m) and as a value."""
    found, sought = equation.found, equation.sought
    links = (_("link {links}") if len(equation.links) == 1 else _("links {links}")).format(
        links=", ".join(equation.links)
    )
    if found is None and sought is not None:
        text = (
            _("ΣM({point}), {links}: nothing has a moment, so {name} goes through {point}")
            if sought.arm
            else _("ΣM({point}), {links}: nothing has a moment, so {name} = 0")
        )
        yield text.format(point=equation.about, links=links, name=sought.name)
        return
    if not equation.terms:
        return
    others = [t for t in equation.terms if t is not found]
    terms = [*([found] if found else []), *others]
    yield _("ΣM({point}), {links}: {sum} = 0").format(
        point=equation.about, links=links, sum=_sum((_letters(t), t.moment) for t in terms)
    )
    if found is None or sought is None:
        rest, largest = abs(sum(t.moment for t in terms)), max(abs(t.moment) for t in terms)
        numbers = _sum((_numbers(t), t.moment) for t in terms)
        yield f"    {numbers} = {figure(rest if rest > NO_MOMENT * largest else 0.0)} N*m"
        return
    sense = -np.sign(found.moment)
    letters = _sum((_letters(t), sense * t.moment) for t in others)
    numbers = _sum((_numbers(t), sense * t.moment) for t in others)
    name, unit, divided, by = found.acting.name, "N*m", "", ""
    if sought.arm and not found.acting.couple:
        name, unit, divided, by = found.letter, "m", found.acting.name, figure(found.acting.size)
    elif not found.acting.couple:
        unit, divided, by = "N", found.letter, figure(found.arm)
    if divided:
        letters, numbers = f"({letters}) / {divided}", f"({numbers}) / {by}"
    yield f"    {name} = {letters} = {numbers} = {figure(equation.value)} {unit}"


def _letters(term: Term) -> str:
    return f"{term.acting.name}·{term.letter}" if term.letter else term.acting.name


def _numbers(term: Term) -> str:
    return f"{figure(term.acting.size)}·{figure(term.arm)}" if term.letter else figure(term.acting.size)


def _sum(terms: Iterable[tuple[str, float]]) -> str:
    """a − b + c."""
    text = " ".join(("− " if sign < 0 else "+ ") + name for name, sign in terms)
    return text.removeprefix("+ ") if text[:1] == "+" else text.replace("− ", "−", 1)


def table_of_forces(acting: Iterable[Acting]) -> Table:
    """Sizes, and angles of forces from x."""
    rows = []
    for one in acting:
        angle = "" if one.couple else f"{round(float(np.degrees(np.angle(one.force))), 1) % 360:.1f}°"
        size = f"{figure(one.moment)} N*m" if one.couple else f"{figure(one.size)} N"
        rows.append((one.name, size, angle))
    return Table((_("force"), _("size"), _("from x")), rows)


def table_of_arms(equations: Sequence[MomentEquation], units: UnitSystem, mu: float) -> Table:
    """Of the mechanism, in the unit of lengths, and on paper; mu: m a millimetre."""
    rows: dict[str, tuple[str, ...]] = {}
    for term in (t for e in equations for t in e.terms if t.letter):
        if term.letter in rows:
            letter, of, *sizes = rows[term.letter]
            rows[letter] = (letter, f"{of}, {term.acting.name}", *sizes)
        else:
            size = figure(units.from_si(term.arm, LENGTH))
            rows[term.letter] = (term.letter, term.acting.name, size, f"{term.arm / mu:.1f} mm")
    return Table((_("arm"), _("of"), units.symbol(LENGTH), _("on paper")), list(rows.values()))
