"""PyYAML's events to plain data and marks, with a stack of its own, not Python's."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Final, NoReturn

import yaml

from tmm_cli.errors import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.scalars import HIDDEN, Scalar, comma_error, plain_value, split_number
from tmm_cli.problem.tree import Mark, Path
from tmm_cli.problem.yaml_errors import syntax_error

MAX_DEPTH: Final = 20
MAX_NODES: Final = 50_000

_LOADER: Final[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_ITEM_BELOW = re.compile(r"[\r\n] *- ")


@dataclass
class _Frame:
    """A mapping or list that is still open."""

    value: dict[str, Any] | list[Any]
    path: Path
    flow: bool
    key: str | None = None
    events: list[Any] = field(default_factory=list)  # scalar events of the items, None for other items


class Composer:
    """Data, marks, key marks and commas of one text; `compose` fills them (see reader.Tree)."""

    def __init__(self, text: str, file: str) -> None:
        self.text, self.file = text, file
        self.stack: list[_Frame] = []
        self.documents = self.nodes = 0
        self.top: Any = None
        self.marks: dict[Path, Mark] = {}
        self.key_marks: dict[Path, Mark] = {}
        self.commas: dict[Path, str] = {}

    def compose(self) -> dict[str, Any]:
        """The top mapping. Raises ProblemError, with file, line and column, at the first mistake."""
        for event in self.events():
            if isinstance(event, yaml.DocumentStartEvent):
                self.documents += 1
                if self.documents > 1:
                    self.refuse(event, (), _("a second document"), found="---", allowed=_("one document in a file"))
            elif isinstance(event, yaml.NodeEvent):
                self.node(event)
            elif isinstance(event, yaml.CollectionEndEvent):
                self.close(self.stack.pop())
        if self.top is None:
            raise ProblemError(_("the file is empty"), allowed=_("a mapping such as 'tmm: 1'"), file=self.file)
        if not isinstance(self.top, dict):
            raise ProblemError(
                _("the top level is not a mapping"),
                found=quote(self.top),
                allowed=_("lines 'key: value'"),
                file=self.file,
                mark=self.marks[()],
            )
        return self.top

    def events(self) -> Iterator[Any]:
        try:
            yield from yaml.parse(self.text, Loader=_LOADER)
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

    def node(self, event: Any) -> None:
        frame = self.stack[-1] if self.stack else None
        path: Path = ()
        if frame is not None and isinstance(frame.value, list):
            path = (*frame.path, len(frame.value))
        elif frame is not None:
            path = frame.path if frame.key is None else (*frame.path, frame.key)
        self.check(event, path)
        if frame is not None and isinstance(frame.value, dict) and frame.key is None:
            self.key(event, frame, frame.value)
            return
        self.marks[path] = _mark(event)
        value: Any
        if isinstance(event, yaml.ScalarEvent):
            value = self.scalar(event, path)
        else:
            value = {} if isinstance(event, yaml.MappingStartEvent) else []
            self.stack.append(_Frame(value, path, bool(event.flow_style)))
        if frame is None:
            self.top = value
            return
        if isinstance(frame.value, list):
            frame.value.append(value)
        elif frame.key is not None:
            self.split_by_flow(event, frame)
            frame.value[frame.key], frame.key = value, None
        frame.events.append(event if isinstance(event, yaml.ScalarEvent) else None)

    def check(self, event: Any, path: Path) -> None:
        self.nodes += 1
        if self.nodes > MAX_NODES:
            self.refuse(event, path, _("too many values"), allowed=_("at most {most}").format(most=MAX_NODES))
        if len(self.stack) >= MAX_DEPTH and not isinstance(event, yaml.ScalarEvent):
            self.refuse(
                event, path[:3], _("nested too deeply"), allowed=_("at most {most} levels").format(most=MAX_DEPTH)
            )
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            self.refuse(
                event, path, _("aliases are not part of a problem file"),
                allowed=_("the value written out, or a parameter; text that starts with * or & in quotes"),
            )  # fmt: skip
        if event.tag is not None:
            self.refuse(event, path, _("tags are not part of a problem file"), quote(event.tag), _("plain values"))

    def key(self, event: Any, frame: _Frame, mapping: dict[str, Any]) -> None:
        if not isinstance(event, yaml.ScalarEvent):
            self.refuse(event, frame.path, _("a list or mapping is used as a key"), allowed=_("a word or number"))
        name: str = event.value
        path = (*frame.path, name)
        if name in mapping:
            first = self.key_marks[path]
            self.refuse(
                event, path, _("duplicate key"), quote(name), _("the first is at line {line}").format(line=first.line)
            )
        self.key_marks[path] = _mark(event)
        frame.key = name
        frame.events.append(event)

    def scalar(self, event: Any, path: Path) -> Scalar:
        text: str = event.value
        if event.style:
            if hidden := HIDDEN.search(text):
                self.refuse(event, path, _("a control character"), found=quote(hidden[0]), allowed=_("printable text"))
            return text
        if event.start_mark.line != event.end_mark.line:
            if _ITEM_BELOW.search(self.text[event.start_mark.index : event.end_mark.index]):
                self.refuse(
                    event, path, _("a value and a list below it"), found=quote(text), allowed=_("one of the two")
                )
            return text
        try:
            return plain_value(text)
        except ProblemError as error:
            raise self.placed(error, event, path) from None

    def split_by_flow(self, event: Any, frame: _Frame) -> None:
        """`{length: 1,5}` is read by YAML as {length: 1, 5: null}, `{length:5}` as {"length:5": null}."""
        start, name = event.start_mark.index, frame.events[-1]
        if not frame.flow or not isinstance(event, yaml.ScalarEvent) or event.style or event.value:
            return
        if ":" in self.text[name.end_mark.index : start]:
            return
        if len(frame.events) >= 3 and _split_number(frame.events[-2], name):
            number = frame.events[-2]
            path = (*frame.path, frame.events[-3].value)
            raise self.placed(comma_error(number.value, name.value), number, path)
        wanted = _("'key: value', a space after ':'")
        self.refuse(name, frame.path, _("a key without a value"), quote(name.value), wanted)

    def close(self, frame: _Frame) -> None:
        if not frame.flow or not isinstance(frame.value, list):
            return
        words: list[str] = []
        previous = None
        for event in frame.events:
            if _split_number(previous, event):
                words[-1] += f".{event.value}"
                previous = None
            else:
                words.append(event.value if event is not None else "…")
                previous = event
        if len(words) < len(frame.events):
            self.commas[frame.path] = words[0] if len(words) == 1 else f"[{', '.join(words)}]"


def _split_number(whole: Any, part: Any) -> bool:
    """Whether two plain scalars stand as `1,5` in the text, nothing but the comma between them."""
    if whole is None or part is None or whole.style or part.style:
        return False
    end, start = whole.end_mark, part.start_mark
    touching: bool = end.line == start.line and end.column + 1 == start.column
    return touching and split_number(whole.value, part.value)


def _mark(event: Any) -> Mark:
    return Mark(event.start_mark.line + 1, event.start_mark.column + 1)
