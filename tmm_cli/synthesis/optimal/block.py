"""Optimal synthesis: keys of the task."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from copy import copy
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.assembly.solvable import mobile
from tmm_cli.errors import MobilityError, _
from tmm_cli.linkage import Linkage
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.extended import VariedUnits
from tmm_cli.problem.record import Problem
from tmm_cli.problem.schema_parts import Name, Strict, Value, Vector
from tmm_cli.problem.units import PhysicalValue, UnitSystem
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import ANGLE, KINDS, LENGTH, Dimension
from tmm_cli.synthesis.blocks import Block, OfTheFile
from tmm_cli.synthesis.optimal import task
from tmm_cli.synthesis.optimal.block_over import Ends, asked_over, driven, within
from tmm_cli.synthesis.optimal.block_ranges import Range, Ranges, Two, read_ranges, two
from tmm_cli.synthesis.optimal.quantities import QUANTITIES
from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.synthesis.optimal.task import Task, near
from tmm_cli.tape.traced_number import TracedNumber
from tmm_cli.variants.variant import Make, Variant

SEARCH = True  # it wants the linkage for other parameters, and takes long
MOST = 20  # parameters
FEWEST = 8  # candidates in a generation
MOST_PLACES = 2_000_000_000  # positions of candidates: some minutes for a four-bar
if TYPE_CHECKING:
    Of = str
else:
    Of = Literal[tuple(QUANTITIES)]


class Quality(Strict):
    """A quantity of the mechanism over its cycle."""

    of: Of = Field(description="length: sum of link lengths; box: width + height; margin: from dead positions")
    pair: Name | None = Field(default=None, description="whose reaction")
    point: Name | None = Field(default=None, description="whose path")
    link: Name | None = Field(default=None, description="whose law of motion")
    links: list[Name] = Field(default_factory=list, max_length=100, description="of length: of these alone")
    through: list[Vector] = Field(default_factory=list, max_length=200, description="wanted points of the path")
    values: list[Value] = Field(default_factory=list, max_length=200, description="wanted angles or runs of the link")
    at: list[Value] = Field(default_factory=list, max_length=200, description="angles of the crank for them")
    relative: bool = Field(default=False, description="law: from the first value on")
    norm: Literal["least squares", "largest"] = "least squares"


class Objective(Quality):
    """What is made least (a margin: largest), or brought near to a target."""

    target: Value | None = Field(default=None, description="come near to this instead")


class Constraint(Quality):
    """What must be kept."""

    least: Value | None = None
    most: Value | None = None
    equal: Value | None = None


def _short(found: Any) -> Any:
    return {"of": found} if isinstance(found, str) else found


class Shape(Block):
    """Parameters within bounds that make an objective least and keep constraints; the driver goes its whole way."""

    task: Literal["optimal"]
    vary: dict[Name, Range] = Field(
        min_length=1, max_length=MOST,
        description="by name of the parameter: [low, high]; {from, to, step}; {among: [...]}; bare numbers are lengths "
        "where the file takes them for such",
    )  # fmt: skip
    objective: Annotated[Objective, BeforeValidator(_short)]
    constraints: list[Constraint] = Field(default_factory=list, max_length=30)
    over: Literal["cycle", "stroke", "positions"] | Two | None = Field(
        default=None,
        description="the driver's way: cycle, stroke (its own), positions (through the file's), [from, to]",
    )
    positions: int = Field(
        default=72, ge=12, le=720, description="round the cycle, in the search; no fewer than 24 in each of many turns"
    )
    population: int = Field(default=0, ge=0, le=10_000, description="in a generation; 0: 20 a parameter")
    generations: int = Field(default=0, ge=0, le=100_000, description="25 times the square of the number of parameters")
    seed: int = Field(default=1, ge=0, le=2**32 - 1)


def parameters(shape: Shape) -> dict[str, str]:
    """Names of what is found; their kinds follow from the bounds."""
    return dict.fromkeys(shape.vary, "length")


def read(
    shape: Shape, sense: ValueReader, file_with: Callable[[dict[str, PhysicalValue], UnitSystem], Problem]
) -> Task:
    """The task in SI. Raises ProblemError."""
    ranges = read_ranges(shape.vary, sense, shape.names, file_with)
    low, high, kinds = ranges.low, ranges.high, ranges.kinds
    _check_work(shape)
    varied = VariedUnits(sense.units)
    names = [shape.names.get(name, name) for name in low]

    def file(numbers: Sequence[Any]) -> Problem:
        units = varied if any(isinstance(x, TracedNumber) for x in numbers) else sense.units
        dimensions = (KINDS[kind].dimension for kind in kinds.values())
        return file_with({n: PhysicalValue(x, d) for n, x, d in zip(names, numbers, dimensions, strict=True)}, units)

    def said(error: OfTheFile, numbers: Sequence[Any]) -> OfTheFile:
        """A refusal of the file with the numbers that it is refused with."""
        refused, values = copy(error.error), []
        for name, number, kind in zip(low, numbers, kinds.values(), strict=True):
            value, dimension = number.value if isinstance(number, TracedNumber) else number, KINDS[kind].dimension
            shown = f"{sense.units.from_si(float(value), dimension):.6g} {sense.units.symbol(dimension)}".rstrip()
            values.append(f"{name} = {shown}")
        refused.message = _("with {numbers} the file is refused: {reason}").format(
            numbers=", ".join(values), reason=refused.message
        )
        return OfTheFile(refused)

    def takes(numbers: Sequence[Any]) -> bool:
        try:
            file(numbers)
        except OfTheFile:
            return False
        return True

    def first(numbers: Sequence[float]) -> Problem:
        try:
            return file(numbers)
        except OfTheFile as error:
            sound = any(takes(list(ends.values())) for ends in (low, high))
            raise (said(error, numbers) if sound else error) from None

    middles = near(
        [(a + b) / 2 for a, b in zip(low.values(), high.values(), strict=True)], ranges.values, list(low)
    ).tolist()
    over = asked_over(shape.over, first(middles).linkage.driver, sense)

    def make(numbers: Sequence[Any]) -> Variant:
        return driven(file(numbers), over)

    def tried(numbers: Sequence[Any]) -> Variant:
        """With other numbers the file is sound: what it is refused for is said of these."""
        try:
            return make(numbers)
        except OfTheFile as error:
            raise said(error, numbers) from None

    def accepts(numbers: Sequence[float]) -> bool:
        try:
            make(numbers)
        except (OfTheFile, ProblemError):
            return False
        return True

    middle = make(middles)
    _check_mobility(middle.linkage)
    ends_at_bounds = list(dict.fromkeys([middle.ends, *_check_bounds(ranges, make, middles)]))
    constraints = []
    for n, given in enumerate(shape.constraints):
        path: tuple[str | int, ...] = ("constraints", n)
        quantity = _quantity(given, middle, ends_at_bounds, sense, path)
        dimension = _dimension(quantity, middle.linkage)
        sides = {
            key: sense.number(value, dimension, (*path, key))
            for key in ("least", "most", "equal") if (value := getattr(given, key)) is not None
        }  # fmt: skip
        if not sides or ("equal" in sides and len(sides) > 1):
            raise ProblemError(
                _("a constraint has a bound"), path=path, allowed=_("least, most or both; or equal"), key=True
            )
        equal = sides.get("equal")
        least, most = sides.get("least", equal), sides.get("most", equal)
        if least is not None and most is not None and least > most:
            raise ProblemError(_("the least is more than the most"), path=path, found=two(given.least, given.most))
        key = "equal" if equal is not None else "least" if most is None else "most"
        constraints.append(task.Constraint(quantity, least, most, (*path, key)))
    objective = _quantity(shape.objective, middle, ends_at_bounds, sense, ("objective",))
    target = shape.objective.target
    wanted = (
        None if target is None else sense.number(target, _dimension(objective, middle.linkage), ("objective", "target"))
    )
    return Task(
        low, high, kinds, tried, objective, tuple(constraints), wanted, shape.positions, shape.population,
        shape.generations, shape.seed, accepts, _bar(), ranges.values,
    )  # fmt: skip


def _check_work(shape: Shape) -> None:
    """A search ends in our days. Raises ProblemError."""
    if 0 < shape.population < FEWEST:
        raise ProblemError(
            _("a population so small does not evolve"), path=("population",), found=str(shape.population),
            allowed=_("{least} or more, or 0 for as many as is usual").format(least=FEWEST),
        )  # fmt: skip
    each = max(shape.population, 20 * len(shape.vary)) * shape.positions
    if shape.generations * each > MOST_PLACES:
        raise ProblemError(
            _("such a search takes too long"), path=("generations",), found=str(shape.generations),
            allowed=_("{most} or less of so many candidates at so many positions").format(most=MOST_PLACES // each),
        )  # fmt: skip


def _check_mobility(linkage: Linkage) -> None:
    """What has passive links moves with exact dimensions only, which a parameter may spoil. Raises ProblemError."""
    try:
        mobile(linkage)
    except MobilityError as refusal:
        from tmm_cli.problem.refusals import mobility

        told = mobility(refusal.structure)
        raise ProblemError(
            _("with values in the middle of these bounds {reason}").format(reason=told.message), path=("vary",),
            found=told.found, allowed=_(
                "{allowed}; where pairs hold the same twice, a parameter that all their dimensions rest on"
            ).format(allowed=told.allowed),
        ) from None  # fmt: skip


def _check_bounds(ranges: Ranges, make: Make, middles: Sequence[float]) -> list[Ends]:
    """Where the driver goes at the bounds; what the file refuses there is said before the search.

    Raises ProblemError.
    """
    found = []
    for n, ends in enumerate((ranges.low, ranges.high)):
        for k, (name, end) in enumerate(ends.items()):
            try:
                found.append(make([*middles[:k], end, *middles[k + 1 :]]).ends)
            except OfTheFile as error:
                raise ProblemError(
                    _("with this bound the file is refused: {reason}").format(reason=error.error.message),
                    path=ranges.at[name][n], found=ranges.told[name][n],
                    allowed=error.error.allowed or _("another bound"),
                ) from None  # fmt: skip
        make(list(ends.values()))
    return found


def _dimension(quantity: Goal, linkage: Linkage) -> Dimension:
    return KINDS[quantity.kind(linkage, mobile(linkage).solved)].dimension


def _quantity(
    given: Quality, variant: Variant, ends: list[Ends], sense: ValueReader, path: tuple[str | int, ...]
) -> Goal:  # fmt: skip
    linkage, kind = variant.linkage, QUANTITIES[given.of]
    for key in given.model_fields_set & {key for other in QUANTITIES.values() for key in other.keys} - {*kind.keys}:
        raise ProblemError(
            _("{quantity} has no {key}").format(quantity=given.of, key=key), path=(*path, key),
            allowed=", ".join(sorted(kind.keys)) or "of", key=True,
        )  # fmt: skip
    name = ""
    if kind.named:
        name = getattr(given, kind.named) or ""
        known = {
            "pair": [pair.name for pair in mobile(linkage).pairs], "link": linkage.moving,
            "point": list(dict.fromkeys(p for link in linkage.moving for p in linkage.links[link].points)),
        }[kind.named]  # fmt: skip
        if not name:
            raise ProblemError(
                _("the key `{key}` is missing").format(key=kind.named), path=(*path, kind.named),
                allowed=", ".join(known),
            )  # fmt: skip
        sense.known(name, dict.fromkeys(known), (*path, kind.named), kind.named)
    for n, link in enumerate(given.links):
        sense.known(link, linkage.links, (*path, "links", n), "link")
    wanted: list[Any] = [sense.vector(v, LENGTH, (*path, "through", n)) for n, v in enumerate(given.through)]
    if given.values:
        dimension = LENGTH if linkage.slides_on_frame(name) else ANGLE
        wanted = [sense.number(v, dimension, (*path, "values", n)) for n, v in enumerate(given.values)]
    places = [_place(v, variant, ends, sense, (*path, "at", n)) for n, v in enumerate(given.at)]
    if kind.given and not wanted:
        raise ProblemError(
            _("the key `{key}` is missing").format(key=kind.given), path=(*path, kind.given),
            allowed=_("what is wanted"),
        )  # fmt: skip
    if len(places) != len(wanted) and (places or given.values):
        raise ProblemError(
            _("as many angles as {key} are wanted").format(key=kind.given), path=(*path, "at"),
            found=quote(len(places)), allowed=str(len(wanted)),
        )  # fmt: skip
    return kind(name, tuple(given.links), tuple(map(float, places)), tuple(wanted), given.norm, given.relative)


def _place(value: Any, variant: Variant, ends: list[Ends], sense: ValueReader, path: tuple[str | int, ...]) -> float:
    """A place of the driver's way, on all that it has at the bounds."""
    turns = variant.linkage.driver.kind == "turn"
    dimension = ANGLE if turns else LENGTH
    place = float(sense.number(value, dimension, path))
    for both in ends[::-1]:
        found = within(place, both, turns=turns)
        if found is None and both is not None:
            low, high = (f"{sense.units.from_si(float(end), dimension):.6g}" for end in both)
            stroke, several = both == variant.linkage.driver.stroke, len(ends) > 1
            allowed = {
                (True, False): _("a place of its stroke, {low} to {high} {unit}"),
                (True, True): _("a place of its stroke, {low} to {high} {unit} at a bound of what varies"),
                (False, False): _("a place of its way, {low} to {high} {unit}"),
                (False, True): _("a place of its way, {low} to {high} {unit} at a bound of what varies"),
            }[stroke, several]
            raise ProblemError(
                _("the driver does not go there"), path=path, found=quote(value),
                allowed=allowed.format(low=low, high=high, unit=sense.units.symbol(dimension)),
            )  # fmt: skip
    assert found is not None
    return found  # on the way of the middle of the bounds, which is the first of them


def _bar() -> Callable[[int, int], None]:
    """Progress on a terminal."""
    if not sys.stderr.isatty():
        return lambda at, of: None
    from rich.console import Console
    from rich.progress import Progress

    bar = Progress(console=Console(stderr=True), transient=True)
    task = bar.add_task(_("generations"))

    def show(at: int, of: int) -> None:
        if at == 0:
            bar.start()
        bar.update(task, completed=at, total=of)
        if at == of:
            bar.stop()

    return show
