"""Four-bar by 2 to 5 pairs of angles of its input AB and output DC, given or taken from a function.

l1 = AB, l2 = BC, l3 = DC, l4 = AD; angles from AD, counterclockwise, without the zero angles phi0 and psi0. Of all real
solutions those without defects are kept: all pairs on one assembly, no place between them where the input locks.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis import loop
from tmm_cli.synthesis.freudenstein import Bars
from tmm_cli.synthesis.functions import ANGLES
from tmm_cli.synthesis.inversion import construction
from tmm_cli.synthesis.measures import crank_turns
from tmm_cli.synthesis.nearest_pairs import refuse_found, refuse_inputs
from tmm_cli.synthesis.pair_changes import LINKS, fit, length
from tmm_cli.synthesis.pairs import LONGEST, Asked, chosen, of_ratio, quality, real, through
from tmm_cli.synthesis.parallelogram import parallelogram
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Listing, Outcome, Shown, Value
from tmm_cli.synthesis.structural_error import errors, extremes
from tmm_cli.vectors import settled

__all__ = ["PARAMETERS", "Asked", "chosen", "quality", "solve", "through"]
PARAMETERS: Final = {
    "l1": "length", "l2": "length", "l3": "length", "l4": "length",
    "phi0": "angle", "psi0": "angle", "phi1": "angle", "psi1": "angle",
}  # fmt: skip
W: Final = "synthesis_four_bar_by_angles"
ANY: Final = 0.1  # m: a length, where any will do
STEP: Final = np.radians(10)  # of the input, from a neighbour that it must leave, or less than a turn
SPREAD: Final = np.radians(30)  # between inputs of which none can stay
HALVINGS: Final = 30
FAMILY: Final = 121  # four-bars through two pairs that are listed, of each sense of the crank


def refuse(asked: Asked) -> None:
    """Raises Infeasible for lengths that are none and inputs that turn back, or round."""
    for name, value in asked.lengths.items():
        if not value > 0:
            _refuse_length(asked, name)
    steps = np.diff(asked.phi)
    if not asked.function and not (np.all(steps > 0) or np.all(steps < 0)):
        sense = np.sign(steps[0]) or 1.0
        bad = int(np.argmax(steps * sense <= 0)) + 1
        error = Infeasible(("pairs", bad), f"{W}.order", f"{W}.in_order", {
            "this": (str(bad + 1), "word"), "last": (str(bad), "word"),
        })  # fmt: skip
        _refuse_inputs(asked, (bad, bad - 1), error)
    if abs(asked.span[1] - asked.span[0]) >= 2 * np.pi:
        error = Infeasible("input" if asked.function else "pairs", f"{W}.turn", f"{W}.one_turn")
        _refuse_inputs(asked, (1, 0) if asked.function else (len(asked.phi) - 1, 0), error)


def _refuse_length(asked: Asked, name: str) -> None:
    """A length that is none: with two of them the least with which a sound four-bar passes, and that of the best."""
    rest = {key: value for key, value in asked.lengths.items() if key != name}
    if not all(value > 0 for value in rest.values()):
        raise Infeasible(name, f"{W}.positive", f"{W}.any_length", {"one": (ANY, "length")})
    if not rest:
        raise Infeasible(name, f"{W}.positive", f"{W}.at_least", {"least": (SMALLEST, "length")})
    best = float(solve(replace(asked, lengths=rest)).parameters[name].value)
    change = length(replace(asked, lengths=rest | {name: best}))
    moves = -change.step * np.arange(change.count + 1)
    good = fit(change, moves).sensible
    inside = float(moves[np.flatnonzero(good)[-1]]) if np.any(good) else 0.0
    outside = inside - change.step
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if fit(change, [middle], closely=True).sensible[0] else (inside, middle)
    values: dict[str, Shown] = {
        "least": (float(change.value(inside + SMALLEST)), "length", "least"),
        "best": (best, "length"),
    }
    long = "_long" if fit(change, [inside - SMALLEST], closely=True).good[0] else ""
    values["links"] = (f"{LINKS:g}", "word")
    raise Infeasible(name, f"{W}.positive", f"{W}.length_least{long}", values)


def _refuse_inputs(asked: Asked, which: tuple[int, int], error: Infeasible) -> None:
    """Raises Infeasible with an input angle that mends it; where no one alone does, with one that leaves it less to
    mend, and what else must change then."""
    try:
        refuse_inputs(asked, which, error)
    except Infeasible as told:
        if told is not error:
            raise
    row = np.asarray(asked.function.phi if asked.function else asked.phi, dtype=float)
    bad, sense = which[0], float(np.sign(row[1] - row[0]) or 1.0)
    if error.path[-1] in ("pairs", "input"):  # less than a turn from the first to the last
        bad = len(row) - 1
        row[bad] = row[0] + sense * (2 * np.pi - STEP)
    elif bad + 1 < len(row) and sense * (row[bad + 1] - row[bad - 1]) > 0:
        row[bad] = (row[bad - 1] + row[bad + 1]) / 2
    else:
        row[bad] = row[bad - 1] + sense * STEP
    error.nearest, error.values["which"] = f"{W}.input_alone", (str(bad + 1), "word")
    if not np.all(sense * np.diff(row) > 0) or abs(row[-1] - row[0]) >= 2 * np.pi:
        row, error.nearest = row[0] + sense * SPREAD * np.arange(len(row)), f"{W}.inputs_{len(row)}"
    error.values |= {"phi": (float(row[bad]), "angle")} | {
        f"phi{k + 1}": (float(x), "angle") for k, x in enumerate(row)
    }  # fmt: skip
    try:
        solve(_with_inputs(asked, tuple(map(float, row))))
    except Infeasible as then:
        error.then = then
    raise error


def _with_inputs(asked: Asked, row: tuple[float, ...]) -> Asked:
    """The same with other input angles (rad), of a function with other ends of the input."""
    if asked.function:
        function = replace(asked.function, phi=(row[0], row[1]))
        phi, psi = function.precision(len(asked.phi))
        return replace(asked, function=function, phi=tuple(phi), psi=tuple(psi))
    return replace(asked, phi=row)


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(asked)
    found = through(asked)
    at = chosen(asked, found)
    if at < 0 or not found:
        try:
            refuse_found(replace(asked, keep=False), found)
        except Infeasible as told:
            if asked.choose.isdigit():  # other pairs have other solutions
                told.then = Infeasible("choose", told.reason, f"{W}.choose_best")
            raise
    fair = " or ".join(str(k + 1) for k, other in enumerate(found) if not quality(other, asked).defect)
    if at >= len(found):
        words, count = "numbers" if asked.keep else "numbers_fair" if fair else "numbers_keep", str(len(found))
        raise Infeasible(
            "choose", f"{W}.number", f"{W}.{words}", {"count": (count, "word"), "numbers": (fair, "word")}, whole=True
        )
    one, mark = found[at], quality(found[at], asked)
    if mark.defect and not asked.keep:
        words = "another" if fair else "keep"
        raise Infeasible("choose", f"{W}.its_{mark.defect}", f"{W}.{words}", {"numbers": (fair, "word")})
    name, size = next(iter(asked.lengths)), _size(asked, one)
    phi, psi = one.phi0 + asked.phi[0], one.psi0 + asked.psi[0]
    lengths = {"l1": one.l1 * size, "l2": one.l2 * size, "l3": one.l3 * size, "l4": size}
    angles = {"phi0": one.phi0, "psi0": one.psi0, "phi1": phi, "psi1": psi}
    angles = {key: settled(angle, np.pi) for key, angle in angles.items()}
    plain = float if isinstance(asked.lengths[name], float) else np.longdouble  # more digits only where they are asked
    values = [Value(key, plain(value), PARAMETERS[key], f"{W}.{key}") for key, value in (lengths | angles).items()]
    values += [
        Value("", mark.least, "angle", f"{W}.transmission"),
        Value("", None, "word", f"{W}.defect", f"{W}.{mark.defect or 'sound'}"),
    ]
    if len(found) > 1:
        values.append(Value("", None, "word", f"{W}.solution", f"{at + 1} / {len(found)}"))
    if _free(asked):
        values.append(Value("", 1 / float(one.l1), "number", f"{W}.free"))
    demands = [
        Demand(f"{W}.pair{k + 1}", float(b), "angle", partial(_output, one, (a,), (b,)), at=1.0)
        for k, (a, b) in enumerate(zip(asked.phi, asked.psi, strict=True))
    ]
    demands.append(Demand(f"{W}.transmission", mark.least, "angle", partial(_transmission, mark.worst), False, 1.0))
    any_one = parallelogram(asked.phi, asked.psi, asked.phi0, asked.psi0) is not None
    if not any_one:  # it has change points
        demands.append(Demand(f"{W}.crank_turns", float(mark.crank), "number", crank_turns, asked=False))
    drawings: list[Any] = [construction(one, asked.phi, asked.psi, float(size), W)]
    if asked.function and not mark.defect:
        curve, error = errors(one, asked, W)
        values.append(Value("", error, "angle", f"{W}.error"))
        demands.append(Demand(f"{W}.error", error, "angle", partial(_largest, one, asked), False, 1.0))
        drawings.append(curve)
    notes = ((f"{W}.parallelogram",) if any_one else ()) + ((f"{W}.reversed",) if mark.reversed else ())
    if asked.choose == "crank" and not mark.crank:
        notes = (*notes, f"{W}.no_crank")
    listings = (_solutions(asked, found, at),) if len(found) > 1 else ()
    if _free(asked):
        at_end = abs(abs(np.log(abs(float(one.l1)))) - np.log(LONGEST)) < 1e-9
        notes, listings = (*notes, f"{W}.free_end" if at_end else f"{W}.free_note"), (*listings, _family(asked))
    return Outcome(_given(asked), tuple(values), f"{W}.source", tuple(demands), tuple(drawings), notes, listings)


def _free(asked: Asked) -> bool:
    """Two pairs and one length leave l1/l4 free."""
    return len(asked.phi) == 2 and len(asked.lengths) == 1


def _size(asked: Asked, one: Bars) -> Any:
    """l4 (m) of a four-bar, by the length that is given."""
    name = next(iter(asked.lengths))
    return asked.lengths[name] / (1.0 if name == "l4" else getattr(one, name))


def _solutions(asked: Asked, found: list[Bars], at: int) -> Listing:
    """Every four-bar that was found, by the number by which it can be chosen."""
    names = ("l1", "l2", "l3", "l4", "phi0", "psi0")
    columns = (
        (f"{W}.number_of", "name"), (f"{W}.taken", "word"),
        *((f"{W}.column_{name}", "length" if name[0] == "l" else "angle") for name in names),
        (f"{W}.column_transmission", "angle"), (f"{W}.column_crank", "word"), (f"{W}.defect", "word"),
    )  # fmt: skip
    rows = []
    for k, one in enumerate(found):
        mark, size = quality(one, asked), _size(asked, one)
        lengths = (float(one.l1 * size), float(one.l2 * size), float(one.l3 * size), float(size))
        taken = f"{W}.chosen" if k == at else None
        crank = f"{W}.turns_fully" if mark.crank else f"{W}.swings"
        rows.append((str(k + 1), taken, *lengths, float(one.phi0), float(one.psi0), mark.least, crank,
                     f"{W}.short_{mark.defect or 'sound'}"))  # fmt: skip
    return Listing("solutions", f"{W}.solutions", columns, tuple(rows))


def _family(asked: Asked) -> Listing:
    """Four-bars through two pairs for the ratios l1/l4 that are compared."""
    names = ("l1", "l2", "l3", "l4", "phi0", "psi0")
    columns = (
        (f"{W}.free", "number"), *((f"{W}.column_{name}", "length" if name[0] == "l" else "angle") for name in names),
        (f"{W}.column_transmission", "angle"), (f"{W}.defect", "word"),
    )  # fmt: skip
    ratios = np.geomspace(1 / LONGEST, LONGEST, FAMILY)
    rows = []
    for ratio in np.concatenate([ratios, -ratios]):
        one = of_ratio(asked, float(ratio))
        if real(one):
            mark, size = quality(one, asked), _size(asked, one)
            lengths = (float(one.l1 * size), float(one.l2 * size), float(one.l3 * size), float(size))
            rows.append((abs(float(ratio)), *lengths, float(one.phi0), float(one.psi0), mark.least,
                         f"{W}.short_{mark.defect or 'sound'}"))  # fmt: skip
    return Listing("family", f"{W}.family", columns, tuple(rows), long=True)


def _given(asked: Asked) -> tuple[Value, ...]:
    values = [Value(name, value, "length", f"{W}.{name}") for name, value in asked.lengths.items()]
    if asked.function:
        text = asked.function.name.replace("x^1.5", "x^(3/2)") or f"{W}.table"
        values.append(Value("", None, "word", f"{W}.function", text))
        of_x = "angle" if asked.function.name in ANGLES else "number"
        ranges = (
            ("x", asked.function.x, of_x),
            ("phi", asked.function.phi, "angle"),
            ("psi", asked.function.psi, "angle"),
        )
        for key, ends, kind in ranges:
            values += [
                Value("", end, kind, f"{W}.{key}_{side}") for side, end in zip(("from", "to"), ends, strict=True)
            ]
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
    function = asked.function

    def error(phi: Any) -> Any:
        wanted = function.wanted(phi)
        there = loop.output_angles(results, phi + float(one.phi0), wanted + float(one.psi0)) - float(one.psi0)
        return there - wanted

    return extremes(error, function)[1]
