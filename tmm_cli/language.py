"""Languages of messages and notation of courses: messages marked for gettext, and the current language.

A message is written in English where it is used, as `_("...")`, and translated into the current language
there. A message that is needed when a module is imported, or is kept in results, is a phrase,
`N_("...")`, and translated where it is shown. Translations are in `locale/`.

Files for programs (CSV, result.json) are written in English, `with words_of_files(): ...`. Scripts rely
on their headings and words, so these stay when a message gets better English: the catalogue `files` keeps
the words of files.
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
    """Notation of a course: language, number of the frame, letter of inertia forces ("": that of the language)."""

    language: str = ENGLISH
    frame: str = "0"
    inertia: str = ""
    for_programs: bool = False


USUAL: Final = CourseNotation()
_course: ContextVar[CourseNotation] = ContextVar("course", default=USUAL)


class Phrase(str):
    """Message for later translation, with fields; as a str it is English, `translated` gives the current
    language.
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
    """Translate a Phrase, and the phrases in its fields, into the current language; return other text unchanged."""
    if not isinstance(text, Phrase) or _name_of_catalogue() == ENGLISH:
        return text
    message = _(text.message)
    return message.format(**{key: translated(own) for key, own in text.fields.items()}) if text.fields else message


def _(message: str) -> str:
    """Translate a message into the current language; untranslated messages stay English."""
    name = _name_of_catalogue()
    return message if name == ENGLISH or not message else _catalogue(name).gettext(message)


def _name_of_catalogue() -> str:
    """The language, or FILES in files for programs."""
    course = _course.get()
    return FILES if course.for_programs else course.language


def numeral(value: float, form: str) -> str:
    """Format a number for people, with a decimal comma where the language has one; input that may be typed keeps
    its point.
    """
    text = f"{half_up(value):{form}}"
    return text if language() == ENGLISH else text.replace(".", ",")


def half_up(value: float) -> float:
    """Increase a value slightly so that a final five is rounded away from zero, whatever its last bits are."""
    return value * (1 + TIE)


def filled(sentence: str, **parts: Any) -> tuple[Any, ...]:
    """Split a message at its fields and insert objects such as symbols, or tuples of them."""
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

    Hyphens become minus signs in formulas, and dashes between the two links of a pair; others stay, so that
    numbers can be copied.
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
    """Return the letter of a quantity in the current notation: inertia force U in English, Φ in Russian."""
    own = INERTIA.get(_course.get().inertia, {})
    return own[letter] if letter in own else _in_context("symbol", letter)


def printed(link: str) -> str:
    """Return the printed number of a link; only that of the frame, "0", depends on the notation."""
    return _course.get().frame if link == "0" else link


def _in_context(context: str, message: str) -> str:
    name = _name_of_catalogue()
    return message if name == ENGLISH or not message else _catalogue(name).pgettext(context, message)


def _catalogue(language: str) -> NullTranslations:
    """Return the translations of a language, read once."""
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
    """Return the current notation."""
    return _course.get()


@contextmanager
def spoken(language: str) -> Iterator[None]:
    """Use a language inside the block; messages are translated where they are made, so none may be made later."""
    with written_as(replace(_course.get(), language=language, for_programs=False)):
        yield


@contextmanager
def words_of_files() -> Iterator[None]:
    """Write English inside, with the headings and words on which scripts rely."""
    with written_as(replace(_course.get(), language=ENGLISH, for_programs=True)):
        yield


def word_of_files(text: str) -> str:
    """A phrase as files for programs have it; a name or a title as it is."""
    with words_of_files():
        return translated(text)


@contextmanager
def written_as(course: CourseNotation) -> Iterator[None]:
    """Use the notation of a course inside the block."""
    before = _course.set(course)
    try:
        yield
    finally:
        _course.reset(before)


def speak(language: str) -> None:
    """Use a language until the end of the enclosing `spoken` block."""
    _course.set(replace(_course.get(), language=language))


def write(frame: str, inertia: str) -> None:
    """Use a frame number and a letter of inertia forces until the end of the enclosing `spoken` block."""
    _course.set(replace(_course.get(), frame=frame, inertia=inertia))


def speaking(course: CourseNotation, work: Callable[[], Found]) -> Found:
    """Call a function in the notation of a course, for work in another process."""
    with written_as(course):
        return work()
