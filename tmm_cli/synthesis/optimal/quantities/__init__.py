"""Quantities that may be an objective or a constraint, each a class that is registered here by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tmm_cli.synthesis.optimal.quantities.base import MechanismQuantity
from tmm_cli.synthesis.optimal.quantities.deviation import LawDeviation, PathDeviation
from tmm_cli.synthesis.optimal.quantities.sizes import LinkLengthSum, MotionBox, MovingMass
from tmm_cli.synthesis.optimal.quantities.strokes import MeanOutputSpeed, OutputStroke, TimeRatio
from tmm_cli.synthesis.optimal.quantities.transmission import (
    DeadPositionMargin,
    LargestBalancingMoment,
    LargestPressureAngle,
    LargestReaction,
)

ALL: Final[tuple[type[MechanismQuantity], ...]] = (
    LinkLengthSum,
    MovingMass,
    MotionBox,
    LargestPressureAngle,
    LargestBalancingMoment,
    LargestReaction,
    DeadPositionMargin,
    OutputStroke,
    TimeRatio,
    MeanOutputSpeed,
    PathDeviation,
    LawDeviation,
)
QUANTITIES: Final[Mapping[str, type[MechanismQuantity]]] = {
    quantity.of: quantity for quantity in ALL
}  # as problem files write them
