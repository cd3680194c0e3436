"""Motion of every named point, centre of mass, link and sliding pair, with transfer functions. Long: a row a position."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from tmm_cli.linkage import FRAME
from tmm_cli.motion import Motion, Point
from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    LENGTH,
    NUMBER,
    SPEED,
    Dimension,
)
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def named_points(results: Results) -> dict[str, tuple[str, complex]]:
    """Every named point of a moving link, once, with its link and place on it."""
    linkage = results.linkage
    return {
        point: (link, local)
        for link in reversed(linkage.moving)
        for point, local in linkage.links[link].points.items()
        if point not in linkage.links[FRAME].points
    }


def mass_centres(results: Results) -> dict[str, tuple[str, complex]]:
    """Centres of mass of the links that have one, named S3 after the link."""
    links = results.linkage.links
    return {f"S{name}": (name, links[name].centre) for name in results.linkage.moving if np.any(links[name].mass != 0)}


def tables(results: Results) -> Iterable[Table]:
    """points, links, slides."""
    if results.motion is None:
        return
    points = dict(sorted(named_points(results).items())) | mass_centres(results)
    yield _long(results, "points", "word.point", points, lambda m, key: _point(m.point(*key)))
    links = {name: name for name in results.linkage.moving}
    yield _long(results, "link-motion", "word.link", links, _link)
    slides = {s.name: s for s in results.linkage.slides}
    if slides:
        yield _long(results, "slides", "word.pair", slides, _slide)


Values = list[tuple[str, Any, Dimension]]


def _point(p: Point) -> Values:
    return [
        ("x", p.x.real, LENGTH), ("y", p.x.imag, LENGTH),
        ("vx", p.v.real, SPEED), ("vy", p.v.imag, SPEED), ("v", np.abs(p.v), SPEED),
        ("ax", p.a.real, ACCELERATION), ("ay", p.a.imag, ACCELERATION), ("a", np.abs(p.a), ACCELERATION),
        ("v1x", p.first.real, NUMBER), ("v1y", p.first.imag, NUMBER),
        ("a1x", p.second.real, NUMBER), ("a1y", p.second.imag, NUMBER),
    ]  # fmt: skip


def _link(motion: Motion, name: str) -> Values:
    t = motion.link(name)
    return [
        ("angle", t.angle, ANGLE), ("omega", t.omega, ANGULAR_SPEED), ("epsilon", t.epsilon, ANGULAR_ACCELERATION),
        ("first", t.first, NUMBER), ("second", t.second, NUMBER),
    ]  # fmt: skip


def _slide(motion: Motion, slide: Any) -> Values:
    s = motion.slide(slide)
    return [
        ("run", s.run, LENGTH), ("vr", s.v, SPEED), ("ar", s.a, ACCELERATION),
        ("kx", s.coriolis.real, ACCELERATION), ("ky", s.coriolis.imag, ACCELERATION),
        ("k", np.abs(s.coriolis), ACCELERATION), ("first", s.first, NUMBER), ("second", s.second, NUMBER),
    ]  # fmt: skip


def _long(
    results: Results, name: str, header: str, things: dict[str, Any], values: Callable[[Motion, Any], Values]
) -> Table:
    """Stack the things' values, position by position."""
    motion = results.motion
    assert motion is not None
    per_thing = [values(motion, key) for key in things.values()]
    count, number = len(results.numbers), len(things)

    def stacked(parts: Sequence[Any]) -> Any:
        return np.stack([np.broadcast_to(p, (count,)) for p in parts], axis=1).ravel()

    columns = [
        Column(c.header, np.repeat(np.asarray(c.values), number).tolist(), c.dimension) for c in driver_columns(results)
    ]
    columns.append(Column(say(header), list(things) * count))
    for k, (symbol, _, dimension) in enumerate(per_thing[0]):
        columns.append(Column(say(f"kinematics.{symbol}"), stacked([p[k][1] for p in per_thing]), dimension))
    return Table(name, say(f"{name}.title"), tuple(columns), long=True)
