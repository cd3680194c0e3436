"""`tmm structure`."""

from __future__ import annotations

from tmm_cli.cli.chains import report_chain, solved_any
from tmm_cli.cli.common import Files, Json, Out, each, report


def structure(files: Files, as_json: Json = False, out: Out = None) -> None:
    """Mobility, pairs, Assur groups, names of links; contours and redundant constraints in space; chains by pairs."""
    names = ("structure", "links", "pairs", "groups", "contours", "space", "replacements")

    def work(file: str) -> int:
        from tmm_cli.chain import ChainResults

        results = solved_any(file, "structure", None)
        if isinstance(results, ChainResults):
            return report_chain(results, as_json, out)
        return report(results, names, as_json, out)

    each(files, work, as_json=as_json)
