"""Templates of problem files for `tmm new`. Every *.yaml file in this folder is a template; its title describes it.

Templates are written in English. Titles, link names and comments are translated by means of translations/words.yaml;
everything else is the same in every language.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable
from importlib.resources import files

import yaml

from tmm_cli.language import ENGLISH

WIDTH = 120  # columns of a file
_COMMENT = re.compile(r"( *)# (.*)")
_KEY = re.compile(r" {3,}|(?:[a-z_]+|\w): ")  # of a comment that is a line of the file to be taken instead
_HEADING = re.compile(r"[A-Z]\w+[:.] ")  # of a paragraph of comments
_WORDS = re.compile(r"(?<=^title: )(.+)|(?<=\bname: )([^,}]+)")

Translate = Callable[[str], str]


def list_templates(language: str = ENGLISH) -> dict[str, str]:
    """Return the titles of all templates in a language, by name of the template."""
    translate, titles_by_name = _translator(language), {}
    for entry in sorted(files(__name__).iterdir(), key=lambda e: e.name):
        if entry.name.endswith(".yaml"):
            titles = [x for x in entry.read_text(encoding="utf-8").splitlines() if x.startswith("title:")]
            titles_by_name[entry.name.removesuffix(".yaml")] = translate(titles[0].removeprefix("title:").strip())
    return titles_by_name


def template_text(name: str, language: str = ENGLISH, file: str | None = None) -> str:
    """Return the text of a template with its comments in a language.

    Args:
        name: name of the template.
        language: language code.
        file: name of the new file, for the command in the first comment.
    """
    text = files(__name__).joinpath(f"{name}.yaml").read_text(encoding="utf-8")
    first, rest = text.split("\n", 1)
    first = first.replace(f"{name}.yaml", "{file}")
    if language != ENGLISH:
        translate = _translator(language)
        first = "# " + translate(first.removeprefix("# "))
        rest = "\n".join(_translate_lines(rest.split("\n"), translate))
        rest = re.sub("^# lang: en", f"lang: {language}  ", rest, count=1, flags=re.MULTILINE)
    return f"{first}\n{rest}".replace("{file}", file or f"{name}.yaml")


def load_translations() -> list[dict[str, str]]:
    """Load the texts of the templates; each entry contains one text in every language, by language code."""
    text = files(__name__).joinpath("translations/words.yaml").read_text(encoding="utf-8")
    entries: list[dict[str, str]] = yaml.safe_load(text)
    return entries


def _translator(language: str) -> Translate:
    if language == ENGLISH:
        return lambda text: text
    texts = {entry["en"]: entry[language] for entry in load_translations()}
    return texts.__getitem__


def _translate_lines(lines: list[str], translate: Translate) -> list[str]:
    """Translate the lines of a template.

    A comment of several lines is translated as one paragraph and wrapped again. A comment behind a value is translated
    separately.
    """
    translated_lines: list[str] = []
    paragraph: list[str] = []
    indent = ""
    for number, line in enumerate([*lines, ""]):
        comment = _COMMENT.fullmatch(line)
        prose = comment is not None and not _KEY.match(comment[2])
        if paragraph and (not prose or number == 1 or _HEADING.match(comment[2] if comment else "")):
            mark = f"{indent}# "
            text = translate(" ".join(paragraph))
            translated_lines += textwrap.wrap(
                text,
                WIDTH,
                initial_indent=mark,
                subsequent_indent=mark,
                break_long_words=False,
                break_on_hyphens=False,
            )
            paragraph = []
        if comment is not None and prose:
            indent, paragraph = comment[1], [*paragraph, comment[2]]
            continue
        start = line.find(" # ", comment.end(1) + 2 if comment else 0)
        value, behind = (line, "") if start < 0 else (line[: start + 3], translate(line[start + 3 :]))
        translated_lines.append(_WORDS.sub(lambda word: translate(word[0]), value) + behind)
    return translated_lines[:-1]
