"""Published path problems of four-bar linkages, as problem files.

Points, timing, bounds and the linkages that others found are read from public copies of the sources named: HCDJ and
FOUR_BAR keep those of the papers, PHCPACK those of an exact task. HCDJ wants the crank to be the shortest link. Lengths
that may be zero there begin a little above; of paths whose bounds are not told there, bounds hold the linkage printed.
In the 25 points one (5.05, 6.84) may be a slip of the pen for 5.45, but stays as it is read.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

Bounds = tuple[float, float]
TURN: Final = (0.0, 360.0)


@dataclass(frozen=True)
class PathProblem:
    """lengths: bounds of crank, coupler, rocker and frame; offsets: of the coupler's point in its own axes; places: of
    the crank's pivot, where it is free; tilted: the frame may lie at any angle; at: of the crank from the frame (deg),
    from a free first angle where `phase`; apart: between fixed pivots, where the frame is given; shortest: the crank is
    the shortest link, no double crank is wanted. Distances are root mean squares (mm): printed of the best linkage that
    the source prints, worked out from its lengths, zero where it goes through all points, None where none that a crank
    drives is printed; least the least known of all runs of this search.
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
    apart: float = 0.0
    shortest: bool = False
    printed: float | None = None
    least: float = 0.0

    @property
    def variables(self) -> int:
        return 6 - bool(self.apart) + 2 * (self.places is not None) + self.tilted + self.phase

    def text(self) -> str:
        """The problem file."""
        vary = dict.fromkeys(("crank", "coupler", "rocker", "frame"), self.lengths)
        vary |= {"along": self.offsets, "aside": self.offsets}
        if self.apart:
            del vary["frame"]
        if self.places:
            vary |= {"x0": self.places, "y0": self.places}
        turns = {"tilt": self.tilted, "phase": self.phase}
        bounds = [f"{name}: [{low:g}, {high:g}]" for name, (low, high) in vary.items()]
        bounds += [f"{name}: [{TURN[0]:g} deg, {TURN[1]:g} deg]" for name, free in turns.items() if free]
        fixed = ["n1: 60 rpm", *(f"{name}: 0 mm" for name in ("x0", "y0") if not self.places)]
        fixed += [f"{name}: 0 deg" for name, free in turns.items() if not free]
        fixed += [f"frame: {self.apart:g}"] * bool(self.apart)
        crank = "min(crank, frame)" if self.shortest else "crank"
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
  1: {{points: {{O: [0, 0], A: ["{crank}*cos(tilt + phase)", "{crank}*sin(tilt + phase)"]}}}}
  2: {{points: {{A: [0, 0], B: [coupler, 0], K: [along, aside]}}}}
  3: {{points: [D, B], length: rocker}}
driver: {{link: 1, speed: n1, turns: ccw}}
sketch:
  at: 0  # B to the left of AD, as in the linkages printed
  B:
    - x0 + frame*cos(tilt) - frame*sin(tilt) + crank*sin(tilt + phase)
    - y0 + frame*sin(tilt) + frame*cos(tilt) - crank*cos(tilt + phase)
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
TWELVE = (
    (4.15, 2.21), (4.5, 2.18), (4.53, 1.83), (4.13, 1.68), (3.67, 1.58), (2.96, 1.33), (2.67, 1.06), (2.63, 0.82),
    (2.92, 0.81), (3.23, 1.07), (3.49, 1.45), (3.76, 1.87),
)  # fmt: skip
TWENTY_FIVE = (
    (7.03, 5.99), (6.95, 5.45), (6.77, 5.03), (6.4, 4.6), (5.91, 4.03), (5.43, 3.56), (4.93, 2.94), (4.67, 2.6),
    (4.38, 2.2), (4.04, 1.67), (3.76, 1.22), (3.76, 1.97), (3.76, 2.78), (3.76, 3.56), (3.76, 4.34), (3.76, 4.91),
    (3.76, 5.47), (3.8, 5.98), (4.07, 6.4), (4.53, 6.75), (5.07, 6.85), (5.05, 6.84), (5.89, 6.83), (6.41, 6.8),
    (6.92, 6.58),
)  # fmt: skip
HALF_MOON = (
    (-27, 1), (-21.857, -3.214), (-16.7, -7.428), (-11.571, -11.642), (-6.428, -15.857), (-1.285, -20.071),
    (3.857, -24.285), (9, -28.5), (15, -29.9), (20, -30), (27.2, -25), (29.2, -20), (28, -10), (22.7, 2), (15, 10.6),
    (5, 16.5), (-10, 19.6), (-22, 17), (-28, 11), (-29, 5),
)  # fmt: skip
BONE = (
    (-24, 40), (-30, 41), (-34, 40), (-38, 36), (-36, 30), (-28, 29), (-21, 31), (-17, 32), (-8, 34), (3, 37), (10, 41),
    (17, 41), (26, 39), (28, 33), (29, 26), (26, 23), (17, 23), (11, 24), (6, 27), (0, 31),
)  # fmt: skip
FIVE = ((0.5, 1.06), (-0.83, -0.27), (-0.34, 0.22), (-0.13, 0.43), (0.22, 0.78))
HCDJ = "github.com/sy-nguyen-van/DE_Jaya_Synthesis_Four_Bar_Mechanisms"
FOUR_BAR = "github.com/KmolYuan/four-bar-rs, test-fb"
PHCPACK = "github.com/janverschelde/PHCpack, src/Python/PHCpy3/doc/source/fourbar.rst"
CABRERA = f"J. A. Cabrera, A. Simon, M. Prado, Mechanism and Machine Theory 37 (2002) 1165-1177; {HCDJ}"
ACHARYYA = f"S. K. Acharyya, M. Mandal, Mechanism and Machine Theory 44 (2009) 1784-1794; {HCDJ}"
KUNJUR = f"A. Kunjur, S. Krishnamurty, Journal of Applied Mechanisms and Robotics 4 (1997) 18-24; {HCDJ}"
BULATOVIC = "R. R. Bulatovic, G. Miodragovic, M. S. Boskovic, Mechanism and Machine Theory 95 (2016) 1-21; " + FOUR_BAR
YU = f"H. Yu, D. Tang, Z. Wang, Mechanism and Machine Theory 42 (2007) 383-392; {FOUR_BAR}"
MORGAN = f"A. P. Morgan, C. W. Wampler, Journal of Mechanical Design 112 (1990) 544-550; {PHCPACK}"

PROBLEMS: Final = (
    PathProblem(
        "line of 6 points", CABRERA, LINE, (5, 60), (-60, 60), (-60, 60), tilted=True, shortest=True, printed=0.0
    ),
    PathProblem(
        "arc of 5 points, timed", CABRERA, ARC, (0.5, 50), (-50, 50), at=(30, 45, 60, 75, 90), shortest=True,
        printed=5.0675e-4, least=3.851169007e-4,
    ),
    PathProblem(
        "leaf of 18 points, timed", KUNJUR, LEAF, (0.05, 50), (-50, 50), (-50, 50), tilted=True,
        at=tuple(range(0, 360, 20)), phase=True, shortest=True, printed=0.029887, least=0.0223965335,
    ),
    PathProblem(
        "ellipse of 10 points", ACHARYYA, ELLIPSE, (5, 80), (-80, 80), (-80, 80), tilted=True, shortest=True,
        printed=6.4818e-3, least=6.340284334e-3,
    ),
    PathProblem(
        "semicircle of 6 points, timed", ACHARYYA, SEMICIRCLE, (5, 50), (-50, 50), (-50, 50), tilted=True,
        at=(30, 60, 90, 120, 150, 180), shortest=True, printed=0.65579, least=0.6557890445,
    ),
    PathProblem(
        "leaf of 18 points", BULATOVIC, LEAF, (0.05, 5), (-5, 5), (-5, 5), tilted=True, printed=0.016600,
        least=0.01292403602,
    ),
    PathProblem(
        "loop of 12 points", BULATOVIC, TWELVE, (0.1, 10), (-10, 10), (-10, 10), tilted=True, printed=3.5223e-3,
        least=2.518090445e-3,
    ),
    PathProblem(
        "loop of 25 points", BULATOVIC, TWENTY_FIVE, (0.1, 10), (-10, 10), (-10, 10), tilted=True, printed=0.039357,
        least=0.03870662168,
    ),
    PathProblem(
        "half moon of 20 points", YU, HALF_MOON, (1, 100), (-100, 100), (-100, 100), tilted=True, printed=0.41411,
        least=0.2066712115,
    ),
    PathProblem(
        "bone of 20 points", YU, BONE, (1, 100), (-100, 100), (-100, 100), tilted=True, printed=0.96500,
        least=0.6282824273,
    ),
    PathProblem("line of 5 points, fixed pivots", MORGAN, FIVE, (0.05, 5), (-5, 5), apart=1.0, least=0.0137561421),
)  # fmt: skip
