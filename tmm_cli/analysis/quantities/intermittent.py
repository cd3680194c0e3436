"""What a wheel of the block intermittent makes of the mechanism's motion."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.analysis.quantities.base import Quantity
from tmm_cli.quantities import ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, NUMBER, Dimension

if TYPE_CHECKING:  # few files have the block
    from tmm_cli.kinematics.intermittent import Intermittent
    from tmm_cli.kinematics.intermittent_task import WheelTask

Reader = Callable[["Intermittent"], float]
KINDS: tuple[tuple[str, Dimension, Reader], ...] = (
    ("turn", ANGLE, lambda wheel: abs(wheel.turn)),
    ("standing", NUMBER, lambda wheel: wheel.standing),
    ("cycles", NUMBER, lambda wheel: np.nan if wheel.cycles is None else wheel.cycles),
    ("largest omega", ANGULAR_SPEED, lambda wheel: wheel.omega),
    ("largest epsilon", ANGULAR_ACCELERATION, lambda wheel: wheel.epsilon),
    ("shock", ANGULAR_SPEED, lambda wheel: wheel.shock),
)


def of_wheels(tasks: Iterable[WheelTask]) -> dict[str, Quantity]:
    """Sizes of a wheel's turn in a cycle and of each step; share of standing, cycles to whole turns, speeds."""
    found = []
    for number, task in enumerate(tasks):
        for name, dimension, of in KINDS:
            found.append((f"{name} of {task.name}", dimension, partial(_read, number, of)))
        for k in range(len(task.settings)):
            found.append((f"step {k + 1} of {task.name}", ANGLE, partial(_read, number, partial(_step, k))))
    return {name: Quantity(name, "velocities", dimension, read, whole=True) for name, dimension, read in found}


def _read(number: int, of: Reader, results: Any) -> Any:
    return np.array([float(of(results.wheels[number]))])


def _step(setting: int, wheel: Intermittent) -> float:
    return abs(wheel.of_setting(setting))
