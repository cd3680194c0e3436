"""Reading a problem file, and printing a summary of it before anything is computed."""

from __future__ import annotations

from collections.abc import Sequence

from tmm_cli.cli.talk import say, use_file_language, use_file_notation, warn
from tmm_cli.language import ENGLISH, _
from tmm_cli.problem import (
    Problem,
    ProblemError,
    TaskProblem,
    Tree,
    apply_settings,
    build_any_problem,
    decode_text,
    find_language,
    read_bytes,
    read_text,
    refuse_options,
)
from tmm_cli.reports import describe_units, find_slips, summarise_file


def read_tree(file: str, settings: Sequence[str] | None = None) -> Tree:
    """Read a file, apply the settings of the command line, and switch to the language of the file.

    Args:
        file: name of the problem file.
        settings: texts such as `OA=120`, each of which sets a parameter.

    Raises:
        ProblemError: the file or a setting is wrong.
    """
    return apply_settings(read_in_file_language(file), settings or ())


def read_in_file_language(file: str) -> Tree:
    """Read a file and switch the messages to its language, even if the file has errors. Raises ProblemError."""
    data = read_bytes(file)
    use_file_language(find_language(data))
    tree = read_text(decode_text(data, file), file)
    use_file_language(tree.data.get("lang", ENGLISH))
    use_file_notation(tree.data)
    return tree


def open_problem(
    file: str, settings: Sequence[str] | None = None, positions: Sequence[int] | None = None, digits: bool = False
) -> Problem | TaskProblem:
    """Read a problem file, apply the settings of the command line, and print a summary of the file.

    Args:
        file: name of the problem file.
        settings: texts such as `OA=120`, each of which sets a parameter.
        positions: numbers of the requested positions; None for all.
        digits: True if error bounds are requested; this work is then checked against the limit.

    Raises:
        ProblemError: the file or a setting is wrong, or the requested work exceeds the limit.
    """
    problem = build_any_problem(read_tree(file, settings))
    print_file_summary(problem)
    if digits:
        refuse_excess_work(problem.whole, positions, digits=True)
    return problem


def variant_settings(file: str, variants: str | None, variant: str | None, settings: Sequence[str] | None) -> list[str]:
    """Return the parameter values of one variant from a table, followed by the settings of the command line.

    Args:
        file: name of the problem file.
        variants: name of the table of variants, or None.
        variant: number of the variant or name of the student, or None.
        settings: settings of the command line, such as `OA=120`.

    Raises:
        ProblemError: only one of table and variant is given, or the table has no such variant.
    """
    own_settings = list(settings or ())
    if variants is None and variant is None:
        return own_settings
    if variants is None or variant is None:
        raise ProblemError(
            _("specify both the table of variants and the variant"), allowed="--variants FILE --variant 7"
        )
    from tmm_cli.batch import read_task
    from tmm_cli.grading import find_variant, read_table  # imported late: few runs use a table

    try:
        values = find_variant(read_table(variants, read_task(read_tree(file))), variant)
    except ProblemError as error:
        raise (error if error.file else error.located(variants)) from None
    return [*(f"{name}={text}" for name, text in values.items()), *own_settings]


def refuse_excess_work(
    problem: Problem,
    positions: Sequence[int] | None,
    *,
    digits: bool = False,
    detail: int | None = None,
    large: bool = False,
    plans: int = 0,
    centres: int = 0,
) -> None:
    """Refuse work that exceeds the limit, before it starts.

    The arguments are those of `tmm_cli.problem.work_limits.refuse_options`.

    Raises:
        ProblemError: the work exceeds the limit.
    """
    request = problem.request
    count = len(positions or request.places) or request.count
    try:
        refuse_options(problem.linkage, count, digits=digits, detail=detail, large=large, plans=plans, centres=centres)
    except ProblemError as error:
        raise error.located(problem.file) from None


def count_detailed_positions(problem: Problem) -> int:
    """Return the number of detailed positions: those that the file requests, or 1 if it requests none."""
    return len(problem.request.detail) or 1


def print_file_summary(problem: Problem | TaskProblem, *, drafted: bool = False) -> None:
    """Print how the file was understood, and warn of probable mistakes in it.

    Args:
        problem: problem of the file.
        drafted: if the file has a synthesis task, print only the units and do not solve the task.
    """
    if drafted and isinstance(problem, TaskProblem):
        say(f"{problem.name}: {describe_units(problem.units)}")
        return
    for sentence in summarise_file(problem):
        say(f"{problem.name}: {sentence}")
    for doubt in find_slips(problem.whole):
        warn(f"{problem.name}: {doubt}")
