"""What a mechanism can be optimised for or held to: one file a quantity, and a line here."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.synthesis.optimal.quantities.box import Box
from tmm_cli.synthesis.optimal.quantities.k import K
from tmm_cli.synthesis.optimal.quantities.law import Law
from tmm_cli.synthesis.optimal.quantities.length import Length
from tmm_cli.synthesis.optimal.quantities.margin import Margin
from tmm_cli.synthesis.optimal.quantities.mass import Mass
from tmm_cli.synthesis.optimal.quantities.moment import Moment
from tmm_cli.synthesis.optimal.quantities.path import Path
from tmm_cli.synthesis.optimal.quantities.pressure import Pressure
from tmm_cli.synthesis.optimal.quantities.reaction import Reaction
from tmm_cli.synthesis.optimal.quantities.speed import Speed
from tmm_cli.synthesis.optimal.quantities.stroke import Stroke

QUANTITIES: Final[Mapping[str, type[Goal]]] = {  # as problem files write them
    "length": Length,
    "mass": Mass,
    "box": Box,
    "pressure": Pressure,
    "moment": Moment,
    "reaction": Reaction,
    "margin": Margin,
    "stroke": Stroke,
    "k": K,
    "speed": Speed,
    "path": Path,
    "law": Law,
}
