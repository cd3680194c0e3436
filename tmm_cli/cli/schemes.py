"""`tmm schemes`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.cli.common import Json, console, drawn, emit_json, progress, refusing
from tmm_cli.cli.scheme_files import named_types, wanted_chains, wanted_schemes, write_skeletons
from tmm_cli.cli.talk import printable, say
from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.files import Staged
from tmm_cli.results.schemes import chains_json, chains_table, schemes_json, schemes_table
from tmm_cli.results.terminal import MORE_ROWS_AS_JSON, show

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
    table: Annotated[
        bool, typer.Option("--table", help="Instead: draw the table of Assur groups of classes II to VI by order.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Structural synthesis: all schemes built of Assur groups, or the number of kinematic chains."""
    written = None
    with refusing(as_json, str(out or "")):
        if table and (links, chains) == (None, None):
            with Staged(out or Path("outputs") / "assur-groups") as staged:
                for name, picture in drawn("group-table"):
                    staged.write(name, (picture,))
            say(_("written: {folder}").format(folder=printable(staged.folder)))
        elif links is not None and chains is None:
            types = named_types(groups)
            found = wanted_schemes(links, mobility, types)
            written = None if out is None else write_skeletons(found, out, progress(found))
            if as_json:
                emit_json(schemes_json(found, links, mobility, written, types))
            else:
                rows = schemes_table(found, links, mobility, written, types)
                show(rows, UnitSystem(), console(), more=MORE_ROWS_AS_JSON)
        elif chains is not None and links is None:
            if out is not None:
                raise ProblemError(_("kinematic chains have no files"), path=("--out",), allowed="--links N, --json")
            all_chains = wanted_chains(chains, mobility)
            if as_json:
                emit_json(chains_json(all_chains, chains, mobility))
            else:
                show(chains_table(all_chains, chains, mobility), UnitSystem(), console(), more=MORE_ROWS_AS_JSON)
        else:
            wanted = _("--links N for schemes, --chains N for kinematic chains, or --table for the table of groups")
            raise ProblemError(_("what is wanted?"), allowed=wanted)
    if out is not None and written:
        count = sum(x is not None for x in written)
        say(_("written: {count} files in {out}; next: tmm run {out}/FILE").format(count=count, out=printable(out)))
