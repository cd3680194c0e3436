"""Structural error of a four-bar that generates a function: its curve and its largest size."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.roots import least
from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import Bars, outputs
from tmm_cli.synthesis.four_bar_by_angles.function import Function
from tmm_cli.synthesis.four_bar_by_angles.pairs import Task

ERRORS: Final = 721  # places of the curve
NEAR: Final = 0.9  # of the largest: peaks that are looked at closely


def _scan(function: Function) -> Any:
    """Input angles (rad) that are looked at: even, and where the table has rows."""
    even = np.linspace(min(function.phi), max(function.phi), ERRORS)
    return np.unique(np.concatenate((even, function.corners())))


def extremes(error: Callable[[Any], Any], function: Function) -> tuple[Any, float]:
    """Input angles (rad) of the largest peaks of an error, and its largest size, to the last digits.

    Where a table has a corner an extreme may be there; between the places of the scan the error has one extreme.
    """
    phi = _scan(function)
    size = np.abs(error(phi))
    inner = (size[1:-1] >= size[:-2]) & (size[1:-1] >= size[2:]) & (size[1:-1] > NEAR * np.max(size))
    peaks = [least(lambda x: -np.abs(error(x)), phi[k], phi[k + 2]) for k in np.flatnonzero(inner)]
    places = np.array([place for place, __ in peaks])
    return places, float(max(np.max(size), *(-value for __, value in peaks))) if peaks else float(np.max(size))


def side_of(one: Bars, task: Task) -> float:
    """The assembly of the pairs: the sign of (BC x DC)."""
    phi, psi = np.asarray(task.phi, dtype=float), np.asarray(task.psi, dtype=float)
    return min((1.0, -1.0), key=lambda side: float(np.sum((outputs(one, phi, psi, side) - psi) ** 2)))


def off(one: Bars, task: Task) -> Any:
    """Errors of the output angle (rad) at the pairs."""
    phi, psi = np.asarray(task.phi, dtype=float), np.asarray(task.psi, dtype=float)
    return outputs(one, phi, psi, side_of(one, task)) - psi


def reached(one: Bars, task: Task) -> Diagram:
    """Output angles over the input, and the pairs they are to be near."""
    side, (start, end) = side_of(one, task), task.span
    phi, at_pairs = np.linspace(float(start), float(end), ERRORS), np.asarray(task.phi, dtype=float)
    psi = np.asarray(task.psi, dtype=float)
    order = np.argsort(at_pairs)
    lines = (
        Line(N_("reached"), phi, outputs(one, phi, np.interp(phi, at_pairs[order], psi[order]), side)),
        Line(N_("wanted"), at_pairs, psi, dots=True),
    )
    return Diagram("pairs", N_("Output angles at the pairs"), (N_("input angle phi"), "angle"),
                   (N_("output angle psi"), "angle"), lines)  # fmt: skip


def errors(one: Bars, task: Task) -> tuple[Diagram, float]:
    """The curve of structural error over the input angle, with the points of the task, and its largest size."""
    assert task.function
    function = task.function
    side = side_of(one, task)

    def error(phi: Any) -> Any:
        wanted = function.wanted(phi)
        return outputs(one, phi, wanted, side) - wanted

    places, largest = extremes(error, function)
    phi = np.unique(np.concatenate((_scan(function), places)))
    at_points = np.asarray(task.phi, dtype=float)
    lines = (
        Line(N_("structural error of the output angle"), phi, error(phi)),
        Line(N_("precision points"), at_points, error(at_points) if task.approximate else 0 * at_points, dots=True),
    )
    axes = (N_("input angle phi"), "angle"), (N_("structural error of the output angle"), "angle")
    return Diagram("error", N_("Structural error over the range"), *axes, lines), largest
