"""Loads and reactions. Long: a row a position."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.forces.transmission import find_transmitted_forces
from tmm_cli.language import N_, Phrase, _, printed, symbol
from tmm_cli.linkage import FRAME
from tmm_cli.plans.bodies import load_names
from tmm_cli.quantities import ANGLE, FORCE, LOAD, MOMENT, REACTION, TRANSMITTED, columns
from tmm_cli.results.reports.cycle import driver_columns, signs
from tmm_cli.results.reports.long import long_table
from tmm_cli.results.reports.structure import indeterminate
from tmm_cli.results.table import Column, Table


def label(by: str, on: str) -> str:
    """R_12 acts from link 1 on link 2."""
    by, on = printed(by), printed(on)
    return f"R_{by}{on}" if len(by) == len(on) == 1 else f"R_{by},{on}"


def tables(results: Results) -> Iterable[Table]:
    """Reactions, in compound hinges link by link too, loads, and the driving link."""
    reactions = results.reactions
    assert reactions is not None
    words = {
        N_("pair"): [r.pair.name for r in reactions.all],
        N_("name"): [label(r.by, r.on) for r in reactions.all],
    }
    note = _("R_ik acts from link i on link k; `acts at`: along the guide from its running point.")
    note = " ".join([note, *indeterminate(results.structure)])
    values = [columns(REACTION, reaction) for reaction in reactions.directed]
    yield long_table(results, "reactions", _("Reactions"), words, values, note)
    pins = reactions.pins(results.linkage)
    if pins:
        words = {
            N_("pin"): [pin.point for pin in pins],
            N_("link"): [pin.link for pin in pins],
            N_("pairs"): [", ".join(pin.pairs) for pin in pins],
        }
        title = _("Compound hinges: the force of the pin on each of its links")
        note = _(
            "The link named with all pairs, to which the others are attached, bears the force of the whole pin; the "
            "forces on all links add up to zero."
        )
        yield long_table(results, "pins", title, words, [columns(LOAD[:1], pin) for pin in pins], note)
    loads = reactions.applied
    if loads:
        words = {N_("link"): [x.link for x in loads], N_("name"): [load_names(x)[0] for x in loads]}
        title = _("Loads: weights {G}, inertia forces {U} and couples {M}, and those of the task").format(
            G=symbol("G"), U=symbol("U"), M=symbol("M")
        )
        yield long_table(results, "loads", title, words, [columns(LOAD, load) for load in loads])
    yield from _transmitted(results)
    yield _balances(results)


def _transmitted(results: Results) -> Iterable[Table]:
    """Of every link that is driven in one pair: its pressure angle, the driving force and what of it is useful."""
    assert results.motion is not None and results.reactions is not None
    found = find_transmitted_forces(results.motion, results.reactions)
    if found and results.reactions.loaded:
        angles = {(p.group, p.link): p.angles for p in results.pressure}
        words = {N_("driven link"): [f.link for f in found], N_("driven in pair"): [f.pair for f in found]}
        things = [
            [(N_("pressure angle"), angles.get((f.group, f.link)), ANGLE), *columns(TRANSMITTED, f)] for f in found
        ]
        note = _(
            "P: reaction of the pair in which the link is driven; Q: its component along the velocity of its point. "
            "Without weights, inertia and friction Q = P cos(pressure angle)."
        )
        yield long_table(results, "transmission", _("Force transmission"), words, things, note)


def _balances(results: Results) -> Table:
    """Every driver's moment or force, and what the frame does to the links that are driven from it."""
    reactions = results.reactions
    assert reactions is not None
    found = driver_columns(results)
    several = len(reactions.balances) > 1
    for balance in reactions.balances:
        link = balance.driver.link
        if balance.moment is not None:
            name = _("M_b of {link}").format(link=link) if several else _("M_b")
            found.append(Column(name, balance.moment, MOMENT))
        if balance.moment is None or balance.driver.base == FRAME:
            name = _("F_b of {link}").format(link=link) if several else _("F_b")
            found.append(Column(name, balance.force, FORCE))
        for frame in (f for f in reactions.frames if f.on == link):
            name = label(frame.by, frame.on)
            found.append(Column(Phrase("{name} x", name=name), frame.force.real, FORCE))
            found.append(Column(Phrase("{name} y", name=name), frame.force.imag, FORCE))
    return Table("balance", _("Driving link"), tuple(found), notes=(signs(results.linkage),))
