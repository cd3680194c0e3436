"""Published path problems of four-bar linkages, as problem files.

Points, timing and bounds are after the sources named, not compared with their print; lengths that may be zero there
begin a little above. Errors printed there are not kept: what is least known is of this program's own runs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

Bounds = tuple[float, float]
TURN: Final = (0.0, 360.0)


@dataclass(frozen=True)
class PathProblem:
    """lengths: bounds of crank, coupler, rocker and frame; offsets: of the coupler's point in its own axes; places: of
    the crank's pivot, where it is free; tilted: the frame may lie at any angle; at: of the crank (deg), from a free
    first angle where `phase`. least: the least known root mean square distance (mm), of all runs of this search.
    """

    name: str
    source: str
    points: tuple[tuple[float, float], ...]
    lengths: Bounds
    offsets: Bounds
    places: Bounds | None = None
    tilted: bool = False
    at: tuple[float, ...] = ()
    phase: bool = False
    least: float = 0.0

    @property
    def variables(self) -> int:
        return 6 + 2 * (self.places is not None) + self.tilted + self.phase

    def text(self) -> str:
        """The problem file."""
        vary = dict.fromkeys(("crank", "coupler", "rocker", "frame"), self.lengths)
        vary |= {"along": self.offsets, "aside": self.offsets}
        if self.places:
            vary |= {"x0": self.places, "y0": self.places}
        turns = {"tilt": self.tilted, "phase": self.phase}
        bounds = [f"{name}: [{low:g}, {high:g}]" for name, (low, high) in vary.items()]
        bounds += [f"{name}: [{TURN[0]:g} deg, {TURN[1]:g} deg]" for name, free in turns.items() if free]
        fixed = ["n1: 60 rpm", *(f"{name}: 0 mm" for name in ("x0", "y0") if not self.places)]
        fixed += [f"{name}: 0 deg" for name, free in turns.items() if not free]
        at = f", at: [{', '.join(f'{angle:g}' for angle in self.at)}]" if self.at else ""
        through = ", ".join(f"[{x:g}, {y:g}]" for x, y in self.points)
        return f"""tmm: 1
title: {self.name}
units: {{length: mm, angle: deg}}
parameters: {{{", ".join(fixed)}}}
synthesis:
  task: optimal
  vary: {{{", ".join(bounds)}}}
  objective: {{of: path, point: K, through: [{through}]{at}}}
points: {{O: [x0, y0], D: [x0 + frame*cos(tilt), y0 + frame*sin(tilt)]}}
links:
  1: {{points: {{O: [0, 0], A: [crank*cos(phase), crank*sin(phase)]}}}}
  2: {{points: {{A: [0, 0], B: [coupler, 0], K: [along, aside]}}}}
  3: {{points: [D, B], length: rocker}}
driver: {{link: 1, speed: n1, turns: ccw}}
sketch: {{at: 0, B: [x0 + frame*cos(tilt) - rocker*sin(tilt), y0 + frame*sin(tilt) + rocker*cos(tilt)]}}
output: 3
positions: {{count: 12}}
"""


LINE = tuple((20.0, 20.0 + 5 * k) for k in range(6))
ARC = ((3, 3), (2.759, 3.363), (2.372, 3.663), (1.890, 3.862), (1.355, 3.943))
LEAF = (
    (0.5, 1.1), (0.4, 1.1), (0.3, 1.1), (0.2, 1.0), (0.1, 0.9), (0.05, 0.75), (0.02, 0.6), (0, 0.5), (0, 0.4),
    (0.03, 0.3), (0.1, 0.25), (0.15, 0.2), (0.2, 0.3), (0.3, 0.4), (0.4, 0.5), (0.5, 0.7), (0.6, 0.9), (0.6, 1.0),
)  # fmt: skip
ELLIPSE = (
    (20, 10), (17.66, 15.142), (11.736, 17.878), (5, 16.928), (0.60307, 12.736), (0.60307, 7.2638), (5, 3.0718),
    (11.736, 2.1215), (17.66, 4.8577), (20, 10),
)  # fmt: skip
SEMICIRCLE = ((0, 0), (1.9098, 5.8779), (6.9098, 9.5106), (13.09, 9.5106), (18.09, 5.8779), (20, 0))
CABRERA = "J. A. Cabrera, A. Simon, M. Prado, Mechanism and Machine Theory 37 (2002) 1165-1177"
ACHARYYA = "S. K. Acharyya, M. Mandal, Mechanism and Machine Theory 44 (2009) 1784-1794"
KUNJUR = "A. Kunjur, S. Krishnamurty, Journal of Applied Mechanisms and Robotics 4 (1997) 18-24"

PROBLEMS: Final = (
    PathProblem("line of 6 points", CABRERA, LINE, (5, 60), (-60, 60), (-60, 60), tilted=True),
    PathProblem(
        "arc of 5 points, timed", CABRERA, ARC, (0.5, 50), (-50, 50), at=(30, 45, 60, 75, 90), least=3.851265224e-4
    ),
    PathProblem(
        "leaf of 18 points, timed", KUNJUR, LEAF, (0.05, 50), (-50, 50), (-50, 50), tilted=True,
        at=tuple(range(0, 360, 20)), phase=True, least=0.0223965335,
    ),
    PathProblem(
        "ellipse of 10 points", ACHARYYA, ELLIPSE, (5, 80), (-80, 80), (-80, 80), tilted=True, least=6.386013110e-3
    ),
    PathProblem(
        "semicircle of 6 points, timed", ACHARYYA, SEMICIRCLE, (5, 50), (-50, 50), (-50, 50), tilted=True,
        at=(30, 60, 90, 120, 150, 180), least=0.3312714851,
    ),
)  # fmt: skip
