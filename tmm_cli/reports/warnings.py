"""Warnings about results. To add a warning, write a function that yields sentences, and add it to WARNINGS."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.reports import force_warnings as forces, motion_warnings as motion
from tmm_cli.reports.elements.view import element_warnings
from tmm_cli.reports.synthesis_quality import unusable_mechanism

WARNINGS: tuple[Callable[[Results], Iterable[str]], ...] = (  # of results with a motion, in the order they are said
    motion.limited_driver,
    motion.far_from_sketch,
    motion.dead_positions,
    motion.unreached_positions,
    motion.stopped_driver,
    motion.opposite_run,
    motion.short_drive,
    motion.near_dead,
    motion.passive_pairs,
    motion.unrepeated_cycle,
    motion.left_slots,
    motion.excessive_pressure_angles,
    unusable_mechanism,
    forces.locked_positions,
    element_warnings,
    motion.cam_impacts,
    forces.driving_loads,
    forces.short_tables,
    forces.long_tables,
    forces.open_tables,
    forces.loads_without_strokes,
    forces.unmet_demands,
    forces.lever_disagreement,
)
IN_CHECKS = (
    motion.left_slots,
    motion.excessive_pressure_angles,
    forces.lever_disagreement,
)  # the table of checks has them with numbers


def collect_warnings(results: Results | ChainResults, *, checked: bool = True) -> Iterable[str]:
    """Yield the warnings about results as sentences, with values in the units of the file.

    checked: False to omit warnings about quantities that the table of checks contains.
    """
    if isinstance(results, ChainResults) or results.motion is None or results.driver_range is None:
        return
    for warning in WARNINGS:
        if checked or warning not in IN_CHECKS:
            yield from warning(results)
