"""Properties requested in the block `shows` of a file: single numbers, some of them with an expected value."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import (
    STAGES,
    NamedQuantity,
    Results,
    list_quantities,
    pipeline,
    relative_angles,
    results_at,
    wheel_quantities,
)
from tmm_cli.mechanics.groups import DriverMotion, link_extent
from tmm_cli.mechanics.numerics import Real, find_roots, greatest_values
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_JERK,
    JERK,
    LENGTH,
    NUMBER,
    Dimension,
    coordinate_dimension,
)
from tmm_cli.mechanics.structure import ChainResults, analyse_structure
from tmm_cli.problem import (
    Path,
    Problem,
    ProblemError,
    ShownKeys,
    apply_settings,
    build_problem,
    format_path,
    prefix_errors,
    quote,
    translate_errors,
    unknown_name_error,
    unknown_position_error,
)

RANGE_STEPS = 720  # in a turn, or over the driver's way
ANGLE_STEPS = 60  # of the way between two positions, through which an angle is followed
ROUNDING = 1e-13  # of a radian, or of the longest link: a smaller angle or length is rounding, and is told as none
PROPERTY_TOLERANCE = 1e-9  # of the value, or of one in SI: rounding of what is found by search


@dataclass(frozen=True)
class ShownProperty:
    """A property requested in the block `shows`.

    Attributes:
        name: name of the property in the file.
        value: value in SI; nan if undefined.
        dimension: dimension of the value.
        expected: expected value in SI; None if the file gives none or it does not apply.
    """

    name: str
    value: float
    dimension: Dimension
    expected: float | None = None

    @property
    def met(self) -> bool:
        return self.expected is None or math.isclose(
            self.value, self.expected, rel_tol=PROPERTY_TOLERANCE, abs_tol=PROPERTY_TOLERANCE
        )


def shown_properties(results: Results | ChainResults) -> tuple[ShownProperty, ...]:
    """Return the properties requested in the block `shows`.

    A property that needs a stage of the calculation that has not run is omitted.

    Raises:
        ProblemError: a requested property cannot be computed for this mechanism.
    """
    problem = results.problem
    if isinstance(results, ChainResults):
        return tuple(_chain_property(name, task, results) for name, task in problem.shows.items())
    return _linkage_properties(results)


@lru_cache(maxsize=1)
def _linkage_properties(results: Results) -> tuple[ShownProperty, ...]:
    problem = results.problem
    if problem is None or results.of:
        return ()
    shown = []
    for name, task in problem.shows.items():
        try:
            with prefix_errors("shows", name):
                shown_property = _linkage_property(name, task, results)
        except ProblemError as error:
            raise error.located(problem.file, problem.source) from None
        shown += [shown_property] if shown_property is not None else []
    return tuple(shown)


def _chain_property(name: str, task: ShownKeys, results: ChainResults) -> ShownProperty:
    chain, path = results.chain, ("shows", name)
    quantities = {"W": chain.mobility, "Wm": chain.local_mobility, "q": chain.redundant, "m": chain.manoeuvrability}
    value = quantities.get(task.of)
    if value is None or not isinstance(task.expected, int | None):
        key, raw = ("of", task.of) if value is None else ("expected", task.expected)
        allowed = ", ".join(k for k, v in quantities.items() if v is not None) if value is None else _("a number")
        message = _(
            "for a chain given without dimensions only properties of the structure can be computed: W, Wm, q and m"
        )
        error = ProblemError(message, path=(*path, key), found=quote(raw), allowed=allowed)
        raise error.located(results.problem.name, results.problem.source)
    return ShownProperty(name, float(value), NUMBER, None if task.expected is None else float(task.expected))


def _linkage_property(name: str, task: ShownKeys, results: Results) -> ShownProperty | None:
    """Return a requested property of a linkage; None if it needs a stage of the calculation that has not run."""
    problem: Problem = results.problem
    values = problem.values
    assert values is not None
    if task.set:
        results = _with_settings(task, results)
    if task.without is not None:
        results = _without_hinge(task.without, results)
    linkage = results.linkage
    quantities = {
        **list_quantities(linkage, results.structure),
        **wheel_quantities(results.inputs.wheels),
        **relative_angles(linkage),
    }
    if task.of not in quantities:
        raise unknown_name_error(task.of, quantities, _("unknown quantity"), path=("of",))
    quantity = quantities[task.of]
    if task.without is not None and quantity.stage != "structure":
        raise ProblemError(
            _("only properties of the structure can be computed with a hinge removed (`without`)"),
            path=("of",),
            found=quote(task.of),
        )
    if not _has_run(quantity, results):
        return None
    law = None if results.motion is None else results.motion.law
    if quantity.dimension in (JERK, ANGULAR_JERK) and not isinstance(law, DriverMotion):
        message = _("the jerk is computed only for a driver with constant speed or constant acceleration")
        raise ProblemError(message, path=("of",), found=quote(task.of))
    by = quantities.get(task.per) if isinstance(task.per, str) else None
    ratio = by is not None and task.over in ("largest", "least")
    if by is not None:
        if by.dimension != quantity.dimension or (ratio and by.dimension == ANGLE):
            raise ProblemError(_("expected a quantity of the same dimension"), path=("per",), found=quote(task.per))
        if not _has_run(by, results):
            return None
    value = _property_value(quantity, task, results, by if ratio else None)
    dimension = quantity.dimension
    if not ratio and abs(value) <= ROUNDING * _rounding_scale(dimension, results):
        value = 0.0
    if task.within is not None:
        dimension = coordinate_dimension(results.linkage.driver.kind)
    if task.per is not None:
        if by is None:
            value /= values.positive(task.per, dimension, ("per",))
        elif not ratio:
            by_value = _property_value(by, task, results)
            value = value / by_value if by_value else np.nan
        dimension = NUMBER
    compared = task.expected is not None and (quantity.stage == "structure" or not _holds_for_file_only(task, problem))
    expected = values.number(task.expected, dimension, ("expected",)) if compared else None
    return ShownProperty(name, value, dimension, expected)


def _rounding_scale(dimension: Dimension, results: Results) -> float:
    """Return the reference value (SI) by which small angles and lengths are recognised as rounding errors of zero.

    It is 0 for other dimensions, whose values are not rounded to zero.
    """
    if dimension == LENGTH:
        return max(float(link_extent(results.linkage, link)) for link in results.linkage.links)
    return 1.0 if dimension == ANGLE else 0.0


def _holds_for_file_only(task: ShownKeys, problem: Problem) -> bool:
    """Return True if the user has changed parameters and the expected value holds only for those of the file."""
    source = problem.source
    if source is None or not source.given:
        return False
    names = set(re.findall(r"[^\W\d]\w*", str(task.expected)))
    return names.isdisjoint(source.data.get("parameters", {}))


def _has_run(quantity: NamedQuantity, results: Results) -> bool:
    if quantity.stage == "structure":
        return True
    forces = quantity.order >= STAGES.index("forces")
    return results.motion is not None and not (forces and results.reactions is None)


def _with_settings(task: ShownKeys, results: Results) -> Results:
    """Solve the linkage again with the parameter values that a requested property sets.

    The calculation ends with the same stage as the given results.
    """
    problem: Problem = results.problem
    assert problem.source is not None
    stage: pipeline.Stage = "structure" if results.motion is None else "kinematics"
    stage = stage if results.reactions is None else "forces"
    try:
        other = build_problem(apply_settings(problem.source, [f"{name}={value}" for name, value in task.set.items()]))
        inputs = replace(
            results.inputs, linkage=other.linkage, request=other.request, wheels=other.wheels, extended=None
        )
        with translate_errors(other):
            return pipeline.solve(inputs, stage, (0,), problem=other)  # further places are found when they are read
    except ProblemError as error:  # its place is that of what the parameters spoil
        message = _("the file is not valid with these parameters: {reason}")
        reason = ": ".join(text for text in (format_path(error.path), error.message) if text)
        raise ProblemError(
            message.format(reason=reason), path=("set",), found=error.found, allowed=error.allowed
        ) from None


def _without_hinge(hinge: str, results: Results) -> Results:
    """Return results for the linkage without one of its hinges. They contain the structural analysis, but no motion."""
    linkage = results.linkage
    results.problem.values.known_name(hinge, [h.point for h in linkage.hinges], ("without",), "hinge")
    left = replace(linkage, hinges=tuple(h for h in linkage.hinges if h.point != hinge))
    return replace(
        results, inputs=replace(results.inputs, linkage=left), structure=analyse_structure(left), motion=None
    )


def _property_value(
    quantity: NamedQuantity, task: ShownKeys, results: Results, per: NamedQuantity | None = None
) -> float:
    """Return the number that the block `shows` requests for a quantity.

    This is the value at one position, the change between two positions, the largest value, the least value or the range
    over the travel of the driver, or the range of the driver in which the quantity changes by at most a given amount.

    per: second quantity; if given, the quantity is divided by it.
    """
    ways = [key for key in ("at", "between", "over") if getattr(task, key) is not None]
    if quantity.whole:
        if ways or task.within is not None:
            message = _("this is a property of the whole mechanism, not of a position")
            raise ProblemError(message, path=((*ways, "within")[0],), found=quote(task.of))
        return float(np.asarray(quantity.read(results)).ravel()[0])
    if len(ways) != 1 or (task.within is not None and ways != ["at"]):
        wanted = _("specify one position, two positions, or the whole travel of the driver")
        raise ProblemError(wanted, path=("of",), found=quote(task.of), allowed="at, between, over, at + within")
    read = partial(_read_quantity, quantity, results) if per is None else partial(_read_ratio, quantity, per, results)
    if task.over is not None:
        return _extreme_over_range(read, task.over, results, quantity.dimension == ANGLE)
    numbers = (
        [(task.at, ("at",))]
        if task.at is not None
        else [(number, ("between", k)) for k, number in enumerate(task.between or [])]
    )
    coordinates = [_driver_coordinate(number, path, results) for number, path in numbers]
    if task.within is not None:
        most = results.problem.values.positive(task.within, quantity.dimension, ("within",))
        return _range_within(read, coordinates[0], most, results)
    if len(coordinates) == 1:
        return float(read(np.array(coordinates))[0])
    way = np.linspace(coordinates[0], coordinates[1], ANGLE_STEPS + 1)
    values = read(way)
    values = np.unwrap(values) if quantity.dimension == ANGLE else values
    return float(values[-1] - values[0])


def _read_quantity(quantity: NamedQuantity, results: Results, q: Real) -> Real:
    """Return a quantity, or the magnitude of a vector, at driver coordinates q, (positions,)."""
    results_there = results_at(results, q)
    values = np.asarray(quantity.read(results_there))
    return np.broadcast_to(np.abs(values) if quantity.vector else values, np.shape(q))


def _read_ratio(quantity: NamedQuantity, per: NamedQuantity, results: Results, q: Real) -> Real:
    """Return the ratio of two quantities at driver coordinates q, (positions,); nan where the divisor is zero."""
    value, divisor = _read_quantity(quantity, results, q), _read_quantity(per, results, q)
    ratio: Real = np.divide(value, divisor, out=np.full(np.shape(q), np.nan), where=divisor != 0)
    return ratio


def _driver_coordinate(number: int, path: Path, results: Results) -> float:
    coordinates = results.asked
    if number >= len(coordinates):
        raise unknown_position_error(number, len(coordinates), *path)
    return float(coordinates[number])


def _extreme_over_range(read: Callable[[Real], Real], over: str, results: Results, turns: bool) -> float:
    """Return the largest value, the least value or the range of a quantity over the travel of the driver.

    Extremes between the sampled positions are refined. over: largest, least or range.
    """
    q = results.closely(RANGE_STEPS * max(results.turns, 1) + 1)
    values = read(q)[None, :]
    values = np.unwrap(values) if turns else values

    def extreme(sign: float) -> float:
        def curve(_rows: Real, coordinates: Real) -> Real:
            return sign * read(coordinates.ravel()).reshape(coordinates.shape)

        return sign * float(greatest_values(curve, q, sign * values, turns=turns)[0])

    if over == "range":
        return extreme(1.0) - extreme(-1.0)
    return extreme(1.0 if over == "largest" else -1.0)


def _range_within(read: Callable[[Real], Real], place: float, most: float, results: Results) -> float:
    """Return the width of the range around a position in which a quantity changes by at most `most`.

    It is a range of the driver coordinate; `place` is the coordinate of the position. Changes are counted from the
    value there.
    """
    middle = read(np.array([place]))[0]
    travel = abs(results.closely(2)[1] - results.closely(2)[0])
    low, high = np.min(results.closely(2)), np.max(results.closely(2))
    ends = []

    def beyond(q: Real) -> Real:
        over = np.abs(read(q) - middle) - most
        return np.where(np.isnan(over), np.inf, over)

    for sign in (-1.0, 1.0):
        far = travel if results.turns else abs((low if sign < 0 else high) - place)
        q = place + sign * np.linspace(0, far, RANGE_STEPS * max(results.turns, 1) + 1)
        gone = np.flatnonzero(beyond(q) > 0)
        if not gone.size:
            ends.append(float(q[-1]))
            continue
        ends.append(float(find_roots(beyond, q[gone[:1] - 1], q[gone[:1]])[0]))
    return min(ends[1] - ends[0], travel if results.turns else np.inf)
