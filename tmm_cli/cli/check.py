"""Command `tmm check`: compute problems again and compare the results with those of an earlier version."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple
from xml.etree import ElementTree

import typer

from tmm_cli import __version__
from tmm_cli.cli.common import console, problems_in, reporting_errors, with_progress
from tmm_cli.cli.reporting import compute_file
from tmm_cli.cli.talk import BAD_INPUT, CHECK_FAILED, OK, printable, say
from tmm_cli.grading import grade_example
from tmm_cli.language import _
from tmm_cli.problem import ProblemError, UnitSystem
from tmm_cli.reports import (
    ResultDifference,
    brief_value,
    difference_table,
    find_differences,
    golden_part,
    golden_record,
    json_bytes,
    new_quantities,
    print_on_terminal,
    to_json,
    write_atomically,
)

TOLERANCE = 1e-7  # of golden runs with 8 digits


class CheckOutcome(NamedTuple):
    """Outcome of the check of one problem.

    Attributes:
        name: name of the problem.
        wrong: error message if the problem could not be checked; empty otherwise.
        different: quantities that differ from their expected values.
        new: quantities that have no expected value; they are not compared.
        code: exit code for this problem.
    """

    name: str
    wrong: str = ""
    different: Sequence[ResultDifference] = ()
    new: Sequence[str] = ()
    code: int = OK


def check_problem(file: Path, update: bool) -> CheckOutcome:
    """Compute a problem again and compare it with its expected values; with `update`, replace the expected values."""
    expected_file = file.parent / "expected" / f"{file.stem}.json"
    return _check_expected(
        file.stem, expected_file, lambda: to_json(compute_file(str(file), "forces", silent=True)), update
    )


def check_grades(task: Path, update: bool) -> CheckOutcome:
    """Grade an example again and compare the marks with expected.json beside its task file."""
    return _check_expected(
        f"grading/{task.parent.name}", task.parent / "expected.json", lambda: grade_example(task), update
    )


def _check_expected(
    name: str, expected_file: Path, compute: Callable[[], dict[str, Any]], update: bool
) -> CheckOutcome:
    try:
        computed = compute()
    except ProblemError as error:
        return CheckOutcome(name, wrong=str(error), code=BAD_INPUT)
    expected = _read_expected(expected_file)
    recorded = isinstance(expected, dict)
    if update:
        if not recorded or expected["result"] != golden_record(computed):
            golden = {
                "golden_run": f"computed by tmm {__version__} itself, to 8 digits; no reference from elsewhere",
                "tolerance": expected["tolerance"] if recorded else TOLERANCE,
                "result": golden_record(computed),
            }
            try:
                write_atomically(expected_file, json_bytes(golden))
            except OSError as error:
                wrong = f"{error.filename}: {error.strerror}"
                return CheckOutcome(name, wrong=wrong, code=BAD_INPUT)
        return CheckOutcome(name)
    if not recorded:
        return CheckOutcome(name, wrong=f"{expected_file}: {expected}", code=CHECK_FAILED)
    record, compared = expected["result"], golden_part(computed)
    different = find_differences(record, compared, float(expected["tolerance"]))
    new = new_quantities(record, compared)
    return CheckOutcome(name, different=different, new=new, code=CHECK_FAILED if different else OK)


def _read_expected(file: Path) -> Any:
    """Read a file of expected values; return an error message if this fails."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        float(content["tolerance"])
        content["result"].items()
    except FileNotFoundError:
        return _("there are no expected values yet; run `tmm check --update` to write them")
    except RecursionError:
        return _("this is not a file of expected values (its brackets are nested too deeply)")
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        return _("this is not a file of expected values ({error})").format(error=error)
    return content


def show_outcomes(outcomes: Sequence[CheckOutcome]) -> None:
    """Print the differences as a table, and the error messages of problems that could not be checked."""
    table = difference_table({outcome.name: outcome.different for outcome in outcomes})
    if table.rows:
        print_on_terminal(table, UnitSystem(), console(), more=_("... further rows: {rows}"))
    for outcome in outcomes:
        if outcome.new:
            told = _(
                "note: {name}: new quantities, not compared: {count}, e.g. {example}; `tmm check --update` records them"
            )
            say(told.format(name=printable(outcome.name), count=len(outcome.new), example=outcome.new[0]))
        if outcome.wrong:
            say(_("error: {name}: {wrong}").format(name=printable(outcome.name), wrong=outcome.wrong))


def write_junit(path: Path, outcomes: Sequence[CheckOutcome]) -> None:
    """Write the outcomes as a report in JUnit XML."""
    failures = sum(bool(outcome.different) for outcome in outcomes)
    errors = sum(bool(outcome.wrong) for outcome in outcomes)
    suite = ElementTree.Element(
        "testsuite", name="tmm check", tests=str(len(outcomes)), failures=str(failures), errors=str(errors)
    )
    for name, wrong, different, *__ in outcomes:
        case = ElementTree.SubElement(suite, "testcase", classname="problems", name=name)
        if wrong:
            ElementTree.SubElement(case, "error", message=wrong)
        elif different:
            failure = ElementTree.SubElement(case, "failure", message=f"{len(different)} quantities differ")
            failure.text = "\n".join(
                f"{d.quantity}: expected {brief_value(d.expected)}, found {brief_value(d.found)}"
                for d in different[:50]
            )
    write_atomically(path, ElementTree.tostring(suite, encoding="utf-8", xml_declaration=True))


# `tmm check`.


GRADED_EXAMPLES = ("variants.csv", "*/variants.csv", "grading/*/variants.csv")  # beside the task of a graded example


def check(
    paths: Annotated[
        list[Path], typer.Argument(metavar="DIR|FILE...", help="Problem files, or folders of them.", show_default=False)
    ],
    update: Annotated[bool, typer.Option("--update", help="Write the expected values anew.")] = False,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Also write a JUnit report.", show_default=False)
    ] = None,
) -> None:
    """Compute every problem again and compare it with expected/<problem>.json beside it.

    Folders are searched with their subfolders. Examples of grading are graded again. Expected values are results of an
    earlier version, to 8 digits. The difference of a quantity in result.json is divided by its largest value in the
    cycle; the tolerance is stored in the file of expected values. Quantities without an expected value are reported as
    new. Exit code 1 if something differs.
    """
    tables = [
        table for path in paths if path.is_dir() for depth in GRADED_EXAMPLES for table in sorted(path.glob(depth))
    ]
    tasks = [table.with_name("task.yaml") for table in tables if table.with_name("task.yaml").is_file()]
    files = [*(f for f in problems_in(paths, tasks) if f not in tasks), *tasks]
    outcomes = [
        check_grades(Path(name), update) if Path(name) in tasks else check_problem(Path(name), update)
        for name in with_progress([str(f) for f in files])
    ]
    show_outcomes(outcomes)
    if junit is not None:
        with reporting_errors():
            write_junit(junit, outcomes)
    differing = sum(bool(outcome.wrong or outcome.different) for outcome in outcomes)
    say(_("problems: {count}, of which with differences: {differing}").format(count=len(outcomes), differing=differing))
    raise typer.Exit(max(outcome.code for outcome in outcomes))
