"""Four-bar by 2 to 5 pairs of angles of its input AB and output DC, given or taken from a function.

l1 = AB, l2 = BC, l3 = DC, l4 = AD; angles from AD, counterclockwise, without the zero angles phi0 and psi0. Of all real
solutions those without defects are kept: all pairs on one assembly, no place between them where the input locks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.roots import least
from tmm_cli.synthesis import freudenstein, loop
from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.freudenstein import Bars
from tmm_cli.synthesis.functions import Function
from tmm_cli.synthesis.grashof import FourBar, four_bar
from tmm_cli.synthesis.inversion import construction
from tmm_cli.synthesis.measures import crank_turns
from tmm_cli.synthesis.parallelogram import parallelogram
from tmm_cli.synthesis.record import Demand, Infeasible, Outcome, Value

PARAMETERS: Final = {
    "l1": "length", "l2": "length", "l3": "length", "l4": "length",
    "phi0": "angle", "psi0": "angle", "phi1": "angle", "psi1": "angle",
}  # fmt: skip
W: Final = "synthesis_four_bar_by_angles"
SCAN: Final = 1500  # four-bars through two pairs that are compared, and
LONGEST: Final = 10.0  # the largest l1/l4 or l4/l1 of them
ERRORS: Final = 721  # places of the curve of structural error
SENSIBLE: Final = 50.0  # the longest link over the shortest one of a four-bar that is told instead
INWARDS: Final = 2e-6  # rad, from the edge, so that six digits of it are still good
STEPS: Final = np.radians(np.arange(1, 241) * 0.25)  # by which the last output angle is changed for the nearest task


@dataclass(frozen=True)
class Asked:
    """Given angles (rad); lengths (m) by name: one, or two of l1, l3, l4 with two pairs; zero angles, None: to find.

    choose: transmission, crank, or the number of a solution; keep: whether defects are put up with.
    """

    phi: tuple[float, ...]
    psi: tuple[float, ...]
    lengths: dict[str, float]
    phi0: float | None = 0.0
    psi0: float | None = 0.0
    choose: str = "transmission"
    keep: bool = False
    function: Function | None = None

    @property
    def span(self) -> tuple[float, float]:
        """First and last input angle that are used."""
        return self.function.phi if self.function else (self.phi[0], self.phi[-1])


@dataclass(frozen=True)
class Quality:
    """Of one four-bar: its least transmission angle (rad) over the range and the input angle there (from AD), its
    defect ("", locks, branch), whether its input turns fully, whether a link is the other way than its given zero says.
    """

    least: float
    worst: float
    defect: str
    crank: bool
    reversed: bool


def quality(one: Bars, asked: Asked) -> Quality:
    """What one four-bar (single numbers) is worth; BD, and with it the angle BCD, is extreme at the ends and on AD."""
    l1, l2, l3, phi0 = (float(x) for x in (one.l1, one.l2, one.l3, one.phi0))
    low, high = sorted((phi0 + asked.span[0], phi0 + asked.span[1]))
    places = np.array([low, high, *(np.pi * np.arange(np.ceil(low / np.pi), np.floor(high / np.pi) + 1))])
    cosines = (l2 * l2 + l3 * l3 - (1 + l1 * l1 - 2 * l1 * np.cos(places))) / (2 * l2 * l3)
    k = int(np.argmax(np.abs(cosines)))
    angle = float(np.arccos(min(1.0, abs(cosines[k]))))
    b, c = one.pins(np.asarray(asked.phi), np.asarray(asked.psi))
    sides = np.sign(np.asarray(((c - b) * np.conj(c - 1)).imag, dtype=float))
    defect = "branch" if len(set(sides.tolist())) > 1 else "locks" if abs(cosines[k]) >= 1 else ""
    turns = four_bar(FourBar(l1, l2, l3, 1.0)).turns[0]
    zeros = ((asked.phi0, one.phi0), (asked.psi0, one.psi0))
    turned = any(given is not None and np.cos(float(found) - float(given)) < 0 for given, found in zeros)
    return Quality(angle, float(places[k]), defect, bool(turns), turned)


def through(asked: Asked) -> list[Bars]:
    """All four-bars that are found for the task, over l4."""
    if len(asked.phi) > 2:
        if (one := parallelogram(asked.phi, asked.psi, asked.phi0, asked.psi0)) is not None:
            return [one]
        found = freudenstein.solutions([asked.phi], [asked.psi], asked.phi0, asked.psi0)
        return [found[0, k] for k in range(found.l1.shape[1]) if _real(found[0, k])]
    phi, psi = (np.asarray([row], freudenstein.EXACT) for row in (asked.phi, asked.psi))
    phi, psi = phi + (asked.phi0 or 0.0), psi + (asked.psi0 or 0.0)
    lengths = asked.lengths
    if len(lengths) == 2:
        a, b = sorted(lengths)
        ways = []
        for ratio in (lengths[b] / lengths[a], -lengths[b] / lengths[a]):
            row = [1.0, -ratio, 0] if b == "l3" else [1.0, 0, 0] if a == "l1" else [0, 1.0, 0]  # p = ratio q, p, or q
            ways.append(_of_two(phi, psi, np.array([row]), np.array([0.0 if b == "l3" else ratio]), asked))
        return [one for one in ways if _real(one)]
    return _best_of_two(phi, psi, asked)


def _of_two(phi: Any, psi: Any, row: Any, value: Any, asked: Asked) -> Bars:
    values = freudenstein.two(phi, psi, row, value)
    zero = np.zeros((1, 2), freudenstein.EXACT)
    found = freudenstein.bars(np.concatenate([values, zero], -1), phi, psi)[0]
    return replace(found, phi0=found.phi0 + (asked.phi0 or 0.0), psi0=found.psi0 + (asked.psi0 or 0.0))


def _best_of_two(phi: Any, psi: Any, asked: Asked) -> list[Bars]:
    """The four-bar of best transmission through two pairs, l1/l4 being free."""

    def make(p: float) -> Bars:
        return _of_two(phi, psi, np.array([[1.0, 0, 0]]), np.array([p]), asked)

    def badness(p: float) -> float:
        one = make(p)
        if not _real(one):
            return 9.0
        q = quality(one, asked)
        return (4.0 if q.defect else 2.0 if q.reversed else 0.0) - q.least

    tried = np.geomspace(1 / LONGEST, LONGEST, SCAN // 2)
    tried = np.concatenate([-tried[::-1], tried])
    values = np.array([badness(p) for p in tried])
    k = int(np.argmin(values))
    low, high = (tried[min(max(k + step, 0), len(tried) - 1)] for step in (-1, 1))
    if low * high > 0:
        best, value = least(lambda ps: np.array([badness(p) for p in ps]), low, high)
        if value <= values[k]:
            return [make(best)]
    one = make(tried[k])
    return [one] if _real(one) else []


def _real(one: Bars) -> bool:
    numbers = np.array([float(x) for x in vars(one).values()])
    return bool(np.all(np.isfinite(numbers)) and np.all(numbers[:3] > 1e-9) and np.all(numbers[:3] < 1e9))


def _sensible(one: Bars) -> bool:
    links = [float(one.l1), float(one.l2), float(one.l3), 1.0]
    return max(links) < SENSIBLE * min(links)


def chosen(asked: Asked, found: list[Bars]) -> int:
    """Which of the four-bars is taken, -1: none has no defect."""
    marks = [quality(one, asked) for one in found]
    if asked.choose.isdigit():
        return int(asked.choose) - 1
    fair = [k for k, mark in enumerate(marks) if asked.keep or not mark.defect]
    if not fair:
        return -1
    with_crank = asked.choose == "crank"
    return max(fair, key=lambda k: (
        not marks[k].defect, with_crank and marks[k].crank, not marks[k].reversed, marks[k].least))  # fmt: skip


def refuse(asked: Asked) -> None:
    """Raises Infeasible for pairs that no four-bar passes, or none in order."""
    steps = np.diff(asked.phi)
    if not asked.function and not (np.all(steps > 0) or np.all(steps < 0)):
        sense = np.sign(steps[0]) or 1.0
        bad = int(np.argmax(steps * sense <= 0)) + 1
        raise Infeasible(("pairs", bad), f"{W}.order", f"{W}.in_order", {
            "this": (str(bad + 1), "word"), "last": (str(bad), "word"), "phi": (asked.phi[bad - 1], "angle"),
        })  # fmt: skip
    if abs(asked.span[1] - asked.span[0]) >= 2 * np.pi:
        raise Infeasible("input" if asked.function else "pairs", f"{W}.turn", f"{W}.one_turn")
    for name, value in asked.lengths.items():
        if not value > 0:
            raise Infeasible(name, f"{W}.positive", f"{W}.more_than_zero")


def _refuse_found(asked: Asked, found: list[Bars]) -> None:
    """None of what was found is any good: why, and the nearest last output angle for which one is."""
    key: tuple[str | int, ...] = ("output",) if asked.function else ("pairs", len(asked.psi) - 1)
    defects = {quality(one, asked).defect for one in found}
    reason = f"{W}.none" if not found else f"{W}.all_{'branch' if defects == {'branch'} else 'locks'}"
    if len(defects) > 1:
        reason = f"{W}.all_both"
    near = _nearest(asked)
    if near is None:
        raise Infeasible(key, reason, f"{W}.other" if found else f"{W}.other_alone")
    raise Infeasible(key, reason, f"{W}.nearest" if found else f"{W}.nearest_alone", {"psi": (near, "angle")})


def _nearest(asked: Asked) -> float | None:
    """The nearest end of the output (rad) for which there is a four-bar without defects and of links that can be made;
    None: not within 60 deg.
    """

    def ends(change: float) -> Asked:
        if asked.function:
            function = replace(asked.function, psi=(asked.function.psi[0], asked.function.psi[1] + change))
            phi, psi = function.precision(len(asked.phi))
            return replace(asked, function=function, phi=tuple(phi), psi=tuple(psi))
        return replace(asked, psi=(*asked.psi[:-1], asked.psi[-1] + change))

    def good(change: float) -> bool:
        return chosen(ends(change), [one for one in through(ends(change)) if _sensible(one)]) >= 0

    if len(asked.phi) < 3:
        return None
    for step in STEPS:
        for change in (step, -step):
            if good(change):
                inside, outside = change, change - np.sign(change) * STEPS[0]
                for _ in range(30):
                    middle = (inside + outside) / 2
                    inside, outside = (middle, outside) if good(middle) else (inside, middle)
                last = asked.function.psi[1] if asked.function else asked.psi[-1]
                return float(last + inside + np.sign(inside) * INWARDS)
    return None


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(asked)
    found = through(asked)
    at = chosen(asked, found)
    if at < 0:
        _refuse_found(replace(asked, keep=False), found)
    if at >= len(found):
        raise Infeasible("choose", f"{W}.number", f"{W}.numbers", {"count": (str(len(found)), "word")})
    one, mark = found[at], quality(found[at], asked)
    if mark.defect and not asked.keep:
        raise Infeasible("choose", f"{W}.its_{mark.defect}", f"{W}.another")
    name = next(iter(asked.lengths))
    size = asked.lengths[name] / (1.0 if name == "l4" else getattr(one, name))
    phi, psi = one.phi0 + asked.phi[0], one.psi0 + asked.psi[0]
    lengths = {"l1": one.l1 * size, "l2": one.l2 * size, "l3": one.l3 * size, "l4": size}
    angles = {"phi0": one.phi0, "psi0": one.psi0, "phi1": phi, "psi1": psi}
    plain = float if isinstance(asked.lengths[name], float) else np.longdouble  # more digits only where they are asked
    values = [Value(key, plain(value), PARAMETERS[key], f"{W}.{key}") for key, value in (lengths | angles).items()]
    values += [
        Value("", mark.least, "angle", f"{W}.transmission"),
        Value("", None, "word", f"{W}.defect", f"{W}.{mark.defect or 'sound'}"),
    ]
    for k, other in enumerate(found if len(found) > 1 else ()):
        its = quality(other, asked)
        scale = asked.lengths[name] / (1.0 if name == "l4" else getattr(other, name))
        of = f"{W}.s{k + 1}"
        values += [Value("", getattr(other, key) * scale, "length", f"{of}_{key}") for key in ("l1", "l2", "l3")]
        values += [Value("", getattr(other, key), "angle", f"{of}_{key}") for key in ("phi0", "psi0")]
        values += [Value("", its.least, "angle", f"{of}_transmission")]
        values += [Value("", None, "word", f"{of}_defect", f"{W}.{its.defect or 'sound'}")]
    demands = [
        Demand(f"{W}.pair{k + 1}", float(b), "angle", partial(_output, one, (a,), (b,)), at=1.0)
        for k, (a, b) in enumerate(zip(asked.phi, asked.psi, strict=True))
    ]
    demands.append(Demand(f"{W}.transmission", mark.least, "angle", partial(_transmission, mark.worst), False, 1.0))
    free = parallelogram(asked.phi, asked.psi, asked.phi0, asked.psi0) is not None
    if not free:  # it has change points
        demands.append(Demand(f"{W}.crank_turns", float(mark.crank), "number", crank_turns, asked=False))
    drawings: list[Any] = [construction(one, asked.phi, asked.psi, float(size), W)]
    if asked.function and not mark.defect:
        curve, error = errors(one, asked)
        values.append(Value("", error, "angle", f"{W}.error"))
        demands.append(Demand(f"{W}.error", error, "angle", partial(_largest, one, asked), False, 1.0))
        drawings.append(curve)
    notes = ((f"{W}.parallelogram",) if free else ()) + ((f"{W}.reversed",) if mark.reversed else ())
    return Outcome(_given(asked), tuple(values), f"{W}.source", tuple(demands), tuple(drawings), notes)


def _given(asked: Asked) -> tuple[Value, ...]:
    values = [Value(name, value, "length", f"{W}.{name}") for name, value in asked.lengths.items()]
    if asked.function:
        text = asked.function.name.replace("x^1.5", "x^(3/2)") or f"{W}.table"
        values.append(Value("", None, "word", f"{W}.function", text))
    for k, (a, b) in enumerate(zip(asked.phi, asked.psi, strict=True)):
        values += [Value("", a, "angle", f"{W}.input{k + 1}"), Value("", b, "angle", f"{W}.pair{k + 1}")]
    zeros = {"phi0": asked.phi0, "psi0": asked.psi0}
    return (*values, *(Value(key, value, "angle", f"{W}.{key}") for key, value in zeros.items() if value is not None))


def _output(one: Bars, phi: Any, psi: Any, results: Any) -> float:
    """The output angle, from its zero, at an input angle."""
    near = np.asarray(psi) + float(one.psi0)
    return float((loop.output_angles(results, np.asarray(phi) + float(one.phi0), near) - float(one.psi0))[0])


def _transmission(phi: float, results: Any) -> float:
    return float(loop.transmission(results, np.array([phi]))[0])


def _largest(one: Bars, asked: Asked, results: Any) -> float:
    """The largest structural error on the mechanism."""
    assert asked.function
    phi = np.linspace(*asked.function.phi, ERRORS)
    wanted = asked.function.wanted(phi)
    there = loop.output_angles(results, phi + float(one.phi0), wanted + float(one.psi0)) - float(one.psi0)
    return float(np.max(np.abs(there - wanted)))


def outputs(one: Bars, phi: Any, near: Any, side: float) -> Any:
    """Output angles (without psi0) at input angles phi; side: the sign of (BC x DC)."""
    l1, l2, l3 = (np.asarray(x, dtype=float) for x in (one.l1, one.l2, one.l3))
    b = l1 * np.exp(1j * (float(one.phi0) + phi))
    way = b - 1
    cosine = (l3 * l3 + np.abs(way) ** 2 - l2 * l2) / (2 * l3 * np.abs(way))
    psi = np.angle(way) + side * np.arccos(np.clip(cosine, -1, 1))
    gap = psi - float(one.psi0) - near
    return near + gap - 2 * np.pi * np.round(gap / (2 * np.pi))


def errors(one: Bars, asked: Asked) -> tuple[Diagram, float]:
    """The curve of structural error over the input angle, with the precision points, and its largest size."""
    assert asked.function
    phi = np.linspace(*asked.function.phi, ERRORS)
    wanted = asked.function.wanted(phi)
    first = np.array([asked.phi[0]])
    side = min((1.0, -1.0), key=lambda s: float(abs(outputs(one, first, asked.psi[0], s) - asked.psi[0])[0]))
    error = outputs(one, phi, wanted, side) - wanted
    lines = (
        Line(f"{W}.error_curve", phi, error),
        Line(f"{W}.points", np.asarray(asked.phi), np.zeros(len(asked.phi)), dots=True),
    )
    axes = (f"{W}.phi", "angle"), (f"{W}.error_curve", "angle")
    return Diagram("error", f"{W}.error_title", *axes, lines), float(np.max(np.abs(error)))
