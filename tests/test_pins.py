"""Compound hinges: what the pin does to each of its links, however the hinge is counted as pairs."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from test_commands import tmm

from tmm_cli import solve
from tmm_cli.problem.build import build
from tmm_cli.problem.reader import read_text
from tmm_cli.results.as_json import to_json

SIX_BAR = Path("problems/six-bar.yaml")
TEXT = SIX_BAR.read_text(encoding="utf-8")
PUSH = complex(300, -700)  # N, on the pin B


def pins(text):
    """The force of pin B on each link, N, and the largest of them."""
    results = solve(build(read_text(text, "pins.yaml")))
    found = {pin.link: pin.force for pin in results.reactions.pins(results.linkage)}
    return found, max(np.max(np.abs(force)) for force in found.values())


def pushed(link):
    """The linkage with the pin pushed, the push being put down to one of its links."""
    return pins(TEXT.replace("loads:\n", f"loads:\n  P: {{on: {link}, at: B, force: [{PUSH.real}, {PUSH.imag}]}}\n"))


def test_what_a_pin_does_to_its_links_comes_to_nothing():
    force, largest = pins(TEXT)
    assert list(force) == ["2", "3", "4"]
    assert np.max(np.abs(sum(force.values()))) < 1e-15 * largest


@pytest.mark.parametrize("link", ["2", "3", "4"])
def test_the_links_bear_the_load_on_their_pin_whichever_of_them_it_is_put_down_to(link):
    force, largest = pushed(link)
    borne = {name: f + (PUSH if name == link else 0) for name, f in force.items()}
    assert np.max(np.abs(PUSH - sum(borne.values()))) < 1e-15 * largest, "the pin itself is in equilibrium"
    other, __ = pushed("2")
    for name, f in borne.items():
        assert np.max(np.abs(f - other[name] - (PUSH if name == "2" else 0))) < 4e-15 * largest


def test_the_pin_bears_each_link_with_all_that_acts_on_it():
    """Rod 4 hangs on pin B and pin F: both forces, its weight and its inertia are in equilibrium."""
    results = solve(build(read_text(TEXT, "pins.yaml")))
    force = next(pin.force for pin in results.reactions.pins(results.linkage) if pin.link == "4")
    total = force + results.reactions.of("F").onto("4") + sum(x.force for x in results.loads if x.link == "4")
    assert np.max(np.abs(total)) < 1e-15 * np.max(np.abs(force))


def test_how_a_hinge_is_counted_as_pairs_does_not_matter():
    rocker = "  3: {name: rocker, points: [D, B], length: BD}\n"
    other = TEXT.replace(rocker, "").replace("  2: {name", rocker + "  2: {name")
    one, two = (solve(build(read_text(text, "pins.yaml"))) for text in (TEXT, other))
    assert [r.pairs for r in one.reactions.pins(one.linkage)] == [("B",), ("B", "B''"), ("B''",)]
    found = {pin.link: pin for pin in two.reactions.pins(two.linkage)}
    assert found["2"].pairs == ("B", "B''")
    for pin in one.reactions.pins(one.linkage):
        assert np.max(np.abs(pin.force - found[pin.link].force)) < 4e-15 * np.max(np.abs(pin.force))


def test_tables_and_result_json_have_a_row_a_link(tmp_path):
    assert tmm("forces", SIX_BAR).stdout.count("B, B''") == 1
    tmm("run", SIX_BAR, "--no-drawings", "-o", tmp_path)
    with next(tmp_path.rglob("pins.csv")).open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    written = to_json(solve(build(read_text(TEXT, "pins.yaml"))))["forces"]["compound_hinges"]["B"]
    for row in rows:
        position = int(row["position"])
        assert float(row["Fx, N"]) == pytest.approx(written[row["link"]]["x"][position], rel=1e-8)
    assert len(rows) == 12 * 3
    assert "Compound hinges" not in tmm("forces", "problems/crank-rocker.yaml").stdout
