"""Texts that others wrote, made harmless: one line, short, nothing that steers."""

from __future__ import annotations

import re

LONGEST = 200  # characters of a name, or of an answer as it was written
LONGEST_SENTENCE = 600
JOINERS = "\u200c\u200d"  # that words of Persian and of Indian languages need


def shown(text: str, longest: int = LONGEST) -> str:
    """A text that others wrote, on one line, without signs that steer (a page, a terminal, the order of letters)."""
    if len(text) > longest:
        text = text[: longest - 1] + "…"
    return text if text.isprintable() else re.sub(r"\s", " ", "".join(map(_shown, text)))


def _shown(sign: str) -> str:
    return sign if sign.isprintable() or sign.isspace() or sign in JOINERS else "\ufffd"


def sentence(text: str) -> str:
    """The same of a sentence that may quote them."""
    return shown(text, LONGEST_SENTENCE)
