"""The structure and the way of the calculation in sentences, as they stand in an explanatory note."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _, printed
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.structure import Group, Pair, Structure
from tmm_cli.reports.given import input_tables
from tmm_cli.reports.stages import skipped, stages_table, steps
from tmm_cli.reports.structure_tables import (
    ROLES,
    contours_in_words,
    counted_by_classes,
    counted_generally,
    counted_mobility,
    counted_with_replacements,
    kind_in_words,
    left_out,
    mobility_with_rollers,
    motion_in_words,
    primary_mechanisms_in_words,
    schemes_in_words,
)
from tmm_cli.reports.table import Table
from tmm_cli.reports.understood import motion


def in_words(results: Results) -> Iterable[str]:
    """Whole sentences, in the order of a note."""
    structure = results.structure
    yield _mobility(structure)
    count = (len(structure.links), len(structure.pairs) - structure.higher, structure.higher)
    yield _("By classes of pairs the same is W = 3n - 2 p5 - p4 = {count}.").format(count=counted_by_classes(count))
    yield _("By the generalised formula W = Hn - sum((H - i) p_i) with H = 3 it is {count}.").format(
        count=counted_generally(count)
    )
    if structure.higher:
        text = _("With each higher pair replaced by a link with two turning pairs: W = {count}.")
        yield text.format(count=counted_with_replacements(count))
    if any(pair.mesh is not None and pair.mesh.roller for pair in structure.pairs):
        yield _("With rollers as links W = {count}.").format(count=mobility_with_rollers(structure))
    if structure.passive:
        yield _("The rank of its equations shows passive constraints: {count}; the true mobility is W = {w}.").format(
            count=structure.redundant, w=structure.mobility + structure.redundant
        )
    yield _("Pairs, with their classes and codes: {pairs}.").format(pairs=", ".join(map(_pair, structure.pairs)))
    for driver in results.linkage.drivers:
        yield _("Link {link} ({role}) is a driving link: {motion}.").format(
            link=driver.link, role=_(ROLES[results.roles[driver.link]]), motion=motion(driver)
        )
    yield _("The formula of structure is {formula}; the mechanism is of class {number}.").format(
        formula=structure.formula, number=structure.roman
    )
    if len(structure.drivers) > 1:
        yield _("Primary mechanisms: {names}.").format(names=primary_mechanisms_in_words(structure))
    yield _("Chain, and kind of structure: {words}.").format(words=kind_in_words(structure))
    yield _("Independent contours K = p - n: {count}.").format(count=contours_in_words(structure))
    schemes = schemes_in_words(structure)
    if schemes:
        yield _("Basic schemes in it: {schemes}.").format(schemes=schemes)
    motions = (f"{link}: {motion_in_words(results, link)}" for link in structure.links)
    yield _("Motion of the links: {motions}.").format(motions="; ".join(motions))
    for sentence in left_out(structure):
        yield _("For the formula: {what}.").format(what=sentence)
    for group in structure.groups:
        text = _("The group {group} is of class {number}, order {order}, type {type}; its outer pairs are {outer}.")
        kind = f"{group.type} ({group.letters}, {group.type_number})" if group.type_number else group.type
        yield text.format(
            group=group.title,
            number=group.roman,
            order=group.order,
            type=kind,
            outer=_outer(group),
        )
        yield _("For the group {group}, 3n - 2 p1 - p2 = {count}.").format(
            group=group.title, count=counted_mobility(group.count)
        )
    if structure.groups:
        yield _(
            "Positions, velocities and accelerations are found group by group in this order, reactions in the opposite "
            "one; {balance}, and Zhukovsky's lever checks it."
        ).format(balance=_balance(results.linkage))


def _mobility(structure: Structure) -> str:
    n, higher, w = len(structure.links), structure.higher, structure.mobility
    lower = len(structure.pairs) - higher
    turning = sum(pair.kind == "R" for pair in structure.pairs)
    text = _(
        "The mechanism has n = {n} moving links and p1 = {lower} lower pairs (turning: {turning}, sliding: {sliding}); "
        "by Chebyshev's formula its mobility is W = 3n - 2 p1 = 3*{n} - 2*{lower} = {w}."
    )
    if higher:
        text = _(
            "The mechanism has n = {n} moving links, p1 = {lower} lower pairs (turning: {turning}, sliding: {sliding}) "
            "and p2 = {higher} higher pairs; by Chebyshev's formula its mobility is "
            "W = 3n - 2 p1 - p2 = 3*{n} - 2*{lower} - {higher} = {w}."
        )
    return text.format(n=n, lower=lower, turning=turning, sliding=lower - turning, higher=higher, w=w)


def _pair(pair: Pair) -> str:
    """O 0-1 (5, 1в): a pair, its links, its class and its code; a higher pair has no code."""
    words = ", ".join(filter(None, (str(pair.pair_class), pair.code)))
    return f"{pair.name} {printed(pair.i)}-{printed(pair.j)} ({words})"


def _outer(group: Group) -> str:
    """The pairs that join a group to what is known, and that link."""
    known = [(pair.name, pair.i if pair.j in group.links else pair.j) for pair in group.outer]
    frame, moving = _("{pair} (frame)"), _("{pair} (link {link})")
    return ", ".join((frame if link == FRAME else moving).format(pair=pair, link=link) for pair, link in known)


def _balance(linkage: Linkage) -> str:
    driver = linkage.driver
    if linkage.others:
        return _("moments and forces on the driving links balance it")
    text = _("the balancing moment acts on link {link}")
    if driver.kind == "slide" or driver.balance == "force":
        text = _("the balancing force acts on link {link}")
    return text.format(link=driver.link)


# What a file was understood to say; then the way of the calculation (results.stages).


def explain_tables(results: Results, verbose: bool = False) -> Iterable[Table]:
    """Tables of words: the file in full, then the way of the calculation; verbose: places that each stage computes."""
    yield from input_tables(results.problem)
    yield steps(results)
    if verbose:
        yield stages_table(results)
    yield from skipped(results.problem)
