"""PyYAML's syntax errors in simple words: the one table of them."""

from __future__ import annotations

import re

import yaml

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.tree import MAX_DEPTH, Mark

# In a list or mapping in brackets: a quoted text, a comment, a bracket, or a line end with the indentation after it.
_IN_BRACKETS = re.compile(r"""'[^']*'|"(?:[^"\\]|\\.)*"|(?<=\s)\#.*|[][{}]|\n(?P<indent>\ *)(?=[^\s\#])""", re.VERBOSE)


def tab_error(file: str, mark: Mark) -> ProblemError:
    """The refusal of a tab where the indentation counts."""
    return ProblemError(
        _("a tab is used for indentation"),
        found=_("a tab"),
        allowed=_("spaces, two for each level"),
        file=file,
        mark=mark,
    )


def syntax_error(error: yaml.MarkedYAMLError, text: str, file: str) -> ProblemError:
    """The error of either of PyYAML's parsers on `text`, with its line and column."""
    opened, shown = error.context_mark or error.problem_mark, error.problem_mark or error.context_mark
    indent = _("keys and items of one level start in one column, indented by spaces")
    quoted = _("a quote is not closed"), _("text between two equal quotes"), opened
    table = {  # PyYAML's words (of both its parsers): what is wrong, what is allowed, and where
        "mapping values are not": (
            _("a ':' where none can be"), _("one 'key: value' in a line; text with ': ' in quotes"), shown
        ),
        "expected ',' or ']'": (_("'[' is not closed"), _("'[1, 2]', items separated by commas"), opened),
        "expected ',' or '}'": (_("'{' is not closed"), _("'{a: 1, b: 2}', items separated by commas"), opened),
        "end of stream": quoted,
        "found unexpected document": quoted,
        "could not find expected ':'": (_("a line without ':'"), _("'key: value', with a space after ':'"), opened),
        "cannot start any token": (_("a value cannot start with this character"), _("text between quotes"), shown),
        "expected <block end>": (_("this does not fit the lines above"), indent, shown),
        "did not find expected key": (_("this does not fit the lines above"), indent, shown),
        "entries are not allowed": (
            _("a list item '-' where none can be"), _("each '- item' in a line of its own"), shown
        ),
        "node content": (_("a value is missing"), _("a value"), shown),
        "nesting depth": (_("nested too deeply"), _("at most {most} levels").format(most=MAX_DEPTH), shown),
    }  # fmt: skip
    problem = f"{error.problem} {error.context}"
    plain = _("this is not YAML: {problem}").format(problem=error.problem), None, shown
    message, allowed, place = next((told for words, told in table.items() if words in problem), plain)
    if opened and shown and "expected ',' or" in problem and _is_closed(text, opened.index):
        start = _start_of_stray_text(text, opened.index, shown.index)
        message, allowed = _("',' or the closing bracket is expected here"), _("[2 kN, 0] or {a: 1, b: 2}")
        return _refusal_at(start, text, file, message, allowed)
    if shown and allowed == indent and text[: shown.index].rstrip(" ").endswith(("]", "}")):
        message, allowed = _("text after a closing bracket"), _("[2 kN, 0]: units inside; a comment begins with #")
        return _refusal_at(shown.index, text, file, message, allowed)
    if place is None:
        return ProblemError(message, allowed=allowed, file=file)
    mark = Mark(place.line + 1, place.column + 1)
    rest = text[place.index :]
    if rest.startswith("\t"):
        return tab_error(file, mark)
    line = rest.split("\n")[0].strip()
    return ProblemError(message, found=quote(line) if line else None, allowed=allowed, file=file, mark=mark)


def _refusal_at(index: int, text: str, file: str, message: str, allowed: str) -> ProblemError:
    mark = Mark(text.count("\n", 0, index) + 1, index - text.rfind("\n", 0, index))
    found = quote(text[index:].split("\n")[0].strip())
    return ProblemError(message, found=found, allowed=allowed, file=file, mark=mark)


def _is_closed(text: str, start: int) -> bool:
    """Return True if the bracket at `start` is closed before a line that is indented no more than its own line."""
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
    """Where an item in brackets that the parser gives up at `stop` goes wrong: a semicolon, a new line, or `stop`."""
    item = max(text.rfind(mark, start, stop) for mark in ",[{")
    semicolon, line = text.rfind(";", item, stop), text.rfind("\n", item, stop)
    if semicolon > line:
        return semicolon
    return stop - len(text[line + 1 : stop].lstrip(" ")) if line > item else stop
