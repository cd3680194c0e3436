"""Laws that every linkage obeys, on random linkages of all five kernels joined in every way."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings, strategies as st
from random_linkages import TYPES, linkage

from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.forces import collect_loads, compute_lever, solve_reactions
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.linkage import FRAME, Link
from tmm_cli.mechanics.numerics import cross, dot
from tmm_cli.mechanics.structure import analyse_structure

CHAINS = st.lists(st.sampled_from(TYPES), min_size=1, max_size=4).map(tuple)
SEEDS = st.integers(0, 2**32 - 1)
GENERIC = 0.02  # margins below this are near a dead position, where nothing keeps its digits


def solved(it, offsets=(0.0, 0.01, -0.01), law=None):
    """Motion and forces of a linkage about its sketch."""
    structure = analyse_structure(it)
    kernels = assemble(it, structure)
    q = it.sketch.at + np.array(offsets)
    d = it.driver
    motion = compute_motion(it, kernels, q, law or DriverMotion(q[0], d.rate, d.acceleration, d.sense))
    loads = collect_loads(motion, None)
    reactions = solve_reactions(motion, structure, loads)
    return structure, motion, loads, reactions


def generic(it):
    """Leave out linkages that happen to be near a dead position or a change of assembly."""
    try:
        found = solved(it)
    except Exception as error:
        if type(error).__name__ in ("Undecided", "Misfit"):
            assume(False)
        raise
    motion = found[1]
    assume(bool(np.all(motion.moving)))
    assume(min(float(np.min(p.margin)) for p in motion.placements) > GENERIC)
    return found


@given(SEEDS, CHAINS)
@settings(max_examples=30)
def test_groups_are_found_as_they_were_put_together(seed, kinds):
    structure = analyse_structure(linkage(seed, kinds))
    assert structure.mobility == structure.freedom == 1
    # all groups that are solved; one on two points of the frame is rigid, and the structural report leaves it out
    assert sorted(g.type for g in structure.all_groups) == sorted(kinds)
    placed = {FRAME, "1"}
    for group in structure.all_groups:  # solving order: a group hangs on links placed before it
        for pair, own in zip(group.outer, group.links, strict=True):
            assert pair.other(own) in placed
        placed |= set(group.links)


@given(SEEDS, CHAINS)
@settings(max_examples=30)
def test_pairs_stay_closed_in_place_velocity_and_acceleration(seed, kinds):
    it = linkage(seed, kinds)
    _, motion, *_ = generic(it)
    size = max(np.max(np.abs(motion.named(p).x)) for p in it.sketch.points)
    speed = max(np.max(np.abs(motion.named(p).v)) for p in it.sketch.points)
    accel = max(np.max(np.abs(motion.named(p).a)) for p in it.sketch.points)
    for hinge in it.hinges:
        one, *others = (motion.point(name, it.local(name, hinge.point)) for name in hinge.links)
        for other in others:
            assert np.max(np.abs(one.x - other.x)) < 1e-13 * size / GENERIC
            assert np.max(np.abs(one.v - other.v)) < 1e-13 * speed / GENERIC**2
            assert np.max(np.abs(one.a - other.a)) < 1e-13 * accel / GENERIC**2
    for slide in it.slides:
        carrier, runner = motion.link(slide.carrier), motion.link(slide.runner)
        assert np.max(np.abs(np.exp(1j * (runner.angle - carrier.angle - slide.turned)) - 1)) < 1e-13 / GENERIC
        sliding = motion.slide(slide)
        here, through = motion.point(slide.runner, slide.at), motion.point(slide.carrier, slide.through)
        guided = through.x + sliding.run * sliding.u
        assert np.max(np.abs(here.x - guided)) < 1e-13 * size / GENERIC
        arm = here.x - through.x
        carried = through.v + 1j * carrier.omega * arm + sliding.v * sliding.u
        assert np.max(np.abs(here.v - carried)) < 1e-13 * speed / GENERIC**2
        transported = through.a + (1j * carrier.epsilon - carrier.omega**2) * arm
        total = transported + sliding.a * sliding.u + sliding.coriolis
        assert np.max(np.abs(here.a - total)) < 1e-12 * accel / GENERIC**2


@given(SEEDS, CHAINS)
@settings(max_examples=30)
def test_velocities_and_accelerations_are_derivatives_of_places(seed, kinds):
    it = linkage(seed, kinds)
    step = 1e-4
    structure = analyse_structure(it)
    generic(it)
    kernels = assemble(it, structure)
    q = it.sketch.at + step * np.arange(-2, 3)
    motion = compute_motion(it, kernels, q, DriverMotion(it.sketch.at, 1.0, 0.0, 1))
    assume(min(float(np.min(p.margin)) for p in motion.placements) > 0.2)
    for point in it.sketch.points:
        x = motion.named(point)
        first = (x.x[0] - 8 * x.x[1] + 8 * x.x[3] - x.x[4]) / (12 * step)
        second = (x.v[0] - 8 * x.v[1] + 8 * x.v[3] - x.v[4]) / (12 * step)
        assert abs(first - x.v[2]) < 1e-7 * (1 + np.max(np.abs(x.v)) ** 4)
        assert abs(second - x.a[2]) < 1e-6 * (1 + np.max(np.abs(x.a)) ** 3)


@given(SEEDS, CHAINS)
@settings(max_examples=30)
def test_every_link_is_in_equilibrium_under_loads_and_reactions(seed, kinds):
    it = linkage(seed, kinds)
    _, motion, loads, reactions = generic(it)
    for name in it.moving:
        forces, moments, largest, turning = 0, 0, 1.0, 1.0
        parts = [(motion.point(name, load.at).x, load.force, load.moment) for load in loads if load.link == name]
        for r in reactions.all:
            if name in (r.on, r.by):
                sign = 1 if name == r.on else -1
                parts.append((r.at, sign * r.force, 0 if r.couple is None else sign * r.couple))
        for at, force, moment in parts:
            forces = forces + force
            moments = moments + cross(at, force) + moment
            largest = np.maximum(largest, np.abs(force))
            turning = np.maximum(turning, np.abs(at * force) + np.abs(moment))
        if name == it.driver.link:
            moments = moments + reactions.balance.moment
        assert np.all(np.abs(forces) < 1e-12 * largest / GENERIC)
        assert np.all(np.abs(moments) < 1e-11 * turning / GENERIC)


@given(SEEDS, CHAINS)
@settings(max_examples=30)
def test_the_lever_agrees_with_the_force_plan(seed, kinds):
    it = linkage(seed, kinds)
    _, motion, loads, reactions = generic(it)
    check = compute_lever(motion, loads, reactions.balance.moment)
    scale = np.max(np.sum([np.abs(item.moment) for item in check.items], axis=0))
    assert np.max(np.abs(check.balancing - reactions.balance.moment)) < 1e-12 * scale / GENERIC


@given(SEEDS, CHAINS)
@settings(max_examples=25)
def test_power_of_the_loads_is_the_rate_of_kinetic_energy(seed, kinds):
    it = linkage(seed, kinds)
    _, motion, loads, reactions = generic(it)
    power = sum(
        dot(x.force, motion.point(x.link, x.at).v) + x.moment * motion.link(x.link).omega
        for x in loads
        if x.kind != "inertia"
    )
    rate = sum(
        it.links[n].mass * dot(motion.centre(n).v, motion.centre(n).a)
        + it.links[n].inertia * motion.link(n).omega * motion.link(n).epsilon
        for n in it.moving
    )
    driving = reactions.balance.moment * motion.rate
    scale = np.abs(power) + np.abs(rate) + np.abs(driving) + 1
    assert np.all(np.abs(driving + power - rate) < 1e-10 * scale / GENERIC)


@given(SEEDS, CHAINS, st.sampled_from([1e-6, 1e6]))
@settings(max_examples=25)
def test_size_changes_lengths_only(seed, kinds, size):
    it = linkage(seed, kinds)
    _, motion, _, _ = generic(it)
    links = {
        n: replace(x, points={p: z * size for p, z in x.points.items()}, centre=x.centre * size)
        for n, x in it.links.items()
    }
    slides = tuple(replace(s, through=s.through * size, at=s.at * size) for s in it.slides)
    sketch = replace(it.sketch, points={p: z * size for p, z in it.sketch.points.items()})
    _, other, _, _ = solved(replace(it, links=links, slides=slides, sketch=sketch))
    for name in it.moving:
        one, two = motion.link(name), other.link(name)
        scale = 1 + np.abs(one.omega) ** 2 + np.abs(one.epsilon)
        assert np.all(np.abs(one.omega - two.omega) < 1e-12 * scale / GENERIC)
        assert np.all(np.abs(one.epsilon - two.epsilon) < 1e-11 * scale / GENERIC**2)
        x = motion.centre(name).x
        assert np.all(np.abs(other.centre(name).x / size - x) < 1e-12 * (1 + np.abs(x)) / GENERIC)


@given(SEEDS, CHAINS)
@settings(max_examples=15)
def test_time_reversed_velocities_turn_round_and_forces_stay(seed, kinds):
    it = linkage(seed, kinds)
    _, motion, _, reactions = generic(it)
    driver = it.driver
    law = DriverMotion(float(motion.q[0]), driver.rate, driver.acceleration, driver.sense)
    back = replace(it, driver=replace(driver, sense=-1, acceleration=-driver.acceleration))
    speed, accel = law.speed(motion.q), driver.acceleration
    for k in range(len(motion.q)):  # the same instant, run backward: rate -> -rate, acceleration as it was
        at = DriverMotion(float(motion.q[k]), float(abs(speed[k])), -accel, -1)
        _, other, _, forces = solved(back, (motion.q[k] - it.sketch.at,), at)
        for name in it.moving:
            one, two = motion.centre(name), other.centre(name)
            assert abs(one.v[k] + two.v[0]) <= 1e-12 * (1 + abs(one.v[k])) / GENERIC
            assert abs(one.a[k] - two.a[0]) <= 1e-12 * (1 + abs(one.a[k])) / GENERIC**2
        for r in reactions.all:
            other_force = forces.of(r.pair.name).force[0]
            assert abs(r.force[k] - other_force) <= 1e-10 * (1 + abs(r.force[k])) / GENERIC**2


@given(SEEDS, CHAINS)
@settings(max_examples=25)
def test_mirror_image(seed, kinds):
    it = linkage(seed, kinds)
    _, motion, _, reactions = generic(it)
    links = {
        n: replace(x, points={p: z.conjugate() for p, z in x.points.items()}, centre=x.centre.conjugate())
        for n, x in it.links.items()
    }
    slides = tuple(
        replace(s, through=s.through.conjugate(), at=s.at.conjugate(), direction=-s.direction, turned=-s.turned)
        for s in it.slides
    )
    sketch = replace(
        it.sketch,
        at=-it.sketch.at,
        points={p: z.conjugate() for p, z in it.sketch.points.items()},
        angles={n: -a for n, a in it.sketch.angles.items()},
    )
    loads = tuple(replace(x, at=x.at.conjugate(), force=x.force.conjugate(), moment=-x.moment) for x in it.loads)
    mirrored = replace(
        it,
        links=links,
        slides=slides,
        sketch=sketch,
        loads=loads,
        gravity=it.gravity.conjugate(),
        driver=replace(it.driver, sense=-1),
    )
    _, other, _, forces = solved(mirrored, (0.0, -0.01, 0.01))
    for name in it.moving:
        one, two = motion.centre(name), other.centre(name)
        assert np.all(np.abs(one.a.conjugate() - two.a) <= 1e-11 * (1 + np.abs(one.a)) / GENERIC**2)
    for r in reactions.all:
        gap = np.abs(r.force.conjugate() - forces.of(r.pair.name).force)
        assert np.all(gap <= 1e-10 * (1 + np.abs(r.force)) / GENERIC**2)


@pytest.mark.parametrize("order", list(itertools.permutations("2345"))[::5])
def test_order_and_names_of_links_change_nothing(order):
    it = linkage(11, ("RRR", "RRP"))
    motion = solved(it)[1]
    names = {FRAME: FRAME, "1": "1"} | {old: f"link{new}" for old, new in zip(order, "abcd", strict=True)}
    links = {names[n]: replace(it.links[n], name=names[n]) for n in (FRAME, *order[::-1], "1")}
    assert all(isinstance(x, Link) for x in links.values())
    renamed = replace(
        it,
        links=links,
        hinges=tuple(replace(h, links=tuple(names[n] for n in h.links)) for h in it.hinges),
        slides=tuple(replace(s, carrier=names[s.carrier], runner=names[s.runner]) for s in it.slides),
        sketch=replace(it.sketch, angles={names[n]: a for n, a in it.sketch.angles.items()}),
        loads=tuple(replace(x, link=names[x.link]) for x in it.loads),
    )
    other = solved(renamed)[1]
    for name in it.moving:
        assert np.max(np.abs(motion.centre(name).a - other.centre(names[name]).a)) < 1e-12
