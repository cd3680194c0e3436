"""A fuzzer: files of the bank, changed by the grammar of the format, are loaded, solved, run by commands and graded.

    python tests/fuzz.py --minutes 10 --seed 1
    python tests/fuzz.py --loads 100000 --solves 10000 --runs 1000 --grades 300

A load reads a file. A solve computes it, with all its tables. A run draws it and writes its note and its sheets, and
takes one of the other commands. A grade marks a group twice. With counts each kind ends at its own; without counts each
takes its share of the time.

What is right: a problem, or the product's own error. Reported, with a file that shows it: any other exception, a
warning of Python, work beyond the limits of LONGEST, a number that is not finite where it is called sound, and one that
is farther from the truth than its bound says.
"""

from __future__ import annotations

import argparse
import json
import resource
import signal
import sys
import time
import traceback
import types
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, chdir, contextmanager, redirect_stderr, redirect_stdout
from copy import deepcopy
from dataclasses import dataclass, field
from functools import cache
from io import StringIO
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any, Literal, Union, get_args, get_origin
from unittest import mock
from zlib import crc32

import numpy as np
from fuzz_blocks import with_blocks
from pydantic import BaseModel

from tmm_cli import solve
from tmm_cli.cli import application
from tmm_cli.drawing.formats import run_in_process
from tmm_cli.mechanics.accuracy import exact_linkage, results_with_linkage
from tmm_cli.mechanics.numerics import array, to_double_double, to_float
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.problem import (
    KEYS_IN_OTHER_LANGUAGES,
    SYMBOLS,
    File,
    ProblemError,
    SpatialFile,
    build_any_problem,
    build_chain,
    is_chain,
    read_text,
)
from tmm_cli.reports import assess_accuracy, computed_tables, json_text, numbers_at_positions, row_keys, sections, walk
from tmm_cli.synthesis import TASKS, block_module, read_task

ROOT = Path(__file__).parents[1]
LONGEST = {"load": 10, "solve": 30, "run": 60, "grade": 60}  # seconds of the processor, of each command
SHARES = {"load": 1.0, "solve": 2.0, "run": 3.0, "grade": 1.0}  # of the time, where no counts are given
MEMORY = 3 << 30  # bytes of addresses: a gigabyte, and what Python and its libraries map
JUDGED = 3  # one of so many solutions is compared with double-doubles
POSITIONS = 24  # of what is solved: more of them show no more
NUMBERS = [
    "0",
    "1",
    "-1",
    "0.5",
    "2",
    "3",
    "-0.0",
    "100",
    "250.5",
    "1e-9",
    "1e-17",
    "1e-300",
    "1e9",
    "1e19",
    "1e299",
    "1e999",
    "38.925549624985472123456789",
    "3.14159265358979",
    "180",
    "360",
    "1,5",
    "nan",
    "inf",
    "12:30",
    "010",
    "0x1F",
    "1e200*1e200",
    "(1e200*1e200 - 1e200*1e200)",
    "1e306 km",
    "1e160 rpm",
    "1 900",
    "1.9·10³",
    "10^3 kgf",
    "8 с-1",
    "12 500,5",
]
FACTORS = [0, -1, 1e-9, 1e3, 1e18, 2, 0.5, *[1 + 1e-12, 1.1, 0.9, 1.01, 0.99] * 4]
CALLS = ["sin", "cos", "tan", "asin", "acos", "atan", "atan2", "hypot", "min", "max", "sqrt", "abs", "sinh"]
ODD = [
    None,
    True,
    "",
    "х",
    "ОА",
    "a" * 60,
    [],
    {},
    [1],
    [1, 2, 3],
    [[1, 2], [3, 4]],
    {"on": "AB"},
    "working stroke",
    "=1",
]
SIGNS = [*":,[]{}-\"'&*!\t# .05А|\u200b", "- ", ": ", "1,5"]


Kind = Literal["load", "solve", "run", "grade"]


class Hang(BaseException):
    """Work that took too long; nothing catches it on its way."""


@dataclass
class Spot:
    """A place in a file: its value is parent[key], of the kind that an annotation of the schema says."""

    parent: Any
    key: Any
    kind: Any


@dataclass
class Grammar:
    """Values and changes at random, by the shapes that the product itself reads files with."""

    random: Random
    names: list[str] = field(default_factory=list)

    def number(self) -> Any:
        written = self.random.choice(NUMBERS)
        size = self.random.choice([1, 10, 100, 1e3]) * self.random.uniform(-1, 3)
        return self.random.choice([written, written, round(size, 3), size, int(size)])

    def expression(self, depth: int = 0) -> Any:
        pick = self.random.random()
        if depth > 3 or pick < 0.45:
            return self.number()
        if pick < 0.6:
            return f"{self.number()} {self.random.choice(list(SYMBOLS))}"
        if pick < 0.7:
            return self.name()
        inner = [str(self.expression(depth + 1)) for _ in range(self.random.choice([1, 2, 2, 3]))]
        if pick < 0.82:
            return f"{self.random.choice(CALLS)}({', '.join(inner)})"
        return self.random.choice(["(", ""]) + self.random.choice("+-*/^ ").join(inner) + self.random.choice([")", ""])

    def name(self) -> str:
        return self.random.choice([*self.names, "Z9", "1", "О"])

    def value(self, kind: Any, depth: int = 0) -> Any:
        """A value of a kind, now and then of another."""
        if depth > 4 or self.random.random() < 0.05:
            return deepcopy(self.random.choice(ODD))
        origin, inner = get_origin(kind), get_args(kind)
        if origin is Literal:
            return self.random.choice(inner)
        if origin in (types.UnionType, Union):
            return self.value(self.random.choice(inner), depth)
        if origin is list:
            return [self.value(inner[0], depth + 1) for _ in range(self.random.choice([1, 2, 2, 3]))]
        if origin is dict:
            return {self.name(): self.value(inner[1], depth + 1) for _ in range(self.random.choice([1, 2]))}
        if inner:  # Annotated
            return self.value(inner[0], depth)
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            fields = kind.model_fields.items()
            chosen = [(name, one) for name, one in fields if one.is_required() or self.random.random() < 0.2]
            return {one.alias or name: self.value(one.annotation, depth + 1) for name, one in chosen}
        if kind is int:
            return self.random.choice([0, 1, 2, 3, 12, -1, 10**6])
        if kind is str:
            return self.name()
        if kind is bool:
            return self.random.random() < 0.5
        return self.random.choice(
            [
                self.expression(),
                self.expression(),
                self.name(),
                [self.expression(), self.expression()],
                {"on": self.name() + self.name(), "at": self.expression()},
            ]
        )

    def changed(self, data: dict[str, Any], gently: bool) -> dict[str, Any]:
        """The file with one to three changes; gently: of sizes alone, so that most of them are solved."""
        data = deepcopy(data)
        self.names = sorted(_names(data))
        for _ in range(self.random.choice([1, 1, 2, 3])):
            spots = list(_spots(data, shape_of(data)))
            sizes = [spot for spot in spots if _is_size(spot.parent[spot.key])]
            if gently and sizes:
                self.resize(*self.random.choice([[self.random.choice(sizes)]] * 9 + [sizes]))
            elif spots:
                self.change(self.random.choice(spots), spots)
        return data

    def resize(self, *spots: Spot) -> None:
        factor = self.random.choice([*FACTORS, self.random.uniform(0.5, 2)])
        for spot in spots:
            own = spot.parent[spot.key]
            spot.parent[spot.key] = own * factor if isinstance(own, int | float) else f"({own})*{factor!r}"

    def change(self, spot: Spot, spots: list[Spot]) -> None:
        own, pick = spot.parent[spot.key], self.random.random()
        if _is_size(own) and pick < 0.2:
            self.resize(spot)
        elif _is_size(own) and pick < 0.7:
            spot.parent[spot.key] = self.expression()
        elif pick < 0.55:
            spot.parent[spot.key] = self.value(spot.kind)
        elif pick < 0.65:
            other = self.random.choice(spots)
            spot.parent[spot.key] = deepcopy(other.parent[other.key])
        elif pick < 0.75:
            del spot.parent[spot.key]
        elif isinstance(own, dict) and isinstance(model := _model(spot.kind), type):
            name, one = self.random.choice(list(model.model_fields.items()))
            own[one.alias or name] = self.value(one.annotation)
        elif isinstance(spot.parent, dict):
            spot.parent[self.random.choice([self.name(), *KEYS_IN_OTHER_LANGUAGES, str(spot.key) + "s"])] = (
                spot.parent.pop(spot.key)
            )
        else:
            spot.parent.insert(spot.key, deepcopy(own))  # of rows of a table: a jump

    def cut(self, text: str) -> str:
        """The text with a few characters or lines changed."""
        for _ in range(self.random.choice([1, 1, 2])):
            lines = text.split("\n")
            k = self.random.randrange(len(lines))
            at = self.random.randrange(len(lines[k]) + 1)
            pick = self.random.random()
            if pick < 0.15:
                del lines[k]
            elif pick < 0.3:
                lines.insert(k, self.random.choice(lines))
            else:
                sign = self.random.choice([*SIGNS, ""])
                lines[k] = lines[k][:at] + sign + lines[k][at + self.random.choice([0, 1]) :]
            text = "\n".join(lines)
        return text


def _is_size(value: Any) -> bool:
    """Whether this is a number, or a text that begins with one."""
    if isinstance(value, str):
        return value[:1].isdigit()
    return isinstance(value, int | float) and not isinstance(value, bool)


def shape_of(data: dict[str, Any]) -> Any:
    """The shape of a file."""
    return SpatialFile if "structure" in data else File


def _names(data: Any) -> set[str]:
    """Keys and words of a file: what it may name."""
    if isinstance(data, dict):
        return {str(key) for key in data}.union(*map(_names, data.values()))
    if isinstance(data, list):
        return set().union(*map(_names, data))
    return {data} if isinstance(data, str) and len(data) < 6 else set()


@cache
def _model(kind: Any) -> Any:
    """The model in an annotation."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return kind
    return next((found for inner in get_args(kind) if (found := _model(inner))), None)


def _spots(data: Any, kind: Any) -> Iterator[Spot]:
    """Every place in a file, with its kind."""
    model = _model(kind)
    if isinstance(data, dict):
        fields = {one.alias or name: one.annotation for name, one in model.model_fields.items()} if model else {}
        task = data.get("synthesis")
        if isinstance(task, dict) and str(task.get("task")) in TASKS:
            fields["synthesis"] = block_module(task["task"]).BLOCK
        if get_origin(kind) is dict:
            fields = dict.fromkeys(data, get_args(kind)[1])
        for key, value in data.items():
            yield Spot(data, key, fields.get(key, Any))
            yield from _spots(value, fields.get(key, Any))
    elif isinstance(data, list):
        inner = get_args(kind)[0] if get_origin(kind) is list else model or Any
        for number, value in enumerate(data):
            yield Spot(data, number, inner)
            yield from _spots(value, inner)


def small(data: dict[str, Any]) -> dict[str, Any]:
    """The same with few positions and a short search: more of them take longer and show no more."""
    positions = data.get("positions")
    if isinstance(positions, dict) and isinstance(positions.get("count"), int | float):
        positions["count"] = min(positions["count"], POSITIONS)
    task = data.get("synthesis")
    if isinstance(task, dict) and task.get("task") == "optimal":
        task |= {"population": 8, "generations": 3, "positions": 24}
    return data


@contextmanager
def limited(kind: str) -> Iterator[None]:
    """Raises Hang where what is inside takes too long."""

    def stop(*_: object) -> None:
        raise Hang

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, LONGEST[kind])
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def unsound(results: Any) -> str | None:
    """What is not finite in a position that has velocities and forces."""
    motion = results.motion
    if motion is None:
        return None
    sound = np.asarray(motion.moving) & ~np.asarray(results.locked)
    found: dict[str, Any] = {}
    for link in results.linkage.links:
        turning = motion.link(link)
        found |= {f"omega of {link}": turning.omega, f"epsilon of {link}": turning.epsilon}
    if results.reactions is not None:
        found |= {f"force in {one.pair.name}": one.force for one in results.reactions.all}
        found["balance"] = results.reactions.balance.force
    return next((name for name, values in found.items() if not np.isfinite(np.asarray(values)[..., sound]).all()), None)


def beyond(results: Any) -> str | None:
    """A number in a table that is farther from the same in double-doubles than its bound says."""
    motion, request = results.motion, results.inputs.request
    if motion is None or not len(motion.q):
        return None
    q, first = to_double_double(motion.q), results.start
    if results.inputs.extended is not None and request.places:
        places = np.stack(results.inputs.extended().request.places)
        q, first = places[list(results.numbers)], places[0]
    with np.errstate(all="ignore"):
        found, wide = (
            assess_accuracy(results),
            numbers_at_positions(results_with_linkage(results, exact_linkage(results), q, first)),
        )
        for table in computed_tables(results):
            keys = row_keys(table, len(results.numbers))
            for k, column in enumerate(found.table(table).columns if keys else ()):
                if column.dimension is None or not all(key in wide for key in keys[k]):
                    continue
                true = array([wide[key] for key in keys[k]]).T.ravel()
                error = to_float(np.abs(column.array - true))
                if column.dimension == ANGLE:  # a cycle may have several turns
                    error = np.abs(error - 2 * np.pi * np.round(error / (2 * np.pi)))
                if np.any(error > column.bound):
                    worst = int(np.nanargmax(np.where(error > column.bound, error - column.bound, np.nan)))
                    return f"{table.name}, {column.header}: off by {error[worst]:.2e}, bound {column.bound[worst]:.2e}"
    return None


@dataclass(frozen=True)
class Case:
    """A problem file and what is done with it. command: of a run, after its three; group: of a grade, by its files."""

    kind: Kind
    text: str
    command: tuple[str, ...] = ()
    group: dict[str, bytes] = field(default_factory=dict)


def fault(case: Case) -> tuple[str, str, str]:
    """What is wrong with a case ("" for nothing), how it ended, and where the fault is in the product."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            ended, wrong = DONE[case.kind](case)
        except Hang:
            return f"longer than {LONGEST[case.kind]} s", "fault", f"{case.kind} hangs"
        except Exception as error:  # whatever it is, it is a fault
            frames = traceback.extract_tb(error.__traceback__)
            own = next((f for f in reversed(frames) if "tmm_cli" in f.filename), frames[-1])
            place = f"{own.filename.split('tmm_cli/')[-1]}:{own.lineno}"
            return f"{type(error).__name__}: {error} ({place})", "fault", f"{type(error).__name__} {place}"
    told = [one for one in told if case.kind in ("load", "solve") or not issubclass(one.category, RuntimeWarning)]
    if told and not wrong:
        place = f"{told[0].filename.split('tmm_cli/')[-1]}:{told[0].lineno}"
        wrong = f"warning: {told[0].message} ({place})"
    return wrong, "fault" if wrong else ended, wrong.partition(":")[0] + wrong.rpartition("(")[2]


def _loaded(case: Case) -> tuple[str, str]:
    return _ended(case.text, solving=False)


def _solved(case: Case) -> tuple[str, str]:
    return _ended(case.text, solving=True)


def _ended(text: str, solving: bool) -> tuple[str, str]:
    try:
        with limited("solve" if solving else "load"):
            tree = read_text(text, "fuzz.yaml")
            if is_chain(tree):
                build_chain(tree)
                return "loaded", ""
            problem = build_any_problem(tree)
            if "synthesis" in tree.data and tree.data["synthesis"]["task"] == "optimal":
                read_task(tree)  # which a file with a search does not need before it is solved
            if not solving:
                return "loaded", ""
            results = solve(problem)
            if odd := unsound(results):
                return "solved", f"not finite: {odd}"
            if crc32(text.encode()) % JUDGED == 0 and (far := beyond(results)):
                return "solved", f"beyond its bound: {far}"
            if not (sum(len(table.columns) for table in walk(results)) and list(json_text(sections(results)))):
                return "solved", "no tables"
            return "solved", ""
    except ProblemError as error:
        str(error)
        return "refused", ""


def _run(case: Case) -> tuple[str, str]:
    """The three commands that draw and write everything, then another one."""
    with TemporaryDirectory() as folder, chdir(folder):
        Path("fuzz.yaml").write_text(case.text, encoding="utf-8")
        digits = ("--digits",) if crc32(case.text.encode()) % JUDGED == 0 else ()
        codes = [
            _command(*words)
            for words in (("run", "fuzz.yaml", *digits), ("note", "fuzz.yaml"), ("sheets", "fuzz.yaml"), case.command)
        ]
        if codes[0] == 0 and not (Path("outputs") / "fuzz" / "result.json").exists():
            return "run", "run wrote nothing"
    return ("refused" if codes[:3] == [2, 2, 2] else "run"), ""


def _graded(case: Case) -> tuple[str, str]:
    """Graded twice: the second time what is kept of the first one is read back, and gives the same marks."""
    with TemporaryDirectory() as folder, chdir(folder):
        Path("task.yaml").write_text(case.text, encoding="utf-8")
        for name, content in case.group.items():
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            Path(name).write_bytes(content)
        handed = next((name for name in case.group if name.startswith("answers")), "submissions")
        words = ("grade", "task.yaml", "--variants", "variants.csv", "--submissions", handed, "--jobs", "1")
        codes, marks = [], []
        for _ in range(2):
            codes.append(_command(*words))
            marks.append(
                {f.name: f.read_bytes() for f in Path("marks").glob("*.csv")} if Path("marks").exists() else {}
            )
        if codes[0] != codes[1] or marks[0] != marks[1]:
            return "graded", f"a second run of grade differs: codes {codes}"
    return ("refused" if codes[0] == 2 else "graded"), ""


DONE: dict[str, Callable[[Case], tuple[str, str]]] = {
    "load": _loaded,
    "solve": _solved,
    "run": _run,
    "grade": _graded,
}


def _command(*words: str) -> int:
    """Call a command in this process, drawing in it too; its exit code. What it raises else is a fault."""
    with limited("grade" if words[0] == "grade" else "run"), ExitStack() as stack:
        for module in ("tmm_cli.cli.sheets", "tmm_cli.cli.pictures"):
            stack.enter_context(
                mock.patch(f"{module}.run_on_all_cores", lambda jobs, quiet=False: run_in_process(jobs))
            )
        stack.enter_context(redirect_stdout(StringIO()))
        stack.enter_context(redirect_stderr(StringIO()))
        try:
            application(words)(list(words))
        except SystemExit as ended:
            code = int(ended.code or 0)
    if code not in (0, 1, 2):
        raise AssertionError(f"{words[0]} ended with exit code {code}")
    return code


def cases(kind: Kind, seed: int) -> Iterator[Case]:
    """Cases of a kind without end."""
    random = Random(f"{seed} {kind}")
    grammar = Grammar(random)
    if kind == "grade":
        yield from _groups(grammar)
    texts = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "problems").glob("*.yaml"))]
    trees = [read_text(text, "bank").data for text in texts]
    while True:
        k, kept = random.randrange(len(texts)), 0.4 if kind == "load" else 0.8
        if kind == "load" and random.random() < 0.2:
            yield Case(kind, grammar.cut(texts[k]))
            continue
        pick, data = random.random(), trees[k]
        if pick < 0.5 and "structure" not in data:
            data = with_blocks(data, random)
        if pick > 0.3:
            data = grammar.changed(data, gently=random.random() < kept)
        command = _further(data, random) if kind == "run" else ()
        yield Case(kind, json.dumps(small(data), ensure_ascii=False), command)


def _further(data: dict[str, Any], random: Random) -> tuple[str, ...]:
    """A command that is not in every run."""
    parameters = data.get("parameters")
    swept = random.choice(list(parameters)) if isinstance(parameters, dict) and parameters else "a"
    out = ("-o", "further")
    return random.choice(
        [
            ("kinematics", "fuzz.yaml", "--extremes", "--centres", *out),
            ("kinematics", "fuzz.yaml", "--assemblies", *out),
            ("forces", "fuzz.yaml", "--hodographs", "--extremes", *out),
            ("forces", "fuzz.yaml", "--digits", *out),
            ("structure", "fuzz.yaml", "--drawings", *out),
            ("dynamics", "fuzz.yaml", *out),
            ("explain", "fuzz.yaml"),
            ("animate", "fuzz.yaml", "-o", "further.html"),
            ("note", "fuzz.yaml", "--as", "docx", *out),
            ("sweep", "fuzz.yaml", "--over", f"{swept}=20..200:5", "--show", "H,k,M_b", "--jobs", "1"),
        ]
    )


def _groups(grammar: Grammar) -> Iterator[Case]:
    """Tasks of the bank with what their groups handed in, changed here and there."""
    random = grammar.random
    folders = sorted(path.parent for path in (ROOT / "problems" / "grading").glob("*/task.yaml"))
    while True:
        folder = random.choice(folders)
        text = (folder / "task.yaml").read_text(encoding="utf-8")
        if random.random() < 0.3:
            data = small(grammar.changed(read_text(text, "task").data, gently=random.random() < 0.8))
            text = json.dumps(data, ensure_ascii=False)
        files = [path for path in sorted(folder.rglob("*")) if path.is_file() and path.suffix != ".json"]
        group = {str(path.relative_to(folder)): path.read_bytes() for path in files if path.name != "task.yaml"}
        for name in [name for name in group if not name.endswith(".xlsx") and random.random() < 0.3]:
            content = group[name]
            for _ in range(random.choice([1, 2, 5])):
                content = grammar.cut(content.decode("utf-8")).encode("utf-8", "replace")
            group[name] = content
        handed = [name for name in group if name.startswith("submissions")]
        if handed and random.random() < 0.5:  # of a student whom nobody knows
            group["submissions/" + random.choice(["Nobody.csv", "Иванов.csv", "a b.csv"])] = group[
                random.choice(handed)
            ]
        yield Case("grade", text, group=group)


def fuzz(
    seed: int,
    counts: Mapping[str, int] | None = None,
    until: float | None = None,
    found: Callable[[str, Case], None] = lambda wrong, case: None,
) -> tuple[Counter[str], dict[str, Case]]:
    """How cases ended, and faults with the first case that shows each.

    counts: so many of each kind; without them shares of the time. until: the time (monotonic) at which it ends anyhow.
    found: called with each fault as it is met.
    """
    wanted = dict(counts) if counts is not None else dict.fromkeys(SHARES, sys.maxsize)
    streams = {kind: cases(kind, seed) for kind in wanted}
    spent = dict.fromkeys(wanted, 0.0)
    ended: Counter[str] = Counter()
    faults: dict[str, Case] = {}
    known: set[str] = set()
    while until is None or time.monotonic() < until:
        left = [kind for kind in wanted if ended[kind] < wanted[kind]]
        if not left:
            break
        kind = min(left, key=lambda one: spent[one] / SHARES[one])
        start, case = time.process_time(), next(streams[kind])
        wrong, how, place = fault(case)
        spent[kind] += time.process_time() - start
        ended.update([kind, f"{kind}: {how}"])
        if wrong and place not in known:
            known.add(place)
            faults[wrong] = case
            found(wrong, case)
    return ended, faults


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, help="when it ends; 10 where no counts are given")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="a folder for the files that show a fault")
    for kind in SHARES:
        parser.add_argument(f"--{kind}s", type=int, help=f"so many cases of this kind: {kind}")
    given = parser.parse_args()
    counts = {kind: count for kind in SHARES if (count := getattr(given, f"{kind}s")) is not None}
    minutes = given.minutes if given.minutes is not None or counts else 10

    def keep(wrong: str, case: Case) -> None:
        words = " ".join(case.command)
        print(f"{case.kind}: {wrong}\n  {words}\n  {case.text[:2000]}\n", flush=True)
        if given.keep:
            name = f"{given.seed}-{crc32(wrong.encode()):08x}"
            for file, content in {f"{name}.yaml": case.text.encode(), **case.group}.items():
                target = given.keep / (Path(name) / file if case.group else file)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)

    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.RLIM_INFINITY))
    until = None if minutes is None else time.monotonic() + 60 * minutes
    ended, faults = fuzz(given.seed, counts or None, until, keep)
    for kind in SHARES:
        if ended[kind]:
            how = ", ".join(
                f"{name.partition(': ')[2]} {n}" for name, n in sorted(ended.items()) if name.startswith(f"{kind}: ")
            )
            print(f"{kind}s: {ended[kind]} ({how})")
    print(f"different faults: {len(faults)}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
