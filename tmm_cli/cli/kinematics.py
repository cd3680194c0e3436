"""`tmm kinematics`."""

from __future__ import annotations

from tmm_cli.cli.common import Files, Json, Out, Position, each, report, solved


def kinematics(files: Files, as_json: Json = False, out: Out = None, position: Position = None) -> None:
    """Positions, velocities, accelerations, transfer functions; of points, links and sliding pairs."""
    names = ("quality", "pressure", "cycle", "points", "link-motion", "slides")
    each(files, lambda file: report(solved(file, "kinematics", position), names, as_json, out), as_json=as_json)
