"""What a file was understood to say; then the way of the calculation (results.stages)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.double_double import rounded
from tmm_cli.language import N_, _, numeral, spelt
from tmm_cli.linkage import FRAME, Driver, Load, LoadTable, Mesh, SpeedTable, Spring
from tmm_cli.problem.record import Problem
from tmm_cli.quantities import (
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    DAMPING,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    SPEED,
    STIFFNESS,
    TORSION,
    TORSION_DAMPING,
    Dimension,
    place_dimension,
)  # fmt: skip
from tmm_cli.results.reports.synthesis import parameters
from tmm_cli.results.stages import heavy, link_name, skipped, stages_table, steps
from tmm_cli.results.table import Table, table_of_words, with_unit
from tmm_cli.results.understood import between_rows
from tmm_cli.structure.assur import analyse
from tmm_cli.structure.naming import output_link

FILE_WORDS = {  # that a file may say, where they are shown
    "always": N_("always"), "working stroke": N_("working stroke"),
    "stroke": N_("stroke"), "crank angle": N_("crank angle"), "crank turn": N_("crank turn"),
}  # fmt: skip


def explain(results: Results, verbose: bool = False) -> Iterable[Table]:
    """Tables of words: the file in full, then the way of the calculation; verbose: places that each stage computes."""
    yield from given(results.problem)
    yield steps(results)
    if verbose:
        yield stages_table(results)
    yield from skipped(results.problem)


def given(problem: Problem) -> Iterable[Table]:
    """The file in full."""
    if problem.synthesis is not None and problem.synthesis.names:
        yield parameters(problem.synthesis, problem.units)
    yield _points(problem)
    if problem.linkage.slides:
        yield _slides(problem)
    yield table_of_words("facts", _("Driver, positions, limits"), (_("what"), _("value")), _facts(problem))
    if problem.linkage.driver.law is not None:
        yield _speeds(problem, problem.linkage.driver.law)
    yield from _further(problem)
    if any(np.any(link.mass != 0) for link in problem.linkage.links.values()):
        yield _masses(problem)
    if problem.linkage.loads:
        yield table_of_words(
            "loads", _("Loads"), (_("name"), _("link"), _("acts at (link's axes)"), _("size"), _("when")),
            [_load(problem, load) for load in problem.linkage.loads],
        )  # fmt: skip
        for load in problem.linkage.loads:
            if load.table is not None:
                yield _tabulated(problem, load, load.table)


def _points(problem: Problem) -> Table:
    rows = [
        (link_name(name), point, show_vector(problem, local))
        for name, link in problem.linkage.links.items()
        for point, local in link.points.items()
    ]
    note = _("Lengths in {unit}. A point on two links is a hinge; on three and more, a compound hinge.")
    return table_of_words(
        "points", _("Points, each in the axes of its link"), (_("link"), _("point"), _("place")), rows,
        (note.format(unit=problem.units.spelt(LENGTH)),),
    )  # fmt: skip


def _slides(problem: Problem) -> Table:
    return table_of_words(
        "slides", _("Sliding pairs"),
        (_("pair"), _("link"), _("point"), _("slides on"), _("guide through"), _("guide's angle"), _("turned by")),
        [(s.name, s.runner, s.point, link_name(s.carrier), show_vector(problem, s.through),
          show(problem, s.direction, ANGLE), show(problem, s.turned, ANGLE)) for s in problem.linkage.slides],
    )  # fmt: skip


def _facts(problem: Problem) -> Iterable[tuple[str, str]]:
    linkage, units = problem.linkage, problem.units
    driver, measure = linkage.driver, place_dimension(linkage.driver.kind)
    dimensions = (LENGTH, ANGLE, MASS, FORCE, MOMENT, INERTIA)
    yield _("bare numbers are in"), ", ".join(units.spelt(dimension) for dimension in dimensions)
    yield _("a bare speed is in"), units.spelt(ANGULAR_SPEED if driver.kind == "turn" else SPEED)
    if driver.kind == "slide":
        text = _("link {link}, {speed}")
    elif driver.sense > 0:
        text = _("link {link}, {speed} counterclockwise")
    else:
        text = _("link {link}, {speed} clockwise")
    yield _("driver"), text.format(link=driver.link, speed=_speed(driver))
    yield _("gravity"), f"[{linkage.gravity.real:.6g}, {linkage.gravity.imag:.6g}] {spelt('m/s^2')}"
    if linkage.turns > 1:
        yield _("loads come again after"), _("{turns} turns of the crank").format(turns=linkage.turns)
    yield _("positions"), _positions(problem, measure)
    sketch = linkage.sketch
    places = [show(problem, sketch.at, measure)]
    places += [f"{name} {show_vector(problem, place)}" for name, place in sketch.points.items()]
    places += [f"{name} {show(problem, angle, ANGLE)}" for name, angle in sketch.angles.items()]
    yield _("sketch, driver at"), ", ".join(places)
    yield from ((_("law of motion") if not row else "", told) for row, told in enumerate(_law(problem)))
    yield _("limit of the lever check"), f"{numeral(100 * problem.lever_limit, '.6g')} %"


def _law(problem: Problem) -> Iterable[str]:
    """What is computed of it."""
    task = problem.dynamics
    if task is None:
        yield _("given; without a block `dynamics` nothing of it is computed")
        return
    if not task.cyclic:
        yield _("of a single run, integrated by time")
        return
    yield _("of steady running, from the reduced inertia and the reduced moment over the cycle")
    if task.motor is not None:
        yield _("driven by the characteristic of its motor")
    else:
        speed = show(problem, task.mean, ANGULAR_SPEED)
        yield _("driven by a constant moment that leaves no work over the cycle, mean speed {speed}").format(
            speed=speed
        )
    if task.flywheel:
        given = show(problem, task.flywheel, INERTIA)
        yield _("with a flywheel of {inertia}, reduced to the driver").format(inertia=given)
    if task.delta is not None:
        yield _("a flywheel is found that keeps delta = {delta}").format(delta=numeral(task.delta, ".4g"))
    yield _("forces with the speeds and accelerations of this law")


def _positions(problem: Problem, measure: Dimension) -> str:
    request, driver = problem.request, problem.linkage.driver
    if request.places:
        return ", ".join(show(problem, q, measure) for q in request.places[:12])
    if driver.stroke is not None:
        a, b = (show(problem, q, measure) for q in driver.stroke)
        return _("{count} from {a} to {b}").format(count=request.count, a=a, b=b)
    if driver.kind == "slide":
        return _("{count} from one end of its way to the other").format(count=request.count)
    start = _(FILE_WORDS[request.start]) if isinstance(request.start, str) else show(problem, request.start, measure)
    return _("{count} from {start}").format(count=request.count, start=start)


def _masses(problem: Problem) -> Table:
    links = [problem.linkage.links[name] for name in heavy(problem.linkage)]
    return table_of_words(
        "masses", _("Masses"), (_("link"), _("mass"), _("inertia about S"), _("S in the link's axes")),
        [(x.name, show(problem, x.mass, MASS), show(problem, x.inertia, INERTIA), show_vector(problem, x.centre))
         for x in links],
    )  # fmt: skip


def _load(problem: Problem, load: Load) -> tuple[str, ...]:
    dimension, value = (FORCE, load.force) if load.force else (MOMENT, load.moment)
    if load.table is not None:
        size = _("table of {rows} rows against the {against}").format(
            rows=len(load.table.values), against=_(FILE_WORDS[load.table.against])
        )
    elif load.resists:
        size = _("{size} against the motion").format(size=show(problem, abs(value), dimension))
    elif load.force:
        size = f"{show_vector(problem, load.force, FORCE)} {problem.units.spelt(FORCE)}"
    else:
        size = show(problem, load.moment, MOMENT)
    place = show_vector(problem, load.at) if load.force else ""
    link = load.link if load.base == FRAME else _("{link} from {base}").format(link=load.link, base=load.base)
    when = _(FILE_WORDS[load.when])
    if load.window is not None:
        first, last = (show(problem, angle, ANGLE) for angle in load.window)
        when = _("crank from {first} to {last}").format(first=first, last=last)
    return load.name, link, place, size, when


def _tabulated(problem: Problem, load: Load, table: LoadTable) -> Table:
    """The rows of a load's table; of a force, its direction too."""
    linkage, measure = problem.linkage, ANGLE
    if table.against == "stroke":
        link = output_link(linkage, analyse(linkage).groups)
        measure = ANGLE if link is None or linkage.output_swings(link) else LENGTH
    rows = [
        (show(problem, at, measure), show(problem, size, FORCE if load.force else MOMENT))
        for at, size in zip(table.arguments, table.values, strict=True)
    ]
    direction = show(problem, np.angle(load.force), ANGLE)
    notes = [_("Its direction is {direction}.").format(direction=direction)] if load.force else []
    if table.between == "step":
        notes.append(_("Each row holds up to the next one."))
    elif table.between == "smooth":
        closed, natural = _("Between rows: a cubic spline that closes."), _("Between rows: a natural cubic spline.")
        notes.append(closed if table.closed else natural)
    title = _("{load} against the {against}").format(load=load.name, against=_(FILE_WORDS[table.against]))
    name = f"load_table_{linkage.loads.index(load) + 1}"
    return table_of_words(name, title, (_(FILE_WORDS[table.against]), _("size")), rows, tuple(notes))


def show(problem: Problem, value: float, dimension: Dimension) -> str:
    """A value with its unit, of the file where it has one for this dimension."""
    return with_unit(problem.units, float(np.ravel(value)[0]), dimension)


def show_vector(problem: Problem, value: complex, dimension: Dimension = LENGTH) -> str:
    """Both components in the unit of the file: `[120, 0]`."""
    value = complex(np.ravel(value)[0])
    return f"[{', '.join(f'{problem.units.from_si(v, dimension) + 0.0:.6g}' for v in (value.real, value.imag))}]"


def _speeds(problem: Problem, law: SpeedTable) -> Table:
    """The rows of a table of speeds, with the accelerations that follow from them, or are given."""
    squares = law.squares
    places = np.array([float(rounded(row)) for row in squares.arguments])
    after = squares.slope(places) / 2 * problem.linkage.driver.sense
    gains = after if law.accelerations is None else law.accelerations(places)
    speeds = np.sqrt(squares(places))
    rows = [
        (show(problem, at, ANGLE), show(problem, speed, ANGULAR_SPEED), show(problem, gain, ANGULAR_ACCELERATION))
        for at, speed, gain in zip(places, speeds, gains, strict=True)
    ]
    head = (_("crank angle"), _("speed"), _("acceleration"))
    note = _("Between rows: {between}.").format(between=between_rows(law))
    return table_of_words("speeds", _("Speed of the driver, in its sense"), head, rows, (note,))


def _speed(driver: Driver) -> str:
    """A driver's speed, and its acceleration where it has one."""
    if driver.law is not None:
        return _("by a table against the crank angle")
    turns = driver.kind == "turn"
    rate = f"{numeral(driver.rate, '.6g')} {spelt('rad/s' if turns else 'm/s')}"
    return rate + (
        f", {numeral(driver.acceleration, '.6g')} {spelt('rad/s^2' if turns else 'm/s^2')}"
        if driver.acceleration
        else ""
    )


def _further(problem: Problem) -> Iterable[Table]:
    """A table for each block that the file has of these."""
    linkage = problem.linkage
    if linkage.others or linkage.driver.base != FRAME:
        yield table_of_words(
            "drivers", _("Drivers; they pass through the places of the sketch together"),
            (_("link"), _("driven from"), _("in pair"), _("it"), _("speed"), _("sense"), _("in the sketch at")),
            [_driver(problem, driver) for driver in linkage.drivers],
        )  # fmt: skip
    wheels = [_mesh(problem, mesh) for mesh in linkage.meshes if mesh.kind != "cam"]
    if wheels:
        note, title = _("Angles are those of the wheels from the link that holds them."), _("Toothed wheels")
        if any(mesh.kind == "rack" for mesh in linkage.meshes):
            title = _("Toothed wheels and racks")
            note = _(
                "Angles are those of the wheels from the link that holds them; a rack's run is in {unit} "
                "for an angle in rad."
            )
        yield table_of_words(
            "meshes", title,
            (_("pair"), _("kind"), _("links"), _("held by"), _("law"), _("pitch radii"), _("pressure angle")),
            wheels, (note.format(unit=problem.units.spelt(LENGTH)),),
        )  # fmt: skip
    cams = [row for mesh in linkage.meshes if mesh.kind == "cam" for row in _cam(problem, mesh)]
    if cams:
        note = _(
            "Of a sliding follower the force is taken as that of a flat face: along the guide, ds/da "
            "from the cam's axis. A swinging one is loaded by a couple."
        )
        yield table_of_words(
            "cams", _("Cams, by the law of the follower"),
            (_("pair"), _("cam"), _("follower"), _("piece"), _("cam from"), _("to"), _("rise"), _("law"),
             _("follower then at")),
            cams, (note,),
        )  # fmt: skip
    if linkage.springs:
        yield table_of_words(
            "springs", _("Springs"),
            (_("name"), _("between"), _("ends"), _("stiffness"), _("free at"), _("preload"), _("damping")),
            [_spring(problem, spring) for spring in linkage.springs],
        )  # fmt: skip
    if linkage.friction:
        slides = {slide.name for slide in linkage.slides}
        yield table_of_words(
            "friction", _("Friction"), (_("pair"), _("coefficient"), _("journal's radius")),
            [(f.pair, numeral(f.coefficient, ".6g"),
              _("a guide") if f.pair in slides else show(problem, f.radius, LENGTH))
             for f in linkage.friction],
        )  # fmt: skip


def _driver(problem: Problem, driver: Driver) -> tuple[str, ...]:
    senses = {"turn": (_("clockwise"), _("counterclockwise")), "slide": (_("in"), _("out"))}
    at = problem.linkage.sketch.at if driver is problem.linkage.driver else driver.at
    return (
        driver.link, link_name(driver.base), driver.joint, _("turns") if driver.kind == "turn" else _("slides"),
        _speed(driver), senses[driver.kind][driver.sense > 0], show(problem, at, place_dimension(driver.kind)),
    )  # fmt: skip


def _mesh(problem: Problem, mesh: Mesh) -> tuple[str, ...]:
    """A row of two wheels, or of a wheel and a rack, with the equation of their motion."""
    linkage = problem.linkage
    if mesh.kind == "rack":
        kind = _("wheel and rack")
        step = problem.units.from_si(mesh.ratio, LENGTH)
        law, offset = f"s_{mesh.j} = {numeral(step, '.6g')} phi_{mesh.i}", show(problem, mesh.offset, LENGTH)
        radii = show(problem, abs(mesh.ratio), LENGTH)
    else:
        kind = _("inner mesh") if mesh.ratio > 0 else _("outer mesh")
        law, offset = f"phi_{mesh.j} = {numeral(mesh.ratio, '.6g')} phi_{mesh.i}", show(problem, mesh.offset, ANGLE)
        points = [linkage.shared(mesh.carrier, link) for link in (mesh.i, mesh.j)]
        a, b = (complex(np.ravel(linkage.local(mesh.carrier, p))[0]) for p in points if p is not None)
        pitch = (a - mesh.ratio * b) / (1 - mesh.ratio)
        radii = ", ".join(show(problem, abs(pitch - axis), LENGTH) for axis in (a, b))
    if mesh.offset:
        law += f" + {offset}"
    return (
        mesh.name, kind, f"{link_name(mesh.i)}, {link_name(mesh.j)}", link_name(mesh.carrier), law, radii,
        show(problem, mesh.pressure, ANGLE),
    )  # fmt: skip


def _cam(problem: Problem, mesh: Mesh) -> Iterable[tuple[str, ...]]:
    """The pieces of a cam's law, a row each."""
    assert mesh.law is not None
    measure = LENGTH if mesh.slide else ANGLE
    at, run = mesh.law.start, mesh.offset
    for number, piece in enumerate(mesh.law.pieces):
        name = (mesh.name, mesh.i, mesh.j) if number == 0 else ("", "", "")
        end, run = at + piece.over, run + piece.rise
        law = piece.shape if piece.rise else _("dwell")
        yield (
            *name, str(number + 1), show(problem, at, ANGLE), show(problem, end, ANGLE),
            show(problem, piece.rise, measure), law, show(problem, run, measure),
        )  # fmt: skip
        at = end


def _spring(problem: Problem, spring: Spring) -> tuple[str, ...]:
    between = f"{link_name(spring.i)}, {link_name(spring.j)}"
    if spring.turns:
        ends, measures = "", (TORSION, ANGLE, MOMENT, TORSION_DAMPING)
    else:
        ends = f"{show_vector(problem, spring.at_i)}, {show_vector(problem, spring.at_j)}"
        measures = (STIFFNESS, LENGTH, FORCE, DAMPING)
    values = (spring.rate, spring.free, spring.preload, spring.damping)
    rate, free, preload, damping = (show(problem, v, measure) for v, measure in zip(values, measures, strict=True))
    if not spring.rate:
        rate, free = _("constant force"), ""
    return spring.name, between, ends, rate, free, preload if spring.preload else "", damping if spring.damping else ""
