"""`tmm kinematics --assemblies`: kinematics with every real assembly of the groups, listed and drawn."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tmm_cli.cli.common import report, say, write_pictures
from tmm_cli.errors import _


def list_assemblies(file: str, as_json: bool, out: Path | None, positions: Sequence[int] | None) -> int:
    """Compute one file, show its assemblies and draw them; the exit code. Raises ProblemError."""
    from tmm_cli import assemblies, load
    from tmm_cli.assembly.enumerate import listed
    from tmm_cli.draw.assemblies import sheets
    from tmm_cli.draw.formats import files

    results = assemblies(load(file), positions)
    code = report(results, [stem for stem, *__ in listed(results.assemblies or ())], as_json, None)
    for here in results.assemblies or ():
        if here.undecided is not None:
            say(
                _("the sketch does not decide which assembly {group} has; all of them are listed").format(
                    group=here.undecided.title
                )
            )
            if positions and here.number is None:
                say(_("while the sketch decides nothing, positions have no numbers; listed at its own place"))
        for group in here.lost:
            say(_("{group} is not listed: links that it hangs on cannot be placed there").format(group=group.title))
    write_pictures(results, out, dict(files(sheets(results))))
    return code
