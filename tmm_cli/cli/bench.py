"""`tmm bench`: measurements. A new one is a function here, with its measurement and its chart in `tmm_cli/bench`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.bench_common import Out, Reduced, chosen, finish, table
from tmm_cli.cli.common import BAD_INPUT, Json, emit_json, say
from tmm_cli.errors import _

if TYPE_CHECKING:
    from tmm_cli.bench.savings import Savings
    from tmm_cli.results.table import Column, Table

app = typer.Typer(
    name="bench",
    help="Measure speed, accuracy, stability, savings and synthesis on this machine.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
Linkages = Annotated[
    list[str] | None,
    typer.Option("--linkage", metavar="NAME", help="This linkage only (may be repeated).", show_default=False),
]
Families = Annotated[
    list[str] | None,
    typer.Option("--family", metavar="NAME", help="This family only (may be repeated).", show_default=False),
]
File = Annotated[
    str | None, typer.Argument(metavar="[FILE]", help="Problem file; none: the shaper of tmm new.", show_default=False)
]


@app.command()
def accuracy(linkage: Linkages = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against largest relative error of many methods, on five linkages known to 50 digits.

    Exit code 1 when the product itself misses its targets: 1e-14 for positions, 1e-13 for all else.
    """
    from tmm_cli.bench.accuracy import NAMED, measure
    from tmm_cli.bench.chart_accuracy import chart
    from tmm_cli.bench.references import NAMES

    names = chosen(linkage, NAMES, _("there is no reference linkage {name}; there are {names}"))
    measured = measure(names, reduced=reduced, progress=say)
    tables = [
        table(
            "accuracy", _("Errors over the largest value in the cycle: {linkage}").format(linkage=name),
            (_("method"), _("µs a position"), *NAMED.values()),
            [
                (row.method, "-" if row.microseconds is None else f"{row.microseconds:.3g}",
                 *("-" if math.isnan(row.errors[q]) else f"{row.errors[q]:.1e}" for q in NAMED))
                for row in measured.rows if row.linkage == name
            ],
        ) for name in names
    ]  # fmt: skip
    finish(
        "accuracy", measured, tables, lambda: {f"accuracy-{name}.png": chart(measured, name) for name in names},
        out, as_json=as_json, met=_("all targets met: positions within 1e-14, the rest within 1e-13"),
    )  # fmt: skip


@app.command()
def savings(file: File = None, reduced: Reduced = False, as_json: Json = False, out: Out = None) -> None:
    """Count and time what is saved by computing no more than what is asked; exit code 1 when something is not."""
    from tmm_cli import load
    from tmm_cli.bench.chart_savings import chart
    from tmm_cli.bench.savings import measure
    from tmm_cli.errors import LinkageError
    from tmm_cli.problem.build import build
    from tmm_cli.problem.errors import ProblemError
    from tmm_cli.problem.reader import read_text
    from tmm_cli.problem.refusals import refusal
    from tmm_cli.problem.templates import template_text

    try:
        problem = load(file).whole if file is not None else build(read_text(template_text("shaper"), "shaper.yaml"))
        try:
            measured = measure(problem, reduced=reduced)
        except LinkageError as error:
            raise refusal(error, problem) from None
    except ProblemError as error:
        if as_json:
            emit_json({"error": error.to_dict()})
        say(f"error: {error}")
        raise typer.Exit(BAD_INPUT) from None
    finish(
        "savings", measured, [_saved(measured)],
        lambda: dict.fromkeys(("savings.png", "savings.svg"), chart(measured)), out, as_json=as_json,
    )  # fmt: skip


def _saved(measured: Savings) -> Table:
    """A row a saving: what was counted and how long it took, with it and without."""
    from tmm_cli.bench.savings import COUNTED, NAMED, WHY_NOT
    from tmm_cli.quantities import NUMBER
    from tmm_cli.results.table import Column, Table

    found = measured.found

    def number(header: str, values: Sequence[float | None]) -> Column:
        return Column(header, [None if s.why else v for s, v in zip(found, values, strict=True)], NUMBER, digits=3)

    def told(header: str, values: Sequence[object]) -> Column:
        return Column(header, ["" if s.why else str(v) for s, v in zip(found, values, strict=True)])

    return Table(
        "savings", _("What is saved by computing no more than what is asked for"),
        (
            Column(_("saving"), [NAMED[s.name] for s in found]),
            told(_("counted"), [COUNTED[s.counts] for s in found]),
            told(_("with it"), [s.with_ for s in found]),
            told(_("without"), [s.without for s in found]),
            number(_("with it, ms"), [s.seconds[0] * 1e3 for s in found]),
            number(_("without, ms"), [s.seconds[1] * 1e3 for s in found]),
            number(_("times faster"), [s.seconds[1] / s.seconds[0] if s.seconds[0] else None for s in found]),
            Column(_("remark"), [WHY_NOT[s.why] if s.why else "" if s.holds else _("saves nothing") for s in found]),
        ),
        notes=(_(
            "A solution is a group at one place of the driver, or a round of Newton's method there; "
            "its velocities and its accelerations are one more each."
        ),),
    )  # fmt: skip


@app.command()
def speed(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Time a position against code written by hand for one mechanism, other programs, and growing problems.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.chart_speed import chart
    from tmm_cli.bench.speed import GROWING, RIVALS, measure

    measured = measure(reduced=reduced, progress=say)
    races = table(
        "races", _("Nanoseconds a position with all reactions, against NumPy written by hand for this mechanism"),
        (_("mechanism"), _("variants"), _("positions"), _("tmm"), _("by hand"), _("ratio"), _("at most"),
         _("preparing once, ms")),
        [
            (r.mechanism, str(r.variants), str(r.positions), f"{r.ours:.0f}", f"{r.by_hand:.0f}", f"{r.ratio:.2f}",
             "" if r.target is None else f"{r.target:g}", f"{r.preparing:.0f}") for r in measured.races
        ],
    )  # fmt: skip
    growths = table(
        "growths", _("How time grows: t0 + c n^exponent"), (_("with"), _("n"), _("ms"), _("exponent")),
        [
            (GROWING[g.what][0], f"{g.numbers[0]} ... {g.numbers[-1]}",
             f"{1e3 * g.seconds[0]:.2f} ... {1e3 * g.seconds[-1]:.2f}", f"{g.exponent:.3f}") for g in measured.growths
        ],
    )  # fmt: skip
    rivals = table(
        "rivals", _("Other programs, nanoseconds a position of 360"),
        (_("program"), _("mechanism"), _("its time"), _("tmm"), _("times as long"), _("at least")),
        [
            (r.name, r.mechanism, f"{r.theirs:.0f}", f"{r.ours:.0f}", f"{r.ratio:.1f}", f"{RIVALS[r.name]:g}")
            for r in measured.rivals
        ],
    )  # fmt: skip
    tables = [races, growths, rivals] if measured.rivals else [races, growths]
    finish("speed", measured, tables, lambda: {"speed.png": chart(measured)}, out, as_json=as_json)


@app.command()
def stability(family: Families = None, reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Every method as it comes near what kills it, and the distance at which it first lies, against 50 digits.

    Exit code 1 when a value of the product is off by more than its bound, or when fewer than nine of ten of its bounds
    are within 100 times the true error.
    """
    from tmm_cli.bench.chart_stability import charts
    from tmm_cli.bench.families import BY_NAME
    from tmm_cli.bench.stability import WIDE, measure

    names = chosen(family, BY_NAME, _("there is no family {name}; there are {names}"))
    measured = measure(names, reduced=reduced, progress=say)

    def first(name: str, method: str) -> str:
        if not measured.of(name, method):
            return "-"
        distance = measured.lies(name, method)
        return _("never") if distance is None else f"{distance:.0e}".replace("e-0", "e-")

    lies = table(
        "stability", _("Where each method first gives a wrong answer without saying so"),
        (_("method"), *measured.families),
        [(method, *(first(name, method) for name in measured.families)) for method in measured.methods],
    )  # fmt: skip
    sharp = _("{count} bounds of tmm against 50 digits: {share} are at most {wide} times the true error").format(
        count=len(measured.widths), share=f"{measured.sharp:.1%}", wide=f"{WIDE:g}"
    )
    finish(
        "stability", measured, [lies],
        lambda: {f"stability-{number}.png": sheet for number, sheet in enumerate(charts(measured), 1)},
        out, as_json=as_json, more=[sharp], met=_("all targets met: every value within its bound or not given"),
    )  # fmt: skip


@app.command()
def synthesis(reduced: Reduced = False, out: Out = None, as_json: Json = False) -> None:
    """Count candidates a second of the optimal synthesis, and how near 10 seeds come to the best known.

    Exit code 1 when a target is missed, of a reduced run by more than twice.
    """
    from tmm_cli.bench.chart_searches import chart
    from tmm_cli.bench.searches import measure

    measured = measure(reduced=reduced, progress=say)
    runs = measured.known["runs"]
    rates = table(
        "rates", _("Candidates a second at the evaluation, one thread: least time of several turns"),
        (_("problem"), _("parameters"), _("constraints"), _("positions"), _("operations"), _("generation"),
         _("candidates/s"), _("at least")),
        [
            (r.problem, str(r.parameters), str(r.constraints), str(r.positions), str(r.operations), str(r.generation),
             f"{r.per_second:.0f}", "" if r.target is None else f"{r.target:.0f}") for r in measured.rates
        ],
    )  # fmt: skip
    found = table(
        "found",
        _("Search from several seeds, {problem}; best known {objective:.9g} of {runs} runs of {evaluations} candidates")
        .format(problem=measured.known["problem"], objective=measured.known["objective"], runs=len(runs),
                evaluations=max(run["evaluations"] for run in runs)),
        (_("seed"), _("objective (SI)"), _("above the best known, %"), _("candidates"), _("search, s"),
         _("polish, s")),
        [
            (str(f.seed), f"{f.objective:.9g}", f"{100 * f.off:.2g}", str(f.evaluations), f"{f.searching:.2f}",
             f"{f.polishing:.2f}") for f in measured.found
        ],
    )  # fmt: skip
    finish("synthesis", measured, [rates, found], lambda: {"synthesis.png": chart(measured)}, out, as_json=as_json)
