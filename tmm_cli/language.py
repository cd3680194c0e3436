"""The language in which people are spoken to: sentences marked for gettext, and who speaks which language.

A sentence stands in English at the place that says it, as `_("...")`, and is said in the language that is spoken
there and then. What must be named when a module is imported, or is kept in results, is a phrase, `N_("...")`, and
translated where it is shown. Translations are in `locale/`.

Files for programs (CSV, result.json) are written in English, `with words_of_files(): ...`. Scripts rely on their
headings and words, so these stay when a sentence gets better English: the catalogue `files` keeps what files say.
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
    """How a course writes: its language, the number of the frame, the letter of inertia forces ("": the language's).

    for_programs: with the words on which scripts rely (`words_of_files`).
    """

    language: str = ENGLISH
    frame: str = "0"
    inertia: str = ""
    for_programs: bool = False


USUAL: Final = CourseNotation()
_course: ContextVar[CourseNotation] = ContextVar("course", default=USUAL)


class Phrase(str):
    """A marked sentence, perhaps with fields put in: English to all that read it, until it is `translated`."""

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
    """A phrase in the language that is spoken, with the phrases in its fields; a name or a title as it is."""
    if not isinstance(text, Phrase) or _name_of_catalogue() == ENGLISH:
        return text
    message = _(text.message)
    return message.format(**{key: translated(own) for key, own in text.fields.items()}) if text.fields else message


def _(message: str) -> str:
    """The sentence in the language that is spoken; in English where it is not translated."""
    name = _name_of_catalogue()
    return message if name == ENGLISH or not message else _catalogue(name).gettext(message)


def _name_of_catalogue() -> str:
    """The language, or FILES in files for programs."""
    course = _course.get()
    return FILES if course.for_programs else course.language


def numeral(value: float, form: str) -> str:
    """A number for people in this format, with a comma where the language has one. What may be typed has points."""
    text = f"{half_up(value):{form}}"
    return text if language() == ENGLISH else text.replace(".", ",")


def half_up(value: float) -> float:
    """The same, so little larger that what ends in a five is rounded away from zero, whatever its last bits are."""
    return value * (1 + TIE)


def filled(sentence: str, **parts: Any) -> tuple[Any, ...]:
    """A sentence in pieces: with a part, such as a symbol, or several ones (a tuple) in the places of its {names}."""
    found: list[Any] = []
    for before, name, *__ in string.Formatter().parse(sentence):
        found += [before] if before else []
        if name:
            found += parts[name] if isinstance(parts[name], tuple) else [parts[name]]
    return tuple(found)


def signed(text: str) -> str:
    """A text whose numbers have a minus sign for their hyphen."""
    return MINUS.sub("−", text)


def typeset(text: str) -> str:
    """A text with the signs that are printed for those of a keyboard: 3·5 − 2·7 = 1 for 3*5 - 2*7 = 1, → for ->.

    Hyphens are minus signs in formulas, and dashes between the two links of a pair; else they stay, so that a number
    may be taken over.
    """
    text = text.replace("->", "→")
    if FORMULA.search(text):
        text = signed(text.replace(" - ", " − "))
    text = re.sub(r"(?<=\d)\*(?=\d)", "·", PAIR.sub(" – ", text))
    return re.sub(r"(?<=\d) °(?!/)", "°", text)


def spelt(unit: str) -> str:
    """A unit as the language spells it: rad/s is рад/с in Russian, rpm is o/min in Serbian."""
    if language() == ENGLISH:
        return unit
    return re.sub(r"[A-Za-zµμ°]+", lambda name: _in_context("unit", name[0]), unit)


def symbol(letter: str) -> str:
    """The letter that a course in this language writes: of a force of inertia U in English, Φ in Russian."""
    own = INERTIA.get(_course.get().inertia, {})
    return own[letter] if letter in own else _in_context("symbol", letter)


def printed(link: str) -> str:
    """The number of a link as the course prints it; only that of the frame, link "0", may be another one."""
    return _course.get().frame if link == "0" else link


def _in_context(context: str, message: str) -> str:
    name = _name_of_catalogue()
    return message if name == ENGLISH or not message else _catalogue(name).pgettext(context, message)


def _catalogue(language: str) -> NullTranslations:
    """The translations of a language, read once."""
    if language not in CATALOGUES:
        from gettext import GNUTranslations  # English needs none

        path = LOCALE / language / "LC_MESSAGES" / f"{DOMAIN}.mo"
        if not path.exists():
            raise FileNotFoundError(ENOENT, "the translations are not compiled: pip install -e . does it", str(path))
        with path.open("rb") as stream:
            CATALOGUES[language] = GNUTranslations(stream)
    return CATALOGUES[language]


def language() -> str:
    """The language that is spoken here and now."""
    return _course.get().language


def course() -> CourseNotation:
    """How is written here and now."""
    return _course.get()


@contextmanager
def spoken(language: str) -> Iterator[None]:
    """Speak a language inside; a sentence is said where it is made, so nothing may be left to be made later."""
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
    """Write inside as a course does."""
    before = _course.set(course)
    try:
        yield
    finally:
        _course.reset(before)


def speak(language: str) -> None:
    """Speak a language from here to the end of the `spoken` around."""
    _course.set(replace(_course.get(), language=language))


def write(frame: str, inertia: str) -> None:
    """Write so from here to the end of the `spoken` around: the number of the frame, the letter of inertia forces."""
    _course.set(replace(_course.get(), frame=frame, inertia=inertia))


def speaking(course: CourseNotation, work: Callable[[], Found]) -> Found:
    """What some work gives when it writes as this course does; for work that goes to another process."""
    with written_as(course):
        return work()
