"""The picture of a task: the mechanism at the sketch, to scale, with its names; of what is to be found nothing."""

from __future__ import annotations

from tmm_cli.drawing.paper import DARK, Drawing, Sheet, scale_words
from tmm_cli.drawing.sheets.mechanism import measured
from tmm_cli.drawing.sheets.structure import at_sketch
from tmm_cli.drawing.symbols import MEASURED, arrows, fixed_pivots, to_scale
from tmm_cli.mechanics.analysis import Results


def task_picture(results: Results) -> Drawing | None:
    """None when the linkage cannot be assembled at the sketch."""
    found = at_sketch(results)
    if found is None:
        return None
    place, scene = found
    linkage = results.linkage
    places = [*fixed_pivots(linkage), *(scene.point(name) for name in linkage.moving_points)]
    places += [scene.place(name, complex(linkage.links[name].centre)) for name in linkage.moving]
    sheet = Sheet(results.problem.title, place, to_scale(scene, places), pad=30)
    arrows(sheet, scene, measured(sheet, scene), MEASURED, dict.fromkeys(linkage.links, DARK))
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    return sheet.finish()
