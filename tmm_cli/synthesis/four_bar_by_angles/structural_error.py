"""Structural error of a four-bar that generates a function: its curve and its largest size."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from tmm_cli.errors import _
from tmm_cli.roots import least
from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import Bars
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


def outputs(one: Bars, phi: Any, near: Any, side: float) -> Any:
    """Output angles (without psi0) at input angles phi; side: the sign of (BC x DC)."""
    l1, l2, l3 = (np.asarray(x, dtype=float) for x in (one.l1, one.l2, one.l3))
    b = l1 * np.exp(1j * (float(one.phi0) + phi))
    way = b - 1
    cosine = (l3 * l3 + np.abs(way) ** 2 - l2 * l2) / (2 * l3 * np.abs(way))
    psi = np.angle(way) + side * np.arccos(np.clip(cosine, -1, 1))
    gap = psi - float(one.psi0) - near
    return near + gap - 2 * np.pi * np.round(gap / (2 * np.pi))


def errors(one: Bars, task: Task) -> tuple[Diagram, float]:
    """The curve of structural error over the input angle, with the precision points, and its largest size."""
    assert task.function
    function = task.function
    first = np.array([task.phi[0]])
    side = min((1.0, -1.0), key=lambda s: float(abs(outputs(one, first, task.psi[0], s) - task.psi[0])[0]))

    def error(phi: Any) -> Any:
        wanted = function.wanted(phi)
        return outputs(one, phi, wanted, side) - wanted

    places, largest = extremes(error, function)
    phi = np.unique(
        np.concatenate((np.linspace(min(function.phi), max(function.phi), ERRORS), function.corners(), places))
    )
    lines = (
        Line(_("structural error of the output angle"), phi, error(phi)),
        Line(_("precision points"), np.asarray(task.phi), np.zeros(len(task.phi)), dots=True),
    )
    axes = (_("input angle phi"), "angle"), (_("structural error of the output angle"), "angle")
    return Diagram("error", _("Structural error over the range"), *axes, lines), largest
