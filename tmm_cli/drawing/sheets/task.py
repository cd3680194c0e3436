"""The picture of a task: the mechanism at the sketch, to scale, with its names; of what is to be found nothing."""

from __future__ import annotations

from tmm_cli.drawing.paper import DARK_COLOUR, Drawing, DrawingSheet, scale_words
from tmm_cli.drawing.sheets.mechanism import draw_measured
from tmm_cli.drawing.sheets.structure import sketch_scene
from tmm_cli.drawing.symbols import MEASURED, draw_driver_arrows, frame_pivots, points_to_scale
from tmm_cli.mechanics.analysis import Results


def task_picture(results: Results) -> Drawing | None:
    """None when the linkage cannot be assembled at the sketch."""
    found = sketch_scene(results)
    if found is None:
        return None
    place, scene = found
    linkage = results.linkage
    places = [*frame_pivots(linkage), *(scene.point(name) for name in linkage.moving_points)]
    places += [scene.place(name, complex(linkage.links[name].centre)) for name in linkage.moving]
    sheet = DrawingSheet(results.problem.title, place, points_to_scale(scene, places), pad=30)
    draw_driver_arrows(sheet, scene, draw_measured(sheet, scene), MEASURED, dict.fromkeys(linkage.links, DARK_COLOUR))
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    return sheet.finish()
