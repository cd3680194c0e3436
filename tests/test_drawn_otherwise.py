"""A mechanism drawn otherwise moves and bears as before: with friction, loads that resist, strokes, on the whole bank.

The sign of what resists a motion comes from the sign of a speed. Where nothing moves that sign is rounding, and each
drawing of the same mechanism rounds in its own way.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bank import EVERY, problem
from random_linkages import any_linkage
from transforms import mirrored, moved, renamed, reversed_in_time, turned, with_other_axes

from tmm_cli.mechanics.analysis import Inputs, motion_at_positions, solve, with_forces
from tmm_cli.mechanics.forces import solve_reactions
from tmm_cli.mechanics.kinematics import output_run
from tmm_cli.mechanics.linkage import FRAME, Friction, Load, Output, Request, Sketch

BY, ASIDE = 0.7, 0.3 - 0.2j  # rad, m
CLOSE = 1e-9  # of the largest there is
CHAINS = [
    (1, ("III", "gear"), "crank"),
    (1, ("IV",), "cylinder"),
    (1, ("VI", "cam"), "crank"),
    (1, ("III", "swinging follower"), "swinging cylinder"),
    (1, ("rack", "RPP"), "cylinder"),
    (3, ("cylinder", "RRP"), "crank"),
    (1, ("arm", "RPR"), "cylinder"),
    (2, ("RRR", "PRP", "RPR"), "crank"),
    (3, ("cylinder", "arm", "III"), "crank"),
    (4, ("RRP", "RPP", "RRR"), "crank"),
]


def solved(linkage, request):
    return with_forces(solve(Inputs(linkage, request), "kinematics"), cycle=False)


def rubbing(linkage):
    """With friction in all sliding pairs and hinges of two links; pairs of compound hinges are not named alike."""
    size = max(abs(p - q) for x in linkage.links.values() for p in x.points.values() for q in x.points.values()) or 1.0
    hinges = [Friction(hinge.point, 0.03, 0.02 * size) for hinge in linkage.hinges if len(hinge.links) == 2]
    return replace(linkage, friction=(*hinges, *(Friction(slide.name, 0.03) for slide in linkage.slides)))


def key(pair, names=None, points=None):
    """What tells a pair from others in both drawings."""
    ends = frozenset(names[link] if names else link for link in (pair.i, pair.j))
    place = pair.slide.name if pair.slide else pair.mesh.name if pair.mesh else ""
    return ends, pair.kind, place or (points[pair.point] if points else pair.point)


def same(one, other, scale):
    assert np.allclose(one, other, rtol=0, atol=CLOSE * scale, equal_nan=True)


def alike(one, other, names, points, *, sense, spin, shift=0j):
    """The two results agree; sense: of angles (-1 for the mirror image), spin: what the drawing does to a vector."""
    m, n = one.motion, other.motion
    links = m.linkage.moving
    assert np.array_equal(m.moving, n.moving)
    for part in ("x", "v", "a"):
        values = {link: getattr(m.centre(link), part) for link in links}
        scale = max(np.nanmax(np.abs(v), initial=0) for v in values.values()) + 1e-3
        for link, value in values.items():
            aside = shift if part == "x" else 0
            same(spin(value) + aside, getattr(n.centre(names[link]), part), scale)
    fastest = 1e-3
    for part in ("omega", "epsilon"):
        values = {link: getattr(m.link(link), part) for link in links}
        scale = max(np.nanmax(np.abs(v), initial=0) for v in values.values()) + fastest
        fastest = scale**2  # what rotates with a steady speed has no other scale of epsilon
        for link, value in values.items():
            same(sense * value, getattr(n.link(names[link]), part), scale)
    assert np.array_equal(one.locked, other.locked)
    compound = {hinge.point for hinge in m.linkage.hinges if len(hinge.links) > 2}
    strongest = max(np.nanmax(np.abs(r.force), initial=0) for r in one.reactions.all) + 1e-3
    others = {key(r.pair): r for r in other.reactions.all}
    for r in one.reactions.all:
        if r.pair.point not in compound:
            same(spin(r.force), others[key(r.pair, names, points)].onto(names[r.on]), strongest)
    balances = {b.driver.link: b for b in other.reactions.balances}
    for b in one.reactions.balances:
        drive = balances[names[b.driver.link]].generalized
        same(b.generalized * (sense if b.driver.kind == "turn" else 1), drive, strongest)
    if one.strokes is not None and one.strokes.strokes:
        assert other.strokes.travel == pytest.approx(one.strokes.travel, rel=1e-10)
        assert other.strokes.k == pytest.approx(one.strokes.k, abs=1e-10 + doubt_of_k(one))


def doubt_of_k(results):
    """Uncertainty of k: an end of a stroke is a zero of the slope, less sure the flatter the output lies there."""
    ends = motion_at_positions(results, np.array([stroke.start for stroke in results.strokes.strokes]))
    bend = np.abs(output_run(ends, results.strokes.link)[2])
    return 10 * np.sum(np.minimum(1e-3, 1e-13 * results.strokes.travel / (bend + 1e-300)))


def as_drawn(name):
    """A problem of the bank at three positions, its working stroke named, with friction in its pairs."""
    linkage = problem(name).linkage
    linkage = replace(linkage, driver=replace(linkage.driver, law=None))
    results = solve(Inputs(linkage, Request(3, linkage.sketch.at + 0.4)), "kinematics")
    if results.strokes is not None and results.strokes.strokes:
        working = "forward" if results.strokes.strokes[0].run > 0 else "backward"
        linkage = replace(linkage, output=Output(results.strokes.link, working))
    there = motion_at_positions(results, np.array([linkage.sketch.at]), 0)
    points = {point: complex(there.spot(point)[0]) for point in linkage.moving_points}
    angles = {link: float(np.angle(there.poses[link].z[0])) for link in linkage.moving}
    return rubbing(replace(linkage, sketch=Sketch(linkage.sketch.at, points, angles))), results.asked


def mirror_of_output(linkage):
    """Its working stroke runs the other way where it swings."""

    def other(output):
        if output.link not in linkage.links or not linkage.output_swings(output.link):
            return output
        back = {"forward": "backward", "backward": "forward"}
        return replace(output, working=back.get(output.working, output.working))

    outputs = tuple(other(output) for output in linkage.outputs)
    return replace(linkage, output=linkage.output and other(linkage.output), outputs=outputs)


@pytest.mark.parametrize("name", EVERY)
def test_a_problem_of_the_bank_drawn_otherwise(name):
    """Mirrored and turned where nothing is counted from the axes of the drawing, moved, with other axes in its links,
    its links, points and pairs renamed and in another order."""
    linkage, places = as_drawn(name)
    one = solved(linkage, Request(places=tuple(places)))
    by_axes = any(load.table is not None and load.table.against == "crank angle" for load in linkage.loads)
    by_axes |= any(output.link not in linkage.links for output in (*linkage.outputs, linkage.output) if output)
    other, sense, by = linkage, 1, 0.0
    turning = linkage.driver.kind == "turn"
    if not by_axes:
        other, sense, by = turned(mirrored(mirror_of_output(linkage)), BY), -1, BY
    counted = any(load.window or load.table is not None for load in linkage.loads)  # by the angle of the driver
    other, turns = with_other_axes(moved(other, ASIDE), 3, driver=not counted)
    other, names, points = renamed(other, 5)
    if turning:
        on_frame = linkage.driver.base == FRAME
        places = sense * places + (by if on_frame else 0.0) + turns[linkage.driver.link] - turns[linkage.driver.base]
    two = solved(other, Request(places=tuple(places)))
    alike(
        one,
        two,
        names,
        points,
        sense=sense,
        shift=ASIDE,
        spin=lambda v: (v if sense > 0 else np.conj(v)) * np.exp(1j * by),
    )


def resisted(seed, kinds, driver):
    """A random chain about its sketch with friction, and with loads that resist motions of its links on one another."""
    it = any_linkage(seed, kinds, driver)
    random = np.random.default_rng(seed)

    def load(k):
        link, base = (str(name) for name in random.choice(it.moving, 2, replace=False))
        return Load(
            f"R{k}",
            link,
            complex(*random.uniform(-1, 1, 2)),
            complex(random.uniform(1, 9)),
            float(random.uniform(1, 9)),
            resists=True,
            base=base if k % 2 else FRAME,
        )

    it = replace(it, loads=(*it.loads, *(load(k) for k in range(4))))
    return it, it.sketch.at + np.array([0.0, 0.004, -0.004])


@pytest.fixture(scope="module", params=CHAINS, ids=lambda made: "-".join((*made[1], made[2])))
def chain(request):
    return resisted(*request.param)


def test_a_random_chain_drawn_otherwise(chain):
    """Mirrored, turned, moved, with other axes, renamed and in another order, with friction in its pairs."""
    linkage, places = rubbing(chain[0]), chain[1]
    one = solved(linkage, Request(places=tuple(places)))
    assert not np.all(one.locked)
    other, turns = with_other_axes(moved(turned(mirrored(linkage), BY), ASIDE), 3)
    other, names, points = renamed(other, 5)
    if linkage.driver.kind == "turn":
        on_frame = linkage.driver.base == FRAME
        places = -places + BY * on_frame + turns[linkage.driver.link] - turns[linkage.driver.base]
    two = solved(other, Request(places=tuple(places)))
    alike(one, two, names, points, sense=-1, shift=ASIDE, spin=lambda v: np.conj(v) * np.exp(1j * BY))


def test_reactions_of_loads_are_the_sum_of_those_of_each(chain):
    """R(A and B) + R(nothing) = R(A) + R(B): weights and inertia are in each."""
    linkage, places = chain
    results = solved(linkage, Request(places=tuple(places)))
    rest = [load for load in results.loads if load.kind != "load"]
    loads = [load for load in results.loads if load.kind == "load"]
    none, first, second = (
        solve_reactions(results.motion, results.structure, tuple(acting))
        for acting in (rest, [*rest, *loads[::2]], [*rest, *loads[1::2]])
    )
    strongest = max(np.max(np.abs(r.force)) for r in (*results.reactions.all, *none.all))
    for r, n, a, b in zip(results.reactions.all, none.all, first.all, second.all, strict=True):
        same(r.force + n.force, a.force + b.force, strongest)
    for r, n, a, b in zip(results.reactions.balances, none.balances, first.balances, second.balances, strict=True):
        same(r.generalized + n.generalized, a.generalized + b.generalized, strongest)


def test_what_resists_drives_when_the_chain_runs_backward(chain):
    """Then the loads of both senses cancel: reactions of a run forward and back are those of the loads reversed."""
    linkage, places = chain
    one = solved(linkage, Request(places=tuple(places)))
    back = solved(reversed_in_time(linkage), Request(places=tuple(places)))
    strongest = max(np.max(np.abs(r.force)) for r in one.reactions.all)
    for r, s in zip(one.reactions.all, back.reactions.all, strict=True):
        same(r.force, s.force, strongest)
    for load, other in zip(one.loads, back.loads, strict=True):
        same(load.force, other.force, strongest)
