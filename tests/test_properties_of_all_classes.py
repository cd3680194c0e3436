"""Laws that every linkage obeys, on random linkages of all classes with wheels, racks, cams, cylinders and springs."""

from __future__ import annotations

import numpy as np
import pytest
from random_linkages import any_linkage
from transforms import mirrored, renamed, reversed_in_time, sized, turned

from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.forces import (
    collect_loads,
    compute_energy,
    compute_lever,
    reduced_driving_moment,
    solve_reactions,
)
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.numerics import cross
from tmm_cli.mechanics.structure import analyse_structure

LINKAGES = [
    (1, ("III", "gear"), "crank"),
    (1, ("IV",), "cylinder"),
    (1, ("VI", "cam"), "crank"),
    (1, ("III", "swinging follower"), "swinging cylinder"),
    (1, ("rack", "RPP"), "cylinder"),
    (1, ("geared five-bar", "RRR"), "crank"),
    (2, ("pinion", "PRP"), "swinging cylinder"),
    (3, ("cylinder", "RRP"), "crank"),
    (1, ("arm", "RPR"), "cylinder"),
    (3, ("cylinder", "arm", "III"), "crank"),
    (3, ("gear", "rack", "RPR"), "swinging cylinder"),
    (1, ("cam", "IV"), "crank"),
]  # seeds and kinds: every kind of group, pair and driver, with some way to both sides of the sketch
OFFSETS = (0.0, 0.004, -0.004)  # of the driver from the sketch, rad or m
CLOSE = 1e-9  # relative; groups may be 1/200 from a dead position, and several hang on one another


def law_of(it):
    return DriverMotion(it.sketch.at, it.driver.rate, it.driver.acceleration, it.driver.sense)


def solved(it, offsets=OFFSETS, kernels=None):
    """Motion and forces of a linkage about its sketch."""
    structure = analyse_structure(it)
    motion = compute_motion(it, kernels or assemble(it, structure), it.sketch.at + np.array(offsets), law_of(it))
    loads = collect_loads(motion, None)
    return structure, motion, loads, solve_reactions(motion, structure, loads)


@pytest.fixture(scope="module", params=LINKAGES, ids=lambda made: "-".join((*made[1], made[2])))
def found(request):
    """The same of each of the random linkages, which all tests look at."""
    parts = solved(any_linkage(*request.param))
    assert np.all(parts[1].moving)
    return parts


def same(one, other, scale):
    assert np.all(np.abs(one - other) <= CLOSE * scale)


def largest(values):
    return max((float(np.max(np.abs(v))) for v in values), default=0.0)


def alike(one, other, *, spin=lambda v: v, sense=1, size=1.0, time=1, names=None):
    """Two solutions that are alike but for a change of vectors, the sense of angles, the size and the way of time."""
    (_, m, _, r), (_, n, _, s) = one, other
    names = names or {name: name for name in m.linkage.links}
    links = m.linkage.moving
    for part, way in (("x", 1), ("v", time), ("a", 1)):
        scale = largest(getattr(m.centre(link), part) for link in links) + 1e-3
        for link in links:
            same(spin(getattr(m.centre(link), part)) * way, getattr(n.centre(names[link]), part) / size, scale)
    for part, way in (("omega", time), ("epsilon", 1)):
        scale = largest(getattr(m.link(link), part) for link in links) + 1e-3
        for link in links:
            same(getattr(m.link(link), part) * way * sense, getattr(n.link(names[link]), part), scale)
    strongest = largest([x.force for x in r.all]) + 1
    pinned = {h.point for h in m.linkage.hinges if len(h.links) > 2}
    others = {frozenset((x.on, x.by, x.pair.kind, x.pair.mesh and x.pair.mesh.name)): x for x in s.all}
    for x in r.all:
        if x.pair.point in pinned:
            continue
        y = others[frozenset((names[x.on], names[x.by], x.pair.kind, x.pair.mesh and x.pair.mesh.name))]
        same(spin(x.force), y.onto(names[x.on]) / size, strongest)
    by_link = {b.driver.link: b for b in s.balances}
    for b in r.balances:
        c = by_link[names[b.driver.link]]
        turns = b.moment is not None
        change = size**2 * sense if turns else size
        same(b.generalized, c.generalized / change, strongest * 10)


def test_pairs_stay_closed_and_links_in_equilibrium(found):
    _, motion, loads, reactions = found
    it = motion.linkage
    for hinge in it.hinges:
        one, *others = (motion.point(name, it.local(name, hinge.point)) for name in hinge.links)
        for other in others:
            same(one.x, other.x, 1e-2)
            same(one.v, other.v, 1 + np.abs(one.v))
            same(one.a, other.a, 1 + np.abs(one.a) + np.abs(one.v) ** 2)
    for slide in it.slides:
        carrier, runner = motion.link(slide.carrier), motion.link(slide.runner)
        same(np.exp(1j * (runner.angle - carrier.angle - slide.turned)), 1, 1e-2)
        same(runner.omega, carrier.omega, 1 + np.abs(runner.omega))
        same(runner.epsilon, carrier.epsilon, 1 + np.abs(runner.epsilon))
        sliding = motion.slide(slide)
        here, through = motion.point(slide.runner, slide.at), motion.point(slide.carrier, slide.through)
        same(here.x, through.x + sliding.run * sliding.u, 1e-2)
    for mesh in it.meshes:
        i, j, c = (motion.link(n) for n in (mesh.i, mesh.j, mesh.carrier))
        slide = it.slide(mesh.slide) if mesh.slide else None
        if mesh.kind == "gear":
            same(j.omega - c.omega, mesh.ratio * (i.omega - c.omega), 1 + np.abs(j.omega))
            same(j.epsilon - c.epsilon, mesh.ratio * (i.epsilon - c.epsilon), 1 + np.abs(j.epsilon))
        elif mesh.kind == "rack":
            same(motion.slide(slide).v, mesh.ratio * (i.omega - c.omega), 1 + np.abs(i.omega))
            same(motion.slide(slide).a, mesh.ratio * (i.epsilon - c.epsilon), 1 + np.abs(i.epsilon))
        else:
            lift, first, second = mesh.law(i.angle)
            follower = motion.slide(slide) if slide else j
            speed, change = (follower.v, follower.a) if slide else (j.omega, j.epsilon)
            place = follower.run if slide else np.exp(1j * j.angle)
            same(place, lift + mesh.offset if slide else np.exp(1j * (lift + mesh.offset)), 1e-2)
            same(speed, first * i.omega, 1 + np.abs(i.omega))
            same(change, second * i.omega**2 + first * i.epsilon, 1 + np.abs(i.omega) ** 2 + np.abs(i.epsilon))
    for name in it.moving:
        in_equilibrium(it, motion, loads, reactions, name)


def in_equilibrium(it, motion, loads, reactions, name):
    parts = [(motion.point(name, x.at).x, x.force, x.moment) for x in loads if x.link == name]
    for r in reactions.all:
        if name == r.on:
            parts.append((r.at, r.force, 0 if r.couple is None else r.couple))
        elif name == r.by:
            back = r.back if r.back is not None else 0 if r.couple is None else -r.couple
            parts.append((r.at, -r.force, back))
    for b in reactions.balances:
        for link, sense in ((b.driver.link, 1), (b.driver.base, -1)):
            if link == name:
                turns = b.moment is not None
                parts.append((b.at, 0 * b.at, sense * b.moment) if turns else (b.at, sense * b.vector, 0))
    force = sum(f for _, f, _ in parts)
    moment = sum(cross(at, f) + m for at, f, m in parts)
    same(force, 0, 1 + sum(np.abs(f) for _, f, _ in parts))
    same(moment, 0, 1 + sum(np.abs(at * f) + np.abs(m) for at, f, m in parts))


def test_lever_and_powers_agree_with_the_force_plan(found):
    _, motion, loads, reactions = found
    drivers = reduced_driving_moment(motion, reactions)
    check = compute_lever(motion, loads, drivers)
    scale = np.max(np.sum([np.abs(item.moment) for item in check.items], axis=0), initial=1.0)
    same(check.balancing, drivers, scale)
    same(compute_energy(motion, loads, drivers).balance, 0, 10)


def test_a_position_alone_is_that_position_among_others(found):
    motion = found[1]
    it = motion.linkage
    many = compute_motion(it, motion.kernels, it.sketch.at + np.linspace(-1, 1, 41), law_of(it))
    for k in (0, 7, 20, 33):
        alone = compute_motion(it, motion.kernels, many.q[k : k + 1], law_of(it))
        assert alone.placed[0] == many.placed[k]
        assert alone.moving[0] == many.moving[k]
        if many.moving[k]:
            for name in it.moving:
                for part in ("x", "v", "a"):
                    one, other = getattr(alone.centre(name), part)[0], getattr(many.centre(name), part)[k]
                    assert abs(one - other) <= 1e-13 * (1 + abs(other)) * (1 if part == "x" else 1e3)


def test_velocities_and_accelerations_are_derivatives_of_places(found):
    """By differences of the eighth order."""
    motion = found[1]
    it = motion.linkage
    step = 2e-3
    q = it.sketch.at + step * np.arange(-4, 5)
    motion = compute_motion(it, motion.kernels, q, DriverMotion(it.sketch.at, 1.0, 0.0, 1))
    assert np.all(motion.moving)
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / step
    for name in it.moving:
        point = motion.centre(name)
        fastest = 1 + np.max(np.abs(point.v)) + np.max(np.abs(point.a))
        assert fastest < 30  # higher derivatives grow with powers of it
        assert abs(weights @ point.x - point.v[4]) < 1e-8 * fastest
        assert abs(weights @ point.v - point.a[4]) < 1e-7 * fastest**2


def test_another_drawing_of_the_same_linkage(found):
    """Mirrored, turned, of another size, its links and pairs renamed and in another order.

    Lengths and forces change by the scale, moments by its square.
    """
    it = found[1].linkage
    size = 1e-6 if len(it.moving) % 2 else 1e6
    by = 0.7 * np.log10(size)
    other, names, _ = renamed(sized(turned(mirrored(it), by), size), 5)
    offsets = np.array(OFFSETS) * (size if it.driver.kind == "slide" else -1)
    alike(found, solved(other, offsets), spin=lambda v: np.conj(v) * np.exp(1j * by), sense=-1, size=size, names=names)


def test_time_run_backward(found):
    _, motion, _, _ = found
    back = reversed_in_time(motion.linkage)
    alike(found, solved(back, kernels=[kernel.rebind(back) for kernel in motion.kernels]), time=-1)
