"""The note as one HTML page that opens without a network and prints on A4. All texts are data: no script runs."""

from __future__ import annotations

import base64
import hashlib
from dataclasses import dataclass, field
from functools import partial
from html import escape
from importlib.resources import files

from tmm_cli.draw.formats.svg import NOT_XML, svg
from tmm_cli.language import _
from tmm_cli.note.blocks import (
    Block,
    Contents,
    Equation,
    Figure,
    Found,
    Heading,
    Inline,
    Items,
    Line,
    Link,
    NewPage,
    Note,
    Paragraph,
    Ref,
    Rows,
    Sources,
    Title,
)  # fmt: skip
from tmm_cli.note.breaking import formula
from tmm_cli.note.context import figures
from tmm_cli.note.math import Letter, Node
from tmm_cli.note.mathml import mathml
from tmm_cli.plans.record import Symbol


def html(note: Note) -> bytes:
    """The page in UTF-8."""
    style = files("tmm_cli.note.formats").joinpath("note.css").read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    policy = f"default-src 'none';style-src 'sha256-{digest}'"
    writer = Writer(note)
    head = (
        f'<!doctype html>\n<html lang="{data(note.language)}"><head><meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width,initial-scale=1">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        f"<title>{data(note.title)}</title><style>{style}</style></head>\n<body>\n"
    )
    body = "\n".join(writer.block(block) for block in note.blocks)
    return f"{head}{body}\n</body></html>\n".encode("utf-8", "replace")


def data(text: str) -> str:
    """A text that comes from anywhere."""
    return escape(text.translate(NOT_XML))


@dataclass
class Writer:
    """Blocks as elements; it counts headings as it goes."""

    note: Note
    counted: list[int] = field(default_factory=lambda: [0, 0])

    def __post_init__(self) -> None:
        self.numbers = self.note.numbers()
        self.places = {key: f"n{place}" for place, key in enumerate(self.numbers)}
        self.tables = self.figures = 0

    def block(self, block: Block) -> str:
        """One of them."""
        match block:
            case Heading():
                number, place = self.number(block)
                return f'<h{block.level} id="{place}">{number} {data(block.text)}</h{block.level}>'
            case Paragraph(line):
                return f"<p>{self.line(line)}</p>"
            case Items(lines):
                return f"<ul>{''.join(f'<li>{self.line(line)}</li>' for line in lines)}</ul>"
            case Equation(node, key):
                return self.equation(node, key, "equation")
            case Found(substitution, key):
                shown = formula(substitution, partial(figures, language=self.note.language))
                return self.equation(shown, key, "equation found")
            case Rows():
                return self.table(block)
            case Figure():
                return self.figure(block)
            case Contents():
                return self.contents()
            case NewPage():
                return '<div class="page"></div>'
            case Title():
                return title(block)
            case Sources(sources):
                listed = "".join(f"<li{self.place(s.key)}>{data(s.text)}</li>" for s in sources)
                return f'<ol class="sources">{listed}</ol>'

    def line(self, line: Line) -> str:
        """Texts and formulas."""
        return "".join(self.inline(part) for part in line)

    def inline(self, part: Inline) -> str:
        """One of these."""
        match part:
            case str():
                return data(part)
            case Ref(key):
                return f'<a href="#{self.places[key]}">{self.numbers[key]}</a>'
            case Link(key):
                return f'[<a href="#{self.places[key]}">{self.numbers[key]}</a>]'
            case Symbol():
                return mathml(Letter(part))
        return mathml(part)

    def equation(self, node: Node, key: str, kind: str) -> str:
        """A formula on its line, its number at the right."""
        number = f"<span>({self.numbers[key]})</span>" if key else ""
        return f'<div class="{kind}"{self.place(key)}>{mathml(node, display=True)}{number}</div>'

    def table(self, rows: Rows) -> str:
        """With its caption above."""
        self.tables += 1
        caption = _("Table {number}. {text}").format(number=self.tables, text=rows.caption)
        numeric = [all(_is_number(row[k]) for row in rows.rows) for k in range(len(rows.head))]
        head = "".join(f"<th>{self.line(cell)}</th>" for cell in rows.head)
        body = "".join(
            "<tr>" + "".join(
                f"<td{' class=' + chr(34) + 'number' + chr(34) if number else ''}>{self.line(cell)}</td>"
                for cell, number in zip(row, numeric, strict=True)
            ) + "</tr>\n"
            for row in rows.rows
        )  # fmt: skip
        return (
            f"<table{self.place(rows.key)}><caption>{data(caption)}</caption>\n<thead><tr>{head}</tr></thead>\n"
            f"<tbody>{body}</tbody></table>"
        )

    def figure(self, figure: Figure) -> str:
        """With its caption below."""
        self.figures += 1
        caption = _("Figure {number}. {text}").format(number=self.figures, text=figure.caption)
        drawn = svg(figure.drawing).decode().partition("\n")[2]
        return f"<figure{self.place(figure.key)}>{drawn}<figcaption>{data(caption)}</figcaption></figure>"

    def contents(self) -> str:
        """All headings, each a link to its place."""
        counter = Writer(self.note)
        lines = []
        for block in self.note.blocks:
            if isinstance(block, Heading):
                number, place = counter.number(block)
                lines.append(f'<p class="level{block.level}"><a href="#{place}">{number} {data(block.text)}</a></p>')
        return f'<nav><p class="heading">{data(_("Contents"))}</p>{"".join(lines)}</nav>'

    def number(self, heading: Heading) -> tuple[str, str]:
        """3.2, and the name of the place."""
        chapter, section = self.counted
        self.counted = [chapter + 1, 0] if heading.level == 1 else [chapter, section + 1]
        number = ".".join(str(n) for n in self.counted[: heading.level])
        return number, f"h{number}"

    def place(self, key: str) -> str:
        """The name of what is referred to."""
        return f' id="{self.places[key]}"' if key else ""


def title(block: Title) -> str:
    """The title page."""
    people = "".join(f"<tr><td>{data(role)}</td><td>{data(name)}</td></tr>" for role, name in block.people)
    return (
        f'<header><p class="institution">{data(block.institution)}</p><div><p class="kind">{data(block.heading)}</p>'
        f'<p class="title">{data(block.title)}</p></div><table class="people">{people}</table>'
        f'<p class="foot">{data(block.foot)}</p></header>'
    )


def _is_number(cell: Line) -> bool:
    """Whether a cell has figures only, or is empty."""
    text = "".join(part if isinstance(part, str) else "x" for part in cell)
    return not text.strip("0123456789.,−-–— ")
