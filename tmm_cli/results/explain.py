"""What a file was understood to say, what will be computed by which group, what is skipped and why."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.groups.base import Closed
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import ANGLE, ANGULAR_SPEED, FORCE, INERTIA, LENGTH, MASS, MOMENT, SPEED, Dimension
from tmm_cli.problem.record import Problem
from tmm_cli.results.explain_pairs import further
from tmm_cli.results.stages import how, stages
from tmm_cli.results.table import Column, Table
from tmm_cli.structure.assur import Group, Pair
from tmm_cli.words import say


def explain(results: Results) -> Iterable[Table]:
    """Tables of words: the file in full, then the way of the calculation."""
    problem = results.problem
    if problem.synthesis is not None and problem.synthesis.names:
        from tmm_cli.results.synthesis import parameters

        yield parameters(problem.synthesis, problem.units)
    yield _points(problem)
    if problem.linkage.slides:
        yield _slides(problem)
    yield _facts(problem)
    yield from further(problem)
    if any(np.any(link.mass != 0) for link in problem.linkage.links.values()):
        yield _masses(problem)
    if problem.linkage.loads:
        yield _loads(problem)
    yield _way(results)
    yield _words(
        "stages", list(stages(results)), tuple(f"explain.{k}" for k in ("stage", "groups", "places", "motion", "note"))
    )
    skipped = list(_skipped(problem))
    if skipped:
        yield _words("skipped", skipped, ("word.what", "explain.why"))


def _show(problem: Problem, value: float, dimension: Dimension) -> str:
    return f"{problem.units.from_si(float(np.real(value)), dimension):.6g} {problem.units.symbol(dimension)}"


def _xy(problem: Problem, value: complex) -> str:
    return f"[{', '.join(f'{problem.units.from_si(float(v), LENGTH):.6g}' for v in (value.real, value.imag))}]"


def _words(name: str, rows: Sequence[tuple[str, ...]], headers: tuple[str, ...]) -> Table:
    columns = (Column(say(header), [row[k] for row in rows]) for k, header in enumerate(headers))
    return Table(name, say(f"explain.{name}"), tuple(columns))


def _points(problem: Problem) -> Table:
    rows = [
        (say("explain.frame") if name == FRAME else name, point, _xy(problem, complex(local)))
        for name, link in problem.linkage.links.items()
        for point, local in link.points.items()
    ]
    table = _words("points", rows, ("word.link", "word.point", "explain.place"))
    note = say("explain.points_note", unit=problem.units.symbol(LENGTH))
    return Table(table.name, table.title, table.columns, notes=(note,))


def _slides(problem: Problem) -> Table:
    rows = [
        (
            s.name, s.runner, s.point, say("explain.frame") if s.carrier == FRAME else s.carrier,
            _xy(problem, complex(s.through)), _show(problem, s.direction, ANGLE), _show(problem, s.turned, ANGLE),
        )
        for s in problem.linkage.slides
    ]  # fmt: skip
    keys = ("pair", "link", "point", "on", "through", "angle", "turned")
    return _words("slides", rows, tuple(("explain." if k in keys[3:] else "word.") + k for k in keys))


def _facts(problem: Problem) -> Table:
    linkage, request = problem.linkage, problem.request
    driver = linkage.driver
    crank = driver.kind == "turn"
    speed = f"{driver.rate:.6g} {'rad/s' if crank else 'm/s'}"
    if driver.acceleration:
        speed += f", {driver.acceleration:.6g} {'rad/s2' if crank else 'm/s2'}"
    sense = say("explain.ccw" if driver.sense > 0 else "explain.cw") if crank else ""
    measure = ANGLE if crank else LENGTH
    if request.places:
        asked = ", ".join(_show(problem, q, measure) for q in request.places[:12])
    else:
        start = request.start if isinstance(request.start, str) else _show(problem, request.start, measure)
        if driver.stroke is not None:
            start = say(
                "explain.stroke", **{n: _show(problem, q, measure) for n, q in zip("ab", driver.stroke, strict=True)}
            )
        elif not crank:
            start = say("explain.whole_way")
        asked = say("explain.count", count=request.count, start=start)
    units = problem.units
    rows = [
        (say("explain.units"), ", ".join(units.symbol(d) for d in (LENGTH, ANGLE, MASS, FORCE, MOMENT, INERTIA))),
        (say("explain.speed"), units.symbol(ANGULAR_SPEED if crank else SPEED)),
        (say("explain.driver"), say("explain.driver_is", link=driver.link, speed=speed, sense=sense)),
        (say("explain.gravity"), f"[{linkage.gravity.real:.6g}, {linkage.gravity.imag:.6g}] m/s2"),
        (say("explain.positions"), asked),
        (say("explain.sketch"), _sketch(problem, measure)),
        (say("explain.limit"), f"{100 * problem.lever_limit:.6g} %"),
    ]
    return _words("facts", rows, ("word.what", "word.value"))


def _sketch(problem: Problem, measure: Dimension) -> str:
    sketch = problem.linkage.sketch
    parts = [_show(problem, sketch.at, measure)]
    parts += [f"{name} {_xy(problem, place)}" for name, place in sketch.points.items()]
    parts += [f"{name} {_show(problem, angle, ANGLE)}" for name, angle in sketch.angles.items()]
    return ", ".join(parts)


def _masses(problem: Problem) -> Table:
    links = [link for link in problem.linkage.links.values() if np.any(link.mass != 0) or np.any(link.inertia != 0)]
    rows = [
        (x.name, _show(problem, x.mass, MASS), _show(problem, x.inertia, INERTIA), _xy(problem, complex(x.centre)))
        for x in links
    ]
    return _words("masses", rows, ("word.link", "explain.mass", "explain.inertia", "explain.centre"))


def _loads(problem: Problem) -> Table:
    rows = []
    for load in problem.linkage.loads:
        unit = problem.units.symbol(FORCE)
        if load.table is not None:
            what = say("explain.table", rows=len(load.table.values), against=load.table.against)
        elif load.force:
            parts = ", ".join(f"{problem.units.from_si(v, FORCE):.6g}" for v in (load.force.real, load.force.imag))
            what = f"[{parts}] {unit}"
        else:
            what = _show(problem, load.moment, MOMENT)
        when = say("explain.working" if load.working_stroke_only else "explain.always")
        place = _xy(problem, load.at) if load.force else ""
        rows.append((load.name, load.link, place, what, when))
    return _words("loads", rows, ("forces.name", "word.link", "explain.at", "explain.size", "explain.when"))


def _way(results: Results) -> Table:
    structure = results.structure
    linkage = results.linkage
    rows = [("1", " + ".join(f"I({d.base},{d.link})" for d in linkage.drivers),
             say("explain.given_all" if linkage.others else "explain.given"), "", say("stages.closed"))]  # fmt: skip
    solved = {link: k for k in results.kernels for link in k.group.links}
    for number, group in enumerate(structure.groups, 2):
        hangs = "; ".join(_hang(pair, group) for pair in group.outer)
        kernel = solved.get(group.links[0])
        if isinstance(kernel, Closed):
            one = kernel.assemblies == 1
            which = say("explain.one") if one else say("explain.two", sign=f"{kernel.sign:+d}")
        elif kernel is not None:
            which = say("explain.newton")
        else:
            which = say("explain.unsolved")
        rows.append((str(number), f"{group.title} {group.type}", hangs, which, "" if kernel is None else how(kernel)))
    table = _words("way", rows, ("explain.step", "word.group", "explain.hangs", "explain.assembly", "explain.how"))
    return Table(table.name, table.title, table.columns, notes=(say("explain.back"),))


def _hang(pair: Pair, group: Group) -> str:
    known = pair.i if pair.j in group.links else pair.j
    return say("explain.from", pair=pair.name, link=say("explain.frame") if known == FRAME else known)


def _skipped(problem: Problem) -> Iterable[tuple[str, str]]:
    linkage: Linkage = problem.linkage
    light = [n for n in linkage.moving if not np.any(linkage.links[n].mass != 0)]
    if light:
        yield say("explain.no_weight", links=", ".join(light)), say("explain.massless")
    spinless = [n for n in linkage.moving if not np.any(linkage.links[n].inertia != 0) and n not in light]
    if spinless:
        yield say("explain.no_couple", links=", ".join(spinless)), say("explain.inertialess")
    if not linkage.loads and len(light) == len(linkage.moving):
        yield say("explain.no_forces"), say("explain.nothing")
    if linkage.gravity == 0:
        yield say("explain.no_gravity"), say("explain.gravityless")
    if not problem.request.detail:
        yield say("explain.no_detail"), say("explain.detailless")
