"""Variants that are drawn are sound, unlike one another, and a student's hangs on the seed and his name."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from test_commands import SHAPER

from tmm_cli import solve
from tmm_cli.batch import read_free_parameters, read_task, with_vary
from tmm_cli.grading import VariantGenerator, draw_numbered_variants, draw_student_variants, draw_variants
from tmm_cli.problem import ProblemError, read_text

ASKED = """
variants: {OA: {from: 100, to: 240, step: 5}, DE: [150, 250], n1: {among: [70 rpm, 80 rpm, 90 rpm]}}
grading: {answers: [{of: H}, {of: k}, {of: v of E, at: [3, 7]}, {of: M_b, at: 3}]}
"""


def task(text=ASKED, vary=()):
    return read_task(with_vary(read_text(SHAPER.read_text(encoding="utf-8") + text, "task.yaml"), vary))


@pytest.fixture(autouse=True)
def few(monkeypatch):
    monkeypatch.setattr(draw_variants, "CHUNK", 100)
    monkeypatch.setattr(draw_variants, "ENOUGH", 80)


@cache
def drawn():
    variety = VariantGenerator(task())
    return variety, draw_numbered_variants(variety, 1, 12)


def test_drawn_variants_are_sound_as_files_of_their_own():
    variety, table = drawn()
    assert len(table.rows) == 12 and len(set(table.rows.values())) == 12
    for row in list(table.rows.values())[:4]:
        results = solve(variety.task.variant(dict(zip(table.names, row, strict=True))))
        assert results.driver_range.full and not results.dead
        assert all(pressure.holds for pressure in results.pressure)
        assert all(slot.far <= 0 for slot in results.slots)
        margins = (np.min(at.margin) for at in results.motion.placements)
        assert all(margin > kernel.near for margin, kernel in zip(margins, results.kernels, strict=True))


def test_what_was_thrown_away_is_counted_by_its_reason():
    variety, _table = drawn()
    assert variety.rejected["the pressure angle exceeds 30 deg"] > 0
    assert sum(variety.rejected.values()) < variety.tried


def test_results_are_spread_over_their_range():
    variety, table = drawn()
    strokes = [
        solve(variety.task.variant(dict(zip(table.names, row, strict=True))), "kinematics").strokes.travel
        for row in list(table.rows.values())[:5]
    ]
    assert max(strokes) > 1.8 * min(strokes)


def test_a_student_has_a_variant_by_the_seed_and_the_name_alone():
    names = ["Ana", "Бојан", "Čeda", "<script>"]
    few = draw_student_variants(VariantGenerator(task()), 7, names)
    more = draw_student_variants(VariantGenerator(task()), 7, ["Aaron", *reversed(names), "Zoran"])
    assert {name: more.rows[name] for name in names} == few.rows
    assert len(set(more.rows.values())) == 6
    assert draw_student_variants(VariantGenerator(task()), 8, names).rows != few.rows


def test_one_by_one_they_are_judged_as_together():
    variety = VariantGenerator(task())
    picks = np.array([[0, 0, 0], [28, 0, 0], [4, 50, 2]])
    together = variety.check(picks)
    variety.alone = True
    alone = variety.check(picks)
    assert (
        together.why.tolist()
        == alone.why.tolist()
        == ["", "the output link moves differently than in the problem file", ""]
    )
    assert together.values == pytest.approx(alone.values, rel=1e-9)


@pytest.mark.parametrize(
    ("vary", "texts"),
    [
        ("OA=80..90:5", ("80", "85", "90")),
        ("OA=8 cm..9 cm:5 mm", ("8 cm", "8.5 cm", "9 cm")),
        ("n1=80 rpm..81 rpm:0.5", ("80 rpm", "80.5 rpm", "81 rpm")),
        ("OA=1..2:0.3", ("1", "1.3", "1.6", "1.9")),
    ],
)
def test_ranges_of_the_command_take_the_place_of_those_of_the_file(vary, texts):
    found = {choice.name: choice.texts for choice in read_free_parameters(task(vary=[vary]))}
    assert found[vary.partition("=")[0]] == texts


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        ("OA", ("--vary OA: expected a name, two bounds and optionally a step\n  allowed: --vary OA=80..140:5")),
        (
            "OA=90..80:5",
            (
                "--vary OA=90..80:5: variants.OA: the first bound must be smaller than the second\n"
                "  found:   90 and 80\n"
                "  allowed: [low, high]"
            ),
        ),
        (
            "OA=80..90:0",
            (
                "--vary OA=80..90:0: variants.OA.step: the number of steps between the bounds must be from 1 to 9999\n"
                "  found:   0\n"
                "  allowed: give another step, or bounds without a step: [low, high]"
            ),
        ),
        (
            "oa=80..90",
            (
                "--vary oa=80..90: variants.oa: no parameter has this name\n"
                "  found:   'oa'\n"
                "  allowed: OA, OC, CD, DE, n1\n"
                "  did you mean 'OA'?"
            ),
        ),
    ],
)
def test_ranges_that_are_none_are_refused(vary, message):
    with pytest.raises(ProblemError) as caught:
        read_free_parameters(task(vary=[vary]))
    assert str(caught.value) == message
