"""What went wrong with a file, said once in the file's own terms: from pydantic's errors and from the stages'."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, get_args, get_origin

from pydantic import BaseModel, ValidationError

from tmm_cli.errors import (
    AmbiguousSketchError,
    AssemblyError,
    GroupTooLargeError,
    LinkageError,
    MissingStrokesError,
    MobilityError,
    NotOnFrameError,
    SketchMismatchError,
    UnknownNameError,
    UnknownPositionError,
    _,
)
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError, nearest, quote
from tmm_cli.problem.reader import decimal_comma_hint
from tmm_cli.problem.record import Problem
from tmm_cli.problem.tree import Path, Tree
from tmm_cli.quantities import ANGLE, LENGTH

if TYPE_CHECKING:
    from tmm_cli.structure.assur import Structure

MOST_CHOICES = 4  # points and angles that would tell two assemblies apart are many in a large group
ModelAt = Callable[[Path], type[BaseModel] | None]


def shape_error(error: ValidationError, tree: Tree, model: type[BaseModel], part: Path = ()) -> ProblemError:
    """The first mistake in the shape of a file, by its place; model: the shape of what stands at the path `part`."""
    meant = _meant(_flat(error, part), tree)

    def model_at(path: Path) -> type[BaseModel] | None:
        return _model(model, path[len(part) :]) if path[: len(part)] == part else schema.File

    refusals = [(kind, _refusal(kind, path, context, tree, model_at)) for kind, path, context in meant]
    misspelt = {(*r.path[:-1], r.near) for kind, r in refusals if kind == "extra_forbidden"}
    # a key that stands there misspelt is not missing
    located = [r.located(tree.file, tree) for kind, r in refusals if kind != "missing" or r.path not in misspelt]
    return min(located, key=lambda r: (r.mark.line, r.mark.column) if r.mark else (0, 0))


def _flat(error: ValidationError, prefix: Path) -> Iterable[tuple[str, Path, dict[str, Any]]]:
    for item in error.errors():
        inner = item.get("ctx", {}).get("error")
        if isinstance(inner, ValidationError):
            yield from _flat(inner, (*prefix, *item["loc"]))
        else:
            yield item["type"], (*prefix, *item["loc"]), {**item.get("ctx", {}), "msg": item["msg"]}


def _meant(errors: Iterable[tuple[str, Path, dict[str, Any]]], tree: Tree) -> list[tuple[str, Path, dict[str, Any]]]:
    """Errors with paths into the data; a branch of a union that the data was not meant for is left out."""
    meant: list[tuple[str, Path, dict[str, Any]]] = []
    rest: list[tuple[str, Path, dict[str, Any]]] = []
    for kind, loc, context in errors:
        path: list[str | int] = []
        data: Any = tree.data
        fits = True
        for number, step in enumerate(loc):
            last = number == len(loc) - 1
            if (isinstance(data, dict) and step in data) or (isinstance(data, list) and isinstance(step, int)):
                path.append(step)
                data = _at(data, (step,))
            elif last and kind in ("missing", "extra_forbidden"):
                path.append(step)
            else:  # the name of a union's branch
                fits = fits and isinstance(data, list) == str(step).startswith("list")
        (meant if fits else rest).append((kind, tuple(path), context))
    return meant or rest


def _refusal(kind: str, path: Path, context: dict[str, Any], tree: Tree, model: ModelAt) -> ProblemError:
    data = _at(tree.data, path)
    if kind == "extra_forbidden":
        names = _keys(path[:-1], model)
        key = str(path[-1])
        return ProblemError(
            _("unknown key"), path=path, found=quote(key), allowed=", ".join(names), near=nearest(key, names), key=True
        )
    if kind == "missing":
        return ProblemError(
            _("the key `{path}` is missing").format(path=path[-1]), path=path, allowed=_describe(path, model)
        )
    if kind == "literal_error":
        words = str(context.get("expected", "")).replace("'", "").replace(" or ", ", ")
        described = _describe(path, model) or ""
        return ProblemError(
            _("this word is not known here"), path=path, found=quote(data),
            allowed=described if "[" in described else words,  # a list may stand here too
            near=nearest(str(data), words.split(", ")),
        )  # fmt: skip
    hint = decimal_comma_hint(tree, path)
    message = _words(kind, context)
    return ProblemError(message, path=path, found=quote(data), allowed=hint or _describe(path, model))


def _at(data: Any, path: Path) -> Any:
    """The value at a path, None when it is not in the data."""
    for step in path:
        if isinstance(data, dict):
            data = data.get(step)
        elif isinstance(data, list) and isinstance(step, int) and step < len(data):
            data = data[step]
        else:
            return None
    return data


def _words(kind: str, context: dict[str, Any]) -> str:
    """What is wrong with a value, by pydantic's kind of error."""
    if kind.startswith("int_"):
        return _("a whole number is wanted")
    if kind == "greater_than_equal":
        return _("at least {least} is wanted").format(least=context["ge"])
    if kind == "less_than_equal":
        return _("at most {most} is wanted").format(most=context["le"])
    if kind in ("too_long", "string_too_long"):
        return _("this is too long: at most {most}").format(most=context["max_length"])
    if kind == "too_short" and context["min_length"] > 1:
        return _("{number} are wanted here").format(number=context["min_length"])
    words = {
        "string_type": _("text is wanted"),
        "list_type": _("a list [..., ...] is wanted"),
        "dict_type": _("keys with values are wanted"),
        "model_type": _("keys with values are wanted"),
        "model_attributes_type": _("keys with values are wanted"),
        "too_short": _("there is nothing here"),
    }
    return words.get(kind) or str(context["msg"])


def _model(here: type[BaseModel] | None, path: Path) -> type[BaseModel] | None:
    """The model of what stands at a path inside another."""
    named = False  # whether the next key is one of the user's own names
    for step in path:
        if isinstance(step, int) or here is None or named:
            named = False
            continue
        field = here.model_fields.get(step)
        here = None if field is None else _inside([field.annotation])
        named = field is not None and get_origin(field.annotation) is dict
    return here


def _inside(parts: Iterable[Any]) -> type[BaseModel] | None:
    """The model among the parts of an annotation."""
    for part in parts:
        found = part if isinstance(part, type) and issubclass(part, BaseModel) else _inside(get_args(part))
        if found:
            return found
    return None


def _keys(path: Path, model: ModelAt) -> list[str]:
    here = model(path)
    return [field.alias or name for name, field in here.model_fields.items()] if here else []


def _describe(path: Path, model: ModelAt) -> str | None:
    while path and isinstance(path[-1], int):  # an item is described with its list
        path = path[:-1]
    here = model(path[:-1]) if path else None
    for name, field in here.model_fields.items() if here else ():
        if path[-1] in (name, field.alias):
            return field.description
    return None


def refusal(error: LinkageError, problem: Problem) -> ProblemError:
    """A stage's refusal in the words and at the place of the file."""
    found = _stage_error(error, problem)
    return found.located(problem.file, problem.source) if problem.file else found


def _stage_error(error: LinkageError, problem: Problem) -> ProblemError:
    units = problem.units

    def shown(value: complex | float) -> str:
        if isinstance(value, complex):
            return f"[{units.from_si(value.real, LENGTH):.6g}, {units.from_si(value.imag, LENGTH):.6g}]"
        return f"{units.from_si(value, ANGLE):.6g} {units.symbol(ANGLE)}"

    crank = problem.linkage.driver.kind == "turn"
    at = units.from_si(problem.linkage.sketch.at, ANGLE if crank else LENGTH)
    place = f"{at:.6g} {units.symbol(ANGLE if crank else LENGTH)}"
    match error:
        case MobilityError(structure=structure):
            return mobility(structure)
        case AssemblyError(group=group, residual=residual):
            short = _("it never closes")
            if residual is not None:
                size = f"{units.from_si(residual, LENGTH):.6g} {units.symbol(LENGTH)}"
                short = _("{size} short of closing").format(size=size)
            return ProblemError(
                _("group {group} cannot be assembled with the driver at {place}").format(
                    group=group.title, place=place
                ),
                path=("sketch", "at"), found=short, allowed=_("lengths that reach, or another place of the driver"),
            )  # fmt: skip
        case AmbiguousSketchError(group=group, choices=choices) if choices:
            told = list(choices.items())[:MOST_CHOICES]
            ways = "; ".join(f"{name}: {shown(a)} or {shown(b)}" for name, (a, b) in told)
            undecided = _(
                "the sketch does not say how group {group} is assembled; see tmm kinematics {file} --assemblies"
            ).format(group=group.title, file=problem.file or "FILE")
            return ProblemError(
                undecided, path=("sketch",), key=True,
                allowed=_("with the driver at {place}, {ways}").format(place=place, ways=ways),
            )  # fmt: skip
        case AmbiguousSketchError(group=group):
            return ProblemError(
                _("group {group} is in a dead position in the sketch").format(group=group.title),
                path=("sketch", "at"), found=place, allowed=_("another place of the driver"),
            )  # fmt: skip
        case SketchMismatchError(name=name, sketched=sketched, found=value):
            return ProblemError(
                _("the sketch fits no assembly"), path=("sketch", name), found=shown(sketched),
                allowed=_("about {value} with the driver at {place}").format(value=shown(value), place=place),
            )  # fmt: skip
        case GroupTooLargeError(group=group, most=most):
            return ProblemError(
                _("a group of so many links is not solved: {title}").format(title=group.title), path=("links",),
                found=str(len(group.links)),
                allowed=_("at most {most} in one group; any number of groups").format(most=most), key=True,
            )  # fmt: skip
        case UnknownPositionError(number=number, count=count):
            return ProblemError(
                _("there is no such position"), path=("positions",), found=str(number),
                allowed=_("0 to {last}").format(last=count - 1),
            )  # fmt: skip
        case UnknownNameError(name=name, allowed=allowed):
            return ProblemError(
                _("there is no such point, link or centre of mass"), path=("links",), found=quote(name),
                allowed=", ".join(allowed), near=nearest(name, list(allowed)), key=True,
            )  # fmt: skip
        case NotOnFrameError(link=link, allowed=allowed):
            return ProblemError(
                _("this link cannot drive: it is not joined to the frame"), path=("links",), found=quote(link),
                allowed=", ".join(allowed), near=nearest(link, list(allowed)), key=True,
            )  # fmt: skip
        case MissingStrokesError(link=link, path=path):
            what = _("no output is joined to the frame")
            if link is not None:
                what = _("link {link} has no ends of its stroke").format(link=link)
            return ProblemError(_("there is no working stroke"), path=path, found=what, allowed=_("see output:"))
    return ProblemError(str(error))


def mobility(structure: Structure) -> ProblemError:
    """What a wrong mobility comes from: links that are loose, or pairs that hold what is held already."""
    n, p2, wanted = len(structure.links), structure.higher, len(structure.drivers)
    higher = f" - {p2}" if p2 else ""
    count = f"W = 3*{n} - 2*{len(structure.pairs) - p2}{higher} = {structure.mobility}"
    loose, redundant = structure.under_constrained, structure.redundant_pairs
    held = next((bodies for name, bodies in redundant if name == "driver"), None)
    if not redundant and not loose:
        held = structure.links
    if held is not None:
        number = max((k for k, d in enumerate(structure.drivers) if {d.base, d.link} <= set(held)), default=0)
        return ProblemError(
            _("link {link} cannot be driven: pairs or other drivers hold it already").format(
                link=structure.drivers[number].link
            ),
            path=("driver", number, "link") if wanted > 1 else ("driver", "link"),
            found=_("{count}; over-held: links {links}").format(count=count, links=", ".join(held)),
            allowed=f"W = {wanted}",
        )  # fmt: skip
    if loose:
        return ProblemError(
            _("mobility is not {wanted}: these links are loose: {links}").format(wanted=wanted, links=", ".join(loose)),
            path=("links", loose[0]), found=count,
            allowed=_("W = {wanted}, as many as there are drivers").format(wanted=wanted), key=True,
        )  # fmt: skip
    name, bodies = redundant[0]
    links = tuple(b for b in bodies if b in structure.links)
    return ProblemError(
        _("mobility is not {wanted}: pair {name} holds what is held already").format(wanted=wanted, name=name),
        path=("links", links[0]) if links else ("links",), key=True,
        found=_("{count}; over-held: links {links}").format(count=count, links=", ".join(bodies)),
        allowed=f"W = {wanted}",
    )  # fmt: skip
