"""A fuzzer of problem files: those of the bank, changed by the grammar of the format, are loaded, and some are solved.

    python -m tests.fuzz --minutes 10 --seed 1

What is right: a problem, or the product's own error. Reported, with a file that shows it: any other exception, a
warning of Python, a load or solution longer than LONGEST, a number that is not finite where it is called sound, and one
that is farther from the truth than its bound says.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
import time
import traceback
import types
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from dataclasses import dataclass, field
from functools import cache
from itertools import count
from pathlib import Path
from random import Random
from typing import Any, Literal, Union, get_args, get_origin
from zlib import crc32

import numpy as np
from pydantic import BaseModel

from tmm_cli import solve
from tmm_cli.accuracy.digits import at, exact
from tmm_cli.double_double import array, exactly, rounded
from tmm_cli.library import problem_of
from tmm_cli.problem.build import is_chain
from tmm_cli.problem.build_chain import build_chain
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.foreign_keys import FOREIGN
from tmm_cli.problem.reader import read_text
from tmm_cli.problem.schema import File
from tmm_cli.problem.schema_chain import SpatialFile
from tmm_cli.problem.units import SYMBOLS
from tmm_cli.quantities import ANGLE
from tmm_cli.results.cells import cells, computed_tables, keys_of
from tmm_cli.results.digits import accuracy
from tmm_cli.synthesis import TASKS, block
from tmm_cli.synthesis.reading import task_of

ROOT = Path(__file__).parents[1]
LONGEST = 10  # seconds of the processor
SOLVED = 10  # one of so many loads is solved too
JUDGED = 3  # one of so many solutions is compared with double-doubles
POSITIONS = 24  # of what is solved: more of them show no more
NUMBERS = [
    "0", "1", "-1", "0.5", "2", "3", "-0.0", "100", "250.5", "1e-9", "1e-17", "1e-300", "1e9", "1e19", "1e299", "1e999",
    "38.925549624985472123456789", "3.14159265358979", "180", "360", "1,5", "nan", "inf", "12:30", "010", "0x1F",
    "1e200*1e200", "(1e200*1e200 - 1e200*1e200)", "1e306 km", "1e160 rpm",
    "1 900", "1.9·10³", "10^3 kgf", "8 с-1", "12 500,5",
]  # fmt: skip
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


class Hang(Exception):
    """A load or a solution that took too long."""


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
        return self.random.choice([
            self.expression(), self.expression(), self.name(), [self.expression(), self.expression()],
            {"on": self.name() + self.name(), "at": self.expression()},
        ])  # fmt: skip

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
            spot.parent[self.random.choice([self.name(), *FOREIGN, str(spot.key) + "s"])] = spot.parent.pop(spot.key)
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
            fields["synthesis"] = block(task["task"]).Shape
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
def limited() -> Iterator[None]:
    """Raises Hang where what is inside takes too long."""

    def stop(*_: object) -> None:
        raise Hang

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
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
    sound = np.asarray(motion.moving)
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
    q, first = exactly(motion.q), results.start
    if results.inputs.extended is not None and request.places:
        places = np.stack(results.inputs.extended().request.places)
        q, first = places[list(results.numbers)], places[0]
    with np.errstate(all="ignore"):
        found, wide = accuracy(results), cells(at(results, exact(results), q, first))
        for table in computed_tables(results):
            keys = keys_of(table, len(results.numbers))
            for k, column in enumerate(found.table(table).columns if keys else ()):
                if column.dimension is None or not all(key in wide for key in keys[k]):
                    continue
                true = array([wide[key] for key in keys[k]]).T.ravel()
                error = rounded(np.abs(column.array - true))
                error = np.minimum(error, np.abs(2 * np.pi - error)) if column.dimension == ANGLE else error
                if np.any(error > column.bound):
                    worst = int(np.nanargmax(np.where(error > column.bound, error - column.bound, np.nan)))
                    return f"{table.name}, {column.header}: off by {error[worst]:.2e}, bound {column.bound[worst]:.2e}"
    return None


def fault(text: str, solving: bool) -> tuple[str, str]:
    """What is wrong with reading, or solving, this file ("" for nothing), and how it ended."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            with limited():
                ended, wrong = _ended(text, solving)
        except Hang:
            return f"longer than {LONGEST} s", "fault"
        except Exception as error:  # whatever it is, it is a fault
            frames = traceback.extract_tb(error.__traceback__)
            own = next((f for f in reversed(frames) if "tmm_cli" in f.filename), frames[-1])
            return f"{type(error).__name__}: {error} ({own.filename.split('tmm_cli/')[-1]}:{own.lineno})", "fault"
    if told and not wrong:
        one = told[0]
        wrong = f"warning: {one.message} ({one.filename.split('tmm_cli/')[-1]}:{one.lineno})"
    return wrong, "fault" if wrong else ended


def _ended(text: str, solving: bool) -> tuple[str, str]:
    try:
        tree = read_text(text, "fuzz.yaml")
        if is_chain(tree):
            build_chain(tree)
            return "loaded", ""
        problem = problem_of(tree)
        if "synthesis" in tree.data and tree.data["synthesis"]["task"] == "optimal":
            task_of(tree)  # which a file with a search does not need before it is solved
        if not solving:
            return "loaded", ""
        results = solve(problem)
        if odd := unsound(results):
            return "solved", f"not finite: {odd}"
        if crc32(text.encode()) % JUDGED == 0 and (far := beyond(results)):
            return "solved", f"beyond its bound: {far}"
        return "solved", ""
    except ProblemError as error:
        str(error)
        return "refused", ""


def cases(random: Random) -> Iterator[tuple[str, bool]]:
    """Files without end, and whether to solve them."""
    texts = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "problems").glob("*.yaml"))]
    trees = [read_text(text, "bank").data for text in texts]
    grammar = Grammar(random)
    for number in count():
        k, solving = random.randrange(len(texts)), number % SOLVED == 0
        if not solving and random.random() < 0.2:
            yield grammar.cut(texts[k]), False
        else:
            data = grammar.changed(trees[k], gently=random.random() < (0.8 if solving else 0.4))
            yield json.dumps(small(data), ensure_ascii=False), solving


def fuzz(
    seed: int, loads: int | None = None, until: float | None = None,
    found: Callable[[str, str], None] = lambda wrong, text: None,
) -> tuple[Counter[str], dict[str, str]]:  # fmt: skip
    """How files ended, and faults with the first file that shows each; so many loads, or until a time.

    found: told of each fault as it is met.
    """
    random = Random(seed)
    ended: Counter[str] = Counter()
    faults: dict[str, str] = {}
    for number, (text, solving) in enumerate(cases(random)):
        if (loads is not None and number >= loads) or (until is not None and time.monotonic() > until):
            break
        wrong, how = fault(text, solving)
        ended.update([how, "solves" if solving else "loads"])
        if wrong and wrong not in faults:
            faults[wrong] = text
            found(wrong, text)
    return ended, faults


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="a folder for the files that show a fault")
    given = parser.parse_args()

    def keep(wrong: str, text: str) -> None:
        print(f"{wrong}\n  {text[:2000]}\n", flush=True)
        if given.keep:
            given.keep.mkdir(parents=True, exist_ok=True)
            (given.keep / f"{given.seed}-{crc32(wrong.encode()):08x}.yaml").write_text(text, encoding="utf-8")

    ended, faults = fuzz(given.seed, until=time.monotonic() + 60 * given.minutes, found=keep)
    print(", ".join(f"{how}: {count}" for how, count in sorted(ended.items())))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
