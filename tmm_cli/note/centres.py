"""Chapter on instantaneous centres: their number, Kennedy's theorem, velocities of links from distances of centres."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol, subscript
from tmm_cli.mechanics.kinematics import InstantCentre, LinkPair
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_VECTOR
from tmm_cli.note.blocks import Block, Heading, write_sentence
from tmm_cli.note.expression import ComputedQuantity, Leaf
from tmm_cli.note.subject import Subject, note_table
from tmm_cli.reports import centre_name, walk

ALL, LINKS = Symbol("N"), Symbol("k")


def write_centres(subject: Subject) -> Iterable[Block]:
    """Write the chapter on instantaneous centres. It is empty if the file does not request them."""
    results = subject.results
    if not results.centres:
        return
    yield Heading(_("Instantaneous centres"))
    yield write_sentence(
        _(
            "Any two links have an instantaneous centre: the point at which both have the same velocity. The "
            "number of instantaneous centres of {k} links, including the frame, is"
        ),
        k=LINKS,
    )
    count = len(results.linkage.links)
    link_count = Leaf(LINKS, float(count))
    yield ComputedQuantity(ALL, link_count * (link_count - 1) / 2, count * (count - 1) / 2, whole=True)
    yield write_sentence(
        _(
            "The instantaneous centre of two links joined by a hinge is the hinge; that of two links joined by "
            "a prismatic pair is at infinity, perpendicular to the guide. By Kennedy's theorem the three "
            "centres of any three links lie on one line, so every other centre is the intersection of two such "
            "lines; the table names these lines."
        )
    )
    yield from (note_table(subject, table) for table in walk(results, ("centres",)))
    yield from subject.figures(
        "centres",
        _("The instantaneous centres are shown in figure {figure}."),
        further=_("The instantaneous centres in another position are shown in figure {figure}."),
    )
    if results.linkage.driver.kind == "turn" and not results.linkage.others:
        yield from _write_speeds(subject)


def _write_speeds(subject: Subject) -> Iterable[Block]:
    results = subject.results
    assert results.centres is not None
    text = _(
        "At the instantaneous centre of a link and the input link both have the same velocity. The "
        "distances between centres therefore give the angular velocity of the link or, if it does not "
        "rotate, its velocity. Position {number}:"
    )
    for k, centres in results.centres.items():
        speeds = list(_compute_speeds(subject, k, {centre.links: centre for centre in centres}))
        if speeds:
            yield write_sentence(text, number=subject.position_number(k))
            yield from speeds
            text = _("Position {number}:")


def _compute_speeds(subject: Subject, k: int, centres: Mapping[LinkPair, InstantCentre]) -> Iterable[ComputedQuantity]:
    motion = subject.motion
    driver = motion.linkage.driver.link
    driver_speed = abs(subject.rate(k))
    rate, pivot = Leaf(Symbol("ω", driver), driver_speed), centres[FRAME, driver]
    for link in motion.linkage.moving:
        if link == driver or pivot.place is None or not driver_speed:
            continue
        to_frame = centres[FRAME, link]
        to_driver = centres[(driver, link) if (driver, link) in centres else (link, driver)]
        if to_driver.place is None:
            continue
        reached = rate * _distance(pivot, to_driver)
        if to_frame.place is None and to_frame.direction is not None:
            speed = abs(complex(motion.point(link, 0j).v[k]))
            yield ComputedQuantity(Symbol("v", link), reached, speed, _("m/s"))
        elif to_frame.place is not None:
            other, turning = _distance(to_frame, to_driver), abs(float(motion.link(link).omega[k]))
            if turning > NO_VECTOR * driver_speed and other.value:
                yield ComputedQuantity(Symbol("ω", link), reached / other, turning, _("rad/s"))


def _distance(first: InstantCentre, second: InstantCentre) -> Leaf:
    """Return the distance (m) between two instantaneous centres as a quantity with a symbol such as P₁₂P₁₃."""
    assert first.place is not None and second.place is not None
    letters = "".join("P" + subscript(centre_name(centre.links)[1:]) for centre in (first, second))
    return Leaf(Symbol(letters), abs(second.place - first.place))
