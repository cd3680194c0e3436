"""PyYAML's events to plain data and marks. MAX_DEPTH bounds the recursion, MAX_NODES the work."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, Final, NoReturn

import yaml

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.scalars import HIDDEN, Scalar, comma_error, plain_value, split_number
from tmm_cli.problem.tree import MAX_DEPTH, Mark, Path
from tmm_cli.problem.yaml_errors import syntax_error

MAX_NODES: Final = 50_000

LONGEST_CALL: Final = 100  # so far the end of a call that was cut is looked for

LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_ITEM_BELOW = re.compile(r"[\r\n] *- ")
_CALL = re.compile(r"[^\[\]{}\n]*?,[^\[\]{}\n]*?\)(?=\s*[,}\]\n]|$)")  # what may end with its bracket behind a comma
_COMMA = re.compile(r"(?<![\d.])(\d+),(\d+)(?![\d.])")


class Composer:
    """Data, marks, key marks and commas of one text; `compose` fills them (see tree.Tree)."""

    def __init__(self, text: str, file: str) -> None:
        self.text, self.file = text, file
        self.events = self.parsed()
        self.nodes = 0
        self.marks: dict[Path, Mark] = {}
        self.key_marks: dict[Path, Mark] = {}
        self.commas: dict[Path, str] = {}

    def compose(self) -> dict[str, Any]:
        """The top mapping. Raises ProblemError, with file, line and column, at the first mistake."""
        top = None
        for event in self.events:
            if isinstance(event, yaml.NodeEvent):
                top = self.node(event, ())
            elif isinstance(event, yaml.DocumentStartEvent) and () in self.marks:
                self.refuse(event, (), _("a second document"), "---", _("one document in a file"))
        if top is None:
            raise ProblemError(_("the file is empty"), allowed=_("a mapping such as 'tmm: 1'"), file=self.file)
        if not isinstance(top, dict):
            raise ProblemError(
                _("the top level is not a mapping"), found=quote(top), allowed=_("lines 'key: value'"),
                file=self.file, mark=self.marks[()],
            )  # fmt: skip
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
        """The value that begins with this event."""
        self.check(event, path)
        self.marks[path] = _mark(event)
        if isinstance(event, yaml.ScalarEvent):
            return self.scalar(event, path)
        return self.mapping(event, path) if isinstance(event, yaml.MappingStartEvent) else self.sequence(event, path)

    def mapping(self, start: Any, path: Path) -> dict[str, Any]:
        found: dict[str, Any] = {}
        before = None
        while not isinstance(key := next(self.events), yaml.MappingEndEvent):
            self.check(key, path)
            name = self.key(key, path, found)
            value = next(self.events)
            found[name] = self.node(value, (*path, name))
            if start.flow_style and value.end_mark.index == value.start_mark.index:
                self.key_alone(key, value, before, path)
            before = (*path, name), value
        return found

    def sequence(self, start: Any, path: Path) -> list[Any]:
        found: list[Any] = []
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            its_path = *path, len(found)
            found.append(self.node(event, its_path))
            if start.flow_style and isinstance(event, yaml.ScalarEvent) and not event.style:
                self.cut_by_comma(event, its_path)
        if start.flow_style:
            end: Any = event
            written = self.text[start.start_mark.index : end.end_mark.index]
            pointed = _COMMA.sub(r"\1.\2", written)
            if pointed != written:
                self.commas[path] = pointed if "," in pointed else pointed[1:-1]
        return found

    def check(self, event: Any, path: Path) -> None:
        self.nodes += 1
        if self.nodes > MAX_NODES:
            self.refuse(event, path, _("too many values"), allowed=_("at most {most}").format(most=MAX_NODES))
        if len(path) >= MAX_DEPTH and not isinstance(event, yaml.ScalarEvent):
            allowed = _("at most {most} levels").format(most=MAX_DEPTH)
            self.refuse(event, path[:3], _("nested too deeply"), allowed=allowed)
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            self.refuse(
                event, path, _("aliases are not part of a problem file"),
                allowed=_("the value written out, or a parameter; text that starts with * or & in quotes"),
            )  # fmt: skip
        if event.tag is not None:
            self.refuse(event, path, _("tags are not part of a problem file"), quote(event.tag), _("plain values"))

    def key(self, event: Any, path: Path, mapping: dict[str, Any]) -> str:
        """The name of a key, as it is written."""
        if not isinstance(event, yaml.ScalarEvent):
            self.refuse(event, path, _("a list or mapping is used as a key"), allowed=_("a word or number"))
        name: str = event.value
        path = (*path, name)
        if name in mapping:
            allowed = _("the first is at line {line}").format(line=self.key_marks[path].line)
            self.refuse(event, path, _("duplicate key"), quote(name), allowed)
        self.key_marks[path] = _mark(event)
        return name

    def scalar(self, event: Any, path: Path) -> Scalar:
        text: str = event.value
        if event.style:
            if hidden := HIDDEN.search(text):
                self.refuse(event, path, _("a control character"), found=quote(hidden[0]), allowed=_("printable text"))
            return text
        if event.start_mark.line != event.end_mark.line:
            if _ITEM_BELOW.search(self.text[event.start_mark.index : event.end_mark.index]):
                self.refuse(event, path, _("a value and a list below it"), quote(text), _("one of the two"))
            return text
        try:
            return plain_value(text)
        except ProblemError as error:
            raise self.placed(error, event, path) from None

    def cut_by_comma(self, event: Any, path: Path) -> None:
        """Refuse `{at: atan2(y, x)}` and `[atan2(y, x), 0]`, which YAML cuts at the comma."""
        if event.value.count("(") <= event.value.count(")"):
            return
        if cut := _CALL.match(self.text[event.start_mark.index : event.start_mark.index + LONGEST_CALL]):
            if cut[0].startswith("("):  # as coordinates are written on paper
                self.refuse(event, path, _("two coordinates [x, y] are wanted"), quote(cut[0]), f"[{cut[0][1:-1]}]")
            self.refuse(event, path, _("a comma in brackets needs quotes here"), quote(cut[0]), f'"{cut[0]}"')

    def key_alone(self, key: Any, value: Any, before: tuple[Path, Any] | None, path: Path) -> None:
        """Refuse `{length: 1,5}`, which YAML reads as {length: 1, 5: null}, and `{length:5}`: {"length:5": null}."""
        if ":" in self.text[key.end_mark.index : value.start_mark.index]:
            return
        if before is not None and isinstance(before[1], yaml.ScalarEvent) and not before[1].style:
            its_path, number = before
            self.cut_by_comma(number, its_path)
            touching = self.text[number.end_mark.index : key.start_mark.index] == ","
            if touching and split_number(number.value, key.value):
                raise self.placed(comma_error(number.value, key.value), number, its_path)
        self.refuse(key, path, _("a key without a value"), quote(key.value), _("'key: value', a space after ':'"))


def _mark(event: Any) -> Mark:
    return Mark(event.start_mark.line + 1, event.start_mark.column + 1)
