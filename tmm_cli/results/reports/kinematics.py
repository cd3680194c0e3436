"""Motion of named points, centres of mass, links and sliding pairs, with transfer functions; a row a position."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.linkage import FRAME, Slide
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
)
from tmm_cli.results.reports.long import Values, long_table
from tmm_cli.results.table import Table


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
    motion = results.motion
    if motion is None:
        return
    points = {name: motion.named(name) for name in sorted(named_points(results))}
    points |= {name: motion.point(*key) for name, key in mass_centres(results).items()}
    yield long_table(results, "points", {"word.point": list(points)}, [_point(p) for p in points.values()])
    links = results.linkage.moving
    yield long_table(results, "link-motion", {"word.link": links}, [_link(motion, name) for name in links])
    slides = results.linkage.slides
    if slides:
        words = {"word.pair": [s.name for s in slides]}
        yield long_table(results, "slides", words, [_slide(motion, slide) for slide in slides])


def _point(p: Point) -> Values:
    return [
        ("kinematics.x", p.x.real, LENGTH),
        ("kinematics.y", p.x.imag, LENGTH),
        ("kinematics.vx", p.v.real, SPEED),
        ("kinematics.vy", p.v.imag, SPEED),
        ("kinematics.v", np.abs(p.v), SPEED),
        ("kinematics.ax", p.a.real, ACCELERATION),
        ("kinematics.ay", p.a.imag, ACCELERATION),
        ("kinematics.a", np.abs(p.a), ACCELERATION),
        ("kinematics.v1x", p.first.real, NUMBER),
        ("kinematics.v1y", p.first.imag, NUMBER),
        ("kinematics.a1x", p.second.real, NUMBER),
        ("kinematics.a1y", p.second.imag, NUMBER),
    ]


def _link(motion: Motion, name: str) -> Values:
    t = motion.link(name)
    angle = t.angle - 2 * np.pi * np.ceil((t.angle - np.pi) / (2 * np.pi))  # -180 to 180 deg, the driver's too
    return [
        ("kinematics.angle", angle, ANGLE),
        ("kinematics.omega", t.omega, ANGULAR_SPEED),
        ("kinematics.epsilon", t.epsilon, ANGULAR_ACCELERATION),
        ("kinematics.first", t.first, NUMBER),
        ("kinematics.second", t.second, NUMBER),
    ]


def _slide(motion: Motion, slide: Slide) -> Values:
    s = motion.slide(slide)
    return [
        ("kinematics.run", s.run, LENGTH),
        ("kinematics.vr", s.v, SPEED),
        ("kinematics.ar", s.a, ACCELERATION),
        ("kinematics.kx", s.coriolis.real, ACCELERATION),
        ("kinematics.ky", s.coriolis.imag, ACCELERATION),
        ("kinematics.k", np.abs(s.coriolis), ACCELERATION),
        ("kinematics.first", s.first, NUMBER),
        ("kinematics.second", s.second, NUMBER),
    ]
