"""What is worth a second look: each check with its number, the limit, and where the driver is then."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tmm_cli.analysis.checks import Check, checks
from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import _, numeral
from tmm_cli.quantities import ANGLE, LENGTH, place_dimension
from tmm_cli.results.table import Table, table_of_words, with_unit
from tmm_cli.tolerances import SAME_PLACE


def tables(results: Results) -> Iterable[Table]:
    """A row a check."""
    rows = [
        (*_said(check, results), _place(check, results), _("ok") if check.holds else _("warn"))
        for check in checks(results)
    ]
    if rows:
        headers = (_("check"), _("of"), _("found"), _("limit"), _("driver at"), _("verdict"))
        yield table_of_words("checks", _("Checks"), headers, rows)


def _place(check: Check, results: Results) -> str:
    if check.at is None:
        return ""
    at = check.at if abs(check.at) > SAME_PLACE else 0.0
    units, dimension = results.problem.units, place_dimension(results.linkage.driver.kind)
    place, none = (with_unit(units, each, dimension, 4) for each in (at, 0.0))
    again = with_unit(units, 2 * math.pi * results.turns, dimension, 4) if results.turns else ""
    return none if place == again else place


def _said(check: Check, results: Results) -> tuple[str, str, str, str]:
    """What is checked, of what, the number, and its limit."""
    units = results.problem.units
    match check.kind:
        case "slot":
            slide = results.linkage.slide(check.of)
            slot = _("link {runner} in slot {slot} of link {carrier}").format(
                runner=slide.runner, slot="".join(slide.ends or ()), carrier=slide.carrier
            )
            found = _("{far} left before {point}") if check.holds else _("{far} beyond {point}")
            far = with_unit(units, abs(check.value), LENGTH, 4)
            return _("stone in its slot"), slot, found.format(far=far, point=check.detail), _("its ends")
        case "pressure":
            link = _("link {link} of {group}").format(link=check.of, group=check.detail)
            most = _("at most {angle}").format(angle=with_unit(units, check.limit, ANGLE, 4))
            return _("pressure angle"), link, with_unit(units, check.value, ANGLE, 4), most
        case "load":
            found = _("one way")
            if not check.holds:
                found = (
                    _("drives in the working stroke ({work} J), resists in the idle one")
                    if check.detail == "working"
                    else _("resists in the working stroke, drives in the idle one ({work} J)")
                ).format(work=numeral(check.value, ".6g"))
            wanted = _("one way; or when: working stroke")
            return _("load without `when`"), _("load {load}").format(load=check.of), found, wanted
        case "near dead":
            limit = _("at least {margin}").format(margin=numeral(check.limit, ".6g"))
            found = numeral(check.value if check.value > 1e-12 else 0.0, ".3g")
            return _("margin to dead and change points"), check.of, found, limit
        case "lever":
            limit = _("at most {share} %").format(share=numeral(100 * check.limit, ".6g"))
            value = 100 * check.value
            return _("lever against force plan"), "", f"{numeral(0.0 if check.at is None else value, '.3g')} %", limit
