"""A cylinder between two moving links: its stroke, and what it does, from virtual work by hand."""

from __future__ import annotations

import numpy as np
import pytest
from models import solved_text

from tmm_cli.problem import ProblemError

SWINGING = """tmm: 1
points: {O: [0, -300], D: [350, 0]}
links:
  1: {name: cylinder, points: [O]}
  2: {name: piston, points: [B], slides: {on: 1, through: O, angle: 0}}
  3: {name: lever, points: {D: [0, 0], B: [200, 0], E: [-250, 50]}}
driver: {link: 2, on: 1, speed: 150 mm/s, stroke: [400, 600]}
sketch: {at: 550, B: [267, 182]}
loads: {F: {on: 3, at: E, force: [0, -800]}}
output: 3
positions: {count: 5}
"""


def test_the_positions_go_from_end_to_end_of_the_stroke():
    results = solved_text(SWINGING)
    assert np.allclose(results.motion.q, [0.4, 0.45, 0.5, 0.55, 0.6], rtol=0, atol=1e-15)
    assert results.structure.formula == "I(1,2) -> II(1,2,3)"


def test_the_lever_is_where_the_triangle_of_the_cylinder_puts_it():
    results = solved_text(SWINGING)
    base, arm, length = 0.35 + 0.3j, 0.2, results.motion.q
    cosine = (abs(base) ** 2 + arm**2 - length**2) / (2 * abs(base) * arm)
    angle = np.angle(-base) + 2 * np.pi - np.arccos(cosine)
    assert np.max(np.abs(np.exp(1j * results.motion.link("3").angle) - np.exp(1j * angle))) < 1e-14
    # l^2 = b^2 + a^2 - 2 a b cos(t)  gives  l l' = a b sin(t) t'
    speed = length * 0.15 / (abs(base) * arm * np.sqrt(1 - cosine**2))
    assert np.allclose(np.abs(results.motion.link("3").omega), speed, rtol=1e-13)


def test_the_force_of_the_cylinder_follows_from_virtual_work():
    results = solved_text(SWINGING)
    work = 800 * results.motion.named("E").v.imag
    assert np.allclose(results.reactions.balance.force * 0.15, work, rtol=0, atol=1e-12)


def test_it_pushes_along_its_own_axis_and_the_hinges_feel_nothing_else():
    results = solved_text(SWINGING)
    force = results.reactions.of("O").onto("1")
    along = results.motion.named("B").x - (0 - 0.3j)
    assert np.max(np.abs((force * np.conj(along)).imag)) < 1e-12
    assert np.allclose(np.abs(force), np.abs(results.reactions.balance.force), rtol=1e-13)


def test_a_sketch_beyond_the_stroke_is_refused():
    with pytest.raises(ProblemError) as caught:
        solved_text(SWINGING.replace("at: 550", "at: 650"))
    assert str(caught.value) == (
        "x.yaml:8:14: sketch.at: in the sketch the driver is outside its stroke\n  found:   650"
    )


def test_a_cylinder_that_pushes_at_its_ends_only_is_a_spring_without_rate():
    text = SWINGING.replace(
        "driver: {link: 2, on: 1, speed: 150 mm/s, stroke: [400, 600]}", "driver: {link: 3, speed: 1 rad/s}"
    )
    text = text.replace("  1: {name: cylinder, points: [O]}\n", "").replace(
        "  2: {name: piston, points: [B], slides: {on: 1, through: O, angle: 0}}\n", ""
    )
    text = text.replace("sketch: {at: 550, B: [267, 182]}", "sketch: {at: 120}")
    text = text.replace(
        "loads: {F: {on: 3, at: E, force: [0, -800]}}",
        "springs: {c: {between: [0, 3], at: [[0, -300], B], rate: 0, preload: -500}}",
    )
    results = solved_text(text.replace("output: 3\n", "").replace("points: {O: [0, -300], D", "points: {D"))
    pivot, end = 0.35 + 0j, results.motion.named("B").x
    push = 500 * (end + 0.3j) / np.abs(end + 0.3j)
    moment = (np.conj(end - pivot) * push).imag
    assert np.allclose(results.reactions.balance.moment, -moment, rtol=0, atol=1e-12)
