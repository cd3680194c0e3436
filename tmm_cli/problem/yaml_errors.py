"""PyYAML's syntax errors in simple words: the one table of them."""

from __future__ import annotations

from typing import Final

import yaml

from tmm_cli.problem.errors import Mark, ProblemError, quote

_INDENT: Final = "keys and items of one level start in one column, indented by spaces"

# PyYAML's words (of both its parsers) -> our message, what is allowed, whether the place is the start.
_SYNTAX: Final = (
    (
        "mapping values are not",
        "a ':' where none can be",
        "one 'key: value' in a line; text with ': ' in quotes",
        False,
    ),
    ("expected ',' or ']'", "'[' is not closed", "'[1, 2]', items separated by commas", True),
    ("expected ',' or '}'", "'{' is not closed", "'{a: 1, b: 2}', items separated by commas", True),
    ("end of stream", "a quote is not closed", "text between two equal quotes", True),
    ("found unexpected document", "a quote is not closed", "text between two equal quotes", True),
    ("could not find expected ':'", "a line without ':'", "'key: value', with a space after ':'", True),
    ("escape", "an unknown escape after '\\' in double quotes", "single quotes, where '\\' is plain", False),
    (
        "hexdecimal",
        "an unknown escape after '\\' in double quotes",
        "single quotes, where '\\' is plain",
        False,
    ),
    ("cannot start any token", "a value cannot start with this character", "text between quotes", False),
    ("expected <block end>", "this does not fit the lines above", _INDENT, False),
    ("did not find expected key", "this does not fit the lines above", _INDENT, False),
    ("expected '-' indicator", "this does not fit the list above", _INDENT, False),
    (
        "entries are not allowed",
        "a list item '-' where none can be",
        "each '- item' in a line of its own",
        False,
    ),
    ("node content", "a value is missing", "a value", False),
    ("<document start>", "text after the end of the document", "one document in a file", False),
    (
        "tag",
        "tags are not part of a problem file",
        "plain values; text that starts with ! goes in quotes",
        False,
    ),
)


def tab_error(file: str, mark: Mark) -> ProblemError:
    """The refusal of a tab where the indentation counts."""
    return ProblemError(
        "a tab is used for indentation",
        found="a tab",
        allowed="spaces, two for each level",
        file=file,
        mark=mark,
    )


def syntax_error(error: yaml.MarkedYAMLError, text: str, file: str) -> ProblemError:
    """The error of either of PyYAML's parsers on `text`, with its line and column."""
    problem = f"{error.problem} {error.context}"
    place = error.problem_mark or error.context_mark
    message = f"not YAML: {error.problem}"
    allowed: str | None = None
    if "alias" in problem or "anchor" in problem:
        message, allowed = "aliases are not part of a problem file", "text that starts with * or & in quotes"
    else:
        for words, ours, instead, from_start in _SYNTAX:
            if words in problem:
                message, allowed = ours, instead
                place = (error.context_mark or place) if from_start else place
                break
    if place is None:
        return ProblemError(message, allowed=allowed, file=file)
    mark = Mark(place.line + 1, place.column + 1)
    char = text[place.index : place.index + 1]
    if char == "\t":
        return tab_error(file, mark)
    line = text[place.index :].splitlines()[:1]
    return ProblemError(
        message, found=quote(line[0]) if line and line[0] else None, allowed=allowed, file=file, mark=mark
    )
