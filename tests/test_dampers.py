"""Dampers between points and between links: what they take from the machine, and how files and reports have them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from bank import solved as of_bank, written
from fuzz import beyond
from models import solved_text
from test_commands import tmm

from tmm_cli.drawing.paper import DrawingSheet, LineMark
from tmm_cli.drawing.symbols import MechanismScene, draw_elements
from tmm_cli.note import ComputedQuantity, Note, Paragraph, note
from tmm_cli.problem import ProblemError, build_any_problem, read_text
from tmm_cli.reports import explain_tables

RADIUS, OMEGA = 0.05, 6 * np.pi  # of the rig's crank: m, rad/s
LINEAR, QUADRATIC, ROTARY = 400.0, 750.0, 0.4

RIG = Path(__file__).parents[1] / "problems" / "damper-rig.yaml"
FOUR_BAR = """tmm: 1
points: {A: [0 mm, 0 mm], D: [300 mm, 0 mm], W: [100 mm, 250 mm]}
links:
  1: {points: [A, B], length: 80 mm}
  2: {points: {B: [0 mm, 0 mm], C: [250 mm, 0 mm], K: [120 mm, 60 mm]}}
  3: {points: [C, D], length: 200 mm}
driver: {link: 1, speed: 90 rpm, turns: cw}
sketch: {at: 60 deg, B: [40 mm, 69 mm], C: [250 mm, 190 mm]}
masses: {2: {mass: 2 kg, inertia: 0.01, centre: K}, 3: {mass: 1 kg, inertia: 0.005, centre: C}}
output: 3
positions: {count: 24}
"""
BETWEEN_LINKS = (
    "dampers: {d: {between: [0, 2], at: [W, K], linear: 90, quadratic: 35}, t: {between: [3, 2], torsion: 2}}\n"
)


def rig(count):
    """The rig of the bank at this many positions of a turn."""
    return solved_text(RIG.read_text(encoding="utf-8").replace("count: 12", f"count: {count}"))


def test_a_harmonic_motion_loses_what_books_on_vibrations_say_in_a_cycle():
    """pi c w X^2 by linear damping, 8/3 a w^2 X^3 by quadratic (S. S. Rao, Mechanical Vibrations, ch. 3), 2 pi c w by
    the brake on the shaft.
    """
    mean_power = np.mean(rig(720).energy.drivers)
    work = mean_power * 2 * np.pi / OMEGA
    expected = (
        np.pi * LINEAR * OMEGA * RADIUS**2 + 8 / 3 * QUADRATIC * OMEGA**2 * RADIUS**3 + 2 * np.pi * ROTARY * OMEGA
    )
    assert work == pytest.approx(expected, rel=1e-9)


def test_the_balancing_moment_follows_the_square_and_the_cube_of_the_sine():
    results = rig(24)
    sine = np.abs(np.sin(results.motion.q))
    speed = RADIUS * OMEGA * sine
    inertia = 3 * (RADIUS * OMEGA) ** 2 * np.sin(results.motion.q) * np.cos(results.motion.q)  # yoke of 3 kg
    expected = ROTARY * OMEGA + RADIUS * sine * (LINEAR * speed + QUADRATIC * speed**2) + inertia
    assert results.reactions.balance.moment == pytest.approx(expected, rel=1e-12)


def test_dampers_take_the_power_of_their_relative_motion_and_the_powers_balance():
    results = solved_text(FOUR_BAR + BETWEEN_LINKS)
    motion = results.motion
    end = motion.point("2", motion.linkage.links["2"].points["K"])
    away = end.x - (0.1 + 0.25j)
    faster = np.real(np.conj(away) * end.v) / np.abs(away)
    twist = motion.link("2").omega - motion.link("3").omega
    taken = 90 * faster**2 + 35 * np.abs(faster) ** 3 + 2 * twist**2
    assert -results.energy.dampers == pytest.approx(taken, rel=1e-12)
    assert np.array_equal(results.energy.loads, results.energy.dampers)  # there are no other loads
    assert np.max(np.abs(results.energy.balance)) < 1e-12
    assert np.max(results.lever.difference) < 1e-12
    assert beyond(results) is None


def test_a_linear_damper_is_a_spring_without_stiffness():
    damper = "dampers: {d: {between: [0, 2], at: [W, K], linear: 90}}\n"
    spring = "springs: {d: {between: [0, 2], at: [W, K], rate: 0, damping: 90}}\n"
    one, other = (solved_text(FOUR_BAR + text).reactions.balance.moment for text in (damper, spring))
    assert np.array_equal(one, other)


def test_without_motion_against_each_other_a_torsional_damper_does_nothing():
    """The coupler of a parallelogram only translates."""
    parallel = FOUR_BAR
    for text, other in (
        (", W: [100 mm, 250 mm]", ""),
        ("D: [300 mm", "D: [250 mm"),
        ("length: 200 mm", "length: 80 mm"),
        ("C: [250 mm, 190 mm]", "C: [290 mm, 69 mm]"),
        ("count: 24", "at: [40 deg, 70 deg, 130 deg]"),  # off its change points
    ):
        parallel = parallel.replace(text, other)
    results = solved_text(parallel + "dampers: {t: {between: [0, 2], torsion: 2, torsion quadratic: 5}}\n")
    (moment,) = (load.moment for load in results.loads if load.name == "t")
    assert np.max(np.abs(moment)) < 1e-12


@pytest.mark.parametrize(
    "keys, message",
    [
        (
            "at: [W, K], linear: 90, torsion: 2",
            "x.yaml:12:11: dampers.d: a damper acts either along the line of two points or on the relative rotation of "
            "two links\n"
            "  found:   linear, torsion\n"
            "  allowed: `linear`, `quadratic` or both; or `torsion`, `torsion quadratic` or both",
        ),
        (
            "at: [W, K]",
            "x.yaml:12:11: dampers.d: a damper acts either along the line of two points or on the relative rotation of "
            "two links\n"
            "  allowed: `linear`, `quadratic` or both; or `torsion`, `torsion quadratic` or both",
        ),
        (
            "at: [W, K], quadratic: 20 N*s/m",
            "x.yaml:12:55: dampers.d.quadratic: expected here: a coefficient of the squared speed\n"
            "  found:   '20 N*s/m', a damping coefficient (20 N*s/m)\n"
            "  allowed: a coefficient of the squared speed, e.g. 30 N*s^2/m^2",
        ),
        (
            "at: [W, K], linear: -1",
            "x.yaml:12:52: dampers.d.linear: a damping coefficient cannot be negative\n"
            "  found:   -1\n"
            "  allowed: zero or more",
        ),
        (
            "at: [W, K], torsion quadratic: 1",
            "x.yaml:12:32: dampers.d.at: a torsional element has no end points",
        ),
    ],
)
def test_a_wrong_damper_is_refused(keys, message):
    with pytest.raises(ProblemError) as caught:
        build_any_problem(read_text(f"{FOUR_BAR}dampers: {{d: {{between: [0, 2], {keys}}}}}\n", "x.yaml"))
    assert str(caught.value) == message


def test_its_name_is_that_of_no_spring():
    both = FOUR_BAR + "springs: {d: {between: [0, 2], at: [W, K], rate: 0}}\n" + BETWEEN_LINKS
    with pytest.raises(ProblemError, match=r"dampers\.d: this name is already in use"):
        build_any_problem(read_text(both, "x.yaml"))


def test_no_law_of_motion_is_computed_with_it(tmp_path):
    file = tmp_path / "x.yaml"
    file.write_text(FOUR_BAR + BETWEEN_LINKS + "dynamics: {delta: 1/30}\n", encoding="utf-8")
    told = tmm("run", file)
    assert told.returncode == 2
    assert "dampers.d: the law of motion is not computed if forces depend on reactions or on speeds" in told.stderr


def test_explain_and_the_note_have_its_law():
    results = of_bank("damper-rig")
    (table,) = (table for table in explain_tables(results) if table.name == "dampers")
    assert list(zip(*(column.values for column in table.columns), strict=True)) == [
        ("d", "3, frame", "[80, 0], [200, 0]", "400 N*s/m", "750 N*s^2/m^2"),
        ("t", "frame, 1", "", "0.4 N*m*s/rad", ""),
    ]
    quantities = [block for block in written("damper-rig").blocks if isinstance(block, ComputedQuantity)]
    told = {quantity.name.plain: quantity.result for quantity in quantities}
    speed = RADIUS * OMEGA * np.sin(np.pi / 3)  # in the detailed position
    assert told["d"] == pytest.approx(LINEAR * speed + QUADRATIC * speed**2, rel=1e-12)
    assert told["t"] == pytest.approx(ROTARY * OMEGA, rel=1e-12)


def sentences(whole: Note) -> list[str]:
    """Paragraphs of a note, with the letters of its symbols."""
    paragraphs = [block for block in whole.blocks if isinstance(block, Paragraph)]
    return [
        "".join(part if isinstance(part, str) else getattr(part, "plain", "") for part in p.line) for p in paragraphs
    ]


def test_the_note_on_a_spring_names_the_coefficients_that_it_has():
    (valve,) = (text for text in sentences(written("valve-drive")) if "of the spring" in text)
    assert "its length l and on the rate v at which it changes" in valve and "b its damping coefficient" in valve
    damper = "springs: {s: {between: [0, 2], at: [W, K], rate: 0, damping: 90}}\n"
    detailed = FOUR_BAR.replace("count: 24", "count: 24, detail: [2]") + damper
    told = [text for text in sentences(note(solved_text(detailed), drawn=False)) if "of the spring s" in text]
    assert told == [
        "The force of the spring s, which has no stiffness, depends on the rate v at which its length changes; b is "
        "its damping coefficient:"
    ]


def test_it_is_drawn_as_a_piston_in_a_cylinder_from_end_to_end():
    results = of_bank("damper-rig")
    sheet = DrawingSheet("t", "c", [-0.05 - 0.05j, 0.25 + 0.05j])
    scene = MechanismScene(results.linkage, results.structure, results.motion.poses, 2)
    draw_elements(sheet, scene)
    lines = [mark.places for mark in sheet.marks if isinstance(mark, LineMark)]
    start, end = sheet.on(scene.place("3", 0.08 + 0j)), sheet.on(0.2 + 0j)
    rod, stem = [line for line in lines if line[0] == pytest.approx(start) or line[-1] == pytest.approx(end)]
    cylinder = next(line for line in lines if len(line) == 4)
    assert rod[1] == pytest.approx((cylinder[1] + cylinder[2]) / 2)
    assert abs(start - cylinder[1]) < abs(start - stem[0]) < abs(start - cylinder[0])  # the piston is in the cylinder
    assert [label.text for label in sheet.labels] == ["d", "t"]
