"""result.json: everything that was found, in SI and radians. `schema()` documents it.

Arrays have one entry a position, null where a position cannot be reached or is dead. Vectors are two arrays, x and y.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli import asked
from tmm_cli.chain import ChainResults
from tmm_cli.forces.plan import Balance, Reaction, Reactions
from tmm_cli.linkage import Driver
from tmm_cli.motion import Motion, Point
from tmm_cli.pipeline import Results
from tmm_cli.problem.chain import ChainProblem
from tmm_cli.problem.record import Problem
from tmm_cli.results.as_space import chain_json, space_json
from tmm_cli.results.reports.cycle import states
from tmm_cli.results.text import plain
from tmm_cli.results.warnings import warnings
from tmm_cli.strokes import Strokes, output_link
from tmm_cli.structure.assur import ROMAN, Structure
from tmm_cli.structure.contours import classification, contours
from tmm_cli.structure.redundancy import space
from tmm_cli.vectors import Vector

if TYPE_CHECKING:
    from tmm_cli.results.digits import Trusted

FORMAT = 1


def to_json(results: Results | ChainResults, digits: Trusted | None = None) -> dict[str, Any]:
    """The whole content of result.json as plain data; with the section `digits` when all has been judged."""
    return {key: plain(part) for key, part in sections(results, digits)}


def sections(results: Results | ChainResults, digits: Trusted | None = None) -> Iterator[tuple[str, Any]]:
    """The parts of result.json one after the other, with arrays as they are."""
    yield "tmm", FORMAT
    yield "problem", _problem(results.problem)
    if isinstance(results, ChainResults):
        yield "chain", chain_json(results.chain)
        yield "warnings", []
        return
    yield "structure", _structure(results.structure, results)
    yield "space", _space(results)
    if results.synthesis is not None and results.motion is not None:
        from tmm_cli.results.synthesis import to_json as synthesis_json

        yield "synthesis", synthesis_json(results.synthesis, results.measured, long=False)
    yield from numbers(results)
    if digits is not None:
        yield "digits", digits.json()
    if results.assemblies is not None:
        from tmm_cli.results.as_assemblies import assemblies_json

        yield "assemblies", assemblies_json(results.assemblies)
    yield "warnings", list(warnings(results))


def numbers(results: Results, parts: Collection[str] | None = None) -> Iterator[tuple[str, Any]]:
    """What was computed, part by part, as arrays; with `parts` these of the large ones alone."""
    if results.motion is not None:
        yield from _range(results).items()
        yield "positions", _positions(results.motion, results)
        if parts is None or "kinematics" in parts:
            yield "kinematics", _kinematics(results.motion, results)
    if results.reactions is not None and results.lever is not None:
        if parts is None or "forces" in parts:
            yield "forces", _forces(results.reactions, results)
        yield "lever", {
            "balancing": results.lever.balancing,
            "difference": results.lever.difference,
            "limit": results.problem.lever_limit,
            "holds": results.lever_holds,
            "items": [
                {"name": i.name, "link": i.link, "kind": "force" if i.end is not None else "couple",
                 "size": i.size, "arm": i.arm, "moment": i.moment}
                for i in results.lever.items
            ],
        }  # fmt: skip
    if results.energy is not None:
        yield "energy", _energy(results)


def _problem(problem: Problem | ChainProblem) -> dict[str, Any]:
    return {"name": problem.name, "title": problem.title, "description": problem.description}


def _space(results: Results) -> dict[str, Any]:
    structure = results.structure
    return space_json(space(results.linkage, structure), contours(structure.pairs, structure.links))


def _structure(structure: Structure, results: Results) -> dict[str, Any]:
    links = results.linkage.links
    return {
        "mobility": structure.mobility,
        "links": [
            {"name": n, "role": results.roles[n], "label": links[n].label, "points": list(links[n].points)}
            for n in structure.links
        ],
        "pairs": [{"name": p.name, "kind": p.kind, "links": [p.i, p.j], "point": p.point} for p in structure.pairs],
        "true_mobility": structure.mobility + structure.redundant,
        "passive": [
            {"pair": p.pair, "constraints": p.constraints, "links": list(p.links), "among": list(p.among)}
            for p in structure.passive
        ],
        "n": len(structure.links),
        "p1": len(structure.pairs) - structure.higher,
        "p2": structure.higher,
        "contours": structure.contours,
        "classification": list(classification(structure)),
        "formula": structure.formula,
        "class": ROMAN[structure.mechanism_class],
        "groups": [
            {"links": list(g.links), "class": ROMAN[g.grade], "order": g.order, "type": g.type, "name": g.title,
             "inner": [p.name for p in g.inner], "outer": [p.name for p in g.outer]}
            for g in structure.groups
        ],
    }  # fmt: skip


def _range(results: Results) -> dict[str, Any]:
    driver: Driver = results.linkage.driver
    way = results.way
    assert way is not None
    return {
        "driver": {
            "link": driver.link,
            "kind": driver.kind,
            "sense": driver.sense,
            "rate": driver.rate,
            "acceleration": driver.acceleration,
            "full_turn": way.full,
            "range": [way.start, way.end],
            "limits": [{"at": limit.place, "group": limit.group} for limit in way.limits],
        },
        "turns": way.turns,
        **({} if results.of else _quality(results)),
    }


def _quality(results: Results) -> dict[str, Any]:
    strokes = results.strokes
    return {
        "pressure": [
            {"group": p.group, "link": p.link, "pair": p.pair, "slides": p.slides, "largest": p.largest, "at": p.place,
             "allowed": p.allowed, "holds": p.holds, "transmission": p.transmission, "gain": p.gain, "angles": p.angles}
            for p in results.pressure
        ],
        "dead_positions": [{"at": d.place, "group": d.group, "margin": d.margin} for d in results.dead],
        "output": None if strokes is None else _strokes(strokes),
        "further_outputs": [_strokes(further) for further in results.further],
        "travels": [
            {"link": t.link, "kind": t.kind, "low": t.low, "high": t.high, "low_at": t.low_at, "high_at": t.high_at}
            for t in results.travels
        ],
    }  # fmt: skip


def _strokes(strokes: Strokes) -> dict[str, Any]:
    return {
        "link": strokes.link,
        "kind": strokes.kind,
        "travel": strokes.travel if strokes.strokes else None,
        "k": strokes.k if strokes.strokes else None,
        "rule": strokes.rule,
        "strokes": [
            {"start": s.start, "length": s.length, "from": s.low, "run": s.run, "working": s.working}
            | ({"rest": s.rest} if s.rest else {})
            for s in strokes.strokes
        ],
    }  # fmt: skip


def _positions(motion: Motion, results: Results) -> dict[str, Any]:
    return {
        "number": list(results.numbers),
        "driver": motion.q,
        "time": motion.time,
        "rate": motion.rate,
        "placed": motion.placed,
        "moving": motion.moving,
        "state": states(results),
    }


def _kinematics(motion: Motion, results: Results) -> dict[str, Any]:
    linkage, of = results.linkage, results.of
    points, centres = asked.named_points(linkage), asked.mass_centres(linkage)
    if of:
        places = asked.places(linkage, results.kernels, of)
        points = {name: key for name, key in places.items() if name in points}
        centres = {name: key for name, key in places.items() if name not in points}
    links = {}
    for name in asked.links(linkage, of) if of else linkage.moving:
        t = motion.link(name)
        links[name] = {
            "angle": t.angle, "omega": t.omega, "epsilon": t.epsilon, "first": t.first, "second": t.second
        }  # fmt: skip
    slides = {}
    for slide in () if of else linkage.slides:
        s = motion.slide(slide)
        slides[slide.name] = {
            "runner": slide.runner, "carrier": slide.carrier, "run": s.run, "v": s.v, "a": s.a,
            "coriolis": _xy(s.coriolis), "first": s.first, "second": s.second,
        }  # fmt: skip
    margins = {d.group.title: p.margin for d, p in zip(motion.kernels, motion.placements, strict=True)}
    return {
        "output": output_link(linkage, results.structure.groups),
        "points": {name: _point(motion.named(name)) for name, key in points.items()},
        "centres": {name: _point(motion.point(*key)) for name, key in centres.items()},
        "links": links,
        "slides": slides,
        "margins": margins,
    }


def _point(p: Point) -> dict[str, Any]:
    return {"x": _xy(p.x), "v": _xy(p.v), "a": _xy(p.a), "first": _xy(p.first), "second": _xy(p.second)}


def _xy(vector: Vector) -> dict[str, Any]:
    return {"x": vector.real, "y": vector.imag}


def _forces(reactions: Reactions, results: Results) -> dict[str, Any]:
    return {
        "loads": [
            {"name": load.name, "kind": load.kind, "link": load.link, "force": _xy(load.force), "moment": load.moment}
            for load in reactions.applied
        ],
        "reactions": {r.pair.name: _reaction(r) for r in reactions.all},
        "compound_hinges": _pins(reactions, results),
        "balancing": _balancing(reactions.balance),
        "drivers": {b.driver.link: _balancing(b) for b in reactions.balances},
    }


def _balancing(balance: Balance) -> dict[str, Any]:
    return {
        "kind": balance.kind,
        "moment": balance.moment,
        "force": balance.force,
        "vector": _xy(balance.vector),
        "at": _xy(balance.at),
    }


def _energy(results: Results) -> dict[str, Any]:
    found = results.energy
    assert found is not None
    energy: dict[str, Any] = {field.name: getattr(found, field.name) for field in fields(found)}
    if results.friction is not None:
        energy["locked"] = results.friction.locked
    if results.losses is not None:
        energy["efficiency"] = results.losses.efficiency
        energy["friction_work"] = dict(results.losses.pairs)
    return energy


def _reaction(r: Reaction) -> dict[str, Any]:
    found: dict[str, Any] = {
        "on": r.on, "by": r.by, "force": _xy(r.force), "size": np.abs(r.force), "angle": np.angle(r.force),
        "at": _xy(r.at),
    }  # fmt: skip
    if r.tangential is not None and r.normal is not None:
        found |= {"tangential": _xy(r.tangential), "normal": _xy(r.normal)}
    if r.couple is not None:
        found |= {"signed": r.signed, "couple": r.couple, "arm": r.arm}
    return found


def _pins(reactions: Reactions, results: Results) -> dict[str, Any]:
    """At a compound hinge, what the pin does to each link (however the hinge is counted as pairs)."""
    found = {}
    for hinge in results.linkage.hinges:
        if len(hinge.links) < 3:
            continue
        pairs = [r for r in reactions.all if r.pair.kind == "R" and r.pair.point == hinge.point]
        found[hinge.point] = {
            link: _xy(np.sum([r.onto(link) for r in pairs if link in (r.on, r.by)], axis=0)) for link in hinge.links
        }
    return found
