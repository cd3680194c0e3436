"""`tmm schemes`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import BAD_INPUT, Json, _progress, console, emit_json, say

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

    try:
        if (links is None) == (chains is None):
            raise ProblemError("what is wanted?", allowed="--links N for schemes, or --chains N for kinematic chains")
        if chains is not None and out is not None:
            raise ProblemError("kinematic chains have no files", path=("--out",), allowed="--links N, or --json")
        if chains is not None:
            _chains(chains, mobility, as_json)
        elif links is not None:
            _schemes(links, mobility, groups, out, as_json)
    except ProblemError as error:
        if as_json:
            emit_json({"error": error.to_dict()})
        say(f"error: {error}")
        raise typer.Exit(BAD_INPUT) from None
    except OSError as error:
        say(f"error: {error.filename or out}: {error.strerror}")
        raise typer.Exit(BAD_INPUT) from None


def _chains(links: int, mobility: int, as_json: bool) -> None:
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.schemes import chains_json, chains_table, wanted_chains
    from tmm_cli.results.terminal import show

    found = wanted_chains(links, mobility)
    if as_json:
        emit_json(chains_json(found, links, mobility))
    else:
        show(chains_table(found, links, mobility), UnitSystem(), console(), more="table.more_json")


def _schemes(links: int, mobility: int, groups: str, out: Path | None, as_json: bool) -> None:
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.results.schemes import named_types, schemes_json, schemes_table, wanted_schemes, write_skeletons
    from tmm_cli.results.terminal import show

    found = wanted_schemes(links, mobility, named_types(groups))
    written = None if out is None else write_skeletons(found, out, _progress(found))
    if as_json:
        emit_json(schemes_json(found, links, mobility, written))
    else:
        show(schemes_table(found, links, mobility, written), UnitSystem(), console(), more="table.more_json")
    if out is not None and written:
        say(f"written: {sum(x is not None for x in written)} files in {out}; next: tmm run {out}/FILE")
