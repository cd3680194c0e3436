"""Arithmetic on parameters: what a bare number means, what is refused, and that nothing runs away."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, strategies as st

from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_SPEED,
    DIMENSIONS,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    PRESSURE,
    SPEED,
    TIME,
    Dimension,
)
from tmm_cli.problem import PhysicalValue, ProblemError, UnitSystem, evaluate, evaluate_quantity, resolve_parameters

UNITS = UnitSystem()
GIVEN = {
    "OA": PhysicalValue(110.0),  # bare: in the file's unit
    "CD": PhysicalValue(0.65, LENGTH),
    "n1": PhysicalValue(8.0, ANGULAR_SPEED),
    "m": PhysicalValue(22.0, MASS),
    "s": PhysicalValue(2.0, TIME),
    "m2": PhysicalValue(5.0, MASS),
    "phi": PhysicalValue(30.0),
    "длина": PhysicalValue(0.4, LENGTH),
}


@pytest.mark.parametrize(
    ("source", "want", "value"),
    [
        (110, LENGTH, 0.11),
        ("110", LENGTH, 0.11),
        ("OA", LENGTH, 0.11),
        ("2*OA/4", LENGTH, 0.055),
        (5, ANGLE, math.radians(5)),
        ("OA + CD", LENGTH, 0.76),
        ("CD - 50", LENGTH, 0.6),
        ("OA + 5 мм", LENGTH, 0.115),
        ("длина/2", LENGTH, 0.2),
        ("82 rpm", ANGULAR_SPEED, 82 * math.pi / 30),
        ("82 об/мин", ANGULAR_SPEED, 82 * math.pi / 30),
        ("82 1/min", ANGULAR_SPEED, 82 * math.pi / 30),
        ("5 с⁻¹", ANGULAR_SPEED, 5),
        ("30°", ANGLE, math.pi / 6),
        ("1.5 kN", FORCE, 1500),
        ("5 N*m", MOMENT, 5),
        ("5 kN mm", MOMENT, 5),
        ("50 %", NUMBER, 0.5),
        ("50 % * CD", LENGTH, 0.325),
        ("CD*n1", SPEED, 5.2),
        ("m * 9.81 m/s^2", FORCE, 215.82),
        ("sqrt(CD^2)", LENGTH, 0.65),
        ("abs(-CD)", LENGTH, 0.65),
        ("sin(phi)*CD", LENGTH, 0.325),
        ("cos(60)", NUMBER, 0.5),
        ("sin(pi/6)", NUMBER, 0.5),
        ("asin(OA/220)", ANGLE, math.pi / 6),
        ("atan2(CD, CD)", ANGLE, math.pi / 4),
        ("hypot(3, 4)", LENGTH, 0.005),
        ("pi/2", ANGLE, math.pi / 2),
        ("pi", NUMBER, math.pi),
        ("pi*OA", LENGTH, 0.11 * math.pi),
        ("pi*CD + 5 mm", LENGTH, 0.65 * math.pi + 0.005),
        ("2*pi*82/60", ANGULAR_SPEED, 82 * math.pi / 30),
        ("-2^2", NUMBER, -4),
        ("2^3^2", NUMBER, 512),
        ("2**-1", NUMBER, 0.5),
        ("--3", NUMBER, 3),
        ("1 - 2 - 3", NUMBER, -4),
        ("8/4/2", NUMBER, 1),
        ("−5 mm", LENGTH, -0.005),
        ("3×4 mm", LENGTH, 0.012),
        (" ( 1 + 2 ) * 3 ", NUMBER, 9),
        ("1.5e3 mm", LENGTH, 1.5),
        (".5", NUMBER, 0.5),
        ("100 mm -50", LENGTH, 0.05),
        ("max(1,5)", NUMBER, 5),
        ("max(OA, CD, 5 mm)", LENGTH, 0.65),
        ("min(1, CD, 3)", LENGTH, 0.001),
        ("min(CD, 1, 3)", LENGTH, 0.001),
        ("max(1, 2, 3 mm)", LENGTH, 0.003),
        ("5 m*s", Dimension(length=1, time=1), 5),  # written together it is a unit,
        ("5 m * s", Dimension(length=1, time=1), 10),  # set apart a parameter
        ("1.9·10³ Н", FORCE, 1900),
        ("1.9*10^3", NUMBER, 1900),
        ("2.1×10⁵ МПа", PRESSURE, 2.1e11),
        ("5/2·10^3 N", FORCE, 2500),  # the unit is that of the power, and what stands before divides and multiplies it
        ("8·10⁻³ кг·м²", INERTIA, 0.008),
        ("2·OA", LENGTH, 0.22),
        ("-10^3 N", FORCE, -1000),
        ("1 900 N", FORCE, 1900),
        ("12\u2009500.5 мм", LENGTH, 12.5005),
        ("1\u202f234\xa0567", NUMBER, 1234567),
        ("8 с-1", ANGULAR_SPEED, 8),
        ("82 мин-1", ANGULAR_SPEED, 82 * math.pi / 30),
        ("2 m·s-2", ACCELERATION, 2),
        ("10 mm-1", LENGTH, 0.009),  # of other units it is a difference
        ("5 кгс", FORCE, 5 * 9.80665),
        ("2 тс", FORCE, 2 * 9806.65),
        ("6 кгс/см²", PRESSURE, 6 * 98066.5),
        ("1.5 кгс·м", MOMENT, 1.5 * 9.80665),
        ("0.2 кгс·м·с²", INERTIA, 0.2 * 9.80665),
    ],
)
def test_values(source: str | float, want: Dimension, value: float) -> None:
    assert evaluate(source, GIVEN, UNITS, want) == pytest.approx(value, rel=1e-14)


ARITHMETIC = "\n  allowed: numbers, units, parameters and the signs + - * / ^ ( )"
COMMA = "\n  allowed: a decimal point; a list is written [1, 5]"
NAMES = "\n  allowed: OA, CD, n1, m, s, m2, phi, длина"
UNIT_NAMES = "\n  allowed: e.g. mm, deg, rpm, kg, N, N*m"
LENGTHS = "\n  allowed: a length, e.g. 110 mm or 0.11 m"
ANGLES = "\n  allowed: an angle, e.g. 30 deg or 0.5 rad"


@pytest.mark.parametrize(
    ("source", "want", "message"),
    [
        ("110 mm", ANGLE, "expected here: an angle\n  found:   '110 mm', a length (110 mm)" + ANGLES),
        ("CD/длина", ANGLE, "expected here: an angle\n  found:   'CD/длина', a number (1.625)" + ANGLES),
        ("1/2 mm", LENGTH, "expected here: a length\n  found:   '1/2 mm', a quantity in m^-1 (0.5 mm^-1)" + LENGTHS),
        ("pi*m", LENGTH, "expected here: a length\n  found:   'pi*m', a quantity in kg*rad (3960 kg*deg)" + LENGTHS),
        (
            "CD + n1",
            LENGTH,
            "a length and an angular speed cannot be added or compared\n  found:   'CD + n1'" + ARITHMETIC,
        ),
        (
            "CD/CD + 5 mm",
            LENGTH,
            "a number and a length cannot be added or compared\n  found:   'CD/CD + 5 mm'" + ARITHMETIC,
        ),
        (
            "min(CD, n1)",
            LENGTH,
            "a length and an angular speed cannot be added or compared\n  found:   'min(CD, n1)'" + ARITHMETIC,
        ),
        ("sin(CD)", NUMBER, "the argument of sin must be an angle; found: a length\n  found:   'sin(CD)'" + ARITHMETIC),
        (
            "asin(CD)",
            ANGLE,
            "the argument of asin must be a number without a unit; found: a length\n  found:   'asin(CD)'" + ARITHMETIC,
        ),
        ("asin(1.2)", ANGLE, "asin of 1.2 is undefined\n  found:   'asin(1.2)'" + ARITHMETIC),
        ("sqrt(-4)", NUMBER, "sqrt of -4 is undefined\n  found:   'sqrt(-4)'" + ARITHMETIC),
        (
            "sqrt(CD)",
            LENGTH,
            "no square root can be taken of this quantity: a length\n  found:   'sqrt(CD)'" + ARITHMETIC,
        ),
        ("tan(90)", NUMBER, ("the tangent of a right angle is undefined\n  found:   'tan(90)'") + ARITHMETIC),
        (
            "cos(1e19)",
            NUMBER,
            "the angle is too large: because of rounding, no digit of cos would be correct\n  found:   'cos(1e19)'"
            + ARITHMETIC,
        ),
        ("1/(OA - 110)", NUMBER, "division by zero\n  found:   '1/(OA - 110)'" + ARITHMETIC),
        ("(-8)^(1/3)", NUMBER, "this power is undefined\n  found:   '(-8)^(1/3)'" + ARITHMETIC),
        ("0^-1", NUMBER, "this power is undefined\n  found:   '0^-1'" + ARITHMETIC),
        ("9^9^9", NUMBER, ("an exponent must be a number without a unit, at most 20\n  found:   '9^9^9'") + ARITHMETIC),
        ("1e300*1e300", NUMBER, "this number is too large\n  found:   '1e300*1e300'"),
        (
            "1e999",
            NUMBER,
            (
                "the number is too large or too small\n"
                "  found:   '1e999'\n"
                "  allowed: absolute values from 1e-300 to 1e300"
            ),
        ),
        ("1,5", LENGTH, "decimal comma: write 1.5\n  found:   '1,5'" + COMMA),
        (
            "OA + 1,5 mm",
            LENGTH,
            "decimal comma: write 1.5 mm\n  found:   '1,5 mm'\n  allowed: a decimal point; a list is written [1, 5 mm]",
        ),
        ("(1,5 + 2)", LENGTH, "decimal comma: write 1.5\n  found:   '1,5'" + COMMA),
        ("OAA", LENGTH, "there is no such parameter\n  found:   'OAA'" + NAMES + "\n  did you mean 'OA'?"),
        (
            "ОА",
            LENGTH,
            "there is no such parameter\n  found:   'ОА'" + NAMES + "\n  did you mean 'OA' in Latin letters?",
        ),
        ("5 rmp", ANGULAR_SPEED, "unknown unit\n  found:   'rmp'" + UNIT_NAMES + "\n  did you mean 'rpm'?"),
        (
            "mm",
            LENGTH,
            "there is no parameter mm; if the unit is meant, write 1 mm\n  found:   'mm'"
            + NAMES
            + "\n  did you mean 'm'?",
        ),
        ("0.05*H", LENGTH, "there is no parameter H; if the unit is meant, write 1 H\n  found:   'H'" + NAMES),
        (
            "1 900,5 mm",
            LENGTH,
            "decimal comma: write 1 900.5 mm\n  found:   '1 900,5 mm'"
            "\n  allowed: a decimal point; a list is written [1 900, 5 mm]",
        ),
        (
            "1 90",
            LENGTH,
            ("this is not a valid arithmetic expression\n  found:   '1 90', the error is at '90'") + ARITHMETIC,
        ),
        ("CD/OA", NUMBER, "parameter OA has no unit: write OA: 110 mm\n  found:   'CD/OA'"),
        ("asin(OA/CD)", ANGLE, "parameter OA has no unit: write OA: 110 mm\n  found:   'asin(OA/CD)'"),
        ("CD*phi", SPEED, "parameter phi has no unit: write phi: 30 rpm or 30 rad/s\n  found:   'CD*phi'"),
        (
            "500 кг",
            FORCE,
            (
                "expected here: a force\n"
                "  found:   '500 кг', a mass (500 kg)\n"
                "  allowed: a force, e.g. 1500 N or 1.5 kN; the unit kilogram-force is written kgf"
            ),
        ),
        (
            "6 кг/см²",
            PRESSURE,
            (
                "expected here: a pressure\n"
                "  found:   '6 кг/см²', a quantity in m^-2*kg (0.06 mm^-2*kg)\n"
                "  allowed: a pressure, e.g. 1.2 MPa or 12 bar; the unit kilogram-force is written kgf"
            ),
        ),
        (
            "CD/phi",
            MASS,
            "expected here: a mass\n  found:   'CD/phi', a length (21.6667 mm)\n  allowed: a mass, e.g. 22 kg",
        ),
        ("2 OA", LENGTH, "a * is missing before OA\n  found:   '2 OA', the error is at 'OA'" + ARITHMETIC),
        ("2m2", MASS, "a * is missing before m2\n  found:   '2m2', the error is at 'm2'" + ARITHMETIC),
        ("1 +", LENGTH, "a number is missing\n  found:   '1 +'" + ARITHMETIC),
        ("(1", LENGTH, "a bracket is not closed\n  found:   '(1'" + ARITHMETIC),
        (
            "1 2",
            LENGTH,
            ("this is not a valid arithmetic expression\n  found:   '1 2', the error is at '2'") + ARITHMETIC,
        ),
        (
            "OA.real",
            LENGTH,
            ("this is not a valid arithmetic expression\n  found:   'OA.real', the error is at '.real'") + ARITHMETIC,
        ),
        (
            "sin 30",
            NUMBER,
            ("the argument of the function sin must be in brackets\n  found:   'sin 30', the error is at '30'")
            + ARITHMETIC,
        ),
        ("atan2(1)", ANGLE, "the function atan2 has the wrong number of arguments\n  found:   'atan2(1)'" + ARITHMETIC),
        ("__import__('os')", LENGTH, "there is no such parameter\n  found:   '__import__'" + NAMES),
        (
            True,
            LENGTH,
            (
                "a number is expected here\n"
                "  found:   true\n"
                "  allowed: a number, a number with a unit, or an arithmetic expression"
            ),
        ),
        (
            None,
            LENGTH,
            (
                "a number is expected here\n"
                "  found:   nothing (null)\n"
                "  allowed: a number, a number with a unit, or an arithmetic expression"
            ),
        ),
        (
            [1, 5],
            LENGTH,
            (
                "a number is expected here\n"
                "  found:   [1, 5]\n"
                "  allowed: a number, a number with a unit, or an arithmetic expression"
            ),
        ),
        (math.nan, LENGTH, ("the number must lie between -1e300 and 1e300\n  found:   nan")),
    ],
)
def test_refusals(source: object, want: Dimension, message: str) -> None:
    with pytest.raises(ProblemError) as caught:
        evaluate(source, GIVEN, UNITS, want)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("(" * 200, "too many nested brackets"),
        ("2" + "^2" * 99, "too many nested brackets"),
        ("sqrt(" * 40, "too many nested brackets"),
        ("1" * 201, "too long"),
        ("1" + " mm" * 60, "this is not a valid unit"),
        ("1" + "*m" * 99, "expected here"),
        (10**400, "1e300"),
    ],
)
def test_nothing_runs_away(source: object, words: str) -> None:
    with pytest.raises(ProblemError, match=words):
        evaluate(source, GIVEN, UNITS, LENGTH)


@given(
    st.text(max_size=40) | st.text("OACDpisnm21.,5+-*/^() ²", max_size=30), st.sampled_from(list(DIMENSIONS.values()))
)
def test_any_text_gives_a_finite_number_or_a_refusal(source: str, kind: object) -> None:
    try:
        value = evaluate(source, GIVEN, UNITS, kind.dimension)  # type: ignore[attr-defined]
    except ProblemError as error:
        assert error.path == ()
    else:
        assert math.isfinite(value)


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.floats(0.1, 1e6))
def test_arithmetic_is_that_of_python(a: float, b: float, c: float) -> None:
    assert evaluate(f"({a!r}) - ({b!r}) * 2 / {c!r}", {}, UNITS, NUMBER) == a - b * 2 / c


@given(st.lists(st.sampled_from(["1", "CD", "3", "2 mm", "1 m"]), min_size=1, max_size=5))
def test_min_and_max_mix_bare_numbers_with_lengths(words: list[str]) -> None:
    lengths = [{"1": 0.001, "CD": 0.65, "3": 0.003, "2 mm": 0.002, "1 m": 1.0}[word] for word in words]
    assert evaluate(f"min({', '.join(words)})", GIVEN, UNITS, LENGTH) == min(lengths)
    assert evaluate(f"max({', '.join(words)})", GIVEN, UNITS, LENGTH) == max(lengths)


def test_parameters_in_any_order() -> None:
    found = resolve_parameters({"AB": "2*OA + 5 mm", "OA": "r", "r": 110, "n1": "82 rpm"}, UNITS)
    assert list(found) == ["AB", "OA", "r", "n1"]
    assert (found["r"], found["OA"]) == (PhysicalValue(110.0), PhysicalValue(110.0))
    assert found["AB"].value == pytest.approx(0.225)
    assert found["n1"].dimension == ANGULAR_SPEED


def test_a_unit_is_not_a_parameter_of_the_same_name() -> None:
    found = resolve_parameters({"L": "5 m", "m": "20*L", "s": "3 s", "mm": "2 mm"}, UNITS)
    assert [found[name].value for name in ("L", "m", "s", "mm")] == [5, 100, 3, 0.002]


def test_long_chains_of_parameters() -> None:
    raw: dict[str, object] = {f"a{i}": f"a{i + 1} + 1" for i in range(2000)}
    assert resolve_parameters({**raw, "a2000": 0}, UNITS)["a0"] == PhysicalValue(2000.0)


@pytest.mark.parametrize(
    ("raw", "message"),
    [
        (
            {"x": 1, "a": "b", "b": "c*2", "c": "a"},
            ("a: these parameters depend on each other in a circle\n  found:   a -> b -> c -> a"),
        ),
        ({"a": "a + 1"}, ("a: these parameters depend on each other in a circle\n  found:   a -> a")),
        ({"OA": 1, "b": "2*0A"}, "b: unknown unit\n  found:   'A'" + UNIT_NAMES),
        ({"b": "1/0"}, "b: division by zero\n  found:   '1/0'" + ARITHMETIC),
        (
            {"sin": 1},
            ("sin: this is the name of a function or constant in expressions; choose another name\n  found:   'sin'"),
        ),
        (
            {"1a": 1},
            (
                "1a: invalid name of a parameter\n"
                "  found:   '1a'\n"
                "  allowed: letters, digits and _, beginning with a letter"
            ),
        ),
        (
            {"BC": 220, "OA": "110 mm", "a": "asin(OA/BC)"},
            "a: parameter BC has no unit: write BC: 220 mm\n  found:   'asin(OA/BC)'",
        ),
        (
            {"a": False},
            (
                "a: a number is expected here\n"
                "  found:   false\n"
                "  allowed: a number, a number with a unit, or an arithmetic expression"
            ),
        ),
    ],
)
def test_parameters_refused(raw: dict[str, object], message: str) -> None:
    with pytest.raises(ProblemError) as caught:
        resolve_parameters(raw, UNITS)
    assert str(caught.value) == message


def test_quantities_keep_their_dimension() -> None:
    assert evaluate_quantity("CD/длина", GIVEN, UNITS).dimension == NUMBER
    assert evaluate_quantity("2*3", {}, UNITS) == PhysicalValue(6.0)
    assert evaluate_quantity("atan2(1, 1)", {}, UNITS).dimension == ANGLE
