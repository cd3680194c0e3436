"""What is written for people has no English word of the program: all is marked for translation.

Each marked sentence is translated into a word of Cyrillic letters; Latin words that are left are names of the file, or
signs that are the same in every language.
"""

import re
from functools import cache
from itertools import chain

import pytest

from tests.test_language import Cyrillic
from tmm_cli import load, solve
from tmm_cli.animation import chart_quantities
from tmm_cli.drawing.run import all_sheets, position_remarks
from tmm_cli.language import CATALOGUES, spoken
from tmm_cli.note import html, note
from tmm_cli.reports import (
    collect_warnings,
    explain_tables,
    find_slips,
    narrate_structure,
    spreadsheet_cells,
    summarise_file,
    tables,
)

PROBLEMS = ("shaper", "planetary-dwell-press", "crank-rocker-synthesis", "press-class-iii", "cylinder", "valve-drive")
WORD = re.compile(r"(?<!\w)[A-Za-z]{3,}(?!\w)")
SIGNS = {"cos", "sin", "max", "min", "III", "VII", "tmm"}
GROUP = re.compile(r"[RPGKC]{2,}")  # by its pairs: RRP


@pytest.fixture(scope="module", autouse=True)
def foreign():
    kept = CATALOGUES.get("ru")
    CATALOGUES["ru"] = Cyrillic()
    yield
    del CATALOGUES["ru"]
    if kept is not None:
        CATALOGUES["ru"] = kept


@cache
def solved(problem):
    """In the language of these tests."""
    return solve(load(f"problems/{problem}.yaml"))


def left(texts, problem):
    """Latin words that are neither names of the file nor signs."""
    with open(f"problems/{problem}.yaml", encoding="utf-8") as stream:
        own = set(WORD.findall(stream.read()))
    words = {word for text in texts for word in WORD.findall(text)}
    return {word for word in words - own - SIGNS if not GROUP.fullmatch(word)}


def of_tables(found, units):
    for table in found:
        yield table.title
        yield from table.notes
        yield from (column.heading(units) for column in table.columns)
        yield from (
            cell for column in table.columns for cell in spreadsheet_cells(column, units) if isinstance(cell, str)
        )


def drawn(results, problem):
    return chain.from_iterable(drawing.texts() for __, drawing in all_sheets(results))


def tabled(results, problem):
    structure = solve(load(f"problems/{problem}.yaml"), "structure")
    return of_tables([*tables(results), *explain_tables(structure, True)], results.problem.units)


def said(results, problem):
    return (
        *summarise_file(results.problem),
        *find_slips(results.problem),
        *collect_warnings(results),
        *narrate_structure(results),
        *position_remarks(results),
    )


def noted(results, problem):
    page = html(note(results, drawn=False)).decode()
    return [re.sub(r"<(style|script|head|math)\b.*?</\1>|<[^>]*>", " ", page, flags=re.DOTALL)]


def charted(results, problem):
    return (one.words for one in chart_quantities(results, results))


@pytest.mark.parametrize("way", [drawn, tabled, said, noted, charted], ids=lambda way: way.__name__)
@pytest.mark.parametrize("problem", PROBLEMS)
def test_no_word_is_left_in_english(problem, way):
    with spoken("ru"):
        assert left(way(solved(problem), problem), problem) == set()
