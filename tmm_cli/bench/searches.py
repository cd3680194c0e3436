"""`tmm bench synthesis`: candidates a second of the optimal synthesis, how near its search comes to the best known."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from importlib.resources import files
from itertools import cycle
from typing import Any

import numpy as np

from tmm_cli.bench.measured import CLOCK, Measured, slack, timed, words
from tmm_cli.bench.paths import PROBLEMS, PathProblem
from tmm_cli.problem.reader import read_text
from tmm_cli.results.table import Table
from tmm_cli.synthesis.optimal.candidates import Candidates
from tmm_cli.synthesis.optimal.solver import best
from tmm_cli.synthesis.reading import task_of
from tmm_cli.variants.taped import Taped
from tmm_cli.vectors import Real

SEARCHED = "crank-rocker"  # whose search is measured
NAMES = (SEARCHED, "six-bar", "shaper", "press-class-iii")
GENERATIONS = (300, 1000, 4000, 16_000)  # sizes, beside that of the search itself
PER_SECOND = {SEARCHED: 100_000.0, "press-class-iii": 20_000.0}  # candidates, at the size that the search uses
NEAR = 1e-3  # of the best known
NEAR_PATH, SECONDS = 1e-2, 20.0  # of the least known path; the processor's time for it
MET = 1e-6  # of a distance printed, or mm: it is met
REDUCED_PATHS = ("arc of 5 points, timed", "semicircle of 6 points, timed")  # which take little
SEEDS, REDUCED_SEEDS, OF_TEN = 10, 3, 9


@dataclass(frozen=True)
class SearchRate:
    """Candidates a second in generations of a size, in the least time of several turns."""

    problem: str
    parameters: int
    constraints: int
    positions: int
    operations: int
    generation: int
    per_second: float
    target: float | None = None

    def missed(self, slack: float) -> str:
        if self.target is None or self.per_second >= self.target / slack:
            return ""
        size = f"{self.problem}, generations of {self.generation}"
        return f"{size}: {self.per_second:.0f} candidates a second, target {self.target:.0f}"


@dataclass(frozen=True)
class Found:
    """What a seed led to: its objective exactly, by how much constraints are missed (shares), processor's time (s).

    off: above the best known, as a share of it. history: candidates so far, and how far the best of them is off,
    where it got better.
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
class PathFound:
    """What a seed led to on a published path problem: root mean square distance (mm), how far it is above the least
    known (a share; where that is zero, of the points' spread), whether independent starts agree, processor's time (s),
    the distance of the best linkage printed.
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
class Searches(Measured):
    """The whole measurement. known: what the long runs found (`known`)."""

    rates: tuple[SearchRate, ...]
    found: tuple[Found, ...]
    known: dict[str, Any]
    paths: tuple[PathFound, ...] = ()

    @property
    def near(self) -> int:
        return sum(one.near for one in self.found)

    @property
    def wanted(self) -> int:
        """How many seeds must come near: 9 of 10; of a reduced run all but one."""
        return OF_TEN if len(self.found) == SEEDS else len(self.found) - 1

    @property
    def failures(self) -> tuple[str, ...]:
        """Targets that are missed; of a reduced run, by more than twice."""
        slow = tuple(filter(None, (rate.missed(slack(self.reduced)) for rate in self.rates)))
        slow += tuple(filter(None, (self._far(name) for name in dict.fromkeys(path.problem for path in self.paths))))
        if self.near >= self.wanted:
            return slow
        near = f"{self.near} of {len(self.found)} seeds within {100 * NEAR:g} %"
        return (*slow, f"{near} of the best known, target {self.wanted}")

    def _far(self, name: str) -> str:
        """Where more than one seed of ten ends far above the least known path, or takes long."""
        own = [path for path in self.paths if path.problem == name]
        near, longest = sum(path.near for path in own), max(path.seconds for path in own)
        if near < len(own) - len(own) // SEEDS:
            return f"{name}: {near} of {len(own)} seeds within {100 * NEAR_PATH:g} % of the least known"
        above = sum(p.printed is not None and p.distance > p.printed * (1 + MET) + MET for p in own)
        if above:
            return f"{name}: {above} of {len(own)} seeds above the best linkage printed"
        if longest > SECONDS * slack(self.reduced):
            return f"{name}: {longest:.0f} s of the processor, target {SECONDS:g}"
        return ""

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        found = [asdict(one) | {"near": one.near} for one in self.found]
        return super().to_dict() | {"found": found, "near": self.near, "wanted": self.wanted}

    @property
    def tables(self) -> tuple[Table, ...]:
        runs = self.known["runs"]
        title = (
            "Search from several seeds, {problem}; best known {objective:.9g} "
            "of {runs} runs of {evaluations} candidates"
        )
        rates = words(
            "rates", "Candidates a second at the evaluation, one thread: least time of several turns",
            ("problem", "parameters", "constraints", "positions", "operations", "generation",
             "candidates/s", "at least"),
            [(r.problem, str(r.parameters), str(r.constraints), str(r.positions), str(r.operations), str(r.generation),
              f"{r.per_second:.0f}", "" if r.target is None else f"{r.target:.0f}") for r in self.rates],
        )  # fmt: skip
        found = words(
            "found", title.format(problem=self.known["problem"], objective=self.known["objective"], runs=len(runs),
                                  evaluations=max(run["evaluations"] for run in runs)),
            ("seed", "objective (SI)", "above the best known, %", "candidates", "search, s",
             "polish, s"),
            [(str(f.seed), f"{f.objective:.9g}", f"{100 * f.off:.2g}", str(f.evaluations), f"{f.searching:.2f}",
              f"{f.polishing:.2f}") for f in self.found],
        )  # fmt: skip
        paths = words(
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
def text(name: str) -> str:
    """A problem file that ships with the package."""
    return (files("tmm_cli.bench") / "data" / "synthesis" / f"{name}.yaml").read_text(encoding="utf-8")


@cache
def known() -> dict[str, Any]:
    """The best known of SEARCHED and the long runs that found it (tests/write_synthesis_best.py writes them)."""
    source = (files("tmm_cli.bench") / "data" / "synthesis" / "best.json").read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(source)
    return found


def prepared(name: str) -> Candidates:
    """The task of a problem by its name, ready for evaluation."""
    return Candidates(task_of(read_text(text(name), f"{name}.yaml")))


def measure(*, reduced: bool = False, progress: Callable[[str], None] = lambda _: None) -> Searches:
    """Speed of evaluation on every problem, then the search from several seeds on one."""
    rates: list[SearchRate] = []
    for name in NAMES:
        progress(name)
        rates += rate(name, reduced)
    search = prepared(SEARCHED)
    reference = known()
    found = []
    for seed in range(1, 1 + (REDUCED_SEEDS if reduced else SEEDS)):
        progress(f"{SEARCHED}, seed {seed}")
        found.append(searched(search, seed, reference["objective"]))
    return Searches(tuple(rates), tuple(found), reference, tuple(_paths(reduced, progress)), reduced=reduced)


def _paths(reduced: bool, progress: Callable[[str], None]) -> Iterator[PathFound]:
    """Published path problems, from several seeds; of a reduced run some of them from one."""
    for problem in PROBLEMS:
        if reduced and problem.name not in REDUCED_PATHS:
            continue
        for seed in range(1, 2 if reduced else 1 + SEEDS):
            progress(f"{problem.name}, seed {seed}")
            yield path_found(problem, seed)


def path_found(problem: PathProblem, seed: int) -> PathFound:
    """What the ordinary search leads to."""
    search = Candidates(task_of(read_text(problem.text(), f"{problem.name}.yaml")))
    search.task = replace(search.task, seed=seed)
    start = CLOCK()
    one = best(search)
    distance, spread = 1000 * one.values[0], 1000 * float(np.std(np.array(search.task.objective.wanted)))
    off = distance / problem.least - 1 if problem.least else distance / spread
    return PathFound(problem.name, problem.variables, seed, distance, off, one.agree, CLOCK() - start, problem.printed)


def rate(name: str, reduced: bool) -> list[SearchRate]:
    """Candidates a second, evenly spread over the bounds, by the size of generations."""
    search = prepared(name)
    chance = np.random.default_rng(1)
    sizes = (search.population, *GENERATIONS[: 2 if reduced else None])
    return [_rated(name, search, chance.random((2, size, len(search.low))), reduced) for size in sizes]


def _rated(name: str, search: Candidates, generations: Real, reduced: bool) -> SearchRate:
    """generations (2, size, parameters) by turns: the way of candidates that come again is known already."""
    _, size, parameters = generations.shape
    target = PER_SECOND.get(name) if size == search.population else None
    turn = cycle(generations)
    operations = search.coarse.program.operations if isinstance(search.coarse, Taped) else 0
    constraints = len(search.constraints) - 1  # without that the crank turns fully

    def found(least: dict[str, float]) -> SearchRate:
        positions, per_second = search.task.positions, size / least[""]
        return SearchRate(name, parameters, constraints, positions, operations, size, per_second, target)

    return timed({"": lambda: search.evaluate(next(turn))}, found, reduced)


def searched(search: Candidates, seed: int, known: float) -> Found:
    """Search and polish from a seed, at the ordinary settings of the task."""
    times = [CLOCK()]

    def watch(at: int, of: int) -> None:
        if at == of:
            times.append(CLOCK())

    search.task = replace(search.task, seed=seed, progress=watch)
    one = best(search)
    times.append(CLOCK())
    size = search.population
    f = np.where(one.evolved.history[:, 1] == 0, one.evolved.history[:, 0], np.nan)
    so_far = np.fmin.accumulate(f)
    steps = [k for k, v in enumerate(so_far) if not np.isnan(v) and (k in (0, len(f) - 1) or v != so_far[k - 1])]
    history = [(size * (k + 1), float(so_far[k] / known - 1)) for k in steps]
    return Found(
        seed, one.values[0], one.missed, one.values[0] / known - 1, size * len(f), times[1] - times[0],
        times[2] - times[1], tuple(history),
    )  # fmt: skip
