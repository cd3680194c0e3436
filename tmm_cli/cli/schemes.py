"""`tmm schemes`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tmm_cli.cli.common import Json, _progress, console, emit_json, refusing, say
from tmm_cli.errors import _

if TYPE_CHECKING:
    from tmm_cli.results.table import Table
    from tmm_cli.schemes.chains import KinematicChain
    from tmm_cli.schemes.schemes import Scheme

DEFAULT_GROUPS = "II"


def schemes(
    links: Annotated[
        int | None, typer.Option("--links", "-n", help="Schemes with so many moving links.", show_default=False)
    ] = None,
    chains: Annotated[
        int | None, typer.Option("--chains", help="Instead: kinematic chains of so many links.", show_default=False)
    ] = None,
    mobility: Annotated[int, typer.Option("--mobility", "-W", help="Mobility: the number of driving cranks.")] = 1,
    groups: Annotated[
        str, typer.Option("--groups", metavar="LIST", help="Assur groups: RRR, RRP, RPR, PRP, RPP; or II, III, IV.")
    ] = DEFAULT_GROUPS,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="DIR", help="Write a problem file a scheme there.", show_default=False),
    ] = None,
    as_json: Json = False,
) -> None:
    """Structural synthesis: all schemes built of Assur groups, or the number of kinematic chains."""
    from tmm_cli.problem.errors import ProblemError

    with refusing(as_json, str(out or "")):
        if (links is None) == (chains is None):
            raise ProblemError(
                _("what is wanted?"), allowed=_("--links N for schemes, or --chains N for kinematic chains")
            )
        if chains is not None and out is not None:
            raise ProblemError(_("kinematic chains have no files"), path=("--out",), allowed="--links N, --json")
        if chains is not None:
            _chains(chains, mobility, as_json)
        elif links is not None:
            _schemes(links, mobility, groups, out, as_json)


def _chains(links: int, mobility: int, as_json: bool) -> None:
    from tmm_cli.results.schemes import chains_json, chains_table

    found = wanted_chains(links, mobility)
    if as_json:
        emit_json(chains_json(found, links, mobility))
    else:
        _show(chains_table(found, links, mobility))


def _schemes(links: int, mobility: int, groups: str, out: Path | None, as_json: bool) -> None:
    from tmm_cli.results.schemes import schemes_json, schemes_table

    found = wanted_schemes(links, mobility, named_types(groups))
    written = None
    if out is not None:
        from tmm_cli.cli.scheme_files import write_skeletons

        written = write_skeletons(found, out, _progress(found))
    if as_json:
        emit_json(schemes_json(found, links, mobility, written))
    else:
        _show(schemes_table(found, links, mobility, written))
    if out is not None and written:
        count = sum(x is not None for x in written)
        say(_("written: {count} files in {out}; next: tmm run {out}/FILE").format(count=count, out=out))


def _show(table: Table) -> None:
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.terminal import MORE_ROWS_AS_JSON, show

    show(table, UnitSystem(), console(), more=MORE_ROWS_AS_JSON)


def named_types(text: str) -> tuple[str, ...]:
    """Types of groups from a list of types and classes, `RRR,RRP` or `II,III`. Raises ProblemError."""
    from tmm_cli.problem.errors import ProblemError, nearest, quote
    from tmm_cli.schemes.schemes import CLASSES, TYPES

    found: list[str] = []
    for word in text.split(","):
        name = word.strip().upper()
        if name not in TYPES and name not in CLASSES:
            known = [*CLASSES, *(name for name in TYPES if name not in CLASSES)]
            raise ProblemError(
                _("there is no such group"), path=("--groups",), found=quote(word.strip()), allowed=", ".join(known),
                near=nearest(name, known),
            )  # fmt: skip
        found += CLASSES.get(name, (name,))
    return tuple(dict.fromkeys(found))


def wanted_schemes(links: int, mobility: int, types: tuple[str, ...]) -> tuple[Scheme, ...]:
    """The schemes, or a ProblemError that says what can be asked for."""
    from tmm_cli.problem.errors import ProblemError
    from tmm_cli.schemes.schemes import MOST_CRANKS, MOST_LINKS, MOST_SCHEMES, TooManySchemes, schemes

    _refuse_numbers(links, "--links", mobility, MOST_CRANKS, range(mobility + 2, MOST_LINKS + 1, 2))
    try:
        return schemes(links, mobility, types)
    except TooManySchemes:
        raise ProblemError(
            _("these are too many schemes: more than {most}").format(most=MOST_SCHEMES), path=("--links",),
            found=str(links), allowed=_("fewer links, or fewer types of groups (--groups)"),
        ) from None  # fmt: skip


def wanted_chains(links: int, mobility: int) -> tuple[KinematicChain, ...]:
    """The chains, or a ProblemError that says what can be asked for."""
    from tmm_cli.schemes.chains import MOST_LINKS as most  # noqa: N811
    from tmm_cli.schemes.chains import chains

    _refuse_numbers(links, "--chains", mobility, most - 3, range(mobility + 3, most + 1, 2))
    return chains(links, mobility)


def _refuse_numbers(links: int, option: str, mobility: int, most: int, allowed: range) -> None:
    """Refuse a mobility above the most, and numbers of links that no structure of this mobility has."""
    from tmm_cli.problem.errors import ProblemError

    if not 1 <= mobility <= most:
        raise ProblemError(
            _("structures of this mobility are not built"), path=("--mobility",), found=str(mobility),
            allowed=_("1 to {most}").format(most=most),
        )  # fmt: skip
    if links not in allowed:
        raise ProblemError(
            _("no structure of mobility {mobility} has so many links").format(mobility=mobility), path=(option,),
            found=str(links),
            allowed=_("for W = {mobility}: {links}").format(mobility=mobility, links=", ".join(map(str, allowed))),
        )  # fmt: skip
