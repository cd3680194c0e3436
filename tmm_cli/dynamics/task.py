"""What is asked of the law of motion: numbers alone, as a problem file gives them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

from tmm_cli.dynamics.motors import Motor
from tmm_cli.dynamics.sizes import Disk, Size


@dataclass(frozen=True)
class SteadyTask:
    """What is wanted. mean: of the largest and the least speed of the driver (rad/s, or m/s), under a constant moment.

    delta: fluctuation that a flywheel is to keep. motor: in place of a constant moment; `mean` is then a guess only.
    flywheel: a given one, reduced to the driver (kg m2, or kg); without a delta no other is sought. ratio: speed of the
    flywheel's shaft over the driver's; size: how its form is told.
    """

    mean: float
    delta: float | None = None
    motor: Motor | None = None
    flywheel: float = 0.0
    ratio: float = 1.0
    size: Size = field(default_factory=partial(Disk, 7800.0, 0.2))
