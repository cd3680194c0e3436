"""Force plans of one position: the closed force polygon of each Assur group and of each driving link.

The groups are taken from the last to the first, as in a course project.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tmm_cli.mechanics.forces import (
    GroupForces,
    LoadedPosition,
    Reaction,
    Reactions,
    Symbol,
    VectorKind,
    balance_symbol,
    component_across,
    external_pairs,
    load_symbols,
    reaction_symbol,
    vector_kind,
)
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.plans.named_vectors import NamedVector, Plan

PolygonPart = tuple[Symbol, complex, VectorKind]


@dataclass(frozen=True)
class ForcePlan:
    """Closed force polygon of an Assur group or of a driving link.

    Attributes:
        links: the links that are cut free together.
        plan: the vectors of the polygon.
        driving: True for a driving link on the frame.
        full: whole vectors of the reactions that are resolved in the polygon, from the start of the first
            component to the end of the second.
    """

    links: tuple[str, ...]
    plan: Plan
    driving: bool = False
    full: tuple[NamedVector, ...] = ()


def force_plans(reactions: Reactions, k: int, motion: Motion | None = None) -> tuple[ForcePlan, ...]:
    """Return the force polygons at position k: those of the Assur groups from the last to the first, then the driving
    links.

    motion: if it is given, hinge reactions in external pairs are resolved into components for groups of any class, not
    only for dyads.
    """
    position = None if motion is None else LoadedPosition.at(motion, reactions, k)
    groups = [_group_plan(group, reactions, k, position) for group in reversed(reactions.groups)]
    return (*groups, *(_driving_link_plan(frame, reactions, k) for frame in reactions.frames))


def _group_plan(group: GroupForces, reactions: Reactions, k: int, position: LoadedPosition | None) -> ForcePlan:
    """Build the force polygon of a group of any class, link by link, from the external forces.

    Internal reactions cancel, so they are not drawn.
    """
    if len(group.group.links) == 2 and len(group.outer) == 2 and len(group.inner) == 1 and not group.group.drivers:
        return _dyad_plan(group, reactions, k)
    axes = {} if position is None else {lead.pair.name: lead.axis for lead in external_pairs(position, group.group)}
    parts: list[PolygonPart] = []
    parted: list[tuple[Reaction, int]] = []
    for link in group.group.links:
        parts += _borne_forces(group.borne, reactions, group.group.links, link, k)
        for r in (r for r in group.outer if r.on == link):
            force, axis = complex(r.force[k]), axes.get(r.pair.name)
            if axis is None:
                parts.append((reaction_symbol(r.by, r.on), force, "reaction"))
                continue
            across = component_across(force, axis)
            parted.append((r, len(parts)))
            parts.append((reaction_symbol(r.by, r.on, "τ"), across, "tangential"))
            parts.append((reaction_symbol(r.by, r.on, "n"), force - across, "normal"))
    plan = _polygon(parts)
    full = tuple(_whole_reaction(r, plan.vectors[at : at + 2]) for r, at in parted)
    return ForcePlan(group.group.links, plan, full=full)


def _dyad_plan(group: GroupForces, reactions: Reactions, k: int) -> ForcePlan:
    """Build the force polygon of a dyad.

    The tangential components and the loads come first; normal components or guide reactions close the polygon. The
    forces on each link are consecutive, so one more vector, the internal reaction, closes the polygon of each link.
    """
    first, last = group.outer
    a, b = group.group.links
    parts_a = [*_tangential_part(first, "τ", k), *_borne_forces(group.borne, reactions, (a, b), a, k)]
    parts_b = [*_borne_forces(group.borne, reactions, (a, b), b, k), *_tangential_part(last, "τ", k)]
    closing_b, closing_a = list(_closing_part(last, k)), list(_closing_part(first, k))
    plan = _polygon([*closing_a, *parts_a, *parts_b, *closing_b])
    corner = plan.vectors[len(closing_a) + len(parts_a) - 1].end if closing_a or parts_a else 0j
    inner = group.inner[0]
    force = complex(inner.onto(b)[k])
    # the forces on b lead from this corner back to the start, so the internal reaction on b leads from the start to it
    symbol = reaction_symbol(inner.pair.other(b), b)
    joined = NamedVector(symbol.name, corner - force, corner, "inner", symbol)
    ends = ((first, plan.vectors[:2]), (last, plan.vectors[-2:]))
    full = tuple(_whole_reaction(reaction, parts) for reaction, parts in ends if reaction.tangential is not None)
    return ForcePlan((a, b), Plan((*plan.vectors, joined)), full=full)


def _whole_reaction(reaction: Reaction, parts: Sequence[NamedVector]) -> NamedVector:
    """Join two consecutive components of a reaction in the polygon to the vector of the whole reaction."""
    symbol = reaction_symbol(reaction.by, reaction.on)
    return NamedVector(symbol.name, parts[0].start, parts[-1].end, "reaction", symbol)


def _driving_link_plan(frame: Reaction, reactions: Reactions, k: int) -> ForcePlan:
    link = frame.on
    parts = [*_borne_forces(reactions.borne[link], reactions, (link,), link, k), *_closing_part(frame, k)]
    return ForcePlan((link,), _polygon(parts), driving=True)


def _tangential_part(reaction: Reaction, mark: str, k: int) -> Iterable[PolygonPart]:
    if reaction.tangential is not None:
        yield reaction_symbol(reaction.by, reaction.on, mark), complex(reaction.tangential[k]), "tangential"


def _closing_part(reaction: Reaction, k: int) -> Iterable[PolygonPart]:
    """Yield the vector of an external reaction that is drawn last.

    It is the normal component in a hinge, or the whole reaction of a guide.
    """
    if reaction.normal is not None:
        yield reaction_symbol(reaction.by, reaction.on, "n"), complex(reaction.normal[k]), "normal"
    else:
        yield reaction_symbol(reaction.by, reaction.on), complex(reaction.force[k]), "reaction"


def _borne_forces(
    borne: tuple[Reaction, ...], reactions: Reactions, links: tuple[str, ...], link: str, k: int
) -> Iterable[PolygonPart]:
    """Yield the known forces on a link: reactions of later groups, loads, and driving forces.

    Args:
        borne: reactions of later groups.
        reactions: the force solution.
        links: all links of the polygon; the force of a driver between two of them is internal and left out.
        link: the link.
        k: index of the position.
    """
    for reaction in borne:
        if reaction.by == link:
            yield reaction_symbol(reaction.on, link), complex(reaction.onto(link)[k]), "reaction"
    for load in reactions.applied:
        if load.link == link and load.has_force:
            yield load_symbols(load)[0], complex(load.force[k]), vector_kind(load)
    several = len(reactions.balances) > 1
    for balance in reactions.balances:
        driven, base = balance.driver.link, balance.driver.base
        if balance.kind == "force" and link in (driven, base) and not {driven, base} <= {*links}:
            symbol, vector = balance_symbol(driven, several), complex(balance.vector[k])
            if link != driven:
                symbol, vector = symbol.primed, -vector
            yield symbol, vector, "load"


def _polygon(parts: Iterable[PolygonPart]) -> Plan:
    at, vectors = 0j, []
    for symbol, value, kind in parts:
        vectors.append(NamedVector(symbol.name, at, at + value, kind, symbol))
        at += value
    return Plan(tuple(vectors))
