"""The note as one HTML page with formulas in MathML. It works offline, prints on A4 and runs no scripts."""

from __future__ import annotations

import base64
import hashlib
import re
from functools import partial
from html import escape
from importlib.resources import files

from tmm_cli.drawing.formats import NOT_XML, write_svg
from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note import blocks
from tmm_cli.note.blocks import Block, Inline, Line, Note
from tmm_cli.note.expression import ComputedQuantity, formula
from tmm_cli.note.formula_tree import Brackets, Fraction, Letter, Lines, Node, Number, Power, Root, Row, Sign, Words
from tmm_cli.note.subject import localise_figures


def mathml(node: Node, *, display: bool = False) -> str:
    """Return a formula as MathML. With `display` it is printed on a line of its own."""
    return f"<math{' display=' + chr(34) + 'block' + chr(34) if display else ''}>{_mathml(node)}</math>"


def _mathml(node: Node) -> str:
    match node:
        case Number(text):
            return f"<mn>{escape(text)}</mn>"
        case Letter(symbol, vector, lines):
            letter = _symbol(symbol, vector)
            # the row is as wide as the letter, and so are its underlines
            return f'<mrow class="lines{lines}">{letter}</mrow>' if lines else letter
        case Sign(text):
            return f"<mo>{escape(text)}</mo>"
        case Words(text):
            return f"<mtext>{escape(text).replace(' ', '&#160;')}</mtext>"
        case Row(nodes):
            return f"<mrow>{''.join(_mathml(n) for n in nodes)}</mrow>"
        case Fraction(over, under):
            return f"<mfrac>{_mathml(over)}{_mathml(under)}</mfrac>"
        case Power(base, exponent):
            return f"<msup>{_mathml(base)}{_mathml(exponent)}</msup>"
        case Root(radicand):
            return f"<msqrt>{_mathml(radicand)}</msqrt>"
        case Brackets(inside, opens, closes, bars):
            left, right = "||" if bars else "()"
            return f"<mrow>{f'<mo>{left}</mo>' * opens}{_mathml(inside)}{f'<mo>{right}</mo>' * closes}</mrow>"
        case Lines(lines):
            rows = "".join(f"<mtr><mtd>{_mathml(line)}</mtd></mtr>" for line in lines)
            return f'<mtable columnalign="left" displaystyle="true">{rows}</mtable>'


def _symbol(symbol: Symbol, vector: bool) -> str:
    base = symbol.letter.rstrip("′")  # letter and strokes in one element would be printed upright, as a name
    letter = f"<mi>{escape(base)}</mi>" + "<mo>′</mo>" * (len(symbol.letter) - len(base))
    letter = letter if base == symbol.letter else f"<mrow>{letter}</mrow>"
    if vector:
        letter = f'<mover accent="true">{letter}<mo stretchy="false">¯</mo></mover>'
    below, above = f"<mtext>{escape(symbol.below)}</mtext>", f"<mi>{escape(symbol.above)}</mi>"
    if symbol.below and symbol.above:
        return f"<msubsup>{letter}{below}{above}</msubsup>"
    if symbol.below:
        return f"<msub>{letter}{below}</msub>"
    return f"<msup>{letter}{above}</msup>" if symbol.above else letter


# The note as one HTML page that opens without a network and prints on A4. All texts are data: no script runs.


STOPS = ".,;:)"
SHORT = 16  # letters of a cell that is not broken into lines
WHOLE = 13  # rows of the largest table that is not split between pages


def html(note: Note) -> bytes:
    """Return the note as an HTML page, encoded in UTF-8."""
    style = files("tmm_cli.note.formats").joinpath("note.css").read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    policy = f"default-src 'none';style-src 'sha256-{digest}'"
    writer = HtmlWriter(note)
    head = (
        f'<!doctype html>\n<html lang="{escape_text(note.language)}"><head><meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width,initial-scale=1">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        f"<title>{escape_text(note.title)}</title><style>{style}</style></head>\n<body>\n"
    )
    body = "\n".join(writer.write_block(block) for block in note.blocks)
    return f"{head}{body}\n</body></html>\n".encode("utf-8", "replace")


def escape_text(text: str) -> str:
    """Escape a text for HTML. Characters that are not allowed are replaced."""
    return escape(text.translate(NOT_XML))


class HtmlWriter:
    """Writer of blocks as HTML elements. It numbers headings, tables and figures, so the order of blocks matters."""

    def __init__(self, note: Note) -> None:
        self.note, self.numbers, self.headings = note, note.numbers(), iter(note.headings())
        self.ids = {key: f"n{place}" for place, key in enumerate(self.numbers)}
        self.tables = self.figures = 0

    def write_block(self, block: Block) -> str:
        """Return a block as HTML."""
        match block:
            case blocks.Heading():
                number, __ = next(self.headings)
                return f'<h{block.level} id="h{number}">{number} {escape_text(block.text)}</h{block.level}>'
            case blocks.Paragraph(line):
                leads = ' class="leads"' if str(line[-1]).endswith(":") else ""
                return f"<p{leads}>{self.write_line(line)}</p>"
            case blocks.Items(lines):
                return f"<ul>{''.join(f'<li>{self.write_line(line)}</li>' for line in lines)}</ul>"
            case blocks.Equation(node):
                return f'<div class="equation">{mathml(node, display=True)}</div>'
            case ComputedQuantity():
                formula_node = formula(block, partial(localise_figures, spoken=self.note.language))
                return f'<div class="equation found">{mathml(formula_node, display=True)}</div>'
            case blocks.Rows():
                return self.write_table(block)
            case blocks.Figure():
                return self.write_figure(block)
            case blocks.Contents():
                return self.write_contents()
            case blocks.Title():
                return write_title_page(block)
            case blocks.Sources(sources):
                listed = "".join(f"<li{self.id_attribute(s.key)}>{escape_text(s.text)}</li>" for s in sources)
                return f'<ol class="sources">{listed}</ol>'

    def write_line(self, line: Line) -> str:
        """Return a line of texts and formulas as HTML. A formula and the punctuation after it stay on one line."""
        texts = [self.write_inline(inline) for inline in line]
        for k, inline in enumerate(line[1:], 1):
            if isinstance(inline, str) and inline[0] in STOPS and not isinstance(line[k - 1], str):
                texts[k - 1] = f'<span class="joined">{texts[k - 1]}{inline[0]}</span>'
                texts[k] = escape_text(inline[1:])
        return "".join(texts)

    def write_inline(self, inline: Inline) -> str:
        """Return one text, symbol, formula or reference of a line as HTML."""
        match inline:
            case str():
                return escape_text(inline)
            case blocks.Ref(key):
                return f'<a href="#{self.ids[key]}">{self.numbers[key]}</a>'
            case blocks.Link(key):
                return f'[<a href="#{self.ids[key]}">{self.numbers[key]}</a>]'
            case Symbol():
                return mathml(Letter(inline))
        return mathml(inline)

    def write_table(self, rows: blocks.Rows) -> str:
        """Return a table with its caption above it."""
        self.tables += 1
        caption = _("Table {number}. {text}").format(number=self.tables, text=rows.caption)
        head = "".join(f"<th>{self.write_heading(cell)}</th>" for cell in rows.head)
        body = "".join(
            "<tr>"
            + "".join(
                f"<td{cell_class(cell, number)}>{self.write_line(cell)}</td>"
                for cell, number in zip(row, rows.numeric, strict=True)
            )
            + "</tr>\n"
            for row in rows.rows
        )
        whole = ' class="whole"' if len(rows.rows) <= WHOLE else ""
        return (
            f'<p class="caption"{self.id_attribute(rows.key)}>{escape_text(caption)}</p><table{whole}>\n'
            f"<thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table>"
        )

    def write_heading(self, cell: Line) -> str:
        """Return a column heading. Units such as rad/s are not broken between lines."""
        if not all(isinstance(inline, str) for inline in cell):
            return self.write_line(cell)
        return re.sub(r"\S+/\S+", r'<span class="joined">\g<0></span>', escape_text("".join(map(str, cell))))

    def write_figure(self, figure: blocks.Figure) -> str:
        """Return a figure with its caption below it."""
        self.figures += 1
        caption = _("Figure {number}. {text}").format(number=self.figures, text=figure.caption)
        drawn = write_svg(figure.drawing).decode().partition("\n")[2]
        return f"<figure{self.id_attribute(figure.key)}>{drawn}<figcaption>{escape_text(caption)}</figcaption></figure>"

    def write_contents(self) -> str:
        """Return the table of contents with links to the headings."""
        lines = [
            f'<p class="level{heading.level}"><a href="#h{number}">{number} {escape_text(heading.text)}</a></p>'
            for number, heading in self.note.headings()
        ]
        return (
            f'<nav><p class="heading">{escape_text(_("Contents"))}</p>{"".join(lines)}</nav>\n<div class="page"></div>'
        )

    def id_attribute(self, key: str) -> str:
        """Return the id attribute of a block with this key, or an empty text if the key is empty."""
        return f' id="{self.ids[key]}"' if key else ""


def cell_class(cell: Line, number: bool) -> str:
    """Return the class attribute of a table cell.

    The class is "number", or "short" for a text that is not broken into lines. Other cells have no class.
    """
    short = all(isinstance(inline, str) for inline in cell) and sum(map(len, map(str, cell))) <= SHORT
    return ' class="number"' if number else ' class="short"' if short else ""


def write_title_page(block: blocks.Title) -> str:
    """Return the title page as HTML."""
    people = "".join(
        f"<tr><td>{escape_text(role)}</td><td>{escape_text(name)}</td></tr>" for role, name in block.people
    )
    return (
        f'<header><p class="institution">{escape_text(block.institution)}</p>'
        f'<div><p class="kind">{escape_text(block.heading)}</p><p class="title">{escape_text(block.title)}</p></div>'
        f'<table class="people">{people}</table>'
        f'<p class="foot">{escape_text(block.foot)}</p></header>'
    )
