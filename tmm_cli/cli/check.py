"""`tmm check`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tmm_cli.cli.common import BAD_INPUT, CHECK_FAILED, OK, _progress, console, say

if TYPE_CHECKING:
    from tmm_cli.results.compare import Difference

TOLERANCE = 1e-9
Outcome = tuple[str, str, "list[Difference]"]  # problem, what is wrong as a whole, what differs


def check(
    paths: Annotated[list[Path], typer.Argument(metavar="DIR|FILE...", help="A bank of problems.", show_default=False)],
    update: Annotated[bool, typer.Option("--update", help="Rewrite the expected values.")] = False,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Write a JUnit report too.", show_default=False)
    ] = None,
) -> None:
    """Compute every problem again and compare it with expected/<problem>.json beside it.

    Every quantity of result.json is compared, relative to its largest value in the cycle; the tolerance is in the
    expected file. Exit code 1 when something differs.
    """
    files = [f for path in paths for f in (sorted(path.glob("*.yaml")) if path.is_dir() else [path])]
    if not files:
        say(f"error: no problems (*.yaml) in {', '.join(map(str, paths))}")
        raise typer.Exit(BAD_INPUT)
    outcomes, worst = [], OK
    for name in _progress([str(f) for f in files]):
        code, outcome = _one(Path(name), update)
        outcomes.append(outcome)
        worst = max(worst, code)
    _show(outcomes)
    if junit is not None:
        from tmm_cli.results.files import write_whole

        write_whole(junit, _junit(outcomes))
    say(f"{len(outcomes)} problems, {sum(bool(o[1] or o[2]) for o in outcomes)} differ")
    raise typer.Exit(worst)


def _one(file: Path, update: bool) -> tuple[int, Outcome]:
    from tmm_cli.cli.chains import solved_any
    from tmm_cli.problem.errors import ProblemError
    from tmm_cli.results.as_json import to_json
    from tmm_cli.results.compare import IGNORED, differences
    from tmm_cli.results.files import write_whole
    from tmm_cli.results.text import json_bytes

    expected_file = file.parent / "expected" / f"{file.stem}.json"
    try:
        computed = to_json(solved_any(str(file), "forces", None))
        found = {key: part for key, part in computed.items() if key not in IGNORED}
    except ProblemError as error:
        return BAD_INPUT, (file.stem, str(error), [])
    expected = _read(expected_file)
    if update:
        tolerance = expected.get("tolerance", TOLERANCE) if isinstance(expected, dict) else TOLERANCE
        if not isinstance(expected, dict) or differences(expected["result"], found, 0.0):
            write_whole(expected_file, json_bytes({"tolerance": tolerance, "result": found}))
        return OK, (file.stem, "", [])
    if not isinstance(expected, dict):
        return CHECK_FAILED, (file.stem, f"{expected_file}: {expected}", [])
    found = json.loads(json.dumps(found))
    different = differences(expected["result"], found, float(expected["tolerance"]))
    return (CHECK_FAILED if different else OK), (file.stem, "", different)


def _read(file: Path) -> Any:
    """The expected values, or what is wrong with them."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        float(content["tolerance"])
        content["result"].items()
    except FileNotFoundError:
        return "there are no expected values; tmm check --update writes them"
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        return f"this is not a file of expected values ({error})"
    return content


def _show(outcomes: list[Outcome]) -> None:
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.table import Column, Table
    from tmm_cli.results.terminal import show
    from tmm_cli.words import say as word

    rows = [
        (name, d.quantity, "" if d.position is None else str(d.position), _brief(d.expected), _brief(d.found),
         "" if d.size is None else f"{d.size:.2g}")
        for name, _, different in outcomes for d in different
    ]  # fmt: skip
    if rows:
        keys = ("check.problem", "check.quantity", "word.position", "check.expected", "check.found", "check.relative")
        columns = tuple(Column(word(key), [row[k] for row in rows]) for k, key in enumerate(keys))
        show(Table("check", word("check.title"), columns), UnitSystem(), console(), more="table.more_only")
    for name, wrong, _ in outcomes:
        if wrong:
            say(f"error: {name}: {wrong}")


def _brief(value: Any) -> str:
    return f"{value:.15g}" if isinstance(value, float) else str(value)[:60]


def _junit(outcomes: list[Outcome]) -> bytes:
    from xml.etree import ElementTree

    failures = sum(bool(different) for _, _, different in outcomes)
    errors = sum(bool(wrong) for _, wrong, _ in outcomes)
    suite = ElementTree.Element(
        "testsuite", name="tmm check", tests=str(len(outcomes)), failures=str(failures), errors=str(errors)
    )
    for name, wrong, different in outcomes:
        case = ElementTree.SubElement(suite, "testcase", classname="problems", name=name)
        if wrong:
            ElementTree.SubElement(case, "error", message=wrong)
        elif different:
            failure = ElementTree.SubElement(case, "failure", message=f"{len(different)} quantities differ")
            failure.text = "\n".join(
                f"{d.quantity}: expected {_brief(d.expected)}, found {_brief(d.found)}" for d in different[:50]
            )
    xml: bytes = ElementTree.tostring(suite, encoding="utf-8", xml_declaration=True)
    return xml
