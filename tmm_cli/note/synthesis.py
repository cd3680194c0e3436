"""Chapter on synthesis: requirements, formulas, results, and the required quantities measured on the mechanism."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tmm_cli.language import _, translated
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note.blocks import Block, Heading, paragraph, write_sentence, write_table
from tmm_cli.note.expression import ComputedQuantity, Constant, Function, Leaf
from tmm_cli.note.subject import Subject, note_table, typeset_formulas
from tmm_cli.problem import Synthesised
from tmm_cli.reports import tables_of_synthesis
from tmm_cli.synthesis import Diagram, measure_problem, theta_of

FOUND = 6  # figures of computed lengths; with fewer the mechanism would differ
THETA, K, H = Symbol("θ"), Symbol("k"), Symbol("H")
USED = ("k", "stroke", "OA", "OC", "CD")  # values that are substituted in formulas


def write_synthesis(subject: Subject) -> Iterable[Block]:
    """Write the chapter on synthesis. It is empty if the file gives all dimensions of the mechanism."""
    results = subject.results
    task = results.problem.synthesis
    if task is None:
        return
    yield Heading(_("Synthesis of the mechanism"))
    tables = {t.name: t for t in tables_of_synthesis(task, measure_problem(results), results.problem.units, FOUND)}
    required = tables.pop("synthesis-asked", None)
    if required is None:
        yield paragraph(_("The dimensions of the mechanism are determined from the requirements."))
    else:
        rows = note_table(subject, required, _("Requirements"), "asked", FOUND)
        yield from write_table(
            _("The dimensions of the mechanism are determined from the requirements (table {table})."), rows
        )
    source = typeset_formulas(translated(task.outcome.source).rstrip("."))
    yield paragraph(_("Method of solution: {source}.").format(source=source))
    yield from _write_formulas(task)
    results_table = tables.pop("synthesis-found", None)
    measured = tables.pop("synthesis-measured", None)
    if results_table is not None:
        rows = note_table(subject, results_table, _("Results of the synthesis"), "found", FOUND)
        yield from write_table(_("The results are given in table {table}."), rows)
        yield from (paragraph(typeset_formulas(translated(note))) for note in task.outcome.notes)
    yield from (note_table(subject, t, digits=FOUND) for t in tables.values() if not t.long)
    diagrams = [drawn for drawn in task.outcome.drawings if isinstance(drawn, Diagram)]
    for drawn in task.outcome.drawings:
        sentence = _("The construction is drawn in figure {figure}.")
        if drawn in diagrams[:1]:
            sentence = _("Figure {figure} shows how the result depends on the freely chosen quantity.")
        elif drawn in diagrams:
            sentence = _("Figure {figure} shows other quantities that depend on this choice.")
        yield from subject.figures("synthesis", sentence, only=f"synthesis-{drawn.name}")
    sentence = _("The extreme positions of the resulting mechanism are shown in figure {figure}.")
    yield from subject.figures("synthesis", sentence, only="synthesis-extremes")
    if measured is not None:
        text = _("Table {table} gives the same quantities measured on the mechanism with these dimensions.")
        rows = note_table(subject, measured, _("Required quantities, measured on the mechanism"), "measured", FOUND)
        yield from write_table(text, rows)


def _write_formulas(task: Synthesised) -> Iterable[Block]:
    """Write the formulas of the synthesis with numbers substituted, if they fit on one line."""
    values = {
        value.name: float(value.value) for value in (*task.outcome.asked, *task.outcome.found) if value.name in USED
    }
    if "k" in values:
        theta = float(theta_of(values["k"]))
        yield write_sentence(
            _("The angle {theta} follows from the time ratio {k} (coefficient of change of mean speed):"),
            theta=THETA,
            k=K,
        )
        ratio = Leaf(K, values["k"])
        share = (ratio - 1) / (ratio + 1)
        yield ComputedQuantity(THETA, Constant(math.pi, "180°") * share, theta, "°", angle=True)
        half = Function("sin", Leaf(THETA, theta, angle=True) / 2)
        if task.task == "shaper":
            length = Leaf(H, values["stroke"]) / (2 * half)
            yield ComputedQuantity(Symbol("l", "CD"), length, values["CD"], "m")
        if task.task in ("shaper", "slotted-lever"):
            crank = Leaf(Symbol("l", "OC"), values["OC"]) * half
            yield ComputedQuantity(Symbol("l", "OA"), crank, values["OA"], "m")
