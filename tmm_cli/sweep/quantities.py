"""What can be shown over parameters: what students may be asked, as one number of a mechanism, and the pressure angle.

Of what has a value a position the largest size over the cycle counts; of places and angles, their range over the cycle.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.batch import Task
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Quantity, Solved
from tmm_cli.mechanics.numerics import Real, greatest
from tmm_cli.mechanics.quantities import ANGLE, Dimension
from tmm_cli.problem import ProblemError, unknown_name

PRESSURE = "pressure"  # the largest pressure angle on the output, over all the driver's way
USUAL = ("H", "psi", "k", PRESSURE, "M_b", "F_b")  # where nothing is asked for
MOST = 12  # quantities at once


@dataclass(frozen=True)
class Shown:
    """A quantity that is shown. quantity: how it is read from a solution; none of what is searched for."""

    name: str
    dimension: Dimension
    quantity: Quantity | None

    @property
    def whole(self) -> bool:
        """Whether it belongs to the mechanism, and to no position."""
        return self.quantity is None or self.quantity.whole

    @property
    def forces(self) -> bool:
        """Whether it wants the force plan."""
        return self.quantity is not None and self.quantity.stage in ("forces", "balance")

    @property
    def words(self) -> str:
        """For people."""
        if self.whole:
            return {PRESSURE: _("largest pressure angle")}.get(self.name, self.name)
        if self.ranges:
            return _("range of {quantity} over the cycle").format(quantity=self.name)
        return _("largest {quantity} over the cycle").format(quantity=self.name)

    @property
    def ranges(self) -> bool:
        return self.quantity is not None and self.quantity.against in ("range", "angle")

    def at_positions(self, solved: Solved) -> Any:
        """What a tape is to give of it at positions, see `over_cycle`."""
        assert self.quantity is not None
        found = self.quantity.read(solved)
        return found if self.ranges else np.abs(found)

    def over_cycle(self, curves: Callable[[Real, Real], Real], q: Real, values: Real) -> Real:
        """One number of each variant, (variants,): the largest value over the cycle, or the range; nan of none.

        curves, q, values: see `roots.greatest`.
        """
        if not self.ranges:
            return greatest(curves, q, values)
        assert self.quantity is not None
        turns = self.quantity.against == "angle"
        values = np.unwrap(values, axis=1) if turns else values
        high = greatest(curves, q, values, turns=turns)
        return high + greatest(lambda rows, at: -curves(rows, at), q, -values, turns=turns)


def known(task: Task) -> Mapping[str, Shown]:
    """All that can be shown of a file, by the names in its tables. Raises ProblemError."""
    named = {
        name: Shown(name, quantity.dimension, quantity)
        for name, quantity in task.quantities.items()
        if not name.startswith("arm of ")  # it is nothing where its force vanishes
    }
    return {**named, PRESSURE: Shown(PRESSURE, ANGLE, None)}


def read_shown(task: Task, given: Sequence[str]) -> tuple[Shown, ...]:
    """What options `--show` ask for: names with commas between; `v_E` is v of E. Raises ProblemError."""
    every = known(task)
    names = {
        **{name.replace(" of ", "_").replace(" on ", "_"): name for name in every},
        **{name: name for name in every},
    }
    found: list[Shown] = []
    for text in given:
        for name in _split(text, names):
            if name not in names:
                some = _("e.g. {names}").format(names=", ".join(_examples(every)))
                raise unknown_name(name, names, _("there is no such quantity"), some, file=f"--show {text}")
            found.append(every[names[name]])
    found = list(dict.fromkeys(found)) or [
        every[name] for name in USUAL if name in every and not (name == "H" and "psi" in every)
    ]
    if len(found) > MOST:
        raise ProblemError(
            _("these are too many quantities"),
            found=str(len(found)),
            allowed=_("at most {most}").format(most=MOST),
            file="--show",
        )
    return tuple(found)


def _split(text: str, names: Mapping[str, str]) -> list[str]:
    """Names between commas; a name may have a comma itself, R_10,11."""
    found: list[str] = []
    for part in re.split(r"\s*,\s*", text.strip()):
        if found and f"{found[-1]},{part}" in names:
            found[-1] = f"{found[-1]},{part}"
        else:
            found.append(part)
    return found


def _examples(every: Mapping[str, Shown]) -> list[str]:
    """One of each kind."""
    kinds = {re.split(r" of |_(?=[^b])", name)[0]: name for name in reversed(list(every))}
    return list(kinds.values())[::-1]
