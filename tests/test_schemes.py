"""Structural synthesis: kinematic chains are as many as the literature counts; schemes move as they say."""

from __future__ import annotations

import io
import json
import math
import random
import re
from collections import Counter
from functools import cache
from itertools import combinations, permutations
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console
from test_commands import tmm

from tmm_cli import solve
from tmm_cli.cli import make_scheme_file, read_group_types, schemes as scheme_files
from tmm_cli.drawing.sheets import GROUP_EXAMPLES
from tmm_cli.mechanics.linkage import Driver, Hinge, Link, Linkage, Sketch
from tmm_cli.mechanics.structure import ROMAN, analyse_structure, group_class
from tmm_cli.problem import UnitSystem, build_problem, read_text
from tmm_cli.reports import print_on_terminal, schemes_table
from tmm_cli.synthesis import (
    MOST_SCHEMES,
    KinematicChain,
    canonical_form,
    enumerate_chains as every_chain,
    enumerate_schemes as every_scheme,
)

chains, schemes = cache(every_chain), cache(every_scheme)

MULTI_LINK = ("RRR", "III", "IV")  # every group of turning pairs with at most four links


@pytest.mark.parametrize(
    "mobility, counts",
    [(1, {4: 1, 6: 2, 8: 16, 10: 230}), (2, {5: 1, 7: 4, 9: 40, 11: 839}), (3, {6: 1, 8: 7, 10: 98})],
)
def test_chains_are_as_many_as_in_the_literature(mobility, counts):
    for links, count in counts.items():
        found = chains(links, mobility)
        assert len(found) == len({chain.form for chain in found}) == count
        assert {chain.mobility for chain in found} == {mobility}
        assert all(sum(chain.assortment) == links for chain in found)


def test_chains_of_ten_links_by_assortment():
    assert Counter(chain.assortment for chain in chains(8)) == {(4, 4): 9, (5, 2, 1): 5, (6, 0, 2): 2}
    assert Counter(chain.assortment for chain in chains(10)) == {
        (4, 6): 50,
        (5, 4, 1): 95,
        (6, 2, 2): 57,
        (7, 0, 3): 3,
        (6, 3, 0, 1): 15,
        (7, 1, 1, 1): 8,
        (8, 0, 0, 2): 2,
    }


def test_a_chain_with_one_freedom_does_not_fall_apart_and_others_may():
    assert not any(chain.fractionated for n in (4, 6, 8, 10) for chain in chains(n))
    assert [sum(chain.fractionated for chain in chains(n, 2)) for n in (5, 7, 9)] == [0, 1, 5]
    apart = next(chain for chain in chains(7, 2) if chain.fractionated)  # two four-bars with one link in common
    assert apart.assortment == (6, 0, 1)


def test_there_is_no_chain_where_the_count_of_pairs_is_no_whole_number():
    assert chains(5, 1) == chains(3, 1) == chains(4, 2) == ()


def sound(links, pairs, mobility):
    """A closed chain, straight from its definition."""
    degrees = Counter(link for pair in pairs for link in pair)
    if len(degrees) < links or min(degrees.values()) < 2 or 3 * (links - 1) - 2 * len(pairs) != mobility:
        return False
    reached = {0}
    for _ in range(links):
        reached |= {b for pair in pairs for a, b in (pair, pair[::-1]) if a in reached}
    return len(reached) == links and all(
        3 * (size - 1) - 2 * sum(i in part and j in part for i, j in pairs) >= 1
        for size in range(2, links + 1)
        for part in map(set, combinations(range(links), size))
    )


@pytest.mark.parametrize("links, mobility", [(4, 1), (5, 2), (6, 1), (6, 3)])
def test_all_labelled_graphs_that_are_chains_are_labellings_of_those_listed(links, mobility):
    """n!/|Aut| labellings of each listed chain are all there are among all graphs with so many edges."""
    every = list(combinations(range(links), 2))
    count = (3 * (links - 1) - mobility) // 2
    labelled = sum(sound(links, pairs, mobility) for pairs in combinations(every, count))

    def symmetries(chain):
        pairs = {frozenset(pair) for pair in chain.pairs}
        return sum({frozenset((p[i], p[j])) for i, j in chain.pairs} == pairs for p in permutations(range(links)))

    assert labelled == sum(math.factorial(links) // symmetries(chain) for chain in chains(links, mobility))


@pytest.mark.parametrize("links, mobility", [(8, 1), (9, 2), (10, 1), (10, 3)])
def test_the_canonical_form_does_not_depend_on_labels(links, mobility):
    chance = random.Random(7)
    for chain in chains(links, mobility):
        order = chance.sample(range(links), links)
        pairs = [tuple(sorted((order[i], order[j]))) for i, j in chain.pairs]
        assert KinematicChain(links, tuple(chance.sample(pairs, len(pairs)))).form == chain.form


def test_the_canonical_form_tells_colours_and_kinds_apart_and_the_petersen_graph_from_another_cubic_one():
    square = {(0, 1): 0, (1, 2): 0, (2, 3): 0, (0, 3): 1}
    assert canonical_form([0, 1, 1, 1], square) == canonical_form([1, 1, 1, 0], square)
    assert canonical_form([0, 1, 1, 1], square) != canonical_form([1, 0, 1, 1], square)
    assert canonical_form([0] * 4, square) != canonical_form([0] * 4, dict.fromkeys(square, 0))
    ring = {(k, (k + 1) % 5) if k < 4 else (0, 4): 0 for k in range(5)} | {(k, k + 5): 0 for k in range(5)}
    petersen = ring | {tuple(sorted((5 + k, 5 + (k + 2) % 5))): 0 for k in range(5)}
    prism = ring | {tuple(sorted((5 + k, 5 + (k + 1) % 5))): 0 for k in range(5)}
    assert canonical_form([0] * 10, petersen) != canonical_form([0] * 10, prism)


def test_schemes_with_three_moving_links_are_the_four_link_mechanisms():
    assert [scheme.name for scheme in schemes(3)] == [
        "II-RRR",
        "II-RRP",
        "II-RRP",
        "II-RPR",
        "II-PRP",
        "II-RPP",
        "II-RPP",
    ]
    four_bar, crank_slider, *_ = schemes(3)
    assert four_bar.joints == ((0, 1, "R"), (1, 2, "R"), (0, 3, "R"), (2, 3, "R"))
    assert crank_slider.joints == ((0, 1, "R"), (1, 2, "R"), (0, 3, "P"), (2, 3, "R"))


def same(one, other):
    """Whether two schemes are isomorphic, by trying all renumberings of the links that are neither frame nor crank."""
    if (one.cranks, one.links) != (other.cranks, other.links):
        return False
    pairs = {(frozenset((i, j)), kind) for i, j, kind in one.joints}
    fixed, free = range(1, one.cranks + 1), range(one.cranks + 1, one.links + 1)
    return any(
        {(frozenset((order[i], order[j])), kind) for i, j, kind in other.joints} == pairs
        for cranks in permutations(fixed)
        for rest in permutations(free)
        for order in [(0, *cranks, *rest)]
    )


@pytest.mark.parametrize(
    "links, mobility, groups, count",
    [(3, 1, "II", 7), (5, 1, "RRR,RRP", 51), (5, 1, "III,IV", 3), (4, 2, "II", 5), (6, 2, "RRR", 8)],
)
def test_no_two_schemes_are_isomorphic(links, mobility, groups, count):
    found = schemes(links, mobility, read_group_types(groups))
    assert len(found) == count
    assert not any(same(one, other) for one, other in combinations(found, 2))


def held_and_driven(chain):
    """Every choice of a frame and a crank beside it in a chain, no two alike, as linkages."""
    forms = {}
    for frame, crank in (way for pair in chain.pairs for way in (pair, pair[::-1])):
        colours = [0 if link == frame else 1 if link == crank else 2 for link in range(chain.links)]
        forms.setdefault(canonical_form(colours, dict.fromkeys(chain.pairs, 0)), (frame, crank))
    for frame, crank in forms.values():
        name = {link: str(link) if link else str(chain.links) for link in range(chain.links)} | {frame: "0"}
        hinges = tuple(Hinge(f"P{k}", (name[i], name[j])) for k, (i, j) in enumerate(chain.pairs))
        links = {n: Link(n, {}) for n in ("0", *(n for n in name.values() if n != "0"))}
        yield Linkage(links, hinges, (), Driver(name[crank], "turn", "O", 1.0), Sketch(0.0))


@pytest.mark.parametrize("links", [4, 6, 8])
def test_schemes_of_turning_pairs_are_the_chains_with_a_frame_and_a_crank(links):
    """Two ways to all hinged mechanisms with one freedom: attaching groups, and holding links of chains."""
    found = [analyse_structure(linkage) for chain in chains(links) for linkage in held_and_driven(chain)]
    assert {structure.mobility for structure in found} == {1}
    small = [s for s in found if all(len(g.links) <= 4 for g in s.groups)]
    attached = schemes(links - 1, 1, MULTI_LINK)
    assert len(small) == len(attached)
    grades = Counter(tuple(sorted(g.group_class for g in s.groups)) for s in small)
    assert grades == Counter(tuple(sorted(g.type.grade for g in s.groups)) for s in attached)
    assert len(found) == len(small) or links == 8  # from eight links on there are groups of six


@pytest.mark.parametrize("links, mobility, groups", [(5, 1, "II,III,IV"), (6, 2, "II,III"), (7, 1, "RRR,RRP")])
def test_schemes_are_admissible(links, mobility, groups):
    for scheme in schemes(links, mobility, read_group_types(groups)):
        assert scheme.mobility == mobility and scheme.links == links
        assert all(len({known for known, _, _ in group.outer}) > 1 for group in scheme.groups)
        assert len({frozenset((i, j)) for i, j, _ in scheme.joints}) == len(scheme.joints)
        assert all(any(i == crank for i, _, _ in scheme.joints) for crank in range(1, mobility + 1))
        # a hinge whose two links slide on one another, or on links that do, never turns
        assert all(scheme.directions[i] != scheme.directions[j] for i, j, kind in scheme.joints if kind == "R")


def test_schemes_of_seven_links_in_the_usual_groups_are_not_too_many():
    assert len(schemes(7, 1, ("RRR", "RRP"))) < MOST_SCHEMES


@pytest.mark.parametrize(
    "links, groups, some",
    [
        (3, "II", slice(None)),
        (5, "RRR,RRP", slice(0, None, 13)),
        (5, "II", slice(3, None, 80)),
        (7, "RRR,RRP", slice(0, None, 900)),
    ],
)
def test_the_problem_of_a_class_ii_scheme_is_that_scheme_and_runs(links, groups, some):
    for scheme in schemes(links, 1, read_group_types(groups))[some]:
        is_that_scheme_and_runs(scheme)


def is_that_scheme_and_runs(scheme):
    made = make_scheme_file(scheme, "a scheme")
    problem = build_problem(read_text(made.text, "scheme.yaml"))
    results = solve(problem)
    structure = results.structure
    assert (structure.formula, structure.mobility) == (scheme.formula, scheme.mobility)
    assert [f"II {group.type}" for group in structure.groups] == list(scheme.types)
    pairs = {(frozenset((int(p.i), int(p.j))), p.kind) for p in structure.pairs}
    assert pairs == {(frozenset((i, j)), kind) for i, j, kind in scheme.joints}
    assert results.motion.placed.all()
    assert max(results.lever.difference) < 1e-9
    assert abs(results.reactions.balance.moment).max() > 0


@pytest.mark.parametrize(
    "links, groups, some",
    [(5, "III,IV", slice(0, None, 2)), (7, "RRR,III,IV", slice(69, None, 40))],
)
def test_the_problem_of_a_higher_scheme_has_its_structure(links, groups, some, monkeypatch):
    monkeypatch.setattr(scheme_files, "FEW_CANDIDATES", 2)  # poses
    for scheme in schemes(links, 1, read_group_types(groups))[some]:
        problem = build_problem(read_text(make_scheme_file(scheme, "a scheme").text, "scheme.yaml"))
        structure = analyse_structure(problem.linkage)
        assert structure.formula == scheme.formula
        assert (structure.mobility, structure.freedom) == (1, 1)
        assert structure.redundant_pairs == structure.under_constrained == ()


def test_a_crank_rocker_and_crank_sliders_of_all_kinds_turn_fully():
    for scheme in (*schemes(3)[:4], *schemes(5, 1, ("RRR", "RRP"))[::10]):
        problem = build_problem(read_text(make_scheme_file(scheme, "a scheme").text, "scheme.yaml"))
        assert solve(problem, "kinematics").driver_range.full, scheme.joints


def test_a_problem_is_the_same_every_time_and_its_dimensions_are_whole():
    scheme = schemes(5, 1, ("RPR", "RPP"))[7]
    text = make_scheme_file(scheme, "a scheme").text
    assert text == make_scheme_file(scheme, "a scheme").text
    sizes = re.findall(r"length: ([^,}]+)|\[([-0-9.]+), ([-0-9.]+)\]", text.split("masses:")[0].split("points:", 1)[1])
    assert sizes and all(re.fullmatch(r"-?\d+", number) for row in sizes for number in row if number)


def test_the_command_writes_a_problem_a_scheme_and_nothing_else(tmp_path):
    out = tmp_path / "in" / "here"
    done = tmm("schemes", "--links", 3, "--groups", "RRR,rrp", "--out", out)
    assert done.returncode == 0, done.stderr
    names = sorted(path.name for path in out.iterdir())
    assert names == ["scheme-01-II-RRR.yaml", "scheme-02-II-RRP.yaml", "scheme-03-II-RRP.yaml"]
    assert all(name in done.stdout for name in names) and "number of schemes: 3" in done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["in"]
    assert tmm("structure", *sorted(out.iterdir())).stdout.count("I(0,1) → II(2,3)") == 3
    run = tmm("run", out / names[1], "-o", tmp_path / "out", "--no-drawings")
    assert run.returncode == 0 and "error" not in run.stderr


def test_a_file_that_was_changed_is_not_written_over(tmp_path):
    assert tmm("schemes", "--links", 3, "--groups", "RRR,RRP", "--out", tmp_path).returncode == 0
    assert tmm("schemes", "--links", 3, "--groups", "RRR,RRP", "--out", tmp_path).returncode == 0
    mine = tmp_path / "scheme-02-II-RRP.yaml"
    mine.write_text("mine", encoding="utf-8")
    (tmp_path / "scheme-01-II-RRR.yaml").unlink()
    done = tmm("schemes", "--links", 3, "--groups", "RRR,RRP", "--out", tmp_path)
    assert done.returncode == 2 and "scheme-02-II-RRP.yaml" in done.stderr
    assert mine.read_text(encoding="utf-8") == "mine"
    assert len(list(tmp_path.iterdir())) == 2  # none of the others was written either


def test_a_narrow_terminal_breaks_the_table_of_schemes_and_cuts_nothing():
    console = Console(width=60, record=True, file=io.StringIO(), highlight=False)
    found = schemes(5, 1, ("RRR",))
    print_on_terminal(schemes_table(found, 5, 1, None), UnitSystem(), console)
    text = console.export_text()
    assert all(len(line) <= 60 for line in text.splitlines())
    assert all(f"{i}-{j}" in text for scheme in found for i, j, _ in scheme.joints)
    assert text.count("links/pairs") == 1  # words are broken rather than the table


def test_the_command_counts_chains_by_assortment():
    assert "Kinematic chains of 8 links, W = 1: 16" in tmm("schemes", "--chains", 8).stdout
    told = json.loads(tmm("schemes", "--chains", 7, "--mobility", 2, "--json").stdout)
    assert (told["count"], told["fractionated"], len(told["chains"])) == (4, 1, 4)
    told = json.loads(tmm("schemes", "--links", 4, "--mobility", 2, "--json").stdout)
    assert told["count"] == 5
    assert told["schemes"][0]["formula"] == "I(0,1) + I(0,2) -> II(3,4)"


@pytest.mark.parametrize(
    "arguments, words",
    [
        ((), "--links N for schemes, --chains N"),
        (("--links", 5, "--chains", 6), "--links N for schemes, --chains N"),
        (("--links", 4), "for W = 1 the number of links can be: 3, 5, 7, 9"),
        (("--links", 10**9), "for W = 1 the number of links can be: 3, 5, 7, 9"),
        (("--links", 9), "more than 2000"),
        (("--links", 5, "--mobility", 0), "1 to 3"),
        (("--links", 3, "--groups", "RRR,RRX"), "did you mean 'RRR'?"),
        (("--links", 7, "--groups", "RRR,RRP", "--out", "out"), "at most 300"),
        (("--chains", 12), "for W = 1 the number of links can be: 4, 6, 8, 10"),
        (("--chains", 8, "--mobility", -1), "1 to 8"),
        (("--chains", 8, "--out", "out"), "no problem files can be written for kinematic chains"),
    ],
)
def test_what_cannot_be_built_is_refused_in_one_message(arguments, words, tmp_path):
    done = tmm("schemes", *arguments, "--json")
    assert done.returncode == 2
    assert words in done.stderr and "Traceback" not in done.stderr
    assert set(json.loads(done.stdout)) == {"error"}


@pytest.mark.parametrize("links, mobility", [(4, 2), (5, 3), (6, 2)])
def test_schemes_of_more_freedoms_get_as_many_drivers_and_run(links, mobility):
    every = {4: 2, 5: 3, 6: 16}[links]
    for scheme in schemes(links, mobility, read_group_types("RRR,RRP"))[::every]:
        made = make_scheme_file(scheme, scheme.formula)
        assert made is not None
        results = solve(build_problem(read_text(made.text, "scheme.yaml")))
        assert len(results.linkage.drivers) == results.structure.mobility == mobility
        assert np.max(results.lever.difference[results.motion.moving]) < 1e-9


def test_the_list_of_schemes_says_which_groups_it_does_not_enumerate():
    missing = (
        "Not enumerated: groups of classes III and IV with six links or more (e.g. class III of order 4) "
        "or with prismatic pairs, and groups of class V and higher. Only groups with four links and "
        "revolute pairs are listed."
    )
    written = json.loads(tmm("schemes", "-n", "7", "--groups", "III", "--json").stdout)
    assert (written["count"], written["not_enumerated"]) == (0, [missing])
    assert "Not enumerated" in tmm("schemes", "-n", "7", "--groups", "III").stdout
    assert json.loads(tmm("schemes", "-n", "3", "--json").stdout)["not_enumerated"] == []


@pytest.mark.parametrize("example", GROUP_EXAMPLES, ids=lambda e: f"{ROMAN[e.group_class]}-{e.order}-{e.name}")
def test_a_group_of_the_table_is_of_the_class_and_order_under_which_it_stands(example):
    """3n - 2p = 0 with its leads; the class by the count of the report, the order by its leads."""
    joined = example.pairs
    assert 3 * len(example.links) == 2 * len(joined)
    assert {point for point, links in joined if len(links) == 1} == set(example.external)
    pairs = [SimpleNamespace(i=links[0], j=(*links, "0")[1], lower=True, name=point) for point, links in joined]
    inner, outer = [p for p in pairs if p.j != "0"], [p for p in pairs if p.j == "0"]
    assert group_class([(link,) for link in example.links], inner, outer, ()) == example.group_class
    assert len(outer) == example.order


def test_the_table_of_groups_is_drawn_with_its_classes(tmp_path):
    done = tmm("schemes", "--table", "-o", str(tmp_path / "table"))
    assert done.returncode == 0, done.stderr
    assert sorted(file.name for file in (tmp_path / "table").iterdir()) == ["assur-groups.png", "assur-groups.svg"]
    text = (tmp_path / "table" / "assur-groups.svg").read_text(encoding="utf-8")
    for words in ("II, order 2: RPR", "III, order 4", "IV, order 2", "V, order 3", "VI, order 3"):
        assert f"class {words}" in text
