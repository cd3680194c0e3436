"""Drawings; matplotlib is imported here and nowhere else. A new sheet is a function in a file here and a line below."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from matplotlib.figure import Figure

from tmm_cli.draw.diagrams import diagrams
from tmm_cli.draw.groups import groups
from tmm_cli.draw.mechanism import all_positions, detailed, position
from tmm_cli.draw.plans import acceleration, forces, lever, velocity
from tmm_cli.draw.sheet import picture
from tmm_cli.draw.structure import structure
from tmm_cli.draw.synthesis import synthesised
from tmm_cli.pipeline import Results

Drawn = Iterable[tuple[str, Figure]]
OF_THE_SYNTHESIS: tuple[Callable[[Results], Drawn], ...] = (synthesised,)
OF_THE_STRUCTURE: tuple[Callable[[Results], Drawn], ...] = (structure, groups)
OF_THE_CYCLE: tuple[Callable[[Results], Drawn], ...] = (all_positions, diagrams)
OF_A_POSITION: tuple[Callable[[Results, int], Drawn], ...] = (position, velocity, acceleration, forces, lever)


def sheets(results: Results) -> Drawn:
    """Every sheet with its file's stem: those of the structure, of the cycle, then of each position in detail."""
    for of_structure in OF_THE_STRUCTURE:
        yield from of_structure(results)
    if results.motion is None:
        return
    for of_synthesis in OF_THE_SYNTHESIS:
        yield from of_synthesis(results)
    if bool(results.motion.placed.any()):
        for of_cycle in OF_THE_CYCLE:
            yield from of_cycle(results)
    for k in detailed(results):
        for of_position in OF_A_POSITION:
            yield from of_position(results, k)


def files(results: Results) -> Iterable[tuple[str, bytes]]:
    """Every sheet as PNG and SVG."""
    for stem, figure in sheets(results):
        for kind in ("png", "svg"):
            yield f"{stem}.{kind}", picture(figure, kind)
