"""Motion of named points, centres of mass, links and sliding pairs, with transfer functions; a row a position."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.selection import links as chosen_links
from tmm_cli.analysis.selection import moving_centres, moving_points
from tmm_cli.kinematics.motion import Turning
from tmm_cli.language import N_, _
from tmm_cli.quantities import LINK, POINT, SLIDE, columns
from tmm_cli.results.reports.cycle import signs
from tmm_cli.results.reports.long import long_table
from tmm_cli.results.table import Table
from tmm_cli.vectors import pi


def tables(results: Results) -> Iterable[Table]:
    """points, links, slides."""
    motion = results.motion
    assert motion is not None
    linkage, of = results.linkage, results.of
    points = dict(sorted(moving_points(linkage, motion, of).items())) | moving_centres(linkage, motion, of)
    if of:
        points = {name: points[name] for name in of if name in points}
    if points:
        values = [columns(POINT, point) for point in points.values()]
        yield long_table(results, "points", _("Points and centres of mass"), {N_("point"): list(points)}, values)
    links = chosen_links(linkage, of)
    if links:
        values = [columns(LINK, _half_turned(motion.link(name))) for name in links]
        table = long_table(results, "link-motion", _("Motion of links"), {N_("link"): links}, values, signs(linkage))
        yield _with_turns(table) if any(mesh.kind != "cam" for mesh in linkage.meshes) else table
    slides = () if of else linkage.slides
    if slides:
        values = [columns(SLIDE, motion.slide(slide)) for slide in slides]
        title = _("Sliding pairs: motion of the runner along the guide")
        yield long_table(results, "slides", title, {N_("pair"): [slide.name for slide in slides]}, values)


def _with_turns(table: Table) -> Table:
    """With angular speeds in turns a minute beside them, as speeds of wheels are given."""
    k = next(k for k, column in enumerate(table.columns) if column.header == "omega")
    turns = replace(table.columns[k], header=_("n"), unit="rpm")
    return replace(table, columns=(*table.columns[: k + 1], turns, *table.columns[k + 1 :]))


def _half_turned(turning: Turning) -> Turning:
    """With the angle in -180 to 180 deg, the driver's too."""
    half = pi(turning.angle)
    turns = np.ceil((turning.angle - half) / (2 * half))
    return replace(turning, angle=turning.angle - 2 * half * turns)
