"""All real assemblies of a group: how many there are, that none is missed, and how `tmm kinematics` shows them."""

from __future__ import annotations

import cmath
import csv
import json
import math
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from bank import moved
from random_linkages import Maker
from test_commands import described, tmm

from tmm_cli import load, solve
from tmm_cli.mechanics.assembly import assemble, close_from_afar, find_assemblies, placed_by_angles
from tmm_cli.mechanics.groups import DriverMotion, NewtonSolver, driven_state, drives_at, frame_state
from tmm_cli.mechanics.kinematics import compute_motion, find_range
from tmm_cli.mechanics.linkage import FRAME, Driver, Hinge, Link, Linkage, Sketch
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem import ProblemError, build_problem, read_text

SIX = Path(__file__).parent.parent / "problems" / "triad-six-assemblies.yaml"
THREE_EQUAL_LEGS = """tmm: 1
points: {O: [0, 0], C: [300, 0], D: [300, 200]}
links:
  1: {points: [O, A], length: 100}
  2: {points: {P: [0, 0], Q: [200, 0], R: [200, 200]}}
  3: {points: [A, P], length: 100}
  4: {points: [C, Q], length: 100}
  5: {points: [D, R], length: 100}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0 deg}
"""


def problem(text):
    return build_problem(read_text(text, "case.yaml"))


def undecided(text):
    """The text of a problem file without the points of its sketch."""
    lines = [line if not line.startswith("sketch:") else "sketch: {at: 90 deg}" for line in text.splitlines()]
    return "\n".join(lines) + "\n"


# exact count of the assemblies of one triad, without the calculator


def times(a, b):
    product = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            product[i + j] += x * y
    return product


def plus(a, b, factor=1):
    size = max(len(a), len(b))
    a, b = a + [Fraction(0)] * (size - len(a)), b + [Fraction(0)] * (size - len(b))
    return [x + factor * y for x, y in zip(a, b, strict=True)]


def trimmed(a):
    a = list(a)
    while a and a[-1] == 0:
        a.pop()
    return a


def remainder(a, b):
    a, b = trimmed(a), trimmed(b)
    while len(a) >= len(b):
        factor, shift = a[-1] / b[-1], len(a) - len(b)
        for k, y in enumerate(b):
            a[shift + k] -= factor * y
        a = trimmed(a[:-1])
    return a


def real_roots(polynomial):
    """Number of distinct real roots by J. C. F. Sturm's theorem, in exact arithmetic."""
    chain = [trimmed(polynomial), trimmed([k * c for k, c in enumerate(polynomial)][1:])]
    while rest := remainder(chain[-2], chain[-1]):
        chain.append([-c for c in rest])

    def changes(signs):
        signs = [s for s in signs if s]
        return sum(a != b for a, b in pairwise(signs))

    low = [(-1) ** (len(p) - 1) * p[-1] > 0 for p in chain]
    high = [p[-1] > 0 for p in chain]
    return changes([1 if s else -1 for s in low]) - changes([1 if s else -1 for s in high])


def triad_polynomial(centres, corners, radii):
    """The polynomial in t = tan(phi/2) whose real roots are the assemblies of a triad of turning pairs.

    For the corner P at w from its centre and s = 1 + t^2: the corners k are at w + h_k, where s h_k is a polynomial of
    the second degree, and |w + h_k| = r_k less |w| = r_1 is linear in w: 2 h_k . w = r_k^2 - r_1^2 - |h_k|^2.
    """
    one = [Fraction(1), Fraction(0), Fraction(1)]
    cos, sin = [Fraction(1), Fraction(0), Fraction(-1)], [Fraction(0), Fraction(2)]
    rows = []
    for k in (1, 2):
        (px, py), (cx, cy) = (
            tuple(Fraction(b - a) for a, b in zip(p[0], p[k], strict=True)) for p in (corners, centres)
        )
        hx = plus(plus([px * c for c in cos], [-py * c for c in sin]), [-cx * c for c in one])  # times s
        hy = plus(plus([px * c for c in sin], [py * c for c in cos]), [-cy * c for c in one])
        square = plus(times(hx, hx), times(hy, hy))  # times s^2
        flat = times(one, one)
        right = plus([Fraction(radii[k] ** 2 - radii[0] ** 2) * c for c in flat], square, -1)
        rows.append((hx, hy, right))  # 2 s (hx x + hy y) = right
    (ax, ay, a), (bx, by, b) = rows
    det = plus(times(ax, by), times(ay, bx), -1)
    x, y = plus(times(a, by), times(b, ay), -1), plus(times(ax, b), times(bx, a), -1)  # 2 s det w = (x, y)
    left = plus(times(x, x), times(y, y))
    right = [4 * Fraction(radii[0]) ** 2 * c for c in times(times(one, one), times(det, det))]
    found = trimmed(plus(left, right, -1))
    while not (rest := remainder(found, one)) and len(found) > 3:  # factors of s = 1 + t^2 have no real roots
        found, _ = quotient(found, one), rest
    return found


def quotient(a, b):
    a, found = list(a), []
    while len(a) >= len(b):
        factor = a[-1] / b[-1]
        found.append(factor)
        for k, y in enumerate(b):
            a[len(a) - len(b) + k] -= factor * y
        a.pop()
    return found[::-1]


def test_a_triad_with_six_assemblies_exactly():
    """With the crank at 90 deg all coordinates are whole: Sturm's theorem counts six roots of a sextic, exactly."""
    polynomial = triad_polynomial([(0, 40), (160, 0), (130, 180)], [(0, 0), (230, 0), (140, 150)], [110, 110, 110])
    assert len(polynomial) - 1 == 6
    assert real_roots(polynomial) == 6
    given = load(str(SIX))
    results = solve(given, "kinematics")
    found = find_assemblies(given.linkage, results.structure, results.kernels, math.pi / 2).groups[0]
    assert (found.method, found.most, found.complete, len(found.assemblies)) == ("polynomial", 6, True, 6)
    for assembly in found.assemblies:
        t = math.tan(assembly.angles["2"] / 2)
        value = sum(float(c) * t**k for k, c in enumerate(polynomial))
        slope = sum(k * float(c) * t ** (k - 1) for k, c in enumerate(polynomial) if k)
        assert abs(value / slope) < 1e-10 * (1 + t * t)
        legs = [abs(assembly.points[p] - c) for p, c in zip("PQR", (0.04j, 0.16, 0.13 + 0.18j), strict=True)]
        assert legs == pytest.approx([0.11] * 3, rel=1e-12)
    assert [a.of_sketch for a in found.assemblies].count(True) == 1
    sketched = next(a for a in found.assemblies if a.of_sketch)
    assert sketched.points["P"] == pytest.approx(complex(results.motion.named("P").x[3]), abs=1e-12)


# random triads


def triad(seed, legs):
    """Link 2 on three legs of the given kinds (outer and inner pair) on the frame and a crank; it is assembled."""
    maker = Maker(seed)
    maker.link("1")
    maker.hinge("O", FRAME, "1")
    for name in "2345":
        maker.link(name)
    for leg, kind, known in zip("345", legs, ("1", FRAME, "1" if maker.random.random() < 0.5 else FRAME), strict=True):
        for letter, other, name in ((kind[0], known, f"U{leg}"), (kind[1], "2", f"V{leg}")):
            maker.hinge(name, other, leg) if letter == "R" else maker.slide(name.lower(), other, leg)
    links = {name: Link(name, points) for name, points in maker.points.items()}
    angles = {name: cmath.phase(z) for name, (_, z) in maker.poses.items() if name != FRAME}
    hinges = tuple(Hinge(name, tuple(joined)) for name, joined in maker.hinges.items())
    driver = Driver("1", "turn", "O", 1.0)
    return Linkage(links, hinges, tuple(maker.slides), driver, Sketch(angles["1"], {}, angles)), maker.poses


def listed(linkage):
    """The assemblies of the triad of a linkage with its kernel, the poses before it and the drivers."""
    structure = analyse_structure(linkage)
    q = np.array([linkage.sketch.at])
    drives = drives_at(linkage, q)
    placed = {FRAME: frame_state(q)[0], "1": driven_state(linkage, linkage.driver, drives["1"])[0]}
    found = find_assemblies(linkage, structure, (), linkage.sketch.at).groups[0]
    return found, NewtonSolver.of(structure.groups[0], linkage), placed, drives


def random_legs(seed):
    random = np.random.default_rng(seed + 10**6)
    kinds = [("RR", "PR", "RP")[k] for k in random.integers(0, 3, 3)]
    return ["RR"] * 3 if seed % 3 == 0 else [*kinds[:2], "PP"] if seed % 10 == 1 else kinds


def test_no_assembly_of_random_triads_is_missed():
    """60 triads of turning and sliding pairs: what was put together is found, and all that many starts find."""
    counts = set()
    for seed in range(60):
        linkage, poses = triad(seed, random_legs(seed))
        found, kernel, placed, drives = listed(linkage)
        assert found.method == "polynomial" and len(found.assemblies) <= found.most
        counts.add(len(found.assemblies))
        # real assemblies come in pairs, unless every equation is linear
        assert len(found.assemblies) % 2 == 0 or found.most == 1

        def among(angles, found=found):
            return any(
                max(abs(cmath.exp(1j * a.angles[n]) - z) for n, z in angles.items()) < 1e-6 for a in found.assemblies
            )

        assert among({n: poses[n][1] for n in "2345"}), seed
        turn = np.random.default_rng(seed).uniform(-np.pi, np.pi, (60, 4))
        with np.errstate(all="ignore"):
            states, closed = close_from_afar(kernel, placed, drives, placed_by_angles(kernel, placed, drives, turn))
        for k in np.flatnonzero(closed):
            assert among({n: cmath.exp(1j * states.unwrapped[k, kernel.order[n]]) for n in "2345"}), seed
    assert {2, 4, 6} <= counts


def crossings(linkage, steps=20_000):
    """Assemblies of a triad of turning pairs counted with one lead cut: how often the closing distance changes sign.

    The cut leg's neighbour turns through a circle; the rest is a dyad with two assemblies, which meet where its way
    ends. So they are walked through one after the other, as one closed line.
    """
    pose = {"1": cmath.exp(1j * linkage.sketch.at)}

    def known(point):
        if point in linkage.links[FRAME].points:
            return linkage.local(FRAME, point)
        return (linkage.local("1", point) - linkage.local("1", "O")) * pose["1"] + linkage.local(FRAME, "O")

    a, b, c = (known(f"U{leg}") for leg in "345")
    ra, rb, rc = (abs(linkage.local(leg, f"U{leg}") - linkage.local(leg, f"V{leg}")) for leg in "345")
    p, q, r = (linkage.local("2", f"V{leg}") for leg in "345")
    turn = (np.arange(steps) + 0.5) * 2 * np.pi / steps
    first = a + ra * np.exp(1j * turn)
    base, side = b - first, abs(q - p)
    d = np.abs(base)
    x = (d * d + side * side - rb * rb) / (2 * d)
    with np.errstate(invalid="ignore"):
        h = np.sqrt(side * side - x * x)
    values = []
    for sign in (1, -1):
        z = (x + 1j * sign * h) * base / d / (q - p)
        values.append(np.abs(first + (r - p) * z - c) - rc)
    closes = np.isfinite(h)
    if closes.all():
        return sum(int(np.count_nonzero(np.sign(v) != np.sign(np.roll(v, 1)))) for v in values)
    start = int(np.flatnonzero(~closes)[0])
    closes, values = np.roll(closes, -start), [np.roll(v, -start) for v in values]
    edges = np.flatnonzero(np.diff(closes.astype(int)))
    ends = [*edges, steps - 1] if len(edges) % 2 else edges
    number = 0
    for low, high in zip(ends[::2], ends[1::2], strict=True):
        way = np.concatenate([values[0][low + 1 : high + 1], values[1][low + 1 : high + 1][::-1]])
        number += int(np.count_nonzero(np.sign(way) != np.sign(np.roll(way, 1))))
    return number


def test_a_cut_lead_counts_the_same_assemblies():
    """60 triads of turning pairs: the sign changes of the distance that closes the cut lead."""
    for seed in range(60):
        linkage, _ = triad(seed, ["RR"] * 3)
        assert len(listed(linkage)[0].assemblies) == crossings(linkage), seed


def test_two_legs_on_one_compound_hinge_are_legs_of_a_triad_too():
    """Legs 3 and 4 make a triangle with link 2 that lies on either side of PQ; it turns about A until leg 5 closes."""
    text = """tmm: 1
points: {O: [0, 0], D: [130, 180]}
links:
  1: {points: [O, A], length: 40}
  2: {points: {P: [0, 0], Q: [230, 0], R: [140, 150]}}
  3: {points: [A, P], length: 150}
  4: {points: [A, Q], length: 170}
  5: {points: [D, R], length: 200}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 90 deg}
"""
    linkage = problem(text).linkage
    (group,) = find_assemblies(linkage, analyse_structure(linkage), (), math.pi / 2).groups
    assert (group.method, len(group.assemblies)) == ("polynomial", 4)
    side = [
        math.copysign(1, ((0.04j - a.points["P"]) / (a.points["Q"] - a.points["P"])).imag) for a in group.assemblies
    ]
    assert sorted(side) == [-1, -1, 1, 1]


def test_links_that_hang_on_a_leg_do_not_hide_the_triad():
    """In the press the rod to the ram hangs on lever 2, which is a leg of the triad."""
    results = moved("press-class-iii")
    linkage, structure = results.linkage, results.structure
    triad, dyad = find_assemblies(linkage, structure, results.kernels, results.start).groups
    assert (triad.group.links, triad.method, triad.complete) == (("2", "5", "6", "7"), "polynomial", True)
    assert (
        [a.of_sketch for a in triad.assemblies].count(True) == 1 == [a.of_sketch for a in dyad.assemblies].count(True)
    )


def test_two_assemblies_meet_where_the_driver_turns_back():
    """At the end of the driver's way one assembly counts twice; before it there is one more, beyond it one less."""
    seed = 7
    while True:
        linkage, _ = triad(seed, ["RR"] * 3)
        structure = analyse_structure(linkage)
        kernels = assemble(linkage, structure)
        way = find_range(linkage, kernels)
        if not way.full:
            break
        seed += 1

    def at(q):
        return find_assemblies(linkage, structure, kernels, q).groups[0]

    before, there, beyond = at(way.end - 1e-4), at(way.end), at(way.end + 1e-4)
    assert there.dead and not before.dead and not beyond.dead
    assert len(there.assemblies) == len(before.assemblies) - 1 == len(beyond.assemblies) + 1
    assert any(a.of_sketch for a in before.assemblies) and not any(a.of_sketch for a in beyond.assemblies)


def test_the_search_ends_where_a_group_moves_by_itself():
    """Three parallel legs of one length carry a link that can go round a circle: its assemblies have no end."""
    given = problem(THREE_EQUAL_LEGS)
    with pytest.raises(ProblemError, match=r"group III\(2,3,4,5\)"):
        solve(given, "kinematics")
    (group,) = find_assemblies(given.linkage, analyse_structure(given.linkage), (), 0.0).groups
    assert group.moves and not group.complete
    assert 1 <= len(group.assemblies) <= 6


def test_a_dyad_has_two_assemblies_one_in_a_dead_position_and_none_out_of_reach():
    text = """tmm: 1
points: {O: [0, 0], D: [300, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 250}
  3: {points: [D, B], length: 150}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [300, 150]}
"""
    linkage = problem(text).linkage
    structure = analyse_structure(linkage)
    kernels = assemble(linkage, structure)

    def count(q, linkage=linkage, kernels=kernels):
        found = find_assemblies(linkage, structure, kernels, q).groups[0]
        assert found.complete and found.method == "closed form"
        return len(found.assemblies), found.dead

    assert count(math.pi / 3) == (2, False)
    assert count(math.pi) == (1, True)  # 100 + 300 = 250 + 150: links 2 and 3 in line
    assert count(0.0) == (2, False)
    shorter = problem(text.replace("length: 250", "length: 220")).linkage
    assert count(math.pi, shorter, assemble(shorter, structure)) == (0, False)


def test_a_group_of_class_four_is_listed_without_a_proof():
    """Two ternary links on the crank and the frame, joined by two bars: an even number, one of them the sketch's."""
    for seed in range(2):
        maker = Maker(seed)
        maker.link("1")
        maker.hinge("O", FRAME, "1")
        for name in "2345":
            maker.link(name)
        for point, *joined in ("A12", "D03", "B24", "C34", "E25", "F35"):
            maker.hinge(point, *joined)
        links = {name: Link(name, points) for name, points in maker.points.items()}
        angles = {name: cmath.phase(z) for name, (_, z) in maker.poses.items() if name != FRAME}
        hinges = tuple(Hinge(name, tuple(joined)) for name, joined in maker.hinges.items())
        linkage = Linkage(links, hinges, (), Driver("1", "turn", "O", 1.0), Sketch(angles["1"], {}, angles))
        structure = analyse_structure(linkage)
        (group,) = find_assemblies(linkage, structure, assemble(linkage, structure), linkage.sketch.at).groups
        assert group.group.group_class == 4
        assert (group.method, group.complete, group.most) == ("many starts", False, None)
        assert [a.of_sketch for a in group.assemblies].count(True) == 1
        assert len(group.assemblies) % 2 == 0


# as a user sees it


def test_the_command_lists_and_draws_every_assembly(tmp_path):
    done = tmm("kinematics", SIX, "--assemblies", "--json", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    schema = json.loads(tmm("schema", "--result").stdout)
    described(result, schema, "")
    (place,) = result["assemblies"]
    assert (place["position"], place["undecided"]) == (3, None)
    (group,) = place["groups"]
    assert group["complete"] and len(group["assemblies"]) == 6
    folder = tmp_path / "triad-six-assemblies"
    assert (folder / "assemblies-III-2-3-4-5.png").read_bytes().startswith(b"\x89PNG")
    assert "</svg>" in (folder / "assemblies-III-2-3-4-5.svg").read_text(encoding="utf-8")
    with open(folder / "assemblies-III-2-3-4-5.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["source"] for row in rows].count("sketch") == 1
    assert {"angle of 2, deg", "P x, mm", "P y, mm", "margin"} <= set(rows[0])
    files = json.loads((folder / "result.json").read_text(encoding="utf-8"))["files"]
    assert "assemblies-III-2-3-4-5.png" in files


def test_positions_of_the_listing_are_chosen(tmp_path):
    done = tmm("kinematics", SIX, "--assemblies", "-p", 0, "-p", 6, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "position 0, crank at 0 deg: 6" in done.stdout and "position 6, crank at 180 deg: 6" in done.stdout
    names = {path.name for path in (tmp_path / "outputs" / "triad-six-assemblies").iterdir()}
    assert {"assemblies-III-2-3-4-5-00.png", "assemblies-III-2-3-4-5-06.svg"} <= names


def test_an_undecided_sketch_is_told_of_the_listing_and_the_listing_works(tmp_path):
    file = tmp_path / "undecided.yaml"
    file.write_text(undecided(SIX.read_text(encoding="utf-8")), encoding="utf-8")
    refused = tmm("kinematics", file)
    assert refused.returncode == 2
    assert f"tmm kinematics {file} --assemblies" in refused.stderr
    done = tmm("kinematics", file, "--assemblies", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "the sketch does not determine the assembly" in done.stderr
    (place,) = json.loads(done.stdout)["assemblies"]
    assert place["undecided"] == "III(2,3,4,5)" and place["position"] is None
    (group,) = place["groups"]
    assert len(group["assemblies"]) == 6 and not any(a["sketch"] for a in group["assemblies"])
    # every one of them, put into the sketch, is then the one that is computed
    for assembly in group["assemblies"]:
        places = [f"{p}: [{1000 * at['x']:.0f}, {1000 * at['y']:.0f}]" for p, at in assembly["points"].items()]
        sketch = f"sketch: {{at: 90 deg, {', '.join(places)}}}"
        given = problem(undecided(SIX.read_text(encoding="utf-8")).replace("sketch: {at: 90 deg}", sketch))
        kernels = assemble(given.linkage, analyse_structure(given.linkage))
        there = compute_motion(given.linkage, kernels, np.array([math.pi / 2]), DriverMotion(0.0, 1.0, 0.0, 1))
        assert float(np.angle(there.poses["2"].z)[0]) == pytest.approx(assembly["angles"]["2"], abs=1e-9)


def test_without_the_option_nothing_is_listed():
    done = tmm("kinematics", SIX, "--json")
    assert done.returncode == 0 and "assemblies" not in json.loads(done.stdout)
