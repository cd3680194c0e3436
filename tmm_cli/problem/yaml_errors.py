"""PyYAML's syntax errors in simple words: the one table of them."""

from __future__ import annotations

import yaml

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.tree import MAX_DEPTH, Mark


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
    if place is None:
        return ProblemError(message, allowed=allowed, file=file)
    mark = Mark(place.line + 1, place.column + 1)
    rest = text[place.index :]
    if rest.startswith("\t"):
        return tab_error(file, mark)
    line = rest.split("\n")[0].strip()
    return ProblemError(message, found=quote(line) if line else None, allowed=allowed, file=file, mark=mark)
