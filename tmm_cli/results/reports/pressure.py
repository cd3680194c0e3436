"""Pressure and transmission angles of every group over the driver's way, with what is allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from tmm_cli.pipeline import Results
from tmm_cli.pressure import NOTHING
from tmm_cli.problem.dimensions import ANGLE, LENGTH, NUMBER
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def tables(results: Results) -> Iterable[Table]:
    """A row for each driven link."""
    found = results.pressure
    if not found:
        return
    turns = results.linkage.driver.kind == "turn"
    way = results.way
    full = turns and way is not None and way.full
    places = [float(np.mod(p.place, 2 * np.pi * way.turns)) if full and way else p.place for p in found]
    places = [place if p.largest > NOTHING else math.nan for place, p in zip(places, found, strict=True)]
    note = say("pressure.note.file" if any(results.problem.limits_set) else "pressure.note.default")
    yield Table(
        "pressure", say("pressure.title"),
        (
            Column(say("word.group"), [p.group for p in found]),
            Column(say("pressure.link"), [p.link for p in found]),
            Column(say("pressure.motion"), [say("pressure.slides" if p.slides else "pressure.turns") for p in found]),
            Column(say("pressure.pair"), [p.pair for p in found]),
            Column(say("pressure.largest"), [p.largest for p in found], ANGLE),
            Column(say("pressure.place"), places, ANGLE if turns else LENGTH),
            Column(say("pressure.transmission"), [p.transmission for p in found], ANGLE),
            Column(say("pressure.gain"), [p.gain for p in found], NUMBER),
            Column(say("pressure.allowed"), [p.allowed for p in found], ANGLE),
            Column(say("pressure.verdict"), [say("pressure.holds" if p.holds else "pressure.exceeds") for p in found]),
        ),
        notes=(note,),
    )  # fmt: skip
