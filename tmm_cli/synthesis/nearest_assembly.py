"""Assembly of a mechanism found by a synthesis, nearest to the sketch in its file."""

from __future__ import annotations

from dataclasses import replace

from tmm_cli.language import N_
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble
from tmm_cli.mechanics.errors import LinkageError, SketchMismatchError
from tmm_cli.mechanics.linkage import Linkage, Sketch

OTHER_SKETCH = N_(
    "the sketch in the file does not match the mechanism found; the assembly nearest to the sketch was taken"
)


def find_nearest_assembly(linkage: Linkage) -> Sketch | None:
    """Return the sketch moved to the assembly nearest to it, so that the mechanism found is always assembled.

    The file's sketch cannot know the lengths that a synthesis finds.

    Returns:
        None if the sketch fits the mechanism, or if the mechanism cannot be assembled at all.
    """
    moved: Sketch | None = None
    for _tries in range(len(linkage.sketch.points) + len(linkage.sketch.angles) + 1):
        try:
            assemble(linkage, analyse_mobile_structure(linkage))
        except SketchMismatchError as error:
            sketch = linkage.sketch
            if isinstance(error.found, complex):
                sketch = replace(sketch, points={**sketch.points, error.name: error.found})
            else:
                sketch = replace(sketch, angles={**sketch.angles, error.name: error.found})
            moved, linkage = sketch, replace(linkage, sketch=sketch)
        except LinkageError:
            return None
        else:
            return moved
    return None
