"""What a mechanism can be optimised for or held to: one class a quantity, and its name here."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.synthesis.optimal.quantities.deviation import Law, Path
from tmm_cli.synthesis.optimal.quantities.sizes import Box, Length, Mass
from tmm_cli.synthesis.optimal.quantities.strokes import K, Speed, Stroke
from tmm_cli.synthesis.optimal.quantities.transmission import Margin, Moment, Pressure, Reaction

ALL: Final[tuple[type[Goal], ...]] = (
    Length,
    Mass,
    Box,
    Pressure,
    Moment,
    Reaction,
    Margin,
    Stroke,
    K,
    Speed,
    Path,
    Law,
)
QUANTITIES: Final[Mapping[str, type[Goal]]] = {quantity.of: quantity for quantity in ALL}  # as problem files write them
