"""Refusals of linkages that do not move as their drivers want, or are not assembled as sketched."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from tmm_cli.errors import (
    AmbiguousSketchError,
    AssemblyError,
    GroupTooLargeError,
    MobilityError,
    SketchMismatchError,
)
from tmm_cli.language import _
from tmm_cli.linkage import Linkage
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.record import Problem
from tmm_cli.problem.refusals.wording import shown, worded
from tmm_cli.quantities import LENGTH, place_dimension
from tmm_cli.structure.assur import Structure

MOST_CHOICES = 4  # points and angles that would tell two assemblies apart are many in a large group


def _driver_at(problem: Problem) -> str:
    """Where the driver stands in the sketch."""
    return problem.units.told(problem.linkage.sketch.at, place_dimension(problem.linkage.driver.kind))


@worded.register
def _never_closes(error: AssemblyError, problem: Problem) -> ProblemError:
    short = _("it never closes")
    if error.residual is not None:
        short = _("{size} short of closing").format(size=problem.units.told(error.residual, LENGTH))
    return ProblemError(
        _("group {group} cannot be assembled with the driver at {place}").format(
            group=error.group.title, place=_driver_at(problem)
        ),
        path=("sketch", "at"), found=short, allowed=_("lengths that reach, or another place of the driver"),
    )  # fmt: skip


@worded.register
def _ambiguous(error: AmbiguousSketchError, problem: Problem) -> ProblemError:
    group, place, units = error.group.title, _driver_at(problem), problem.units
    if not error.choices:
        return ProblemError(
            _("group {group} is in a dead position in the sketch").format(group=group),
            path=("sketch", "at"), found=place, allowed=_("another place of the driver"),
        )  # fmt: skip
    told = list(error.choices.items())[:MOST_CHOICES]
    ways = "; ".join(f"{name}: {shown(a, units)} or {shown(b, units)}" for name, (a, b) in told)
    undecided = _(
        "the sketch does not say how group {group} is assembled; see tmm kinematics {file} --assemblies"
    ).format(group=group, file=problem.file or "FILE")
    return ProblemError(
        undecided, path=("sketch",), key=True,
        allowed=_("with the driver at {place}, {ways}").format(place=place, ways=ways),
    )  # fmt: skip


@worded.register
def _no_such_assembly(error: SketchMismatchError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("the sketch fits no assembly"), path=("sketch", error.name), found=shown(error.sketched, problem.units),
        allowed=_("about {value} with the driver at {place}").format(
            value=shown(error.found, problem.units), place=_driver_at(problem)
        ),
    )  # fmt: skip


@worded.register
def _too_large(error: GroupTooLargeError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("a group of so many links is not solved: {title}").format(title=error.group.title), path=("links",),
        found=str(len(error.group.links)),
        allowed=_("at most {most} in one group; any number of groups").format(most=error.most), key=True,
    )  # fmt: skip


@worded.register
def _immobile(error: MobilityError, problem: Problem) -> ProblemError:
    lone = _lone_ends(problem.linkage, error.structure.under_constrained)
    hint = _("point {point} is on link {link} alone; a hinge on the frame: points: {{{point}: [x, y]}}")
    return mobility(error.structure, [hint.format(point=point, link=link) for link, point in lone[:1]])


def _lone_ends(linkage: Linkage, loose: Collection[str]) -> list[tuple[str, str]]:
    """Loose links whose origin, or with fewer than two pairs any point, makes no pair; each with that point."""
    runners = {s.runner for s in linkage.slides}
    pairs = [h.links for h in linkage.hinges] + [(s.carrier, s.runner) for s in linkage.slides]
    hinges = {h.point for h in linkage.hinges}
    lone = []
    for name in loose:
        link = linkage.links[name]
        few = sum(name in links for links in pairs) < 2
        free = [p for k, p in enumerate(link.points) if p not in hinges and (few or k == 0)]
        if free and name not in runners:
            lone.append((name, free[0]))
    return lone


def mobility(structure: Structure, hints: Sequence[str] = ()) -> ProblemError:
    """The refusal of a wrong mobility: links that are loose (with hints what holds them), or over-held ones."""
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
            allowed="; ".join([_("W = {wanted}, as many as there are drivers").format(wanted=wanted), *hints]),
            key=True,
        )  # fmt: skip
    name, bodies = redundant[0]
    links = tuple(b for b in bodies if b in structure.links)
    return ProblemError(
        _("mobility is not {wanted}: pair {name} holds what is held already").format(wanted=wanted, name=name),
        path=("links", links[0]) if links else ("links",), key=True,
        found=_("{count}; over-held: links {links}").format(count=count, links=", ".join(bodies)),
        allowed=f"W = {wanted}",
    )  # fmt: skip
