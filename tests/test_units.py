"""Units in two alphabets, exact factors, and what bare numbers mean."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, strategies as st

from tmm_cli.language import spoken
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    DIMENSIONS,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    SPEED,
    TIME,
    Dimension,
)
from tmm_cli.problem import SYMBOLS, PhysicalValue, ProblemError, UnitError, UnitSystem, parse_unit


@pytest.mark.parametrize(
    ("texts", "kind", "factor"),
    [
        ("m м", "length", 1),
        ("mm мм", "length", 0.001),
        ("cm см", "length", 0.01),
        ("in", "length", 0.0254),
        ("um μm µm мкм", "length", 1e-6),
        ("rad рад", "angle", 1),
        ("deg ° град º", "angle", math.pi / 180),
        ("rev turn turns об", "angle", math.tau),
        ("s с c сек", "time", 1),
        ("min мин", "time", 60),
        ("kg кг", "mass", 1),
        ("g г", "mass", 0.001),
        ("t т", "mass", 1000),
        ("N Н H", "force", 1),
        ("kN кН кH", "force", 1000),
        ("N*m N·m N⋅m Nm Н·м Нм N|m", "moment of force", 1),
        ("kN*m кН·м кНм", "moment of force", 1000),
        ("kgf кгс", "force", 9.80665),
        ("tf тс", "force", 9806.65),
        ("kgf/cm2 кгс/см²", "pressure", 98066.5),
        ("рад·с-1 rad·s-1", "angular speed", 1),
        ("мин-1", "angular speed", math.pi / 30),
        ("м·с-2", "acceleration", 1),
        ("kg*m2 kg·m^2 kg*m**2 kg|m² кг·м² кг*м2", "moment of inertia", 1),
        ("m/s м/с m*s^-1 м·с⁻¹", "speed", 1),
        ("m/s^2 м/с² m/s2", "acceleration", 1),
        ("rad/s рад/с рад/c", "angular speed", 1),
        ("rpm об/мин rev/min min^-1 мин⁻¹ 1/min 1/мин", "angular speed", math.pi / 30),
        ("Hz Гц rev/s", "angular speed", math.tau),
        ("rad/s^2 рад/с²", "angular acceleration", 1),
        ("N/mm Н/мм", "stiffness", 1000),
        ("%", "number", 0.01),
    ],
)
def test_units_as_people_write_them(texts: str, kind: str, factor: float) -> None:
    for text in texts.split():
        unit = parse_unit(text.replace("|", " "))
        assert unit.dimension.name == kind, text
        assert unit.si(1.0) == pytest.approx(factor, rel=1e-15), text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rmp", "unknown unit\n  found:   'rmp'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m\n  did you mean 'rpm'?"),
        ("MM", "unknown unit\n  found:   'MM'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m\n  did you mean 'mm'?"),
        ("furlong", "unknown unit\n  found:   'furlong'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m"),
        ("", "a unit is missing\n  found:   ''\n  allowed: e.g. mm, deg, rpm, kN"),
        ("/m", ("this is not a valid unit\n  found:   '/m'\n  allowed: e.g. mm, deg, rpm, kN, N*m, kg*m^2, m/s^2")),
        ("m/", ("this is not a valid unit\n  found:   'm/'\n  allowed: e.g. mm, deg, rpm, kN, N*m, kg*m^2, m/s^2")),
        (
            "m^99999999999",
            ("this is not a valid unit: the power is too large\n  found:   'm^99999999999'\n  allowed: powers up to 4"),
        ),
    ],
)
def test_unknown_units(text: str, message: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_unit(text)
    assert str(caught.value) == message


@given(st.integers(-(10**6), 10**6))
def test_millimetres_are_exact(number: int) -> None:
    assert UnitSystem().si(number, LENGTH) == number / 1000
    assert parse_unit("deg").si(number) == number * math.pi / 180


@given(st.floats(-1e12, 1e12), st.sampled_from(sorted(SYMBOLS)))
def test_round_trip(number: float, name: str) -> None:
    unit = parse_unit(name)
    assert unit.from_si(unit.si(number)) == pytest.approx(number, rel=1e-15, abs=1e-300)


@given(st.sampled_from(sorted(SYMBOLS)), st.sampled_from(sorted(SYMBOLS)), st.sampled_from("*·/"))
def test_products_of_any_two(a: str, b: str, sign: str) -> None:
    first, second = parse_unit(a), parse_unit(b)
    found = parse_unit(f"{a}{sign}{b}")
    power = -1 if sign == "/" else 1
    assert found.dimension == first.dimension.times(second.dimension, power)
    assert found.si(1.0) == pytest.approx(first.si(1.0) * second.si(1.0) ** power, rel=1e-14)


def test_every_kind_has_its_article_and_an_example() -> None:
    for kind in DIMENSIONS.values():
        assert str(kind.dimension).startswith(("a ", "an ")) and kind.example in kind.dimension.example


def test_defaults_of_bare_numbers() -> None:
    units = UnitSystem()
    symbols = [
        "",
        "mm",
        "deg",
        "s",
        "kg",
        "N",
        "N*m",
        "kg*m^2",
        "m/s",
        "m/s^2",
        "rad/s",
        "rad/s^2",
        "m/s^3",
        "rad/s^3",
        "N/m",
        "N*m/rad",
        "N*s/m",
        "N*m*s/rad",
        "N*s^2/m^2",
        "N*m*s^2/rad^2",
        "MPa",
        "kg/m^3",
    ]
    assert [units.symbol(kind.dimension) for kind in DIMENSIONS.values()] == symbols
    assert units.factor(LENGTH) == 0.001
    assert units.factor(NUMBER) == 1


def test_every_unit_is_told_in_latin_letters_whatever_those_of_the_file() -> None:
    for kind, written, told in [
        ("length", "мкм", "um"),
        ("angle", "°", "deg"),
        ("moment of force", "кН·м", "kN·m"),
        ("moment of inertia", "кг·м²", "kg·m²"),
        ("angular speed", "мин⁻¹", "min⁻¹"),
    ]:
        assert UnitSystem({kind: written}).symbol(DIMENSIONS[kind].dimension) == told
        assert parse_unit(told) == parse_unit(written)
    with spoken("sr"):
        assert UnitSystem({"length": "мм"}).spelt(LENGTH) == "mm"


def test_a_file_chooses() -> None:
    units = UnitSystem({"length": "м", "angular_speed": "об/мин", "moment": "kN*m", "inertia": "kg*cm^2"})
    assert units.si(2, LENGTH) == 2
    assert units.si(30, ANGULAR_SPEED) == pytest.approx(math.pi)
    assert units.from_si(math.pi, ANGULAR_SPEED) == pytest.approx(30)
    assert (units.si(1, MOMENT), units.si(1, INERTIA)) == (1000, 1e-4)
    assert (units.symbol(ANGULAR_SPEED), units.symbol(Dimension(length=2))) == ("rev/min", "m^2")
    assert UnitSystem().si(1, Dimension(length=2)) == 1e-6


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (
            {"length": "deg"},
            (
                "length: this is a unit of another quantity\n"
                "  found:   'deg', an angle\n"
                "  allowed: a unit for this quantity: length, e.g. mm"
            ),
        ),
        (
            {"angle": "dge"},
            "angle: unknown unit\n  found:   'dge'\n  allowed: e.g. mm, deg, rpm, kg, N, N*m\n  did you mean 'deg'?",
        ),
        (
            {"lenght": "mm"},
            "lenght: unknown key\n  found:   'lenght'"
            "\n  allowed: length, angle, time, mass, force, moment, "
            "inertia, speed, acceleration, angular speed, angular acceleration, jerk, angular jerk, stiffness, "
            "torsional stiffness, damping, torsional damping, quadratic damping, torsional quadratic damping, "
            "pressure, density"
            "\n  did you mean 'length'?",
        ),
    ],
)
def test_a_file_chooses_wrongly(names: dict[str, str], message: str) -> None:
    with pytest.raises(ProblemError) as caught:
        UnitSystem(names)
    assert str(caught.value) == message


def test_radians_come_and_go_but_an_angle_is_not_a_number() -> None:
    per_second = parse_unit("1/s").dimension
    assert per_second.fits(ANGULAR_SPEED)
    assert parse_unit("1/s^2").dimension.fits(ANGULAR_ACCELERATION)
    assert ANGULAR_SPEED.times(LENGTH).fits(SPEED)
    assert not NUMBER.fits(ANGLE)
    assert not ANGLE.fits(NUMBER)
    assert not LENGTH.fits(ANGLE)
    assert not MASS.fits(FORCE)


def test_words() -> None:
    units = UnitSystem()
    assert units.describe(PhysicalValue(0.11, LENGTH)) == "a length (110 mm)"
    assert units.describe(PhysicalValue(0.5, NUMBER)) == "a number (0.5)"
    assert units.describe(PhysicalValue(5)) == "a number without a unit (5)"
    assert units.describe(PhysicalValue(1, TIME.power(2))) == "a quantity in s^2 (1 s^2)"
    assert ANGLE.example == "an angle, e.g. 30 deg or 0.5 rad"
