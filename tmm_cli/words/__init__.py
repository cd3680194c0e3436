"""Every word that a user reads in a table, a drawing or a report has its place here; another language: another folder.

Keys are dotted: the part before the first dot says where the words are used.
"""

from __future__ import annotations

from tmm_cli.words import drawings, results, structure, warnings

ENGLISH: dict[str, str] = {**structure.WORDS, **results.WORDS, **warnings.WORDS, **drawings.WORDS}


def say(key: str, **values: object) -> str:
    """The words of a key, with values put in their places."""
    return ENGLISH[key].format(**values)
