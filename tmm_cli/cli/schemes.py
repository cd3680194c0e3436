"""Command `tmm schemes`: enumerates schemes and kinematic chains, and writes problem files of schemes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import Json, console, draw_pictures, emit_json, reporting_errors, with_progress
from tmm_cli.cli.talk import printable, say
from tmm_cli.language import _
from tmm_cli.problem import ProblemError, UnitSystem, build_problem, read_text, unknown_name_error
from tmm_cli.reports import (
    MORE_ROWS_AS_JSON,
    StagedFolder,
    WrittenSchemes,
    chains_json,
    chains_table,
    collect_warnings,
    print_on_terminal,
    schemes_json,
    schemes_table,
    write_atomically,
)
from tmm_cli.synthesis import (
    GROUP_CLASSES,
    GROUP_TYPES,
    MOST_CRANKS,
    MOST_LINKS_OF_CHAIN as MOST_CHAIN_LINKS,
    MOST_LINKS_OF_SCHEME,
    MOST_SCHEMES,
    KinematicChain,
    Scheme,
    TooManySchemes,
    enumerate_chains,
    enumerate_schemes as all_schemes,
    find_layouts,
    problem_text,
    solve,
)

CANDIDATES = 24  # largest number of layouts to solve before the best is chosen
FEW_CANDIDATES = 6  # the same for schemes with groups that have no closed-form solution
MOST_FILES = 300  # each takes a few tenths of a second


@dataclass(frozen=True)
class SchemeFile:
    """Problem file of a scheme.

    Attributes:
        text: text of the file.
        solved: True if the problem was solved with forces; False if only its structure was analysed.
        warnings: number of warnings of the solution.
    """

    text: str
    solved: bool
    warnings: int

    @property
    def badness(self) -> tuple[bool, int]:
        return not self.solved, self.warnings


def make_scheme_file(scheme: Scheme, title: str) -> SchemeFile | None:
    """Make a problem file for a scheme, in memory.

    The first layout whose solution has no warnings is used, otherwise the one with the fewest warnings.

    Args:
        scheme: scheme of a mechanism.
        title: title of the problem.

    Returns:
        The file, or None if the mechanism cannot be assembled with any layout.
    """
    closed = all(group.type.grade == 2 for group in scheme.groups)
    best: SchemeFile | None = None
    for layout in find_layouts(scheme)[: CANDIDATES if closed else FEW_CANDIDATES]:
        candidate = _try_layout(problem_text(scheme, layout, title), scheme, closed)
        if candidate is not None and (best is None or candidate.badness < best.badness):
            best = candidate
        if best is not None and best.badness == (False, 0):
            break
    return best


def _try_layout(text: str, scheme: Scheme, closed: bool) -> SchemeFile | None:
    """Solve a problem including its forces, and return its problem file; None if it cannot be solved.

    If the assembly of a group without a closed-form solution is not found, only the structure is analysed.
    """
    problem = build_problem(read_text(text, scheme.name))
    try:
        results = solve(problem)
    except ProblemError:
        if closed:
            return None
        solve(problem, "structure")
        return SchemeFile(text, False, 0)
    return SchemeFile(text, True, sum(1 for __ in collect_warnings(results))) if results.lever_holds else None


def write_scheme_files(schemes: Sequence[Scheme], folder: Path, tracked_schemes: Iterable[Scheme]) -> WrittenSchemes:
    """Write one problem file per scheme into a folder.

    Nothing is written until all files are ready, and no existing file with other contents is replaced.

    Args:
        schemes: the schemes.
        folder: output folder.
        tracked_schemes: iterator over the same schemes that shows a progress bar.

    Returns:
        For each scheme its path and whether it was solved with forces; None if it cannot be assembled.

    Raises:
        ProblemError: there are too many schemes, or a file with other contents exists.
    """
    if len(schemes) > MOST_FILES:
        raise ProblemError(
            _("too many files"),
            path=("--out",),
            found=_("{count} schemes").format(count=len(schemes)),
            allowed=_("at most {most}; choose fewer links or fewer types of groups (--groups)").format(most=MOST_FILES),
        )
    digits = max(2, len(str(len(schemes))))
    texts: dict[Path, str] = {}
    written: list[tuple[Path, bool] | None] = []
    for number, scheme in enumerate(tracked_schemes, 1):
        scheme_file = make_scheme_file(
            scheme, _("Scheme {number}, {formula}").format(number=number, formula=scheme.formula)
        )
        path = folder / f"scheme-{number:0{digits}d}-{scheme.name}.yaml"
        written.append(None if scheme_file is None else (path, scheme_file.solved))
        if scheme_file is not None:
            texts[path] = scheme_file.text
    for path, text in texts.items():
        if path.exists() and path.read_bytes() != text.encode():
            raise ProblemError(
                _("a different file of this name exists, perhaps with your own changes"),
                path=("--out",),
                found=str(path),
                allowed=_("another folder"),
            )
    for path, text in texts.items():
        write_atomically(path, text.encode())
    return written


def read_group_types(text: str) -> tuple[str, ...]:
    """Read a comma-separated list of types and classes of Assur groups, such as `RRR,RRP` or `II,III`.

    Returns:
        Types of groups; a class stands for all its types.

    Raises:
        ProblemError: a name is unknown.
    """
    types: list[str] = []
    for word in text.split(","):
        name = word.strip().upper()
        if name not in GROUP_TYPES and name not in GROUP_CLASSES:
            allowed = [*GROUP_CLASSES, *(name for name in GROUP_TYPES if name not in GROUP_CLASSES)]
            raise unknown_name_error(word.strip(), allowed, _("no such group"), path=("--groups",))
        types += GROUP_CLASSES.get(name, (name,))
    return tuple(dict.fromkeys(types))


def find_schemes(links: int, mobility: int, types: tuple[str, ...]) -> tuple[Scheme, ...]:
    """Enumerate the schemes with a given number of links, mobility and types of groups.

    Raises:
        ProblemError: no scheme can have this number of links or this mobility, or there are too many schemes.
    """
    _refuse_numbers(links, "--links", mobility, MOST_CRANKS, range(mobility + 2, MOST_LINKS_OF_SCHEME + 1, 2))
    try:
        return all_schemes(links, mobility, types)
    except TooManySchemes:
        raise ProblemError(
            _("there are too many schemes: more than {most}").format(most=MOST_SCHEMES),
            path=("--links",),
            found=str(links),
            allowed=_("fewer links, or fewer types of groups (--groups)"),
        ) from None


def find_chains(links: int, mobility: int) -> tuple[KinematicChain, ...]:
    """Enumerate the kinematic chains with a given number of links and mobility.

    Raises:
        ProblemError: no chain can have this number of links or this mobility.
    """
    _refuse_numbers(links, "--chains", mobility, MOST_CHAIN_LINKS - 3, range(mobility + 3, MOST_CHAIN_LINKS + 1, 2))
    return enumerate_chains(links, mobility)


def _refuse_numbers(links: int, option: str, mobility: int, most: int, allowed: range) -> None:
    """Refuse a mobility that is not supported, and a number of links that is impossible for this mobility."""
    if not 1 <= mobility <= most:
        raise ProblemError(
            _("structures of this mobility are not supported"),
            path=("--mobility",),
            found=str(mobility),
            allowed=_("1 to {most}").format(most=most),
        )
    if links not in allowed:
        raise ProblemError(
            _("there is no structure of mobility {mobility} with this number of links").format(mobility=mobility),
            path=(option,),
            found=str(links),
            allowed=_("for W = {mobility} the number of links can be: {links}").format(
                mobility=mobility, links=", ".join(map(str, allowed))
            ),
        )


# `tmm schemes`.


DEFAULT_GROUPS = "II"


def schemes(
    links: Annotated[
        int | None, typer.Option("--links", "-n", help="Number of moving links of the schemes.", show_default=False)
    ] = None,
    chains: Annotated[
        int | None,
        typer.Option("--chains", help="Enumerate kinematic chains with this number of links.", show_default=False),
    ] = None,
    mobility: Annotated[int, typer.Option("--mobility", "-W", help="Mobility: number of driving cranks.")] = 1,
    groups: Annotated[
        str, typer.Option("--groups", metavar="LIST", help="Assur groups: RRR, RRP, RPR, PRP, RPP; or II, III, IV.")
    ] = DEFAULT_GROUPS,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write one problem file per scheme to this folder.", show_default=False
        ),
    ] = None,
    table: Annotated[
        bool, typer.Option("--table", help="Draw the table of Assur groups of classes II to VI by order.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Enumerate all schemes of mechanisms that consist of Assur groups, or all kinematic chains (number synthesis)."""
    written = None
    with reporting_errors(as_json, str(out or "")):
        if table and (links, chains) == (None, None):
            with StagedFolder(out or Path("outputs") / "assur-groups") as staged:
                for name, picture in draw_pictures("group-table"):
                    staged.write(name, (picture,))
            say(_("written: {folder}").format(folder=printable(staged.folder)))
        elif links is not None and chains is None:
            types = read_group_types(groups)
            enumerated = find_schemes(links, mobility, types)
            written = None if out is None else write_scheme_files(enumerated, out, with_progress(enumerated))
            if as_json:
                emit_json(schemes_json(enumerated, links, mobility, written, types))
            else:
                rows = schemes_table(enumerated, links, mobility, written, types)
                print_on_terminal(rows, UnitSystem(), console(), more=MORE_ROWS_AS_JSON)
        elif chains is not None and links is None:
            if out is not None:
                raise ProblemError(
                    _("no problem files can be written for kinematic chains"),
                    path=("--out",),
                    allowed="--links N, --json",
                )
            all_chains = find_chains(chains, mobility)
            if as_json:
                emit_json(chains_json(all_chains, chains, mobility))
            else:
                print_on_terminal(
                    chains_table(all_chains, chains, mobility), UnitSystem(), console(), more=MORE_ROWS_AS_JSON
                )
        else:
            alternatives = _(
                "--links N for schemes, --chains N for kinematic chains, or --table for the table of groups"
            )
            raise ProblemError(
                _("request exactly one of these: schemes, kinematic chains, or the table of groups"),
                allowed=alternatives,
            )
    if out is not None and written:
        count = sum(x is not None for x in written)
        say(_("files written to {out}: {count}; next step: tmm run {out}/FILE").format(count=count, out=printable(out)))
