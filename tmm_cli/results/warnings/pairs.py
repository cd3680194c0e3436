"""Pairs that repeat conditions, slots that are left, pressure angles, cams that hit."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import _, numeral
from tmm_cli.quantities import ANGLE, LENGTH
from tmm_cli.results.table import with_unit
from tmm_cli.results.warnings.motion import driver_place


def passive_pairs(results: Results) -> Iterable[str]:
    """Pairs without which the links would be held where they are."""
    for passive in results.structure.passive:
        i, j = passive.links
        yield _(
            "pair {pair} holds link {j} on link {i} where it would be without it: this works with "
            "exact dimensions only, and the reactions of links {among} are indeterminate (given: the "
            "least ones)"
        ).format(pair=passive.pair, i=i, j=j, among=", ".join(passive.among))


def left_slots(results: Results) -> Iterable[str]:
    """Stones that leave the segment of their guide."""
    units, driver_range = results.problem.units, results.driver_range
    assert driver_range is not None
    cycle = driver_range.end - driver_range.start
    for excess in results.slots:
        slide, ways = excess.slide, []
        for start, end in excess.ways:
            first = start % cycle if driver_range.full else start
            way = _("from {start} to {end}")
            if end - start >= cycle * (1 - 1e-9):
                way = _("everywhere")
            elif start == end:
                way = _("at {start}")
            ways.append(way.format(start=driver_place(results, first), end=driver_place(results, first + end - start)))
        if ways:
            yield _(
                "link {runner} leaves its slot {slot} of link {carrier}, which is {length} long: it is up to {far} "
                "beyond {point} (driver {ways}); a longer slot, or slides: {{..., unbounded: true}} where it is meant"
            ).format(
                runner=slide.runner, slot="".join(slide.ends or ()), carrier=slide.carrier, point=excess.point,
                length=with_unit(units, excess.length, LENGTH), far=with_unit(units, excess.far, LENGTH),
                ways=", ".join(ways),
            )  # fmt: skip


def pressure_angles(results: Results) -> Iterable[str]:
    """Pressure angles beyond what the file allows, or what is usual where a synthesis chose them freely."""
    units, limits_set = results.problem.units, results.problem.limits_set
    chosen = results.driver_range is not None and results.driver_range.full and _chosen_freely(results)
    if not (chosen or any(limits_set)):
        return
    for pressure in results.pressure:
        said = limits_set[0 if pressure.slides else 1]
        if pressure.holds or not (chosen or said):
            continue
        largest, allowed = (with_unit(units, angle, ANGLE, 4) for angle in (pressure.largest, pressure.allowed))
        text = (
            _("the pressure angle on link {link} comes to {largest}, the file allows {allowed}")
            if said
            else _(
                "the pressure angle on link {link} comes to {largest}; usual is at most {allowed} "
                "(another limit: checks: {{{check}: ...}})"
            )
        )
        check = "pressure_sliding" if pressure.slides else "pressure_turning"
        yield text.format(link=pressure.link, largest=largest, allowed=allowed, check=check)


def _chosen_freely(results: Results) -> bool:
    """Whether a synthesis found the linkage, and was asked nothing about its pressure angle."""
    found = results.problem.synthesis
    if found is None:
        return False
    asked = [d for d in found.outcome.demands if d.asked or found.task == "optimal"]
    return not any(d.of == "pressure" for d in asked)


def impacts(results: Results) -> Iterable[str]:
    """Cams whose law has jumps of the follower's speed."""
    units = results.problem.units
    for mesh in results.linkage.meshes:
        jumps = mesh.law.jumps() if mesh.law is not None else ()
        if jumps:
            places = ", ".join(numeral(units.from_si(a, ANGLE), ".6g") for a in jumps)
            yield _(
                "the law of cam {cam} lets the speed of follower {follower} jump ({places} of the cam): "
                "a hard impact, the acceleration there is not finite and is not in the tables"
            ).format(cam=mesh.i, follower=mesh.j, places=f"{places} {units.spelt(ANGLE)}")
