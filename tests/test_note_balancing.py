"""Chapters of the note on balancing and on instantaneous centres: formulas by hand, where a file asks for them."""

from collections.abc import Iterator
from functools import cache

import pytest
from bank import solved
from formulas import formulas
from models import PROBLEMS

from tmm_cli import solve
from tmm_cli.note import ComputedQuantity, Figure, Heading, Note, Subject, balancing, centres, html, note
from tmm_cli.problem import build_problem, read_text

HEADINGS = {"Balancing", "Instantaneous centres"}
SHAFT = """{masses: [{mass: 200, radius: 80}, {mass: 300, radius: 70, angle: 45, at: 300},
  {mass: 400, radius: 60, angle: 115, at: 400}, {mass: 200, radius: 80, angle: 235, at: 700}],
  planes: [{at: 100, radius: 100}, {at: 500, radius: 100}]}"""


@cache
def written(name: str, block: str) -> Note:
    """Of a problem of the bank with another block `balancing`."""
    text = (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8").split("\nbalancing:")[0]
    return note(solve(build_problem(read_text(f"{text}\nbalancing: {block}\n", f"{name}.yaml"))), drawn=False)


def found(blocks: Note) -> Iterator[tuple[str, float]]:
    """Quantities that are found, with their results."""
    for block in blocks.blocks:
        if isinstance(block, ComputedQuantity):
            yield block.name.plain, block.result


def test_masses_in_the_hinges_of_a_coupler_give_the_counterweights_of_a_four_bar():
    told = dict(found(note(solved("balanced-four-bar"), drawn=False)))
    assert (told["m2A"], told["m2B"]) == pytest.approx((1.5, 1.0))
    assert (told["D1"], told["D3"]) == pytest.approx((0.2, 0.43))
    assert (told["mc1"], told["mc3"]) == pytest.approx((5, 5))


def test_a_connecting_rod_with_its_counterweight_is_a_mass_in_the_crank_pin():
    told = dict(found(note(solved("balanced-crank-slider"), drawn=False)))
    assert (told["D2"], told["m2A"], told["D1"]) == pytest.approx((0.2827, 4.57, 0.2742))


@pytest.mark.parametrize("share", [0, 0.3, 2 / 3, 1])
def test_a_counterweight_on_the_crank_takes_its_share_of_what_goes_to_and_fro(share):
    told = dict(found(written("balanced-crank-slider", f"{{counterweights: {{1: {{}}}}, share: {share}}}")))
    assert told["D1"] == pytest.approx(0.06 * (1.1 * 0.65 + share * (1.1 * 0.35 + 0.9)))


def test_counterweights_that_no_masses_in_hinges_give_are_told_without_a_formula():
    told = dict(found(written("six-bar", "{counterweights: {1: {}, 3: {}}}")))
    assert "D1" not in told and "λ" in told and "Fx" in told


def test_masses_of_a_shaft_in_two_planes_are_found_by_sums_of_their_parts():
    """R. S. Khurmi, J. K. Gupta, Theory of Machines (2005), example 21.2: 355 and 182.5 kg by drawing."""
    page = written("crank-slider", f"{{rotor: {SHAFT}}}")
    told = dict(found(page))
    assert (told["mI"], told["mII"]) == pytest.approx((355, 182.5), rel=0.02)
    read = formulas(html(page).decode())
    assert len(read) > 8 and all(one.true for one in read)


def test_centres_are_counted_and_give_the_speeds_of_all_links():
    results = solved("six-bar")
    (k,) = results.centres
    told = dict(found(Note("", "en", tuple(centres.write_centres(Subject(results, drawn=False))))))
    assert told["N"] == len(results.centres[k]) == 15
    for link in "234":
        assert told[f"ω{link}"] == pytest.approx(abs(results.motion.link(link).omega[k]))
    assert told["v5"] == pytest.approx(abs(results.motion.named("F").v[k]))


@pytest.mark.parametrize("name", ["shaper", "shaper-motor", "crank-rocker"])
def test_a_file_that_does_not_ask_has_neither_chapter(name):
    headings = {block.text for block in note(solved(name), drawn=False).blocks if isinstance(block, Heading)}
    assert not headings & HEADINGS


@pytest.mark.parametrize(
    ("name", "chapter", "stem"),
    [
        ("balanced-four-bar", balancing.write_balancing, "shaking-force"),
        ("six-bar", centres.write_centres, "centres-03"),
    ],
)
def test_each_chapter_has_its_drawing(name, chapter, stem):
    figures = [block.key for block in chapter(Subject(solved(name))) if isinstance(block, Figure)]
    assert figures == [stem]
