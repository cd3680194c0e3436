"""What was wanted of a path or a law of motion beside what the best candidate reaches: a table and a drawing."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tmm_cli.synthesis.candidates import Search, W
from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.record import Listing
from tmm_cli.variants.way import Places
from tmm_cli.vectors import Real, Vector

CURVE = 361  # places of a path or a law that is drawn
ZOOMS = 6  # of the place where a path comes nearest
CLOSER = 12  # times, each
NONE = np.zeros(0)

Read = Callable[[Places, str], Real]


def reached(search: Search, x: Real, n: int) -> tuple[Listing, Diagram]:
    """Of the n-th goal, for shares x of the ranges."""
    search = search.own(x) or search
    two = np.stack([x, x])

    def read(places: Places, key: str) -> Real:
        found: Real = search.run(two, places)[f"{n}.{key}"][0]
        return found

    return (_law if search.goals[n].of == "law" else _path)(search, n, read)


def _name(search: Search, n: int) -> str:
    return f"{search.goals[n].of}-{n}" if n else search.goals[n].of


def _law(search: Search, n: int, read: Read) -> tuple[Listing, Diagram]:
    goal, swings = search.goals[n], search.overs[n].swings
    at, wanted = np.array(goal.places), np.array(goal.wanted)
    low, high = float(np.min(at)), float(np.max(at))
    if search.closed:
        high = max(high, low + search.cycle)
    else:
        low, high = min(search.ends[0], low), max(search.ends[1], high)
    q = np.linspace(low, high, CURVE)
    run, there = read(Places(NONE, q), "run"), read(Places(NONE, at), "run")
    if goal.relative:
        run, there = run - there[0], there - there[0]
    if swings:
        there = wanted + np.angle(np.exp(1j * (there - wanted)))
        run = np.unwrap(run)
        run = run + 2 * np.pi * np.round((there[0] - np.interp(at[0], q, run)) / (2 * np.pi))
    kind = "angle" if swings else "length"
    place = "angle" if search.linkage.driver.kind == "turn" else "length"
    columns = tuple(
        (f"{W}.column_{header}", own)
        for header, own in (("at", place), ("wanted", kind), ("reached", kind), ("off", kind))
    )
    rows = tuple(zip(goal.places, wanted.tolist(), there.tolist(), (there - wanted).tolist(), strict=True))
    lines = (
        Line(f"{W}.curve", q, run), Line(f"{W}.wanted", at, wanted, dots=True),
        Line(f"{W}.reached", at, there, dots=True),
    )  # fmt: skip
    up = (f"{W}.angle_of_link" if swings else f"{W}.run", kind)
    drawn = Diagram(_name(search, n), f"{W}.law_drawn", (f"{W}.driver_at", place), up, lines)
    return Listing(_name(search, n), f"{W}.law_reached", columns, rows), drawn


def _path(search: Search, n: int, read: Read) -> tuple[Listing, Diagram]:
    goal, wanted = search.goals[n], np.array(search.goals[n].wanted)

    def spots(places: Places) -> Vector:
        found: Vector = read(places, "px") + 1j * read(places, "py")
        return found

    path = spots(Places(np.linspace(0, 1, CURVE), NONE))
    if goal.places:
        there = spots(Places(NONE, np.array(goal.places)))
    else:
        there = spots(Places(_closest(lambda shares: spots(Places(shares, NONE)), wanted, search.closed), NONE))
    rows: tuple[tuple[float, ...], ...] = tuple(
        (w.real, w.imag, p.real, p.imag, abs(p - w)) for w, p in zip(wanted.tolist(), there.tolist(), strict=True)
    )
    columns = tuple((f"{W}.column_{header}", "length") for header in ("x", "y", "x_reached", "y_reached", "off"))
    if goal.places:
        rows = tuple((q, *row) for q, row in zip(goal.places, rows, strict=True))
        columns = ((f"{W}.column_at", "angle" if search.linkage.driver.kind == "turn" else "length"), *columns)
    lines = (
        Line(f"{W}.path_of", path.real, path.imag), Line(f"{W}.wanted", wanted.real, wanted.imag, dots=True),
        Line(f"{W}.reached", there.real, there.imag, dots=True),
    )  # fmt: skip
    across, up = ((f"{W}.column_{header}", "length") for header in ("x", "y"))
    drawn = Diagram(_name(search, n), f"{W}.path_drawn", across, up, lines, equal=True)
    title = f"{W}.path_reached_at" if goal.places else f"{W}.path_reached"
    return Listing(_name(search, n), title, columns, rows), drawn


def _closest(path: Callable[[Real], Vector], wanted: Vector, closed: bool) -> Real:
    """Shares of the way at which a path comes nearest to points: closer and closer about the nearest place."""
    grid, width = np.broadcast_to(np.linspace(0, 1, CURVE), (len(wanted), CURVE)), 1 / (CURVE - 1)
    nearest: Real = np.zeros(len(wanted))
    for _ in range(ZOOMS):
        grid = grid if closed else np.clip(grid, 0, 1)
        there = path(grid.ravel()).reshape(grid.shape)
        nearest = grid[np.arange(len(wanted)), np.argmin(np.abs(there - wanted[:, None]), axis=1)]
        grid = nearest[:, None] + width * np.linspace(-1, 1, 2 * CLOSER + 1)
        width /= CLOSER
    return nearest
