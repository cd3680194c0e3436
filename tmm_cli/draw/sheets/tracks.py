"""Along what the positions of a mechanism are numbered: the way of its output, and that of its driver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.groups.sequence import LinkStates
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.plans.record import subscript
from tmm_cli.tolerances import SAME_PLACE
from tmm_cli.vectors import Vector, unit


@dataclass(frozen=True)
class Extreme:
    """An end of the output's way: the driver's place (rad or m), and its mark, a number where it is a position."""

    q: float
    mark: str


@dataclass(frozen=True)
class Track:
    """The way of a point of the output: along a line, about a pivot, or any.

    line, pivot: direction and place of it, of the two kinds that have one (m).
    """

    kind: Literal["line", "arc", "any"]
    link: str
    local: complex
    line: complex = 1.0
    pivot: complex = 0j

    def places(self, states: LinkStates) -> Vector:
        """Of the point in these positions, m."""
        return states.poses[self.link].at(self.local)


def extremes(results: Results) -> list[Extreme]:
    """Ends of the strokes in order, or of what is asked for where the driver does not turn fully."""
    strokes, travels = results.strokes, results.travels
    if strokes is not None and strokes.strokes:
        cycle, ends = strokes.cycle, [stroke.start for stroke in strokes.strokes]
        last = strokes.strokes[-1]
        if len(ends) == 1:
            ends.append(last.start + results.linkage.driver.sense * last.length)
    elif travels and travels[0].high - travels[0].low > SAME_PLACE:
        cycle, ends = np.inf, [travels[0].low_at, travels[0].high_at]
    else:
        return []
    found: list[Extreme] = []
    asked = results.asked[list(results.numbers)]
    for q in ends:
        off = np.abs(asked - q) if np.isinf(cycle) else np.abs((asked - q + cycle / 2) % cycle - cycle / 2)
        here = int(np.argmin(off))
        found.append(Extreme(float(q), str(results.numbers[here]) if off[here] < SAME_PLACE else ""))
    between = [extreme for extreme in found if not extreme.mark]
    for number, extreme in enumerate(between, 1):
        mark = "k" + ("" if len(between) == 1 else "′" * (number - 1) if len(between) == 2 else subscript(str(number)))
        found[found.index(extreme)] = Extreme(extreme.q, mark)
    return found


def travel(results: Results) -> float:
    """The stroke (m) or the swing (rad) of the main output between its ends."""
    strokes, travels = results.strokes, results.travels
    if strokes is not None and strokes.strokes:
        return strokes.travel
    return abs(travels[0].high - travels[0].low) if travels else 0.0


def output_track(results: Results) -> Track | None:
    """Of the main output; None where there is none."""
    linkage, link = results.linkage, results.mechanism.output
    if link is None:
        return None
    point = linkage.output_point(link)
    if point is not None:
        return Track("any", linkage.owner(point), linkage.local(linkage.owner(point), point))
    slide = linkage.output_guide(link)
    if slide is None:
        return swinging(linkage, link)
    runs = linkage.slides_on_frame(link)
    if slide.runner == FRAME:  # the guide moves
        return Track("any", link, 0j)
    return Track("line" if runs else "any", link, slide.at, line=complex(unit(slide.direction)))


def swinging(linkage: Linkage, link: str) -> Track:
    """Of the point of a link that is farthest from its pivot on the frame, or of its first one where it has none."""
    points = linkage.links[link].points
    pivot = next((p for p in points if p in linkage.links[FRAME].points and linkage.hinged_to_frame(link)), None)
    if pivot is None or len(points) < 2:
        return Track("any", link, next(iter(points.values()), 0j))
    own = points[pivot]
    end = max(points.values(), key=lambda local: abs(local - own))
    return Track("arc", link, end, pivot=linkage.local(FRAME, pivot))


def driver_track(results: Results) -> Track | None:
    """Of the end of the crank, or of the driven slider; None of a wheel without a point."""
    linkage, driver = results.linkage, results.linkage.driver
    if driver.kind == "turn":
        ends = [local for name, local in linkage.links[driver.link].points.items() if name != driver.joint]
        return Track("any", driver.link, ends[0]) if ends else None
    slide = linkage.slide(driver.joint)
    if driver.base == FRAME and slide.runner == driver.link:
        return Track("line", driver.link, slide.at, line=complex(unit(slide.direction)))
    return Track("any", driver.link, slide.at)


def extreme_states(results: Results, found: list[Extreme]) -> LinkStates:
    """The mechanism at the ends of the output's way."""
    return at_positions(results, np.array([extreme.q for extreme in found]), 0)
