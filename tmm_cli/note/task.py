"""Chapter on the problem statement: input data in the units of the file, and the quantities to be found."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol, symbol_of_name
from tmm_cli.mechanics.linkage import FRAME, Link, Load
from tmm_cli.mechanics.quantities import ANGLE, FORCE, INERTIA, LENGTH, MASS, MOMENT
from tmm_cli.note.blocks import (
    Block,
    Heading,
    Items,
    Line,
    Ref,
    Rows,
    cells,
    join_inline,
    paragraph,
    refer_to_blocks,
    write_sentence,
    write_table,
)
from tmm_cli.note.subject import NONE, Subject, join_with_no_break_spaces, note_table, with_degrees
from tmm_cli.reports import (
    ROLES,
    describe_driver_motion,
    input_data_tables,
    link_name,
    links_with_inertia,
    translate_label,
)

# tables of `tmm explain` that the note replaces by its own; it includes the others unchanged
IN_WORDS = ("synthesis", "points", "slides", "facts", "speeds", "masses", "loads")
SIDES = 3  # for a link with more points only the distances from its first point are given


def write_task(subject: Subject) -> Iterable[Block]:
    """Write the input data and the quantities to be found."""
    results = subject.results
    problem, linkage = results.problem, results.linkage
    yield Heading(_("Problem statement and input data"))
    if problem.description:
        yield paragraph(problem.description.strip())
    sentence = _("The dimensions of the links are given in table {table}.")
    if problem.synthesis is not None:
        sentence = _(
            "The dimensions of the links are given in table {table}; those not given in the problem statement "
            "are found by synthesis."
        )
    yield from write_table(sentence, _dimension_table(subject))
    sentence = _("The coordinates of the fixed points are given in table {table}.")
    if _has_fixed_guides(subject):
        sentence = _("The coordinates of the fixed points and guides are given in table {table}.")
    yield from write_table(sentence, _fixed_point_table(subject))
    for driver in linkage.drivers:
        yield paragraph(
            _("Link {link} is an input link: {motion}.").format(link=driver.link, motion=describe_driver_motion(driver))
        )
    if any(np.any(linkage.links[name].mass != 0) for name in linkage.moving):
        yield from write_table(
            _(
                "Table {table} gives the masses {m} of the links, their moments of inertia {J} about the centres "
                "of mass and the coordinates of the centres of mass. The local axes of a link have their origin at "
                "its first point; the x axis points to the second point or as the coordinates in table {sizes} "
                "indicate. A slider with one point has axes parallel to those of the link on which it slides."
            ),
            _mass_table(subject),
            m=Symbol("m"),
            J=Symbol("J", "S"),
            sizes=Ref("sizes"),
        )
        yield from _write_gravity(subject)
    if linkage.loads:
        yield from write_table(_("The loads are given in table {table}."), _load_table(subject))
    further = [
        table
        for table in input_data_tables(problem)
        if table.name not in IN_WORDS and not (table.name == "drivers" and not linkage.others)
    ]
    if further:
        yield refer_to_blocks(
            _("Further data are given in table {first}."),
            _("Further data are given in tables {first} and {last}."),
            _("Further data are given in tables {first} to {last}."),
            [table.name for table in further],
        )
        for table in further:
            yield note_table(subject, table, key=table.name)
            yield from (paragraph(with_degrees(note)) for note in table.notes)
    yield paragraph(_("To be found:"))
    yield Items(tuple((text,) for text in _list_requirements(subject)))


def _write_gravity(subject: Subject) -> Iterable[Block]:
    pull = subject.results.linkage.gravity
    magnitude = abs(pull)
    if not magnitude:
        yield paragraph(_("The weights of the links are not taken into account."))
        return
    yield write_sentence(
        _("The acceleration of gravity is {g} = {size} m/s²; it is directed at {angle} to the x axis."),
        g=Symbol("g"),
        size=subject.text(magnitude),
        angle=subject.value(float(np.angle(pull)), ANGLE, 4),
    )


def _dimension_table(subject: Subject) -> Rows:
    linkage, roles = subject.results.linkage, subject.results.roles
    rows = tuple(
        cells(name, translate_label(link.label) or _(ROLES[roles[name]]), _describe_dimensions(subject, link) or NONE)
        for name, link in linkage.links.items()
        if name != FRAME
    )
    return Rows(
        _("Links and their dimensions"), cells(_("link"), _("name of the link"), _("dimensions")), rows, "sizes"
    )


def _describe_dimensions(subject: Subject, link: Link) -> Line:
    """Return the lengths of a link as text, e.g. l_AB = 110 mm, and the coordinates of its points.

    The coordinates are left out if all points lie on the x axis of the link.
    """
    points = list(link.points)
    pairs = combinations(points, 2) if len(points) <= SIDES else ((points[0], other) for other in points[1:])
    dimensions: list[Line] = []
    for a, b in pairs:
        length = float(np.ravel(abs(link.points[a] - link.points[b]))[0])
        if length > 0:
            dimensions.append((Symbol("l", a + b), f" = {subject.value(length, LENGTH)}"))
    if any(np.any(np.imag(place) != 0) for place in link.points.values()):
        for point, place in link.points.items():
            x, y = _format_point(subject, place)
            dimensions.append((join_with_no_break_spaces(f"{point} ({x}; {y}) {subject.unit(LENGTH)}"),))
    return join_inline(dimensions)


def _fixed_point_table(subject: Subject) -> Rows:
    """Return the table of fixed points and guides. Its last column is the direction of the guides."""
    linkage, unit = subject.results.linkage, subject.unit(LENGTH)
    rows = [cells(point, *_format_point(subject, place), NONE) for point, place in linkage.links[FRAME].points.items()]
    for slide in linkage.slides:
        if slide.carrier == FRAME:
            angle = subject.value(float(np.ravel(slide.direction)[0]), ANGLE)
            rows.append(cells(_("guide {name}").format(name=slide.name), *_format_point(subject, slide.through), angle))
    head = cells(_("point"), f"x, {unit}", f"y, {unit}", _("angle to the x axis"))
    if _has_fixed_guides(subject):
        return Rows(_("Fixed points and guides"), head, tuple(rows), "fixed")
    return Rows(_("Fixed points"), head[:-1], tuple(row[:-1] for row in rows), "fixed")


def _has_fixed_guides(subject: Subject) -> bool:
    return any(slide.carrier == FRAME for slide in subject.results.linkage.slides)


def _format_point(subject: Subject, place: complex) -> tuple[str, str]:
    value = complex(np.ravel(place)[0])
    return subject.number(value.real, LENGTH), subject.number(value.imag, LENGTH)


def _mass_table(subject: Subject) -> Rows:
    linkage, unit = subject.results.linkage, subject.unit
    rows = []
    for name in links_with_inertia(linkage):
        link = linkage.links[name]
        mass, inertia = (float(np.ravel(value)[0]) for value in (link.mass, link.inertia))
        numbers = (subject.number(mass, MASS), subject.number(inertia, INERTIA))
        rows.append(cells(name, *numbers, *_format_point(subject, link.centre)))
    quantities = (
        (Symbol("m"), MASS),
        (Symbol("J", "S"), INERTIA),
        (Symbol("x", "S"), LENGTH),
        (Symbol("y", "S"), LENGTH),
    )
    head = cells(_("link"), *((symbol, f", {unit(dimension)}") for symbol, dimension in quantities))
    caption = _("Masses, moments of inertia and centres of mass in the axes of each link")
    return Rows(caption, head, tuple(rows), "masses")


def _load_table(subject: Subject) -> Rows:
    linkage = subject.results.linkage
    head = cells(_("load"), _("acts on link"), _("point of action"), _("magnitude"), _("when the load acts"))
    return Rows(_("Loads"), head, tuple(_load_row(subject, load) for load in linkage.loads), "loads")


def _load_row(subject: Subject, load: Load) -> tuple[Line, ...]:
    place = load.point
    if load.force and not place:
        x, y = _format_point(subject, load.at)
        place = _("({x}; {y}) {unit}").format(x=x, y=y, unit=subject.unit(LENGTH))
    magnitude = subject.value(load.moment, MOMENT)
    if load.force:
        x, y = (subject.number(component, FORCE) for component in (load.force.real, load.force.imag))
        magnitude = f"({x}; {y}) {subject.unit(FORCE)}"
    if load.table is not None:
        magnitude = _("given by a table")
    elif load.resists:
        against = subject.value(abs(load.force), FORCE) if load.force else subject.value(load.moment, MOMENT)
        magnitude = _("{size}, opposite to the motion").format(size=against)
    when = _("in the working stroke") if load.working_stroke_only else _("always")
    if load.stroke_link:
        when = _("in the working stroke of link {link}").format(link=load.stroke_link)
    if load.window is not None:
        first, last = (subject.value(angle, ANGLE) for angle in load.window)
        when = _("crank angle from {first} to {last}").format(first=first, last=last)
    name = symbol_of_name(load.name, "P" if load.force else "M")
    return cells(name, link_name(load.link), place if load.force else NONE, magnitude, when)


def _list_requirements(subject: Subject) -> Iterable[str]:
    results = subject.results
    if results.problem.synthesis is not None:
        yield _("the dimensions of the mechanism from the requirements;")
    yield _("the structure of the mechanism: its mobility, Assur groups, structural formula and class;")
    if results.motion is None:
        return
    count = len(results.numbers)
    yield (
        _("positions, velocities and accelerations of points and links;")
        if count == 1
        else _("positions, velocities and accelerations of points and links in {count} positions;").format(count=count)
    )
    if subject.has_loads:
        yield _(
            "the reactions in the pairs and the balancing moment or force on the input link, checked by the "
            "Zhukovsky lever."
        )
