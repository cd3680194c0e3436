"""What belongs to the mechanism as a whole: mobility, class, stroke or swing, coefficient of the mean speed."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from tmm_cli.analysis.quantities.base import Quantity, Solved
from tmm_cli.linkage import Linkage
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER
from tmm_cli.structure.assur import Structure
from tmm_cli.structure.naming import output_link


def whole(linkage: Linkage, structure: Structure) -> dict[str, Quantity]:
    """W, class, numbers of links, pairs, passive constraints and strokes; H of an output (where it swings: the
    arc psi l of its first point), psi, k."""
    exact = {
        "W": structure.mobility + structure.redundant,
        "class": structure.mechanism_class,
        "n": len(structure.links),
        "p1": len(structure.pairs) - structure.higher,
        "p2": structure.higher,
        "passive": structure.redundant,
    }
    found = {
        name: Quantity(name, "structure", NUMBER, _constant(value), whole=True, against="exact")
        for name, value in exact.items()
    }
    output = output_link(linkage, structure.groups)
    slides = output is not None and linkage.slides_on_frame(output)
    name, dimension = ("H", LENGTH) if slides else ("psi", ANGLE)
    found[name] = Quantity(name, "places", dimension, _travel, whole=True)
    if output is not None and not slides and linkage.output_arm(output) is not None:
        found["H"] = Quantity("H", "places", LENGTH, partial(_arc, output), whole=True)
    found["strokes"] = Quantity("strokes", "places", NUMBER, _number, whole=True, against="exact")
    found["k"] = Quantity("k", "places", NUMBER, _k, whole=True)
    return found


def _constant(value: int) -> Any:
    return lambda solution: np.array([float(value)])


def _travel(solution: Solved) -> Any:
    strokes = solution.strokes
    if strokes is None or not strokes.strokes:
        return np.array([np.nan])
    return np.abs(strokes.strokes[0].run) + np.zeros(1)


def _arc(output: str, solution: Solved) -> Any:
    """H = psi l of an output that swings, m."""
    arm = solution.linkage.output_arm(output)
    return _travel(solution) * (np.nan if arm is None else arm[1])


def _k(solution: Solved) -> Any:
    strokes = solution.strokes
    if strokes is None or len(strokes.strokes) < 2:
        return np.array([np.nan])
    working, idle = (sum(s.length for s in strokes.strokes[first::2]) for first in (0, 1))  # they take turns
    return np.asarray(working / idle) + np.zeros(1)


def _number(solution: Solved) -> Any:
    strokes = solution.strokes
    return np.array([float("nan") if strokes is None else float(len(strokes.strokes))])
