"""Keys of an optimal synthesis, read into an OptimalTask."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.batch import Range, TracedNumber, Two, Variant, bounds_text
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import list_quantities
from tmm_cli.mechanics.assembly import analyse_mobile_structure
from tmm_cli.mechanics.errors import MobilityError
from tmm_cli.mechanics.quantities import ANGLE, DIMENSIONS, LENGTH
from tmm_cli.problem import (
    Name,
    Path,
    PhysicalValue,
    Problem,
    ProblemError,
    Strict,
    UnitSystem,
    Value,
    ValueReader,
    VariedUnits,
    Vector,
    mobility_error,
    quote,
    unknown_name_error,
)
from tmm_cli.synthesis.blocks import TaskBlock, TriedFileError
from tmm_cli.synthesis.optimal import task
from tmm_cli.synthesis.optimal.quantities import QUANTITIES
from tmm_cli.synthesis.optimal.quantities.base import MechanismQuantity
from tmm_cli.synthesis.optimal.quantities.named import NAMED
from tmm_cli.synthesis.optimal.ranges import FileWith, read_over, read_position, read_ranges, with_driver_range
from tmm_cli.synthesis.optimal.task import OptimalTask, Parameter, nearest_allowed

SEARCH = True  # it evaluates the linkage for other parameters, and takes long
MOST_PARAMETERS = 20  # parameters
DriverTargets = tuple[tuple[Any, ...], tuple[Any, ...]]  # driver coordinates, and the values required there


if TYPE_CHECKING:
    QuantityName = str
else:
    QuantityName = Literal[tuple(QUANTITIES)]


class QuantityKeys(Strict):
    """Keys that specify a quantity of the mechanism."""

    of: QuantityName | Annotated[str, Field(max_length=100)] = Field(
        description=(
            "quantity to be evaluated, e.g. length (sum of link lengths), box (width + height of the area of "
            "motion), margin (distance from dead positions); or a quantity by its name, e.g. a of E, R_34"
        )
    )
    over: Literal["largest", "least", "range"] | None = Field(
        default=None,
        description="for a quantity by its name: what is taken of its values over the range of the driver",
    )
    pair: Name | None = Field(default=None, description="pair whose reaction is evaluated")
    point: Name | None = Field(default=None, description="point whose path is evaluated")
    link: Name | None = Field(default=None, description="link whose law of motion is evaluated")
    links: list[Name] = Field(
        default_factory=list, max_length=100, description="for length: links whose lengths are added; default: all"
    )
    through: list[Vector] = Field(default_factory=list, max_length=200, description="required points of the path")
    values: list[Value] = Field(
        default_factory=list,
        max_length=200,
        description="required angles or displacements of the link; may depend on varied parameters",
    )
    at: list[Value] = Field(
        default_factory=list,
        max_length=200,
        description="driver coordinates at which these values are required; may depend on varied parameters",
    )
    relative: bool = Field(default=False, description="for law: values are measured from the first one")
    norm: Literal["least squares", "largest"] = "least squares"


class ObjectiveKeys(QuantityKeys):
    """Keys of the objective: a quantity that is minimised (a margin: maximised) or brought close to a target value."""

    target: Value | None = Field(
        default=None, description="value that the objective should approach, instead of being minimised"
    )


class ConstraintKeys(QuantityKeys):
    """Keys of a constraint: a quantity and its bounds."""

    least: Value | None = None
    most: Value | None = None
    equal: Value | None = None


def _expand_short(quantity: Any) -> Any:
    return {"of": quantity} if isinstance(quantity, str) else quantity


class OptimalBlock(TaskBlock):
    """Keys of the task `optimal`: the varied parameters with their bounds, the objective, and the constraints."""

    task: Literal["optimal"]
    vary: dict[Name, Range] = Field(
        min_length=1,
        max_length=MOST_PARAMETERS,
        description=(
            "range of each parameter, by its name: [low, high]; {from, to, step}; or {among: [...]}. A number "
            "without a unit has the unit of that parameter in the file: for a length, the unit of length of "
            "the file"
        ),
    )
    objective: Annotated[ObjectiveKeys, BeforeValidator(_expand_short)]
    constraints: list[ConstraintKeys] = Field(default_factory=list, max_length=30)
    over: Literal["cycle", "stroke", "positions"] | Two | None = Field(
        default=None,
        description="range of the driver: cycle, stroke (of the driver), positions (of the file), or [from, to]",
    )
    positions: int = Field(
        default=72,
        ge=12,
        le=720,
        description=(
            "number of positions per cycle during the search; at least 24 per revolution are used if the cycle "
            "has several revolutions"
        ),
    )
    population: int = Field(default=0, ge=0, le=2000, description="candidates per generation; 0 means 20 per parameter")
    generations: int = Field(
        default=0,
        ge=0,
        le=20_000,
        description="number of generations; 0 means 25 times the square of the number of parameters",
    )
    seed: int = Field(default=1, ge=0, le=2**32 - 1)


BLOCK = OptimalBlock


def parameters(block: OptimalBlock) -> dict[str, str]:
    """Return the names of the varied parameters, all with the provisional kind `length`.

    The actual kinds are determined when the bounds are read.
    """
    return dict.fromkeys(block.vary, "length")


def read(block: OptimalBlock, reader: ValueReader, file_with: FileWith) -> OptimalTask:
    """Convert the keys of the task to an OptimalTask in SI and radians.

    Args:
        block: validated keys.
        reader: reader of numbers with units.
        file_with: function that builds the problem with given parameter values and units.

    Raises:
        ProblemError: a key is invalid.
    """
    parameters = read_ranges(block.vary, reader, block.names, file_with)
    files = _FileVariants(parameters, block, reader, file_with)
    middles = nearest_allowed([(p.low + p.high) / 2 for p in parameters], parameters).tolist()
    files.over = read_over(block.over, files.build_problem(middles).linkage.driver, reader)
    middle = with_driver_range(files.build_problem(middles), files.over)
    _check_mobility(middle)
    for k, parameter in enumerate(parameters):
        for end in (parameter.low, parameter.high):
            files.build_variant([*middles[:k], end, *middles[k + 1 :]])
    constraints = tuple(
        _read_constraint(keys, middle, reader, n, files.read_targets(keys, ("constraints", n), middles, middle))
        for n, keys in enumerate(block.constraints)
    )
    targets = files.read_targets(block.objective, ("objective",), middles, middle)
    objective, target = _read_quantity(block.objective, middle, reader, ("objective",), targets), block.objective.target
    if target is not None:
        target = reader.number(target, DIMENSIONS[_find_kind(objective, middle)].dimension, ("objective", "target"))
    return OptimalTask(
        parameters,
        files.build_variant,
        objective,
        constraints,
        target,
        block.positions,
        block.population,
        block.generations,
        block.seed,
        files.accepts,
        _make_progress_bar(),
    )


class _FileVariants:
    """Builder of variants of the problem file with other values of the varied parameters.

    The values are in SI. They may also be objects (TracedNumber) that record the operations performed on them, so that
    the calculation can be repeated.
    """

    def __init__(
        self, parameters: Sequence[Parameter], block: OptimalBlock, reader: ValueReader, file_with: FileWith
    ) -> None:
        self.parameters, self.names, self.file_with = parameters, block.names, file_with
        self.units, self.varied = reader.units, VariedUnits(reader.units)
        self.own = reader.parameters
        self.over: Any = None
        self.goals: list[tuple[Path, QuantityKeys]] = [(("objective",), block.objective)]
        self.goals += [(("constraints", n), keys) for n, keys in enumerate(block.constraints)]

    def build_problem(self, numbers: Sequence[Any]) -> Problem:
        """Build the problem with these parameter values (SI). Raises TriedFileError."""
        return self.file_with(*self._make_parameters(numbers))

    def _make_parameters(self, numbers: Sequence[Any]) -> tuple[dict[str, PhysicalValue], UnitSystem]:
        parameters = {
            self.names.get(p.name, p.name): PhysicalValue(x, DIMENSIONS[p.kind].dimension)
            for p, x in zip(self.parameters, numbers, strict=True)
        }
        return parameters, self.varied if any(isinstance(x, TracedNumber) for x in numbers) else self.units

    def read_targets(self, keys: QuantityKeys, path: Path, numbers: Sequence[Any], variant: Variant) -> DriverTargets:
        """Return the driver coordinates and required values of a quantity. Both may depend on the varied parameters.

        Args:
            keys: keys of the quantity.
            path: path of the quantity in the block.
            numbers: values of the varied parameters (SI).
            variant: the linkage with these values.

        Returns:
            Driver coordinates, and the values required of a link there (SI, rad); zeros if the quantity has none.

        Raises:
            ProblemError: a value is invalid.
        """
        parameters, units = self._make_parameters(numbers)
        reader, linkage = ValueReader({**self.own, **parameters}, units), variant.linkage
        coordinates = tuple(read_position(v, variant, reader, (*path, "at", n)) for n, v in enumerate(keys.at))
        if not keys.values or keys.link not in linkage.moving:
            return coordinates, (0.0,) * len(coordinates)
        dimension = ANGLE if linkage.output_swings(keys.link) else LENGTH
        return coordinates, tuple(reader.number(v, dimension, (*path, "values", n)) for n, v in enumerate(keys.values))

    def build_variant(self, numbers: Sequence[Any]) -> Variant:
        """Build the variant of the linkage with these parameter values (SI).

        Raises:
            TriedFileError: the file is invalid with these values; the message contains them.
            ProblemError: a driver coordinate or required value of the task is invalid.
        """
        try:
            variant = with_driver_range(self.build_problem(numbers), self.over)
            targets = [self.read_targets(keys, path, numbers, variant) for path, keys in self.goals]
            coordinates, required = (tuple(chain.from_iterable(column)) for column in zip(*targets, strict=True))
            return replace(variant, asked=coordinates, wanted=required)
        except TriedFileError as error:
            refused, texts = copy(error.error), []
            for p, number in zip(self.parameters, numbers, strict=True):
                value, dimension = getattr(number, "value", number), DIMENSIONS[p.kind].dimension
                text = f"{self.units.from_si(float(value), dimension):.6g} {self.units.symbol(dimension)}"
                texts.append(f"{p.name} = {text.rstrip()}")
            refused.message = _("with {numbers} the problem file is invalid: {reason}").format(
                numbers=", ".join(texts), reason=refused.message
            )
            raise TriedFileError(refused) from None

    def accepts(self, numbers: Sequence[float]) -> bool:
        """Return True if the file is valid with these parameter values (SI)."""
        try:
            self.build_variant(numbers)
        except (TriedFileError, ProblemError):
            return False
        return True


def _check_mobility(variant: Variant) -> None:
    """Raise ProblemError if the linkage has redundant constraints.

    Such a linkage moves only with exact dimensions, so that a varied parameter would lock it.
    """
    try:
        analyse_mobile_structure(variant.linkage)
    except MobilityError as refusal:
        described = mobility_error(refusal.structure)
        raise ProblemError(
            _("with every parameter in the middle of its bounds, {reason}").format(reason=described.message),
            path=("vary",),
            found=described.found,
            allowed=described.allowed,
        ) from None


def _read_constraint(
    keys: ConstraintKeys, variant: Variant, reader: ValueReader, n: int, targets: DriverTargets
) -> task.QuantityConstraint:
    path: Path = ("constraints", n)
    quantity = _read_quantity(keys, variant, reader, path, targets)
    dimension = DIMENSIONS[_find_kind(quantity, variant)].dimension
    sides = {
        key: reader.number(value, dimension, (*path, key))
        for key in ("least", "most", "equal")
        if (value := getattr(keys, key)) is not None
    }
    if not sides or ("equal" in sides and len(sides) > 1):
        raise ProblemError(
            _("a constraint must have a bound"), path=path, allowed=_("least or most, or both; or equal"), key=True
        )
    least, most = (sides.get(key, sides.get("equal")) for key in ("least", "most"))
    if least is not None and most is not None and least > most:
        raise ProblemError(
            _("the lower bound exceeds the upper bound"), path=path, found=bounds_text(keys.least, keys.most)
        )
    return task.QuantityConstraint(quantity, least, most, (*path, list(sides)[-1]))


def _find_kind(quantity: MechanismQuantity, variant: Variant) -> str:
    return quantity.kind(variant.linkage, analyse_mobile_structure(variant.linkage).solved)


def _read_quantity(
    keys: QuantityKeys, variant: Variant, reader: ValueReader, path: Path, targets: DriverTargets
) -> MechanismQuantity:
    if keys.of not in QUANTITIES:
        return _read_named(keys, variant, path)
    linkage, kind, name = variant.linkage, QUANTITIES[keys.of], ""
    coordinates, values = targets
    others = {"over", *(key for other in QUANTITIES.values() for key in other.keys)} - {*kind.keys}
    for key in keys.model_fields_set & others:
        raise ProblemError(
            _("the quantity {quantity} has no key {key}").format(quantity=keys.of, key=key),
            path=(*path, key),
            allowed=", ".join(sorted(kind.keys)) or "of",
            key=True,
        )
    for needed in (kind.named, kind.given):
        if needed and not getattr(keys, needed):
            raise ProblemError(_("the key `{key}` is missing").format(key=needed), path=(*path, needed))
    if kind.named:
        name = getattr(keys, kind.named)
        names: dict[str, list[str]] = {
            "pair": [pair.name for pair in analyse_mobile_structure(linkage).pairs],
            "link": list(linkage.moving),
            "point": [point for link in linkage.moving for point in linkage.links[link].points],
        }
        reader.known_name(name, dict.fromkeys(names[kind.named]), (*path, kind.named), kind.named)
    for n, link in enumerate(keys.links):
        reader.known_name(link, linkage.links, (*path, "links", n), "link")
    required: list[Any] = [reader.vector(v, LENGTH, (*path, "through", n)) for n, v in enumerate(keys.through)]
    required = list(values) if keys.values else required
    if len(coordinates) != len(required) and (coordinates or keys.values):
        raise ProblemError(
            _("the keys `at` and `{key}` must have the same number of values").format(key=kind.given),
            path=(*path, "at"),
            found=quote(len(coordinates)),
            allowed=str(len(required)),
        )
    return kind(name, tuple(keys.links), coordinates, tuple(required), keys.norm, keys.relative)


def _read_named(keys: QuantityKeys, variant: Variant, path: Path) -> MechanismQuantity:
    """Read an objective or constraint that is the largest value, smallest value or range of a quantity given by its
    name.
    """
    linkage = variant.linkage
    quantities = {
        name: quantity
        for name, quantity in list_quantities(linkage, analyse_mobile_structure(linkage)).items()
        if not quantity.whole and quantity.against != "angle" and not name.startswith("arm of ")
    }
    if keys.of not in quantities:
        examples = _("{names}; or a quantity of the mechanism in every position, e.g. v of E").format(
            names=", ".join(QUANTITIES)
        )
        message = _("there is no quantity with this name")
        raise unknown_name_error(keys.of, [*QUANTITIES, *quantities], message, examples, path=(*path, "of"))
    for key in keys.model_fields_set - {"of", "over", "target", "least", "most", "equal"}:
        raise ProblemError(
            _("the quantity {quantity} has no key {key}").format(quantity=keys.of, key=key),
            path=(*path, key),
            allowed="over",
            key=True,
        )
    quantity = quantities[keys.of]
    kind = NAMED[keys.over or "largest", quantity.stage in ("forces", "balance")]
    return kind(keys.of, quantity=quantity)


def _make_progress_bar() -> Callable[[int, int], None]:
    """Return a function that shows the progress of the search on a terminal; elsewhere it does nothing."""
    if not sys.stderr.isatty():
        return lambda at, total: None
    from rich.console import Console
    from rich.progress import Progress

    bar = Progress(console=Console(stderr=True), transient=True)
    task = bar.add_task(_("generations"))

    def show(at: int, total: int) -> None:
        if at == 0:
            bar.start()
        bar.update(task, completed=at, total=total)
        if at == total:
            bar.stop()

    return show
