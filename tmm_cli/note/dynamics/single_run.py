"""The law of motion of a single run: its energies and works, the speed at its end, and its figure."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import SingleRun
from tmm_cli.mechanics.forces import Lettered, Symbol
from tmm_cli.note.blocks import Block, Heading, said
from tmm_cli.note.context import Subject
from tmm_cli.note.dynamics.chapter import tables
from tmm_cli.note.dynamics.parts import FLYWHEEL, INERTIA, START
from tmm_cli.note.expression import Expression, Found, Function, Leaf, added

DRIVEN, LOADED, BRAKED, END = Lettered("A_d"), Lettered("A_l"), Lettered("A_b"), Symbol("T", "1")


def blocks(subject: Subject) -> Iterable[Block]:
    """Of a run with an end."""
    single = subject.results.single
    assert single is not None
    yield Heading(_("Law of motion"))
    yield from _energies(single, crank=subject.results.linkage.driver.kind == "turn")
    yield from subject.figures("run", _("The run is shown in figure {figure}."), _("Law of motion of the driving link"))
    yield from tables(subject)


def _energies(single: SingleRun, *, crank: bool) -> Iterable[Block]:
    """Of the whole run."""
    run = single.run
    yield said(
        _(
            "The machine is replaced by its driving link, to which all masses and all loads are reduced, and its "
            "equation of motion is integrated from the beginning of the run on."
        )
    )
    parts = [(START, run.kinetic[0]), (DRIVEN, run.driven[-1]), (LOADED, run.loaded[-1])]
    text = _(
        "The kinetic energy {T0} at the beginning grows by the work {Ad} of what drives and the work {Al} of the loads:"
    )
    if single.task.brake:
        parts.append((BRAKED, run.braked[-1]))
        text = _(
            "The kinetic energy {T0} at the beginning grows by the work {Ad} of what drives, the work {Al} of the "
            "loads and the work {Ab} of the brake:"
        )
    yield said(text, T0=START, Ad=DRIVEN, Al=LOADED, Ab=BRAKED)
    end = Leaf(END, float(run.kinetic[-1]))
    yield Found(END, added(Leaf(symbol, float(value)) for symbol, value in parts), end.value, _("J"))
    inertia = float(single.machine.inertia(np.array([run.way[-1]]))[0])
    every: Expression = Leaf(INERTIA if crank else Symbol("m"), inertia)
    if single.task.flywheel:
        every = Leaf(FLYWHEEL, single.task.flywheel) + every
    if run.speed[-1] > 0:
        yield said(_("With the reduced inertia at the end of the run the speed there is"))
        root = Function("sqrt", 2 * end / every)
        unit = _("rad/s") if crank else _("m/s")
        yield Found(Symbol("ω" if crank else "v", "1"), root, float(run.speed[-1]), unit)
