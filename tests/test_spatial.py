"""Structure in space: counts by hand, redundant constraints and what takes them away, contours, error messages."""

from __future__ import annotations

import itertools
import json
import re

import numpy as np
import pytest
import random_linkages
from bank import NAMES, problem, solved
from models import CLASS_III
from test_commands import ROOT, described, tmm

from tmm_cli import load
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import (
    PAIR_CHOICES,
    PAIR_FREEDOMS,
    SpatialChain,
    SpatialPair,
    analyse_structure,
    classify_linkage,
    count_chain,
    count_in_space,
    find_contours,
    out_of_plane_rank,
    spatial_chain,
)
from tmm_cli.problem import ProblemError, build_chain, build_problem, read_file, read_text
from tmm_cli.synthesis import count

LETTERS = {
    "R": "turning",
    "P": "sliding",
    "H": "screw",
    "C": "cylindrical",
    "U": "universal",
    "S": "spherical",
    "E": "planar",
    "L": "cylinder on plane",
    "B": "sphere on plane",
}


def chain(text):
    """A chain from words like "R01 S12": kind and both links."""
    pairs = [
        SpatialPair(f"{word}{k}", word[1], word[2], PAIR_FREEDOMS[LETTERS[word[0]]], LETTERS[word[0]])
        for k, word in enumerate(text.split())
    ]
    links = dict.fromkeys(link for p in pairs for link in (p.i, p.j) if link != FRAME)
    return SpatialChain(tuple(links), tuple(pairs))


def loop(kinds):
    """One closed contour with these pairs, the first and the last on the frame."""
    last = len(kinds) - 1
    return chain(" ".join(f"{kind}{k}{0 if k == last else k + 1}" for k, kind in enumerate(kinds)))


# ---------------------------------------------------------------- mobility by hand


@pytest.mark.parametrize(
    "kinds, mobility, local, redundant",
    [
        ("RRRR", -2, 0, 3),  # planar and spherical four-bars, Bennett's linkage: the count sees one and the same
        ("RRRP", -2, 0, 3),  # crank-slider
        ("RSSR", 2, 1, 0),  # the coupler turns about its own line
        ("RSCR", 1, 0, 0),
        ("RSSP", 2, 1, 0),
        ("RCCC", 1, 0, 0),
        ("RUSR", 1, 0, 0),
        ("RUR", -2, 0, 3),  # universal joint between two shafts: their axes must meet
        ("RRRRRRR", 1, 0, 0),  # the general 7R chain
        ("RRRRR", -1, 0, 2),  # Goldberg's
        ("RRRRRR", 0, 0, 1),  # Bricard's, Sarrus'
        ("HRP", -3, 0, 4),  # screw and nut
        ("RESP", 2, 1, 0),  # plate and ball: turns about the plate's normal through the ball's centre
        ("REER", 2, 1, 0),  # two plates: slides along both
        ("RSSC", 3, 2, 0),  # crank-slider with a round piston: its rod and the piston turn about their own axes
        ("RLRP", 1, 1, 1),  # cam, roller, sliding follower: the roller turns; its axis must be parallel to the cam's
        ("RBRP", 2, 1, 0),  # the same with a crowned roller
        ("RLR", 0, 0, 1),  # cam and rocker: what turns is the rocker
        ("RCSE", 3, 2, 0),  # a piston of a swashplate pump turns about its axis, its shoe about the plate's normal
    ],
)
def test_closed_chains_by_hand(kinds, mobility, local, redundant):
    found = count_chain(loop(kinds), wanted=1)
    assert (found.mobility, found.local_mobility, found.redundant) == (mobility, local, redundant)
    assert (found.form, len(found.contours)) == ("closed", 1)
    assert len(found.contours[0].links) == len(kinds)


def stewart(leg):
    """Six legs between frame and platform "p"; S and C stand for ball and sliding tube with turning."""
    pairs, links = [], []
    for k in range(6):
        bodies = [FRAME, *(f"{k}{part}" for part in range(len(leg) - 1)), "p"]
        links += bodies[1:-1]
        pairs += [
            SpatialPair(f"{kind}{k}{n}", bodies[n], bodies[n + 1], PAIR_FREEDOMS[LETTERS[kind]], LETTERS[kind])
            for n, kind in enumerate(leg)
        ]
    return SpatialChain((*links, "p"), tuple(pairs))


@pytest.mark.parametrize("leg, mobility, local", [("SPS", 12, 6), ("UPS", 6, 0), ("SCS", 18, 12), ("SHS", 12, 6)])
def test_stewart_platforms_move_in_six_ways_and_their_legs_turn_on_their_own(leg, mobility, local):
    found = count_chain(stewart(leg), wanted=6)
    assert (len(found.chain.links), found.chain.mobility) == (13, mobility)
    assert found.local_mobility == local
    assert found.redundant == 0
    assert (len(found.contours), found.form) == (5, "closed")


def test_a_leg_of_a_stewart_platform_turns_as_one():
    found = count_chain(stewart("SPS"))
    assert [part.links for part in found.local] == [(f"{k}0", f"{k}1") for k in range(6)]
    assert {part.freedoms for part in found.local} == {1}


@pytest.mark.parametrize(
    "text, mobility, held",
    [
        ("S01 R12 S23", 7, 1),  # an arm
        ("R01 R12 R23 R34 R45 R56", 6, 0),  # six turning pairs reach every place, one way only
        ("R01 R12 R23 R34 R45 R56 R67", 7, 1),
        ("P01 P12 P23", 3, -3),
        ("S01 S12", 6, 0),
    ],
)
def test_manoeuvrability_is_mobility_with_the_output_held(text, mobility, held):
    arm = chain(text)
    found = count_chain(arm, output=arm.links[-1])
    assert (found.form, found.mobility, found.manoeuvrability) == ("open", mobility, held)
    assert found.manoeuvrability == mobility - 6


def test_an_elbow_that_swings_is_no_local_freedom_but_a_rod_that_turns_is():
    arm = count_chain(chain("S01 R12 S23"), output="3")
    assert (arm.local, arm.idle_manoeuvrability) == ((), 0)
    rods = count_chain(chain("R01 S12 S23 R34 S45"), output="5")
    assert rods.local_mobility == 1
    strut = count_chain(chain("S01 P12 S23"), output="3")
    assert (strut.manoeuvrability, strut.idle_manoeuvrability) == (1, 1)


def test_what_dimensions_alone_could_decide_is_not_called_local():
    assert count_chain(loop("RSCR")).local == ()  # local only if the ball lay on the axis
    assert count_chain(chain("R01 S12")).local == ()  # an open end
    assert count_chain(chain("S01 S01")).local == ()  # a door: that is what it is for


def test_a_ball_between_two_plates_keeps_all_but_two_of_its_freedoms():
    found = count_chain(chain("B01 B12 P02"))
    assert [(part.links, part.freedoms) for part in found.local] == [(("1",), 4)]
    assert found.mobility == 5


def test_all_pistons_of_a_swashplate_pump_and_their_shoes_turn_on_their_own():
    """Seven pistons in a rotating block, shoes on a plate: W = 6*15 - 5*1 - 4*7 - 3*14 = 15, all but one local."""
    legs = " ".join(f"C1{x} S{x}{x.upper()} E{x.upper()}0" for x in "abcdefg")
    found = count_chain(chain(f"R01 {legs}"), wanted=1)
    assert (found.mobility, found.local_mobility, found.redundant) == (15, 14, 0)
    assert {part.links for part in found.local} == {(x,) for x in "abcdefgABCDEFG"}


@pytest.mark.parametrize(
    "text, links",
    [
        ("R01 R12 R23 R30", ("1", "2", "3")),  # parallel axes let a planar four-bar move: the count does not see them
        ("R01 S12 S23 R30", ()),
        ("R01 R12 R23 R30 R34 R45 R56 R67 R78", ("1", "2", "3")),  # an arm on it, W = 3, moves alone
        ("S01 S12 R20", ("1", "2")),  # W = 1: a strut turns about its own line, which is all that moves
        ("R01 R12 R23", ()),  # open
    ],
)
def test_a_chain_that_cannot_move_by_the_count_is_reported(text, links):
    assert count_chain(chain(text)).immobile == links
    assert count_chain(chain(text), wanted=1).immobile == (), "its dimensions are special then, and q is counted"


def test_the_report_says_that_a_chain_cannot_move_and_how_to_count_its_redundant_constraints(tmp_path):
    file = tmp_path / "x.yaml"
    four_bar = "{A: [0, 1], B: [1, 2], C: [2, 3], D: [0, 3]}"
    pairs = re.sub(r"(\[\d, \d\])", r"{between: \1, kind: turning}", four_bar)
    file.write_text(f"tmm: 1\nstructure: {{spatial: {{pairs: {pairs}}}}}\n", encoding="utf-8")
    shown = " ".join(tmm("structure", file).stdout.split())
    assert (
        "W - Wm < 1: by this count links 1, 2, 3 cannot move. If they move because of special dimensions, "
        "for example parallel axes, give the required mobility (wanted: 1); then the redundant constraints "
        "q are counted."
    ) in shown
    file.write_text(f"tmm: 1\nstructure: {{spatial: {{pairs: {pairs}, wanted: 1}}}}\n", encoding="utf-8")
    shown = " ".join(tmm("structure", file).stdout.split())
    assert (
        "q = 3: the chain moves only if its dimensions are exact; according to the count of degrees of "
        "freedom it is immobile."
    ) in shown


def test_contours_are_short_and_start_near_the_frame():
    found = count_chain(chain("R01 R12 R23 R30 R34 R45 P50 R56"))
    assert [c.title for c in found.contours] == ["0-1-2-3-0", "0-3-4-5-0"]
    assert (found.form, found.branches) == ("mixed", ("6",))
    doubled = count_chain(chain("R01 R01 P12"))
    assert [(c.title, c.pairs) for c in doubled.contours] == [("0-1-0", ("R010", "R011"))]
    # a contour of two cells side by side that does not run through the frame
    assert [c.title for c in count_chain(chain("R01 R12 R23 R34 R41")).contours] == ["1-2-3-4-1"]


def test_every_chain_has_as_many_independent_contours_as_pairs_more_than_links():
    random = np.random.default_rng(7)
    for _ in range(40):
        n = int(random.integers(2, 12))
        names = [FRAME, *(f"{k}" for k in range(1, n + 1))]
        ends = [(names[random.integers(0, k)], names[k]) for k in range(1, n + 1)]
        ends += [tuple(names[k] for k in random.choice(n + 1, 2, replace=False)) for _ in range(random.integers(0, 8))]
        pairs = tuple(SpatialPair(f"P{k}", i, j, 1, "turning") for k, (i, j) in enumerate(ends))
        found = find_contours(pairs, names[1:])
        assert len(found) == len(pairs) - n
        matrix = np.zeros((len(found), len(pairs)), dtype=int)
        by_name = {p.name: p for p in pairs}
        for row, contour in zip(matrix, found, strict=True):
            assert len(set(contour.links)) == len(contour.links) == len(contour.pairs)
            for k, name in enumerate(contour.pairs):
                here, after = contour.links[k], contour.links[(k + 1) % len(contour.links)]
                assert {by_name[name].i, by_name[name].j} == {here, after}
                row[int(name[1:])] = 1
        assert not found or np.linalg.matrix_rank(matrix) == len(found)


# ---------------------------------------------------------------- planar linkages in space


def screws(pair, kind, poses):
    """Motions that a pair of a planar linkage leaves in space, columns (omega, velocity of the drawing's origin)."""

    def turn(place, axis):
        return np.concatenate([axis, np.cross(place, axis)])

    def run(axis):
        return np.concatenate([np.zeros(3), axis])

    def spatial(z):
        return np.array([z.real, z.imag, 0.0])

    origin, z = poses[pair.i]
    up = np.array([0.0, 0.0, 1.0])
    if pair.touch is not None:
        place, along = (spatial(part) for part in pair.touch)
        across = np.cross(up, along)
        line = [run(along), run(up), turn(place, up), turn(place, across)]
        return np.column_stack(line if kind == "cylinder on plane" else [*line, turn(place, along)])
    if pair.slide is None:
        place = spatial(origin + z * pair.local)
        axes = np.eye(3)
        return np.column_stack(
            {
                "turning": [turn(place, up)],
                "cylindrical": [turn(place, up), run(up)],
                "spherical": [turn(place, axis) for axis in axes],
            }[kind]
        )
    along = spatial(z * np.exp(1j * pair.slide.direction))
    place, across = spatial(origin + z * pair.slide.through), np.cross(up, along)
    return np.column_stack(
        {
            "sliding": [run(along)],
            "cylindrical": [run(along), turn(place, along)],
            "planar": [run(along), run(up), turn(place, across)],
        }[kind]
    )


class Placed:
    """A pair with the place of its hinge in the axes of its first link; of teeth and cams a place where they touch.

    Any place will do for these, as long as the links slide there along the common tangent.
    """

    def __init__(self, linkage, pair, poses, rates):
        self.i, self.slide, self.touch = pair.i, pair.slide, None
        self.local = 0j if pair.slide or pair.mesh else linkage.local(pair.i, pair.point)
        if pair.mesh is not None:
            place = complex(0.03, 0.05)
            one, two = (rates[link][0] + 1j * rates[link][1] * (place - poses[link][0]) for link in (pair.i, pair.j))
            sliding = two - one
            self.touch = (place, sliding / abs(sliding) if abs(sliding) > 1e-9 else 0.6 + 0.8j)


def jacobian(linkage, structure, poses, kinds, rates=None):
    """All conditions in space on the motions of all links, in the file's own position."""
    links = structure.links
    blocks = []
    for pair in structure.pairs:
        free = screws(Placed(linkage, pair, poses, rates), kinds.get(pair.name, PAIR_CHOICES[pair.kind][0]), poses)
        conditions = np.linalg.svd(free)[0][:, np.linalg.matrix_rank(free) :].T
        block = np.zeros((len(conditions), 6 * len(links)))
        for link, sign in ((pair.i, 1), (pair.j, -1)):
            if link in links:
                at = 6 * links.index(link)
                block[:, at : at + 6] = sign * conditions
        blocks.append(block)
    return np.vstack(blocks)


def proposal(found):
    return {r.pair.name: r.kind for r in found.replacements}


def lower_only(name):
    """Without higher pairs: see test_higher_pairs_in_space."""
    text = (ROOT / "problems" / f"{name}.yaml").read_text(encoding="utf-8")
    return not re.search(r"^(gears|racks|cams):", text, re.MULTILINE)


@pytest.mark.parametrize("name", list(filter(lower_only, NAMES)))
def test_proposals_hold_in_the_positions_of_the_file_by_the_rank_of_the_whole_jacobian(name):
    results = solved(name)
    linkage, structure, motion = results.linkage, results.structure, results.motion
    if not analyse_structure(linkage).sound:
        pytest.skip("some constraints are passive in the plane")
    found = count_in_space(linkage, structure)
    kinds = proposal(found)
    # a lower pair asks for three conditions out of the plane, teeth and cams for one
    assert (found.redundant, found.redundant_then) == (3 * structure.contours - 2 * structure.higher, 0)
    for k in np.flatnonzero(motion.moving)[::2]:
        poses = {
            name: tuple(complex(np.broadcast_to(part, motion.q.shape)[k]) for part in (pose.x, pose.z))
            for name, pose in motion.poses.items()
        }
        rates = {
            name: tuple(complex(np.broadcast_to(part, motion.q.shape)[k]) for part in (rate.v, rate.w))
            for name, rate in motion.first.items()
        }
        as_is = jacobian(linkage, structure, poses, {}, rates)
        assert len(as_is) - np.linalg.matrix_rank(as_is, tol=1e-9) == found.redundant
        then = jacobian(linkage, structure, poses, kinds, rates)
        assert np.linalg.matrix_rank(then, tol=1e-9) == len(then)
        # W is what can move: the mechanism, and links by themselves
        assert then.shape[1] - len(then) == found.proposed.mobility == len(structure.drivers) + found.rank.local
        # no pair on the frame has been touched
        assert not any(FRAME in (r.pair.i, r.pair.j) for r in found.replacements)


def six_bar():
    linkage = load(str(ROOT / "problems" / "six-bar.yaml")).linkage
    return linkage, analyse_structure(linkage)


def test_the_six_bar_of_the_source_has_six_redundant_constraints():
    linkage, structure = six_bar()
    assert (structure.mobility, spatial_chain(structure, {}).mobility) == (1, -5)
    assert count_in_space(linkage, structure).redundant == 6
    assert out_of_plane_rank(linkage, structure, {}).redundant == 6


def test_seven_constraints_fewer_as_in_the_source_leave_a_rod_that_turns_about_itself():
    """Both ends of rod 4 spherical, and the coupler on a spherical and a cylindrical pair."""
    linkage, structure = six_bar()
    kinds = {"A": "spherical", "B": "cylindrical", "B''": "spherical", "F": "spherical"}
    rank = out_of_plane_rank(linkage, structure, kinds)
    assert (rank.redundant, rank.free, rank.local) == (0, 1, 1)
    then = spatial_chain(structure, kinds)
    assert then.mobility == 2 == 1 + 1
    assert then.mobility - spatial_chain(structure, {}).mobility == 7
    assert [part.links for part in count_chain(then).local] == [("4",)]


def test_the_source_also_names_what_is_proposed_the_pin_that_two_hinges_share_becomes_cylindrical():
    found = count_in_space(*six_bar())
    assert proposal(found) == {"A": "spherical", "B": "cylindrical", "B''": "cylindrical", "F": "spherical"}
    assert (found.proposed.mobility, found.rank.local, found.redundant_then) == (1, 0, 0)


@pytest.mark.parametrize(
    "kinds, redundant, free",
    [
        ({}, 3, 0),
        ({"A": "spherical"}, 1, 0),
        ({"A": "spherical", "B": "cylindrical"}, 0, 0),
        ({"A": "spherical", "B": "spherical"}, 0, 1),
        ({"A": "cylindrical", "B": "cylindrical"}, 2, 1),  # one says again that the coupler does not tilt
    ],
)
def test_of_a_four_bar_the_rank_sees_what_the_count_alone_does_not(kinds, redundant, free):
    linkage = load(str(ROOT / "problems" / "crank-rocker.yaml")).linkage
    structure = analyse_structure(linkage)
    rank = out_of_plane_rank(linkage, structure, kinds)
    assert (rank.redundant, rank.free) == (redundant, free)
    # what is free out of the plane and what is held twice differ by the count
    assert 1 + rank.free - rank.redundant == spatial_chain(structure, kinds).mobility


def test_a_stone_hinged_on_the_line_of_its_guide_cannot_be_held_by_a_ball_and_a_round_guide():
    """The ball and the round guide both say how high the hinge is, so one of them says it in vain."""
    linkage = load(str(ROOT / "problems" / "slotted-lever.yaml")).linkage
    structure = analyse_structure(linkage)
    rank = out_of_plane_rank(linkage, structure, {"A": "spherical", "A'": "cylindrical"})
    assert (rank.redundant, rank.free, rank.local) == (1, 1, 1)
    assert spatial_chain(structure, {"A": "spherical", "A'": "cylindrical"}).mobility == 1  # the count sees nothing
    assert proposal(count_in_space(linkage, structure)) == {"A": "spherical", "A'": "planar"}


def fewest(linkage, structure):
    """Changed pairs and freedoms of the best proposal, by trying everything."""
    moving = [p for p in structure.pairs if FRAME not in (p.i, p.j)]
    best = None
    for chosen in itertools.product(*(PAIR_CHOICES[p.kind] for p in moving)):
        kinds = {p.name: kind for p, kind in zip(moving, chosen, strict=True)}
        changed = [k for p, k in zip(moving, chosen, strict=True) if k != PAIR_CHOICES[p.kind][0]]
        score = (len(changed), sum(PAIR_FREEDOMS[k] for k in changed))
        if best is None or score < best:
            rank = out_of_plane_rank(linkage, structure, kinds)
            if not rank.redundant and rank.free == rank.local:
                best = score
    return best


@pytest.mark.parametrize("kind", random_linkages.TYPES)
def test_no_proposal_for_one_group_has_fewer_changes_or_fewer_freedoms(kind):
    for seed in range(6):
        linkage = random_linkages.linkage(seed, (kind,))
        structure = analyse_structure(linkage)
        if any(p.i == FRAME and p.j in g.links for g in structure.groups for p in g.outer):
            found = count_in_space(linkage, structure)
            score = (
                None
                if found.replacements is None
                else (len(found.replacements), sum(r.freedoms for r in found.replacements))
            )
            assert score == fewest(linkage, structure)


def test_a_group_of_class_iii_is_served_too_and_no_proposal_is_shorter():
    linkage = build_problem(read_text(CLASS_III, "iii.yaml")).linkage
    structure = analyse_structure(linkage)
    found = count_in_space(linkage, structure)
    assert (found.redundant, found.redundant_then) == (6, 0)
    assert (len(found.replacements), sum(r.freedoms for r in found.replacements)) == fewest(linkage, structure)


def test_every_random_linkage_gets_a_proposal_unless_a_part_of_it_is_a_truss_on_the_frame():
    for seed in range(60):
        random = np.random.default_rng(seed)
        kinds = tuple(str(k) for k in random.choice(random_linkages.TYPES, int(random.integers(1, 5))))
        linkage = random_linkages.linkage(seed, kinds)
        structure = analyse_structure(linkage)
        still = {FRAME}
        for group in structure.all_groups:
            if all({p.i, p.j} - set(group.links) <= still for p in group.outer):
                still |= set(group.links)
        found = count_in_space(linkage, structure)
        assert (found.replacements is None) == (len(still) > 1), (seed, kinds)
        if found.replacements is not None:
            assert (found.redundant, found.redundant_then) == (3 * len(kinds), 0)
            assert len(found.replacements) == 2 * len(kinds)


def test_words_of_the_classification():
    words = {name: classify_linkage(analyse_structure(problem(name).linkage)) for name in NAMES}
    assert words["crank-slider"] == ("closed", "simple")
    assert words["shaper"] == ("closed", "complex", "several types")
    alone = "tmm: 1\npoints: {O: [0, 0]}\nlinks: {1: {points: [O, A], length: 1}}\ndriver: {link: 1, speed: 1 rad/s}\n"
    linkage = build_problem(
        read_text(alone.replace("[O, A], length: 1", "{O: [0, 0], A: [1, 0]}"), "alone.yaml")
    ).linkage
    assert classify_linkage(analyse_structure(linkage)) == ("open", "elementary")
    assert count_in_space(linkage, analyse_structure(linkage)).replacements == ()
    twice = analyse_structure(random_linkages.linkage(4, ("RRR", "RRR")))
    assert classify_linkage(twice) == ("closed", "complex", "same type")


# ---------------------------------------------------------------- files


@pytest.mark.parametrize(
    "name, expected",
    [
        ("spatial-six-bar", {"mobility": 2, "local_mobility": 1, "redundant": 0, "form": "closed"}),
        ("manipulator-open", {"mobility": 7, "manoeuvrability": 1, "form": "open", "redundant": None}),
        ("manipulator-closed", {"mobility": 3, "manoeuvrability": 1, "form": "closed"}),
        ("swashplate", {"mobility": 9, "local_mobility": 5, "redundant": 0, "form": "closed"}),
        # by hand 6*4 - 5*2 - 3*4 = 2; both stones turn about the normal of their slot: q = 1 + 2 - 2
        ("crossed-slots-45", {"mobility": 2, "local_mobility": 2, "redundant": 1, "form": "closed"}),
    ],
)
def test_problems_given_by_pairs_alone(name, expected):
    file = ROOT / "problems" / f"{name}.yaml"
    assert "Property to see:" in file.read_text(encoding="utf-8")
    found = count(build_chain(read_file(str(file)))).chain
    assert {key: getattr(found, key) for key in expected} == expected


PAIRS = "{A: {between: [0, 1], kind: turning}, B: {between: [1, 2], kind: spherical}}"


def spatial(text, head="tmm: 1\nstructure:\n  spatial:\n"):
    return build_chain(read_text(head + "".join(f"    {line}\n" for line in text.split("\n")), "x.yaml"))


def test_links_may_be_counted_named_or_left_out_and_local_freedoms_told():
    for links in ("", "links: 2\n", "links: [1, 2]\n"):
        assert spatial(f"{links}pairs: {PAIRS}").chain.links == ("1", "2")
    assert spatial(f"pairs: {PAIRS}\nlocal: {{1: 1, 2: 2}}").local == 3
    told = count(spatial(f"pairs: {PAIRS}\nlocal: 2\nwanted: 1")).chain
    assert (told.local_mobility, told.redundant) == (2, 1 + 2 - 4)
    assert spatial("pairs: {A: {between: [0, 1], freedoms: 4}}").chain.mobility == 4


@pytest.mark.parametrize(
    "text, message",
    [
        (
            "pairs: {A: {between: [0, 1], kind: sferical}}",
            (
                "x.yaml:4:40: structure.spatial.pairs.A.kind: this value is not allowed here\n"
                "  found:   'sferical'\n"
                "  allowed: turning, sliding, screw, cylindrical, spherical with a pin, universal, "
                "spherical, planar, sphere in cylinder, cylinder on plane, sphere on plane\n"
                "  did you mean 'spherical'?"
            ),
        ),
        (
            "links: [1, 2]\npairs: {A: {between: [0, 1], kind: turning}}",
            "x.yaml:5:5: structure.spatial.pairs: no chain of pairs joins link 2 to the frame",
        ),
        (
            "pairs: {A: {between: [1, 1], kind: turning}}",
            ("x.yaml:4:26: structure.spatial.pairs.A.between: the links must be different\n  found:   1, 1"),
        ),
        (
            "links: [arm, hand]\npairs: {A: {between: [0, arm], kind: screw}, B: {between: [arm, hnad], kind: screw}}",
            "x.yaml:5:69: structure.spatial.pairs.B.between[1]: there is no link of that name\n"
            "  found:   'hnad'\n"
            "  allowed: 0, arm, hand\n"
            "  did you mean 'hand'?",
        ),
        (
            "pairs: {A: {between: [0, 1], kind: turning}, B: {between: [2, 3], kind: turning}}",
            "x.yaml:4:5: structure.spatial.pairs: no chain of pairs joins link 2 to the frame",
        ),
        (
            "pairs: {A: {between: [0, 1, 2], kind: turning}}",
            "x.yaml:4:26: structure.spatial.pairs.A.between: there are too many items or characters; "
            "at most 2 are allowed\n"
            "  found:   [0, 1, 2]\n"
            "  allowed: the two links; the frame is 0",
        ),
        (
            "pairs: {A: {between: [0, 1]}}",
            ("x.yaml:4:13: structure.spatial.pairs.A: expected exactly one of these keys\n  allowed: kind, freedoms"),
        ),
        (
            "pairs: {A: {between: [0, 1], kind: turning, freedoms: 1}}",
            (
                "x.yaml:4:13: structure.spatial.pairs.A: expected exactly one of these keys\n"
                "  found:   kind, freedoms\n"
                "  allowed: kind, freedoms"
            ),
        ),
        (
            "pairs: {A: {between: [0, 1], freedoms: 6}}",
            (
                "x.yaml:4:44: structure.spatial.pairs.A.freedoms: expected a number not greater than 5\n"
                "  found:   6\n"
                "  allowed: number of degrees of freedom, 1 to 5; given instead of `kind`"
            ),
        ),
        (
            f"pairs: {PAIRS}\noutput: 3",
            "x.yaml:5:13: structure.spatial.output: there is no moving link of that name\n"
            "  found:   '3'\n"
            "  allowed: 1, 2",
        ),
        (
            f"pairs: {PAIRS}\nlocal: {{3: 1}}",
            "x.yaml:5:13: structure.spatial.local.3: there is no moving link of that name\n"
            "  found:   '3'\n"
            "  allowed: 1, 2",
        ),
        (
            f"links: 1000\npairs: {PAIRS}",
            (
                "x.yaml:4:12: structure.spatial.links: expected a number not greater than 100\n"
                "  found:   1000\n"
                "  allowed: moving links: their names or their number; default: the links named in `pairs`"
            ),
        ),
        (
            f"links: [0, 1]\npairs: {PAIRS}",
            ("x.yaml:4:13: structure.spatial.links[0]: this name is already in use\n  found:   '0'"),
        ),
        (
            f"pairs: {PAIRS}\nwnated: 1",
            "x.yaml:5:5: structure.spatial.wnated: unknown key\n"
            "  found:   'wnated'\n"
            "  allowed: links, pairs, output, local, wanted\n"
            "  did you mean 'wanted'?",
        ),
    ],
)
def test_mistakes_are_told_where_they_are(text, message):
    with pytest.raises(ProblemError) as error:
        spatial(text)
    assert str(error.value) == message


def test_a_slip_beside_or_in_the_name_of_the_block_is_told_in_terms_of_such_a_file():
    with pytest.raises(ProblemError) as error:
        build_chain(read_text(f"tmm: 1\nstructure: {{spacial: {{pairs: {PAIRS}}}}}\n", "x.yaml"))
    assert str(error.value) == (
        "x.yaml:2:13: structure.spacial: unknown key\n  found:   'spacial'\n  allowed: spatial\n"
        "  did you mean 'spatial'?"
    )
    with pytest.raises(ProblemError) as error:
        spatial(f"pairs: {PAIRS}", "tmm: 1\ndriver: {link: 1}\nstructure:\n  spatial:\n")
    assert str(error.value) == (
        "x.yaml:2:1: driver: unknown key\n  found:   'driver'\n"
        "  allowed: tmm, lang, title, description, reference, shows, structure"
    )


def test_a_block_with_nothing_in_it_is_a_bad_chain_and_no_planar_linkage(tmp_path):
    file = tmp_path / "x.yaml"
    file.write_text("tmm: 1\nstructure:\n", encoding="utf-8")
    done = tmm("structure", file)
    assert done.returncode == 2
    assert "structure: expected keys with values" in done.stderr


def test_untrusted_chains_are_bounded():
    with pytest.raises(ProblemError, match="there are too many items or characters; at most 300 are allowed"):
        spatial("pairs:\n" + "\n".join(f"  A{k}: {{between: [0, {k % 90 + 1}], kind: turning}}" for k in range(301)))
    with pytest.raises(ProblemError, match="there are too many links"):
        spatial("pairs:\n" + "\n".join(f"  A{k}: {{between: [0, {k + 1}], kind: turning}}" for k in range(101)))


# ---------------------------------------------------------------- commands


def test_tmm_structure_shows_chains_and_tells_planar_linkages_their_redundant_constraints():
    told = tmm("structure", "problems/spatial-six-bar.yaml").stdout
    assert "6·5 − 5·3 − 4·1 − 3·3 = 2" in told and "1 + 1 − 2 = 0" in told
    assert "rotates about the line through both centres" in told
    told = tmm("structure", "problems/six-bar.yaml").stdout
    assert "1 + 0 − (−5) = 6" in told and "0-3-4-5-0" in told
    assert "complex: the driver and several groups" in told
    held = tmm("structure", "problems/manipulator-open.yaml", "--json")
    assert json.loads(held.stdout)["chain"]["manoeuvrability"] == 1


def test_what_needs_dimensions_says_that_there_are_none():
    for command in ("kinematics", "forces", "explain"):
        done = tmm(command, "problems/swashplate.yaml")
        assert done.returncode == 2
        assert (
            "structure: this file contains only links and pairs, without dimensions: only the structure can be analysed"
        ) in done.stderr


def test_run_writes_the_structure_of_a_chain_and_check_compares_it(tmp_path):
    done = tmm("run", "problems/swashplate.yaml", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    names = {path.name for path in (tmp_path / "swashplate").iterdir()}
    assert names == {"structure.csv", "pairs.csv", "contours.csv", "local.csv", "properties.csv", "result.json"}
    assert tmm("check", "problems/swashplate.yaml", "problems/manipulator-open.yaml").returncode == 0


def test_results_of_chains_and_of_space_follow_the_schema():
    schema = json.loads(tmm("schema", "--result").stdout)
    for name in ("swashplate", "manipulator-open", "six-bar"):
        result = json.loads(tmm("structure", f"problems/{name}.yaml", "--json").stdout)
        assert set(schema["required"]) <= set(result)
        described(result, schema, "")
    files = json.loads(tmm("schema").stdout)
    assert files["then"]["$ref"].removeprefix("#/$defs/") in files["$defs"]
