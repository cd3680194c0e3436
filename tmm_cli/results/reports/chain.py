"""A chain given by pairs alone: mobility, pairs, contours, local freedoms, manoeuvrability."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.language import _
from tmm_cli.results.reports.space import contour_table, redundancy
from tmm_cli.results.table import Table, table_of_words
from tmm_cli.structure.assur import ROMAN
from tmm_cli.structure.spatial import AXLES, CONTACTS, Findings, LocalFreedom


def tables(results: ChainResults) -> Iterable[Table]:
    """Up to four small tables."""
    found = results.chain
    yield table_of_words("structure", _("Structure"), (_("what"), _("value")), _facts(found), _notes(found))
    yield table_of_words(
        "pairs", _("Kinematic pairs"), (_("pair"), _("links"), _("kind"), _("freedoms"), _("class")),
        [(p.name, f"{p.i} - {p.j}", _(p.kind), str(p.freedoms), ROMAN[p.pair_class])
         for p in found.chain.pairs],
    )  # fmt: skip
    if found.contours:
        yield contour_table(found.contours)
    if found.local:
        yield table_of_words(
            "local", _("Local freedoms"), (_("links"), _("freedoms"), _("between pairs"), _("what it does")),
            [(", ".join(x.links), str(x.freedoms), ", ".join(p.name for p in x.ends), _how(x)) for x in found.local],
        )  # fmt: skip


def _facts(found: Findings) -> Iterable[tuple[str, str]]:
    chain = found.chain
    yield _("moving links n"), str(len(chain.links))
    yield _("pairs with 1 to 5 freedoms"), ", ".join(f"p{i} = {chain.p(i)}" for i in range(1, 6))
    yield _("W by Somov-Malyshev"), chain.count
    yield _("independent contours K = p - n"), str(len(chain.pairs) - len(chain.links))
    yield _("chain"), _form(found)
    yield _("local freedoms Wm"), str(found.local_mobility)
    yield _("without them, W - Wm"), str(found.effective)
    if found.wanted is not None and found.redundant is not None:
        q = redundancy(found.wanted, found.local_mobility, found.mobility, found.redundant)
        yield _("redundant constraints q = Wo + Wm - W"), q
    if found.output is not None:
        yield _("manoeuvrability m: W with link {link} held").format(link=found.output), chain.held(found.output).count


def _form(found: Findings) -> str:
    if found.form == "mixed":
        return _("closed, with open branches (links {links})").format(links=", ".join(found.branches))
    return _("open") if found.form == "open" else _("closed: every link lies in a contour")


def _notes(found: Findings) -> Iterable[str]:
    seen = sum(x.freedoms for x in found.local)
    if found.given_local is not None and found.given_local < seen:
        yield _("{given} local freedoms are given, the pairs show {found}.").format(given=found.given_local, found=seen)
    if found.immobile:
        yield _(
            "W - Wm < 1: by the count links {links} cannot move. If they do, by special dimensions such as parallel "
            "axes, give the mobility that is meant (wanted: 1): the redundant constraints q are then counted."
        ).format(links=", ".join(found.immobile))
    if found.redundant is not None and found.redundant > 0 and found.effective < 1:
        yield _("q = {q}: the chain moves with exact dimensions only, by the count it cannot.").format(
            q=found.redundant
        )
    if found.redundant is not None and found.redundant < 0:
        yield _("q < 0: the chain has {many} freedoms more than are wanted.").format(many=-found.redundant)
    m, idle = found.manoeuvrability, found.idle_manoeuvrability
    if m is not None and m < 1:
        yield _("m = {m}: with the output held the chain cannot move; m >= 1 is wanted.").format(m=m)
    elif m is not None and m - idle < 1:
        yield _("m = {m}, but {local} of it are local freedoms: the arm cannot go round an obstacle.").format(
            m=m, local=idle
        )


def _how(part: LocalFreedom) -> str:
    kinds = part.kinds
    if kinds & CONTACTS and kinds & {*AXLES}:
        return _("rotates about its own axis as a roller")
    if part.freedoms == 1 and kinds == {"cylindrical", "spherical"}:
        return _("rotates about its own axis if the ball lies on it")
    if part.freedoms == 1 and len(part.ends) == 2 and kinds <= {"spherical", "planar"}:
        if kinds == {"spherical"}:
            return _("turns about the line of both centres")
        if kinds == {"planar"}:
            return _("slides along both planes")
        return _("turns about the normal of the plane through the centre")
    return _("moves with its neighbours held")
