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
    own = Leaf(LINKS, float(count))
    yield ComputedQuantity(ALL, own * (own - 1) / 2, count * (count - 1) / 2, whole=True)
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
    for k, found in results.centres.items():
        told = list(_compute_speeds(subject, k, {centre.links: centre for centre in found}))
        if told:
            yield write_sentence(text, number=subject.position_number(k))
            yield from told
            text = _("Position {number}:")


def _compute_speeds(subject: Subject, k: int, found: Mapping[LinkPair, InstantCentre]) -> Iterable[ComputedQuantity]:
    motion = subject.motion
    driver = motion.linkage.driver.link
    own = abs(subject.rate(k))
    rate, pivot = Leaf(Symbol("ω", driver), own), found[FRAME, driver]
    for link in motion.linkage.moving:
        if link == driver or pivot.place is None or not own:
            continue
        here = found[FRAME, link]
        both = found[(driver, link) if (driver, link) in found else (link, driver)]
        if both.place is None:
            continue
        reached = rate * _distance(pivot, both)
        if here.place is None and here.direction is not None:
            speed = abs(complex(motion.point(link, 0j).v[k]))
            yield ComputedQuantity(Symbol("v", link), reached, speed, _("m/s"))
        elif here.place is not None:
            other, turning = _distance(here, both), abs(float(motion.link(link).omega[k]))
            if turning > NO_VECTOR * own and other.value:
                yield ComputedQuantity(Symbol("ω", link), reached / other, turning, _("rad/s"))


def _distance(one: InstantCentre, other: InstantCentre) -> Leaf:
    """Return the distance (m) between two instantaneous centres, with a symbol such as P₁₂P₁₃."""
    assert one.place is not None and other.place is not None
    letters = "".join("P" + subscript(centre_name(centre.links)[1:]) for centre in (one, other))
    return Leaf(Symbol(letters), abs(other.place - one.place))
