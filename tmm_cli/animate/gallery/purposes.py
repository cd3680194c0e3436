"""What a mechanism is for, by what its outputs do when it moves."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.kinematics.output import output_run
from tmm_cli.language import N_

QUICK = 1.1  # coefficient of change of mean speed, from which one stroke is the quick one
STILL, DWELL = 0.01, 60  # share of a stroke, and degrees of the crank about an end of it: a crank-slider's are 25

PURPOSES: Final = {
    "slides": N_("output slides to and fro"),
    "swings": N_("output swings"),
    "turns": N_("output turns round"),
    "carried": N_("output is carried in the plane"),
    "point": N_("a point is led along its path"),
    "quick": N_("quick return"),
    "strokes": N_("several strokes in a cycle"),
    "dwell": N_("output dwells"),
    "outputs": N_("several outputs"),
    "drivers": N_("several drivers"),
    "space": N_("moves in space"),
}


def purposes(results: Results) -> tuple[str, ...]:
    """Keys of PURPOSES, in their order, of results that have a motion."""
    found = set(_purposes(results))
    return tuple(key for key in PURPOSES if key in found)


def _purposes(results: Results) -> Iterable[str]:
    outputs, linkage = results.mechanism.outputs, results.linkage
    back = results.swinging
    for link in outputs:
        if linkage.output_point(link) is not None:
            yield "point"
        elif linkage.output_guide(link) is not None:
            yield "slides"
        elif not linkage.hinged_to_frame(link):
            yield "carried"
        else:
            swings = any(one.link == link for one in back) or not results.turns
            yield "swings" if swings else "turns"
    for one in back:
        if one.k >= QUICK or 0 < one.k <= 1 / QUICK:
            yield "quick"
        if len(one.strokes) > 2:
            yield "strokes"
        if any(stroke.rest for stroke in one.strokes) or _dwells(results, one.link):
            yield "dwell"
    if len(outputs) > 1:
        yield "outputs"
    if len(linkage.drivers) > 1:
        yield "drivers"


def _dwells(results: Results, link: str) -> bool:
    """Whether an output hardly moves at an end of its way, while the crank goes on."""
    motion = at_positions(results, results.closely(360 * results.turns + 1)[:-1])
    run = output_run(motion, link)[0]
    run = np.unwrap(run) if results.linkage.output_swings(link) else run
    for near in (run - np.min(run), np.max(run) - run):
        still = np.flatnonzero(np.r_[near, near] > STILL * np.ptp(run))  # twice: it may go over the seam
        if np.max(np.diff(still), initial=0) > DWELL:
            return True
    return False
