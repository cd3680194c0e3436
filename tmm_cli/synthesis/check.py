"""What was asked for, measured on the analysed mechanism."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from tmm_cli.analysis.pipeline import Results
from tmm_cli.linkage import FRAME, Output
from tmm_cli.synthesis.record import Demand, Outcome
from tmm_cli.tolerances import MET, NO_DEMAND


@dataclass(frozen=True)
class MeasuredDemand:
    """A demand, its value on the mechanism (SI, rad; nan: there is none), and the relative difference.

    open: by how much of it rounding leaves the value open, where that is more than is tolerated.
    """

    demand: Demand
    value: float
    difference: float
    open: float = 0.0

    @property
    def met(self) -> bool:
        return self.difference <= max(MET, self.open)


@lru_cache(maxsize=1)
def measured_on(results: Results) -> tuple[MeasuredDemand, ...]:
    """What a problem's synthesis asked and foretold, on its mechanism; nothing where there is none, or no motion."""
    synthesis = results.problem.synthesis
    if synthesis is None or results.of or results.motion is None:
        return ()
    return measured(synthesis.outcome, results)


def measured(outcome: Outcome, results: Results) -> tuple[MeasuredDemand, ...]:
    """Every demand on the mechanism, of the link that the task is about, whatever the file's output is."""
    results, found = _about(synthesised_link(outcome, results), results), []
    for demand in outcome.demands:
        value = _settled(demand, float(demand.measure(results)))
        left = demand.open(results) if demand.open is not None else 0.0
        found.append(MeasuredDemand(demand, value, demand.difference(value), left if left > MET else 0.0))
    return tuple(found)


def synthesised_link(outcome: Outcome, results: Results) -> str | None:
    """The link whose stroke or swing the task found: of those of its kind on the frame the nearest to the driver.

    The file's output if it is one of them, or the task says nothing of a kind.
    """
    linkage, output = results.linkage, results.mechanism.output
    on_frame = {"slide": linkage.slides_on_frame, "swing": linkage.hinged_to_frame}.get(outcome.output)
    if on_frame is None:
        return output
    away = {FRAME: 0} | {driver.link: 0 for driver in linkage.drivers}  # groups from the driver to a link
    for group in results.structure.all_groups:
        away |= dict.fromkeys(group.links, 1 + max(away[link] for link in group.known))
    links = [link for group in results.structure.all_groups for link in group.links if on_frame(link)]
    return min(links, key=lambda link: (away[link], link != output), default=output)


def _about(link: str | None, results: Results) -> Results:
    """The same with another link as the output."""
    mechanism = results.mechanism
    if link is None or link == mechanism.output:
        return results
    inputs = replace(results.inputs, linkage=replace(results.linkage, output=Output(link), outputs=(Output(link),)))
    other = replace(mechanism, inputs=inputs).known(kernels=mechanism.kernels, driver_range=mechanism.driver_range)
    return replace(results, inputs=inputs, mechanism=other)


def _settled(demand: Demand, value: float) -> float:
    """The same; zero where it is nothing but rounding beside what counts."""
    return 0.0 if abs(value) <= NO_DEMAND * max(abs(demand.value), demand.at) else value
