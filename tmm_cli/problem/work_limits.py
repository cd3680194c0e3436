"""Limits of the work of a problem: every command ends within a minute on one core and uses less than a gigabyte."""

from __future__ import annotations

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Linkage, Request
from tmm_cli.problem.errors import ProblemError

# Work is counted in elements (see work_size) times positions; searches and drawings count as further positions.
WORK_BUDGET = 3_000_000  # each unit takes up to 20 us and 160 B: 40 elements at 74 280 positions took 44 s and 536 MB
LINK_SIZE, POINT_SIZE, LOAD_SIZE = 6, 1, 2  # elements that a link, a point, a load count for, by measured times
SEARCH_POSITIONS = 720  # range, strokes and trajectories are found on a grid of their own
SEARCH_POSITIONS_PER_LINK = 8  # a search in one group computes all links before it
SHEET_POSITIONS = 1_250  # one sheet of drawings: 25 ms an element
OTHER_SHEETS = 6  # sheets drawn beside those of the detailed positions
LARGE_LAYOUT_POSITIONS = 6  # detailed positions above which the layout of large sheets, quadratic in them, dominates
PLAN_SHEETS = 0.25  # sheets for the motion plans of one position on large sheets
CENTRE_POSITIONS = 0.1  # further positions for a sheet of centres, times the square of the number of links
DIGIT_POSITIONS = 0.4  # an element in each position whose digits are estimated: by all data, hence by the square
MIN_JUDGED, MAX_JUDGED = 20, 720  # further positions estimated for the results of searches; their largest number


def work_size(linkage: Linkage) -> int:
    """Return the size of a linkage for the work limit: a weighted sum of its links, points, loads and load elements.

    The weights are proportional to measured computing times.
    """
    links, points, loads = _count_elements(linkage)
    return LINK_SIZE * links + POINT_SIZE * points + LOAD_SIZE * loads


def refuse_work(linkage: Linkage, request: Request) -> None:
    """Refuse a problem that exceeds the work limit in any stage of analysis.

    Raises:
        ProblemError: the linkage is too large, or too many positions are requested; without line and column.
    """
    elements, count = work_size(linkage), len(request.places) or request.count
    most = WORK_BUDGET // elements - _search_positions(linkage)
    if most < 1:
        whole = WORK_BUDGET // (_search_positions(linkage) + 1)
        raise ProblemError(
            _("this mechanism is too large"),
            path=("links",),
            found=_describe_linkage(linkage),
            allowed=_("at most {most} in total, counting a link as 6, a point as 1 and a load as 2").format(most=whole),
            key=True,
        )
    if count > most:
        raise ProblemError(
            _("there are too many positions for so many links, points and loads"),
            path=("positions", "count"),
            found=_("positions: {count}; {linkage}").format(count=count, linkage=_describe_linkage(linkage)),
            allowed=_("at most {most}").format(most=most),
        )


def refuse_options(
    linkage: Linkage,
    count: int,
    *,
    digits: bool,
    detail: int | None,
    large: bool = False,
    plans: int = 0,
    centres: int = 0,
) -> None:
    """Refuse options of a command whose additional work exceeds the limit, before the work starts.

    Args:
        linkage: linkage of the problem.
        count: number of positions.
        digits: True if error bounds are requested (option --digits).
        detail: number of positions drawn in detail; None if nothing is drawn.
        large: True for large sheets, which are laid out repeatedly until they are filled.
        plans: number of positions for which only velocity and acceleration plans are drawn.
        centres: number of positions with instantaneous centres.

    Raises:
        ProblemError: the work exceeds the limit; without line and column.
    """
    elements = work_size(linkage)
    left = WORK_BUDGET / elements - _search_positions(linkage) - count
    if digits:
        each = DIGIT_POSITIONS * elements
        left -= each * (MIN_JUDGED + min(count, MAX_JUDGED))
        if left < 0:
            few = (left + count + each * min(count, MAX_JUDGED)) / (1 + each)
            most = int(few if few < MAX_JUDGED else left + count)
            raise ProblemError(
                _("there are too many positions, or the mechanism is too large, to estimate the correct digits"),
                path=("--digits",),
                found=_("positions: {count}; {linkage}").format(count=count, linkage=_describe_linkage(linkage)),
                allowed=_("a run without --digits")
                if most < 1
                else _("at most {most} positions, or a run without --digits").format(most=most),
            )
    each = SHEET_POSITIONS + CENTRE_POSITIONS * len(linkage.moving) ** 2
    if each * centres > left:
        most = int(left // each)
        raise ProblemError(
            _("there are too many instantaneous centres for so many links and positions"),
            path=("--centres",),
            found=_("detailed positions: {count}; {linkage}").format(count=centres, linkage=_describe_linkage(linkage)),
            allowed=_("detailed positions without instantaneous centres")
            if most < 1
            else _("at most {most} detailed positions, or detailed positions without instantaneous centres").format(
                most=most
            ),
        )
    if detail is not None and SHEET_POSITIONS * (
        _count_sheets(detail, large) + PLAN_SHEETS * plans
    ) > left >= SHEET_POSITIONS * _count_sheets(detail, large):
        raise ProblemError(
            _("there are too many drawings for so many links, points and positions"),
            path=("--positions",),
            found=_("positions: {count}; {linkage}").format(count=plans, linkage=_describe_linkage(linkage)),
            allowed=_("plans for at most {most} positions, or a run with --positions detail").format(
                most=int((left / SHEET_POSITIONS - _count_sheets(detail, large)) / PLAN_SHEETS)
            ),
        )
    if detail is not None and SHEET_POSITIONS * _count_sheets(detail, large) > left:
        most = max((few for few in range(detail) if SHEET_POSITIONS * _count_sheets(few, large) <= left), default=-1)
        raise ProblemError(
            _("there are too many drawings for so many links, points and positions"),
            path=("positions", "detail"),
            found=_("detailed positions: {count}; {linkage}").format(count=detail, linkage=_describe_linkage(linkage)),
            allowed=_("a run without drawings")
            if most < 0
            else _("at most {most} detailed positions, or a run without drawings").format(most=most),
        )


def _count_sheets(detail: int, large: bool) -> float:
    """Return the work of drawing the detailed positions, expressed as the number of sheets that would take the same
    work.
    """
    return OTHER_SHEETS + detail * (1 + large * detail / LARGE_LAYOUT_POSITIONS)


def _search_positions(linkage: Linkage) -> int:
    return SEARCH_POSITIONS + SEARCH_POSITIONS_PER_LINK * len(linkage.moving)


def _describe_linkage(linkage: Linkage) -> str:
    links, points, loads = _count_elements(linkage)
    return _("links: {links}, points: {points}, loads: {loads}").format(links=links, points=points, loads=loads)


def _count_elements(linkage: Linkage) -> tuple[int, int, int]:
    """Return the number of moving links, of points on them, and of loads including load elements."""
    points = sum(len(linkage.links[name].points) for name in linkage.moving)
    return len(linkage.moving), points, len(linkage.acting)
