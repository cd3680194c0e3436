"""Description of the structure and of the calculation in sentences, and the tables of `tmm explain`.

The groups in the table of stages come from the functions that the stages call, so the table agrees with the
calculation.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.language import _, printed
from tmm_cli.mechanics.analysis import CYCLE_SAMPLES, Results
from tmm_cli.mechanics.groups import ClosedFormSolver, GroupSolver, solvers_towards
from tmm_cli.mechanics.kinematics import SCAN
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.structure import POSITIONS_PER_TURN, Group, Pair, Structure
from tmm_cli.problem import Problem
from tmm_cli.reports.file_summary import describe_driver_motion
from tmm_cli.reports.input_load_tables import links_with_inertia
from tmm_cli.reports.input_tables import input_data_tables
from tmm_cli.reports.structure_tables import (
    ROLES,
    describe_classification,
    describe_contours,
    describe_link_motion,
    describe_primary_mechanisms,
    describe_schemes,
    generalised_mobility,
    mobility_by_classes,
    mobility_equation,
    mobility_with_replacements,
    mobility_with_rollers,
    reduction_sentences,
)
from tmm_cli.reports.table import Table, link_name, text_table


def narrate_structure(results: Results) -> Iterable[str]:
    """Yield the structural analysis as sentences, in the order usual in the explanatory note of a course project."""
    structure = results.structure
    yield _mobility_sentence(structure)
    count = (len(structure.links), len(structure.pairs) - structure.higher, structure.higher)
    yield _("With the pairs counted by class, W = 3n - 2 p5 - p4 = {count}.").format(count=mobility_by_classes(count))
    yield _("The generalised formula W = Hn - sum((H - i) p_i) with H = 3 gives {count}.").format(
        count=generalised_mobility(count)
    )
    if structure.higher:
        text = _("With each higher pair replaced by a link with two revolute pairs: W = {count}.")
        yield text.format(count=mobility_with_replacements(count))
    if any(pair.mesh is not None and pair.mesh.roller for pair in structure.pairs):
        yield _("If rollers are counted as links, W = {count}.").format(count=mobility_with_rollers(structure))
    if structure.passive:
        yield _(
            "According to the rank of the constraint equations, the number of redundant constraints is {count} "
            "and the true mobility is W = {w}."
        ).format(count=structure.redundant, w=structure.mobility + structure.redundant)
    yield _("Pairs, with their classes and codes: {pairs}.").format(pairs=", ".join(map(_pair_text, structure.pairs)))
    for driver in results.linkage.drivers:
        yield _("Link {link} ({role}) is an input link: {motion}.").format(
            link=driver.link, role=_(ROLES[results.roles[driver.link]]), motion=describe_driver_motion(driver)
        )
    yield _("The structural formula is {formula}; the mechanism is of class {number}.").format(
        formula=structure.formula, number=structure.roman
    )
    if len(structure.drivers) > 1:
        yield _("Primary mechanisms: {names}.").format(names=describe_primary_mechanisms(structure))
    yield _("Type of the kinematic chain and of the structure: {words}.").format(
        words=describe_classification(structure)
    )
    yield _("Number of independent loops K = p - n: {count}.").format(count=describe_contours(structure))
    schemes = describe_schemes(structure)
    if schemes:
        yield _("The mechanism contains these basic mechanisms: {schemes}.").format(schemes=schemes)
    motions = (f"{link}: {describe_link_motion(results, link)}" for link in structure.links)
    yield _("Motion of the links: {motions}.").format(motions="; ".join(motions))
    for sentence in reduction_sentences(structure):
        yield _("Simplification for the structural formula: {what}.").format(what=sentence)
    for group in structure.groups:
        text = _("Group {group} is of class {number}, order {order} and type {type}; its external pairs are {outer}.")
        kind = f"{group.type} ({group.letters}, {group.type_number})" if group.type_number else group.type
        yield text.format(
            group=group.title,
            number=group.roman,
            order=group.order,
            type=kind,
            outer=_external_pairs(group),
        )
        yield _("For group {group}, 3n - 2 p1 - p2 = {count}.").format(
            group=group.title, count=mobility_equation(group.count)
        )
    if structure.groups:
        yield _(
            "Positions, velocities and accelerations are determined group by group in this order, reactions in "
            "the reverse order; {balance}, which is checked by the Zhukovsky lever."
        ).format(balance=_balance_text(results.linkage))


def _mobility_sentence(structure: Structure) -> str:
    n, higher, w = len(structure.links), structure.higher, structure.mobility
    lower = len(structure.pairs) - higher
    turning = sum(pair.kind == "R" for pair in structure.pairs)
    text = _(
        "The mechanism has n = {n} moving links and p1 = {lower} lower pairs (revolute: {turning}, "
        "prismatic: {sliding}); by Chebyshev's formula its mobility is W = 3n - 2 p1 = 3*{n} - 2*{lower} = "
        "{w}."
    )
    if higher:
        text = _(
            "The mechanism has n = {n} moving links, p1 = {lower} lower pairs (revolute: {turning}, prismatic: "
            "{sliding}) and p2 = {higher} higher pairs; by Chebyshev's formula its mobility is W = 3n - 2 p1 - "
            "p2 = 3*{n} - 2*{lower} - {higher} = {w}."
        )
    return text.format(n=n, lower=lower, turning=turning, sliding=lower - turning, higher=higher, w=w)


def _pair_text(pair: Pair) -> str:
    """Return name, links, class and code of a pair, e.g. `O 0-1 (5, 1в)`. A higher pair has no code."""
    words = ", ".join(filter(None, (str(pair.pair_class), pair.code)))
    return f"{pair.name} {printed(pair.i)}-{printed(pair.j)} ({words})"


def _external_pairs(group: Group) -> str:
    """List the external pairs of a group, each with the link outside the group that it connects."""
    outer_links = [(pair.name, pair.i if pair.j in group.links else pair.j) for pair in group.outer]
    frame, moving = _("{pair} (frame)"), _("{pair} (link {link})")
    return ", ".join((frame if link == FRAME else moving).format(pair=pair, link=link) for pair, link in outer_links)


def _balance_text(linkage: Linkage) -> str:
    driver = linkage.driver
    if linkage.others:
        return _("moments and forces on the input links balance the mechanism")
    text = _("the balancing moment acts on link {link}")
    if driver.kind == "slide" or driver.balance == "force":
        text = _("the balancing force acts on link {link}")
    return text.format(link=driver.link)


# What a file was understood to say; then the way of the calculation (results.stages).


def explain_tables(results: Results, verbose: bool = False) -> Iterable[Table]:
    """Yield the tables of input data, of the steps of the calculation, and of quantities that are not computed.

    verbose: True to add the table of stages with the number of positions computed in each.
    """
    yield from input_data_tables(results.problem)
    yield step_table(results)
    if verbose:
        yield stage_table(results)
    yield from skipped_tables(results.problem)


LAW_POSITIONS = 12 * 16  # places on a turn that a law of motion is computed at, at least

StageRow = tuple[str, str, str, str, str]


def step_table(results: Results) -> Table:
    """Return the table of the driver and the groups in solving order, with the assembly of each group."""
    linkage = results.linkage
    drivers = " + ".join(map(results.structure.driver_title, linkage.drivers))
    driver_note = (
        _("the drivers: their coordinates are given") if linkage.others else _("the driver: its coordinate is given")
    )
    rows = [("1", drivers, driver_note, "", _("in closed form"))]
    solved = {link: kernel for kernel in results.kernels for link in kernel.group.links}
    for number, group in enumerate(results.structure.solved, 2):
        kernel = solved.get(group.links[0])
        how = "" if kernel is None else _method_text(kernel)
        rows.append(
            (str(number), f"{group.title} {group.type}".strip(), _known_links(group), _assembly_text(kernel), how)
        )
    note = _(
        "For each group, positions, velocities and accelerations are computed in closed form (positions by "
        "iteration if the assembly is followed from position to position). Then the reactions are "
        "computed, from the last group to the first, and finally the Zhukovsky lever, for which only "
        "velocities are needed."
    )
    return text_table(
        "way",
        _("Order of the calculation; forces are computed in the reverse order"),
        (_("step"), _("group"), _("connected to"), _("assembly"), _("method of solution")),
        rows,
        (note,),
    )


def _known_links(group: Group) -> str:
    texts = []
    for pair in group.outer:
        link = pair.i if pair.j in group.links else pair.j
        texts.append(_("{pair} ({link})").format(pair=pair.name, link=link_name(link)))
    return "; ".join(texts)


def _assembly_text(kernel: GroupSolver | None) -> str:
    if kernel is None:
        return _("ambiguous: see `tmm kinematics`")
    if not isinstance(kernel, ClosedFormSolver):
        return _("as in the sketch, by continuation of the solution")
    if kernel.assemblies == 1:
        return _("the only assembly")
    return _("of the two, the one with the sign {sign}, as in the sketch").format(sign=f"{kernel.sign:+d}")


def _method_text(kernel: GroupSolver) -> str:
    if isinstance(kernel, ClosedFormSolver):
        return (
            _("in closed form")
            if kernel.winding is None
            else _("in closed form; the angle is accumulated over several turns")
        )
    return _("by Newton's method") if kernel.followed is None else _("by Newton's method, with continuation")


def stage_table(results: Results) -> Table:
    """Return a table with a row for each stage of the calculation."""
    headers = (_("stage"), _("groups"), _("positions"), _("quantities"), _("note"))
    return text_table(
        "stages", _("What is computed in each stage that is requested"), headers, describe_stages(results)
    )


def describe_stages(results: Results) -> Iterable[StageRow]:
    """Yield the rows of the table of stages: stage, groups, number of positions, computed quantities, note.

    If the mechanism cannot be assembled, only the row of structural analysis is yielded.
    """
    driver_range, linkage, request = results.driver_range, results.linkage, results.problem.request
    yield (
        _("structure"),
        "-",
        "-",
        "-",
        _("by counting links and pairs; crank and rocker are distinguished by their range of motion"),
    )
    if driver_range is None:
        return
    kernels, scan = results.kernels, SCAN * driver_range.turns + 1
    requested_count = str(len(request.places) or request.count)
    all_titles = _group_titles(kernels, kernels)
    positions, velocities, accelerations = (
        _("positions"),
        _("positions, velocities"),
        _("positions, velocities, accelerations"),
    )

    yield (
        _("range of the driver"),
        all_titles,
        str(scan),
        positions,
        _("in one scan; then the limits of the range are refined"),
    )
    for link in results.mechanism.outputs:
        stage = _("strokes of link {link}").format(link=link)
        if not driver_range.full:
            note = _("over the requested positions: the driver does not rotate fully")
            yield stage, all_titles, str(SCAN + 1), velocities, note
            continue
        note = (
            _("the beginning of the working stroke is position 0")
            if request.start == "working stroke" and not request.places
            else ""
        )
        yield (
            stage,
            _group_titles(solvers_towards(kernels, [linkage.output_carrier(link)]), kernels),
            str(scan + 1),
            velocities,
            note,
        )
    yield _("dead positions"), all_titles, str(scan), positions, ""
    yield _("pressure angles"), all_titles, str(scan), positions, _("from the equilibrium of forces")
    if results.inputs.dynamics is not None:
        note = _(
            "the number of positions is increased until the integrals are accurate; then kinematics and forces "
            "are computed with this law"
        )
        yield _("law of motion"), all_titles, str(LAW_POSITIONS * driver_range.turns), accelerations, note
    if results.inputs.balancing is not None:
        note = _("shaking force and moment at constant speed of the driver")
        yield _("balancing"), all_titles, str(CYCLE_SAMPLES * driver_range.turns), accelerations, note
    note = _("with --position only the given positions; with --of only the groups that are needed")
    yield _("kinematics"), all_titles, requested_count, accelerations, note
    yield _("forces"), all_titles, requested_count, _("reactions"), f"{_inertia_text(linkage)}; {_load_text(linkage)}"
    yield (
        _("Zhukovsky lever"),
        "-",
        requested_count,
        velocities,
        _("with the same loads; no further equations are solved"),
    )
    if linkage.friction:
        yield _("friction losses"), all_titles, str(CYCLE_SAMPLES + 1), accelerations, _("over the whole cycle")
    drawn = _("only if drawings are requested")
    yield _("trajectories"), all_titles, str(POSITIONS_PER_TURN), positions, drawn
    diagrams = min((POSITIONS_PER_TURN - 1) * driver_range.turns, SCAN) + 1
    yield _("diagrams"), all_titles, str(diagrams), accelerations, drawn


def _inertia_text(linkage: Linkage) -> str:
    links = ", ".join(links_with_inertia(linkage))
    return _("inertia of links {links}").format(links=links) if links else _("no inertia")


def _load_text(linkage: Linkage) -> str:
    loads = ", ".join(linkage.acting)
    return _("loads {loads}").format(loads=loads) if loads else _("no loads")


def _group_titles(groups: Sequence[GroupSolver], all_groups: Sequence[GroupSolver]) -> str:
    if len(groups) == len(all_groups) > 1:
        return _("all {count}").format(count=len(all_groups))
    return " ".join(kernel.group.title for kernel in groups) or "-"


def skipped_tables(problem: Problem) -> Iterable[Table]:
    """Yield a table of the quantities that are not computed, with the reasons. There is none if everything is
    computed.
    """
    rows = list(_skipped_rows(problem))
    if rows:
        yield text_table("skipped", _("What is not computed"), (_("item"), _("reason")), rows)


def _skipped_rows(problem: Problem) -> Iterable[tuple[str, str]]:
    linkage = problem.linkage
    light = [n for n in linkage.moving if not np.any(linkage.links[n].mass != 0)]
    if light:
        yield _("weight and inertia of links {links}").format(links=", ".join(light)), _("no masses are given for them")
    spinless = [n for n in linkage.moving if not np.any(linkage.links[n].inertia != 0) and n not in light]
    if spinless:
        couples = _("inertia couples of links {links}").format(links=", ".join(spinless))
        yield couples, _("no moments of inertia are given for them")
    if not linkage.acting and len(light) == len(linkage.moving):
        yield _("all forces are zero"), _("neither masses nor loads are given")
    if linkage.gravity == 0:
        yield _("weights"), _("gravity is zero")
