"""`tmm structure`."""

from __future__ import annotations

from tmm_cli.cli.common import Files, Json, Out, each, report, solved


def structure(files: Files, as_json: Json = False, out: Out = None) -> None:
    """Mobility, pairs, Assur groups in solving order, formula of structure, names of links."""
    names = ("structure", "links", "pairs", "groups")
    each(files, lambda file: report(solved(file, "structure", None), names, as_json, out), as_json=as_json)
