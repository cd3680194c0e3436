"""`tmm synthesis`."""

from __future__ import annotations

from tmm_cli.cli.common import Files, Json, Out, Settings, each
from tmm_cli.cli.synthesis_report import report_synthesis


def synthesis(files: Files, as_json: Json = False, out: Out = None, settings: Settings = None) -> None:
    """Find lengths from what a mechanism must do, analyse it, and measure on it what was asked.

    The file has a block `synthesis`; what it finds becomes parameters of its linkage. Exit code 1 when the mechanism
    does not do what was asked within 1e-9. With -o the tables and the construction as a drawing are written too.
    """

    def work(file: str) -> int:
        return report_synthesis(file, as_json, out, settings)

    each(files, work, as_json=as_json, out=out)
