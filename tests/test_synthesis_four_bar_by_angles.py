"""Four-bars by pairs of angles: the pairs come back on the motion of the mechanism, and what cannot be is refused."""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

from tmm_cli import solve
from tmm_cli.batch import prepare_batch
from tmm_cli.mechanics.linkage import Sketch
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import (
    AnglePairsTask,
    FourBarRatios,
    are_real,
    build_synthesised,
    choose_four_bar,
    fitted_lengths,
    four_bars_through,
    measure_demands,
    output_angles,
    rate_four_bars,
    solve_exact_pairs,
    solve_pqs,
)

LINKAGE = """
points: {A: [0, 0], D: [l4, 0]}
links:
  1: {points: [A, B], length: l1}
  2: {points: [B, C], length: l2}
  3: {points: [D, C], length: l3}
driver: {link: 1, speed: 1 rad/s}
sketch: {at: phi1, C: [l4 + l3*cos(psi1), l3*sin(psi1)]}
output: 3
positions: {count: 4, from: phi1}
"""
MET = 1e-12
COUNT = 250


def problem(block):
    return build_synthesised(
        read_text(f"tmm: 1\nsynthesis: {{task: four-bar-by-angles, {block}}}\n{LINKAGE}", "x.yaml")
    )


def random_tasks(count, seed, least=0.35):
    """Random four-bars, `count` pairs of their angles each, from their zero angles, on one assembly and in order.

    The transmission angle (rad) is nowhere less than `least` on the way, so that the output is well defined.
    """
    rng, kept = np.random.default_rng(seed), []
    while sum(len(k[0]) for k in kept) < COUNT:
        l1, l3 = rng.uniform(0.3, 2.5, (2, 4 * COUNT))
        phi0, first = rng.uniform(-np.pi, np.pi, (2, 4 * COUNT))
        steps = rng.uniform(0.2, 0.6, (count - 1, 4 * COUNT))
        l2 = np.abs(1 + l3 * np.exp(1j * first) - l1 * np.exp(1j * phi0))
        side = np.sign(((1 + l3 * np.exp(1j * first) - l1 * np.exp(1j * phi0)).conj() * l3 * np.exp(1j * first)).imag)
        phi = np.concatenate([np.zeros((1, 4 * COUNT)), np.cumsum(steps, 0)])
        fine = phi[-1] * np.linspace(0, 1, 200)[:, None]

        def angle(turn, l1=l1, l2=l2, l3=l3, phi0=phi0, side=side):
            way = l1 * np.exp(1j * (phi0 + turn)) - 1
            cosine = (l3**2 + np.abs(way) ** 2 - l2**2) / (2 * l3 * np.abs(way))
            inner = (l2**2 + l3**2 - np.abs(way) ** 2) / (2 * l2 * l3)
            return np.angle(way * np.exp(-1j * side * np.arccos(np.clip(cosine, -1, 1)))), inner

        good = (np.abs(angle(fine)[1]) < np.cos(least)).all(0)
        psi = angle(phi)[0]
        good &= np.abs(np.angle(np.exp(1j * (psi[0] - first)))) < 1e-9  # the other assembly is another mechanism
        psi = np.unwrap(psi, axis=0)
        kept.append([x[..., good].T for x in (phi, psi - first, l1, l2, l3, phi0, first)])
    return [np.concatenate(parts)[:COUNT] for parts in zip(*kept, strict=True)]


def on_mechanism(bars, phi, psi):
    """Output angles (tasks, pairs) less psi0, of many four-bars of unit frame, measured on the motion of linkages."""
    first = problem("pairs: [[30, 60], [60, 75], [90, 100]], l4: 1 m").linkage
    numbers = [np.asarray(x, dtype=float) for x in bars]
    linkages = []
    for (l1, l2, l3, phi0, psi0), a, b in zip(zip(*numbers, strict=True), phi[:, 0], psi[:, 0], strict=True):
        links = first.links | {
            "0": replace(first.links["0"], points={"A": 0j, "D": 1 + 0j}),
            "1": replace(first.links["1"], points={"A": 0j, "B": complex(l1)}),
            "2": replace(first.links["2"], points={"B": 0j, "C": complex(l2)}),
            "3": replace(first.links["3"], points={"D": 0j, "C": complex(l3)}),
        }
        c = complex(1 + l3 * np.exp(1j * (psi0 + b)))
        linkages.append(replace(first, links=links, sketch=Sketch(float(phi0 + a), {"C": c})))
    # the first linkage's assembly holds for all of a batch: two batches, by the side on which C lies
    b0, c0 = (np.asarray(x, complex) for x in bars.pins(phi[:, 0], psi[:, 0]))
    left = ((1 - b0).conj() * (c0 - b0)).imag > 0
    found = np.empty(phi.shape)
    for side in (left, ~left):
        numbers_of = np.flatnonzero(side)
        at = prepare_batch([linkages[k] for k in numbers_of], forces=False, own_places=True)
        angles = phi[side] + numbers[3][side, None]
        found[side] = np.angle((at(angles)["C.x"] - 1) * np.exp(-1j * (psi[side] + numbers[4][side, None])))
    return found + psi


def comes_back(phi, psi, bars):
    assert on_mechanism(bars, phi, psi) == pytest.approx(psi, rel=0, abs=MET)


def nearest_root(found, l1, l3):
    """Of all roots that of the mechanism from which the task was made."""
    gap = np.abs(found.l1 / l1[:, None] - 1) + np.abs(found.l3 / l3[:, None] - 1)
    best = np.nanargmin(np.asarray(gap, dtype=float), axis=1)
    return FourBarRatios(*(np.take_along_axis(x, best[:, None], axis=1)[:, 0] for x in found))


@pytest.mark.parametrize(("count", "free"), [(3, ()), (4, ("phi0",)), (4, ("psi0",)), (5, ("phi0", "psi0"))])
def test_pairs_come_back_and_the_mechanism_of_the_task_is_among_the_roots(count, free):
    phi, psi, l1, l2, l3, phi0, psi0 = random_tasks(count, count + len(free))
    given_phi = phi if "phi0" in free else phi + phi0[:, None]
    given_psi = psi if "psi0" in free else psi + psi0[:, None]
    zeros = {name: None if name in free else 0.0 for name in ("phi0", "psi0")}
    found = nearest_root(solve_exact_pairs(given_phi, given_psi, **zeros), l1, l3)
    for value, truth in ((found.l1, l1), (found.l2, l2), (found.l3, l3)):
        assert np.asarray(value, float) == pytest.approx(truth, rel=2e-4)  # how sharply near pairs tell the lengths
    comes_back(given_phi, given_psi, found)


def pairs_of(l1, l2, l3, start, span, count, rng):
    """Pairs (rad) of a four-bar of unit frame within a small span, to the last bit; None where it does not close."""
    share = np.concatenate([[0], np.sort(rng.uniform(0.1, 0.9, count - 2)), [1]])
    phi = start + span * share
    if np.min(np.diff(share)) < 0.08:
        return None
    with mp.workdps(50):
        psi = []
        for angle in phi:
            way = l1 * mp.expj(float(angle)) - 1
            cosine = (l3**2 + abs(way) ** 2 - l2**2) / (2 * l3 * abs(way))
            if abs(cosine) > 1:
                return None
            psi.append(mp.arg(way) + mp.acos(cosine))
        return phi, np.array([float(angle) for angle in psi])


def exact_lengths(phi, psi):
    """l1 and l3 over l4 of all four-bars through five pairs, at 50 digits: a cubic of the tangent of phi0 - psi0."""
    with mp.workdps(50):
        phi, psi = [mp.mpf(float(x)) for x in phi], [mp.mpf(float(x)) for x in psi]
        rows = mp.matrix([[mp.cos(q), mp.sin(q), mp.cos(p), mp.sin(p), 1] for p, q in zip(phi, psi, strict=True)])
        u, v = (
            mp.lu_solve(rows, mp.matrix(right))
            for right in (
                [mp.cos(p - q) for p, q in zip(phi, psi, strict=True)],
                [-mp.sin(p - q) for p, q in zip(phi, psi, strict=True)],
            )
        )

        def sides(t):
            x = [a + t * b for a, b in zip(u, v, strict=True)]
            return mp.mpc(x[0], x[1]), mp.mpc(x[2], x[3])

        def form(t):
            a, b = sides(t)
            return (b * mp.conj(a) * mp.mpc(1, t)).imag

        at = [mp.mpf(x) for x in (0, 1, -1, 2)]
        cubic = mp.lu_solve(mp.matrix([[t**3, t**2, t, 1] for t in at]), mp.matrix([form(t) for t in at]))
        found = []
        companion = mp.matrix([[-cubic[k] / cubic[0] for k in (1, 2, 3)], [1, 0, 0], [0, 1, 0]])
        for t in mp.eig(companion, left=False, right=False):
            if abs(mp.im(t)) < mp.mpf(10) ** -25 * (1 + abs(t)):
                turn = mp.sqrt(1 + mp.re(t) ** 2)
                found.append([float(turn / abs(side)) for side in sides(mp.re(t))])
        return found


@pytest.mark.parametrize("span", [2, 4, 8, 30])
def test_no_four_bar_through_five_near_pairs_is_lost(span):
    rng, count = np.random.default_rng(span), 0
    while count < 30:
        l1, l2, l3 = rng.uniform(0.2, 3, 3)
        made = pairs_of(l1, l2, l3, rng.uniform(-3, 3), np.radians(span), 5, rng)
        if made is None:
            continue
        count += 1
        truth = sorted(exact_lengths(*made))
        found = solve_exact_pairs(*made, None, None)
        own = sorted(
            (float(a), float(b)) for a, b in zip(found.l1[0], found.l3[0], strict=True) if np.isfinite(float(a))
        )
        assert len(own) == len(truth)
        assert np.array(own) == pytest.approx(np.array(truth), rel=1e-6)


@pytest.mark.parametrize("free", ["phi0", "psi0", ""])
def test_the_four_bar_of_three_or_four_near_pairs_is_found(free):
    rng, count = np.random.default_rng(5), 0
    while count < 30:
        l1, l2, l3 = rng.uniform(0.2, 3, 3)
        made = pairs_of(l1, l2, l3, rng.uniform(-3, 3), np.radians(1), 4 if free else 3, rng)
        if made is None:
            continue
        count += 1
        found = solve_exact_pairs(*made, **{name: None if name == free else 0.0 for name in ("phi0", "psi0")})
        assert np.nanmin(np.abs(found.l1 / l1 - 1) + np.abs(found.l3 / l3 - 1)) < 1e-5


@pytest.mark.parametrize(
    "block",
    [
        "[[30, 30], [60, 60], [90, 90]]",
        "[[30, 210], [60, 240], [90, 270]]",
        "[[20, 40], [50, 70], [90, 110], [100, 120]]",
        "[[0, 10], [20, 30], [40, 50], [60, 70], [90, 100]]",
        "[[30, 50], [60, 80], [90, 110]], psi0: -20",
    ],
)
def test_equal_angles_are_those_of_any_parallelogram(block):
    found = problem(f"pairs: {block}, l4: 100")
    outcome = found.synthesis.outcome
    assert any(
        "every parallelogram with l1 = l3 and l2 = l4 passes through the pairs" in note for note in outcome.notes
    )
    l1, l2, l3, l4 = (outcome.parameters[name].value for name in ("l1", "l2", "l3", "l4"))
    assert (l1, l2) == (l3, l4)
    for m in measure_demands(outcome, solve(found, "kinematics")):
        assert m.difference <= MET, m


@pytest.mark.parametrize(("count", "zeros"), [(3, (0.0, 0.0)), (4, (None, 0.0)), (4, (0.0, None)), (5, (None, None))])
def test_what_is_chosen_passes_all_pairs_on_one_assembly(count, zeros):
    drawn = zip(random_tasks(count, 7), random_tasks(count, 8), strict=True)
    phi, psi, _, _, _, phi0, psi0 = (np.concatenate(both) for both in drawn)
    phi = phi if zeros[0] is None else phi + phi0[:, None]
    psi = psi if zeros[1] is None else psi + psi0[:, None]
    every = solve_exact_pairs(phi, psi, *zeros)
    taken, rows = [], []
    for k in range(len(phi)):
        task = AnglePairsTask(tuple(phi[k]), tuple(psi[k]), {"l4": 1.0}, *zeros)
        own = every.at(k)
        here = own.at(are_real(own))
        if not np.any(rate_four_bars(here, task).defect == ""):
            continue
        at = choose_four_bar(task, here)
        if rate_four_bars(here.at(at), task).least > 0.2:
            taken.append(here.at(at))
            rows.append(k)
    assert len(rows) > max(COUNT, 0.97 * len(phi))
    bars = FourBarRatios(*(np.array(numbers) for numbers in zip(*taken, strict=True)))
    comes_back(phi[rows], psi[rows], bars)


def test_two_pairs_and_the_ratio_of_two_links_come_back():
    phi, psi, l1, _, l3, phi0, psi0 = random_tasks(2, 2)
    phi, psi, taken = phi + phi0[:, None], psi + psi0[:, None], []
    for k in range(COUNT):
        lengths = [{"l1": l1[k], "l4": 1.0}, {"l3": l3[k], "l4": 1.0}, {"l1": l1[k], "l3": l3[k]}][k % 3]
        ways = four_bars_through(AnglePairsTask(tuple(phi[k]), tuple(psi[k]), lengths))
        taken.append(ways.at(np.argmin(np.abs(ways.l1 - l1[k]) + np.abs(ways.l3 - l3[k]))))
        assert float(taken[-1].l1) == pytest.approx(l1[k], rel=1e-8)
    bars = FourBarRatios(*(np.array(numbers) for numbers in zip(*taken, strict=True)))
    comes_back(phi, psi, bars)


@pytest.mark.parametrize("held", ["l1", "l3"])
def test_three_pairs_with_the_frame_and_the_crank_or_the_rocker_come_back(held):
    phi, psi, l1, l2, l3, phi0, psi0 = random_tasks(3, 11)
    phi, psi = (phi + phi0[:, None], psi) if held == "l1" else (phi, psi + psi0[:, None])
    zeros, known = ((0.0, None), l1) if held == "l1" else ((None, 0.0), l3)
    tasks = [
        AnglePairsTask(tuple(a), tuple(b), {held: one, "l4": 1.0}, *zeros)
        for a, b, one in zip(phi, psi, known, strict=True)
    ]
    bars = FourBarRatios(*(np.concatenate(numbers) for numbers in zip(*map(four_bars_through, tasks), strict=True)))
    for value, truth in ((bars.l1, l1), (bars.l2, l2), (bars.l3, l3)):
        assert np.asarray(value, float) == pytest.approx(truth, rel=1e-9)
    comes_back(phi, psi, bars)


@pytest.mark.parametrize(("count", "zeros"), [(5, (0.0, 0.0)), (8, (None, 0.0)), (8, (0.0, None)), (12, (None, None))])
def test_more_pairs_of_a_four_bar_than_are_needed_find_it(count, zeros):
    phi, psi, *lengths, phi0, psi0 = random_tasks(count, count)
    for k in range(0, COUNT, 200):
        a = phi[k] + (0 if zeros[0] is None else phi0[k])
        b = psi[k] + (0 if zeros[1] is None else psi0[k])
        found = four_bars_through(AnglePairsTask(tuple(a), tuple(b), {"l4": 1.0}, *zeros))
        assert [float(x[0]) for x in found[:3]] == pytest.approx([one[k] for one in lengths], rel=1e-6)


@pytest.mark.parametrize(
    "block",
    [
        "function: x^2, x: [1, 2], input: [30, 120], output: [60, 120], points: 12",
        "function: exp(x), x: [0, 1], input: [45, 105], output: [0, 60], points: 15, phi0: 0, psi0: 0",
        "pairs: [[40, 70], [45, 76], [50, 83], [55, 91], [60, 100]], phi0: 0, psi0: 0",
        "pairs: [[0, 0], [10, 12], [20, 25], [30, 39], [40, 54], [50, 71]], psi0: 40",
        "table: [[0, 0], [1, 2], [2, 5]], input: [90, 30], output: [110, 60], points: 20",
    ],
)
def test_errors_at_more_pairs_have_the_least_squares_and_are_those_of_the_mechanism(block):
    found = problem(f"{block}, l4: 100")
    outcome = found.synthesis.outcome
    every = measure_demands(outcome, solve(found, "kinematics"))
    for m in every:
        assert m.difference <= MET, m
    pairs = outcome.listings[0]
    phi, psi, _, error = np.array(pairs.rows).T
    least = np.mean(error**2)
    assert np.sqrt(least) == pytest.approx(every[0].value, rel=1e-9)
    one = [float(outcome.parameters[name].value) for name in ("l1", "l2", "l3", "phi0", "psi0")]
    one[:3] = np.array(one[:3]) / float(outcome.parameters["l4"].value)
    free = 3 if "psi0: 0" in block else 4 if "psi0" in block else 5
    for k in range(free):
        for step in (-1e-4, 1e-4):
            other = FourBarRatios(*(value + step * (k == n) for n, value in enumerate(one)))
            off = min((output_angles(other, phi, psi, side) - psi for side in (1, -1)), key=np.linalg.norm)
            assert np.mean(off**2) > least


def test_the_pairs_of_a_weaving_machine_are_met_better_than_by_least_squares_of_the_equation():
    # a laboratory task: five pairs from the frame, 180 mm, by least squares of Freudenstein's equation
    phi, psi = np.radians([[40, 45, 50, 55, 60], [70, 76, 83, 91, 100]])
    equation = fitted_lengths(np.append(solve_pqs(phi[None], psi[None])[0], [0, 0]))
    assert float(equation.l1) == pytest.approx(0.980334, rel=1e-6)  # of Gauss's normal equations
    found = four_bars_through(AnglePairsTask(tuple(phi), tuple(psi), {"l4": 0.18})).at(0)
    means = [np.degrees(np.sqrt(np.mean((output_angles(one, phi, psi, -1.0) - psi) ** 2))) for one in (equation, found)]
    assert means == pytest.approx([0.0982, 0.0931], abs=1e-4)


NOISY = (  # measured on four-bars, with noise
    [[-13.92, 53.28], [-17.63, 49.96], [-22.19, 47.45], [-41.86, 43.57], [-46.99, 41.53], [-53.54, 41]],
    [[-106.7, -88], [-102.5, -83.6], [-98.3, -81.1], [-92.6, -78.4], [-86, -72.2], [-71.2, -61.2], [-66.7, -57.2]],
)


def fitted(block):
    """Ratio of the longest to the shortest link, mean error (deg) and notes of the four-bar chosen, and of all."""
    outcome = problem(f"{block}, l4: 100").synthesis.outcome
    links = [float(outcome.parameters[name].value) for name in ("l1", "l2", "l3", "l4")]
    (mean,) = (m for m in outcome.demands if "mean square" in m.text)
    solutions = [listing.rows for listing in outcome.listings if listing.name == "solutions"]
    return links, np.degrees(mean.value), outcome.notes, *solutions


def test_the_least_squares_of_noisy_pairs_are_a_minimum_that_not_every_start_reaches():
    links, error, notes, solutions = fitted(f"pairs: {NOISY[0]}")
    assert links == pytest.approx([0.1380, 0.08945, 0.1486, 0.1], rel=1e-3)
    assert error == pytest.approx(0.3075, abs=5e-5)
    assert not any("at the bound" in note for note in notes)
    errors = [row[2] for row in solutions]
    assert errors == sorted(errors)
    assert len(errors) > 1


@pytest.mark.parametrize(("ratio", "least"), [(3, 0.61311), (10, 0.60817)])  # least: by differential evolution
def test_a_link_that_would_grow_without_limit_stays_at_the_bound_of_the_ratio(ratio, least):
    links, error, notes, solutions = fitted(f"pairs: {NOISY[1]}, phi0: 0, psi0: 0, link_ratio: {ratio}, choose: 2")
    assert error == pytest.approx(least, abs=1e-5)
    assert max(links) / min(links) == pytest.approx(ratio, rel=1e-5)
    assert any(f"the longest is {ratio} times the shortest" in note for note in notes)
    # with both links in the opposite direction the error is still smaller, and at no bound
    assert np.degrees(solutions[0][2]) == pytest.approx(0.603429, abs=1e-6)


def test_a_fit_is_never_worse_than_the_four_bar_from_which_its_noisy_pairs_come():
    rng = np.random.default_rng(37)
    count = 0
    while count < 8:
        bar = FourBarRatios(*np.exp(rng.uniform(-1.1, 1.1, 3)), *rng.uniform(-np.pi, np.pi, 2))
        phi = np.cumsum(rng.uniform(0.05, 0.3, rng.integers(6, 12)))
        exact = output_angles(bar, phi, np.zeros(len(phi)), 1.0, np.nan)
        psi = np.unwrap(exact) + np.radians(0.7) * rng.standard_normal(len(phi))
        task = AnglePairsTask(tuple(phi), tuple(psi), {"l4": 1.0}, None, None)
        if np.isnan(exact).any() or rate_four_bars(bar, task).least < np.radians(15):
            continue
        count += 1
        four_bars = four_bars_through(task)
        best = four_bars.at(choose_four_bar(task, four_bars))
        errors = [min(np.linalg.norm(output_angles(x, phi, psi, s) - psi) for s in (1.0, -1.0)) for x in (best, bar)]
        assert errors[0] <= errors[1]
        links = [float(best.l1), float(best.l2), float(best.l3), 1.0]
        assert max(links) / min(links) < 10 * (1 + 1e-5)
        assert rate_four_bars(best, task).defect == ""


def test_a_required_transmission_angle_chooses_a_solution_and_bounds_a_fit():
    pairs = "pairs: [[0, 0], [20, 15], [40, 33], [60, 55], [80, 83]]"
    free = problem(f"{pairs}, l4: 100").synthesis.outcome
    _, error, notes, _ = fitted(f"pairs: {NOISY[0]}, transmission: 60")
    assert error > 0.3075
    assert any("at the bound of the transmission angle: it is 60 deg" in note for note in notes)
    with pytest.raises(ProblemError, match="no four-bar through these pairs of angles has so large a smallest"):
        problem(f"{pairs}, l4: 100, transmission: 89")
    assert free.parameters["l1"].value > 0


def test_two_pairs_alone_get_the_best_transmission():
    task = AnglePairsTask((0.5, 1.4), (1.0, 1.6), {"l4": 1.0})
    (least,) = rate_four_bars(four_bars_through(task), task).least
    for ratio in np.linspace(0.11, 9, 300):
        mark = rate_four_bars(four_bars_through(replace(task, lengths={"l1": ratio, "l4": 1.0})), task)
        assert np.all((mark.defect != "") | mark.reversed | (mark.least <= least + 1e-9))


@pytest.mark.parametrize(
    "block",
    [
        "pairs: [[20, 35], [35, 45], [50, 60]], l4: 100",
        "pairs: [[30, 60], [80, 90]], l4: 100, l1: 40",
        "pairs: [[30, 60], [80, 90]], l1: 100",
        "pairs: [[20, 35], [35, 45], [50, 60]], l4: 100, l3: 80",
        "pairs: [[20, 35], [35, 45], [50, 60]], l4: 100, l1: 80, phi0: 10",
        "pairs: [[30, 40], [60, 70], [90, 100]], l4: 100, l1: 80",
        "pairs: [[0, 0], [20, 15], [40, 33], [60, 55]], l1: 100",
        "pairs: [[0, 0], [20, 15], [40, 33], [60, 55]], phi0: 20, l3: 100",
        "pairs: [[0, 0], [20, 15], [40, 33], [60, 55], [80, 83]], l2: 100, choose: crank",
        "function: x^2, x: [1, 2], input: [30, 120], output: [60, 120], l4: 100",
        "function: sin(x), x: [0, 90], input: [0, 90], output: [0, 60], points: 5, l4: 100",
        "table: [[0, 0], [1, 2], [2, 5]], input: [90, 30], output: [110, 60], l4: 100",
    ],
)
def test_the_ordinary_stages_measure_what_was_asked(block):
    found = problem(block)
    every = measure_demands(found.synthesis.outcome, solve(found, "kinematics"))
    assert len(every) >= 4
    for m in every:
        assert m.difference <= MET, m


def test_the_precision_points_are_chebyshevs_and_the_error_vanishes_there():
    outcome = problem("function: log10(x), x: [1, 2], input: [45, 105], output: [0, 90], l4: 100").synthesis.outcome
    asked = [v.value for v in outcome.asked if v.text.startswith("input angle ") and v.text[-1].isdigit()]
    assert np.degrees(asked) == pytest.approx(75 - 30 * np.cos(np.radians([30, 90, 150])), rel=1e-14)
    curve, points = outcome.drawings[1].lines
    assert np.interp(points.x, curve.x, curve.y) == pytest.approx(0, abs=1e-5)
    largest = next(v.value for v in outcome.found if v.text == "largest structural error")
    assert largest == pytest.approx(np.max(np.abs(curve.y)), rel=1e-14)
    assert np.degrees(largest) == pytest.approx(2.364325, rel=2e-6)


REFUSED = {
    "pairs: [[30, 60], [80, 90], [70, 100]], l4: 100": (
        "synthesis.pairs[2][0]: the input link reverses: pair of angles 3 cannot be reached after pair 2\n"
        "  found:   70\n"
        "  allowed: nearest feasible value: pairs[2][0]: "
    ),
    "pairs: [[30, 60], [80, 60], [120, 100]], l4: 100": (
        "synthesis.pairs[2]: branch defect: every four-bar through these pairs of angles reaches some of "
        "them only in its other assembly\n"
        "  found:   [120, 100]\n"
        "  allowed: nearest feasible value: pairs[2][1]: 82.7"
    ),
    "pairs: [[30, 60], [80, 100], [120, 60], [150, 80]], l4: 100": (
        "synthesis.pairs[3]: no four-bar passes through these pairs of angles\n"
        "  found:   [150, 80]\n"
        "  allowed: nearest feasible value: pairs[3][1]: 22.31"
    ),
    "pairs: [[30, 60], [80, 90], [120, 100]]": (
        "synthesis: give exactly one length: it determines the size of the four-bar\n"
        "  found:   none\n"
        "  allowed: one of l1, l2, l3, l4"
    ),
    "pairs: [[0, 0], [20, 15], [40, 33], [60, 55], [80, 83]], l4: 100, phi0: 10": (
        "synthesis.phi0: 5 pairs also determine both zero angles\n  found:   phi0\n  allowed: neither phi0 nor psi0"
    ),
    "pairs: [[20, 35], [35, 45], [50, 60]], l4: 100, choose: 2": (
        "synthesis.choose: there is no solution with this number, or it has a defect\n  found:   2\n  allowed: 1"
    ),
    "pairs: [[0, 0], [20, 15], [40, 33], [60, 55]], l4: 100, choose: 2": (
        "synthesis.choose: there is no solution with this number, or it has a defect\n  found:   2\n  allowed: 1"
    ),
    "pairs: [[20, 35], [35, 45], [50, 60]], l4: -100": (
        "synthesis.l4: this value is too small for a mechanism\n  found:   -100\n  allowed: 0.001 mm or more"
    ),
    "function: log(x), x: [1, 2], input: [30, 120], output: [60, 120], l4: 100": (
        "synthesis.function: unknown function\n  found:   'log(x)'\n"
    ),
    'function: "", x: [1, 2], input: [30, 120], output: [60, 120], l4: 100': (
        "synthesis.function: unknown function\n  found:   ''\n  allowed: log10(x), ln(x), exp(x), "
    ),
    "pairs: [[0, 0], [10, 12], [20, 22], [30, 34], [40, 42], [50, 55]], l4: 100, link_ratio: 0.5": (
        "synthesis.link_ratio: this limit is outside its range\n  found:   0.5\n"
        "  allowed: a number greater than 1, at most 1000"
    ),
    "pairs: [[30, 60], [80, 90], [120, 130]], l4: 100, transmission: 89": (
        "synthesis.transmission: no four-bar through these pairs of angles has so large a smallest transmission angle\n"
        "  found:   89\n"
        "  allowed: nearest feasible value: transmission: "
    ),
    "pairs: [[20, 35], [35, 45], [50, 60]], l4: 100, l3: 80, phi0: 5": (
        "synthesis.phi0: three pairs and two lengths also determine phi0\n  found:   phi0\n  allowed: psi0"
    ),
    "pairs: [[20, 35], [35, 45], [50, 60]], l1: 100, l3: 80": (
        "synthesis: give exactly one length: it determines the size of the four-bar\n"
        "  found:   l1, l3\n"
        "  allowed: one of l1, l2, l3, l4; or l4 and one of l1, l3"
    ),
    "function: ln(x), x: [-1, 2], input: [30, 120], output: [60, 120], l4: 100": (
        "synthesis.x: the function is undefined in this range, or has equal values at both ends\n"
        "  allowed: x greater than 0"
    ),
    "function: x^2, x: [-1, 1], input: [30, 120], output: [60, 120], l4: 100": (
        "synthesis.x: the function is undefined in this range, or has equal values at both ends\n"
        "  allowed: a range with different values of the function at its ends"
    ),
    "l4: 100": "synthesis: these keys do not determine a mechanism\n  found:   none\n"
    "  allowed: pairs; or function (or table), x, input, output",
}


@pytest.mark.parametrize("block", REFUSED)
def test_what_cannot_be_is_refused_with_the_reason_and_what_can(block):
    with pytest.raises(ProblemError) as caught:
        problem(block)
    assert str(caught.value).partition(": ")[2].startswith(REFUSED[block])


def test_the_nearest_output_angle_that_is_told_is_good_and_one_that_is_nearer_is_not():
    problem("pairs: [[30, 60], [80, 60], [120, 82.7281]], l4: 100")
    with pytest.raises(ProblemError, match="branch defect"):
        problem("pairs: [[30, 60], [80, 60], [120, 82.7282]], l4: 100")


def test_a_branch_defect_that_is_kept_shows_on_the_mechanism():
    found = problem("pairs: [[30, 60], [80, 60], [120, 100]], l4: 100, defects: keep")
    every = measure_demands(found.synthesis.outcome, solve(found, "kinematics"))
    assert not all(m.met for m in every)


@pytest.mark.parametrize(
    "block",
    [
        "function: log10(x), x: [1, 2], input: [45, 105], output: [0, 90], l4: 100",
        "function: x^2, x: [0, 1], input: [30, 120], output: [60, 150], points: 5, l4: 100",
        "table: [[0, 0], [1, 2], [2, 5]], input: [90, 30], output: [110, 60], l4: 100",
    ],
)
def test_the_largest_structural_error_is_that_of_all_places_not_of_a_scan(block):
    outcome = problem(block).synthesis.outcome
    largest = next(v.value for v in outcome.found if v.text == "largest structural error")
    curve = next(d for d in outcome.drawings if getattr(d, "name", "") == "error").lines[0]
    k = int(np.argmax(np.abs(curve.y)))
    assert largest == pytest.approx(abs(curve.y[k]), rel=1e-14)
    if 0 < k < len(curve.x) - 1 and "table" not in block:
        near = np.abs(curve.y[[k - 1, k + 1]])
        assert (near <= largest).all() and (near > largest * (1 - 1e-3)).all()
        inner = np.abs(curve.x[k] - curve.x[[k - 1, k + 1]])
        bend = (largest - near) / inner**2  # of a smooth peak the same on either side, to first order
        assert bend[0] == pytest.approx(bend[1], rel=0.1)


def test_what_was_asked_of_a_function_is_told_with_its_ranges_and_angles_as_angles():
    ranges = {}
    for x in ("[0, 90]", "[0, pi/2]"):
        outcome = problem(
            f"function: sin(x), x: {x}, input: [0, 90], output: [0, 60], points: 5, l4: 1"
        ).synthesis.outcome
        asked = {v.text: v for v in outcome.asked}
        assert asked["x at the end of the range"].kind == "angle"
        names = ("x", "input angle", "output angle")
        ranges[x] = [
            float(asked[f"{name} at the {end}"].value)
            for name in names
            for end in ("start of the range", "end of the range")
        ]
    assert ranges["[0, 90]"] == pytest.approx(np.radians([0, 90, 0, 90, 0, 60]), rel=1e-14)
    assert ranges["[0, pi/2]"] == pytest.approx(ranges["[0, 90]"], rel=1e-14)


def test_every_solution_has_the_number_by_which_it_is_chosen():
    block = "pairs: [[0, 0], [20, 15], [40, 33], [60, 55]], l2: 100, defects: keep"
    (listing,) = problem(block).synthesis.outcome.listings
    assert sum(row[1] is not None for row in listing.rows) == 1 and len(listing.rows) > 1
    for row in listing.rows:
        taken = problem(f"{block}, choose: {row[0]}").synthesis.outcome
        lengths = [float(taken.parameters[f"l{k}"].value) for k in range(1, 5)]
        assert lengths == pytest.approx(row[2:6], rel=1e-14)
        (again,) = taken.listings
        assert [r[0] for r in again.rows if r[1]] == [row[0]]


def test_two_pairs_and_one_length_tell_the_free_ratio_and_the_family_of_it():
    outcome = problem("pairs: [[30, 60], [80, 90]], l4: 100").synthesis.outcome
    free = next(v.value for v in outcome.found if v.text == "ratio l4/l1 (free with two pairs of angles)")
    assert free == pytest.approx(float(outcome.parameters["l4"].value / outcome.parameters["l1"].value))
    assert any("the transmission angle is best at one end of the range" in note for note in outcome.notes)  # l4 = 10 l1
    (family,) = outcome.listings
    for ratio, l1, l2, l3, l4, phi0, psi0, *_ in family.rows[::20]:
        assert l4 / l1 == pytest.approx(ratio, rel=1e-12)
        for phi, psi in np.radians([(30, 60), (80, 90)]):
            b, c = l1 * np.exp(1j * (phi0 + phi)), l4 + l3 * np.exp(1j * (psi0 + psi))
            assert abs(b - c) == pytest.approx(l2, rel=1e-9)
    assert not any(
        one.long for one in problem("pairs: [[30, 60], [80, 90]], l4: 100, l1: 40").synthesis.outcome.listings
    )
