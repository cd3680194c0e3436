"""A YAML file to plain data with a line and column for every key and value.

PyYAML only splits the text into events. Composing (composer) and resolving (scalars) are ours, because its
YAML 1.1 spoils engineering input: `12:30` becomes 750, `010` becomes 8, the key `on` becomes True, repeated
keys win silently.
A text is hostile until read: its size, depth and number of values are bounded.
"""

from __future__ import annotations

import codecs
import os
import re
import stat
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.composer import Composer
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.scalars import HIDDEN
from tmm_cli.problem.tree import Mark, Path, Tree
from tmm_cli.problem.yaml_errors import tab_error

MAX_BYTES: Final = 1_000_000

_LANG = re.compile(rb"^[{ \t]*[\"']?lang[\"']?\s*:\s*[\"']?(en|ru|sr)\b", re.MULTILINE)
_TAB = re.compile(r"^ *\t[ \t]*[^\s#]", re.MULTILINE)


def decimal_comma_hint(tree: Tree, path: Path) -> str | None:
    """What to add to an error when the list at `path` may be a number with a decimal comma, like `[1,5]`."""
    written = tree.commas.get(path)
    return written and f"decimal comma? write {written}"


def read_file(path: str | os.PathLike[str]) -> Tree:
    """Read a problem file. Raises ProblemError when it is not a readable, bounded, plain YAML mapping."""
    file = os.fspath(path)
    return read_text(file_text(file), file)


def file_text(file: str) -> str:
    """The text of a file of bounded size. Raises ProblemError."""
    return decoded(file_bytes(file), file)


def language_in(data: bytes) -> str | None:
    """The language that a problem file names in a line `lang: ru`, even if it cannot be read as a whole."""
    named = _LANG.search(data.removeprefix(codecs.BOM_UTF8))
    return None if named is None else named[1].decode()


def file_bytes(file: str) -> bytes:
    """The content of a file of bounded size. Raises ProblemError."""
    try:
        found = os.stat(file)
        if stat.S_ISDIR(found.st_mode):
            raise ProblemError(_("this is a directory"), allowed=_("a YAML file"), file=file)
        if found.st_size > MAX_BYTES:
            raise _too_large(file, f"{found.st_size} bytes")
        with open(file, "rb") as stream:
            # Pipes and devices have no size to look at beforehand.
            data = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise ProblemError(_("no such file"), file=file) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise ProblemError(_("the file cannot be read: {reason}").format(reason=reason), file=file) from None
    if len(data) > MAX_BYTES:
        raise _too_large(file, f"more than {MAX_BYTES} bytes")
    return data


def _too_large(file: str, found: str) -> ProblemError:
    allowed = _("at most {max_bytes} bytes").format(max_bytes=MAX_BYTES)
    return ProblemError(_("the file is too large"), found=found, allowed=allowed, file=file)


def decoded(data: bytes, file: str) -> str:
    """The content of a file as text. Raises ProblemError when it is not UTF-8."""
    body = data.removeprefix(codecs.BOM_UTF8)
    try:
        return body.decode()
    except UnicodeDecodeError as error:
        before = body[: error.start]
        column = len(before[before.rfind(b"\n") + 1 :].decode()) + 1
        raise ProblemError(
            _("the file is not UTF-8 text"),
            found=_("byte {byte} at position {position}").format(
                byte=f"0x{body[error.start]:02X}", position=len(data) - len(body) + error.start + 1
            ),
            allowed=_("UTF-8; in the editor: Save with encoding, UTF-8"),
            file=file,
            mark=Mark(before.count(b"\n") + 1, column),
        ) from None


def read_text(text: str, file: str, composed_by: type[Composer] = Composer) -> Tree:
    """Read the text of a problem file; `file` is its name in messages. Raises as `read_file`."""
    text = text.removeprefix("\ufeff")
    if len(text) > MAX_BYTES:
        raise _too_large(file, f"{len(text)} characters")
    if hidden := HIDDEN.search(text):
        raise ProblemError(
            _("a control or invisible character"), found=f"U+{ord(hidden[0]):04X}", allowed=_("printable text"),
            file=file, mark=_mark_at(text, hidden.start()),
        )  # fmt: skip
    if tab := _TAB.search(text):
        raise tab_error(file, _mark_at(text, text.index("\t", tab.start())))
    composer = composed_by(text, file)
    data = composer.compose()
    return Tree(file, data, composer.marks, composer.key_marks, composer.commas)


def _mark_at(text: str, index: int) -> Mark:
    lines = re.split(r"\r\n|\r|\n", text[:index])
    return Mark(len(lines), len(lines[-1]) + 1)
