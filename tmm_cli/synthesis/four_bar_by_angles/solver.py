"""Synthesis of a four-bar from pairs of angles: solution, values to be measured, notes and tables."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_, Phrase, _
from tmm_cli.mechanics.numerics import zero_within_rounding
from tmm_cli.synthesis import four_bar
from tmm_cli.synthesis.four_bar_by_angles.angle_pairs import (
    LENGTHS,
    LIMITS,
    LONGEST,
    ZEROS,
    AnglePairsTask,
    FourBarQuality,
    are_admissible,
    are_real,
    bounds_reached,
    choose_four_bar,
    four_bars_of_ratios,
    four_bars_through,
    rate_four_bars,
)
from tmm_cli.synthesis.four_bar_by_angles.drawings import (
    draw_construction,
    draw_reached,
    draw_structural_error,
    error_extremes,
    output_errors,
)
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import FourBarRatios, find_parallelogram
from tmm_cli.synthesis.four_bar_by_angles.generated_function import ANGLES
from tmm_cli.synthesis.measures import driver_completes_range
from tmm_cli.synthesis.record import (
    Demand,
    Infeasible,
    Listing,
    NamedValue,
    SolutionQuality,
    SynthesisOutcome,
    given_values,
)

# Four-bar by pairs of angles of its input AB and output DC, given or taken from a function.
#
# l1 = AB, l2 = BC, l3 = DC, l4 = AD; angles from AD, counterclockwise, without the zero angles phi0 and psi0. Of all
# real solutions those without defects are kept: all pairs on one assembly, no position between them where the input
# link locks. More pairs than a four-bar can reach exactly are fitted by least squares.


FOUND: Final = {
    **LENGTHS,
    **ZEROS,
    "phi1": ("angle", N_("angle of AB in the first pair, measured from AD")),
    "psi1": ("angle", N_("angle of DC in the first pair, measured from AD")),
}
PARAMETERS: Final = {name: kind for name, (kind, __) in FOUND.items()}
DEFECTS: Final = {
    "": N_("none: all pairs belong to one assembly and are reached in order"),
    "branch": N_("branch defect: some pairs belong to the other assembly"),
    "locks": N_("order defect: the input link reaches a dead position between two pairs of angles"),
}
MEAN: Final = N_("root mean square error of the output angle")
SHORT_DEFECTS: Final = {"": N_("none"), "branch": N_("branch defect"), "locks": N_("order defect")}
NO_FOUR_BAR: Final = N_("no four-bar passes through these pairs of angles")
NONE_NEAR: Final = N_(
    "no four-bar with links up to {ratio} : 1 passes near these pairs of angles without locking between them; for "
    "longer links, increase link_ratio"
)
DEFECTS_OF_ALL: Final = {
    "branch": N_(
        "branch defect: every four-bar through these pairs of angles reaches some of them only in its other assembly"
    ),
    "locks": N_("order defect: the input link of every four-bar through these pairs of angles locks between them"),
    "branch and locks": N_(
        "every four-bar through these pairs of angles has a branch defect, or its input link locks between them"
    ),
}
COLUMNS: Final = (
    *((name, name, PARAMETERS[name]) for name in ("l1", "l2", "l3", "l4", "phi0", "psi0")),
    ("transmission", N_("smallest transmission angle"), "angle"),
)
SHOWN: Final = 40  # largest number of pairs in a table that is printed
FAMILY: Final = 121  # tabulated four-bars through two pairs, for each direction of the crank


def solve(task: AnglePairsTask) -> SynthesisOutcome:
    """Find the four-bar, draw it and tabulate the other solutions. Raises Infeasible."""
    solutions, at = choose_solution(task)
    solution, rating = solutions.at(at), rate_four_bars(solutions.at(at), task)
    is_parallelogram = find_parallelogram(task.phi, task.psi, task.phi0, task.psi0) is not None
    values, demands = _list_solution_values(task, solution, rating), _list_demands(task, solution, rating)
    if not is_parallelogram:  # a parallelogram has change points
        demands.append(
            Demand(
                N_("input link rotates fully (1: yes)"),
                float(rating.crank),
                "number",
                driver_completes_range,
                asked=False,
            )
        )
    drawings: list[Any] = []
    if not task.approximate:
        drawings.append(draw_construction(solution, task.phi, task.psi, float(_compute_frame_length(task, solution))))
    elif not task.function:
        drawings.append(draw_reached(solution, task))
    listings = [_tabulate_pairs(task, solution)] if task.approximate else []
    if solutions.size > 1:
        values.append(
            NamedValue("", f"{at + 1} / {solutions.size}", "word", N_("number of the solution in the table below"))
        )
        listings.append(_tabulate_solutions(task, solutions, at))
    if task.free:
        values.append(
            NamedValue("", 1 / float(solution.l1), "number", N_("ratio l4/l1 (free with two pairs of angles)"))
        )
        listings.append(_tabulate_family(task))
    if task.function and not rating.defect:
        curve, error = draw_structural_error(solution, task)
        values.append(NamedValue("", error, "angle", N_("largest structural error")))
        largest = partial(_measure_largest_error, solution, task)
        demands.append(Demand(N_("largest structural error"), error, "angle", largest, asked=False, at=1.0))
        drawings.append(curve)
    source = N_(
        "Freudenstein's equation (l4/l1) cos(psi) - (l4/l3) cos(phi) + (l1^2 + l3^2 + l4^2 - l2^2)/(2 l1 "
        "l3) = cos(phi - psi), angles measured from AD; Trans. ASME 76 (1954)"
    )
    quality = SolutionQuality(
        np.pi / 2 - float(rating.least),
        crank=bool(rating.crank),
        defect="order" if rating.defect == "locks" else "branch" if rating.defect else "",
        limited=task.transmission is not None,
    )
    return SynthesisOutcome(
        _list_given_values(task),
        tuple(values),
        source,
        tuple(demands),
        tuple(drawings),
        tuple(_write_notes(task, solution, rating, is_parallelogram)),
        tuple(listings),
        quality=quality,
    )


def choose_solution(task: AnglePairsTask) -> tuple[FourBarRatios, int]:
    """Return all four-bars that satisfy the task, and the index of the chosen one. Raises Infeasible."""
    _refuse_inputs(task)
    four_bars = four_bars_through(task)
    defects = rate_four_bars(four_bars, task).defect
    admissible = [str(k + 1) for k in np.flatnonzero(are_admissible(task, four_bars))]
    if not admissible and task.transmission:
        _refuse_transmission(task)
    if not admissible and task.approximate:
        key_of_pairs = "output" if task.function else "pairs"
        raise Infeasible(key_of_pairs, Phrase(NONE_NEAR, ratio=f"{task.link_ratio:g}"), search=False)
    if not admissible:
        key = ("output",) if task.function else ("pairs", len(task.psi) - 1)
        raise Infeasible(key, NO_FOUR_BAR if not four_bars.size else DEFECTS_OF_ALL[" and ".join(sorted(set(defects)))])
    if task.choose.isdigit() and task.choose not in admissible:
        reason = _("there is no solution with this number, or it has a defect")
        raise Infeasible("choose", reason, ", ".join(admissible))
    return four_bars, choose_four_bar(task, four_bars)


def _refuse_transmission(task: AnglePairsTask) -> None:
    """Raise Infeasible if four-bars satisfy the task except for the required transmission angle.

    The error contains the best possible transmission angle, unless the pairs can be reached only approximately.
    """
    free = replace(task, transmission=None)
    four_bars = four_bars_through(free)
    admissible = are_admissible(free, four_bars)
    if admissible.any():
        best = float(rate_four_bars(four_bars, free).least[admissible].max())
        reason = _("no four-bar through these pairs of angles has so large a smallest transmission angle")
        raise Infeasible("transmission", reason, None if task.approximate else (best, "angle", -1), search=False)


def refuse(task: AnglePairsTask) -> None:
    """Raise Infeasible, with the reason, if no four-bar satisfies the task."""
    choose_solution(task)


def _refuse_inputs(task: AnglePairsTask) -> None:
    """Raise Infeasible unless the input angles increase or decrease monotonically by less than one revolution."""
    steps = np.diff(np.asarray(task.phi, dtype=float))
    back = np.flatnonzero(steps * (np.sign(steps[0]) or 1.0) <= 0) + 1
    if back.size and not task.function:
        reason = _("the input link reverses: pair of angles {this} cannot be reached after pair {last}")
        raise Infeasible(("pairs", int(back[0]), 0), reason.format(this=back[0] + 1, last=back[0]))
    if back.size or abs(task.span[1] - task.span[0]) >= 2 * np.pi:
        key = ("input", 1) if task.function else ("pairs", len(task.phi) - 1, 0)
        raise Infeasible(key, _("the input link completes a full revolution before the last pair of angles"))


def _compute_frame_length(task: AnglePairsTask, solution: FourBarRatios) -> Any:
    """Return the frame length l4 (m) of a four-bar, which follows from the given length."""
    name = next(iter(task.lengths))
    return task.lengths[name] / (1.0 if name == "l4" else getattr(solution, name))


def _list_solution_values(task: AnglePairsTask, solution: FourBarRatios, rating: FourBarQuality) -> list[NamedValue]:
    frame_length = _compute_frame_length(task, solution)
    numbers = {
        "l1": solution.l1 * frame_length,
        "l2": solution.l2 * frame_length,
        "l3": solution.l3 * frame_length,
        "l4": frame_length,
    }
    first = task.psi[0] + (output_errors(solution, task)[0] if task.approximate else 0.0)
    angles = {
        "phi0": solution.phi0,
        "psi0": solution.psi0,
        "phi1": solution.phi0 + task.phi[0],
        "psi1": solution.psi0 + first,
    }
    numbers |= {key: zero_within_rounding(angle, np.pi) for key, angle in angles.items()}
    return [
        *(NamedValue(key, float(numbers[key]), *description) for key, description in FOUND.items()),
        NamedValue("", rating.least, "angle", N_("smallest transmission angle over the range")),
        NamedValue("", DEFECTS[str(rating.defect)], "word", N_("defects")),
        *([NamedValue("", _compute_mean_error(solution, task), "angle", MEAN)] if task.approximate else []),
    ]


def _list_demands(task: AnglePairsTask, solution: FourBarRatios, rating: FourBarQuality) -> list[Demand]:
    if task.approximate:
        mean = partial(_measure_mean_error, solution, task)
        demands = [Demand(MEAN, _compute_mean_error(solution, task), "angle", mean, asked=False, at=1.0)]
    else:
        demands = [
            Demand(_describe_output(k), float(b), "angle", partial(_measure_output, solution, a, b), at=1.0)
            for k, (a, b) in enumerate(zip(task.phi, task.psi, strict=True))
        ]
    name, measure = (
        N_("smallest transmission angle over the range"),
        partial(four_bar.transmission_angle, float(rating.worst)),
    )
    return [*demands, Demand(name, float(rating.least), "angle", measure, asked=False, at=1.0)]


def _compute_mean_error(four_bar: FourBarRatios, task: AnglePairsTask) -> float:
    return float(np.sqrt(np.mean(output_errors(four_bar, task) ** 2)))


def _measure_outputs(solution: FourBarRatios, results: Any, phi: Any, near: Any) -> Any:
    """Return the output angles (rad) of the analysed mechanism at given input angles.

    All angles are measured from the zero angles. Full turns are added to each result, so that it is closest to the
    expected angle `near`.
    """
    return four_bar.output_angles(results, phi + float(solution.phi0), near + float(solution.psi0)) - float(
        solution.psi0
    )


def _measure_mean_error(solution: FourBarRatios, task: AnglePairsTask, results: Any) -> float:
    phi, psi = np.asarray(task.phi, dtype=float), np.asarray(task.psi, dtype=float)
    return float(
        np.sqrt(np.mean((_measure_outputs(solution, results, phi, psi + output_errors(solution, task)) - psi) ** 2))
    )


def _describe_output(k: int) -> str:
    return Phrase("output angle {number}", number=k + 1)


def _measure_output(solution: FourBarRatios, phi: float, psi: float, results: Any) -> float:
    return float(_measure_outputs(solution, results, np.array([phi]), np.array([psi]))[0])


def _measure_largest_error(solution: FourBarRatios, task: AnglePairsTask, results: Any) -> float:
    """Return the largest structural error (rad) of the analysed mechanism."""
    assert task.function
    function = task.function

    def error(phi: Any) -> Any:
        required = function.required_output(phi)
        return _measure_outputs(solution, results, phi, required) - required

    return error_extremes(error, function)[1]


def _write_notes(
    task: AnglePairsTask, solution: FourBarRatios, rating: FourBarQuality, is_parallelogram: bool
) -> Iterable[str]:
    if task.approximate and not is_parallelogram:
        yield N_(
            "there are more pairs than a four-bar can reach exactly: the sum of the squared errors of the "
            "output angle is minimised"
        )
    if is_parallelogram and len(task.lengths) == 1:
        yield N_(
            "the input and output angles stay equal: every parallelogram with l1 = l3 and l2 = l4 passes "
            "through the pairs, and its transmission angle is the angle between DC and AD; l1/l4 is free and "
            "was taken as 1/2"
        )
    if task.approximate and not is_parallelogram:
        at_ratio, at_transmission = bounds_reached(task, solution)
        if at_ratio:
            yield Phrase(
                "at the bound of the links: the longest is {ratio} times the shortest, and the error keeps decreasing "
                "as this ratio grows (key link_ratio)",
                ratio=f"{task.link_ratio:g}",
            )
        if at_transmission:
            yield Phrase(
                "at the bound of the transmission angle: it is {angle} deg at its smallest, and the error keeps "
                "decreasing as it decreases (key transmission)",
                angle=f"{np.degrees(float(rating.least)):.4g}",
            )
    if rating.reversed:
        yield N_(
            "one link points opposite to its given zero angle (difference 180 deg): with the given direction "
            "no such mechanism exists"
        )
    if task.choose == "crank" and not rating.crank:
        yield N_("no solution without defects has an input link that rotates fully: another solution was taken")
    if task.free and abs(abs(np.log(abs(float(solution.l1)))) - np.log(LONGEST)) < 1e-9:
        yield N_(
            "two pairs of angles leave l4/l1 free: between 0.1 and 10 the transmission angle is best at one "
            "end of the range, which was taken; for another value give two of l1, l3, l4"
        )
    elif task.free:
        yield N_(
            "two pairs of angles leave l4/l1 free: the value between 0.1 and 10 with the best transmission "
            "angle was taken; for another value give two of l1, l3, l4"
        )


def _tabulate_solutions(task: AnglePairsTask, four_bars: FourBarRatios, at: int) -> Listing:
    """Tabulate all solutions, with the numbers by which the file can choose them."""
    mean = (("error", MEAN, "angle"),) if task.approximate else ()
    columns = (
        ("number_of", N_("choose"), "name"),
        ("taken", N_("taken"), "word"),
        *mean,
        *COLUMNS,
        ("crank", N_("input link rotates fully"), "word"),
        ("defect", N_("defects"), "word"),
    )
    rows = []
    for k in range(four_bars.size):
        rating = rate_four_bars(four_bars.at(k), task)
        taken, crank = N_("yes") if k == at else None, N_("yes") if rating.crank else N_("no")
        rows.append(
            (
                str(k + 1),
                taken,
                *([_compute_mean_error(four_bars.at(k), task)] if task.approximate else []),
                *_make_solution_row(task, four_bars.at(k), rating),
                crank,
                SHORT_DEFECTS[str(rating.defect)],
            )
        )
    return Listing(
        "solutions", N_("Solutions. To take another one, write choose: and its number"), columns, tuple(rows)
    )


def _tabulate_pairs(task: AnglePairsTask, four_bar: FourBarRatios) -> Listing:
    """Tabulate the pairs of angles and the errors of the output angle."""
    columns = (
        ("phi", N_("input angle"), "angle"),
        ("psi", N_("required output angle"), "angle"),
        ("reached", N_("reached"), "angle"),
        ("error", N_("error"), "angle"),
    )
    error = output_errors(four_bar, task)
    rows = [(float(a), float(b), float(b + e), float(e)) for a, b, e in zip(task.phi, task.psi, error, strict=True)]
    return Listing(
        "pairs", N_("Pairs of angles, and errors of the output angle"), columns, tuple(rows), long=len(rows) > SHOWN
    )


def _tabulate_family(task: AnglePairsTask) -> Listing:
    """Tabulate the four-bars that pass through two pairs, over the free ratio l4/l1."""
    columns = (
        ("free", N_("ratio l4/l1 (free with two pairs of angles)"), "number"),
        *COLUMNS,
        ("defect", N_("defects"), "word"),
    )
    ratios = np.geomspace(1 / LONGEST, LONGEST, FAMILY)
    ratios = np.concatenate([ratios, -ratios])
    four_bars = four_bars_of_ratios(task, ratios)
    rows = []
    for k in np.flatnonzero(are_real(four_bars)):
        rating = rate_four_bars(four_bars.at(k), task)
        rows.append(
            (
                abs(float(ratios[k])),
                *_make_solution_row(task, four_bars.at(k), rating),
                SHORT_DEFECTS[str(rating.defect)],
            )
        )
    return Listing("family", N_("Four-bars through both pairs of angles"), columns, tuple(rows), long=True)


def _make_solution_row(task: AnglePairsTask, solution: FourBarRatios, rating: FourBarQuality) -> tuple[float, ...]:
    """Return the link lengths (m), the zero angles (rad) and the smallest transmission angle (rad) of a four-bar."""
    frame_length = _compute_frame_length(task, solution)
    return (
        *(float(x * frame_length) for x in solution[:3]),
        float(frame_length),
        float(solution.phi0),
        float(solution.psi0),
        float(rating.least),
    )


def _list_given_values(task: AnglePairsTask) -> tuple[NamedValue, ...]:
    values = [NamedValue(name, value, *LENGTHS[name]) for name, value in task.lengths.items()]
    if task.function:
        text = task.function.name.replace("x^1.5", "x^(3/2)") or N_("table with linear interpolation")
        of_x = "angle" if task.function.name in ANGLES else "number"
        (x0, x1), (phi0, phi1), (psi0, psi1) = task.function.x, task.function.phi, task.function.psi
        values += [
            NamedValue("", text, "word", N_("function y(x)")),
            NamedValue("", x0, of_x, N_("x at the start of the range")),
            NamedValue("", x1, of_x, N_("x at the end of the range")),
            NamedValue("", phi0, "angle", N_("input angle at the start of the range")),
            NamedValue("", phi1, "angle", N_("input angle at the end of the range")),
            NamedValue("", psi0, "angle", N_("output angle at the start of the range")),
            NamedValue("", psi1, "angle", N_("output angle at the end of the range")),
        ]
    for k, (a, b) in enumerate(zip(task.phi, task.psi, strict=True) if not task.approximate else ()):
        name = Phrase("input angle {number}", number=k + 1)
        values += [NamedValue("", a, "angle", name), NamedValue("", b, "angle", _describe_output(k))]
    limits = {name: kind for name, kind in LIMITS.items() if name == "transmission" or task.approximate}
    return *values, *given_values(task, ZEROS | limits)
