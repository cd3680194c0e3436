"""The drivers, the positions of the cycle, the extreme positions of the output with its stroke."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.drawing.paper import Picture
from tmm_cli.language import _, symbol
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.kinematics import Strokes, Travel
from tmm_cli.mechanics.linkage import FRAME, Driver
from tmm_cli.mechanics.numerics import NO_VECTOR
from tmm_cli.note.blocks import Block, Equation, said
from tmm_cli.note.context import Subject
from tmm_cli.note.expression import Constant, Found, Function, Leaf
from tmm_cli.note.kinematics.equations import sense
from tmm_cli.note.kinematics.on_paper import Here, unit
from tmm_cli.note.math import Letter, Number, Words, row
from tmm_cli.reports import between_rows

ROUND = 1e-9  # of a speed in rpm that was given as such


def drivers(subject: Subject) -> Iterable[Block]:
    """How each driving link moves."""
    running = subject.results.running
    for driver in subject.results.linkage.drivers:
        if running is not None:
            yield said(
                _(
                    "How fast driving link {link} moves follows from its law of motion, which is found below: it needs "
                    "ratios of velocities only, and these are the same at every speed."
                ),
                link=driver.link,
            )
            continue
        yield from _turning(subject, driver) if driver.kind == "turn" else _sliding(subject, driver)


def _turning(subject: Subject, driver: Driver) -> Iterable[Block]:
    own = driver.link if driver.base == FRAME else driver.link + driver.base
    omega, n = Symbol("ω", "0" if driver.acceleration else own), driver.rate * 30 / np.pi
    rpm = abs(n - float(f"{n:.7g}")) <= ROUND * n
    text = _("Driving link {link} turns about point {point} {sense} with the angular velocity")
    if driver.law is not None:
        text = _(
            "Driving link {link} turns about point {point} {sense}; its angular velocity is given by a table ({how})."
        )
    elif driver.base != FRAME:
        text = _(
            "Driving link {link} turns about point {point} of link {base}, {sense}, with the relative angular velocity"
        )
    elif rpm:
        text = _("Driving link {link} turns about point {point} {sense} at {n} = {speed} rpm; its angular velocity is")
    how = "" if driver.law is None else between_rows(driver.law)
    yield said(
        text,
        link=driver.link,
        point=driver.joint,
        base=driver.base,
        sense=sense(driver.sense),
        how=how,
        n=Symbol("n", own),
        speed=subject.text(n, 6),
    )
    if driver.law is not None:
        return
    if rpm:
        yield Found(omega, Constant(float(np.pi), "π") * Leaf(Symbol("n", own), n) / 30, driver.rate, unit("ω"))
    else:
        yield _given(subject, omega, driver.rate)
    if driver.acceleration:
        yield said(_("in position 0 and with the angular acceleration"))
        yield _given(subject, Symbol("ε", own), driver.acceleration)


def _sliding(subject: Subject, driver: Driver) -> Iterable[Block]:
    slide = subject.results.linkage.slide(driver.joint)
    own = slide.point if driver.base == FRAME else f"{slide.point}{slide.point}{slide.carrier}"
    text = _("Driving link {link} slides along its guide on the frame with the velocity")
    if driver.base != FRAME:
        text = _(
            "Driving link {link} is moved along link {base} (a cylinder with its piston) with the relative velocity"
        )
    yield said(text, link=driver.link, base=driver.base)
    yield _given(subject, Symbol("v", "0" if driver.acceleration else own), driver.rate)
    if driver.acceleration:
        yield said(_("in position 0 and with the acceleration"))
        yield _given(subject, Symbol("a", own), driver.acceleration)


def _given(subject: Subject, name: Symbol, value: float) -> Block:
    return Equation(row(Letter(name), "=", Number(subject.text(value)), Words(f" {unit(name.letter)}")))


def speed_here(here: Here) -> Iterable[Block]:
    """The speed in a position of a first driver that does not keep it."""
    results, motion = here.subject.results, here.motion
    driver, turns = motion.linkage.driver, motion.linkage.driver.kind == "turn"
    if driver.law is not None or results.running is not None:
        yield said(_("By the law of motion its speed and its acceleration are here"))
        for letter, values in zip("ωε" if turns else "va", (motion.rate, motion.acceleration), strict=True):
            value = float(np.broadcast_to(values, motion.q.shape)[here.k])
            yield _given(here.subject, Symbol(letter, driver.link), value)
        return
    if not driver.acceleration:
        return
    letter, rate, way = ("ω", "ε", "φ") if turns else ("v", "a", "s")
    begins = results.linkage.sketch.at if results.linkage.others else results.start
    gone = driver.sense * (float(motion.q[here.k]) - begins)
    run, start, now = Leaf(Symbol(f"Δ{way}"), gone), Leaf(Symbol(letter, "0"), driver.rate), Symbol(letter, driver.link)
    yield said(
        _(
            "Since position 0 the driving link has gone through {gone}; its speed {speed} follows from the even "
            "acceleration:"
        ),
        gone=run.symbol,
        speed=now,
    )
    root = Function("sqrt", start**2 + 2 * Leaf(Symbol(rate, driver.link), driver.acceleration) * run)
    yield Found(now, root, abs(float(motion.rate[here.k])), unit(letter))


def positions(subject: Subject) -> Iterable[Block]:
    """How many there are and from where on; the plan of positions; extreme positions with the stroke."""
    results = subject.results
    request, count = results.inputs.request, len(results.asked)
    full = results.driver_range is not None and results.driver_range.full and results.linkage.driver.kind == "turn"
    text = _("The way of the driving link is studied in {count} positions.")
    if request.places:
        text = _("The mechanism is studied in {count} given positions of the driving link.")
    elif full and request.start == "working stroke":
        text = _("The cycle is divided into {count} equal parts; position 0 is the beginning of the working stroke.")
    elif full:
        text = _("The cycle is divided into {count} equal parts.")
    if count > 1:
        yield said(text, count=str(count))
    for drawing in subject.drawings("positions").values():
        if isinstance(drawing, Picture) and drawing.mu is not None:
            text = _("The scale factor of the plan of positions is {mu} = {value} m/mm.")
            yield said(text, mu=Symbol("μ", "l"), value=subject.text(drawing.mu))
    yield from subject.figures(
        "positions", _("The plan of positions is shown in figure {figure}."), _("Plan of positions of the mechanism")
    )
    for strokes in results.swinging:
        yield from _extremes(subject, strokes)
    for travel in results.travels:
        yield from _travel(subject, travel)


def _extremes(subject: Subject, strokes: Strokes) -> Iterable[Block]:
    """Where the output turns back, how far it goes, and how long each way takes."""
    places = ", ".join(f"{subject.text(_degrees(s.start % strokes.cycle))}°" for s in strokes.strokes)
    slides = strokes.kind == "slide"
    size, letter = (strokes.travel, "H") if slides else (float(np.degrees(strokes.travel)), "ψ")
    shown = (Letter(Symbol(letter)), "=", Number(subject.text(size)), Words(" " + _("m") if slides else "°"))
    text = _(
        "The output, {output}, is in its extreme positions at the angles {phi} = {places} of the driving link; "
        "it swings between them through {size}."
    )
    if slides:
        text = _(
            "The output, {output}, is in its extreme positions at the angles {phi} = {places} of the driving "
            "link; its stroke between them is {size}."
        )
    yield said(text, output=output(subject, strokes.link), phi=Symbol("φ"), places=places, size=row(*shown))
    if not np.isfinite(strokes.k):
        return
    working = sum(s.length for s in strokes.working)
    idle = sum(s.length for s in strokes.strokes if not s.working)
    text = _(
        "During the working stroke the driving link turns through {working}, during the idle one through {idle}; "
        "the coefficient of change of mean speed is {k}:"
    )
    if len(strokes.strokes) > 2:
        text = _(
            "During the working strokes of a cycle the driving link turns through {working} in all, during the "
            "idle ones through {idle}; the coefficient of change of mean speed is {k}:"
        )
    yield said(text, k=Symbol("k"), working=Symbol("φ", symbol("w")), idle=Symbol("φ", symbol("i")))
    ratio = Leaf(Symbol("φ", symbol("w")), working, angle=True) / Leaf(Symbol("φ", symbol("i")), idle, angle=True)
    yield Found(Symbol("k"), ratio, strokes.k)


def _travel(subject: Subject, travel: Travel) -> Iterable[Block]:
    slides = travel.kind == "slide"
    ends = (travel.low, travel.high)
    low, high = (f"{subject.text(end)} {_('m')}" if slides else f"{subject.text(_degrees(end))}°" for end in ends)
    text = _("Over this way the output, {output}, goes from {low} to {high}.")
    yield said(text, output=output(subject, travel.link), low=low, high=high)


def _degrees(angle: float) -> float:
    """Without what only rounding leaves of zero."""
    found = float(np.degrees(angle))
    return 0.0 if abs(found) < NO_VECTOR else found


def output(subject: Subject, link: str) -> str:
    """A link, or a coordinate of a point."""
    return _("link {link}").format(link=link) if link in subject.results.linkage.links else link


def place_here(here: Here) -> Block:
    """Where the driving link is in a position."""
    driver, q, number = here.motion.linkage.driver, float(here.motion.q[here.k]), here.subject.called(here.k)
    if driver.kind == "turn":
        text = _("In position {number} the driving link is at the angle {phi} = {angle}° to the axis x.")
        angle = here.subject.text(_degrees(q % (2 * np.pi)))
        return said(text, number=number, phi=Symbol("φ", driver.link), angle=angle)
    text = _("In position {number} the driving link is at {run} = {place} m.")
    return said(text, number=number, run=Symbol("s", driver.link), place=here.subject.text(q))
