"""The mechanism in all positions with trajectories; a position in detail with its loads."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.figure import Figure

from tmm_cli.cycle import DENSE
from tmm_cli.draw.actuators import driver_arrows, driver_name
from tmm_cli.draw.scheme import beyond, mechanism, moving_points, placer, reach, skeleton, trajectory
from tmm_cli.draw.sheet import COLOURS, DARK, LOAD, REACTION, Sheet, scale_text
from tmm_cli.draw.symbols import turning_arrow
from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results, at_positions
from tmm_cli.plans.record import balance_name
from tmm_cli.problem.dimensions import ANGLE, LENGTH
from tmm_cli.words import say

LOAD_MM = 18.0  # loads are drawn without a scale, as long as one another (guidelines, 2.3.2)
SHOWN = 48  # positions drawn thin, at most


def caption(results: Results, k: int) -> str:
    """Which position it is and where the driver stands."""
    motion, units = results.motion, results.problem.units
    assert motion is not None
    crank = results.linkage.driver.kind == "turn"
    q = float(np.mod(motion.q[k], 2 * np.pi) if crank else motion.q[k])
    measure = ANGLE if crank else LENGTH
    key = "draw.at_crank" if crank else "draw.at_slider"
    return say(key, number=results.numbers[k], place=f"{units.from_si(q, measure):.6g} {units.symbol(measure)}")


def all_positions(results: Results) -> Iterable[tuple[str, Figure]]:
    """One sheet: every position thin, the first detailed one in full, dashed trajectories, numbers at the crank."""
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    whole = at_positions(results, results.closely(DENSE), 0)
    points = moving_points(linkage)
    used = [linkage.local(FRAME, h.point) for h in linkage.hinges if FRAME in h.links]
    chosen = detailed(results)
    k = chosen[0] if chosen else int(np.argmax(motion.placed))
    used += [p for name in points for p in whole.spot(name)]
    sheet = Sheet(
        results.problem.title, say("draw.mechanism", count=len(results.numbers)), [*used, *beyond(motion, k, used)]
    )
    for name in points:
        trajectory(sheet, whole.spot(name))
    for other in range(0, len(results.numbers), max(1, len(results.numbers) // SHOWN)):
        if other != k and motion.placed[other]:
            skeleton(sheet, motion, other)
    if motion.placed[k]:
        _arrows(sheet, results, k, mechanism(sheet, motion, k))
    _numbers(sheet, results)
    sheet.note(scale_text("l", sheet.mu, "m/mm"))
    sheet.note(say("draw.bold", number=results.numbers[k]))
    yield "mechanism", sheet.finish()


def _arrows(sheet: Sheet, results: Results, k: int, drawn: dict[str, tuple[complex, complex]]) -> None:
    """How each driver goes."""
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    place = placer(motion, k)
    for driver, pivot in driver_arrows(sheet, linkage, place, drawn, LOAD):
        own = linkage.links[driver.link].points
        ends = [sheet.on(place(driver.link, local)) - pivot for local in own.values()]
        arm = max(ends, key=abs, default=1 + 0j)
        turning_arrow(sheet, pivot, float(np.angle(arm)), driver.sense, driver_name(driver, "ω"), LOAD)


def _numbers(sheet: Sheet, results: Results) -> None:
    """Numbers of positions at the crank's end, outside its circle."""
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    driver = linkage.driver
    if driver.kind != "turn" or len(results.numbers) > SHOWN // 2:
        return
    pivot = sheet.on(linkage.local(FRAME, driver.joint))
    ends = [p for p in linkage.links[driver.link].points if p != driver.joint]
    if not ends:
        return
    found: list[tuple[complex, list[str]]] = []
    for at, number in zip((sheet.on(complex(x)) for x in motion.named(ends[0]).x), results.numbers, strict=True):
        same = next((numbers for place, numbers in found if abs(place - at) < 0.5), None)
        if same is None:  # in a cycle of several turns the crank comes back to its places
            found.append((at, [str(number)]))
        else:
            same.append(str(number))
    for at, numbers in found:
        out = (at - pivot) / abs(at - pivot)
        sheet.circle(at, 0.5, DARK, DARK, 0.3, 5)
        sheet.label(", ".join(numbers), at + 1.5 * out, 8, "#404040")


def detailed(results: Results) -> list[int]:
    """Indices of the positions in detail that could be computed."""
    motion = results.motion
    assert motion is not None
    wanted = results.problem.request.detail if len(results.numbers) > 1 else results.numbers
    return [k for k, n in enumerate(results.numbers) if n in wanted and motion.moving[k] and not results.locked[k]]


def stem(name: str, results: Results, k: int) -> str:
    """velocity-03."""
    return f"{name}-{results.numbers[k]:02d}"


def position(results: Results, k: int) -> Iterable[tuple[str, Figure]]:
    """The position with weights, inertia forces and couples, loads, and what balances the crank."""
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    places = [linkage.local(FRAME, h.point) for h in linkage.hinges if FRAME in h.links]
    places += [complex(motion.named(p).x[k]) for p in moving_points(linkage)]
    places += [complex(motion.centre(n).x[k]) for n in linkage.moving]
    loads = results.reactions.applied if results.reactions is not None else ()
    places += [complex(motion.point(load.link, load.at).x[k]) for load in loads]
    sheet = Sheet(results.problem.title, caption(results, k), [*places, *beyond(motion, k, places)], pad=30)
    mechanism(sheet, motion, k)
    if results.reactions is not None:
        taken: list[tuple[complex, complex]] = []
        coupled: list[complex] = []
        for load in results.reactions.applied:
            at = sheet.on(complex(motion.point(load.link, load.at).x[k]))
            force, moment = complex(load.force[k]), float(load.moment[k])
            colour = COLOURS["inertia" if load.kind == "inertia" else "load"]
            if abs(force) > 0:
                end = at + (LOAD_MM + stacked(taken, at, force)) * force / abs(force)
                if load.kind == "load" and len(linkage.links[load.link].points) == 1:
                    reach(sheet, motion, load.link, at, k)
                sheet.arrow(at, end, colour, 1.3)
                sheet.label(load.name, end, 9, colour)
            if moment != 0:
                radius = 5.5 + 2.6 * sum(abs(at - other) < 1 for other in coupled)
                coupled.append(at)
                couple(sheet, at, np.sign(moment), colour, load.couple_name or load.name, radius)
        _balance(sheet, results, k)
        sheet.note(say("draw.loads"))
    sheet.note(scale_text("l", sheet.mu, "m/mm"))
    yield stem("position", results, k), sheet.finish()


def _balance(sheet: Sheet, results: Results, k: int) -> None:
    assert results.reactions is not None
    several = len(results.reactions.balances) > 1
    for balance in results.reactions.balances:
        name = balance_name(balance.driver.link, several)
        if balance.kind == "moment" and balance.moment is not None:
            pivots = [f.at for f in results.reactions.frames if f.on == balance.driver.link]
            pivot = sheet.on(complex((pivots[0] if pivots else balance.at)[k]))
            couple(sheet, pivot, np.sign(float(balance.moment[k])), REACTION, name.replace("F", "M", 1), 7.5)
        elif abs(balance.vector[k]) > 0:
            at = sheet.on(complex(balance.at[k]))
            end = at + LOAD_MM * complex(balance.vector[k] / abs(balance.vector[k]))
            sheet.arrow(at, end, REACTION, 1.5)
            sheet.label(name, end, 9, REACTION)


def stacked(taken: list[tuple[complex, complex]], at: complex, force: complex) -> float:
    """How much longer (mm) an arrow is drawn so that it shows beside others from the same place and direction."""
    along = force / abs(force)
    alike = sum(abs(at - place) < 1 and abs(along - other) < 0.05 for place, other in taken)
    taken.append((at, along))
    return 9.0 * alike


def couple(sheet: Sheet, at: complex, sense: float, colour: str, name: str, radius: float) -> None:
    """A couple as an open circle with an arrow head in its sense."""
    if sense == 0:
        return
    angles = np.linspace(0.35 * np.pi, 1.75 * np.pi, 40)[:: int(sense)]
    arc = [at + radius * complex(np.cos(a), np.sin(a)) for a in angles]
    sheet.line(arc[:-4], colour, 1.2, z=5)
    sheet.arrow(arc[-9], arc[-1], colour, 1.2)
    sheet.label(name, arc[20], 9, colour)
