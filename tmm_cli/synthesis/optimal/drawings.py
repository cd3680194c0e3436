"""Drawings of an optimal synthesis: the search by generation, and what was wanted of a path or a law of motion beside
what the best candidate reaches, with its table.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tmm_cli.language import N_, Phrase
from tmm_cli.roots import least
from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.optimal.candidates import Candidates
from tmm_cli.synthesis.optimal.evolution import Evolved
from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.synthesis.record import Listing
from tmm_cli.tolerances import NO_VIOLATION
from tmm_cli.variants.variant import Places
from tmm_cli.vectors import Real, Vector

CURVE = 361  # places of a path or a law that is drawn
NONE = np.zeros(0)

Read = Callable[[Places, str], Real]


def history(evolved: Evolved, shown: Callable[[Real], Real], polished: float, quantity: str, kind: str) -> Diagram:
    """shown: an objective as users read it; polished: the one that was found; quantity: what it is called.

    Above: the best so far of those that keep the constraints, and behind it the candidate that led in each generation
    (early on it misses them: the tolerance shrinks). Below: by how much that one misses them, where it does. Where all
    were tried, each of them that keeps the constraints, and the best so far.
    """
    objective, violation = evolved.history.T
    if evolved.every:
        leading, found = N_("candidate at the positions of the search"), N_("the best of them, looked at closely")
        across, title = N_("candidate"), N_("All candidates, one after another")
    else:
        leading, found = N_("leading candidate (a new population where it rises)"), N_("after the polish")
        across, title = N_("generation"), N_("Best candidate by generation")
    number = np.arange(len(objective))
    there = np.where(np.isfinite(objective) & ((violation == 0) | (not evolved.every)), objective, np.nan)
    kept = np.fmin.accumulate(np.where(violation == 0, there, np.nan))
    lines = [Line(leading, number, shown(there), faint=True)]
    if np.any(np.isfinite(kept)):
        lines.append(Line(N_("best so far that keeps the constraints"), number, shown(kept)))
    lines.append(Line(found, np.array([len(number)]), np.array([polished]), dots=True))
    missed = np.isfinite(violation) & (violation > NO_VIOLATION)
    violated = Line(N_("constraints missed, relative"), number, np.where(missed, violation, np.nan))
    return Diagram(
        "history", title, (across, "number"), (Phrase("objective: {quantity}", quantity=quantity), kind),
        tuple(lines), lower=(violated,) if np.any(missed) and not evolved.every else (),
        lower_y=(N_("constraints missed, relative"), "number"),
    )  # fmt: skip


def reached(candidates: Candidates, x: Real, n: int) -> tuple[Listing, Diagram]:
    """Of the n-th quantity, for shares x of the ranges."""
    two = x[None]

    def read(places: Places, key: str) -> Real:
        found: Real = candidates.run(two, places)[f"{n}.{key}"][0]
        return found

    quantity = candidates.quantity(n, candidates.numbers(x))
    return (_law if quantity.of == "law" else _path)(candidates, n, quantity, read)


def _name(candidates: Candidates, n: int) -> str:
    return f"{candidates.quantities[n].of}-{n}" if n else candidates.quantities[n].of


def _law(candidates: Candidates, n: int, quantity: Goal, read: Read) -> tuple[Listing, Diagram]:
    swings = candidates.overs[n].swings
    at, wanted = np.array(quantity.places), np.array(quantity.wanted)
    low, high = float(np.min(at)), float(np.max(at))
    if candidates.closed:
        high = max(high, low + candidates.cycle)
    else:
        low, high = min(candidates.ends[0], low), max(candidates.ends[1], high)
    q = np.linspace(low, high, CURVE)
    run, there = read(Places(NONE, q), "run"), read(Places(NONE, at), "run")
    if quantity.relative:
        run, there = run - there[0], there - there[0]
    if swings:
        there = wanted + np.angle(np.exp(1j * (there - wanted)))
        run = np.unwrap(run)
        run = run + 2 * np.pi * np.round((there[0] - np.interp(at[0], q, run)) / (2 * np.pi))
    kind = "angle" if swings else "length"
    place = "angle" if candidates.linkage.driver.kind == "turn" else "length"
    columns = (
        ("at", N_("driver at"), place), ("wanted", N_("wanted"), kind), ("reached", N_("reached"), kind),
        ("off", N_("deviation"), kind),
    )  # fmt: skip
    rows = tuple(zip(quantity.places, wanted.tolist(), there.tolist(), (there - wanted).tolist(), strict=True))
    lines = (
        Line(N_("found mechanism"), q, run), Line(N_("wanted"), at, wanted, dots=True),
        Line(N_("reached"), at, there, dots=True),
    )  # fmt: skip
    up = (N_("angle of the link") if swings else N_("run of the link"), kind)
    title = N_("Law of motion over the whole way of the driver")
    drawn = Diagram(_name(candidates, n), title, (N_("driver"), place), up, lines)
    return Listing(_name(candidates, n), N_("Wanted law and what is reached"), columns, rows), drawn


def _path(candidates: Candidates, n: int, quantity: Goal, read: Read) -> tuple[Listing, Diagram]:
    wanted = np.array(quantity.wanted)

    def spots(places: Places) -> Vector:
        return read(places, "px") + 1j * read(places, "py")

    path = spots(Places(np.linspace(0, 1, CURVE), NONE))
    if quantity.places:
        there = spots(Places(NONE, np.array(quantity.places)))
    else:
        there = spots(Places(_closest(lambda shares: spots(Places(shares, NONE)), wanted, candidates.closed), NONE))
    rows: tuple[tuple[float, ...], ...] = tuple(
        (w.real, w.imag, p.real, p.imag, abs(p - w)) for w, p in zip(wanted.tolist(), there.tolist(), strict=True)
    )
    columns: tuple[tuple[str, str, str], ...] = (
        ("x", N_("x"), "length"), ("y", N_("y"), "length"), ("x_reached", N_("x reached"), "length"),
        ("y_reached", N_("y reached"), "length"), ("off", N_("deviation"), "length"),
    )  # fmt: skip
    if quantity.places:
        rows = tuple((q, *row) for q, row in zip(quantity.places, rows, strict=True))
        columns = (("at", N_("driver at"), "angle" if candidates.linkage.driver.kind == "turn" else "length"), *columns)
    lines = (
        Line(N_("path"), path.real, path.imag), Line(N_("wanted"), wanted.real, wanted.imag, dots=True),
        Line(N_("reached"), there.real, there.imag, dots=True),
    )  # fmt: skip
    drawn = Diagram(
        _name(candidates, n), N_("Path of the point over the whole way of the driver"), (N_("x"), "length"),
        (N_("y"), "length"), lines, equal=True,
    )  # fmt: skip
    title = (
        N_("Wanted points and those that are reached at these places of the driver") if quantity.places
        else N_("Wanted points and the nearest that are reached")
    )  # fmt: skip
    return Listing(_name(candidates, n), title, columns, rows), drawn


def _closest(path: Callable[[Real], Vector], wanted: Vector, closed: bool) -> Real:
    """Shares of the way at which a path comes nearest to points."""
    shares, step = np.linspace(0, 1, CURVE), 1 / (CURVE - 1)
    near = shares[np.argmin(np.abs(path(shares) - wanted[:, None]), axis=1)]
    low, high = near - step, near + step
    ends = (low, high) if closed else (np.maximum(low, 0.0), np.minimum(high, 1.0))
    found: Real = least(lambda some: np.abs(path(some) - np.resize(wanted, len(some))), *ends)[0]
    return found
