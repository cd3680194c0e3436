"""Measurement of `tmm bench stability`: results of all methods near critical positions, and reports of failures.

A result is wrong if its error exceeds 1e-6 of the largest value, or 10 times the error that the method itself states
(tolerance of Newton's method), or 5 % for the drawing board. A result of tmm is wrong if its error exceeds its own
error bound. A method reports a failure by an exception, by nan, or by not converging; tmm also by a wide error bound.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, ClassVar, Literal

import numpy as np

from tmm_cli.bench.linkage_families import FAMILIES_BY_NAME
from tmm_cli.bench.measured import Measurement, text_table
from tmm_cli.bench.methods import textbook
from tmm_cli.bench.methods.case import QUANTITIES, Case, Compared, Method, MethodAnswers, UnsupportedLinkageError
from tmm_cli.bench.methods.registry import METHODS
from tmm_cli.bench.references import KnownScene, load_known_scenes
from tmm_cli.mechanics.accuracy import bound_values, solve_bare_linkage
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.numerics import ROUNDOFF, Real
from tmm_cli.reports import Table

PRODUCT = "tmm"
WRONG, TIMES = 1e-6, 10.0  # fraction of the largest value; multiple of the error that a method states
BOARD_ERROR = 0.05  # stated error of the drawing board
LARGEST_WIDTH, TARGET = 100.0, 0.9  # largest ratio of bound to true error, and the least share of bounds within it
REFERENCE_ERROR = 1e-40  # fraction of the largest value: error of the reference values
SEEDS_WHEN_REDUCED, EVERY_WHEN_REDUCED = 2, 4
WHEN_REDUCED = ("closed", "newton-2", "newton-6", "newton-12", "differences-4", "single", "extended")
TEXTBOOK_METHODS = (
    Method("cosines", "cosines", textbook.prepare_cosines),
    Method("freudenstein", "freudenstein", textbook.prepare_freudenstein),
)
RIVALS: tuple[Method, ...] = (*METHODS, *TEXTBOOK_METHODS)

Verdict = Literal["right", "said", "wrong"]
Solver = Callable[[Real], MethodAnswers]


@dataclass(frozen=True)
class SceneOutcome:
    """Result of one method for one linkage near a critical position.

    Attributes:
        method: name of the method.
        verdict: right, said (the method reported a failure) or wrong.
        errors: relative error of each quantity, nan if not computed.
        why: how a failure was reported.
        bound: largest error bound, as a fraction of the largest value; only for tmm.
        widths: ratio of the error bound to the true error for each number; only for tmm.
    """

    method: str
    verdict: Verdict
    errors: dict[Compared, float]
    why: str = ""
    bound: float = float("nan")
    widths: tuple[float, ...] = ()


@dataclass(frozen=True)
class StabilityRow:
    """Results of one method at one distance from the critical position.

    Attributes:
        family: name of the linkage family.
        method: name of the method.
        distance: distance, in the unit of the family.
        scenes: number of linkages.
        right, said, wrong: numbers of linkages with right results, with reported failures, with wrong results.
        errors: largest relative error of each quantity.
        bound: largest error bound of tmm, as a fraction of the largest value.
        why: how failures were reported.
    """

    family: str
    method: str
    distance: float
    scenes: int
    right: int
    said: int
    wrong: int
    errors: dict[Compared, float]
    bound: float = float("nan")
    why: tuple[str, ...] = ()

    @property
    def error(self) -> float:
        """Largest relative error of all quantities; nan if none was computed."""
        errors = [error for error in self.errors.values() if not np.isnan(error)]
        return max(errors, default=float("nan"))


@dataclass(frozen=True)
class Stability(Measurement):
    """Results of `tmm bench stability`.

    Attributes:
        rows: results for each linkage family, method and distance.
        widths: ratio of the error bound to the true error for each number computed by tmm.
    """

    rows: tuple[StabilityRow, ...]
    widths: tuple[float, ...]

    met: ClassVar[str] = "all targets met: every value within its error bound, or not printed"

    @property
    def families(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(row.family for row in self.rows))

    @property
    def methods(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(row.method for row in self.rows))

    def select_rows(self, family: str, method: str) -> list[StabilityRow]:
        """Return the results of a method for a linkage family, ordered towards the critical position."""
        return [row for row in self.rows if (row.family, row.method) == (family, method)]

    def first_wrong_distance(self, family: str, method: str) -> float | None:
        """Return the first distance at which a method gives a wrong result without reporting a failure; None if
        there is none.
        """
        return next((row.distance for row in self.select_rows(family, method) if row.wrong), None)

    @property
    def sharp(self) -> float:
        """Fraction of the error bounds of tmm that are at most 100 times the true error."""
        return float(np.mean(np.array(self.widths) <= LARGEST_WIDTH)) if self.widths else float("nan")

    @property
    def failures(self) -> tuple[str, ...]:
        """Messages on targets that tmm misses."""
        lies = [
            f"{row.family}: {row.wrong} of {row.scenes} outside their error bounds at {row.distance:g}"
            for row in self.rows
            if row.method == PRODUCT and row.wrong
        ]
        if self.widths and not self.sharp >= TARGET:
            lies.append(
                f"{self.sharp:.1%} of the bounds are within {LARGEST_WIDTH:g} times the true error, target {TARGET:.0%}"
            )
        return tuple(lies)

    def to_dict(self) -> dict[str, Any]:
        """Return the contents of the JSON file; an error that was not computed is null."""
        rows = [
            vars(row) | {"errors": {q: _plain(e) for q, e in row.errors.items()}, "bound": _plain(row.bound)}
            for row in self.rows
        ]
        lies = {
            f: {m: self.first_wrong_distance(f, m) for m in self.methods if self.select_rows(f, m)}
            for f in self.families
        }
        return {
            "rows": rows,
            "first_lie": lies,
            "bounds": len(self.widths),
            "sharp": _plain(self.sharp),
            "reduced": self.reduced,
            "absent": list(self.absent),
            "failures": list(self.failures),
        }

    @property
    def tables(self) -> tuple[Table, ...]:
        def first(family: str, method: str) -> str:
            if not self.select_rows(family, method):
                return "-"
            distance = self.first_wrong_distance(family, method)
            return "never" if distance is None else f"{distance:.0e}".replace("e-0", "e-")

        rows = [(method, *(first(family, method) for family in self.families)) for method in self.methods]
        title = "Distance at which each method first gives a wrong result without reporting it"
        return (text_table("stability", title, ("method", *self.families), rows),)

    @property
    def remarks(self) -> tuple[str, ...]:
        sharp = "{count} bounds of tmm against 50 digits: {share} are at most {wide} times the true error"
        return *self.absent, sharp.format(count=len(self.widths), share=f"{self.sharp:.1%}", wide=f"{LARGEST_WIDTH:g}")


def _plain(value: float) -> float | None:
    return None if np.isnan(value) else float(f"{min(value, 1e300):.3g}")


def measure_stability(
    families: Sequence[str] = tuple(FAMILIES_BY_NAME),
    *,
    reduced: bool = False,
    methods: Iterable[Method] | None = None,
    own: bool = True,
    progress: Callable[[str], None] = lambda __: None,
) -> Stability:
    """Apply the methods to linkages near critical positions.

    Args:
        families: Names of linkage families.
        reduced: True for fewer linkages and methods.
        methods: Methods to apply; by default all.
        own: True to include tmm with its error bounds.
        progress: Called with the name of each family.
    """
    fewer = [method for method in RIVALS if method.name in WHEN_REDUCED or method in TEXTBOOK_METHODS]
    chosen = tuple(methods if methods is not None else fewer if reduced else RIVALS)
    rows: list[StabilityRow] = []
    widths: list[float] = []
    absent: dict[str, None] = {}
    for family in families:
        progress(family)
        some = (SEEDS_WHEN_REDUCED, EVERY_WHEN_REDUCED) if reduced else (None, 1)
        shots: dict[tuple[str, float], list[SceneOutcome]] = {}
        for at, case, solvers in _prepare_scenes(load_known_scenes(family, *some), chosen, absent):
            mine = (judge_product(case, at),) if own else ()
            for shot in (*mine, *(judge_method(method, solver, at) for method, solver in solvers.items())):
                shots.setdefault((shot.method, float(at.distance)), []).append(shot)
                widths += shot.widths
        rows += [_make_row(family, *key, outcomes) for key, outcomes in shots.items()]
    return Stability(tuple(rows), tuple(widths), reduced=reduced, absent=tuple(absent))


def _prepare_scenes(
    scenes: Iterable[KnownScene], methods: tuple[Method, ...], absent: dict[str, None]
) -> Iterator[tuple[KnownScene, Case, dict[Method, Solver | Exception]]]:
    """Yield each linkage with its prepared methods, or the error with which preparation failed.

    Methods are prepared only once if the linkage is the same at all distances. Methods that cannot compute a linkage
    are added to `absent`.
    """
    for __, group in groupby(scenes, key=lambda at: (at.seed, None if at.family.fixed else at.distance)):
        of_one = list(group)
        case = Case.of(of_one[0].scene.linkage)
        solvers: dict[Method, Solver | Exception] = {}
        for method in methods:
            try:
                with np.errstate(all="ignore"):
                    solvers[method] = method.prepare(case)
            except UnsupportedLinkageError as error:
                absent[f"{method.name}: {of_one[0].family.name}: {error}"] = None
            except (ArithmeticError, ValueError, LinkageError, np.linalg.LinAlgError) as error:
                solvers[method] = error
        for at in of_one:
            yield at, case, solvers


def error_limit(method: Method) -> float:
    """Return the relative error beyond which a result of the method counts as wrong."""
    stated = (
        BOARD_ERROR
        if method.family == "board"
        else TIMES * (method.setting or 0.0)
        if method.family == "newton"
        else 0.0
    )
    return max(WRONG, stated)


def judge_method(method: Method, solver: Solver | Exception, at: KnownScene) -> SceneOutcome:
    """Apply a method to a linkage and compare the results with the exact values.

    solver: the prepared method, or the error with which preparation failed, which counts as a reported failure.
    """
    nothing: dict[Compared, float] = dict.fromkeys(QUANTITIES, float("nan"))
    try:
        if isinstance(solver, Exception):
            raise solver
        with np.errstate(all="ignore"):
            answers = solver(np.array([at.scene.q]))
    except (ArithmeticError, ValueError, IndexError, AssertionError, LinkageError, np.linalg.LinAlgError) as error:
        return SceneOutcome(method.name, "said", nothing, type(error).__name__)
    values = {quantity: _watched_value(answers, quantity, at) for quantity in QUANTITIES}
    if not all(np.isfinite(value) for value in values.values() if value is not None):
        return SceneOutcome(method.name, "said", nothing, "nan")
    errors = {
        quantity: nothing[quantity] if value is None else _relative_error(value, quantity, at)
        for quantity, value in values.items()
    }
    wrong = max(error for error in errors.values() if not np.isnan(error)) > error_limit(method)
    return SceneOutcome(method.name, "wrong" if wrong else "right", errors)


def _relative_error(value: Any, quantity: Compared, at: KnownScene) -> float:
    return float(abs(value - at.exact[quantity]) / at.largest[quantity])


def _watched_value(answers: MethodAnswers, quantity: Compared, at: KnownScene) -> Any:
    series = answers.series(quantity)
    name = {"reactions": at.scene.pair, "balancing": "balancing"}.get(quantity, at.scene.point)
    return None if series is None else series[name][0]


def judge_product(case: Case, at: KnownScene) -> SceneOutcome:
    """Apply tmm to a linkage and compare the results with the exact values.

    The verdict is wrong if the error of a value exceeds its error bound. A value without a finite bound counts as a
    reported failure.
    """
    q = np.array([at.scene.q])
    results = solve_bare_linkage(case.linkage, q, case.structure, case.kernels)
    values, digits = bound_values(results)
    assert results.reactions is not None
    reaction = results.reactions.of(at.scene.pair)
    sense = 1 if reaction.on == reaction.pair.j else -1
    keys: dict[Compared, tuple[str, str]] = {
        "positions": ("x", at.scene.point),
        "velocities": ("v", at.scene.point),
        "accelerations": ("a", at.scene.point),
        "reactions": ("force", at.scene.pair),
        "balancing": ("balancing", case.linkage.driver.link),
    }
    errors: dict[Compared, float] = {}
    widths: list[float] = []
    within, printed, widest = True, True, 0.0
    for quantity, key in keys.items():
        true = at.exact[quantity]
        total = 0.0
        parts = (("x", true.real), ("y", true.imag)) if np.iscomplexobj(true) else (("", true),)
        for component, exact in parts:
            mine, bound = values[*key, component][0], float(digits.bound[*key, component][0])
            if not (np.isfinite(mine) and np.isfinite(bound)):
                printed, total = False, float("nan")
                continue
            off = float(abs(mine - (sense if quantity == "reactions" else 1) * exact))
            within = within and off <= bound + REFERENCE_ERROR * at.largest[quantity]
            floor = max(off, ROUNDOFF * abs(float(exact)), REFERENCE_ERROR * at.largest[quantity])
            widths.append(bound / floor if bound else 1.0)  # a component that is exactly zero
            total += off * off
            widest = max(widest, bound / at.largest[quantity])
        errors[quantity] = float(np.sqrt(total)) / at.largest[quantity]
    if not within:
        return SceneOutcome(PRODUCT, "wrong", errors, "", widest, tuple(widths))
    if not printed:
        return SceneOutcome(PRODUCT, "said", errors, "nan", widest or float("nan"), tuple(widths))
    far = max(errors.values()) > WRONG  # reported by the bound
    return SceneOutcome(PRODUCT, "said" if far else "right", errors, "bound" if far else "", widest, tuple(widths))


def _make_row(family: str, method: str, distance: float, shots: list[SceneOutcome]) -> StabilityRow:
    errors: dict[Compared, float] = {}
    for quantity in QUANTITIES:
        errors_given = [shot.errors[quantity] for shot in shots if not np.isnan(shot.errors[quantity])]
        errors[quantity] = max(errors_given, default=float("nan"))
    wide = [shot.bound for shot in shots if not np.isnan(shot.bound)]
    right, said, wrong = (sum(shot.verdict == verdict for shot in shots) for verdict in ("right", "said", "wrong"))
    why = tuple(sorted({shot.why for shot in shots if shot.why}))
    bound = max(wide, default=float("nan"))
    return StabilityRow(family, method, distance, len(shots), right, said, wrong, errors, bound, why)
