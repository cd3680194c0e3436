"""Motion of named points, centres of mass, links and sliding pairs, with transfer functions; a row a position."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.asked import links as asked_links
from tmm_cli.asked import mass_centres, named_points
from tmm_cli.asked import places as asked_places
from tmm_cli.linkage import Slide
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
from tmm_cli.vectors import pi


def tables(results: Results) -> Iterable[Table]:
    """points, links, slides."""
    motion = results.motion
    if motion is None:
        return
    linkage, of = results.linkage, results.of
    points = dict(sorted(named_points(linkage).items())) | mass_centres(linkage)
    if of:
        points = dict(asked_places(linkage, results.kernels, of))
    if points:
        hinges = named_points(linkage)
        values = [_point(motion.named(n) if n in hinges else motion.point(*key)) for n, key in points.items()]
        yield long_table(results, "points", {"word.point": list(points)}, values)
    links = asked_links(linkage, of) if of else linkage.moving
    if links:
        yield long_table(results, "link-motion", {"word.link": links}, [_link(motion, name) for name in links])
    slides = () if of else linkage.slides
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
    half = pi(t.angle)
    angle = t.angle - 2 * half * np.ceil((t.angle - half) / (2 * half))  # -180 to 180 deg, the driver's too
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
