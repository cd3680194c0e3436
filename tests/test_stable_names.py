"""Names on which files and scripts of others rely stay: keys, commands, options, headings of CSV files, result.json.

tests/data/stable_names.json was written by `python -m tests.test_stable_names` at the commit to which names are held.
New names may join; none may go.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from bank import NAMES, solved
from test_commands import tmm

from tmm_cli.language import words_of_files
from tmm_cli.mechanics.analysis import list_quantities
from tmm_cli.reports import csv_text, tables, to_json

SNAPSHOT = Path(__file__).parent / "data" / "stable_names.json"


def keys_of_schema(part: Any) -> Iterator[str]:
    """Every key of problem files and every word that a value may be."""
    if isinstance(part, dict):
        yield from (key for key in part.get("properties", {}) if isinstance(part["properties"], dict))
        yield from (f"= {word}" for word in part.get("enum", ()))
        yield from (f"= {part[key]}" for key in ("const",) if isinstance(part.get(key), str))
    for below in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from keys_of_schema(below)


def schema() -> Any:
    return json.loads(tmm("schema").stdout)


def options() -> Iterator[str]:
    """Every command, and each of its options."""
    for name in re.findall(r"^  ([a-z]+)  ", tmm("--help").stdout, re.MULTILINE):
        yield name
        yield from (
            f"{name} {option}" for option in re.findall(r"(?<![\w-])--?[a-z][a-z-]*", tmm(name, "--help").stdout)
        )


def paths(value: Any, above: str = "") -> Iterator[str]:
    """Keys of result.json with those above them; what a file names itself is a star."""
    if isinstance(value, dict):
        for key, below in value.items():
            path = f"{above}.{key if re.fullmatch(r'[a-z_]{3,}', key) else '*'}"
            yield path
            yield from paths(below, path)
    elif isinstance(value, list):
        for below in value:
            yield from paths(below, above)


def headings(name: str) -> Iterator[str]:
    """Headings of the CSV files of a problem, by file."""
    results = solved(name)
    with words_of_files():
        for table in tables(results):
            first = next(iter(csv_text(table, results.problem.units)))
            yield f"{table.name}: {first.strip()}"


def names_of_problem(name: str) -> dict[str, list[str]]:
    results = solved(name)
    return {
        "csv": sorted(headings(name)),
        "quantities": sorted(list_quantities(results.linkage, results.structure)),
    }


def keys_of_results() -> set[str]:
    return {path for name in NAMES for path in paths(to_json(solved(name)))}


@cache
def held() -> Any:
    return json.loads(SNAPSHOT.read_text(encoding="utf-8"))


def test_keys_and_words_of_problem_files_stay():
    assert not set(held()["schema"]) - set(keys_of_schema(schema()))


def test_commands_and_options_stay():
    assert not set(held()["options"]) - set(options())


@pytest.mark.parametrize("name", NAMES)
def test_headings_of_csv_files_and_quantities_stay(name):
    for kind, names in names_of_problem(name).items():
        assert not set(held()["problems"][name][kind]) - set(names), kind


def test_keys_of_results_stay():
    assert not set(held()["results"]) - keys_of_results()


def main() -> None:
    """Hold the names of this commit."""
    found = {
        "schema": sorted(set(keys_of_schema(schema()))),
        "options": sorted(set(options())),
        "results": sorted(keys_of_results()),
        "problems": {name: names_of_problem(name) for name in NAMES},
    }
    SNAPSHOT.write_text(json.dumps(found, indent=0, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
