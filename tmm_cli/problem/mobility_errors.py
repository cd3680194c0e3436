"""Error for a wrong mobility, with the links that cause it."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.structure import Structure
from tmm_cli.problem.errors import ProblemError


def list_loose_ends(linkage: Linkage, loose: Collection[str]) -> list[tuple[str, str]]:
    """List points that form no pair, of the links `loose`, which have too much freedom, as (link, point).

    The point is the origin of the link or, if the link has fewer than two pairs, any of its points.
    """
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


def mobility_error(structure: Structure, hints: Sequence[str] = ()) -> ProblemError:
    """Return the error for a wrong mobility.

    It names the links that have too much freedom, or those that have redundant constraints.

    Args:
        structure: result of the structural analysis.
        hints: sentences on how to mend the file.
    """
    n, p2, required = len(structure.links), structure.higher, len(structure.drivers)
    higher = f" - {p2}" if p2 else ""
    count = f"W = 3*{n} - 2*{len(structure.pairs) - p2}{higher} = {structure.mobility}"
    loose, redundant = structure.under_constrained, structure.redundant_pairs
    held = next((bodies for name, bodies in redundant if name == "driver"), None)
    if not redundant and not loose:
        held = structure.links
    if held is not None:
        number = max((k for k, d in enumerate(structure.drivers) if {d.base, d.link} <= set(held)), default=0)
        return ProblemError(
            _("link {link} cannot be a driver: pairs or other drivers already determine its motion").format(
                link=structure.drivers[number].link
            ),
            path=("driver", number, "link") if required > 1 else ("driver", "link"),
            found=_("{count}; links with redundant constraints: {links}").format(count=count, links=", ".join(held)),
            allowed=f"W = {required}",
        )
    if loose:
        return ProblemError(
            _("the mobility is not {wanted}: these links are not sufficiently constrained: {links}").format(
                wanted=required, links=", ".join(loose)
            ),
            path=("links", loose[0]),
            found=count,
            allowed="; ".join([_("W = {wanted}, the number of drivers").format(wanted=required), *hints]),
            key=True,
        )
    name, bodies = redundant[0]
    links = tuple(b for b in bodies if b in structure.links)
    return ProblemError(
        _("the mobility is not {wanted}: pair {name} adds redundant constraints").format(wanted=required, name=name),
        path=("links", links[0]) if links else ("links",),
        key=True,
        found=_("{count}; links with redundant constraints: {links}").format(count=count, links=", ".join(bodies)),
        allowed=f"W = {required}",
    )
