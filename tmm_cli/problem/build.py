"""Building of problems from files that have been read: names are resolved and numbers are converted to SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from importlib import import_module
from itertools import count
from typing import TYPE_CHECKING, Any, TypeVar, cast

from pydantic import BaseModel, ValidationError

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import FRAME, Link, Linkage, Mesh, Output
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.mechanics.structure import PAIR_FREEDOMS, SpatialChain, SpatialPair, links_joined_to_frame
from tmm_cli.problem import schema
from tmm_cli.problem.blocks.drivers import build_cycle, build_drivers, build_request, build_sketch
from tmm_cli.problem.blocks.elements import build_elements
from tmm_cli.problem.blocks.friction import build_friction
from tmm_cli.problem.blocks.links import build_links, refuse_attachments, refuse_unused
from tmm_cli.problem.blocks.loads import build_loads
from tmm_cli.problem.blocks.masses import add_masses
from tmm_cli.problem.blocks.meshes import build_meshes
from tmm_cli.problem.errors import Path, ProblemError, Tree, locate_errors_in, prefix_errors
from tmm_cli.problem.parameters import resolve_parameters
from tmm_cli.problem.problems import ChainProblem, Problem, TaskProblem
from tmm_cli.problem.schema_errors import shape_error
from tmm_cli.problem.schema_types import MAX_LINKS
from tmm_cli.problem.units import ExtendedUnits, PhysicalValue, UnitSystem
from tmm_cli.problem.values import FileSection, ValueReader, check_name
from tmm_cli.problem.work_limits import refuse_work

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import WheelTask


TASK_READER = "tmm_cli.synthesis.reading"  # reads the block synthesis, which stands above the problem


Model = TypeVar("Model", bound=BaseModel)


def is_chain(tree: Tree) -> bool:
    """Return True if the file describes a spatial chain by its pairs (structure.spatial), not a planar linkage."""
    structure = tree.data.get("structure")
    named = isinstance(structure, dict) and "spatial" in structure
    return named or ("structure" in tree.data and "links" not in tree.data)


def build_problem(tree: Tree, *, extended: bool = False) -> Problem:
    """Build the problem of a file without a synthesis task (for files with a task see synthesis.reading).

    Args:
        tree: content of the file.
        extended: compute with double-double numbers, about 31 digits.

    Raises:
        ProblemError: the file is wrong.
    """
    shape = validate_planar(tree)
    with locate_errors_in(tree):
        units = build_unit_system(shape.units, extended=extended)
        problem = build_from_shape(shape, tree, ValueReader(build_parameters(shape.parameters, units), units))
    return replace(problem, extended=partial(build_problem, tree, extended=True))


def validate_planar(tree: Tree) -> schema.File:
    """Validate the keys of a file with a planar linkage.

    Raises:
        ProblemError: a key or value is wrong, or the file describes a spatial chain.
    """
    if is_chain(tree):
        raise ProblemError(
            _("this file contains only links and pairs, without dimensions: only the structure can be analysed"),
            path=("structure",),
            allowed=_("tmm structure, tmm run, tmm check"),
            key=True,
        ).located(tree.file, tree)
    return validate_shape(schema.File, tree)


def validate_shape(model: type[Model], tree: Tree) -> Model:
    """Validate the keys of a file against a pydantic model and return an instance of the model.

    Raises:
        ProblemError: a key or value is wrong; the error contains line and column.
    """
    try:
        return model.model_validate(tree.data)
    except ValidationError as error:
        raise shape_error(error, tree, model) from None


def build_unit_system(names: Mapping[str, str], *, extended: bool = False) -> UnitSystem:
    """Build the unit system of a file from its block `units`.

    Args:
        names: unit by kind of quantity, e.g. `{length: mm}`.
        extended: use double-double numbers, about 31 digits.

    Raises:
        ProblemError: a kind or unit is unknown.
    """
    with prefix_errors("units"):
        return ExtendedUnits(names) if extended else UnitSystem(names)


def build_parameters(
    raw: Mapping[str, object], units: UnitSystem, known: Mapping[str, PhysicalValue] | None = None
) -> dict[str, PhysicalValue]:
    """Evaluate the parameters of a file.

    Args:
        raw: numbers or expressions of the file, by parameter name.
        units: units of numbers that are written without a unit.
        known: values of further parameters that the expressions may use.

    Raises:
        ProblemError: an expression is wrong.
    """
    with prefix_errors("parameters"):
        return resolve_parameters(raw, units, known)


def _refuse_frame_of_a_link(shape: schema.File, links: Mapping[str, Link]) -> None:
    """Refuse a number of the frame (key `frame`) that is already the number of a link or roller."""
    taken = {*links, *(cam.roller for cam in shape.cams.values() if cam.roller)}
    if shape.frame != FRAME and shape.frame in taken:
        free = next(number for number in count(1) if str(number) not in taken)
        raise ProblemError(
            _("a link already has this number"),
            found=shape.frame,
            path=("frame",),
            allowed=_("a number that no link has, e.g. {number}").format(number=free),
        )


def build_from_shape(shape: schema.File, tree: Tree, values: ValueReader) -> Problem:
    """Build the problem from validated keys, in the order in which the blocks depend on one another.

    Args:
        shape: validated keys of the file.
        tree: content of the file.
        values: reader of values, with the parameters and units of the file.

    Raises:
        ProblemError: a value is wrong; the error contains no line and column.
    """
    members = build_links(shape, values)
    _refuse_frame_of_a_link(shape, members.links)
    refuse_unused(shape, tree.data, members)
    links = members.links
    first, *others = build_drivers(shape, members, values)
    meshes: tuple[Mesh, ...] = ()
    if shape.gears or shape.racks or shape.cams:  # few files have any, and only those import what reads them
        meshes = build_meshes(shape, members, first.sense, values)
    outputs = _build_outputs(shape, links, values)
    linkage = Linkage(
        links,
        members.hinges,
        members.slides,
        first,
        build_sketch(shape, links, first, values),
        output=outputs[0] if outputs else None,
        others=tuple(others),
        meshes=meshes,
        outputs=outputs,
        keep_side=shape.change_points == "keep side",
        turns=build_cycle(shape, first, values),
    )
    refuse_attachments(linkage, shape, values)
    linkage = add_masses(linkage, shape, values)
    linkage = replace(linkage, loads=build_loads(linkage, shape, values))
    elements, friction = build_elements(linkage, shape, values), build_friction(linkage, shape, values)
    linkage = replace(linkage, elements=elements, friction=friction)
    checks = FileSection(shape.checks, ("checks",), values)
    _refuse_law_with_table(shape)
    limit = values.fraction(shape.checks.lever, checks.at("lever"), zero=True)
    angles, limits_set = list(Problem.pressure_limits), [False, False]
    for number, key in enumerate(("pressure_sliding", "pressure_turning")):
        if getattr(shape.checks, key) is not None:
            angles[number], limits_set[number] = checks.positive(key, ANGLE), True
    name = tree.name
    request = build_request(shape, first, values)
    refuse_work(linkage, request)
    first_driver = shape.driver if isinstance(shape.driver, schema.DriverKeys) else shape.driver[0]
    return Problem(
        name,
        shape.title or name,
        linkage,
        request,
        values.units,
        limit,
        shape.description,
        tree.file,
        (angles[0], angles[1]),
        (limits_set[0], limits_set[1]),
        has_bare_speed(first_driver, values),
        shape.sheet,
        shape.note,
        _build_optional_task("dynamics", shape, linkage, values),
        _build_optional_task("balancing", shape, linkage, values),
        shape.reference,
        shape.shows,
        values,
        tree,
        wheels=_build_wheel_tasks(shape, tree, linkage, values),
    )


def has_bare_speed(driver: schema.DriverKeys, values: ValueReader) -> bool:
    """Return True if the speed of the driver is given without a unit."""
    speeds = [row[1] for row in driver.speed.table] if isinstance(driver.speed, schema.Speeds) else [driver.speed]
    return any(values.is_bare(speed) for speed in speeds if speed != 0)  # rest is rest in any unit


def _refuse_law_with_table(shape: schema.File) -> None:
    """Refuse a table of speeds together with the block `dynamics`. Raises ProblemError.

    Variants and optimal synthesis allow neither of the two.
    """
    by_table = isinstance(shape.driver, schema.DriverKeys) and isinstance(shape.driver.speed, schema.Speeds)
    if by_table and shape.dynamics is not None:
        raise ProblemError(
            _(
                "a table of speeds and the block `dynamics` exclude each other: the law of motion is either given "
                "or computed"
            ),
            path=("driver", "speed"),
            key=True,
            allowed=_("a single speed together with `dynamics`"),
        )
    searched = isinstance(shape.synthesis, dict) and shape.synthesis.get("task") == "optimal"
    if searched or shape.grading is not None or shape.variants is not None:
        refuse_variable_speed(by_table, shape.dynamics is not None)


def refuse_variable_speed(by_table: bool, dynamics: bool) -> None:
    """Refuse a table of speeds or the block `dynamics` where only a constant speed or acceleration is supported.

    Args:
        by_table: True if the file gives the speed by a table.
        dynamics: True if the file has the block `dynamics`.

    Raises:
        ProblemError: one of the two is present.
    """
    if by_table or dynamics:
        raise ProblemError(
            _(
                "for variants and optimization, give the motion of the driver by one speed and one acceleration, "
                "without tables and without `dynamics`"
            ),
            key=True,
            path=("driver", "speed") if by_table else ("dynamics",),
            allowed=_("speed: 82 rpm"),
        )


def _build_optional_task(block: str, shape: schema.File, linkage: Linkage, values: ValueReader) -> Any:
    """Build the task of a block that few files have; return None if the file does not have this block.

    The code for the block is imported only if it is needed.
    """
    if getattr(shape, block) is None:
        return None
    module = import_module("tmm_cli.problem.blocks.optional_blocks")
    return getattr(module, f"build_{block}")(shape, linkage, values)


def _build_wheel_tasks(shape: schema.File, tree: Tree, linkage: Linkage, values: ValueReader) -> tuple[WheelTask, ...]:
    """Build the tasks of intermittent motion.

    There are none if the problem is built with double-double numbers, because intermittent motion is computed in
    ordinary floating-point numbers only.
    """
    if not shape.intermittent or isinstance(values.units, ExtendedUnits):
        return ()

    def other(settings: Mapping[str, object]) -> Linkage:
        """Build the linkage with other parameter values; if the file has a synthesis task, its solution is not
        recomputed.
        """
        task_results = {name: value for name, value in values.parameters.items() if name not in shape.parameters}
        parameters = build_parameters({**shape.parameters, **settings}, values.units, task_results)
        alone = shape.model_copy(update={"intermittent": {}})
        return build_from_shape(alone, tree, ValueReader(parameters, values.units)).linkage

    module = import_module("tmm_cli.problem.blocks.optional_blocks")  # few files have the block
    wheels: tuple[WheelTask, ...] = module.build_wheels(shape, linkage, values, other)
    return wheels


def _build_outputs(shape: schema.File, links: Mapping[str, Link], values: ValueReader) -> tuple[Output, ...]:
    moving = [name for name in links if name != FRAME]
    outputs = cast("list[schema.OutputKeys]", shape.output)  # as its validator left it
    paths: list[Path] = [("output", number) if len(outputs) > 1 else ("output",) for number in range(len(outputs))]
    points = [p for name in moving for p in links[name].points if p not in links[FRAME].points and p not in moving]
    built: list[Output] = []
    for output_keys, path in zip(outputs, paths, strict=True):
        if output_keys.link in points:
            built += [Output(f"{output_keys.link}.{axis}", output_keys.working) for axis in "xy"]
        else:
            link = values.known_name(output_keys.link, dict.fromkeys([*moving, *points]), path, "link or point")
            built.append(Output(link, output_keys.working))
    return tuple(built)


def build_any_problem(tree: Tree) -> Problem | TaskProblem:
    """Build the problem of a file with or without a synthesis task.

    Raises:
        ProblemError: the file is wrong.
    """
    if "synthesis" not in tree.data:
        return build_problem(tree)
    read: TaskProblem = import_module(TASK_READER).read(tree)  # few files have a task
    return read


def early_parameters(tree: Tree) -> dict[str, PhysicalValue]:
    """Evaluate the parameters of a file with a synthesis task, except those that depend on the solution of the task.

    Raises:
        ProblemError: an expression is wrong.
    """
    early: dict[str, PhysicalValue] = import_module(TASK_READER).TaskFile(tree).independent
    return early


SPATIAL: Path = ("structure", "spatial")
WITHOUT_PARAMETERS = ValueReader({}, UnitSystem())


def build_chain(tree: Tree) -> ChainProblem:
    """Build the problem of a file that describes a spatial chain.

    Raises:
        ProblemError: the file is wrong; the error contains line and column.
    """
    shape = validate_shape(schema.SpatialFile, tree)
    name = tree.name
    spatial = shape.structure.spatial
    with locate_errors_in(tree):
        chain = _build_spatial_chain(spatial)
        if spatial.output is not None:
            WITHOUT_PARAMETERS.known_name(spatial.output, chain.links, (*SPATIAL, "output"), "moving link")
        return ChainProblem(
            name,
            shape.title or name,
            chain,
            spatial.output,
            _local_freedoms(spatial, chain),
            spatial.wanted,
            WITHOUT_PARAMETERS.units,
            shape.description,
            shape.reference,
            shape.shows,
            tree,
        )


def _build_spatial_chain(spatial: schema.Spatial) -> SpatialChain:
    links = _chain_links(spatial)
    pairs = []
    for name, pair in spatial.pairs.items():
        section = FileSection(pair, (*SPATIAL, "pairs", name), WITHOUT_PARAMETERS)
        check_name(name, section.path, "pair")
        i, j = section.two_links((FRAME, *links))
        section.one_of("kind", "freedoms")
        pairs.append(
            SpatialPair(name, i, j, PAIR_FREEDOMS[pair.kind] if pair.kind else pair.freedoms or 0, pair.kind or "")
        )
    chain = SpatialChain(links, tuple(pairs))
    joined = links_joined_to_frame(chain.pairs)
    if apart := [link for link in links if link not in joined]:  # W would count a chain of its own
        message = _("no chain of pairs joins link {link} to the frame").format(link=apart[0])
        raise ProblemError(message, path=(*SPATIAL, "pairs"), key=True)
    return chain


def _chain_links(spatial: schema.Spatial) -> tuple[str, ...]:
    links = spatial.links
    if isinstance(links, int):
        return tuple(str(number) for number in range(1, links + 1))
    if links is None:
        named = dict.fromkeys(link for pair in spatial.pairs.values() for link in pair.between if link != FRAME)
        for name, pair in spatial.pairs.items():
            for number, link in enumerate(pair.between):
                check_name(link, (*SPATIAL, "pairs", name, "between", number), "link")
        if len(named) > MAX_LINKS:
            raise ProblemError(
                _("there are too many links"),
                path=(*SPATIAL, "pairs"),
                found=str(len(named)),
                allowed=_("at most {max_links}").format(max_links=MAX_LINKS),
            )
        return tuple(named)
    for number, link in enumerate(links):
        check_name(link, (*SPATIAL, "links", number), "link", (FRAME, *links[:number]))
    return tuple(links)


def _local_freedoms(spatial: schema.Spatial, chain: SpatialChain) -> int | None:
    if not isinstance(spatial.local, dict):
        return spatial.local
    for link in spatial.local:
        WITHOUT_PARAMETERS.known_name(link, chain.links, (*SPATIAL, "local", link), "moving link", key=True)
    return sum(spatial.local.values())
