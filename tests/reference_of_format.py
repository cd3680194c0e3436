"""problems/docs/FORMAT.md: every key of a problem file, from the JSON Schema, with examples from the bank.

What a value measures is in data/units_of_keys.txt: the schema says only that it is a value. Meanings of keys without a
description in the schema are in data/meanings_of_keys.txt.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import yaml
from test_commands import tmm

from tmm_cli.mechanics.quantities import DIMENSIONS
from tmm_cli.problem import SYMBOLS, parse_unit

ROOT = Path(__file__).parents[1]
PROBLEMS, DOCS, DATA = ROOT / "problems", ROOT / "problems" / "docs", ROOT / "tests" / "data"
LONGEST = 64  # characters of an example
LATER = ("shows", "variants", "grading", "synthesis")  # sections after all others
WRITTEN = "How values are written"
MEANINGS = "meanings_of_keys.txt"
HEAD = """# Reference: problem files

Every key of a problem file. `python -m tests.documentation` writes this page from `tmm schema` and from the files of
the bank; tasks are explained in the [how-to pages](README.md).

## How values are written

| in the column *type* | what may be written | examples |
| --- | --- | --- |
| value | a number, a number with its unit, or arithmetic on parameters | `110`, `0.11 m`, \
`2*OA + 5 mm`, `CD*sin(30 deg)` |
| name | letters and digits; numbers may be names | `A`, `B1`, `3` |
| place | a point of the link, coordinates in the axes of the link, or a place on the line of two points | `C`, \
`[60, -20]`, `{on: CD, at: 0.5}` |
| [x, y] | two values | `[0, 270]`, `[0.23*CD, 0]` |
| map of ... | entries by their names | `{O: [0, 0], C: [0, -OC]}` |
| list of ... | entries one after another | `[3, 6]` |

- A bare number has the unit that the block `units` gives to its kind, or else the default unit of the table *Units*.
- Functions: FUNCTIONS; and `pi`. A bare `sin(30)` takes the unit of angles of the file.
- A decimal point is a point: `0.5`, not `0,5`.
- An unknown key is refused, with the nearest known key.
- A default of the type *value* is written as in a file. "-" in the column *default*: the key has no value unless the
  file gives one.

"""


@cache
def schema() -> dict[str, Any]:
    """What `tmm schema` prints."""
    found: dict[str, Any] = json.loads(tmm("schema").stdout)
    return found


@cache
def words_of_keys(file: str) -> dict[str, str]:
    """Words by the path of a key, from a file in data."""
    lines = (DATA / file).read_text(encoding="utf-8").splitlines()
    rows = (line.split("|") for line in lines if line and not line.startswith("#"))
    return {key.strip(): words.strip() for key, words in rows}


def units() -> dict[str, str]:
    """What a value measures, by the path of the key."""
    return words_of_keys("units_of_keys.txt")


def own_examples() -> dict[str, str]:
    """Examples of keys that no file of the bank has, by their paths."""
    return words_of_keys("examples_of_keys.txt")


def chain() -> str:
    """The definition of a file with a chain in space."""
    return definition(schema()["then"])


def tasks() -> str:
    """The definition of the block `synthesis`."""
    return definition(ways(schema()["else"]["properties"]["synthesis"])[0])


def is_place(name: str) -> bool:
    """Whether a definition is a place on the line of two points."""
    return set(schema()["$defs"].get(name, {}).get("properties", {})) == {"on", "at", "side"}


def definition(part: Mapping[str, Any]) -> str:
    """The name of the definition that a part of the schema refers to, or nothing."""
    return str(part.get("$ref", "")).rpartition("/")[2]


def ways(part: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The alternatives of a part, without null."""
    found = part.get("anyOf") or [part]
    flat = [way for one in found for way in (ways(one) if "anyOf" in one else [one])]
    return [way for way in flat if way.get("type") != "null"]


def inner(part: Mapping[str, Any]) -> dict[str, Any]:
    """What the entries of a map are."""
    found = part.get("additionalProperties")
    return found if isinstance(found, dict) else {}


def is_value(part: Mapping[str, Any]) -> bool:
    """Whether a part is a value, or coordinates."""
    kinds = [way.get("type") for way in ways(part)]
    return {"number", "string"} <= set(kinds) or any(
        way.get("type") == "array" and is_value(way.get("items", {})) for way in ways(part)
    )


class YamlOfFiles(yaml.SafeLoader):
    """YAML 1.2 as problem files are read: `on` is a word."""


YamlOfFiles.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
YamlOfFiles.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(?:true|false)$"), list("tf"))


def yaml_of(text: str) -> Any:
    """A file, or a block of a page, as plain data."""
    return yaml.load(text, YamlOfFiles)


class Page:
    """The sections of the page, each with the path at which its keys stand in a file."""

    def __init__(self) -> None:
        self.sections: dict[str, tuple[str, dict[str, Any]]] = {}  # definition: path, its schema
        self.also: dict[str, list[str]] = {}
        self._visit("File", "", schema()["else"])
        self._visit(chain(), "chains in space", schema()["$defs"][chain()])

    def _visit(self, name: str, path: str, found: dict[str, Any]) -> None:
        if name in self.sections:
            self.also[name].append(path)
            return
        self.sections[name], self.also[name] = (path, found), []
        keys = found.get("properties", {})
        for key in sorted(keys, key=lambda key: LATER.index(key) if name == "File" and key in LATER else -1):
            part = keys[key]
            below = "" if name in ("File", chain()) else f"{path}."
            if name == chain() and key in schema()["else"]["properties"]:
                continue
            self._follow(part, f"{below}{key}")

    def _follow(self, part: dict[str, Any], path: str) -> None:
        for way in ways(part):
            name = definition(way)
            if name == tasks():
                for task in schema()["$defs"][tasks()]["anyOf"]:
                    kind = task["properties"]["task"]["const"]
                    self._visit(f"synthesis {kind}", f"synthesis, task: {kind}", task)
            elif name:
                self._visit(name, path, schema()["$defs"][name])
            elif way.get("type") == "array" and isinstance(way.get("items"), dict):
                self._follow(way["items"], path)
            elif isinstance(way.get("additionalProperties"), dict):
                self._follow(way["additionalProperties"], f"{path}.NAME")

    def path(self, name: str, key: str) -> str:
        """Where a key of a definition stands in a file."""
        path = self.sections[name][0].replace("synthesis, task: ", "synthesis ")
        return f"{path}.{key}" if path else key

    def type_of(self, part: dict[str, Any], unit: str) -> str:
        """The type of a key in words."""
        found = ways(part)
        if any(is_place(definition(way)) for way in found):
            return f"[place](#{slug(WRITTEN)})"
        kinds = {way.get("type") for way in found if "enum" not in way and "pattern" not in way}
        texts: list[str] = []
        if {"number", "string"} <= kinds:
            texts.append(f"value ({unit})" if unit else "value")
            found = [way for way in found if way.get("type") not in ("number", "string") or "enum" in way]
        elif {"integer", "string"} <= kinds:
            texts.append("name")
            found = [way for way in found if way.get("type") not in ("integer", "string") or "enum" in way]
        texts += [self._type_of_way(way, unit) for way in found]
        return " or ".join(dict.fromkeys(text for text in texts if text))

    def _type_of_way(self, way: dict[str, Any], unit: str) -> str:
        if name := definition(way):
            if name == tasks():
                return "[a task](#synthesis-task-crank-slider)"
            path = self.sections[name][0]
            return f"[{path}](#{slug(path)})"
        if "const" in way:
            return f"`{way['const']}`"
        if "enum" in way:
            return ", ".join(f"`{word}`" for word in way["enum"])
        if "pattern" in way:
            pattern = way["pattern"].strip("^$").replace("(\\S.*)", "LINK")
            return f"`{re.sub(r'[(]([^)]*)[)][?]', '[...]', pattern)}`".replace("[...]", "[share of ]")
        match way.get("type"):
            case "array":
                items = way.get("items", {})
                if way.get("maxItems") == 2 and way.get("minItems") == 2 and is_value(items):
                    return "[x, y]" if unit in ("length", "") else f"two values ({unit})"
                return f"list of {self.type_of(items, unit)}" if items else "[x, y]"
            case "object":
                inner = way.get("additionalProperties")
                return f"map of {self.type_of(inner, unit)}" if isinstance(inner, dict) and inner else "map"
            case "boolean":
                return "`true`, `false`"
            case "string":
                return "text"
            case "integer":
                return "whole number"
            case "number":
                return "number"
        return str(way.get("type") or "value or [x, y] (acceleration)")  # gravity


def slug(heading: str) -> str:
    """The anchor of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


# examples


def sources() -> Iterator[tuple[str, Any]]:
    """Files from which examples are taken, with how the page links to them."""
    first = [PROBLEMS / "shaper.yaml"]
    for file in [*first, *sorted(PROBLEMS.glob("*.yaml")), *sorted(PROBLEMS.glob("*/*.yaml"))]:
        path = file.relative_to(PROBLEMS).as_posix()
        yield f"[{file.stem}](../{path})", yaml_of(file.read_text(encoding="utf-8"))
    for file in [*sorted(PROBLEMS.glob("grading/*/task.yaml")), *sorted((DATA / "linkages").glob("*.yaml"))]:
        path = Path(os.path.relpath(file, DOCS)).as_posix()
        name = file.parent.name if file.stem == "task" else file.stem
        yield f"[{name}]({path})", yaml_of(file.read_text(encoding="utf-8"))
    for page in sorted(DOCS.glob("*.md")):
        for block in re.findall(r"^```yaml\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S):
            yield f"[{page.stem}]({page.name})", yaml_of(block)


@cache
def examples() -> dict[tuple[str, str], tuple[str, str]]:
    """For each key of a definition the first example that is short enough, and where it stands."""
    short: dict[tuple[str, str], tuple[str, str]] = {}
    cut: dict[tuple[str, str], tuple[str, str]] = {}

    def walk(name: str, part: dict[str, Any], data: Any, link: str) -> None:
        for key, value in data.items() if isinstance(data, dict) else ():
            own = part.get("properties", {}).get(key)
            if own is None:
                continue
            text = written(key, value)
            if len(text) <= LONGEST and (name, key) not in short:
                short[name, key] = (text, link)
            elif (name, key) not in cut:
                cut[name, key] = (f"{text[:LONGEST].rpartition(', ')[0]}, ...", link)
            follow(own, value, link)

    def follow(part: dict[str, Any], value: Any, link: str) -> None:
        for way in ways(part):
            name = definition(way)
            if name == tasks() and isinstance(value, dict):
                for task in schema()["$defs"][tasks()]["anyOf"]:
                    if task["properties"]["task"]["const"] == value.get("task"):
                        walk(f"synthesis {value['task']}", task, value, link)
            elif name and isinstance(value, dict):
                walk(name, schema()["$defs"][name], value, link)
            elif way.get("type") == "array" and isinstance(value, list) and isinstance(way.get("items"), dict):
                for item in value:
                    follow(way["items"], item, link)
            elif isinstance(way.get("additionalProperties"), dict) and isinstance(value, dict):
                for item in value.values():
                    follow(way["additionalProperties"], item, link)

    for link, data in sources():
        spatial = isinstance(data, dict) and "structure" in data
        name = chain() if spatial else "File"
        walk(name, schema()["$defs"][name] if spatial else schema()["else"], data, link)
    return {**cut, **short}


def written(key: str, value: Any) -> str:
    """A key with its value on one line, as in a file."""
    text = yaml.safe_dump({key: value}, default_flow_style=True, allow_unicode=True, width=1000, sort_keys=False)
    return text.strip()[1:-1].replace("'on'", "on").replace("'y'", "y")


# the page


def row(page: Page, name: str, key: str, part: dict[str, Any], required: bool) -> str:
    """A key in its table."""
    default = part.get("default")
    shown = "required" if required else "-" if default in (None, "", [], {}, [{}]) else f"`{_word(default)}`"
    if default in ("0",) or default == 0:
        shown = "`0`" if default is not False else "`false`"
    if isinstance(default, bool):
        shown = f"`{str(default).lower()}`"
    path = page.path(name, key)
    text, link = examples().get((name, key), (own_examples().get(path, ""), ""))
    example = f"`{text}` {link}".rstrip() if text else ""
    unit = units().get(path, "")
    cells = (f"`{key}`", page.type_of(part, unit), shown, meaning(path, part), example)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _word(default: Any) -> str:
    return default if isinstance(default, str) else json.dumps(default, ensure_ascii=False)


def meaning(path: str, part: dict[str, Any]) -> str:
    """What a key means."""
    own = "which task" if path.endswith(".task") else words_of_keys(MEANINGS).get(path, "")
    return str(part.get("description") or own)


def unit_rows() -> Iterator[str]:
    """What values measure, the unit of bare numbers, and the symbols of units."""
    for name, kind in DIMENSIONS.items():
        own = [symbol for symbol in SYMBOLS if parse_unit(symbol).dimension == kind.dimension]
        symbols = ", ".join(f"`{symbol}`" for symbol in own) or "products of the others"
        first, __, second = kind.example.partition(" or ")
        shown = f"`{first}`" + (f", `{second}`" if second else "")
        yield f"| {name} | {f'`{kind.default}`' if kind.default else '-'} | {shown} | {symbols} |\n"


def lines() -> Iterator[str]:
    """The page."""
    page = Page()
    functions = import_module("tmm_cli.problem.arithmetic").FUNCTIONS
    yield HEAD.replace("FUNCTIONS", ", ".join(f"`{name}`" for name in functions))
    yield "## Units\n\n| what is measured | unit of a bare number | examples | symbols |\n| --- | --- | --- | --- |\n"
    yield from unit_rows()
    yield "\nUnits are products, quotients and powers: `kg*m^2`, `кг·м²`, `m/s^2`, `1/s`, `об/мин`.\n"
    yield "`units: {length: mm, angle: deg}` sets the unit of bare numbers in a file, by the names of the first\n"
    yield "column (`moment` and `inertia` are short for the long ones).\n\n"
    for name, (path, found) in page.sections.items():
        title = "Place on a line" if is_place(name) else path or "Top level"
        yield f"## {title}\n\n"
        about = found.get("description", "").replace("\n", " ").strip()
        others = ", ".join(f"`{other}`" for other in dict.fromkeys(page.also[name]) if other != path)
        if about:
            yield f"{about}\n\n"
        if others:
            yield f"The same keys: {others}.\n\n"
        yield "| key | type | default | meaning | example |\n| --- | --- | --- | --- | --- |\n"
        required = found.get("required", [])
        for key, part in found.get("properties", {}).items():
            yield row(page, name, key, part, key in required)
        yield "\n"


def missing_words() -> list[str]:
    """Keys without a unit, a meaning or an example in the files in data, and rows there without a key."""
    page = Page()
    keys = {
        page.path(name, key): (name, key, part)
        for name, (__, found) in page.sections.items()
        for key, part in found.get("properties", {}).items()
    }
    parts = {path: part for path, (__, ___, part) in keys.items()}
    measured = {path for path, part in parts.items() if is_value(part) or is_value(inner(part))}
    silent = {path for path, part in parts.items() if not meaning(path, part)}
    known = set(words_of_keys(MEANINGS))
    shown = {path for path, (name, key, __) in keys.items() if (name, key) in examples()} | set(own_examples())
    return [
        *(f"data/units_of_keys.txt: {path} is missing" for path in sorted(measured - set(units()))),
        *(f"data/units_of_keys.txt: there is no {path}" for path in sorted(set(units()) - measured)),
        *(f"data/meanings_of_keys.txt: {path} is missing" for path in sorted(silent)),
        *(f"data/meanings_of_keys.txt: there is no {path}" for path in sorted(known - set(keys))),
        *(f"data/examples_of_keys.txt: {path} is missing" for path in sorted(set(keys) - shown)),
        *(f"data/examples_of_keys.txt: there is no {path}" for path in sorted(set(own_examples()) - set(keys))),
    ]
