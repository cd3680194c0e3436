"""Where the count and the truth differ: the numerical rank decides and names what is passive."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
import random_linkages
from bank import EVERY, problem, solved
from models import solved_text
from test_commands import tmm
from test_jams import planets

from tmm_cli import solve
from tmm_cli.mechanics.assembly import analyse_mobile_structure
from tmm_cli.mechanics.linkage import FRAME, Hinge, Link
from tmm_cli.mechanics.numerics import CROSSING_AGREES
from tmm_cli.mechanics.structure import PairRedundancy, analyse_structure, classify_linkage, list_ties
from tmm_cli.problem import ProblemError
from tmm_cli.reports import reduction_sentences

WITH_A_DYAD = Path("tests/data/redundant-first.yaml").read_text(encoding="utf-8")

PARALLELOGRAM = """tmm: 1
points: {O: [0, 0], C: [300, 0]}
links:
  1: {points: {O: [0, 0], A: [100, 0], D: [60, 0]}}
  2: {points: [A, B], length: 300}
  3: {points: {C: [0, 0], B: [100, 0], E: [60, 0]}}
  4: {points: [D, E], length: DE}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [350, 86], D: [30, 52], E: [330, 52]}
masses: {2: {mass: 3 kg, inertia: 0.1, centre: {on: AB}}, 4: {mass: 1 kg, inertia: 0.01, centre: {on: DE}}}
loads: {M: {on: 3, moment: -10}}
positions: {count: 7, from: 20 deg}
parameters: {DE: 300}
"""
WEDGE = """tmm: 1
guides: {x: {through: [0, 0], angle: 0}, y: {through: [0, 0], angle: 90}}
links:
  1: {points: {A: [0, 0]}, slides: {on: x}}
  2: {points: {B: [0, 0]}, slides: [{on: y}, {on: 1, through: [0, 0], angle: 30}]}
driver: {link: 1, speed: 0.1 m/s}
sketch: {at: 50 mm, B: [0, -29]}
masses: {2: {mass: 3 kg}}
gravity: 9.81
positions: {at: [0, 10, 20]}
"""
BOLTED = """
tmm: 1
points: {O: [0, 0]}
guides: {x: {through: O, angle: 0}}
links:
  1: {points: [O, A], length: 60}
  2: {points: {A: [0, 0], M: [100, 0], N: [140, 20]}}
  3: {points: {M: [0, 0], N: [40, 20], B: [120, 0]}}
  4: {points: [B], slides: x}
driver: {link: 1, speed: 300 rpm}
sketch: {at: 90, A: [0, 60], M: [95, 35], N: [140, 45], B: [211, 0]}
"""
GUIDES = """tmm: 1
points: {O: [0, 0]}
guides: {x: {through: [0, 0], angle: 0}, y: {through: [0, 40], angle: ANGLE}}
links:
  1: {points: [O, A], length: 50}
  2: {points: [A, B], length: 200}
  3: {points: {B: [0, 0], K: [10, 40]}, slides: [{on: x}, {on: y, point: K}]}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [220, 0]}
masses: {3: {mass: 3 kg, centre: B}}
"""


def test_the_second_coupler_of_a_parallelogram_is_passive_and_named():
    results = solved_text(PARALLELOGRAM)
    structure = results.structure
    assert structure.mobility == 0 and structure.redundant == 1
    (passive,) = structure.passive
    assert (passive.pair, passive.links) == ("E", ("3", "4"))
    assert passive.among == ("0", "1", "2", "3", "4")
    assert structure.formula == "I(0,1) -> II(2,3)"
    assert [*reduction_sentences(structure)] == ["link 4 is redundant; redundant constraints q = 1"]


def test_the_parallelogram_with_two_couplers_moves_as_one():
    results = solved_text(PARALLELOGRAM)
    assert results.driver_range.full
    turned = results.motion.link("3")
    assert np.max(np.abs(np.angle(np.exp(1j * (turned.angle - results.motion.q))))) < 1e-14
    assert np.max(np.abs(turned.omega - 2 * math.pi)) < 1e-12
    for link in ("2", "4"):
        assert np.max(np.abs(results.motion.link(link).omega)) < 1e-12


def test_its_cranks_turn_alike_to_the_last_digits_however_near_to_its_change_points():
    angles = (start + step for start in (7, 0.3, 179.9) for step in range(0, 360, 30))
    text = PARALLELOGRAM.replace("count: 7, from: 20 deg", "at: [{}]".format(", ".join(f"{a:g} deg" for a in angles)))
    motion = solved_text(text).motion
    for link in ("2", "3", "4"):
        assert np.max(np.abs(motion.second[link].e)) < 1e-15, "in units of the square of the crank's speed"
        assert np.max(np.abs(motion.first[link].w - (link == "3"))) < 1e-15
    on_circle = -0.1 * (2 * math.pi) ** 2 * np.exp(1j * motion.q)
    assert np.max(np.abs(motion.named("B").a - on_circle)) < 1e-15 * np.max(np.abs(on_circle))


def test_its_balancing_moment_follows_from_power_alone():
    results = solved_text(PARALLELOGRAM)
    # both couplers go round on circles without turning: the work of their weights and of the load, none of inertia
    expected = 10 + 9.81 * np.cos(results.motion.q) * (3 * 0.1 + 1 * 0.06)
    assert np.max(np.abs(results.reactions.balance.moment - expected)) < 1e-13 * np.max(expected)
    assert np.max(np.abs(results.energy.balance)) < 1e-13
    assert np.max(results.lever.difference) < 1e-13


def test_another_length_of_the_second_coupler_locks_it():
    with pytest.raises(ProblemError) as caught:
        solved_text(PARALLELOGRAM.replace("{DE: 300}", "{DE: 305}"))
    assert str(caught.value) == (
        "x.yaml:8:16: driver.link: link 1 cannot be a driver: pairs or other drivers already "
        "determine its motion\n"
        "  found:   W = 3*4 - 2*6 = 0; links with redundant constraints: 0, 1, 2, 3, 4\n"
        "  allowed: W = 1"
    )


def test_a_wedge_of_three_sliding_pairs_has_one_freedom():
    results = solved_text(WEDGE)
    assert (results.structure.mobility, results.structure.redundant) == (0, 1)
    slope = math.tan(math.radians(30))
    assert np.allclose(results.motion.named("B").v, -0.1j * slope, rtol=0, atol=1e-14 * 0.1 * slope)
    # the weight of the follower, over the slope
    assert np.allclose(results.reactions.balance.force, -3 * 9.81 * slope, rtol=1e-14)


def test_a_second_parallel_guide_is_passive_and_an_inclined_one_locks():
    results = solved_text(GUIDES.replace("ANGLE", "0"))
    assert (results.structure.mobility, results.structure.redundant) == (-1, 2)
    (passive,) = results.structure.passive
    assert (passive.pair, passive.constraints, passive.links) == ("y", 2, ("0", "3"))
    one = GUIDES.replace(", {on: y, point: K}", "").replace(", y: {through: [0, 40], angle: ANGLE}", "")
    alone = solved_text(one)
    both = [(r.motion.named("B").a, r.reactions.balance.moment) for r in (results, alone)]
    for found, expected in zip(*both, strict=True):
        assert np.allclose(found, expected, rtol=0, atol=1e-15 * np.max(np.abs(expected)))
    with pytest.raises(ProblemError, match="the mobility is not 1: pair y adds redundant constraints"):
        solved_text(GUIDES.replace("ANGLE", "5"))


def in_order(text, *links):
    """The same file with its links, one a line, in another order."""
    lines = text.splitlines()
    first = lines.index("links:") + 1
    names = [line.split(":")[0].strip() for line in lines[first : first + len(links)]]
    assert sorted(names) == sorted(links)
    lines[first : first + len(links)] = [lines[first + names.index(link)] for link in links]
    return "\n".join([*lines, ""])


FOUR_BAR = """tmm: 1
points: {O: [0, 0], C: [300, 0]}
links:
  1: {points: CRANK}
  2: {points: [A, B], length: 300}
  3: {points: ROCKER}
MORE
driver: {link: 1, speed: 1 rad/s}
sketch: {at: 60 deg, B: [340, 196]SKETCHED}
"""


def four_bar(*more, crank="[O, A], length: 100", rocker="[C, B], length: 200", sketched=""):
    """A four-bar linkage with further links."""
    text = FOUR_BAR.replace("CRANK", crank).replace("ROCKER", rocker).replace("SKETCHED", sketched)
    return text.replace("MORE", "\n".join(f"  {line}" for line in more))


ON_THE_SECOND = """tmm: 1
points: {O: [0, 0], C: [300, 0]}
guides: {x: {through: [0, -200], angle: 0}}
links:
  1: {points: {O: [0, 0], A: [100, 0], D: [60, 0]}}
  2: {points: {A: [0, 0], B: [300, 0], H: [100, 60]}}
  3: {points: {C: [0, 0], B: [100, 0], E: [60, 0]}}
  4: {points: {D: [0, 0], E: [300, 0], F: [150, 50]}}
  5: {points: [F, G], length: 400}
  6: {points: [G], slides: x}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [350, 87], H: [150, 147], D: [30, 52], E: [330, 52], F: [180, 102], G: [400, -200]}
"""
ON_BOTH = (
    ON_THE_SECOND.replace("guides: {", "guides: {z: {through: [0, 500], angle: 0}, ")
    .replace("slides: x}\n", "slides: x}\n  7: {points: [H, K], length: 450}\n  8: {points: [K], slides: z}\n")
    .replace("G: [400, -200]", "G: [400, -200], K: [428, 500]")
)
WHEELS = """tmm: 1
points: {O: [0, 0], C: [300, 0], Q: [600, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: {A: [0, 0], B: [300, 0], D: [600, 0]}}
  3: {points: [C, B], length: 100}
  4: {points: [Q, D], length: 100}
driver: {link: 1, speed: 1 rad/s}
sketch: {at: 60 deg, B: [350, 87], D: [650, 87]}
output: 3
"""


@pytest.mark.parametrize(
    "text, formula, sentences",
    [
        pytest.param(
            four_bar(
                "4: {points: [B, D], length: 150}", "5: {points: [A, D], length: 180}", sketched=", D: [130, 270]"
            ),
            "I(0,1) -> II(2+4+5,3)",
            ["links 2, 4, 5 are rigidly connected and count as one"],
            id="three bars hinged in a triangle",
        ),
        pytest.param(
            four_bar(
                "4: {points: {X: [0, 0], P: [0, 20], A: [60, 0]}}",
                crank="{O: [0, 0], X: [40, 0], P: [40, 20]}",
                sketched=", X: [20, 34], P: [3, 44], A: [50, 86]",
            ),
            "I(0,1+4) -> II(2,3)",
            ["links 1, 4 are rigidly connected and count as one; redundant constraints q = 1"],
            id="a crank of two links bolted together",
        ),
        pytest.param(
            four_bar(
                "4: {points: {U: [0, 0], V: [20, 20], W: [40, 0]}}",
                rocker="[W, B], length: 200",
                sketched=", W: [320, 0]",
            ).replace("C: [300, 0]", "U: [280, 0], V: [300, 20]"),
            "I(0,1) -> II(2,3)",
            ["rigidly attached to the frame and counted as part of it: 4; redundant constraints q = 1"],
            id="a bracket bolted to the frame",
        ),
        pytest.param(
            ON_THE_SECOND,
            "I(0,1) -> II(3,4) -> II(5,6)",
            ["link 2 is redundant; redundant constraints q = 1"],
            id="without the second coupler the dyad on it would fall apart",
        ),
        pytest.param(
            WITH_A_DYAD,
            "I(0,1) -> II(2,3) -> II(5,6)",
            ["link 4 is redundant; redundant constraints q = 1"],
            id="the second coupler on a compound hinge",
        ),
        pytest.param(
            WITH_A_DYAD.replace("links:\n", "hinges: {B: {attached to: 4}}\nlinks:\n"),
            "I(0,1) -> II(3,4) -> II(5,6)",
            ["link 2 is redundant; redundant constraints q = 1"],
            id="the file attaches the dyad to the second coupler",
        ),
        pytest.param(
            ON_BOTH,
            "I(0,1) -> II(2,3) -> II(4) -> II(5,6), II(2,3) -> II(7,8)",
            ["pair E counts as a higher pair, because one of its two constraints is redundant: q = 1"],
            id="neither coupler can be left out",
        ),
        pytest.param(
            WHEELS,
            "I(0,1) -> II(2,3)",
            ["link 4 is redundant; redundant constraints q = 1"],
            id="three coupled wheels, output the second",
        ),
        pytest.param(
            WHEELS.replace("output: 3", "output: 4"),
            "I(0,1) -> II(2,4)",
            ["link 3 is redundant; redundant constraints q = 1"],
            id="three coupled wheels, output the third",
        ),
        pytest.param(
            WEDGE,
            "I(0,1) -> II(2)",
            ["pair B' counts as a higher pair, because one of its two constraints is redundant: q = 1"],
            id="a wedge: its follower is the output",
        ),
        pytest.param(
            GUIDES.replace("ANGLE", "0"),
            "I(0,1) -> II(2,3)",
            ["pair y is redundant; redundant constraints q = 2"],
            id="a second parallel guide",
        ),
        pytest.param(
            BOLTED,
            "I(0,1) -> II(2+3,4)",
            ["links 2, 3 are rigidly connected and count as one; redundant constraints q = 1"],
            id="two parts bolted together, and the slider for an instant as quick as they are",
        ),
        pytest.param(
            planets(3, "h"),
            "I(0,h) -> II(p0) -> II(s)",
            ["link p1 is redundant; redundant constraints q = 1", "link p2 is redundant; redundant constraints q = 1"],
            id="three planets",
        ),
    ],
)
def test_rigid_links_count_as_one_and_redundant_links_and_pairs_are_left_out_of_the_formula(text, formula, sentences):
    structure = solved_text(text, stage="structure").structure
    assert (structure.formula, [*reduction_sentences(structure)]) == (formula, sentences)
    assert [group.mobility for group in structure.groups] == [0] * len(structure.groups)
    n, lower, higher = structure.count
    assert 3 * n - 2 * lower - higher == 1


@pytest.mark.parametrize("seed", range(12))
def test_a_plate_bolted_to_any_link_of_a_random_linkage_changes_no_group(seed):
    """Two bolts are two hinges: they repeat one constraint, and the plate counts as one with its link."""
    random = np.random.default_rng(seed)
    linkage = random_linkages.linkage(seed, tuple(map(str, random.choice(random_linkages.TYPES, 2))))
    plain = analyse_structure(linkage)
    link = str(random.choice([name for name in linkage.moving if len(linkage.links[name].points) > 1]))
    bolts = sorted(linkage.links[link].points)[-2:]
    first, last = (linkage.local(link, bolt) for bolt in bolts)
    plate = Link("plate", {bolts[0]: 0j, bolts[1]: (last - first) * 1j})  # its axes are turned by -90 degrees
    known = {hinge.point: hinge.links for hinge in linkage.hinges}
    hinges = [Hinge(point, (*known.get(point, (link,)), "plate")) for point in bolts]
    others = [hinge for hinge in linkage.hinges if hinge.point not in bolts]
    sketched = {**linkage.sketch.angles, "plate": linkage.sketch.angles[link] - math.pi / 2}
    bolted = analyse_mobile_structure(
        replace(
            linkage,
            links={**linkage.links, "plate": plate},
            hinges=(*others, *hinges),
            sketch=replace(linkage.sketch, angles=sketched),
        )
    )
    alike = next((links for rigid in plain.reduction.rigid if link in (links := rigid.links)), (link,))
    (rigid,) = (rigid for rigid in bolted.reduction.rigid if "plate" in rigid.links)
    assert (set(rigid.links), rigid.constraints) == ({*alike, "plate"}, 1)
    assert bolted.redundant == 1
    assert [(group.type, group.roman) for group in bolted.groups] == [(g.type, g.roman) for g in plain.groups]
    assert bolted.count == plain.count


@pytest.mark.parametrize(
    "name, formula, sentences",
    [
        ("crossed-slots", "I(0,1) -> II(2,3)", ["link 4 is redundant; redundant constraints q = 1"]),
        ("parallel-couplers", "I(0,1) -> II(2,3)", ["link 4 is redundant; redundant constraints q = 1"]),
        (
            "four-bars/transfer",
            "I(0,1) -> II(2,3)",
            [f"link {n} is redundant; redundant constraints q = 1" for n in (4, 5, 6)],
        ),
        (
            "settings/breaking-rod",
            "I(0,1) -> II(2+3,4)",
            ["links 2, 3 are rigidly connected and count as one; redundant constraints q = 1"],
        ),
        (
            "settings/safety-rod",
            "I(0,1) -> II(2,3) -> II(4+5,6)",
            ["links 4, 5 are rigidly connected and count as one; redundant constraints q = 1"],
        ),
    ],
)
def test_all_redundant_linkages_of_the_bank_are_of_class_ii(name, formula, sentences):
    structure = solve(problem(name), "structure").structure
    assert (structure.formula, structure.roman, [*reduction_sentences(structure)]) == (formula, "II", sentences)
    if name == "four-bars/transfer":
        assert classify_linkage(structure) == ("closed", "simple"), "not complex, of several types"


@pytest.mark.parametrize("name", EVERY)
def test_every_group_of_the_bank_is_an_assur_group(name):
    """3n - 2p1 - p2 = 0 for each group, and with the drivers' links it is the number of drivers."""
    structure = analyse_mobile_structure(problem(name).linkage)
    assert [group.mobility for group in structure.groups] == [0] * len(structure.groups)
    n, lower, higher = structure.count
    assert 3 * n - 2 * lower - higher == len(structure.drivers) == structure.mobility + structure.redundant
    reduction = structure.reduction
    added = [*reduction.rigid, *reduction.links, *reduction.pairs]
    assert sum(redundant.constraints for redundant in added) == structure.redundant
    assert {n for group in structure.all_groups for n in group.links} == {
        n for n in structure.links if n not in [driver.link for driver in structure.drivers if driver.base == FRAME]
    }


def test_kinematics_and_forces_keep_what_the_structural_formula_leaves_out():
    """The stone that the formula leaves out carries the disc where the other one is dead, and its pairs bear forces."""
    results = solved("crossed-slots")
    assert [sorted(kernel.group.links) for kernel in results.kernels] == [["2", "3", "4"]]
    assert all(np.all(np.isfinite(results.reactions.of(pair).force)) for pair in ("A", "B", "B'"))
    shown = " ".join(tmm("forces", "problems/crossed-slots.yaml", "--position", 1).stdout.split())
    assert (
        "Redundant constraints make the reactions between links 0, 1, 2, 3, 4 statically indeterminate: "
        "the smallest possible ones are given. The balancing load is not affected."
    ) in shown


def test_the_table_of_the_structure_says_what_is_redundant_below_the_formula():
    shown = tmm("structure", "problems/parallel-couplers.yaml").stdout
    lines = [" ".join(line.split()) for line in shown.splitlines()]
    at = lines.index("structural formula I(0,1) → II(2,3)")
    assert lines[at + 1 : at + 3] == [
        "link 4 is redundant; redundant constraints q = 1",
        "mobility W by the structural formula 3·3 − 2·4 = 1",
    ]
    assert "2, 3 II 2 RRR B A (1-2), C (0-3) 3·2 − 2·3 = 0 1 ВВВ" in lines
    assert "Replacements without redundant constraints" not in lines, "q = 1 is left in the plane"
    assert "Redundant constraints in the plane remain: link 4 is redundant; redundant constraints q = 1." in lines


def test_whatever_the_order_of_links_each_group_is_solved_after_those_it_is_attached_to():
    """A parallelogram with a dyad on its rocker: its redundant coupler is solved with the parallelogram."""
    linkage = solved_text(WITH_A_DYAD, stage="structure").linkage
    condition = next(k for k, tie in enumerate(list_ties(linkage)) if tie.name == "B" and "4" in (tie.a, tie.b))
    passive = PairRedundancy("B", 1, ("3", "4"), ("0", "1", "2", "3", "4"))
    for order in permutations("23456"):
        reordered = replace(linkage, links={name: linkage.links[name] for name in ("0", "1", *order)})
        structure = replace(analyse_structure(reordered, {condition: 1}), passive=(passive,))
        placed = {"0", "1"}
        for group in structure.solved:
            assert placed.issuperset(group.known), order
            placed.update(group.links)
        assert [sorted(group.links) for group in structure.solved] == [["2", "3", "4"], ["5", "6"]]


@pytest.mark.parametrize("order", ["123456", "123564", "654321"])
def test_a_dyad_on_a_parallelogram_with_two_couplers_moves_as_on_a_rotating_link(order):
    """B moves on a circle, so the slider moves as that of a crank-slider of crank 120 mm and coupler 350 mm."""
    results = solved_text(in_order(WITH_A_DYAD, *order), stage="kinematics")
    angle = results.motion.q
    height = 0.12 * np.sin(angle) + 0.15
    expected = 0.4 + 0.12 * np.cos(angle) + np.sqrt(0.35**2 - height**2)
    change_points = np.abs(np.sin(angle)) < 1e-9  # passed by a fit, and known as well as it
    known = np.where(change_points, CROSSING_AGREES, 2e-15)
    assert np.all(np.abs(results.motion.spot("F").real - expected) <= known)


def test_every_command_accepts_a_redundant_link_before_the_group_that_follows(tmp_path):
    file = tmp_path / "x.yaml"
    file.write_text(in_order(WITH_A_DYAD, *"123564") + "positions: {count: 2}\n", encoding="utf-8")
    for command in ("structure", "explain", "forces"):
        done = tmm(command, file, cwd=tmp_path)
        assert (done.returncode, "Traceback" in done.stderr) == (0, False), (command, done.stderr)


def test_a_load_on_a_coupler_follows_the_stroke_of_the_output_although_a_guide_is_redundant():
    """The second guide changes no force, and the stroke is a length with it as without it."""
    load = "loads: {F: {on: 2, at: B, force: {angle: 0, against: stroke, table: [[0, 0], [60 mm, -10 N]]}}}\n"
    text = GUIDES.replace("ANGLE", "0") + load
    alone = text.replace(", {on: y, point: K}", "").replace(", y: {through: [0, 40], angle: 0}", "")
    both, expected = (solved_text(each).reactions.balance.moment for each in (text, alone))
    assert np.allclose(both, expected, rtol=0, atol=1e-13 * np.max(np.abs(expected)))
