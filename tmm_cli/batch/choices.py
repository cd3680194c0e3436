"""What a task frees: each parameter with the values that a variant may have, as texts of a file."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.batch.task import MOST, SAME, Blocks, Chosen, Task, two
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import Dimension
from tmm_cli.problem import Path, ProblemError, Tree, plain_value, quote, under

STEPS = 50  # at least so many between two bounds that were given without a step
VARY = re.compile(r"\s*([^=\s]+)\s*=\s*(.+?)\s*\.\.\s*(.+?)\s*(?::\s*(.+?)\s*)?")
NUMBER = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*")


@dataclass(frozen=True)
class Choice:
    """A parameter that is free. texts: its values; dimension: None for bare numbers."""

    name: str
    texts: tuple[str, ...]
    dimension: Dimension | None


def with_vary(tree: Tree, vary: Sequence[str]) -> Tree:
    """The file with these ranges, `OA=80..140:5`, in the place of its own. Raises ProblemError."""
    own = tree.data.get("variants")
    ranges: dict[str, Any] = dict(own) if isinstance(own, Mapping) else {}
    given: dict[Path, str] = {}
    for text in vary:
        words = f"--vary {text}"
        found = VARY.fullmatch(text)
        if found is None:
            raise ProblemError(
                _("a name, two bounds and perhaps a step are wanted"), allowed="--vary OA=80..140:5", file=words
            )
        name, *ends = found.groups()
        given["variants", name] = words
        with under("variants", name):
            values = [plain_value(end) for end in ends if end is not None]
        ranges[name] = dict(zip(("from", "to", "step"), values, strict=True)) if len(values) == 3 else values
    return replace(tree, data={**tree.data, "variants": ranges}, given={**tree.given, **given}) if given else tree


def read_choices(task: Task) -> tuple[Choice, ...]:
    """What the block `variants` frees. Raises ProblemError."""
    try:
        return _choices(task, task.blocks)
    except ProblemError as error:
        raise error.located(task.tree.file, task.tree) from None


def _choices(task: Task, blocks: Blocks) -> tuple[Choice, ...]:
    ranges = blocks.variants
    if not ranges:
        raise ProblemError(
            _("nothing is free"),
            path=("variants",),
            allowed=_("variants: {OA: {from: 80, to: 140, step: 5}}; or --vary OA=80..140:5"),
        )
    found = []
    for name, own in ranges.items():
        with under("variants", name):
            (dimension,) = task.dimensions((name,))
            values = (own.among or [own.from_, own.to, own.step]) if isinstance(own, Chosen) else own
            texts = _with_units([str(value) for value in values])
            read = [task.value(text) for text in texts]
            said = next((v.dimension for v in read if v.dimension), dimension)
            if not (isinstance(own, Chosen) and own.among):
                texts = _steps(task, values, [task.number(value, said) for value in read], said, texts[0])
            found.append(Choice(name, tuple(dict.fromkeys(texts)), said))
    return tuple(found)


def _with_units(texts: Sequence[str]) -> list[str]:
    """Numbers without a unit get that of the first one that has any."""
    parts = [NUMBER.fullmatch(text) for text in texts]
    unit = next((part[2] for part in parts if part and part[2]), "")
    return [
        f"{text} {unit}" if unit and part and not part[2] else text for text, part in zip(texts, parts, strict=True)
    ]


def _steps(
    task: Task, values: Sequence[Any], sizes: Sequence[float], dimension: Dimension | None, first: str
) -> list[str]:
    """From low to high, in the unit in which the first was written."""
    low, high = sizes[:2]
    if not low < high:
        raise ProblemError(_("the lower bound comes first"), found=two(*values[:2]), allowed=_("[low, high]"))
    written = NUMBER.fullmatch(first)
    unit = written[2] if written else task.units.symbol(dimension) if dimension else ""
    scale = task.number(task.value(f"1 {unit}"), dimension)
    step = sizes[2] if len(sizes) > 2 else 10 ** math.floor(math.log10((high - low) / scale / STEPS)) * scale
    count = (high - low) / step + SAME if step > 0 else math.inf
    if not 1 <= count < MOST:
        raise ProblemError(
            _("1 to {most} steps must lie between the bounds").format(most=MOST - 1),
            path=("step",),
            found=quote(values[2]),
            allowed=_("another step; or bounds without steps, [low, high]"),
        )
    return [f"{(low + step * k) / scale:.12g} {unit}".strip() for k in range(int(count) + 1)]


def choice_values(task: Task, choice: Choice) -> Real:
    """The values of a choice: in SI, bare where it has no dimension."""
    return np.array([task.number(task.value(text), choice.dimension) for text in choice.texts])
