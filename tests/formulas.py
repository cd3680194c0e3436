"""Reads formulas of a note back from its HTML, as a reader with a calculator does: numbers put in give the result."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass

NAMED = {
    "cos": math.cos,
    "sin": math.sin,
    "tan": math.tan,
    "arccos": math.acos,
    "arcsin": math.asin,
    "arctan": math.atan,
}
LETTERS = ("mi", "msub", "msubsup", "mover", "munder")  # what begins a quantity by its letter


@dataclass(frozen=True)
class Formula:
    """letters = numbers = result unit; texts: the figures of the result as they are printed."""

    source: str
    values: tuple[float, ...]  # of the sides with numbers but the last, in the unit of the result
    result: str

    @property
    def last_digit(self) -> float:
        mantissa, _, power = self.result.partition("e")
        return 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))

    @property
    def true(self) -> bool:
        """Whether every side with numbers gives the printed result within its last digit."""
        slack = 1e-9 * abs(float(self.result))
        return all(abs(value - float(self.result)) <= self.last_digit + slack for value in self.values)


def maths(html: str) -> list[str]:
    """Every formula on a line of its own, as it stands in the page."""
    return re.findall(r'<math display="block">.*?</math>', html, re.S)


def formulas(html: str) -> list[Formula]:
    """Those with numbers put in."""
    read = [formula(one) for one in maths(html)]
    return [one for one in read if one is not None]


def formula(source: str) -> Formula | None:
    """None where a formula has letters only, or is a result alone."""
    sides = [list(side) for side in split(tokens(ET.fromstring(source)))]
    numeric = [side for side in sides if side and not has_letters(side)]
    if len(sides) < 2 or len(numeric) < 2:
        return None
    text, unit = result(numeric[-1])
    values = tuple(Reader(side).whole() for side in numeric[:-1])
    return Formula(source, tuple(math.degrees(v) if unit == "°" else v for v in values), text)


def tokens(element: ET.Element) -> Iterator[ET.Element]:
    """Parts one after another: rows and lines of a broken formula are none of their own."""
    for child in element:
        if child.tag in ("mrow", "mtable", "mtr", "mtd", "mstyle"):
            yield from tokens(child)
        else:
            yield child


def split(parts: Iterator[ET.Element]) -> Iterator[list[ET.Element]]:
    """Sides between the signs of equality."""
    side: list[ET.Element] = []
    for part in parts:
        if part.tag == "mo" and part.text == "=":
            yield side
            side = []
        else:
            side.append(part)
    yield side


def has_letters(side: list[ET.Element]) -> bool:
    return any(one.tag in LETTERS and "".join(one.itertext()) != "π" for part in side for one in part.iter())


def result(side: list[ET.Element]) -> tuple[str, str]:
    """Figures as Python writes them, and the unit."""
    text, unit = "", ""
    for part in side:
        if part.tag == "mtext":
            unit = (part.text or "").replace("\xa0", " ").strip()
        elif part.tag == "msup":
            base, exponent = part
            assert "".join(base.itertext()) == "10"
            text += "e" + figures("".join(exponent.itertext()))
        elif not (part.tag == "mo" and part.text == "·"):
            text += figures(part.text or "")
    return text, unit


def figures(text: str) -> str:
    return text.replace("−", "-").replace(",", ".")


class Reader:
    """A side with numbers: + − · fractions, powers, roots, brackets, functions; angles in degrees have their sign."""

    def __init__(self, parts: list[ET.Element]) -> None:
        self.parts, self.at = parts, 0

    def whole(self) -> float:
        value = self.sum()
        assert self.at == len(self.parts), "".join("".join(part.itertext()) for part in self.parts)
        return value

    def next(self) -> str:
        """What stands next, if it is a sign."""
        if self.at < len(self.parts) and self.parts[self.at].tag in ("mo", "mtext"):
            return (self.parts[self.at].text or "").strip()
        return ""

    def take(self, *signs: str) -> str:
        found = self.next()
        if found not in signs or not found:
            return ""
        self.at += 1
        return found

    def sum(self) -> float:
        sign = self.take("+", "−")
        value = -self.product() if sign == "−" else self.product()
        while sign := self.take("+", "−"):
            value += self.product() if sign == "+" else -self.product()
        return value

    def product(self) -> float:
        value = self.factor()
        while self.take("·"):
            value *= self.factor()
        return value

    def factor(self) -> float:
        name = self.take(*NAMED)
        if name:
            return NAMED[name](self.factor())
        value = self.single()
        return math.radians(value) if self.take("°") else value

    def single(self) -> float:
        for opening, closing in (("(", ")"), ("|", "|")):
            if self.take(opening):
                value = self.sum()
                assert self.take(closing)
                return abs(value) if opening == "|" else value
        part = self.parts[self.at]
        self.at += 1
        if part.tag in ("mn", "mi"):
            text = part.text or ""
            if text == "π":
                return math.pi
            return math.radians(float(figures(text[:-1]))) if text.endswith("°") else float(figures(text))
        inner = [Reader(list(tokens(wrapped(child)))) for child in part]
        match part.tag:
            case "mfrac":
                return inner[0].whole() / inner[1].whole()
            case "msup":
                return inner[0].whole() ** inner[1].whole()
            case "msqrt":
                return math.sqrt(Reader(list(tokens(part))).whole())
        raise AssertionError(ET.tostring(part, encoding="unicode"))


def wrapped(child: ET.Element) -> ET.Element:
    row = ET.Element("mrow")
    row.append(child)
    return row
