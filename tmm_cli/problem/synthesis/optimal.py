"""Optimal synthesis: keys of the task."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from copy import copy
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.linkage import Linkage
from tmm_cli.mobile import mobile
from tmm_cli.problem.dimensions import KINDS
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.record import Problem
from tmm_cli.problem.schema import Name, Strict, Value, Vector
from tmm_cli.problem.sense import Sense
from tmm_cli.problem.synthesis import Block
from tmm_cli.problem.synthesis.build import OfTheFile
from tmm_cli.problem.synthesis.driven import Ends, asked_over, driven, within
from tmm_cli.problem.synthesis.ranges import Range, Ranges, Two, read
from tmm_cli.problem.units import ANGLE, LENGTH, Dimension, Quantity, UnitSystem
from tmm_cli.problem.varied import VariedUnits
from tmm_cli.refused import WrongMobility
from tmm_cli.synthesis.goals import Goal
from tmm_cli.synthesis.optimal import Asked, Limit
from tmm_cli.synthesis.optimal_asked import near
from tmm_cli.tape.varied import Varied
from tmm_cli.variants.way import Make, Variant

SEARCH = True  # it wants the linkage for other parameters, and takes long
MOST = 20  # parameters
PART = 0.0625  # what is added to a whole number, to see whether the file takes others
FEWEST = 8  # candidates in a generation
MOST_PLACES = 2_000_000_000  # positions of candidates: some minutes for a four-bar
Of = Literal["length", "mass", "box", "pressure", "moment", "reaction", "margin", "stroke", "k", "speed", "path", "law"]
NEEDS = {"reaction": "pair", "path": "point", "law": "link"}  # the key that names of what
FULL = {"moment": "moment of force", "reaction": "force"}


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


def asked(shape: Shape, sense: Sense, file_with: Callable[[dict[str, Quantity], UnitSystem], Problem]) -> Asked:
    """The task in SI. Raises ProblemError."""
    ranges = read(shape.vary, sense, shape.names, file_with)
    low, high, kinds = ranges.low, ranges.high, ranges.kinds
    _check_work(shape)
    varied = VariedUnits(sense.units)
    names = [shape.names.get(name, name) for name in low]

    def file(numbers: Sequence[Any]) -> Problem:
        units = varied if any(isinstance(x, Varied) for x in numbers) else sense.units
        dimensions = (KINDS[kind].dimension for kind in kinds.values())
        return file_with({n: Quantity(x, d) for n, x, d in zip(names, numbers, dimensions, strict=True)}, units)

    def said(error: OfTheFile, numbers: Sequence[Any]) -> OfTheFile:
        """A refusal of the file with the numbers that it is refused with."""
        refused, values = copy(error.error), []
        for name, number, kind in zip(low, numbers, kinds.values(), strict=True):
            value, dimension = number.value if isinstance(number, Varied) else number, KINDS[kind].dimension
            shown = f"{sense.units.from_si(float(value), dimension):.6g} {sense.units.symbol(dimension)}".rstrip()
            values.append(f"{name} = {shown}")
        refused.message = f"with {', '.join(values)} the file is refused: {refused.message}"
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

    middles = near([(a + b) / 2 for a, b in zip(low.values(), high.values(), strict=True)], ranges.values, low).tolist()
    _check_whole(ranges, middles, takes)
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
    ways = list(dict.fromkeys([middle.ends, *_check_bounds(ranges, make, middles)]))
    limits = []
    for n, given in enumerate(shape.constraints):
        path: tuple[str | int, ...] = ("constraints", n)
        goal = _goal(given, middle, ways, sense, path)
        dimension = _dimension(goal, middle.linkage)
        sides = {
            key: sense.number(value, dimension, (*path, key))
            for key in ("least", "most", "equal") if (value := getattr(given, key)) is not None
        }  # fmt: skip
        if not sides or ("equal" in sides and len(sides) > 1):
            raise ProblemError("a constraint has a bound", path=path, allowed="least, most or both; or equal", key=True)
        equal = sides.get("equal")
        least, most = sides.get("least", equal), sides.get("most", equal)
        if least is not None and most is not None and least > most:
            raise ProblemError("the least is more than the most", path=path, found=f"{given.least} and {given.most}")
        key = "equal" if equal is not None else "least" if most is None else "most"
        limits.append(Limit(goal, least, most, (*path, key)))
    objective = _goal(shape.objective, middle, ways, sense, ("objective",))
    target = shape.objective.target
    wanted = (
        None if target is None else sense.number(target, _dimension(objective, middle.linkage), ("objective", "target"))
    )
    return Asked(
        low, high, kinds, tried, objective, tuple(limits), wanted, shape.positions, shape.population,
        shape.generations, shape.seed, accepts, _bar(), ranges.values, ranges.at,
    )  # fmt: skip


def _check_work(shape: Shape) -> None:
    """A search ends in our days. Raises ProblemError."""
    if 0 < shape.population < FEWEST:
        raise ProblemError(
            "a population so small does not evolve", path=("population",), found=str(shape.population),
            allowed=f"{FEWEST} or more, or 0 for as many as is usual",
        )  # fmt: skip
    each = max(shape.population, 20 * len(shape.vary)) * shape.positions
    if shape.generations * each > MOST_PLACES:
        raise ProblemError(
            "such a search takes too long", path=("generations",), found=str(shape.generations),
            allowed=f"{MOST_PLACES // each} or less of so many candidates at so many positions",
        )  # fmt: skip


def _check_mobility(linkage: Linkage) -> None:
    """What has passive links moves with exact dimensions only, which a parameter may spoil. Raises ProblemError."""
    try:
        mobile(linkage)
    except WrongMobility as refusal:
        from tmm_cli.problem.refusals import mobility

        told = mobility(refusal.structure)
        raise ProblemError(
            f"with values in the middle of these bounds {told.message}", path=("vary",), found=told.found,
            allowed=f"{told.allowed}; where pairs hold the same twice, a parameter that all their dimensions rest on",
        ) from None  # fmt: skip


def _check_whole(ranges: Ranges, numbers: Sequence[float], takes: Callable[[Sequence[float]], bool]) -> None:
    """Of what the file refuses, as a number of teeth that is not whole, steps are wanted. Raises ProblemError."""
    for k, name in enumerate(ranges.low):
        if ranges.kinds[name] != "number" or name in ranges.values:
            continue
        whole, *parts = ([*numbers[:k], round(numbers[k]) + more, *numbers[k + 1 :]] for more in (0.0, PART, -PART))
        if takes(whole) and not any(map(takes, parts)):
            low, high = math.ceil(ranges.low[name]), math.floor(ranges.high[name])
            raise ProblemError(
                "the file takes whole numbers here", path=("vary", name), found=", ".join(ranges.told[name]),
                allowed=f"{{from: {low}, to: {high}, step: 1}}",
            )  # fmt: skip


def _check_bounds(ranges: Ranges, make: Make, middles: Sequence[float]) -> list[Ends]:
    """The drivers' ways at the bounds; what the file refuses there is said before the search. Raises ProblemError."""
    found = []
    for n, ends in enumerate((ranges.low, ranges.high)):
        for k, (name, end) in enumerate(ends.items()):
            try:
                found.append(make([*middles[:k], end, *middles[k + 1 :]]).ends)
            except OfTheFile as error:
                raise ProblemError(
                    f"with this bound the file is refused: {error.error.message}", path=ranges.at[name][n],
                    found=ranges.told[name][n], allowed=error.error.allowed or "another bound",
                ) from None  # fmt: skip
        make(list(ends.values()))
    return found


def _dimension(goal: Goal, linkage: Linkage) -> Dimension:
    return KINDS[goal.kind(linkage, mobile(linkage).solved)].dimension


def _goal(given: Quality, variant: Variant, ways: list[Ends], sense: Sense, path: tuple[str | int, ...]) -> Goal:
    linkage = variant.linkage
    own = {"pair", "point", "link", "links", "through", "values", "at", "relative", "norm"}
    takes = {"reaction": {"pair"}, "path": {"point", "through", "at", "norm"},
             "law": {"link", "values", "at", "relative", "norm"},
             "length": {"links"}}.get(given.of, set())  # fmt: skip
    for key in own - takes:
        if key in given.model_fields_set:
            allowed = ", ".join(sorted(takes)) or "of"
            raise ProblemError(f"{given.of} has no {key}", path=(*path, key), allowed=allowed, key=True)
    name = ""
    if need := NEEDS.get(given.of):
        name = getattr(given, need) or ""
        known = {
            "pair": [pair.name for pair in mobile(linkage).pairs], "link": linkage.moving,
            "point": list(dict.fromkeys(p for link in linkage.moving for p in linkage.links[link].points)),
        }[need]  # fmt: skip
        if not name:
            raise ProblemError(f"the key `{need}` is missing", path=(*path, need), allowed=", ".join(known))
        sense.known(name, dict.fromkeys(known), (*path, need), need)
    for n, link in enumerate(given.links):
        sense.known(link, linkage.links, (*path, "links", n), "link")
    wanted: list[Any] = [sense.vector(v, LENGTH, (*path, "through", n)) for n, v in enumerate(given.through)]
    if given.of == "law":
        dimension = LENGTH if linkage.slides_on_frame(name) else ANGLE
        wanted = [sense.number(v, dimension, (*path, "values", n)) for n, v in enumerate(given.values)]
    places = [_place(v, variant, ways, sense, (*path, "at", n)) for n, v in enumerate(given.at)]
    if given.of in ("path", "law"):
        key = "through" if given.of == "path" else "values"
        if not wanted:
            raise ProblemError(f"the key `{key}` is missing", path=(*path, key), allowed="what is wanted")
        if len(places) != len(wanted) and (places or given.of == "law"):
            raise ProblemError(
                f"as many angles as {key} are wanted", path=(*path, "at"), found=quote(len(places)),
                allowed=str(len(wanted)),
            )  # fmt: skip
    return Goal(
        given.of, name, tuple(given.links), tuple(map(float, places)), tuple(wanted), given.norm, given.relative
    )


def _place(value: Any, variant: Variant, ways: list[Ends], sense: Sense, path: tuple[str | int, ...]) -> float:
    """A place of the driver's way, on all ways that it has at the bounds."""
    turns = variant.linkage.driver.kind == "turn"
    dimension = ANGLE if turns else LENGTH
    place = float(sense.number(value, dimension, path))
    for ends in ways[::-1]:
        found = within(place, ends, turns=turns)
        if found is None and ends is not None:
            low, high = (f"{sense.units.from_si(float(end), dimension):.6g}" for end in ends)
            of = "its stroke" if ends == variant.linkage.driver.stroke else "its way"
            raise ProblemError(
                "the driver does not go there", path=path, found=quote(value),
                allowed=f"a place of {of}, {low} to {high} {sense.units.symbol(dimension)}"
                + (" at a bound of what varies" if len(ways) > 1 else ""),
            )  # fmt: skip
    assert found is not None
    return found  # on the way of the middle of the bounds, which is the first of them


def _bar() -> Callable[[int, int], None]:
    """Progress on a terminal."""
    if not sys.stderr.isatty():
        return lambda at, of: None
    from rich.console import Console
    from rich.progress import Progress

    from tmm_cli.words import say

    bar = Progress(console=Console(stderr=True), transient=True)
    task = bar.add_task(say("synthesis_optimal.searching"))

    def show(at: int, of: int) -> None:
        if at == 0:
            bar.start()
        bar.update(task, completed=at, total=of)
        if at == of:
            bar.stop()

    return show
