"""Where the law of an accelerated driver begins: at position 0 of the file."""

from __future__ import annotations

from typing import Any

from tmm_cli.family import Iterated
from tmm_cli.variants.way import Variant


def start_of(variant: Variant, working: Any = None) -> Any:
    """The driver's place (rad or m) at t = 0, as tmm_cli.strokes.places has it; None where it does not count.

    working: where the working stroke of each variant begins, if that is known. Raises Iterated where the place cannot
    be told without moving each variant through its whole range.
    """
    if not variant.accelerated:
        return None
    request, driver = variant.request, variant.linkage.driver
    if request.places:
        return request.places[0]
    if variant.ends is None:
        found = working if variant.begins else request.start
        if found is None:
            raise Iterated
        return found
    if driver.stroke is None:
        raise Iterated
    return driver.stroke[0] if driver.sense > 0 else driver.stroke[1]
