"""Measurement of `tmm bench speed`: tmm against code written by hand and other programs, sweeps, growth of time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np

from tmm_cli.batch import Batch, Task, prepare_batch
from tmm_cli.bench.by_hand import MECHANISMS, HandCodedMechanism
from tmm_cli.bench.linkage_families import dyad_chain
from tmm_cli.bench.measured import Measurement, TimedResult, target_slack, text_table, time_until_met
from tmm_cli.bench.methods import product as taped
from tmm_cli.bench.methods.case import Case, Method, UnsupportedLinkageError
from tmm_cli.bench.references import load_problem_tree, load_reference
from tmm_cli.bench.rivals import list_installed
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real
from tmm_cli.reports import Table
from tmm_cli.sweep import SweptMechanisms, grid_points, read_axes

POSITIONS = (12, 360, 36_000)
VARIANTS = (100, 10_000)
OF_VARIANTS = 12  # positions of each variant
OF_LINKS = 72  # positions of each chain: with 360 the longest chain would fill the cache
TARGETS = {
    (1, 360): 1.3,
    (1, 36_000): 1.0,
    (10_000, 12): 1.3,
}  # largest ratio of tmm to code by hand, by (variants, positions)
RIVALS = {"pylinkage": 3.0, "kinepy": 30.0}  # least ratio of the program to tmm
EXPONENT = 0.05  # allowed difference of the exponent from 1

DYADS = (1, 2, 3, 5, 8, 12, 18, 24, 30)
GROWING = {  # what increases, and its numbers
    "links": ("moving links", DYADS),
    "positions": ("positions", (360, 1000, 3000, 9000, 18_000, 36_000, 72_000)),
    "variants": ("variants", (30, 100, 300, 1000, 3000, 10_000)),
}


@dataclass(frozen=True)
class Race:
    """Times of tmm and of code written by hand for the same mechanism.

    Attributes:
        mechanism: name of the mechanism.
        variants, positions: number of variants, and number of positions of each variant.
        ours, by_hand: time per position of tmm and of the code written by hand, ns; the least of all timings.
        preparing: time of the preparation of tmm for the variants, which is done once, ms.
    """

    mechanism: str
    variants: int
    positions: int
    ours: float
    by_hand: float
    preparing: float

    @property
    def ratio(self) -> float:
        return self.ours / self.by_hand

    @property
    def target(self) -> float | None:
        """Largest permitted ratio of the times; None if there is no target."""
        return TARGETS.get((self.variants, self.positions))

    def describe_miss(self, slack: float) -> str:
        if self.target is None or self.ratio <= slack * self.target:
            return ""
        kind = f"{self.mechanism}, {self.variants} x {self.positions}"
        return f"{kind}: {self.ratio:.2f} times the code by hand, target {self.target:g}"


@dataclass(frozen=True)
class Growth:
    """Times for increasing numbers of links, positions or variants, which grow as t0 + c n^exponent.

    Attributes:
        what: what increases: links, positions or variants.
        numbers, seconds: the numbers n, and the time for each, s.
        exponent: exponent of the best fit.
    """

    what: str
    numbers: tuple[int, ...]
    seconds: tuple[float, ...]
    exponent: float

    def describe_miss(self, slack: float) -> str:
        if abs(self.exponent - 1) <= slack * EXPONENT:
            return ""
        return f"growth with {self.what}: exponent {self.exponent:.3f}, target 1 +- {EXPONENT:g}"


@dataclass(frozen=True)
class RivalRace:
    """Times per position (ns) in which another program (`theirs`) and tmm (`ours`) compute the same quantities."""

    name: str
    mechanism: str
    theirs: float
    ours: float

    @property
    def ratio(self) -> float:
        return self.theirs / self.ours

    @property
    def target(self) -> float:
        """Least required ratio of the time of the other program to that of tmm."""
        return RIVALS[self.name]

    def describe_miss(self, slack: float) -> str:
        if self.ratio >= self.target / slack:
            return ""
        return f"{self.name}, {self.mechanism}: {self.ratio:.1f} times as long, target {self.target:g}"


@dataclass(frozen=True)
class SpeedMeasurement(Measurement):
    """Results of `tmm bench speed`.

    Attributes:
        races, rivals: times of tmm against those of code written by hand, and of other programs.
        growths: growth of time with the numbers of links, positions and variants.
        iterated: times of linkages with groups of class III against that of a six-bar with dyads.
        sweeps: speeds of sweeps.
    """

    races: tuple[Race, ...]
    growths: tuple[Growth, ...]
    rivals: tuple[RivalRace, ...]
    iterated: tuple[IteratedRace, ...] = ()
    sweeps: tuple[SweepRate, ...] = ()

    @property
    def failures(self) -> tuple[str, ...]:
        """Messages on missed targets; in a reduced run, on those missed by more than a factor of two."""
        found: tuple[TimedResult, ...] = (*self.races, *self.iterated, *self.sweeps, *self.growths, *self.rivals)
        return tuple(filter(None, (one.describe_miss(target_slack(self.reduced)) for one in found)))

    def to_dict(self) -> dict[str, Any]:
        """Return the contents of the JSON file."""
        return super().to_dict() | {
            "races": [asdict(r) | {"ratio": r.ratio, "target": r.target} for r in self.races],
            "iterated": [r.to_dict() for r in self.iterated],
            "sweeps": [r.to_dict() for r in self.sweeps],
            "rivals": [asdict(r) | {"ratio": r.ratio, "target": r.target} for r in self.rivals],
        }

    @property
    def tables(self) -> tuple[Table, ...]:
        races = text_table(
            "races",
            "Time per position with all reactions, ns: tmm against NumPy code written by hand for the mechanism",
            ("mechanism", "variants", "positions", "tmm", "by hand", "ratio", "at most", "preparing once, ms"),
            [
                (
                    r.mechanism,
                    str(r.variants),
                    str(r.positions),
                    f"{r.ours:.0f}",
                    f"{r.by_hand:.0f}",
                    f"{r.ratio:.2f}",
                    "" if r.target is None else f"{r.target:g}",
                    f"{r.preparing:.0f}",
                )
                for r in self.races
            ],
        )
        growths = text_table(
            "growths",
            "Growth of time, t0 + c n^exponent",
            ("with", "n", "ms", "exponent"),
            [
                (
                    GROWING[g.what][0],
                    f"{g.numbers[0]} ... {g.numbers[-1]}",
                    f"{1e3 * g.seconds[0]:.2f} ... {1e3 * g.seconds[-1]:.2f}",
                    f"{g.exponent:.3f}",
                )
                for g in self.growths
            ],
        )
        rivals = text_table(
            "rivals",
            "Other programs: time per position, ns, for 360 positions",
            ("program", "mechanism", "its time", "tmm", "times as long", "at least"),
            [
                (r.name, r.mechanism, f"{r.theirs:.0f}", f"{r.ours:.0f}", f"{r.ratio:.1f}", f"{r.target:g}")
                for r in self.rivals
            ],
        )
        tables = (races, iterated_table(self.iterated), sweep_table(self.sweeps), growths)
        return (*tables, rivals) if self.rivals else tables


def measure_speed(*, reduced: bool = False, progress: Callable[[str], None] = lambda __: None) -> SpeedMeasurement:
    """Measure all times and speeds in one process. Functions that are compared are timed alternately.

    Args:
        reduced: True for fewer and shorter runs.
        progress: Called with the name of each step.
    """
    races: list[Race] = []
    for mechanism in MECHANISMS:
        progress(mechanism.name)
        races += race_mechanism(mechanism, reduced)
    iterated: list[IteratedRace] = []
    for name in ITERATED:
        progress(name)
        iterated += race_iterated(name, reduced)
    sweeps = []
    for name in SWEPT:
        progress(f"sweep of {name}")
        sweeps.append(time_sweep(name, reduced))
    growths = []
    for what in GROWING:
        progress(what)
        growths.append(measure_growth(what, reduced))
    rivals, absent = race_rivals(reduced, progress)
    return SpeedMeasurement(
        tuple(races), tuple(growths), rivals, tuple(iterated), tuple(sweeps), reduced=reduced, absent=absent
    )


def race_mechanism(mechanism: HandCodedMechanism, reduced: bool) -> list[Race]:
    """Time a mechanism with one variant and with many, alternately by tmm and by code written by hand."""
    kinds = [(1, n) for n in POSITIONS] + [(v, OF_VARIANTS) for v in VARIANTS if not (reduced and v == 100)]
    return [_time_race(mechanism, variants, positions, reduced) for variants, positions in kinds]


def _time_race(mechanism: HandCodedMechanism, variants: int, positions: int, reduced: bool) -> Race:
    linkages = mechanism.make_variants(variants)
    start = perf_counter()
    ours = mechanism.prepare_ours(linkages)
    q = linkages[0].sketch.at + 2 * np.pi * np.arange(positions) / positions
    ours(q)
    preparing = 1e3 * (perf_counter() - start)
    by_hand = mechanism.prepare_by_hand(linkages)
    share = 1e9 / (variants * positions)

    def found(least: dict[str, float]) -> Race:
        return Race(mechanism.name, variants, positions, least["ours"] * share, least["hand"] * share, preparing)

    return time_until_met({"ours": lambda: ours(q), "hand": lambda: by_hand(q)}, found, reduced)


def measure_growth(quantity: str, reduced: bool) -> Growth:
    """Time linkages of increasing size, or a six-bar with increasing numbers of positions or variants.

    Only the balancing moment is requested. For it all groups must be solved, for motion and then for forces, but the
    results take little memory. Otherwise the memory would soon limit the speed.
    """
    numbers = GROWING[quantity][1][:-1] if reduced else GROWING[quantity][1]
    six_bar = next(m for m in MECHANISMS if m.name == "six-bar")
    runs: dict[str, Callable[[], Any]] = {}
    for number in numbers:
        if quantity == "links":
            runs[str(number)] = _make_call(prepare_batch(dyad_chain(number), _balancing_moment), OF_LINKS)
        elif quantity == "positions":
            runs[str(number)] = _make_call(prepare_batch(six_bar.load_linkage(), _balancing_moment), number)
        else:
            runs[str(number)] = _make_call(prepare_batch(six_bar.make_variants(number), _balancing_moment), OF_VARIANTS)
    size = tuple(2 * n + 1 if quantity == "links" else n for n in numbers)

    def found(least: dict[str, float]) -> Growth:
        return Growth(quantity, size, tuple(least.values()), fit_exponent(size, tuple(least.values())))

    return time_until_met(runs, found, reduced)


def _balancing_moment(__: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
    assert reactions is not None
    return {"T": reactions.balance.generalized}


def _make_call(batch: Batch, positions: int) -> Callable[[], Any]:
    q: Real = 1.0 + 2 * np.pi * np.arange(positions) / positions
    return lambda: batch(q)


def fit_exponent(numbers: Sequence[int], seconds: Sequence[float]) -> float:
    """Fit t0 + c n^p with t0 >= 0 to times by least squares of relative deviations; return p."""
    n, t = np.asarray(numbers, float), np.asarray(seconds, float)
    best, fits = np.inf, 1.0
    for p in np.arange(0.5, 1.5005, 0.001):
        columns = np.stack([np.ones_like(n), n**p], -1) / t[:, None]
        both = np.linalg.lstsq(columns, np.ones_like(t), rcond=None)[0]
        if both[0] < 0:
            both = np.array([0.0, np.linalg.lstsq(columns[:, 1:], np.ones_like(t), rcond=None)[0][0]])
        off = float(np.sum((columns @ both - 1) ** 2))
        if off < best:
            best, fits = off, float(p)
    return fits


def race_rivals(reduced: bool, progress: Callable[[str], None]) -> tuple[tuple[RivalRace, ...], tuple[str, ...]]:
    """Time the installed other programs and tmm on the mechanisms that they can compute, at 360 positions.

    The second tuple contains messages on programs and mechanisms that could not be timed.
    """
    methods, missing = list_installed()
    absent = [f"{name}: not installed" for name in missing]
    races = []
    for method in methods:
        for mechanism in MECHANISMS:
            progress(f"{method.name}, {mechanism.name}")
            case = load_reference(mechanism.name).case
            try:
                solver = (method.alone or method.prepare)(case)
            except UnsupportedLinkageError as error:
                absent.append(f"{method.name}: {mechanism.name}: {error}")
                continue
            races.append(_race_rival(method, mechanism.name, case, solver, reduced))
    return tuple(races), tuple(absent)


def _race_rival(
    method: Method, mechanism: str, case: Case, solver: Callable[[Real], object], reduced: bool
) -> RivalRace:
    q = case.start + 2 * np.pi * (np.arange(360) + 0.37) / 360
    ours = taped.make_batch(case, forces=method.solve(case, q).reactions is not None)

    def found(least: dict[str, float]) -> RivalRace:
        return RivalRace(method.name, mechanism, least["theirs"] * 1e9 / 360, least["ours"] * 1e9 / 360)

    return time_until_met({"theirs": lambda: solver(q), "ours": lambda: ours(q)}, found, reduced)


ITERATED = ("press-class-iii",)
ITERATED_POSITIONS = (360, 36_000)
OF_SIX_BAR = 360  # positions
ITERATED_TARGETS = {360: 2.0 / 0.23, 36_000: 1.0 / 0.23}  # 2 us and 1 us per position where the six-bar takes 0.23


@dataclass(frozen=True)
class IteratedRace:
    """Times per position (ns) of a linkage with a group solved by iteration, and of a six-bar with dyads only.

    Attributes:
        mechanism, positions: name of the linkage, and number of its positions; the six-bar is timed at 360 positions.
        ours, six_bar: the times of the linkage and of the six-bar.
        rest: fraction of the positions that the recorded computation cannot solve; they are solved in the ordinary way.
    """

    mechanism: str
    positions: int
    ours: float
    six_bar: float
    rest: float

    @property
    def ratio(self) -> float:
        return self.ours / self.six_bar

    @property
    def target(self) -> float:
        """Largest permitted ratio of the times."""
        return ITERATED_TARGETS[self.positions]

    def describe_miss(self, slack: float) -> str:
        if self.ratio <= slack * self.target:
            return ""
        kind = f"{self.mechanism}, {self.positions} positions"
        return f"{kind}: {self.ratio:.1f} times the six-bar, target {self.target:.1f}"

    def to_dict(self) -> dict[str, Any]:
        """Return this timing as it is written to the JSON file."""
        return asdict(self) | {"ratio": self.ratio, "target": self.target}


def race_iterated(name: str, reduced: bool) -> list[IteratedRace]:
    """Time a linkage over its cycle with all quantities, alternately with the six-bar, whose groups are dyads."""
    batch = prepare_batch(_linkage_with_constant_loads(name))
    six_bar = prepare_batch(_linkage_with_constant_loads("six-bar"))
    races = []
    for positions in ITERATED_POSITIONS:
        q, few = (batch.linkages[0].sketch.at + 2 * np.pi * np.arange(n) / n for n in (positions, OF_SIX_BAR))
        rest = 1 - float(np.mean(batch.closed(q)))

        def judged(least: dict[str, float], n: int = positions, rest: float = rest) -> IteratedRace:
            return IteratedRace(name, n, least["ours"] * 1e9 / n, least["six"] * 1e9 / OF_SIX_BAR, rest)

        runs = {"ours": lambda q=q: batch(q), "six": lambda q=few: six_bar(q)}
        races.append(time_until_met(runs, judged, reduced))
    return races


def _linkage_with_constant_loads(name: str) -> Linkage:
    """Return a reference linkage with constant loads in place of load tables."""
    linkage = load_reference(name).case.linkage
    loads = tuple(
        replace(x, force=x.force * (1 if x.table is None else x.table.values[0]), table=None, when="always")
        for x in linkage.loads
    )
    return replace(linkage, loads=loads)


def iterated_table(rows: Sequence[IteratedRace]) -> Table:
    """Make the table that compares linkages with groups of class III with the six-bar."""
    return text_table(
        "iterated",
        "Groups of class III against the six-bar: time per position with all reactions, ns",
        ("mechanism", "positions", "tmm", "six-bar", "ratio", "at most", "left to the stages"),
        [
            (
                r.mechanism,
                str(r.positions),
                f"{r.ours:.0f}",
                f"{r.six_bar:.0f}",
                f"{r.ratio:.1f}",
                f"{r.target:.1f}",
                f"{100 * r.rest:.1f} %",
            )
            for r in rows
        ],
    )


SWEPT = {"six-bar": "OA=80..120"}  # problem of 12 positions, and its range
SWEPT_QUANTITIES = ("H,k,pressure,M_b,R_34",)
SWEPT_MECHANISMS, REDUCED_MECHANISMS = 20_000, 2_000  # of a sweep: as many as in one job of a long sweep
A_MINUTE = 1e6


@dataclass(frozen=True)
class SweepRate:
    """Speed of a sweep on one core.

    Attributes:
        mechanism: name of the mechanism that is varied.
        mechanisms, positions: number of mechanisms in the sweep, and of positions of each.
        a_minute: mechanisms computed per minute.
        preparing: time of preparation, once, ms.
    """

    mechanism: str
    mechanisms: int
    positions: int
    a_minute: float
    preparing: float

    @property
    def target(self) -> float:
        """Least required number of mechanisms per minute."""
        return A_MINUTE

    def describe_miss(self, slack: float) -> str:
        if self.a_minute >= self.target / slack:
            return ""
        return f"sweep of {self.mechanism}: {self.a_minute:.0f} mechanisms per minute, target {self.target:.0f}"

    def to_dict(self) -> dict[str, Any]:
        """Return this rate as it is written to the JSON file."""
        return asdict(self) | {"target": self.target}


def time_sweep(name: str, reduced: bool) -> SweepRate:
    """Time a sweep as `tmm sweep` computes it, over a range in which all mechanisms can be assembled."""
    count = REDUCED_MECHANISMS if reduced else SWEPT_MECHANISMS
    start = perf_counter()
    tree = load_problem_tree(name)
    mechanisms = SweptMechanisms(tree, read_axes(Task(tree), [f"{SWEPT[name]}:{count}"]), SWEPT_QUANTITIES)
    assert mechanisms.crank_variants is not None
    preparing = 1e3 * (perf_counter() - start)
    points = grid_points(mechanisms.axes)

    def found(least: dict[str, float]) -> SweepRate:
        positions = mechanisms.task.problem.request.count
        return SweepRate(name, count, positions, 60 * count / least[""], preparing)

    return time_until_met({"": lambda: mechanisms.at(points)}, found, reduced)


def sweep_table(rows: Sequence[SweepRate]) -> Table:
    """Make the table of the rates of sweeps."""
    return text_table(
        "sweeps",
        f"Mechanisms per minute of a sweep on one core, with {SWEPT_QUANTITIES[0]}",
        ("mechanism", "mechanisms", "positions of each", "a minute", "at least", "preparing once, ms"),
        [
            (
                r.mechanism,
                str(r.mechanisms),
                str(r.positions),
                f"{r.a_minute:.0f}",
                f"{r.target:.0f}",
                f"{r.preparing:.0f}",
            )
            for r in rows
        ],
    )
