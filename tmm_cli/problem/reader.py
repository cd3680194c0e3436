"""Reader of YAML problem files: plain data with line and column of every key and value.

PyYAML only splits the text into events. This module composes them and interprets unquoted words itself, because YAML
1.1 misreads engineering input: `12:30` becomes 750, `010` becomes 8, the key `on` becomes True, and repeated keys
silently override each other. Size, nesting depth and number of values are limited, as a file may come from anyone.
"""

from __future__ import annotations

import codecs
import os
import re
import stat
from collections.abc import Iterator
from typing import Any, Final, NoReturn

import yaml

from tmm_cli.language import _
from tmm_cli.problem.errors import MAX_DEPTH, Path, ProblemError, SourcePosition, Tree, quote
from tmm_cli.problem.scalars import HIDDEN, Scalar, decimal_comma_error, is_split_number, plain_value

# Tokens of a list or mapping in brackets: quoted text, comment, bracket, line end with the indentation after it.
_IN_BRACKETS = re.compile(r"""'[^']*'|"(?:[^"\\]|\\.)*"|(?<=\s)\#.*|[][{}]|\n(?P<indent>\ *)(?=[^\s\#])""", re.VERBOSE)


def tab_error(file: str, mark: SourcePosition) -> ProblemError:
    """Return the error for a tab in the indentation."""
    return ProblemError(
        _("a tab is used for indentation"),
        found=_("a tab"),
        allowed=_("spaces, two for each level"),
        file=file,
        mark=mark,
    )


def syntax_error(error: yaml.MarkedYAMLError, text: str, file: str) -> ProblemError:
    """Convert a syntax error of PyYAML to a ProblemError with a plain message, line and column.

    The error may come from PyYAML's parser in C or from the one in Python.
    """
    opened, position = error.context_mark or error.problem_mark, error.problem_mark or error.context_mark
    indent = _("keys and items of one level begin in the same column, indented by spaces")
    quoted = _("a quotation mark is not closed"), _("text between two equal quotation marks"), opened
    table = {  # PyYAML's words (of both its parsers): what is wrong, what is allowed, and where
        "mapping values are not": (
            _("a ':' is not allowed here"),
            _("one 'key: value' on a line; a text with ': ' in it needs quotation marks"),
            position,
        ),
        "expected ',' or ']'": (_("'[' is not closed"), _("'[1, 2]', items separated by commas"), opened),
        "expected ',' or '}'": (_("'{' is not closed"), _("'{a: 1, b: 2}', items separated by commas"), opened),
        "end of stream": quoted,
        "found unexpected document": quoted,
        "could not find expected ':'": (_("a line without ':'"), _("'key: value', with a space after ':'"), opened),
        "cannot start any token": (
            _("a value cannot begin with this character"),
            _("text in quotation marks"),
            position,
        ),
        "expected <block end>": (
            _("this line does not match the indentation or structure of the lines above"),
            indent,
            position,
        ),
        "did not find expected key": (
            _("this line does not match the indentation or structure of the lines above"),
            indent,
            position,
        ),
        "entries are not allowed": (
            _("a list item '-' is not allowed here"),
            _("each '- item' on its own line"),
            position,
        ),
        "node content": (_("a value is missing"), _("a value"), position),
        "nesting depth": (_("too many nested levels"), _("at most {most} levels").format(most=MAX_DEPTH), position),
    }
    problem = f"{error.problem} {error.context}"
    plain = _("this is not YAML: {problem}").format(problem=error.problem), None, position
    message, allowed, place = next((entry for words, entry in table.items() if words in problem), plain)
    if opened and position and "expected ',' or" in problem and _is_closed(text, opened.index):
        start = _start_of_stray_text(text, opened.index, position.index)
        message, allowed = _("',' or the closing bracket is expected here"), _("[2 kN, 0] or {a: 1, b: 2}")
        return _refusal_at(start, text, file, message, allowed)
    if position and allowed == indent and text[: position.index].rstrip(" ").endswith(("]", "}")):
        message, allowed = (
            _("text after a closing bracket"),
            _("units inside the brackets: [2 kN, 0]; a comment begins with #"),
        )
        return _refusal_at(position.index, text, file, message, allowed)
    if place is None:
        return ProblemError(message, allowed=allowed, file=file)
    mark = SourcePosition(place.line + 1, place.column + 1)
    rest = text[place.index :]
    if rest.startswith("\t"):
        return tab_error(file, mark)
    line = rest.split("\n")[0].strip()
    return ProblemError(message, found=quote(line) if line else None, allowed=allowed, file=file, mark=mark)


def _refusal_at(index: int, text: str, file: str, message: str, allowed: str) -> ProblemError:
    mark = SourcePosition(text.count("\n", 0, index) + 1, index - text.rfind("\n", 0, index))
    quoted = quote(text[index:].split("\n")[0].strip())
    return ProblemError(message, found=quoted, allowed=allowed, file=file, mark=mark)


def _is_closed(text: str, start: int) -> bool:
    """Return True if the bracket at index `start` is closed within its own block of the text.

    The block ends at the next line that is not indented more than the line of the bracket.
    """
    line = text[text.rfind("\n", 0, start) + 1 : start]
    indent, closing = len(line) - len(line.lstrip(" ")), ""
    for item in _IN_BRACKETS.finditer(text, start):
        if item["indent"] is not None:
            if len(item["indent"]) <= indent and text[item.end()] not in "]}":
                return False
        elif item[0] in ("[", "{"):
            closing = {"[": "]", "{": "}"}[item[0]] + closing
        elif item[0] in ("]", "}"):
            if closing[0] != item[0]:
                return False
            closing = closing[1:]
            if not closing:
                return True
    return False


def _start_of_stray_text(text: str, start: int, stop: int) -> int:
    """Return the index at which text in brackets becomes wrong, if the parser stops at index `stop`.

    It is the index of a semicolon before `stop`, of the beginning of the line, or `stop` itself.
    """
    item = max(text.rfind(mark, start, stop) for mark in ",[{")
    semicolon, line = text.rfind(";", item, stop), text.rfind("\n", item, stop)
    if semicolon > line:
        return semicolon
    return stop - len(text[line + 1 : stop].lstrip(" ")) if line > item else stop


# Composing PyYAML's events to plain data and marks. MAX_DEPTH bounds the recursion, MAX_NODES the work.


MAX_NODES: Final = 50_000

MAX_CALL_LENGTH: Final = 100  # characters in which the end of a cut call is searched for

LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_ITEM_BELOW = re.compile(r"[\r\n] *- ")
_CALL = re.compile(r"[^\[\]{}\n]*?,[^\[\]{}\n]*?\)(?=\s*[,}\]\n]|$)")  # what may end with its bracket behind a comma
_COMMA = re.compile(r"(?<![\d.])(\d+),(\d+)(?![\d.])")


class Composer:
    """Composer of plain data and positions from the YAML events of one text.

    Attributes:
        marks, key_marks, commas: positions of values and keys, and lists that may be decimal commas; see errors.Tree.
    """

    def __init__(self, text: str, file: str) -> None:
        self.text, self.file = text, file
        self.events = self.parsed()
        self.nodes = 0
        self.marks: dict[Path, SourcePosition] = {}
        self.key_marks: dict[Path, SourcePosition] = {}
        self.commas: dict[Path, str] = {}

    def compose(self) -> dict[str, Any]:
        """Return the top mapping of the text. Raises ProblemError with line and column at the first mistake."""
        top = None
        for event in self.events:
            if isinstance(event, yaml.NodeEvent):
                top = self.node(event, ())
            elif isinstance(event, yaml.DocumentStartEvent) and () in self.marks:
                self.refuse(
                    event, (), _("the file contains a second document"), "---", _("only one document in a file")
                )
        if top is None:
            raise ProblemError(_("the file is empty"), allowed=_("keys with values, such as 'tmm: 1'"), file=self.file)
        if not isinstance(top, dict):
            raise ProblemError(
                _("the top level of the file must consist of keys with values"),
                found=quote(top),
                allowed=_("lines 'key: value'"),
                file=self.file,
                mark=self.marks[()],
            )
        return top

    def parsed(self) -> Iterator[Any]:
        try:
            yield from yaml.parse(self.text, Loader=LOADER)
        except yaml.MarkedYAMLError as error:
            raise syntax_error(error, self.text, self.file) from None
        except (yaml.YAMLError, ValueError, OverflowError):
            raise ProblemError(_("this is not YAML"), file=self.file) from None

    def refuse(
        self, event: Any, path: Path, message: str, found: str | None = None, allowed: str | None = None
    ) -> NoReturn:
        raise self.placed(ProblemError(message, found=found, allowed=allowed), event, path)

    def placed(self, error: ProblemError, event: Any, path: Path) -> ProblemError:
        new = error.at(*path)
        new.file, new.mark = self.file, _mark(event)
        return new

    def node(self, event: Any, path: Path) -> Any:
        """Compose a value (scalar, list or mapping) from its first event and the events that follow."""
        self.check(event, path)
        self.marks[path] = _mark(event)
        if isinstance(event, yaml.ScalarEvent):
            return self.scalar(event, path)
        return self.mapping(event, path) if isinstance(event, yaml.MappingStartEvent) else self.sequence(event, path)

    def mapping(self, start: Any, path: Path) -> dict[str, Any]:
        entries: dict[str, Any] = {}
        before = None
        while not isinstance(key := next(self.events), yaml.MappingEndEvent):
            self.check(key, path)
            name = self.key(key, path, entries)
            value = next(self.events)
            entries[name] = self.node(value, (*path, name))
            if start.flow_style and value.end_mark.index == value.start_mark.index:
                self.key_alone(key, value, before, path)
            before = (*path, name), value
        return entries

    def sequence(self, start: Any, path: Path) -> list[Any]:
        items: list[Any] = []
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            its_path = *path, len(items)
            items.append(self.node(event, its_path))
            if start.flow_style and isinstance(event, yaml.ScalarEvent) and not event.style:
                self.cut_by_comma(event, its_path)
        if start.flow_style:
            end: Any = event
            written = self.text[start.start_mark.index : end.end_mark.index]
            pointed = _COMMA.sub(r"\1.\2", written)
            if pointed != written:
                self.commas[path] = pointed if "," in pointed else pointed[1:-1]
        return items

    def check(self, event: Any, path: Path) -> None:
        self.nodes += 1
        if self.nodes > MAX_NODES:
            self.refuse(event, path, _("too many values"), allowed=_("at most {most}").format(most=MAX_NODES))
        if len(path) >= MAX_DEPTH and not isinstance(event, yaml.ScalarEvent):
            allowed = _("at most {most} levels").format(most=MAX_DEPTH)
            self.refuse(event, path[:3], _("too many nested levels"), allowed=allowed)
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            self.refuse(
                event,
                path,
                _("YAML aliases (* and &) are not allowed in a problem file"),
                allowed=_("the value itself, or a parameter; a text that begins with * or & needs quotation marks"),
            )
        if event.tag is not None:
            self.refuse(
                event,
                path,
                _("YAML tags (!) are not allowed in a problem file"),
                quote(event.tag),
                _("values without tags"),
            )

    def key(self, event: Any, path: Path, mapping: dict[str, Any]) -> str:
        """Return the name of a key as written. Raises ProblemError if the key occurs twice."""
        if not isinstance(event, yaml.ScalarEvent):
            self.refuse(event, path, _("a list or a mapping cannot be used as a key"), allowed=_("a word or number"))
        name: str = event.value
        path = (*path, name)
        if name in mapping:
            allowed = _("each key once; the first is on line {line}").format(line=self.key_marks[path].line)
            self.refuse(event, path, _("this key occurs twice"), quote(name), allowed)
        self.key_marks[path] = _mark(event)
        return name

    def scalar(self, event: Any, path: Path) -> Scalar:
        text: str = event.value
        if event.style:
            if hidden := HIDDEN.search(text):
                self.refuse(
                    event,
                    path,
                    _("the text contains a control character"),
                    found=quote(hidden[0]),
                    allowed=_("printable characters"),
                )
            return text
        if event.start_mark.line != event.end_mark.line:
            if _ITEM_BELOW.search(self.text[event.start_mark.index : event.end_mark.index]):
                self.refuse(
                    event,
                    path,
                    _("this key has a value and a list below it"),
                    quote(text),
                    _("either a value or a list"),
                )
            return text
        try:
            return plain_value(text)
        except ProblemError as error:
            raise self.placed(error, event, path) from None

    def cut_by_comma(self, event: Any, path: Path) -> None:
        """Refuse an unquoted expression with a comma, such as `{at: atan2(y, x)}`, which YAML splits at the comma."""
        if event.value.count("(") <= event.value.count(")"):
            return
        if cut := _CALL.match(self.text[event.start_mark.index : event.start_mark.index + MAX_CALL_LENGTH]):
            if cut[0].startswith("("):  # as coordinates are written on paper
                self.refuse(event, path, _("expected two coordinates [x, y]"), quote(cut[0]), f"[{cut[0][1:-1]}]")
            self.refuse(
                event, path, _("an expression with a comma needs quotation marks here"), quote(cut[0]), f'"{cut[0]}"'
            )

    def key_alone(self, key: Any, value: Any, before: tuple[Path, Any] | None, path: Path) -> None:
        """Refuse a key without a value in braces, which usually results from a missing space or a decimal comma.

        YAML reads `{length: 1,5}` as {length: 1, 5: null}, and `{length:5}` as {"length:5": null}.
        """
        if ":" in self.text[key.end_mark.index : value.start_mark.index]:
            return
        if before is not None and isinstance(before[1], yaml.ScalarEvent) and not before[1].style:
            its_path, number = before
            self.cut_by_comma(number, its_path)
            touching = self.text[number.end_mark.index : key.start_mark.index] == ","
            if touching and is_split_number(number.value, key.value):
                raise self.placed(decimal_comma_error(number.value, key.value), number, its_path)
        self.refuse(key, path, _("this key has no value"), quote(key.value), _("'key: value', with a space after ':'"))


def _mark(event: Any) -> SourcePosition:
    return SourcePosition(event.start_mark.line + 1, event.start_mark.column + 1)


MAX_BYTES: Final = 1_000_000

_LANG = re.compile(rb"^[{ \t]*[\"']?lang[\"']?\s*:\s*[\"']?(en|ru|sr)\b", re.MULTILINE)
_TAB = re.compile(r"^ *\t[ \t]*[^\s#]", re.MULTILINE)


def decimal_comma_hint(tree: Tree, path: Path) -> str | None:
    """Return a hint on decimal commas if the list at this path, such as `[1,5]`, may be a number; otherwise None."""
    written = tree.commas.get(path)
    return written and f"decimal comma? write {written}"


def read_file(path: str | os.PathLike[str]) -> Tree:
    """Read a problem file.

    Raises:
        ProblemError: the file cannot be read, is too large, or is not a plain YAML mapping.
    """
    file = os.fspath(path)
    return read_text(read_file_text(file), file)


def read_file_text(file: str) -> str:
    """Read the text of a file.

    Raises:
        ProblemError: the file cannot be read, is too large, or is not encoded in UTF-8.
    """
    return decode_text(read_bytes(file), file)


def find_language(data: bytes) -> str | None:
    """Return the language in a line such as `lang: ru`, or None; the file need not be valid."""
    named = _LANG.search(data.removeprefix(codecs.BOM_UTF8))
    return None if named is None else named[1].decode()


def read_bytes(file: str) -> bytes:
    """Read the bytes of a file.

    Raises:
        ProblemError: the file cannot be read or is too large.
    """
    try:
        status = os.stat(file)
        if stat.S_ISDIR(status.st_mode):
            raise ProblemError(_("this is a folder, not a file"), allowed=_("a YAML file"), file=file)
        if status.st_size > MAX_BYTES:
            raise _too_large_error(file, f"{status.st_size} bytes")
        with open(file, "rb") as stream:
            # Pipes and devices have no size to look at beforehand.
            data = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise ProblemError(_("there is no such file"), file=file) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise ProblemError(_("the file cannot be read: {reason}").format(reason=reason), file=file) from None
    if len(data) > MAX_BYTES:
        raise _too_large_error(file, f"more than {MAX_BYTES} bytes")
    return data


def _too_large_error(file: str, found: str) -> ProblemError:
    allowed = _("at most {max_bytes} bytes").format(max_bytes=MAX_BYTES)
    return ProblemError(_("the file is too large"), found=found, allowed=allowed, file=file)


def decode_text(data: bytes, file: str) -> str:
    """Decode the bytes of a file.

    Raises:
        ProblemError: the text is not encoded in UTF-8.
    """
    body = data.removeprefix(codecs.BOM_UTF8)
    try:
        return body.decode()
    except UnicodeDecodeError as error:
        before = body[: error.start]
        column = len(before[before.rfind(b"\n") + 1 :].decode()) + 1
        raise ProblemError(
            _("the file is not a text in UTF-8 encoding"),
            found=_("byte {byte} at position {position}").format(
                byte=f"0x{body[error.start]:02X}", position=len(data) - len(body) + error.start + 1
            ),
            allowed=_("UTF-8; in the editor choose: Save with encoding, UTF-8"),
            file=file,
            mark=SourcePosition(before.count(b"\n") + 1, column),
        ) from None


def read_text(text: str, file: str, composed_by: type[Composer] = Composer) -> Tree:
    """Read the text of a problem file.

    Args:
        text: content of the file.
        file: name of the file, for messages.
        composed_by: class that composes the data.

    Raises:
        ProblemError: the text is too large, or is not a plain YAML mapping.
    """
    text = text.removeprefix("\ufeff")
    if len(text) > MAX_BYTES:
        raise _too_large_error(file, f"{len(text)} characters")
    if hidden := HIDDEN.search(text):
        raise ProblemError(
            _("the file contains a control character or an invisible character"),
            found=f"U+{ord(hidden[0]):04X}",
            allowed=_("printable characters"),
            file=file,
            mark=_mark_at(text, hidden.start()),
        )
    if tab := _TAB.search(text):
        raise tab_error(file, _mark_at(text, text.index("\t", tab.start())))
    composer = composed_by(text, file)
    data = composer.compose()
    return Tree(file, data, composer.marks, composer.key_marks, composer.commas)


def _mark_at(text: str, index: int) -> SourcePosition:
    lines = re.split(r"\r\n|\r|\n", text[:index])
    return SourcePosition(len(lines), len(lines[-1]) + 1)
