"""Parameters of a problem file that are set on the command line (`--set OA=120`), and parameters that nothing uses."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from tmm_cli.language import _
from tmm_cli.problem.errors import Path, ProblemError, Tree, unknown_name_error
from tmm_cli.problem.scalars import plain_value


def apply_settings(tree: Tree, settings: Sequence[str]) -> Tree:
    """Replace values of parameters by settings of the command line (option --set).

    Args:
        tree: content of the file.
        settings: texts such as `OA=120`.

    Raises:
        ProblemError: a setting is wrong or names an unknown parameter.
    """
    raw = tree.data.get("parameters")
    parameters = dict(raw) if isinstance(raw, dict) else {}
    settings_by_path: dict[Path, str] = {}
    for setting in settings:
        words = f"--set {setting}"
        name, sign, text = (word.strip() for word in setting.partition("="))
        path = ("parameters", name)
        if not sign or not name:
            raise ProblemError(_("expected a name and a value"), allowed="--set OA=120", file=words)
        if name not in parameters:
            none = None if parameters else _("none, since the file has no block `parameters`")
            raise unknown_name_error(name, parameters, _("no parameter has this name"), none, path=path, file=words)
        if path in settings_by_path:
            raise ProblemError(
                _("this parameter is set twice"), path=path, found=f"{settings_by_path[path]}, {words}", file=words
            )
        settings_by_path[path] = words
        try:
            parameters[name] = plain_value(text)
        except ProblemError as error:
            raise error.at(*path).located(words) from None
    return (
        replace(tree, data={**tree.data, "parameters": parameters}, given=settings_by_path)
        if settings_by_path
        else tree
    )


def unused_parameters(tree: Tree, names: Iterable[str]) -> list[str]:
    """Return those of the named parameters that no value of the file uses, directly or through other parameters."""
    parameters = tree.data.get("parameters", {})
    met: set[str] = set()
    left = [value for key, value in tree.data.items() if key not in ("parameters", "title", "description")]
    while left:
        new = {word for value in left for word in _find_names(value)} - met
        met |= new
        left = [parameters[word] for word in new if word in parameters]
    return [name for name in names if name not in met]


def _find_names(value: Any) -> Iterator[str]:
    """Yield all words that may be names, from the texts in a value of the file."""
    if isinstance(value, str):
        yield from re.findall(r"[^\W\d]\w*", value)
    elif isinstance(value, dict | list):
        for child in value.values() if isinstance(value, dict) else value:
            yield from _find_names(child)
