"""Every word that a user reads in a table, a drawing or a report has its place here, and another language its folder.

Keys are dotted: the part before the first dot says where the words are used. Files are read when a word of theirs is
asked for, so that a short command reads few.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module

FILES = (
    "common", "structure", "results", "warnings", "drawings", "accuracy", "speed", "bench", "stability", "synthesis",
    "searches",
)  # fmt: skip
OF_TASKS = "synthesis_"  # files that are named by their keys, one a task of synthesis


@cache
def _text(key: str) -> str:
    own = key.partition(".")[0]
    for name in (own,) if own.startswith(OF_TASKS) else FILES:
        words: dict[str, str] = import_module(f"{__name__}.{name}").WORDS
        if key in words:
            return words[key]
    raise KeyError(key)


def say(key: str, **values: object) -> str:
    """The words of a key, with values put in their places."""
    return _text(key).format(**values)
