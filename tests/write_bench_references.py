"""Writes the 50-digit references of `tmm bench accuracy`: python tests/write_bench_references.py [NAME...].

They come from the textbook multibody way in 120 digits (multibody.py), which knows no groups, with the numbers of the
linkage as float64 has them: so a method's error is its own, not that of its data.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import mpmath as mp
import numpy as np
from multibody import Multibody

from tmm_cli import solve
from tmm_cli.bench import Case
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.problem import build_problem, read_text

NAMES = ("crank-slider", "crank-rocker", "shaper", "six-bar", "press-class-iii")
BANK = Path(__file__).parent.parent / "problems"
DATA = Path(__file__).parent.parent / "tmm_cli" / "bench" / "data"
DIGITS, COUNT = 50, 24
OFF = 0.3717  # of a step: no position is a special one


class Exact(Multibody):
    """The same in 120 digits: its second differences leave 60 of them, and 50 are written."""

    rounds, digits, step, bend = 4, 120, mp.mpf(10) ** -40, mp.mpf(10) ** -32


def text(value):
    """One number, or two of a vector."""
    return (
        [mp.nstr(part, DIGITS) for part in (value.real, value.imag)]
        if isinstance(value, mp.mpc)
        else mp.nstr(value, DIGITS)
    )


def solved(name, q=None):
    """The results of a problem of the bank at places q of its driver, else over a cycle, and the problem's text."""
    source = (BANK / f"{name}.yaml").read_text(encoding="utf-8")
    results = solve(build_problem(read_text(source, f"{name}.yaml")), "kinematics")
    if q is None:
        q = results.start + results.linkage.driver.sense * 2 * np.pi * (np.arange(COUNT) + OFF) / COUNT
    return results, motion_at_positions(results, q), source


def answers(results, motion, k):
    """Everything that a method may be asked for, at one position: names and numbers of 60 true digits."""
    linkage, structure = results.linkage, results.structure
    body = Exact(linkage, structure, motion, results.strokes)
    X, V, A, multipliers = body.at(k)
    case = Case("", linkage, structure, results.kernels)
    found = {"positions": {}, "velocities": {}, "accelerations": {}, "reactions": {}}
    for point in case.linkage.moving_points:
        link = linkage.owner(point)
        i, arm = body.at_row[link], linkage.local(link, point) * body.pose(X, link)[1]
        found["positions"][point] = mp.mpc(X[i], X[i + 1]) + arm
        found["velocities"][point] = mp.mpc(V[i], V[i + 1]) + 1j * V[i + 2] * arm
        found["accelerations"][point] = mp.mpc(A[i], A[i + 1]) + (1j * A[i + 2] - V[i + 2] ** 2) * arm
    for pair in structure.pairs:
        row = body.row_of(pair)
        if pair.kind == "R":  # a multiplier is what acts on the first link
            force = -mp.mpc(multipliers[row], multipliers[row + 1])
        else:
            across = 1j * body.pose(X, pair.i)[1] * mp.expj(pair.slide.direction)
            force = multipliers[row + 1] * across
        found["reactions"][pair.name] = force
    found["balancing"] = multipliers[body.size - 1]
    return found


def write(name):
    results, motion, source = solved(name)
    rows = [answers(results, motion, k) for k in range(COUNT)]
    content = {"problem": source, "start": results.start, "q": [float(q) for q in motion.q]}
    for quantity in ("positions", "velocities", "accelerations", "reactions"):
        content[quantity] = {key: [text(row[quantity][key]) for row in rows] for key in rows[0][quantity]}
    content["balancing"] = [text(row["balancing"]) for row in rows]
    (DATA / f"{name}.json").write_text(json.dumps(content, ensure_ascii=False, indent=0) + "\n", encoding="utf-8")


if __name__ == "__main__":
    for chosen in sys.argv[1:] or NAMES:
        write(chosen)
        print(chosen)
