"""Tables as other programs write them, and files that only look like tables."""

from __future__ import annotations

import io
import subprocess
import sys
import zipfile

import pytest
import xlsxwriter

from tmm_cli.grading import read_rows, untrusted_tables as cells
from tmm_cli.problem import ProblemError

ROWS = [["студент", "OA, mm"], ["Ана", "80,5"]]


@pytest.mark.parametrize(
    "data",
    [
        'студент,"OA, mm"\r\nАна,"80,5"\r\n'.encode(),
        "студент;OA, mm\nАна;80,5\n\n".encode(),
        "\ufeffстудент;OA, mm\r\n;\r\nАна;80,5".encode(),
        "студент;OA, mm\nАна;80,5\n".encode("cp1251"),
        "студент\tOA, mm\nАна\t80,5\n".encode("utf-16"),
        'sep=;\nстудент;"OA, mm"\nАна; 80,5\n'.encode(),
    ],
)
def test_csv_of_all_kinds_is_one_table(data, tmp_path):
    path = tmp_path / "table.csv"
    path.write_bytes(data)
    assert read_rows(path) == ROWS


def test_a_single_column_keeps_its_decimal_commas(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("OA\n80,5\n")
    assert read_rows(path) == [["OA"], ["80,5"]]


def book(path, content):
    with xlsxwriter.Workbook(path) as written:
        sheet = written.add_worksheet()
        for place, value, *kept in content:
            sheet.write(place, value, None, *kept)
    return path


def test_an_xlsx_gives_numbers_texts_and_values_of_formulas(tmp_path):
    path = book(tmp_path / "t.xlsx", [("A1", "OA"), ("B1", "n1"), ("A2", 80.5), ("B2", "=2*A2", 161), ("A4", 7)])
    assert read_rows(path) == [["OA", "n1"], ["80.5", "161"], ["7", ""]]


def packed(path, parts):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as into:
        for name, content in parts.items():
            into.writestr(name, content)
    return path


def refusal(path):
    with pytest.raises(ProblemError) as caught:
        read_rows(path)
    return str(caught.value).removeprefix(f"{path}: ")


def test_what_only_looks_like_a_table_is_refused(tmp_path):
    bomb = packed(tmp_path / "bomb.xlsx", {"xl/sharedStrings.xml": b"0" * 30_000_000})
    assert refusal(bomb) == ("the unpacked file is far larger than a table can be\n  allowed: a smaller file")
    far = book(tmp_path / "far.xlsx", [("A1", 1), ("B12000", 1)])
    assert (
        refusal(far) == "a cell is outside the permitted range\n  found:   'B12000'\n  allowed: 10000 rows, 500 columns"
    )
    copies = book(tmp_path / "c.xlsx", [(f"A{n + 1}", "x" * 32_000) for n in range(9000)])
    assert refusal(copies).startswith("the unpacked file is far larger")
    macros = packed(tmp_path / "macros.xlsx", {"xl/vbaProject.bin": b""})
    assert refusal(macros) == "the file contains macros: save it as .xlsx without macros"
    linked = packed(tmp_path / "linked.xlsx", {"xl/externalLinks/externalLink1.xml": b""})
    assert refusal(linked) == "the file refers to other files: replace the references by their values"
    empty = packed(tmp_path / "empty.xlsx", {"a.txt": b""})
    assert refusal(empty) == "this is not an XLSX file\n  allowed: a table in CSV or XLSX format"
    (tmp_path / "cut.xlsx").write_bytes(far.read_bytes()[:900])
    assert refusal(tmp_path / "cut.xlsx").startswith("the XLSX file is damaged: ")


def rewritten(path, sheet):
    """A sound workbook with another text for its sheet."""
    with zipfile.ZipFile(book(path, [("A1", 1)])) as sound:
        parts = {name: sound.read(name) for name in sound.namelist()}
    return packed(path, {**parts, "xl/worksheets/sheet1.xml": SHEET.replace(b"ROWS", sheet)})


SHEET = b'<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>ROWS</sheetData></worksheet>'


@pytest.mark.parametrize(
    "row",
    [
        b"<c><v>1</v></c>",  # its place is that of the one before and one more: no bound
        b"""<c a=' r="A1"'><v>1</v></c>""",
        b'<c r="&#65;1"><v>1</v></c>',
        b'<x:c xmlns:x="a"><v>1</v></x:c>',
    ],
)
def test_cells_that_do_not_say_where_they_stand_are_not_counted_through(row, tmp_path):
    told = "a cell has no address\n  allowed: a file saved by a spreadsheet program"
    assert refusal(rewritten(tmp_path / "t.xlsx", b"<row>" + row + b"</row>")) == told


def test_a_place_may_stand_behind_other_attributes(tmp_path):
    assert read_rows(rewritten(tmp_path / "t.xlsx", b"<row r='2'><c s = '0' r = 'B2'><v>1.5</v></c></row>")) == [
        ["1.5"]
    ]


SHARED = '<sst xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" {count}><si><t>OA</t></si></sst>'


@pytest.mark.parametrize(
    "count", ['count="1" uniqueCount="4294967295"', "uniqueCount='200'", 'count="999999999999999"']
)
def test_more_texts_than_the_file_holds_are_refused_before_it_is_read(count, tmp_path):
    path = tmp_path / "t.xlsx"
    with zipfile.ZipFile(book(path, [("A1", "OA")])) as sound:
        parts = {name: sound.read(name) for name in sound.namelist()}
    path = packed(path, {**parts, "xl/sharedStrings.xml": SHARED.format(count=count)})
    assert refusal(path).startswith(
        "the XLSX file is damaged: it states a larger number of cells or texts than it contains\n  found:   '"
    )


@pytest.mark.parametrize("ref", ["A1:B2000000", "A1:ZZZ3", "A0", "A1:B99999999999"])
def test_a_range_that_no_sheet_has_is_refused(ref, tmp_path):
    sheet = SHEET.replace(b"<sheetData>", f'<dimension ref="{ref}"/><sheetData>'.encode())
    path = rewritten(tmp_path / "t.xlsx", b"<row r='1'><c r='A1'><v>1</v></c></row>")
    with zipfile.ZipFile(path) as sound:
        parts = {name: sound.read(name) for name in sound.namelist()}
    parts["xl/worksheets/sheet1.xml"] = sheet.replace(b"ROWS", b"<row r='1'><c r='A1'><v>1</v></c></row>")
    assert refusal(packed(path, parts)) == (
        f"the XLSX file is damaged: it states a larger number of cells or texts than it contains\n  found:   '{ref}'\n"
        "  allowed: a file saved by a spreadsheet program"
    )


def test_a_file_that_ends_the_process_which_reads_it_is_refused_and_the_next_one_is_read(tmp_path, capfd, monkeypatch):
    path = tmp_path / "t.xlsx"
    with zipfile.ZipFile(book(path, [("A1", "OA")])) as sound:
        parts = {name: sound.read(name) for name in sound.namelist()}
    many = SHARED.format(count='uniqueCount="4294967295"')  # memory for so many texts is reserved
    path = packed(path, {**parts, "xl/sharedStrings.xml": many})
    limited = "import resource, sys, python_calamine; resource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31)); "
    read = [sys.executable, "-c", limited + "python_calamine.load_workbook(sys.argv[1])", str(path)]
    if subprocess.run(read, capture_output=True).returncode == 0:
        pytest.skip("this version of python-calamine reserves no memory by what a file announces")
    with monkeypatch.context() as blind:
        blind.setattr(cells, "_inspect_archive", lambda *unused: None)
        told = (
            "the file cannot be read: it requires too much memory or crashes the program\n"
            "  allowed: a table in CSV format"
        )
        assert [refusal(path), refusal(path)] == [told, told]
    assert read_rows(book(tmp_path / "sound.xlsx", [("A1", "OA")])) == [["OA"]]
    assert capfd.readouterr().err == ""


def test_other_spreadsheets_than_xlsx_are_not_read_as_one(tmp_path):
    repeated = b'<table:table-cell table:number-columns-repeated="16384" office:value="1"/>'
    path = packed(tmp_path / "ods.xlsx", {"mimetype": b"application/vnd.oasis", "content.xml": repeated})
    assert refusal(path) == "this is not an XLSX file\n  allowed: a table in CSV or XLSX format"


def test_a_packed_size_that_lies_is_no_sound_file(tmp_path):
    stream = io.BytesIO()
    packed(stream, {"xl/workbook.xml": b"0" * 1_000_000})
    lying = tmp_path / "lying.xlsx"
    lying.write_bytes(stream.getvalue().replace((1_000_000).to_bytes(4, "little"), (10).to_bytes(4, "little")))
    assert refusal(lying).startswith("the XLSX file is damaged: ")


def test_files_that_are_no_tables_are_refused(tmp_path):
    (tmp_path / "own.csv").write_text("a\n")
    (tmp_path / "link.csv").symlink_to(tmp_path / "own.csv")
    assert refusal(tmp_path / "link.csv") == "this is not a regular file but a link, a folder or a device"
    assert refusal(tmp_path / "none.csv") == "there is no such file"
    (tmp_path / "old.xls").write_bytes(b"\xd0\xcf\x11\xe0\x00\x00")
    assert refusal(tmp_path / "old.xls") == "this is not a text file\n  allowed: a table in CSV or XLSX format"
    (tmp_path / "large.csv").write_text("1" * 2_000_001)
    assert refusal(tmp_path / "large.csv") == "the file is too large\n  found:   2000001\n  allowed: at most 2000000"
    (tmp_path / "rows.csv").write_text("1\n" * 10_001)
    assert refusal(tmp_path / "rows.csv") == "there are too many rows\n  allowed: at most 10000"
    (tmp_path / "wide.csv").write_text("1," * 501)
    assert refusal(tmp_path / "wide.csv") == "there are too many columns\n  found:   502\n  allowed: at most 500"
    (tmp_path / "cell.csv").write_text('"' + "1\n" * 4000)
    assert refusal(tmp_path / "cell.csv") == "the text in a cell is too long\n  found:   7999\n  allowed: at most 5000"
