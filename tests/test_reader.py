"""The reader: what YAML means here, where each part stands, and every refusal word for word."""

from __future__ import annotations

import copy
import os
import threading
from pathlib import Path

import pytest
import yaml
from hypothesis import given, strategies as st

from tmm_cli.problem import (
    MAX_BYTES,
    ProblemError,
    SourcePosition,
    WrittenNumber,
    clean,
    decimal_comma_hint,
    nearest_name,
    quote,
    read_file,
    read_text,
    reader as composer,
)


@pytest.fixture(params=[name for name in ("CSafeLoader", "SafeLoader") if hasattr(yaml, name)])
def parser(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of PyYAML's parsers that are here: the C one is not in every build."""
    monkeypatch.setattr(composer, "LOADER", getattr(yaml, request.param))


def refused(text: str) -> str:
    with pytest.raises(ProblemError) as caught:
        read_text(text, "f")
    return str(caught.value)


@pytest.mark.usefixtures("parser")
@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("1.5e3", 1500.0),
        ("12:30", "12:30"),
        ("010", 10),
        ("0o17", 15),
        ("0x1F", 31),
        ("-5", -5),
        ("+.5", 0.5),
        ("5.", 5.0),
        ("true", True),
        ("FALSE", False),
        ("null", None),
        ("~", None),
        ("", None),
        *((word, word) for word in ("on", "off", "yes", "No", "y", "n", "1_000", "2001-01-01", "82 rpm", "=", "1.2.3")),
        ("'5'", "5"),
        ('"1,5"', "1,5"),
        ("№ 7, вариант", "№ 7, вариант"),
        ("[1,5]", [1, 5]),
        ("{a: }", {"a": None}),
    ],
)
def test_scalars_are_yaml_1_2_core(written: str, value: object) -> None:
    found = read_text(f"a: {written}\n", "f").data["a"]
    assert found == value
    assert type(found) is (WrittenNumber if isinstance(value, float) else type(value))


@pytest.mark.parametrize("written", ["38.925549624985472123456789", "1.50", "1.5e3", "5."])
def test_a_number_keeps_the_decimals_it_was_written_with(written: str) -> None:
    found = read_text(f"a: {written}\n", "f").data["a"]
    assert (found.written, repr(found), copy.deepcopy(found).written) == (written, written, written)


@pytest.mark.usefixtures("parser")
def test_keys_stay_as_written() -> None:
    keys = ["1", "010", "on", "y", "n", "null", "1.0", "0x1", "ОА"]
    assert list(read_text("".join(f"{key}: 0\n" for key in keys), "f").data) == keys


@pytest.mark.usefixtures("parser")
def test_every_key_and_value_has_its_place() -> None:
    tree = read_text(
        "\ufefflinks:\r\n  1: {имя: 𝔸, length: [1, x]}\r\n  - \r\n".replace("  - \r\n", "b:\r\n - c: 2\r\n"), "f"
    )
    assert tree.key_marks[("links",)] == SourcePosition(1, 1)
    assert tree.key_marks[("links", "1")] == SourcePosition(2, 3)
    assert tree.marks[("links", "1")] == SourcePosition(2, 6)
    assert tree.key_marks[("links", "1", "length")] == SourcePosition(2, 15)
    assert tree.marks[("links", "1", "length", 1)] == SourcePosition(2, 27)
    assert tree.marks[("b", 0, "c")] == SourcePosition(4, 7)
    assert tree.marks[()] == SourcePosition(1, 1)
    assert len(tree.marks) == len(tree.key_marks) + 4  # the top and three list items


INDENT = "\n  allowed: keys and items of one level begin in the same column, indented by spaces"
ALIAS = "\n  allowed: the value itself, or a parameter; a text that begins with * or & needs quotation marks"
BRACKETS = "\n  allowed: [2 kN, 0] or {a: 1, b: 2}"
AFTER_BRACKET = "\n  allowed: units inside the brackets: [2 kN, 0]; a comment begins with #"
COMMA = "\n  allowed: a decimal point; a list is written [1, 5]"
EMPTY = "f: the file is empty\n  allowed: keys with values, such as 'tmm: 1'"


@pytest.mark.usefixtures("parser")
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", EMPTY),
        ("# only\n# comments\n", EMPTY),
        ("---\n", EMPTY),
        ("\n \n", EMPTY),
        (
            "[1, 2]",
            (
                "f:1:1: the top level of the file must consist of keys with values\n"
                "  found:   [1, 2]\n"
                "  allowed: lines 'key: value'"
            ),
        ),
        (
            "tmm:1",
            (
                "f:1:1: the top level of the file must consist of keys with values\n"
                "  found:   'tmm:1'\n"
                "  allowed: lines 'key: value'"
            ),
        ),
        (
            "a: 1\n---\nb: 2",
            ("f:2:1: the file contains a second document\n  found:   ---\n  allowed: only one document in a file"),
        ),
        (
            "a:\n  k: 1\n  k: 2",
            ("f:3:3: a.k: this key occurs twice\n  found:   'k'\n  allowed: each key once; the first is on line 2"),
        ),
        (
            "1: x\n'1': y",
            ("f:2:1: 1: this key occurs twice\n  found:   '1'\n  allowed: each key once; the first is on line 1"),
        ),
        ("a:\n\tb: 1", "f:2:1: a tab is used for indentation\n  found:   a tab\n  allowed: spaces, two for each level"),
        (
            "a:\n  -\tb: 1",
            "f:2:4: a tab is used for indentation\n  found:   a tab\n  allowed: spaces, two for each level",
        ),
        ("a: 1,5", "f:1:4: a: decimal comma: write 1.5\n  found:   '1,5'" + COMMA),
        (
            "a: -1,5 мм",
            "f:1:4: a: decimal comma: write -1.5 мм\n  found:   '-1,5 мм'"
            "\n  allowed: a decimal point; a list is written [-1, 5 мм]",
        ),
        ("a:\n  b: {c: 1,5}", "f:2:10: a.b.c: decimal comma: write 1.5\n  found:   '1,5'" + COMMA),
        ("a: [0, {d: 2, c: 1,5, e: 3}]", "f:1:18: a[1].c: decimal comma: write 1.5\n  found:   '1,5'" + COMMA),
        (
            "a: {b:1}",
            ("f:1:5: a: this key has no value\n  found:   'b:1'\n  allowed: 'key: value', with a space after ':'"),
        ),
        (
            "a: {b: 1, 5}",
            ("f:1:11: a: this key has no value\n  found:   '5'\n  allowed: 'key: value', with a space after ':'"),
        ),
        *(
            (f"a: {w}", f"f:1:4: a: the number must be finite\n  found:   '{w}'\n  allowed: a finite number")
            for w in (".nan", "NaN", ".inf", "-.Inf", "inf", "+Infinity")
        ),
        (
            "a: 1e999",
            (
                "f:1:4: a: the number is too large or too small\n"
                "  found:   '1e999'\n"
                "  allowed: absolute values from 1e-300 to 1e300"
            ),
        ),
        (
            "a: 1e-999",
            (
                "f:1:4: a: the number is too large or too small\n"
                "  found:   '1e-999'\n"
                "  allowed: absolute values from 1e-300 to 1e300"
            ),
        ),
        ("a: " + "9" * 41, f"f:1:4: a: the number is too long\n  found:   '{'9' * 41}'\n  allowed: at most 40 digits"),
        ("a: &x 1", "f:1:4: a: YAML aliases (* and &) are not allowed in a problem file" + ALIAS),
        ("a: *x", "f:1:4: a: YAML aliases (* and &) are not allowed in a problem file" + ALIAS),
        (
            "a: !!python/object:os.system x",
            (
                "f:1:4: a: YAML tags (!) are not allowed in a problem file\n"
                "  found:   'tag:yaml.org,2002:python/object:os.system'\n"
                "  allowed: values without tags"
            ),
        ),
        (
            "a: !!str 5",
            (
                "f:1:4: a: YAML tags (!) are not allowed in a problem file\n"
                "  found:   'tag:yaml.org,2002:str'\n"
                "  allowed: values without tags"
            ),
        ),
        (
            "a: ! 5",
            (
                "f:1:4: a: YAML tags (!) are not allowed in a problem file\n"
                "  found:   '!'\n"
                "  allowed: values without tags"
            ),
        ),
        (
            "a: x\x07",
            (
                "f:1:5: the file contains a control character or an invisible character\n"
                "  found:   U+0007\n"
                "  allowed: printable characters"
            ),
        ),
        (
            "a: 1\r\nb: \u202ex",
            (
                "f:2:4: the file contains a control character or an invisible character\n"
                "  found:   U+202E\n"
                "  allowed: printable characters"
            ),
        ),
        (
            'a: "\\e[31m"',
            ("f:1:4: a: the text contains a control character\n  found:   '\\x1b'\n  allowed: printable characters"),
        ),
        ("? [1]\n: 2", ("f:1:3: a list or a mapping cannot be used as a key\n  allowed: a word or number")),
        (
            "a: 1\n  - 2",
            (
                "f:1:4: a: this key has a value and a list below it\n"
                "  found:   '1 - 2'\n"
                "  allowed: either a value or a list"
            ),
        ),
        (
            "a: b: c",
            (
                "f:1:5: a ':' is not allowed here\n"
                "  found:   ': c'\n"
                "  allowed: one 'key: value' on a line; a text with ': ' in it needs quotation marks"
            ),
        ),
        (
            "a: [1, 2\nb: 3",
            "f:1:4: '[' is not closed\n  found:   '[1, 2'\n  allowed: '[1, 2]', items separated by commas",
        ),
        (
            "a: {b: 3",
            "f:1:4: '{' is not closed\n  found:   '{b: 3'\n  allowed: '{a: 1, b: 2}', items separated by commas",
        ),
        (
            "a: [1, {b: 2]",
            "f:1:8: '{' is not closed\n  found:   '{b: 2]'\n  allowed: '{a: 1, b: 2}', items separated by commas",
        ),
        ("a: {b: 1; c: 2}", "f:1:9: ',' or the closing bracket is expected here\n  found:   '; c: 2}'" + BRACKETS),
        (
            "a: {F: [2, 0] kN, b: 1}\nc: 2",
            "f:1:15: ',' or the closing bracket is expected here\n  found:   'kN, b: 1}'" + BRACKETS,
        ),
        (
            "a: {\n  b: 1\n  c: 2 }",
            "f:3:3: ',' or the closing bracket is expected here\n  found:   'c: 2 }'" + BRACKETS,
        ),
        (
            "a: {b: 'x}'\nc: 2",
            "f:1:4: '{' is not closed\n  found:   '{b: 'x}''\n  allowed: '{a: 1, b: 2}', items separated by commas",
        ),
        ("a: [2, 0] kN", "f:1:11: text after a closing bracket\n  found:   'kN'" + AFTER_BRACKET),
        ("a: {b: 2} // speed\nc: 1", "f:1:11: text after a closing bracket\n  found:   '// speed'" + AFTER_BRACKET),
        (
            "a: 'x\nb: 3",
            (
                "f:1:4: a quotation mark is not closed\n"
                "  found:   ''x'\n"
                "  allowed: text between two equal quotation marks"
            ),
        ),
        ("a: 1\nb\nc: 2", "f:2:1: a line without ':'\n  found:   'b'\n  allowed: 'key: value', with a space after ':'"),
        (
            "a: @x",
            ("f:1:4: a value cannot begin with this character\n  found:   '@x'\n  allowed: text in quotation marks"),
        ),
        (
            "a:\n  b: 1\n c: 2",
            ("f:3:2: this line does not match the indentation or structure of the lines above\n  found:   'c: 2'")
            + INDENT,
        ),
        (
            "a: - 1",
            ("f:1:4: a list item '-' is not allowed here\n  found:   '- 1'\n  allowed: each '- item' on its own line"),
        ),
        ("a: [1,,2]", "f:1:7: a value is missing\n  found:   ',2]'\n  allowed: a value"),
    ],
)
def test_refusals(text: str, message: str) -> None:
    assert refused(text) == message


def test_the_flow_trap_is_hinted_at() -> None:
    tree = read_text("a: [1,5]\nb: [1,5, -2,5 мм]\nc: [1, 5]\nd: [60,-20]\ne: [[1,2], 3]", "f")
    hints = {key: decimal_comma_hint(tree, (key,)) for key in "abcd"}
    assert hints == {"a": "decimal comma? write 1.5", "b": "decimal comma? write [1.5, -2.5 мм]", "c": None, "d": None}
    assert decimal_comma_hint(tree, ("e", 0)) == "decimal comma? write 1.2"


@pytest.mark.usefixtures("parser")
def test_hostile_shapes_are_bounded() -> None:
    deep = "f:1:23: a[0][0]: too many nested levels\n  allowed: at most 20 levels"
    assert refused("a: " + "[" * 500) == deep
    assert "too many nested levels" in refused(
        "a: " + "[" * 100_000
    )  # the parser may refuse it before the composer does
    assert "too many nested levels" in refused("a: " + "{a: " * 100_000)
    assert "too many nested levels" in refused("- " * 100_000)
    assert "too many nested levels" in refused("\n".join(" " * level + "a:" for level in range(200)))
    laughs = "a: &a [x, x]\n" + "".join(
        f"{b}: &{b} [*{a}, *{a}, *{a}]\n" for a, b in zip("abcdefg", "bcdefgh", strict=True)
    )
    assert refused(laughs).startswith("f:1:4: a: YAML aliases (* and &) are not allowed in a problem file")


def test_too_many_values() -> None:
    message = "f:1:149996: a[49997]: too many values\n  allowed: at most 50000"
    assert refused("a: [" + "1, " * 60_000 + "]") == message


@given(st.text(max_size=60) | st.text("[]{}:,-#&*!|>'\"%@`? \n\ta15", max_size=40))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        tree = read_text(text, "f")
    except ProblemError as error:
        assert str(error).replace("\n", "").isprintable()
    else:
        assert set(tree.key_marks) <= set(tree.marks)


def file_error(path: Path | str) -> str:
    with pytest.raises(ProblemError) as caught:
        read_file(path)
    return str(caught.value).replace(str(path), "f")


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    assert file_error(tmp_path / "none.yaml") == "f: there is no such file"
    assert file_error(tmp_path) == ("f: this is a folder, not a file\n  allowed: a YAML file")
    assert "the file cannot be read" in file_error("a\0b")
    (loop := tmp_path / "loop").symlink_to(loop)
    assert "the file cannot be read" in file_error(loop)


def test_large_files_are_refused_unread(tmp_path: Path) -> None:
    large = tmp_path / "large.yaml"
    with large.open("wb") as stream:
        stream.truncate(50_000_000)
    message = "f: the file is too large\n  found:   {}\n  allowed: at most 1000000 bytes"
    assert file_error(large) == message.format("50000000 bytes")
    if os.path.exists("/dev/zero"):
        assert file_error("/dev/zero") == message.format("more than 1000000 bytes")
    assert refused(" " * (MAX_BYTES + 1)) == message.format("1000001 characters")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_pipes_are_read(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_text, args=("a: 1\n",))
    writer.start()
    assert read_file(pipe).data == {"a": 1}
    writer.join()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            "a: 1\nб: я".encode("cp1251"),
            ("f:2:1: the file is not a text in UTF-8 encoding\n  found:   byte 0xE1 at position 6"),
        ),
        (
            b"\xef\xbb\xbfa: \xff",
            ("f:1:4: the file is not a text in UTF-8 encoding\n  found:   byte 0xFF at position 7"),
        ),
        (
            "a: 1".encode("utf-16"),
            ("f:1:1: the file is not a text in UTF-8 encoding\n  found:   byte 0xFF at position 1"),
        ),
    ],
)
def test_other_encodings_are_refused(tmp_path: Path, content: bytes, message: str) -> None:
    (file := tmp_path / "f.yaml").write_bytes(content)
    assert file_error(file) == message + ("\n  allowed: UTF-8; in the editor choose: Save with encoding, UTF-8")


def test_an_error_finds_its_place() -> None:
    tree = read_text("links:\n  3: {points: [C, D]}\n", "f")
    wrong = ProblemError("x", path=("points",))
    assert str(wrong.at("links", "3").located("f", tree)) == "f:2:6: links.3.points: x".replace("2:6", "2:15")
    assert wrong.path == ("points",)
    key = ProblemError("x", path=("links", "3", "points"), key=True).located("f", tree)
    assert key.mark == SourcePosition(2, 7)
    missing = ProblemError("x", path=("links", "3", "length")).located("f", tree)
    assert missing.mark == SourcePosition(2, 3)
    assert ProblemError("x", mark=SourcePosition(9, 9)).located("f", tree).mark == SourcePosition(9, 9)


def test_an_error_as_text_and_data() -> None:
    error = ProblemError(
        "unknown key",
        path=("links", "3", "lenght"),
        found="'lenght'",
        allowed="length, points",
        near="length",
        file="shaper.yaml",
        mark=SourcePosition(12, 7),
    )
    assert str(error) == (
        "shaper.yaml:12:7: links.3.lenght: unknown key\n  found:   'lenght'\n  allowed: length, points"
        "\n  did you mean 'length'?"
    )
    assert error.to_dict() == {
        "message": "unknown key",
        "file": "shaper.yaml",
        "line": 12,
        "column": 7,
        "path": ["links", "3", "lenght"],
        "found": "'lenght'",
        "allowed": "length, points",
        "near": "length",
    }
    assert "did you mean 'OA' in Latin letters?" in str(ProblemError("x", found=quote("ОА"), near="OA"))


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("lenght", "length"),
        ("Length", "length"),
        ("lengh", "length"),
        ("ОА", "OA"),
        ("AO", "OA"),
        ("oa", "OA"),
        ("slide", "slides"),
        ("xyz", None),
        ("B", None),
        ("OB", None),
        ("", None),
        ("l" * 10_000, None),
    ],
)
def test_nearest(name: str, near: str | None) -> None:
    assert nearest_name(name, ["points", "length", "slides", "OA"]) == near


@given(st.text(max_size=200))
def test_no_word_plays_with_the_terminal(text: str) -> None:
    assert clean(text).isprintable()
    assert quote(text).isprintable()
    assert str(ProblemError(text, path=(text,), file=text)).isprintable()
