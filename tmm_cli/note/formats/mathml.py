"""Formulas as MathML, which browsers draw themselves."""

from __future__ import annotations

from html import escape

from tmm_cli.note.math import Brackets, Fraction, Letter, Lines, Node, Number, Power, Root, Row, Sign, Words
from tmm_cli.plans.record import Symbol


def mathml(node: Node, *, display: bool = False) -> str:
    """A formula; display: on a line of its own."""
    return f"<math{' display=' + chr(34) + 'block' + chr(34) if display else ''}>{_of(node)}</math>"


def _of(node: Node) -> str:
    match node:
        case Number(text):
            return f"<mn>{escape(text)}</mn>"
        case Letter(symbol, vector, lines):
            shown = _symbol(symbol, vector)
            return f'<mrow class="lines{lines}">{shown}</mrow>' if lines else shown  # lines under it, as long as it is
        case Sign(text):
            return f"<mo>{escape(text)}</mo>"
        case Words(text):
            return f"<mtext>{escape(text).replace(' ', '&#160;')}</mtext>"
        case Row(nodes):
            return f"<mrow>{''.join(_of(n) for n in nodes)}</mrow>"
        case Fraction(over, under):
            return f"<mfrac>{_of(over)}{_of(under)}</mfrac>"
        case Power(base, exponent):
            return f"<msup>{_of(base)}{_of(exponent)}</msup>"
        case Root(of):
            return f"<msqrt>{_of(of)}</msqrt>"
        case Brackets(inside, opens, closes, bars):
            left, right = "||" if bars else "()"
            return f"<mrow>{f'<mo>{left}</mo>' * opens}{_of(inside)}{f'<mo>{right}</mo>' * closes}</mrow>"
        case Lines(lines):
            rows = "".join(f"<mtr><mtd>{_of(line)}</mtd></mtr>" for line in lines)
            return f'<mtable columnalign="left" displaystyle="true">{rows}</mtable>'


def _symbol(symbol: Symbol, vector: bool) -> str:
    own = symbol.letter.rstrip("′")  # with its strokes it would be a name, which is upright
    letter = f"<mi>{escape(own)}</mi>" + "<mo>′</mo>" * (len(symbol.letter) - len(own))
    letter = letter if own == symbol.letter else f"<mrow>{letter}</mrow>"
    if vector:
        letter = f'<mover accent="true">{letter}<mo stretchy="false">¯</mo></mover>'
    below, above = f"<mtext>{escape(symbol.below)}</mtext>", f"<mi>{escape(symbol.above)}</mi>"
    if symbol.below and symbol.above:
        return f"<msubsup>{letter}{below}{above}</msubsup>"
    if symbol.below:
        return f"<msub>{letter}{below}</msub>"
    return f"<msup>{letter}{above}</msup>" if symbol.above else letter
