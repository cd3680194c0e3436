"""Write problems/SOURCES.md: every item of the two sources, the command that shows it, and what it prints today.

    python -m tests.sources

Items and commands stand in data/sources.txt. Nothing is typed here of what the product prints: it is found in what the
command says. A is the text on lever mechanisms, their synthesis and the force guidelines; B the text on structure.
"""

from __future__ import annotations

import html
import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from unittest import mock

from tmm_cli.cli import application

ROOT = Path(__file__).parents[1]
DATA, PAGE = ROOT / "tests" / "data" / "sources.txt", ROOT / "problems" / "SOURCES.md"
PLACES = (
    (51, "B, chapters 2.1 to 2.3"),
    (91, "A, chapter 6; B, 2.3 and 2.4"),
    (123, "A, force guidelines"),
    (163, "B, figures"),
    (168, "A, combined mechanisms"),
    (170, "B, figures of chapters 1 and 2"),
)
ZERO = re.compile(r"-?\d(\.\d+)?e-1\d\b")  # rounding: another processor has another one
HEAD = """# The items of the two sources

Written by `python -m tests.sources`; a test holds it to what the commands print today. A is the text on lever
mechanisms, their synthesis and the force guidelines, B the text on the structure of mechanisms with its figures. `tmm`
before a command is left out.

| item | what the source treats | place | command | what it prints |
| --- | --- | --- | --- | --- |
"""


@dataclass(frozen=True)
class Item:
    """An item of the sources; parts: what is looked for in the output (a pattern after /), or `no:` and why."""

    number: int
    name: str
    command: str
    parts: tuple[str, ...]

    @property
    def place(self) -> str:
        """Where it stands in the sources; a figure is named by the item itself."""
        return next(place for last, place in PLACES if self.number <= last)


def items() -> Iterator[Item]:
    """All items in their order."""
    for line in DATA.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            number, name, command, parts = (part.strip() for part in line.split("|"))
            yield Item(int(number), name, command, tuple(part.strip() for part in parts.split(";;")))


def printed(command: str) -> list[str]:
    """The lines that a command prints, with single spaces; of notes and drawings their texts and names too."""
    kind, *words = command.split()
    with tempfile.TemporaryDirectory() as folder:
        writes = kind in ("run", "note", "svg") or "--table" in words
        files = [word for word in words if not word.endswith(".svg")]
        called = ["run" if kind == "svg" else kind, *files, *(["-o", folder] if writes else [])]
        lines = said_by(called)
        written = sorted(path for path in Path(folder).rglob("*") if path.is_file())
        lines += [path.name for path in written]
        for path in written:
            if path.name == "note.html" or path.name in words:
                lines += sentences(path.read_text(encoding="utf-8"))
    return [ZERO.sub("0", " ".join(line.split())) for line in lines if line.strip()]


def said_by(words: list[str]) -> list[str]:
    """What a command prints and says, called in this process."""
    printed, said = StringIO(), StringIO()
    wide = mock.patch.dict(os.environ, COLUMNS="400")
    with chdir(ROOT), wide, redirect_stdout(printed), redirect_stderr(said), suppress(SystemExit):
        application(words)(words)
    return [*printed.getvalue().splitlines(), *said.getvalue().splitlines()]


def sentences(page: str) -> list[str]:
    """The texts of a page, block by block."""
    page = re.sub(r"<style.*?</style>|<svg [^>]*class=.*?</svg>", " ", page, flags=re.S)
    blocks = re.split(r"</(?:p|h\d|tr|li|figcaption|div|text)>", page)
    return [html.unescape(re.sub(r"<[^>]+>", " ", block)) for block in blocks]


def answer(item: Item, lines: list[str]) -> list[str]:
    """What the output says of an item, part by part. Raises LookupError where a part is not there."""
    said: list[str] = []
    for part in item.parts:
        if part.startswith("no:"):
            said.append(part.removeprefix("no:").strip())
        elif part == "PROPERTIES":
            said += properties(lines)
        else:
            pattern = re.compile(part.removeprefix("/") if part.startswith("/") else re.escape(part))
            found = next((line for line in lines if pattern.search(line)), None)
            if found is None:
                raise LookupError(f"{item.number}: {part!r} is not in the output of {item.command}")
            said.append(found)
    return said


def properties(lines: list[str]) -> list[str]:
    """Rows of the tables of properties: what a file shows, beside what it expects."""
    rows: list[str] = []
    heads = [number for number, line in enumerate(lines) if line == "property value expected unit"]
    for head in heads:
        for line in lines[head + 1 :]:
            if not re.search(r"\d", line):
                if "─" in line:
                    continue
                break
            if not re.fullmatch(r".*\S -?[\d.e+-]+ -?[\d.e+-]+( \S+)?", line):
                break
            rows.append(line)
    if not rows:
        raise LookupError("no property is shown")
    return rows


def written() -> str:
    """The whole page."""
    every = list(items())
    commands = list(dict.fromkeys(item.command for item in every))
    outputs = {command: printed(command) for command in commands}
    rows, missing = [], []
    for item in every:
        try:
            said = answer(item, outputs[item.command])
        except LookupError as error:
            missing.append(f"{item.number} {item.command}: {error}")
            continue
        told = "<br>".join(line.replace("|", "\\|") for line in said)
        command = item.command.removeprefix("svg ")
        shown = f"run {command.rsplit(' ', 1)[0]}" if item.command.startswith("svg ") else command
        rows.append(f"| {item.number} | {item.name} | {item.place} | `{shown}` | {told} |\n")
    if missing:
        raise LookupError("\n".join(missing))
    return HEAD + "".join(rows)


def main() -> None:
    """Write the page."""
    PAGE.write_text(written(), encoding="utf-8")


if __name__ == "__main__":
    main()
