"""The catalogues of translations: `python -m tests.messages` brings them up to what the sources say.

Every message of the package goes into tmm_cli/locale/LANGUAGE/LC_MESSAGES/tmm.po: new ones without a translation, those
that are said no more are dropped, translations stay. Then tmm.mo, which the program reads, is compiled. Run it after a
message has changed, and after translating. Measurements (bench) are for maintainers and are not translated.
"""

from __future__ import annotations

import ast
import io
import string
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.mofile import read_mo
from babel.messages.pofile import read_po, write_po

from tmm_cli.language import DOMAIN, ENGLISH, LANGUAGES, LOCALE
from tmm_cli.locale.build import compile_catalogues
from tmm_cli.problem import SYMBOLS

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "tmm_cli"
KEYWORDS = {
    "_": "",
    "N_": "",
    "Phrase": "",
    "course_symbol": "symbol",
    "CourseSymbol": "symbol",
    "symbol": "symbol",
}  # what marks a message, and its context
UNITS = sorted({*filter(str.isascii, SYMBOLS), "J", "W"} - {"%"})
NOT_TRANSLATED = "bench"
FINISHED: tuple[str, ...] = (
    "ru",
    "sr",
)  # languages that are held to be whole: add one when nothing is left to translate
TRANSLATED = tuple(language for language in LANGUAGES if language != ENGLISH)


def sources() -> list[Path]:
    """Files that may hold messages, in a fixed order."""
    files = sorted(PACKAGE.rglob("*.py"))
    return [file for file in files if NOT_TRANSLATED not in file.relative_to(PACKAGE).parts]


@cache
def parsed(file: Path) -> ast.Module:
    """A file of the package, read once."""
    return ast.parse(file.read_text(encoding="utf-8"))


@cache
def messages() -> tuple[tuple[str, str, str], ...]:
    """Context (mostly none), message and file, as often as it is marked."""
    found = []
    for file in sources():
        name = file.relative_to(ROOT).as_posix()
        calls = [node for node in ast.walk(parsed(file)) if isinstance(node, ast.Call)]
        calls = [call for call in calls if isinstance(call.func, ast.Name)]
        found += [(KEYWORDS[word], text, name) for word, text in marked(calls)]
        found += [("", text, name) for text in described(calls)]
    return *found, *(("unit", unit, "tmm_cli/problem/units.py") for unit in UNITS)


def marked(calls: list[ast.Call]) -> Iterator[tuple[str, str]]:
    """Marks and their messages, also those inside of formatted strings, where Babel sees none."""
    for call in sorted(calls, key=lambda call: (call.lineno, call.col_offset)):
        if call.func.id in KEYWORDS and call.args:
            text = call.args[0]
            if isinstance(text, ast.Constant) and text.value:
                yield call.func.id, text.value


def described(calls: list[ast.Call]) -> Iterator[str]:
    """What the keys of files are for, `Field(description=...)`, and what their values must be: refusals say it."""
    for call in calls:
        texts = [word.value for word in call.keywords if word.arg == "description" and call.func.id == "Field"]
        texts += call.args[1:2] if call.func.id == "PydanticCustomError" else []
        yield from (text.value for text in texts if isinstance(text, ast.Constant))


def path_of(language: str, ending: str = "po") -> Path:
    """The catalogue of a language."""
    return LOCALE / language / "LC_MESSAGES" / f"{DOMAIN}.{ending}"


def catalogue(language: str) -> Catalog:
    """As it is kept; empty where there is none yet."""
    if not path_of(language).exists():
        return Catalog(locale=language)
    with path_of(language).open("rb") as stream:
        return read_po(stream, locale=language)


def updated(language: str) -> Catalog:
    """Every message of the sources with the translation that it has."""
    old, new = catalogue(language), Catalog(locale=language, project="tmm", charset="utf-8", fuzzy=False)
    new.mime_headers = [(name, value) for name, value in new.mime_headers if name in KEPT_HEADERS]
    for context, text, file in messages():
        before = old.get(text, context or None)
        comments = before.user_comments if before else []
        new.add(
            text,
            before.string if before else "",
            locations=[(file, 0)],
            context=context or None,
            user_comments=comments,
        )
    return new


KEPT_HEADERS = ("Project-Id-Version", "Language", "MIME-Version", "Content-Type", "Content-Transfer-Encoding")


def po_text(catalog: Catalog) -> bytes:
    """The text of a .po file; nothing in it says when it was made."""
    stream = io.BytesIO()
    write_po(stream, catalog, width=120, include_lineno=False, omit_header=False, sort_by_file=True)
    text = stream.getvalue().decode()
    header, body = text.split("\n\n", 1)
    kept = [line for line in header.splitlines() if not line.startswith("#")]
    kept = [line for line in kept if not line.startswith('"') or line[1:].startswith(KEPT_HEADERS)]
    return "\n".join([f"# Translations of tmm: {catalog.locale_identifier}.", *kept, "", body]).encode()


def read(language: str) -> dict[tuple[str | None, str], str]:
    """What the program reads, by context and message."""
    with path_of(language, "mo").open("rb") as stream:
        return translations(read_mo(stream))


def translations(catalog: Catalog) -> dict[tuple[str | None, str], str]:
    """What is translated, by context and message."""
    found = ((m.context, str(m.id), str(m.string)) for m in catalog if m.id and m.string and not m.fuzzy)
    return {(c.decode() if isinstance(c, bytes) else c, text): said for c, text, said in found}


def fields(text: str) -> list[str]:
    """Names of the fields of a message, in order of the alphabet, each once."""
    try:
        return sorted({name for __, name, __, __ in string.Formatter().parse(text) if name is not None})
    except ValueError:  # braces that are meant
        return []


def missing(catalog: Catalog) -> list[str]:
    """Messages without a translation."""
    return [str(message.id) for message in catalog if message.id and not message.string]


def main() -> None:
    """Bring every catalogue up to the sources, and say what is left to translate."""
    for language in TRANSLATED:
        new = updated(language)
        path_of(language).parent.mkdir(parents=True, exist_ok=True)
        path_of(language).write_bytes(po_text(new))
        left = missing(new)
        print(f"{language}: {len(new)} messages, {len(left)} not translated")
    compile_catalogues()


if __name__ == "__main__":
    main()
