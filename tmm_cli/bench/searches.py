"""Measurement of `tmm bench synthesis`: candidates evaluated per second, and searches from several seeds.

Published path problems of four-bar linkages are written as problem files. Points, timing, bounds and published
solutions are from public copies of the sources named: HCDJ and FOUR_BAR contain those of the papers, PHCPACK those of a
problem with an exact solution. HCDJ requires the crank to be the shortest link. Where the published bounds of a length
start at zero, they start slightly above zero here. Where no bounds are published, they are chosen to include the
published solution. One of the 25 points, (5.05, 6.84), may be a misprint of 5.45, but is kept as printed.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from importlib.resources import files
from itertools import cycle
from typing import Any, Final

import numpy as np

from tmm_cli.batch import TracedVariants
from tmm_cli.bench.measured import CLOCK, Measurement, target_slack, text_table, time_until_met
from tmm_cli.mechanics.numerics import Real
from tmm_cli.problem import read_text
from tmm_cli.reports import Table
from tmm_cli.synthesis import Candidates, find_best, read_task

Bounds = tuple[float, float]
TURN: Final = (0.0, 360.0)


@dataclass(frozen=True)
class PathProblem:
    """A published problem: find the four-bar whose coupler point passes through given points.

    Attributes:
        name, source: name in tables; publication, and public copy of its data.
        points: points of the path, mm.
        lengths: bounds of the lengths of crank, coupler, rocker and frame, mm.
        offsets: bounds of the coordinates of the coupler point in the axes of the coupler, mm.
        places: bounds of the coordinates of the crank pivot, mm; None if it is fixed.
        tilted: True if the frame may have any angle.
        at: crank angles (deg) at the points, measured from the frame; from an unknown first angle if `phase`.
        phase: True if the first crank angle is unknown.
        apart: distance of the fixed pivots, if it is prescribed; otherwise 0.
        shortest: True if the crank must be the shortest link, which excludes double-crank linkages.
        printed: root-mean-square distance (mm) of the best published linkage, computed from its lengths; zero if it
            passes through all points; None if no published linkage is driven by a crank.
        least: least distance (mm) found in all runs of this search.
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
        """Return the text of the problem file."""
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
  at: 0  # B to the left of AD, as in the published linkages
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


# Rate of evaluation of the optimal synthesis, and deviation of its search from the best known.


SEARCHED = "crank-rocker"  # whose search is measured
SEARCH_NAMES = (SEARCHED, "six-bar", "shaper", "press-class-iii")
GENERATIONS = (300, 1000, 4000, 16_000)  # sizes, in addition to that of the search
PER_SECOND = {SEARCHED: 100_000.0, "press-class-iii": 20_000.0}  # candidates, at the generation size of the search
NEAR = 1e-3  # relative to the best known
NEAR_PATH, SECONDS = 1e-2, 20.0  # relative to the least known distance; processor time, s
MET = 1e-6  # relative to a published distance, or mm
REDUCED_PATHS = ("arc of 5 points, timed", "semicircle of 6 points, timed")  # which take little time
SEEDS, REDUCED_SEEDS, OF_TEN = 10, 3, 9


@dataclass(frozen=True)
class SearchRate:
    """Speed of the evaluation of candidates in generations of one size.

    Attributes:
        problem: name of the problem.
        parameters, constraints, positions: numbers of varied parameters, of constraints, and of positions per
            candidate.
        operations: number of operations of the recorded computation; 0 if it is not recorded.
        generation: number of candidates in a generation.
        per_second: candidates evaluated per second, from the least time.
        target: least required number per second; None if there is none.
    """

    problem: str
    parameters: int
    constraints: int
    positions: int
    operations: int
    generation: int
    per_second: float
    target: float | None = None

    def describe_miss(self, slack: float) -> str:
        if self.target is None or self.per_second >= self.target / slack:
            return ""
        generation_text = f"{self.problem}, generations of {self.generation}"
        return f"{generation_text}: {self.per_second:.0f} candidates per second, target {self.target:.0f}"


@dataclass(frozen=True)
class SearchOutcome:
    """Result of a search from one seed.

    Attributes:
        objective: exact value of the objective.
        missed: relative violation of the constraints; 0 if all are met.
        off: difference from the best known objective, divided by it.
        evaluations: number of candidates evaluated.
        searching, polishing: processor times of the search and of the local refinement, s.
        history: at each improvement, the number of candidates evaluated so far and `off`.
    """

    seed: int
    objective: float
    missed: float
    off: float
    evaluations: int
    searching: float
    polishing: float
    history: tuple[tuple[int, float], ...] = field(default=(), repr=False)

    @property
    def near(self) -> bool:
        return self.missed == 0 and self.off <= NEAR


@dataclass(frozen=True)
class PathOutcome:
    """Result of a search for a published path problem from one seed.

    Attributes:
        problem, parameters: name of the problem, and number of parameters that vary.
        distance: root-mean-square distance of the path from the required points, mm.
        off: difference from the least known distance, divided by it, or if it is zero by the spread of the points.
        agree: True if searches from independent starting points agree.
        seconds: processor time.
        printed: distance of the best published linkage, mm.
    """

    problem: str
    parameters: int
    seed: int
    distance: float
    off: float
    agree: bool
    seconds: float
    printed: float | None = None

    @property
    def near(self) -> bool:
        return self.off <= NEAR_PATH


@dataclass(frozen=True)
class Searches(Measurement):
    """Results of `tmm bench synthesis`.

    Attributes:
        rates: speed of evaluation for each problem and generation size.
        found: searches of one problem from several seeds.
        known: best known solution of this problem, see `best_known`.
        paths: searches for the published path problems.
    """

    rates: tuple[SearchRate, ...]
    found: tuple[SearchOutcome, ...]
    known: dict[str, Any]
    paths: tuple[PathOutcome, ...] = ()

    @property
    def near(self) -> int:
        return sum(one.near for one in self.found)

    @property
    def wanted(self) -> int:
        """Number of seeds whose search must come close to the best known solution: 9 of 10; all but one if reduced."""
        return OF_TEN if len(self.found) == SEEDS else len(self.found) - 1

    @property
    def failures(self) -> tuple[str, ...]:
        """Messages on missed targets; in a reduced run, on those missed by more than a factor of two."""
        slow = tuple(filter(None, (rate.describe_miss(target_slack(self.reduced)) for rate in self.rates)))
        slow += tuple(
            filter(
                None, (self._describe_path_miss(name) for name in dict.fromkeys(path.problem for path in self.paths))
            )
        )
        if self.near >= self.wanted:
            return slow
        near = f"{self.near} of {len(self.found)} seeds within {100 * NEAR:g} %"
        return (*slow, f"{near} of the best known, target {self.wanted}")

    def _describe_path_miss(self, name: str) -> str:
        """Return a message if the searches for a path problem miss their target, otherwise "".

        The target is missed if more than one seed of ten ends far above the least known distance, if a search ends
        above the best published linkage, or if it takes too long.
        """
        outcomes = [path for path in self.paths if path.problem == name]
        near, longest = sum(path.near for path in outcomes), max(path.seconds for path in outcomes)
        if near < len(outcomes) - len(outcomes) // SEEDS:
            return f"{name}: {near} of {len(outcomes)} seeds within {100 * NEAR_PATH:g} % of the least known"
        above = sum(p.printed is not None and p.distance > p.printed * (1 + MET) + MET for p in outcomes)
        if above:
            return f"{name}: {above} of {len(outcomes)} seeds above the best published linkage"
        if longest > SECONDS * target_slack(self.reduced):
            return f"{name}: {longest:.0f} s of processor time, target {SECONDS:g}"
        return ""

    def to_dict(self) -> dict[str, Any]:
        """Return the contents of the JSON file."""
        found = [asdict(one) | {"near": one.near} for one in self.found]
        return super().to_dict() | {"found": found, "near": self.near, "wanted": self.wanted}

    @property
    def tables(self) -> tuple[Table, ...]:
        runs = self.known["runs"]
        title = (
            "Search from several seeds, {problem}; best known {objective:.9g} "
            "of {runs} runs of {evaluations} candidates"
        )
        rates = text_table(
            "rates", "Rate of evaluation, one thread: least time of several turns",
            ("problem", "parameters", "constraints", "positions", "operations", "generation",
             "candidates/s", "at least"),
            [(r.problem, str(r.parameters), str(r.constraints), str(r.positions), str(r.operations), str(r.generation),
              f"{r.per_second:.0f}", "" if r.target is None else f"{r.target:.0f}") for r in self.rates],
        )  # fmt: skip
        found = text_table(
            "found", title.format(problem=self.known["problem"], objective=self.known["objective"], runs=len(runs),
                                  evaluations=max(run["evaluations"] for run in runs)),
            ("seed", "objective (SI)", "above the best known, %", "candidates", "search, s",
             "polish, s"),
            [(str(f.seed), f"{f.objective:.9g}", f"{100 * f.off:.2g}", str(f.evaluations), f"{f.searching:.2f}",
              f"{f.polishing:.2f}") for f in self.found],
        )  # fmt: skip
        paths = text_table(
            "paths", "Published path problems of four-bar linkages, least squares",
            ("problem", "parameters", "seed", "distance, mm", "best printed, mm",
             "above the least known, %",
             "starts agree", "s"),
            [(p.problem, str(p.parameters), str(p.seed), f"{p.distance:.10g}",
              "" if p.printed is None else f"{p.printed:.5g}", f"{100 * p.off:.2g}",
              "yes" if p.agree else "no", f"{p.seconds:.1f}") for p in self.paths],
        )  # fmt: skip
        return rates, found, paths


@cache
def search_problem_text(name: str) -> str:
    """Return the text of a problem file that is stored as package data."""
    return (files("tmm_cli.bench") / "data" / "synthesis" / f"{name}.yaml").read_text(encoding="utf-8")


@cache
def load_best_known() -> dict[str, Any]:
    """Return the best known solution of SEARCHED and the runs that found it (tests/write_synthesis_best.py)."""
    source = (files("tmm_cli.bench") / "data" / "synthesis" / "best.json").read_text(encoding="utf-8")
    best: dict[str, Any] = json.loads(source)
    return best


def load_candidates(name: str) -> Candidates:
    """Read a problem file from the package data; return the evaluator of the candidates of its optimal synthesis."""
    return Candidates(read_task(read_text(search_problem_text(name), f"{name}.yaml")))


def measure_searches(*, reduced: bool = False, progress: Callable[[str], None] = lambda _: None) -> Searches:
    """Measure the speed of evaluation on each problem, then the searches from several seeds.

    Args:
        reduced: True for fewer seeds and problems.
        progress: Called with the name of each step.
    """
    rates: list[SearchRate] = []
    for name in SEARCH_NAMES:
        progress(name)
        rates += measure_rates(name, reduced)
    search = load_candidates(SEARCHED)
    reference = load_best_known()
    found = []
    for seed in range(1, 1 + (REDUCED_SEEDS if reduced else SEEDS)):
        progress(f"{SEARCHED}, seed {seed}")
        found.append(run_search(search, seed, reference["objective"]))
    return Searches(
        tuple(rates), tuple(found), reference, tuple(_run_path_searches(reduced, progress)), reduced=reduced
    )


def _run_path_searches(reduced: bool, progress: Callable[[str], None]) -> Iterator[PathOutcome]:
    """Yield the results for the published path problems and seeds; reduced: for two problems and one seed."""
    for problem in PROBLEMS:
        if reduced and problem.name not in REDUCED_PATHS:
            continue
        for seed in range(1, 2 if reduced else 1 + SEEDS):
            progress(f"{problem.name}, seed {seed}")
            yield run_path_search(problem, seed)


def run_path_search(problem: PathProblem, seed: int) -> PathOutcome:
    """Search for the linkage of a published path problem from one seed, with the default settings."""
    search = Candidates(read_task(read_text(problem.text(), f"{problem.name}.yaml")))
    search.task = replace(search.task, seed=seed)
    start = CLOCK()
    one = find_best(search)
    distance, spread = 1000 * one.values[0], 1000 * float(np.std(np.array(search.task.objective.wanted)))
    off = distance / problem.least - 1 if problem.least else distance / spread
    return PathOutcome(
        problem.name, problem.variables, seed, distance, off, one.agree, CLOCK() - start, problem.printed
    )


def measure_rates(name: str, reduced: bool) -> list[SearchRate]:
    """Measure the candidates evaluated per second for several generation sizes; candidates are random."""
    search = load_candidates(name)
    chance = np.random.default_rng(1)
    sizes = (search.population, *GENERATIONS[: 2 if reduced else None])
    return [_time_generations(name, search, chance.random((2, size, len(search.low))), reduced) for size in sizes]


def _time_generations(name: str, search: Candidates, generations: Real, reduced: bool) -> SearchRate:
    """Measure how many candidates are evaluated per second in two generations, (2, candidates, parameters).

    They are evaluated alternately, because results of a generation evaluated twice in succession are reused.
    """
    _, size, parameters = generations.shape
    target = PER_SECOND.get(name) if size == search.population else None
    turn = cycle(generations)
    operations = search.coarse.program.operations if isinstance(search.coarse, TracedVariants) else 0
    constraints = len(search.constraints) - 1  # without the one that the crank makes full turns

    def found(least: dict[str, float]) -> SearchRate:
        positions, per_second = search.task.positions, size / least[""]
        return SearchRate(name, parameters, constraints, positions, operations, size, per_second, target)

    return time_until_met({"": lambda: search.evaluate(next(turn))}, found, reduced)


def run_search(search: Candidates, seed: int, best_objective: float) -> SearchOutcome:
    """Run the search and the local refinement from one seed, with the default settings of the task."""
    times = [CLOCK()]

    def watch(at: int, of: int) -> None:
        if at == of:
            times.append(CLOCK())

    search.task = replace(search.task, seed=seed, progress=watch)
    one = find_best(search)
    times.append(CLOCK())
    size = search.population
    f = np.where(one.evolved.history[:, 1] == 0, one.evolved.history[:, 0], np.nan)
    so_far = np.fmin.accumulate(f)
    steps = [k for k, v in enumerate(so_far) if not np.isnan(v) and (k in (0, len(f) - 1) or v != so_far[k - 1])]
    history = [(size * (k + 1), float(so_far[k] / best_objective - 1)) for k in steps]
    return SearchOutcome(
        seed, one.values[0], one.missed, one.values[0] / best_objective - 1, size * len(f), times[1] - times[0],
        times[2] - times[1], tuple(history),
    )  # fmt: skip
