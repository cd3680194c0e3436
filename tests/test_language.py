"""Sentences are said in the language of who reads them, and files for machines in English."""

import ast
import re
from collections.abc import Iterator
from fnmatch import fnmatch
from functools import cache
from gettext import NullTranslations
from pathlib import Path

import pytest
import typer
from test_commands import tmm

from tests import messages
from tmm_cli import load, solve
from tmm_cli.cli import accuracy_of, for_each_file, open_problem, with_language_option
from tmm_cli.drawing.paper import filling_axis
from tmm_cli.language import CATALOGUES, N_, Phrase, _, language, numeral, spoken, translated
from tmm_cli.mechanics.forces import balance_symbol, load_symbols
from tmm_cli.mechanics.quantities import DIMENSIONS
from tmm_cli.problem import UnitSystem, parse_unit
from tmm_cli.reports import write_results

KEPT, UPDATED = cache(messages.catalogue), cache(messages.updated)  # read once for all tests


def said_at_import(tree: ast.AST) -> Iterator[int]:
    """Lines on which `_()` or `translated()` is called when the module is imported."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            now = [*node.args.defaults, *(d for d in node.args.kw_defaults if d), *getattr(node, "decorator_list", [])]
            for part in now:
                yield from said_at_import(ast.Expression(part))
            continue
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("_", "translated"):
            yield node.lineno
        yield from said_at_import(node)


def test_no_sentence_is_said_when_a_module_is_imported():
    # who will read it is not known yet: it is marked N_() there, and said where it is used
    found = [(file.name, line) for file in messages.sources() for line in said_at_import(messages.parsed(file))]
    assert found == []


def test_a_phrase_is_its_english_sentence_until_it_is_translated():
    phrase = Phrase("output angle {number}", number=3)
    assert phrase == "output angle 3"
    assert translated(phrase) == "output angle 3"
    assert translated(N_("a {brace} that is meant")) == "a {brace} that is meant"


def test_a_language_is_spoken_inside_only():
    with spoken("ru"):
        assert language() == "ru"
        with spoken("en"):
            assert _("position") == "position"
        assert language() == "ru"
    assert language() == "en"


@pytest.mark.parametrize("tongue", messages.TRANSLATED)
def test_a_translation_has_the_fields_of_its_message(tongue):
    for message in KEPT(tongue):
        if message.id and message.string:
            assert messages.fields(message.string) == messages.fields(message.id), message.id


@pytest.mark.parametrize("tongue", messages.FINISHED)
def test_every_message_is_translated(tongue):
    assert messages.missing(UPDATED(tongue)) == []  # python -m tests.messages writes them down


@pytest.mark.parametrize("tongue", messages.FINISHED)
def test_a_catalogue_has_no_message_that_is_said_no_more(tongue):
    here, there = (messages.translations(found) for found in (UPDATED(tongue), KEPT(tongue)))
    assert set(there) == set(here)


@pytest.mark.parametrize("tongue", messages.TRANSLATED)
def test_what_the_program_reads_is_made_of_the_catalogue(tongue):
    assert messages.read(tongue) == messages.translations(KEPT(tongue))


class Cyrillic(NullTranslations):
    """Translates everything that is marked: each Latin letter into a Cyrillic one, fields as they are."""

    def gettext(self, message):
        return "".join(
            part if part.startswith("{") else re.sub("[A-Za-z]", "ж", part) for part in re.split(r"({[^{}]*})", message)
        )

    def pgettext(self, context, message):
        return f"{message}_Φ" if context == "symbol" else self.gettext(message)


@pytest.fixture
def all_translated(monkeypatch):
    """Russian in which nothing that is marked stays English."""
    monkeypatch.setitem(CATALOGUES, "ru", Cyrillic())


@pytest.mark.parametrize("problem", ["shaper", "crank-rocker-synthesis", "planetary-dwell-press"])
def test_files_for_machines_are_the_same_in_every_language(problem, tmp_path, all_translated):
    found = {}
    for tongue in ("en", "ru"):
        with spoken(tongue):
            results = solve(load(f"problems/{problem}.yaml"))
            folder = write_results(results, tmp_path / tongue, digits=accuracy_of(results, True)).folder
        found[tongue] = {file.name: file.read_bytes() for file in folder.iterdir()}
    assert len(found["en"]) > 5
    assert found["en"] == found["ru"]


def test_a_file_says_in_which_language_it_speaks_and_the_command_overrides_it(tmp_path, capfd):
    file = tmp_path / "press.yaml"
    text = Path("problems/crank-slider.yaml").read_text().replace("tmm: 1", "tmm: 1\nlang: ru", 1)
    file.write_text(text, encoding="utf-8")
    heard = []

    def work(name):
        heard.append((open_problem(name), language())[1])
        return 0

    for asked, files in (None, [str(file), "problems/crank-slider.yaml"]), ("sr", [str(file)]):
        with pytest.raises(typer.Exit):
            with_language_option(lambda files=files: for_each_file(files, work))(lang=asked)
    assert heard == ["ru", "en", "sr"]
    assert language() == "en"


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"tmm: 1\nlang: ru\ntitle: a: b\n", "x.yaml:3:9: здесь не может быть ':'"),
        (b"\xef\xbb\xbf{tmm: 1,\n 'lang': 'ru',\n title: [1, 2}\n", "x.yaml:3:9: '[' не закрыта"),
        (b"title: a\ttmm: 1\nlang: sr # srpski\n\ttmm: 1\n", "x.yaml:3:1: za uvlačenje je upotrebljen tabulator"),
        (b'tmm: 1\ntitle: "\xcf\xf0"\nlang: sr\n', "x.yaml:2:9: fajl nije tekst u kodiranju UTF-8"),
        (b"tmm: 1\ntitle: a: b # lang: ru\n", "x.yaml:2:9: a ':' is not allowed here"),
    ],
)
@pytest.mark.parametrize("command", ["structure", "grade", "variants"])
def test_a_file_that_cannot_be_read_is_refused_in_its_language(tmp_path, content, told, command):
    (tmp_path / "x.yaml").write_bytes(content)
    ended = tmm(command, "x.yaml", *(["--template", "sheet.csv"] if command == "grade" else []), cwd=tmp_path)
    assert ended.returncode == 2
    assert told in ended.stderr.splitlines()[0]


TO_PEOPLE = (
    "drawing",
    "mechanics/plans",
    "note",
    "animation",
    "cli",
    "grading/exports",
    "reports/structure_t",
    "reports/space_t",
    "reports/cycle_t",
    "reports/quality_t",
    "reports/force_t",
    "reports/dynamics_t",
    "reports/synthesis_t",
)
TO_MACHINES = {  # files whose numbers are no words for people, or are rounded only
    "drawing/formats/*",
    "animation/page.py",
    "animation/content.py",
    "grading/exports/csv_files.py",
    "cli/bench/*",
    "grading/exports/rows.py",
    "grading/exports/xlsx.py",
    "grading/exports/book.py",
    "note/expression.py",
}


def decimals(tree: ast.AST) -> Iterator[int]:
    """Lines that format a number with decimals: `{value:.4g}`; not where it is made a number again."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("float", "numeral"):
            continue
        if isinstance(node, ast.FormattedValue) and node.format_spec is not None:
            form = "".join(part.value for part in node.format_spec.values if isinstance(part, ast.Constant))
            if re.search(r"\.(?!0f)\d*[gfe]$", form):
                yield node.lineno
        yield from decimals(node)


def test_numbers_for_people_have_the_decimal_mark_of_their_language():
    found = {}
    for file in messages.sources():
        name = file.relative_to(messages.PACKAGE).as_posix()
        if name.startswith(TO_PEOPLE) and not any(fnmatch(name, known) for known in TO_MACHINES):
            found |= {f"{name}:{line}": line for line in decimals(messages.parsed(file))}
    assert not found  # numeral(value, ".4g") writes them


@pytest.mark.parametrize(
    ("tongue", "unit", "spelling"),
    [("ru", "rpm", "об/мин"), ("ru", "kg*m^2", "кг·м²"), ("sr", "rpm", "o/min"), ("en", "kg*m^2", "kg*m^2")],
)
def test_a_unit_is_spelt_as_the_language_spells_it_and_read_so_too(tongue, unit, spelling):
    kind = next(kind for kind in DIMENSIONS.values() if parse_unit(unit).dimension == kind.dimension)
    units = UnitSystem({kind.dimension.name: unit})
    with spoken(tongue):
        assert units.spelt(kind.dimension) == spelling
    assert parse_unit(spelling) == parse_unit(unit)


def test_numbers_for_people_have_a_comma_where_the_language_has_one():
    assert numeral(1234.5678, ".6g") == "1234.57"
    for tongue in ("ru", "sr"):
        with spoken(tongue):
            assert numeral(1234.5678, ".6g") == "1234,57"
            assert [text for __, text in filling_axis(0, 1, 0, 100).ticks(5)][1] == "0,05"


def test_letters_are_those_of_the_course():
    (inertia,) = (one for one in solve(load("problems/shaper.yaml")).loads if one.name == "U3")
    assert [symbol.plain for symbol in load_symbols(inertia)] == ["U3", "M3"]
    with spoken("ru"):
        assert [symbol.plain for symbol in load_symbols(inertia)] == ["Φ3", "MΦ3"]
        assert balance_symbol("1", several=False, turns=True).plain == "Mу"


def test_words_that_stay_in_files_are_those_of_messages_of_today():
    kept = messages.read("files")
    assert set(kept) <= {(context or None, text) for context, text, __ in messages.messages()}
    assert all(text != word for (__, text), word in kept.items())
