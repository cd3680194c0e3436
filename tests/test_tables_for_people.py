"""Tables for spreadsheets of people: the figures of a terminal, in their language; nothing in them is run."""

import io
import zipfile
from itertools import chain

import numpy as np
import pytest
from python_calamine import CalamineWorkbook

from tmm_cli import load, solve
from tmm_cli.language import spoken
from tmm_cli.mechanics.quantities import FORCE, LENGTH
from tmm_cli.problem import UnitSystem
from tmm_cli.reports import Column, Table, local_csv, write_results, write_workbook

UNITS = UnitSystem()
HOSTILE = ("=1+1", "+1", "@SUM(A1)", "-2+3", "\t=1", "http://example.org", "1e400", "{=A1}")


@pytest.fixture(scope="module")
def shaper():
    return solve(load("problems/shaper.yaml"))


def sheets(data):
    book = CalamineWorkbook.from_filelike(io.BytesIO(data))
    return {name: book.get_sheet_by_name(name).to_python() for name in book.sheet_names}


def lines(table):
    return "".join(local_csv(table, UNITS)).removeprefix("\ufeff").splitlines()


def test_numbers_are_numbers_with_the_figures_of_a_terminal():
    table = Table("t", "T", (Column("x", np.array([0.1234567891, 1e-20, np.nan]), LENGTH),))
    (rows,) = sheets(write_workbook([table], UNITS)).values()
    assert rows[:4] == [["T"], ["x, mm"], [123.457], [0.0]]
    assert lines(table) == ['"x, mm"', "123,457", "0", ""]


def test_a_number_has_no_figure_that_is_not_true():
    column = Column("F", np.array([1234.56789]), FORCE, bound=np.array([3.0]))
    assert lines(Table("t", "T", (column,)))[1] == "1230"


def test_units_are_printed_in_the_language():
    table = Table("t", "T", (Column("F", np.array([1.0]), FORCE), Column("x", np.array([1.0]), LENGTH)))
    with spoken("ru"):
        assert lines(table)[0] == '"F, Н";"x, мм"'


@pytest.mark.parametrize("text", HOSTILE)
def test_texts_of_files_are_texts(text):
    table = Table("t", text, (Column(text, [text]),), notes=(text,))
    data = write_workbook([table], UNITS)
    with zipfile.ZipFile(io.BytesIO(data)) as parts:
        (sheet,) = (parts.read(name).decode() for name in parts.namelist() if name.startswith("xl/worksheets/sheet"))
    assert "<f>" not in sheet and "hyperlink" not in sheet
    (rows,) = sheets(data).values()
    assert text in list(chain.from_iterable(rows))
    assert not lines(table)[1].startswith(("=", "+", "-", "@", "\t"))


def test_every_table_has_a_sheet_with_a_name_of_its_own(shaper, tmp_path):
    folder = write_results(shaper, tmp_path, spreadsheets="xlsx").folder
    found = sheets((folder / "tables.xlsx").read_bytes())
    assert len(found) == len(list(folder.glob("*.csv")))
    assert all(len(name) <= 31 for name in found)


def test_tables_with_decimal_commas_stand_beside_those_of_machines(shaper, tmp_path):
    folder = write_results(shaper, tmp_path, spreadsheets="csv-local").folder
    names = {file.name for file in folder.glob("*.csv")}
    ours = {name for name in names if name.endswith("-local.csv")}
    assert ours == {name.replace(".csv", "-local.csv") for name in names - ours}
    assert (folder / "cycle-local.csv").read_bytes().startswith(b"\xef\xbb\xbf")


def test_what_an_earlier_run_wrote_for_people_goes_with_it(shaper, tmp_path):
    write_results(shaper, tmp_path, spreadsheets="xlsx")
    assert write_results(shaper, tmp_path).removed == ["tables.xlsx"]


def test_sheets_are_named_by_whole_words():
    titles = (
        "Asked for: four-bar-by-k",
        "Loads: weights and forces of inertia",
        "Balance of powers and of works over the whole cycle",
    )
    data = write_workbook([Table(str(k), title, (Column("x", [1.0]),)) for k, title in enumerate(titles)], UNITS)
    assert list(sheets(data)) == ["Asked for", "Loads", "Balance of powers"]
