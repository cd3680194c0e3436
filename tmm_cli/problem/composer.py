"""PyYAML's events to plain data and marks, with a stack of its own, not Python's."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Final, NoReturn

import yaml

from tmm_cli.problem.errors import Mark, Path, ProblemError, path_text, quote
from tmm_cli.problem.scalars import HIDDEN, Scalar, comma_error, plain_value, split_number
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
                    self.refuse(event, (), "a second document", found="---", allowed="one document in a file")
            elif isinstance(event, yaml.NodeEvent):
                self.node(event)
            elif isinstance(event, yaml.CollectionEndEvent):
                self.close(self.stack.pop())
        if self.top is None:
            raise ProblemError("the file is empty", allowed="a mapping such as 'tmm: 1'", file=self.file)
        if not isinstance(self.top, dict):
            raise ProblemError(
                "the top level is not a mapping",
                found=quote(self.top),
                allowed="lines 'key: value'",
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
            raise ProblemError("this is not YAML", file=self.file) from None

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
            self.refuse(event, path, "too many values", allowed=f"at most {MAX_NODES} keys and values")
        if len(self.stack) >= MAX_DEPTH and not isinstance(event, yaml.ScalarEvent):
            where = path[:3]
            self.refuse(event, where, "nested too deeply", allowed=f"at most {MAX_DEPTH} levels")
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            sign = "*" if isinstance(event, yaml.AliasEvent) else "&"
            self.refuse(
                event,
                path,
                "aliases are not part of a problem file",
                found=quote(sign + event.anchor),
                allowed="the value written out, or a parameter; text that starts with * or & in quotes",
            )
        if event.tag is not None:
            self.refuse(
                event,
                path,
                "tags are not part of a problem file",
                found=quote(event.tag),
                allowed="plain values",
            )

    def key(self, event: Any, frame: _Frame, mapping: dict[str, Any]) -> None:
        if not isinstance(event, yaml.ScalarEvent):
            self.refuse(event, frame.path, "a list or mapping is used as a key", allowed="a word or number")
        name: str = event.value
        path = (*frame.path, name)
        if name == "<<" and not event.style:
            self.refuse(event, path, "merge keys are not part of a problem file", found="<<")
        if HIDDEN.search(name) or not name.strip():
            self.refuse(event, frame.path, "a key that cannot be read", found=quote(name), allowed="a word or number")
        if name in mapping:
            first = self.key_marks[path]
            self.refuse(
                event,
                path,
                "duplicate key",
                found=quote(name),
                allowed=f"one {quote(name)} in {path_text(frame.path) or 'the file'}; the first is at line "
                f"{first.line}, column {first.column}",
            )
        self.key_marks[path] = _mark(event)
        frame.key = name
        frame.events.append(event)

    def scalar(self, event: Any, path: Path) -> Scalar:
        text: str = event.value
        if event.style:
            if hidden := HIDDEN.search(text):
                self.refuse(event, path, "a control character", found=quote(hidden[0]), allowed="printable text")
            return text
        if event.start_mark.line != event.end_mark.line:
            if _ITEM_BELOW.search(self.text[event.start_mark.index : event.end_mark.index]):
                self.refuse(event, path, "a value and a list below it", found=quote(text), allowed="one of the two")
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
        self.refuse(
            name,
            frame.path,
            "a key without a value",
            found=quote(name.value),
            allowed="'key: value', a space after ':'",
        )

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
