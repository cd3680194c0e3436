"""What was asked for, measured on the analysed mechanism."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tmm_cli.synthesis.record import Demand, Outcome

if TYPE_CHECKING:
    from tmm_cli.pipeline import Results

MET = 1e-9  # relative: what differs by more is not met
ROUNDING = 1e-12  # relative: what is smaller is zero


@dataclass(frozen=True)
class Measured:
    """A demand, its value on the mechanism (SI, rad; nan: there is none), and the relative difference."""

    demand: Demand
    value: float
    difference: float

    @property
    def met(self) -> bool:
        return self.difference <= MET


def measured(outcome: Outcome, results: Results) -> tuple[Measured, ...]:
    """Every demand on the mechanism."""
    values = [(demand, _settled(demand, float(demand.measure(results)))) for demand in outcome.demands]
    return tuple(Measured(demand, value, demand.difference(value)) for demand, value in values)


def _settled(demand: Demand, value: float) -> float:
    """The same; zero where it is nothing but rounding beside what counts."""
    return 0.0 if abs(value) <= ROUNDING * max(abs(demand.value), demand.at) else value
