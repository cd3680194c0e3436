"""Drawings of a four-bar found from pairs of angles: construction, reached pairs, structural error of the function."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.mechanics.numerics import find_minima
from tmm_cli.synthesis.construction import (
    Arc,
    Diagram,
    DiagramLine,
    GeometricConstruction,
    LetteredPoint,
    Segment,
    swept_arc,
)
from tmm_cli.synthesis.four_bar_by_angles.angle_pairs import (
    AnglePairsTask,
)
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import FourBarRatios, output_angles
from tmm_cli.synthesis.four_bar_by_angles.generated_function import GeneratedFunction

ERRORS: Final = 721  # points of the curve
NEAR: Final = 0.9  # relative height of peaks that are refined


def _scan_angles(function: GeneratedFunction) -> Any:
    """Return evenly spaced input angles (rad) over the range, merged with the input angles of the rows of the
    function table.
    """
    even = np.linspace(min(function.phi), max(function.phi), ERRORS)
    return np.unique(np.concatenate((even, function.table_angles())))


def error_extremes(error: Callable[[Any], Any], function: GeneratedFunction) -> tuple[Any, float]:
    """Return the input angles (rad) at which an error has its largest peaks, and its largest magnitude (rad).

    Both are exact to rounding. A peak may lie at a corner of a function given by a table. Between two neighbouring
    sample angles the error has at most one extreme.

    Args:
        error: function that returns the error (rad) at input angles.
        function: function to be generated.
    """
    phi = _scan_angles(function)
    magnitudes = np.abs(error(phi))
    inner = (
        (magnitudes[1:-1] >= magnitudes[:-2])
        & (magnitudes[1:-1] >= magnitudes[2:])
        & (magnitudes[1:-1] > NEAR * np.max(magnitudes))
    )
    peaks = [find_minima(lambda x: -np.abs(error(x)), phi[k], phi[k + 2]) for k in np.flatnonzero(inner)]
    angles = np.array([angle for angle, __ in peaks])
    return angles, float(max(np.max(magnitudes), *(-value for __, value in peaks))) if peaks else float(
        np.max(magnitudes)
    )


def assembly_of(four_bar: FourBarRatios, task: AnglePairsTask) -> float:
    """Return the assembly of the four-bar in which it passes through the pairs of angles.

    It is given by the sign of the cross product BC x DC.
    """
    phi, psi = np.asarray(task.phi, dtype=float), np.asarray(task.psi, dtype=float)
    return min((1.0, -1.0), key=lambda side: float(np.sum((output_angles(four_bar, phi, psi, side) - psi) ** 2)))


def output_errors(four_bar: FourBarRatios, task: AnglePairsTask) -> Any:
    """Return the errors of the output angle at the required pairs of angles (rad), shape (pairs,)."""
    phi, psi = np.asarray(task.phi, dtype=float), np.asarray(task.psi, dtype=float)
    return output_angles(four_bar, phi, psi, assembly_of(four_bar, task)) - psi


def draw_reached(four_bar: FourBarRatios, task: AnglePairsTask) -> Diagram:
    """Plot the output angle of the four-bar against its input angle, with the required pairs of angles as points."""
    side, (start, end) = assembly_of(four_bar, task), task.span
    phi, at_pairs = np.linspace(float(start), float(end), ERRORS), np.asarray(task.phi, dtype=float)
    psi = np.asarray(task.psi, dtype=float)
    order = np.argsort(at_pairs)
    lines = (
        DiagramLine(
            N_("reached"), phi, output_angles(four_bar, phi, np.interp(phi, at_pairs[order], psi[order]), side)
        ),
        DiagramLine(N_("required value"), at_pairs, psi, dots=True),
    )
    return Diagram(
        "pairs",
        N_("Output angle against input angle, with the required pairs"),
        (N_("input angle phi"), "angle"),
        (N_("output angle psi"), "angle"),
        lines,
    )


def draw_structural_error(four_bar: FourBarRatios, task: AnglePairsTask) -> tuple[Diagram, float]:
    """Plot the structural error against the input angle, with the precision points.

    Returns:
        The diagram, and the largest magnitude of the error (rad).
    """
    assert task.function
    function = task.function
    side = assembly_of(four_bar, task)

    def error(phi: Any) -> Any:
        required = function.required_output(phi)
        return output_angles(four_bar, phi, required, side) - required

    peaks, largest = error_extremes(error, function)
    phi = np.unique(np.concatenate((_scan_angles(function), peaks)))
    at_points = np.asarray(task.phi, dtype=float)
    lines = (
        DiagramLine(N_("structural error of the output angle"), phi, error(phi)),
        DiagramLine(
            N_("precision points"), at_points, error(at_points) if task.approximate else 0 * at_points, dots=True
        ),
    )
    axes = (N_("input angle phi"), "angle"), (N_("structural error of the output angle"), "angle")
    return Diagram("error", N_("Structural error over the range"), *axes, lines), largest


# Construction of a four-bar by pairs of angles: all positions rotated back to the first input angle.


def draw_construction(
    solution: FourBarRatios, given_phi: Any, given_psi: Any, frame_length: float
) -> GeometricConstruction:
    """Draw the inversion by which the four-bar is constructed: all its positions, rotated about A to the first input
    angle.

    The points C1, C2', C3', ... then lie on a circle about B1.

    Args:
        solution: four-bar.
        given_phi, given_psi: pairs of angles (rad), measured from the zero angles.
        frame_length: length l4 (m).
    """
    phi, psi = np.asarray(given_phi, float), np.asarray(given_psi, float)
    b, c = (np.asarray(x, dtype=complex) * frame_length for x in solution.pins(phi, psi))
    back = c * np.exp(-1j * (phi - phi[0]))
    a, d = 0j, complex(frame_length)
    segments = [
        Segment(a, d, "axis", "l4"),
        Segment(a, complex(b[0]), "link", "l1"),
        Segment(complex(b[0]), complex(c[0]), "link", "l2"),
        Segment(d, complex(c[0]), "link", "l3"),
    ]
    spots = [
        LetteredPoint("A", a, "support"),
        LetteredPoint("D", d, "support"),
        LetteredPoint("B1", complex(b[0]), "hinge"),
        LetteredPoint("C1", complex(c[0]), "hinge"),
    ]
    arcs = [swept_arc(complex(b[0]), back, "dashed", beyond=0.3)]
    for name, row, centre in (("C", c, d), ("B", b, a)):
        arcs.append(swept_arc(centre, row))
        for k in range(1, len(row)):
            segments.append(Segment(centre, complex(row[k]), "thin"))
            spots.append(LetteredPoint(f"{name}{k + 1}", complex(row[k]), "dot"))
    previous = complex(c[0])
    for k in range(1, len(back)):
        point = complex(back[k])
        arc = sorted((float(np.angle(c[k])), float(np.angle(c[k]) - phi[k] + phi[0])))
        arcs.append(Arc(a, float(abs(c[k])), arc[0], arc[1], "dashed"))
        segments += [Segment(previous, point, "thin"), Segment((previous + point) / 2, complex(b[0]), "dashed")]
        spots.append(LetteredPoint(f"C{k + 1}′", point, "dot"))
        previous = point
    lengths = (
        ("l1", float(abs(b[0]))),
        ("l2", float(abs(c[0] - b[0]))),
        ("l3", float(abs(c[0] - d))),
        ("l4", frame_length),
    )
    values = tuple((name, value, "length") for name, value in lengths)
    title = N_(
        "Positions rotated back about {A} to the first input angle: {B}1 is the centre of the circle "
        "through {C}1, {C}2′, ..."
    )
    note = N_("dashed: perpendicular bisectors, and arcs {C}{C}′ about {A} for the reverse rotation of the input link")
    return GeometricConstruction(
        title, tuple(segments), tuple(arcs), tuple(spots), (note,), chain="four-bar", values=values
    )
