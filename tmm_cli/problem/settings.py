"""Parameters that are given beside the file: `--set OA=120`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, unknown_name
from tmm_cli.problem.scalars import plain_value
from tmm_cli.problem.tree import Path, Tree


def with_settings(tree: Tree, settings: Sequence[str]) -> Tree:
    """The file with other values of parameters that it has, each read as if it stood there. Raises ProblemError."""
    own = tree.data.get("parameters")
    parameters = dict(own) if isinstance(own, dict) else {}
    given: dict[Path, str] = {}
    for setting in settings:
        words = f"--set {setting}"
        name, sign, text = (part.strip() for part in setting.partition("="))
        path = ("parameters", name)
        if not sign or not name:
            raise ProblemError(_("a name and a value are wanted"), allowed="--set OA=120", file=words)
        if name not in parameters:
            none = None if parameters else _("none: the file has no parameters")
            raise unknown_name(name, parameters, _("there is no parameter of that name"), none, path=path, file=words)
        if path in given:
            raise ProblemError(_("this is set twice"), path=path, found=f"{given[path]}, {words}", file=words)
        given[path] = words
        try:
            parameters[name] = plain_value(text)
        except ProblemError as error:
            raise error.at(*path).located(words) from None
    return replace(tree, data={**tree.data, "parameters": parameters}, given=given) if given else tree


def unused(tree: Tree, names: Iterable[str]) -> list[str]:
    """Those of these parameters that no value of the file names, nor a parameter that one names."""
    own = tree.data.get("parameters", {})
    met: set[str] = set()
    left = [value for key, value in tree.data.items() if key not in ("parameters", "title", "description")]
    while left:
        new = {word for value in left for word in _words(value)} - met
        met |= new
        left = [own[word] for word in new if word in own]
    return [name for name in names if name not in met]


def _words(value: Any) -> Iterator[str]:
    """What could be names in texts, which arithmetic is too."""
    if isinstance(value, str):
        yield from re.findall(r"[^\W\d]\w*", value)
    elif isinstance(value, dict | list):
        for part in value.values() if isinstance(value, dict) else value:
            yield from _words(part)
