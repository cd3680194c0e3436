"""Equations of moments in letters, then with numbers, then what they give; tables of forces and arms."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.draw.paper.script import Words
from tmm_cli.draw.sheets.beneath import Table
from tmm_cli.language import _, filled, half_up, numeral, spelt
from tmm_cli.plans.bodies import Acting
from tmm_cli.plans.moments import MomentEquation, Term
from tmm_cli.plans.projections import ForceSum, Part
from tmm_cli.plans.record import Symbol
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import LENGTH
from tmm_cli.tolerances import NO_MOMENT

INDENT = "    "
PLAIN = 1e-6  # a smaller number is written with a power of ten
Word = str | Symbol


def written(equation: MomentEquation, unit: str = "N·m") -> Iterable[Words]:
    """The sum in letters; then what it gives, in letters, with numbers (N, m) and as a value; unit: of moments."""
    found, sought = equation.found, equation.sought
    links = (_("link {links}") if len(equation.links) == 1 else _("links {links}")).format(
        links=", ".join(equation.links)
    )
    moments: tuple[Word, ...] = ("Σ", Symbol("M", equation.about), f", {links}: " if equation.links else ": ")
    if found is None and sought is not None:
        text = (
            _("{moments}nothing has a moment, so {name} goes through {point}")
            if sought.arm
            else _("{moments}nothing has a moment, so {name} = 0")
        )
        yield filled(text, moments=moments, name=sought.symbol, point=equation.about)
        return
    if not equation.terms:
        return
    others = [t for t in equation.terms if t is not found]
    terms = [*([found] if found else []), *others]
    yield (*moments, *_sum((_letters(t), t.moment) for t in terms), " = 0")
    if found is None or sought is None:
        rest, largest = abs(sum(t.moment for t in terms)), max(abs(t.moment) for t in terms)
        value = figure(rest if rest > NO_MOMENT * largest else 0.0)
        yield (INDENT, *_sum((_numbers(t), t.moment) for t in terms), f" = {value} {spelt(unit)}")
        return
    sense = -float(np.sign(found.moment))
    letters = _sum((_letters(t), sense * t.moment) for t in others)
    numbers = _sum((_numbers(t), sense * t.moment) for t in others)
    if found.acting.couple:
        value = figure(equation.value)
        summed = () if numbers == [value] else (*numbers, " = ")
        yield (INDENT, found.acting.symbol, " = ", *letters, " = ", *summed, f"{value} {spelt(unit)}")
        return
    name, over, by, of = found.acting.symbol, found.letter, found.arm, "N"
    if sought.arm:
        name, over, by, of = found.letter, found.acting.symbol, found.acting.size, "m"
    divided = ("(", *letters, ") / ", over, " = (", *numbers, f") / {figure(by)}")
    yield (INDENT, name, " = ", *divided, f" = {figure(equation.value)} {spelt(of)}")


def along_guide(forces: ForceSum) -> Iterable[Words]:
    """The sum along a guide in letters, then with numbers."""
    title = _("ΣF along guide {guide}, link {link}: ").format(guide=forces.guide, link=forces.link)
    others = [part for part in forces.parts if part is not forces.found]
    sense = -float(np.sign(forces.found.along))
    yield (title, *_sum((_cosine(p), p.along) for p in (forces.found, *others)), " = 0")
    numbers = _sum(((f"{figure(p.acting.size)}·{figure(p.cosine)}",), sense * p.along) for p in others)
    yield (INDENT, forces.found.acting.symbol, " = ", *numbers, f" = {figure(forces.value)} {spelt('N')}")


def _cosine(part: Part) -> tuple[Word, ...]:
    angle = float(np.degrees(np.arccos(part.cosine)))
    return (part.acting.symbol, f"·cos {numeral(angle, '.1f')}°") if angle >= 0.05 else (part.acting.symbol,)


def _letters(term: Term) -> tuple[Word, ...]:
    return (term.acting.symbol, "·", term.letter) if term.number else (term.acting.symbol,)


def _numbers(term: Term) -> tuple[Word, ...]:
    return (f"{figure(term.acting.size)}·{figure(term.arm)}" if term.number else figure(term.acting.size),)


def _sum(terms: Iterable[tuple[tuple[Word, ...], float]]) -> list[Word]:
    """a − b + c."""
    found: list[Word] = []
    for words, sign in terms:
        plus = " + " if found else ""
        found += [plus if sign > 0 else " − " if found else "−", *words]
    return [word for word in found if word]


def table_of_forces(acting: Iterable[Acting], unit: str = "N·m") -> Table:
    """Sizes, angles of forces from x and senses of couples; unit: of couples."""
    rows: list[tuple[Words, ...]] = []
    for one in acting:
        way = f"{numeral(round(float(np.degrees(np.angle(one.force))), 1) % 360, '.1f')}°"
        if one.couple:  # the equations have its sense as a sign
            way = _("ccw") if one.moment > 0 else _("cw") if one.moment < 0 else ""
        rows.append((one.symbol, f"{figure(one.size)} {spelt(unit if one.couple else 'N')}", way))
    return Table((_("force"), _("size"), _("from x")), rows)


def table_of_arms(equations: Sequence[MomentEquation], units: UnitSystem | None, mu: float) -> Table:
    """In the unit of lengths (none: they are ratios) and on paper; mu: SI a millimetre."""
    found: dict[int, list[Term]] = {}
    for term in (t for e in equations for t in e.terms if t.number):
        found.setdefault(term.number, []).append(term)
    rows: list[tuple[Words, ...]] = []
    for first, *others in found.values():
        of = (first.acting.symbol, *(word for term in others for word in (", ", term.acting.symbol)))
        size = figure(units.from_si(first.arm, LENGTH) if units else first.arm)
        rows.append((first.letter, of, size, f"{numeral(first.arm / mu, '.1f')} {spelt('mm')}"))
    return Table((_("arm"), _("of"), units.spelt(LENGTH) if units else "", _("on paper")), rows)


def figure(value: float) -> str:
    """A number with four figures and all those before its point, without powers of ten as far as people write it so."""
    rounded = float(f"{half_up(value):.4g}")
    if 1e4 <= abs(rounded) < 1e7:
        return numeral(value, ".0f")
    if not 0 < abs(rounded) < 1e-4:  # no power of ten
        return numeral(rounded, ".10g")
    places = len(np.format_float_positional(rounded).partition(".")[2])
    return numeral(rounded, f".{places}f" if abs(value) > PLAIN else ".4g")
