"""Language of messages, and notation of the course (number of the frame, letter of inertia forces).

A message is written in English where it is used, as `_("...")`, which translates it into the current language. A
message that is defined at import, or kept in results, is a phrase, `N_("...")`; it is translated when it is shown.
Translations are in `locale/`.

Files for programs (CSV, result.json) are written in English, inside `with words_of_files(): ...`. Scripts rely on their
headings and words, so these stay when a message gets better English: the catalogue `files` keeps the old words.
"""

from __future__ import annotations

import re
import string
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from errno import ENOENT
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

if TYPE_CHECKING:
    from gettext import NullTranslations


LANGUAGES: Final = ("en", "ru", "sr")
ENGLISH: Final = LANGUAGES[0]
LOCALE: Final = Path(__file__).with_name("locale")
DOMAIN: Final = "tmm"
FILES: Final = "files"  # the catalogue of words of files that differ from the English of today
CATALOGUES: Final[dict[str, NullTranslations]] = {}  # that have been read, by language

Found = TypeVar("Found")
TIE: Final = 1e-13  # relative: far more than rounding, far less than what is printed
MINUS: Final = re.compile(r"(?<![\w)\]}'°.,–—-])-(?=\d)")  # of a number
FORMULA: Final = re.compile(r" = |\d\*\d")
PAIR: Final = re.compile(r"(?<=^\d) - (?=\d$)")  # 0 - 1: the links of a pair

INERTIA: Final = {"U": {"U": "U", "M": "M"}, "Φ": {"U": "Φ", "M": "M_Φ"}}  # force and couple, by the force's letter


@dataclass(frozen=True)
class CourseNotation:
    """Language and notation of a course.

    Attributes:
        language: language of messages, one of LANGUAGES.
        frame: printed number of the frame.
        inertia: letter of inertia forces, U or Φ; empty for the usual one of the language.
        for_programs: True while files for programs are written.
    """

    language: str = ENGLISH
    frame: str = "0"
    inertia: str = ""
    for_programs: bool = False


USUAL: Final = CourseNotation()
_course: ContextVar[CourseNotation] = ContextVar("course", default=USUAL)


class Phrase(str):
    """A message with fields that is translated later.

    As a str it is the English text; `translated` gives the text in the current language.

    Attributes:
        message: the English message with its fields, e.g. "link {name}".
        fields: values of the fields, by name.
    """

    message: str
    fields: dict[str, Any]

    def __new__(cls, message: str, **fields: Any) -> Phrase:
        phrase = super().__new__(cls, message.format(**fields) if fields else message)
        phrase.message, phrase.fields = message, fields
        return phrase

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:
        return (self.message,), self.fields


N_ = Phrase  # as gettext's mark is called


def translated(text: str) -> str:
    """Translate a Phrase, and phrases among its fields, into the current language. Other text is returned unchanged."""
    if not isinstance(text, Phrase) or _name_of_catalogue() == ENGLISH:
        return text
    message = _(text.message)
    return message.format(**{key: translated(own) for key, own in text.fields.items()}) if text.fields else message


def _(message: str) -> str:
    """Translate a message into the current language. A message without a translation stays English."""
    name = _name_of_catalogue()
    return message if name == ENGLISH or not message else _catalogue(name).gettext(message)


def _name_of_catalogue() -> str:
    """Return the current language, or FILES while files for programs are written."""
    course = _course.get()
    return FILES if course.for_programs else course.language


def numeral(value: float, form: str) -> str:
    """Format a number for readers, with a decimal comma in languages that use one.

    Do not use it for values that may be typed into a file again; those keep the decimal point.
    """
    text = f"{half_up(value):{form}}"
    return text if language() == ENGLISH else text.replace(".", ",")


def half_up(value: float) -> float:
    """Increase the magnitude of a value slightly, so that formatting rounds a final five away from zero.

    Otherwise the binary representation of the value would decide whether a final five is rounded up or down.
    """
    return value * (1 + TIE)


def filled(sentence: str, **parts: Any) -> tuple[Any, ...]:
    """Replace the fields of a message by objects such as symbols, or by tuples of objects.

    Returns:
        The text between the fields, and the objects, in order.
    """
    found: list[Any] = []
    for before, name, *__ in string.Formatter().parse(sentence):
        found += [before] if before else []
        if name:
            found += parts[name] if isinstance(parts[name], tuple) else [parts[name]]
    return tuple(found)


def signed(text: str) -> str:
    """Replace hyphens before numbers by minus signs."""
    return MINUS.sub("−", text)


def typeset(text: str) -> str:
    """Replace keyboard characters by printed ones: 3·5 − 2·7 = 1 for 3*5 - 2*7 = 1, → for ->.

    In formulas, hyphens become minus signs; between the two links of a pair, they become dashes. Other hyphens stay, so
    that numbers can be copied.
    """
    text = text.replace("->", "→")
    if FORMULA.search(text):
        text = signed(text.replace(" - ", " − "))
    text = re.sub(r"(?<=\d)\*(?=\d)", "·", PAIR.sub(" – ", text))
    return re.sub(r"(?<=\d) °(?!/)", "°", text)


def spelt(unit: str) -> str:
    """Spell a unit in the current language: rad/s is рад/с in Russian, rpm is o/min in Serbian."""
    if language() == ENGLISH:
        return unit
    return re.sub(r"[A-Za-zµμ°]+", lambda name: _in_context("unit", name[0]), unit)


def symbol(letter: str) -> str:
    """Return the letter of a quantity in the current notation, e.g. U (English) or Φ (Russian) for inertia forces."""
    own = INERTIA.get(_course.get().inertia, {})
    return own[letter] if letter in own else _in_context("symbol", letter)


def printed(link: str) -> str:
    """Return the number of a link as it is printed. Only the number of the frame, "0", depends on the notation."""
    return _course.get().frame if link == "0" else link


def _in_context(context: str, message: str) -> str:
    name = _name_of_catalogue()
    return message if name == ENGLISH or not message else _catalogue(name).pgettext(context, message)


def _catalogue(language: str) -> NullTranslations:
    """Return the translations into a language. They are read from the file once."""
    if language not in CATALOGUES:
        from gettext import GNUTranslations  # English needs none

        path = LOCALE / language / "LC_MESSAGES" / f"{DOMAIN}.mo"
        if not path.exists():
            raise FileNotFoundError(ENOENT, "the translations are not compiled: pip install -e . does it", str(path))
        with path.open("rb") as stream:
            CATALOGUES[language] = GNUTranslations(stream)
    return CATALOGUES[language]


def language() -> str:
    """Return the current language."""
    return _course.get().language


def course() -> CourseNotation:
    """Return the current language and notation."""
    return _course.get()


@contextmanager
def spoken(language: str) -> Iterator[None]:
    """Use a language inside the `with` block.

    Messages are translated when they are composed, so they must be composed inside the block.
    """
    with written_as(replace(_course.get(), language=language, for_programs=False)):
        yield


@contextmanager
def words_of_files() -> Iterator[None]:
    """Write messages for programs inside the `with` block: in English, in the unchanged words on which scripts rely."""
    with written_as(replace(_course.get(), language=ENGLISH, for_programs=True)):
        yield


def word_of_files(text: str) -> str:
    """Return a phrase in the unchanged words on which scripts rely. Other text is returned as it is."""
    with words_of_files():
        return translated(text)


@contextmanager
def written_as(course: CourseNotation) -> Iterator[None]:
    """Use a language and notation inside the `with` block."""
    before = _course.set(course)
    try:
        yield
    finally:
        _course.reset(before)


def speak(language: str) -> None:
    """Set the language until the end of the enclosing `spoken` block."""
    _course.set(replace(_course.get(), language=language))


def write(frame: str, inertia: str) -> None:
    """Set the number of the frame and the letter of inertia forces until the end of the enclosing `spoken` block."""
    _course.set(replace(_course.get(), frame=frame, inertia=inertia))


def speaking(course: CourseNotation, work: Callable[[], Found]) -> Found:
    """Call a function in the language and notation of a course, e.g. in another process."""
    with written_as(course):
        return work()
