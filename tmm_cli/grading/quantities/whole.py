"""What belongs to the mechanism as a whole: mobility, class, stroke or swing, coefficient of the mean speed."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_cli.grading.quantities.base import Quantity
from tmm_cli.grading.solution import Solution
from tmm_cli.linkage import Linkage
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER
from tmm_cli.structure.assur import Structure


def whole(linkage: Linkage, structure: Structure) -> dict[str, Quantity]:
    """W, class, number of links and pairs; H of an output that slides, psi of one that swings, k."""
    exact = {
        "W": structure.mobility + structure.redundant,
        "class": structure.mechanism_class,
        "n": len(structure.links),
        "p1": len(structure.pairs) - structure.higher,
        "p2": structure.higher,
    }
    found = {
        name: Quantity(name, "structure", NUMBER, _constant(value), whole=True, against="exact")
        for name, value in exact.items()
    }
    slides = linkage.output is not None and linkage.slides_on_frame(linkage.output.link)
    name, dimension = ("H", LENGTH) if slides else ("psi", ANGLE)
    found[name] = Quantity(name, "places", dimension, _travel, whole=True)
    found["k"] = Quantity("k", "places", NUMBER, _k, whole=True)
    return found


def _constant(value: int) -> Any:
    return lambda solution: np.full((len(solution.family), 1), float(value))


def _travel(solution: Solution) -> Any:
    strokes = solution.family.strokes
    if strokes is None or not strokes.strokes:
        return np.full((len(solution.family), 1), np.nan)
    return np.abs(strokes.strokes[0].run) + np.zeros((len(solution.family), 1))


def _k(solution: Solution) -> Any:
    strokes = solution.family.strokes
    if strokes is None or len(strokes.strokes) < 2:
        return np.full((len(solution.family), 1), np.nan)
    working, idle = (sum(s.length for s in strokes.strokes[first::2]) for first in (0, 1))  # they take turns
    return np.asarray(working / idle) + np.zeros((len(solution.family), 1))
