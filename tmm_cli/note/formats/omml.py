"""Formulas as OMML, Word's own: they are edited there as formulas."""

from __future__ import annotations

from html import escape

from docx.oxml.ns import nsdecls

from tmm_cli.note.math import Brackets, Fraction, Letter, Lines, Node, Number, Power, Root, Row, Sign, Words
from tmm_cli.plans.record import Symbol

SPACES = nsdecls("w", "m", "r")
FONT = '<w:rPr><w:rFonts w:ascii="Cambria Math" w:hAnsi="Cambria Math"/></w:rPr>'
PLAIN, UPRIGHT, ITALIC = '<m:rPr><m:sty m:val="p"/></m:rPr>', "<m:rPr><m:nor/></m:rPr>", ""  # figures, words, letters
NOT_XML = dict.fromkeys((*range(9), 11, 12, *range(14, 32), *range(0xD800, 0xE000), 65534, 65535), "�")


def data(text: str) -> str:
    """A text in XML; what XML forbids is replaced."""
    return escape(text.translate(NOT_XML))


def omath(node: Node, size: float = 0.0) -> str:
    """A formula in a line of text. size: of its letters, points, where it is not that of the text."""
    shown = _of(node)
    if size:
        shown = shown.replace(FONT, FONT.replace("</w:rPr>", f'<w:sz w:val="{round(2 * size)}"/></w:rPr>'))
    return f"<m:oMath {SPACES}>{shown}</m:oMath>"


def display(node: Node) -> list[str]:
    """A formula apart: a paragraph for each of its lines."""
    lines = node.lines if isinstance(node, Lines) else (node,)
    jc = '<m:oMathParaPr><m:jc m:val="left"/></m:oMathParaPr>'
    return [f"<m:oMathPara {SPACES}>{jc}{omath(_begun(line))}</m:oMathPara>" for line in lines]


def _begun(line: Node) -> Node:
    """A line that begins with a sign of equality, with nothing before it: some programs want two sides."""
    return Row((Words("\u200b"), *line.nodes)) if isinstance(line, Row) and line.nodes[0] == Sign("=") else line


def _of(node: Node) -> str:
    match node:
        case Number(text) | Sign(text):
            return _run(text)
        case Words(text):
            return _run(text, UPRIGHT)
        case Letter(symbol, vector, lines):
            shown = _symbol(symbol, vector)
            for _ in range(lines):
                shown = _bar(shown, "bot")
            return shown
        case Row(nodes) | Lines(nodes):
            return "".join(_of(n) for n in nodes)
        case Fraction(over, under):
            return f"<m:f><m:num>{_of(over)}</m:num><m:den>{_of(under)}</m:den></m:f>"
        case Power(base, exponent):
            return f"<m:sSup><m:e>{_of(base)}</m:e><m:sup>{_of(exponent)}</m:sup></m:sSup>"
        case Root(of):
            return f'<m:rad><m:radPr><m:degHide m:val="1"/></m:radPr><m:deg/><m:e>{_of(of)}</m:e></m:rad>'
        case Brackets(inside, opens, closes, bars):
            own = {"begChr": "|" if bars else "(" if opens else "", "endChr": "|" if bars else ")" if closes else ""}
            marks = "".join(f'<m:{kind} m:val="{mark}"/>' for kind, mark in own.items() if mark not in ("(", ")"))
            return f"<m:d>{f'<m:dPr>{marks}</m:dPr>' if marks else ''}<m:e>{_of(inside)}</m:e></m:d>"


def _symbol(symbol: Symbol, vector: bool) -> str:
    letter = _run(symbol.letter, ITALIC)
    if vector:
        letter = _bar(letter, "top")
    base = f"<m:e>{letter}</m:e>"
    below = f"<m:sub>{_run(symbol.below, UPRIGHT)}</m:sub>" if symbol.below else ""
    above = f"<m:sup>{_run(symbol.above, ITALIC)}</m:sup>" if symbol.above else ""
    if below and above:
        return f"<m:sSubSup>{base}{below}{above}</m:sSubSup>"
    if below:
        return f"<m:sSub>{base}{below}</m:sSub>"
    return f"<m:sSup>{base}{above}</m:sSup>" if above else letter


def _bar(inside: str, place: str) -> str:
    return f'<m:bar><m:barPr><m:pos m:val="{place}"/></m:barPr><m:e>{inside}</m:e></m:bar>'


def _run(text: str, style: str = PLAIN) -> str:
    return f'<m:r>{style}{FONT}<m:t xml:space="preserve">{data(text)}</m:t></m:r>'
