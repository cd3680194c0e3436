"""What went wrong with a file, said once in the file's own terms: from pydantic's errors and from the stages'."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel, ValidationError

from tmm_cli.problem import schema, schema_chain, schema_more
from tmm_cli.problem.errors import Path, ProblemError, nearest, quote
from tmm_cli.problem.reader import Tree, decimal_comma_hint
from tmm_cli.problem.record import Problem
from tmm_cli.problem.units import ANGLE, LENGTH
from tmm_cli.refused import (
    Misfit,
    NoAssembly,
    NoStrokes,
    NoSuchName,
    NoSuchPosition,
    NotOnFrame,
    Refused,
    TooLarge,
    Undecided,
    WrongMobility,
)
from tmm_cli.structure.assur import Group, Structure

MOST_CHOICES = 4  # points and angles that would tell two assemblies apart are many in a large group
ANY = object()
MODELS: tuple[tuple[tuple[Any, ...], type[BaseModel]], ...] = (
    ((), schema.File),
    (("structure",), schema_chain.SpatialStructure),
    (("structure", "spatial"), schema_chain.Spatial),
    (("structure", "spatial", "pairs", ANY), schema_chain.SpatialPair),
    (("guides", ANY), schema.Guide),
    (("links", ANY), schema.Link),
    (("links", ANY, "slides"), schema.Slide),
    (("links", ANY, "slides", ANY), schema.Slide),
    (("driver",), schema.Driver),
    (("driver", ANY), schema.Driver),
    (("gears", ANY), schema_more.Gear),
    (("racks", ANY), schema_more.Rack),
    (("cams", ANY), schema_more.Cam),
    (("cams", ANY, "law", ANY), schema_more.CamPiece),
    (("springs", ANY), schema_more.Spring),
    (("friction",), schema_more.Friction),
    (("friction", "pairs", ANY), schema_more.PairFriction),
    (("masses", ANY), schema.Mass),
    (("loads", ANY), schema.Load),
    (("loads", ANY, "force"), schema.Tabulated),
    (("loads", ANY, "moment"), schema.Tabulated),
    (("output",), schema.Output),
    (("positions",), schema.Positions),
    (("checks",), schema.Checks),
)

WORDS = {
    "int_type": "a whole number is wanted",
    "int_parsing": "a whole number is wanted",
    "int_from_float": "a whole number is wanted",
    "string_type": "text is wanted",
    "list_type": "a list [..., ...] is wanted",
    "dict_type": "keys with values are wanted",
    "model_type": "keys with values are wanted",
    "model_attributes_type": "keys with values are wanted",
}


def shape_error(error: ValidationError, tree: Tree) -> ProblemError:
    """The first mistake of the file's shape, by its place in the file."""
    meant = _meant(_flat(error, ()), tree)
    refusals = [(kind, _refusal(kind, path, context, tree)) for kind, path, context in meant]
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


def _refusal(kind: str, path: Path, context: dict[str, Any], tree: Tree) -> ProblemError:
    data = _at(tree.data, path)
    if kind == "extra_forbidden":
        names = _keys(path[:-1], tree)
        if len(path) == 1 and "structure" in tree.data:
            names = list(schema_chain.SpatialFile.model_fields)
        key = str(path[-1])
        return ProblemError(
            "unknown key", path=path, found=quote(key), allowed=", ".join(names), near=nearest(key, names), key=True
        )
    if kind == "missing":
        return ProblemError(f"the key `{path[-1]}` is missing", path=path, allowed=_describe(path, tree))
    if kind == "literal_error":
        words = str(context.get("expected", "")).replace("'", "").replace(" or ", ", ")
        described = _describe(path, tree) or ""
        return ProblemError(
            "this word is not known here", path=path, found=quote(data),
            allowed=described if "[" in described else words,  # a list may stand here too
            near=nearest(str(data), words.split(", ")),
        )  # fmt: skip
    hint = decimal_comma_hint(tree, path)
    message = WORDS.get(kind) or _limits(kind, context) or str(context["msg"])
    return ProblemError(message, path=path, found=quote(data), allowed=hint or _describe(path, tree))


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


def _limits(kind: str, context: dict[str, Any]) -> str | None:
    if kind == "greater_than_equal":
        return f"at least {context['ge']} is wanted"
    if kind == "less_than_equal":
        return f"at most {context['le']} is wanted"
    if kind in ("too_long", "string_too_long"):
        return f"this is too long: at most {context['max_length']}"
    if kind == "too_short":
        return f"{context['min_length']} are wanted here" if context["min_length"] > 1 else "there is nothing here"
    return None


def _model(path: Path, tree: Tree) -> type[BaseModel] | None:
    if path[:1] == ("synthesis",):
        from tmm_cli.problem.synthesis import model as inside

        return inside(tree.data["synthesis"], path[1:])
    for pattern, model in MODELS:
        if len(pattern) == len(path) and all(p is ANY or p == s for p, s in zip(pattern, path, strict=True)):
            return model
    return None


def _keys(path: Path, tree: Tree) -> list[str]:
    model = _model(path, tree) or schema.OnLine
    return [field.alias or name for name, field in model.model_fields.items()]


def _describe(path: Path, tree: Tree) -> str | None:
    while path and isinstance(path[-1], int):  # an item is described with its list
        path = path[:-1]
    model = _model(path[:-1], tree) if path else None
    if model is None:
        return None
    for name, field in model.model_fields.items():
        if path[-1] in (name, field.alias):
            return field.description
    return None


def refusal(error: Refused, problem: Problem) -> ProblemError:
    """A stage's refusal in the words and at the place of the file."""
    found = _stage_error(error, problem)
    return found.located(problem.file, problem.source) if problem.file else found


def _stage_error(error: Refused, problem: Problem) -> ProblemError:
    units = problem.units

    def shown(value: complex | float) -> str:
        if isinstance(value, complex):
            return f"[{units.from_si(value.real, LENGTH):.6g}, {units.from_si(value.imag, LENGTH):.6g}]"
        return f"{units.from_si(value, ANGLE):.6g} {units.symbol(ANGLE)}"

    crank = problem.linkage.driver.kind == "turn"
    at = units.from_si(problem.linkage.sketch.at, ANGLE if crank else LENGTH)
    place = f"{at:.6g} {units.symbol(ANGLE if crank else LENGTH)}"
    match error:
        case WrongMobility(structure=structure):
            return mobility(structure)
        case NoAssembly(group=group, gap=gap):
            short = f"{units.from_si(gap, LENGTH):.6g} {units.symbol(LENGTH)} short of closing"
            if group.type in ("PRP", "RPP"):
                short = "their guides are parallel"
            return ProblemError(
                f"{_group(group)} cannot be assembled with the driver at {place}",
                path=("sketch", "at"), found=short, allowed="lengths that reach, or another place of the driver",
            )  # fmt: skip
        case Undecided(group=group, choices=choices, count=count) if choices:
            told = list(choices.items())[:MOST_CHOICES]
            ways = "; ".join(f"{name}: {shown(a)} or {shown(b)}" for name, (a, b) in told)
            listing = f"tmm kinematics {problem.file or 'FILE'} --assemblies"
            return ProblemError(
                f"the sketch does not say which way round {_group(group)} {_are(group)} assembled; {listing} lists all",
                path=("sketch",), found=f"{count} assemblies" if count > 2 else None,
                allowed=f"with the driver at {place}, {ways}", key=True,
            )  # fmt: skip
        case Undecided(group=group):
            return ProblemError(
                f"{_group(group)} {_are(group)} in a dead position in the sketch", path=("sketch", "at"),
                found=place, allowed="another place of the driver, where the two assemblies differ",
            )  # fmt: skip
        case Misfit(name=name, sketched=sketched, found=value):
            return ProblemError(
                "the sketch fits no assembly", path=("sketch", name), found=shown(sketched),
                allowed=f"about {shown(value)} with the driver at {place}",
            )  # fmt: skip
        case TooLarge(group=group, most=most):
            return ProblemError(
                f"a group of so many links is not solved: {group.title}", path=("links",), found=str(len(group.links)),
                allowed=f"at most {most} in one group; any number of groups", key=True,
            )  # fmt: skip
        case NoSuchPosition(number=number, count=count):
            return ProblemError(
                "there is no such position", path=("positions",), found=str(number), allowed=f"0 to {count - 1}"
            )
        case NoSuchName(name=name, allowed=allowed):
            return ProblemError(
                "there is no such point, link or centre of mass", path=("links",), found=quote(name),
                allowed=", ".join(allowed), near=nearest(name, list(allowed)), key=True,
            )  # fmt: skip
        case NotOnFrame(link=link, allowed=allowed):
            return ProblemError(
                "this link cannot drive: it is not joined to the frame", path=("links",), found=quote(link),
                allowed=", ".join(allowed), near=nearest(link, list(allowed)), key=True,
            )  # fmt: skip
        case NoStrokes(link=link, path=path):
            what = "no output is joined to the frame" if link is None else f"link {link} has no ends of its stroke"
            return ProblemError("there is no working stroke", path=path, found=what, allowed="see output:")
    return ProblemError(str(error))


def mobility(structure: Structure) -> ProblemError:
    """What a wrong mobility comes from: links that are loose, or pairs that hold what is held already."""
    n, p2, wanted = len(structure.links), structure.higher, len(structure.drivers)
    higher = f" - {p2}" if p2 else ""
    count = f"W = 3*{n} - 2*{len(structure.pairs) - p2}{higher} = {structure.mobility}"
    stuck = next((bodies for name, bodies in structure.idle if name == "driver"), None)
    if stuck is not None and (structure.loose or wanted > 1):
        number, driver = [(k, d) for k, d in enumerate(structure.drivers) if {d.base, d.link} <= set(stuck)][-1]
        loose = f"; {_listed(structure.loose)} loose" if structure.loose else ""
        return ProblemError(
            f"link {driver.link} cannot be driven: {'other drivers and pairs hold' if wanted > 1 else 'pairs hold'} it "
            "already", path=("driver", number, "link") if wanted > 1 else ("driver", "link"),
            found=f"{count}; over-held: links {', '.join(stuck)}{loose}",
            allowed=f"W = {wanted}, and " + ("drivers on links" if wanted > 1 else "a driver on a link")
            + " that can still move",
        )  # fmt: skip
    if structure.loose:
        links = structure.loose
        more = structure.freedom > wanted and not structure.idle
        driven = "as one link is driven" if wanted == 1 else f"as {wanted} links are driven"
        return ProblemError(
            f"mobility is not {wanted}: {_listed(links)} loose", path=("links", links[0]), found=count,
            allowed=f"W = {wanted}, {driven}" + (f"; or {structure.freedom} drivers" if more else ""), key=True,
        )  # fmt: skip
    name, bodies = structure.idle[0] if structure.idle else ("driver", structure.links)
    if name == "driver":
        return ProblemError(
            f"mobility is not {wanted}: the driver cannot move, its links are a truss", path=("driver", "link"),
            found=f"{count}; over-held: links {', '.join(bodies)}", allowed=f"W = {wanted}",
        )  # fmt: skip
    links = tuple(b for b in bodies if b in structure.links)
    return ProblemError(
        f"mobility is not {wanted}: pair {name} holds what is held already",
        path=("links", links[0]) if links else ("links",),
        found=f"{count}; over-held: links {', '.join(bodies)}", allowed=f"W = {wanted}", key=True,
    )  # fmt: skip


def _listed(links: tuple[str, ...]) -> str:
    return f"link {links[0]} is" if len(links) == 1 else f"links {', '.join(links)} are"


def _group(group: Group) -> str:
    """links 2 and 3, group II(2,3)."""
    return f"link{'s' if len(group.links) > 1 else ''} {_and(group.links)}, group {group.title},"


def _are(group: Group) -> str:
    return "are" if len(group.links) > 1 else "is"


def _and(links: tuple[str, ...]) -> str:
    return ", ".join(links[:-1]) + f" and {links[-1]}" if len(links) > 1 else links[0]
