"""`tmm check`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from tmm_cli import __version__
from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, _progress, console, say
from tmm_cli.errors import _

if TYPE_CHECKING:
    from tmm_cli.results.compare import Difference

TOLERANCE = 1e-9


class Outcome(NamedTuple):
    """A problem, what is wrong with it as a whole, what differs, and the exit code of that."""

    name: str
    wrong: str = ""
    different: Sequence[Difference] = ()
    code: int = OK


def check(
    paths: Annotated[list[Path], typer.Argument(metavar="DIR|FILE...", help="A bank of problems.", show_default=False)],
    update: Annotated[bool, typer.Option("--update", help="Rewrite the expected values.")] = False,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Write a JUnit report too.", show_default=False)
    ] = None,
) -> None:
    """Compute every problem again and compare it with expected/<problem>.json beside it.

    What is expected is a golden run: what an earlier version computed. Every quantity of result.json is compared,
    relative to its largest value in the cycle; the tolerance is in the expected file. Exit code 1 when something
    differs.
    """
    files = [f for path in paths for f in (sorted(path.glob("*.yaml")) if path.is_dir() else [path])]
    if not files:
        folders = ", ".join(map(str, paths))
        say(_("error: no problems (*.yaml) in {folders}").format(folders=folders))
        raise typer.Exit(BAD_INPUT)
    outcomes = [_one(Path(name), update) for name in _progress([str(f) for f in files])]
    _show(outcomes)
    if junit is not None:
        from tmm_cli.results.files import write_whole

        write_whole(junit, _junit(outcomes))
    differing = sum(bool(outcome.wrong or outcome.different) for outcome in outcomes)
    say(_("{count} problems, {differing} differ").format(count=len(outcomes), differing=differing))
    raise typer.Exit(max(outcome.code for outcome in outcomes))


def _one(file: Path, update: bool) -> Outcome:
    from tmm_cli.cli.chains import solved_any
    from tmm_cli.problem.errors import ProblemError
    from tmm_cli.results.as_json import to_json
    from tmm_cli.results.compare import differences, recorded
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import json_bytes

    expected_file = file.parent / "expected" / f"{file.stem}.json"
    try:
        found = to_json(solved_any(str(file), "forces", None))
    except ProblemError as error:
        return Outcome(file.stem, wrong=str(error), code=BAD_INPUT)
    expected = _read(expected_file)
    known = isinstance(expected, dict)
    if update:
        if not known or expected["result"] != recorded(found):
            golden = {
                "golden_run": f"computed by tmm {__version__} itself, to 12 digits; no reference from elsewhere",
                "tolerance": expected["tolerance"] if known else TOLERANCE,
                "result": recorded(found),
            }
            write_whole(expected_file, json_bytes(golden))
        return Outcome(file.stem)
    if not known:
        return Outcome(file.stem, wrong=f"{expected_file}: {expected}", code=CHECK_FAILED)
    different = differences(expected["result"], found, float(expected["tolerance"]))
    return Outcome(file.stem, different=different, code=CHECK_FAILED if different else OK)


def _read(file: Path) -> Any:
    """The expected values, or what is wrong with them."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        float(content["tolerance"])
        content["result"].items()
    except FileNotFoundError:
        return _("there are no expected values; tmm check --update writes them")
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        return _("this is not a file of expected values ({error})").format(error=error)
    return content


def _show(outcomes: Sequence[Outcome]) -> None:
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.compare import difference_table
    from tmm_cli.results.terminal import show

    table = difference_table({outcome.name: outcome.different for outcome in outcomes})
    if table.rows:
        show(table, UnitSystem(), console(), more=_("... and {rows} rows more"))
    for outcome in outcomes:
        if outcome.wrong:
            say(_("error: {name}: {wrong}").format(name=outcome.name, wrong=outcome.wrong))


def _junit(outcomes: Sequence[Outcome]) -> bytes:
    from xml.etree import ElementTree

    from tmm_cli.results.compare import brief

    failures = sum(bool(outcome.different) for outcome in outcomes)
    errors = sum(bool(outcome.wrong) for outcome in outcomes)
    suite = ElementTree.Element(
        "testsuite", name="tmm check", tests=str(len(outcomes)), failures=str(failures), errors=str(errors)
    )
    for name, wrong, different, __ in outcomes:
        case = ElementTree.SubElement(suite, "testcase", classname="problems", name=name)
        if wrong:
            ElementTree.SubElement(case, "error", message=wrong)
        elif different:
            failure = ElementTree.SubElement(case, "failure", message=f"{len(different)} quantities differ")
            failure.text = "\n".join(
                f"{d.quantity}: expected {brief(d.expected)}, found {brief(d.found)}" for d in different[:50]
            )
    xml: bytes = ElementTree.tostring(suite, encoding="utf-8", xml_declaration=True)
    return xml
