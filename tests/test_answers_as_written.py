"""One answer as students write it: numbers, units and vectors in all their spellings, and what is none."""

from __future__ import annotations

import pytest

from tmm_cli.grading import Heading, Headings, ReadAnswer, read_answer
from tmm_cli.problem import ProblemError


def read(text):
    """Without the text itself."""
    found = read_answer(text)
    return found and (found.first, found.second, found.form, found.unit, found.turn_unit)


@pytest.mark.parametrize(
    ("text", "number", "unit"),
    [
        ("1,31", 1.31, ""),
        (" 1.31 m/s", 1.31, "m/s"),
        ("−1,31 м/с", -1.31, "м/с"),
        ("–1.31", -1.31, ""),
        ("—1.31", -1.31, ""),
        ("\u20111.31", -1.31, ""),
        ("- 1.31", -1.31, ""),
        ("+5", 5.0, ""),
        (",5", 0.5, ""),
        ("3·10^-3", 3e-3, ""),
        ("3*10^-3", 3e-3, ""),
        ("3 × 10⁻³ kN", 3e-3, "kN"),
        ("3,5·10^(-3)", 3.5e-3, ""),
        ("10^-3", 1e-3, ""),
        ("3e-3", 3e-3, ""),
        ("3Е2", 300.0, ""),  # Cyrillic
        ("1 200,5 N", 1200.5, "N"),
        ("1\u2009200 Н", 1200.0, "Н"),
        ("1\u202f200\u00a0N", 1200.0, "N"),
        ("1,200.5", 1200.5, ""),
        ("1.200,5", 1200.5, ""),
        ("1,200", 1.2, ""),
        ("82 об/мин", 82.0, "об/мин"),
        ("8,6 1/s", 8.6, "1/s"),
        ("34°", 34.0, "°"),
        ("5 мм.", 5.0, "мм"),
        ("II", 2.0, ""),
        ("ІІ", 2.0, ""),  # Cyrillic
        ("iv", 4.0, ""),
    ],
)
def test_a_number_is_read_in_every_spelling(text, number, unit):
    assert read(text) == (number, 0.0, "number", unit, "")


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("(1.2; -3.4) N", (1.2, -3.4, "components", "N", "")),
        ("[1,2; −3,4]", (1.2, -3.4, "components", "", "")),
        ("(1,2, -3,4) кН", (1.2, -3.4, "components", "кН", "")),
        ("(1,2 -3,4)", (1.2, -3.4, "components", "", "")),
        ("(1,2)", (1.0, 2.0, "components", "", "")),
        ("1.2 N; -3.4 N", (1.2, -3.4, "components", "N", "")),
        ("Fx=1.2, Fy=-3.4 N", (1.2, -3.4, "components", "N", "")),
        ("y = 1,2 x = 3,4", (3.4, 1.2, "components", "", "")),
        ("1.2 kN at 34 deg", (1.2, 34.0, "polar", "kN", "deg")),
        ("1200 N, 34°", (1200.0, 34.0, "polar", "N", "°")),
        ("1200 N ∠ -34", (1200.0, -34.0, "polar", "N", "")),
        ("1200 Н под углом -34°", (1200.0, -34.0, "polar", "Н", "°")),
        ("1200; 0.6 rad", (1200.0, 0.6, "polar", "", "rad")),
        ("R = 5 N, phi = 34", (5.0, 34.0, "polar", "N", "")),
    ],
)
def test_a_vector_is_read_by_its_components_or_by_size_and_direction(text, found):
    assert read(text) == found


@pytest.mark.parametrize("text", ["", "  ", "-", "–", "—", "--"])
def test_an_empty_cell_and_a_dash_are_no_answer(text):
    assert read_answer(text) is None


def test_a_unit_of_the_sheet_counts_where_the_cell_has_none():
    assert read_answer("1.2", "N", "deg") == ReadAnswer(1.2, unit="N", text="1.2")
    assert read_answer("1.2 kN", "N").unit == "kN"
    assert read_answer("1.2 at 3", "N", "rad") == ReadAnswer(1.2, 3.0, "polar", "N", "rad", "1.2 at 3")


ONE = "not a number\n  found:   '{}'\n  allowed: 1,31 m/s, 1.31 or 3·10^-3"
TWO = "a vector must be given by two numbers\n  found:   '{}'\n  allowed: (1,2; -3,4) N or 1,2 kN at 34 deg"
LARGE = "the number is too large or too small\n  found:   '{}'"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("nan", ("the number must be finite\n  found:   '{}'")),
        ("-Infinity", ("the number must be finite\n  found:   '{}'")),
        ("1e400", LARGE + ("\n  allowed: absolute values from 1e-300 to 1e300")),
        ("1e-400", LARGE + ("\n  allowed: absolute values from 1e-300 to 1e300")),
        ("1e999999999999", LARGE),
        ("True", ONE),
        ("=1+1", ONE),
        ("__import__('os')", ONE),
        ("1/3", ONE),
        ("1.2.3", ONE),
        ("1_000", ONE),
        ("--5", ONE),
        (
            "2026-05-01",
            (
                "the spreadsheet has turned this number into a date\n"
                "  found:   '{}'\n"
                "  allowed: a number in a cell formatted as text"
            ),
        ),
        ("(5)", TWO),
        ("1 N; 2 N; 3 N", TWO),
        ("1 N; 2 kN", ("the components have different units\n  found:   '{}'\n  allowed: (1,2; -3,4) N")),
        ("Fz = 1, Fy = 2", "these are not the components x and y\n  found:   '{}'\n  allowed: Fx = 1,2 N, Fy = -3,4 N"),
    ],
)
def test_what_is_no_answer_is_refused(text, message):
    with pytest.raises(ProblemError) as caught:
        read_answer(text)
    assert str(caught.value) == message.format(text)


def test_what_is_too_long_is_refused_unread():
    with pytest.raises(ProblemError, match="this expression is too long"):
        read_answer("1" * 201)


HEADINGS = Headings(["v of E", "v of E2", "x of E", "R_34", "R_10,11", "R_34 in B", "v of 2 on 3", "H"])


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("v of E at 7, m/s", Heading("v of E", 7, unit="m/s")),
        ("v of E at 7 [m/s]", Heading("v of E", 7, unit="m/s")),
        ("v of E2 at 7", Heading("v of E2", 7)),
        ("v  of Е at 7,м/с", Heading("v of E", 7, unit="м/с")),  # a Cyrillic E
        ("x of E at 0", Heading("x of E", 0)),
        ("v of 2 on 3 at 7.0", Heading("v of 2 on 3", 7)),
        ("R_34 at 7, angle, deg", Heading("R_34", 7, part="angle", unit="deg")),
        ("R_34 x at 7", Heading("R_34", 7, part="x")),
        ("R_34 in B at 7, y, N", Heading("R_34 in B", 7, part="y", unit="N")),
        ("R_10,11 at 7, N", Heading("R_10,11", 7, unit="N")),
        ("H, mm", Heading("H", unit="mm")),
    ],
)
def test_a_heading_names_quantity_position_part_and_unit(text, found):
    assert HEADINGS.read(text) == found


@pytest.mark.parametrize("text", ["v of E at phi = 90 deg, m/s", "v of E at φ=90°, m/s", "v of E at 90 град [m/s]"])
def test_a_position_may_be_named_by_the_angle_of_the_driver(text):
    found = HEADINGS.read(text)
    assert (found.position, found.angle, found.unit) == (None, pytest.approx(1.5707963267948966), "m/s")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v of e at 7, m/s", ("there is no quantity with this name\n  found:   'v of e'")),
        ("v of E at seven", ("this column heading is not recognised\n  found:   '{}'\n  allowed: v of E at 7, m/s")),
        (
            "v of E at 7.5",
            "expected a position number or an angle of the driver\n  found:   '7.5'\n  allowed: 7, or phi = 210 deg",
        ),
        ("v of E at 7, foo", "unknown unit\n  found:   'foo'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m"),
    ],
)
def test_a_heading_that_is_none_is_refused(text, message):
    with pytest.raises(ProblemError) as caught:
        HEADINGS.read(text)
    assert str(caught.value) == message.format(text)
