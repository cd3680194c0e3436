"""Limits of the work that a problem may request: any command ends within a minute and a gigabyte on one core."""

from __future__ import annotations

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Linkage, Request
from tmm_cli.problem.errors import ProblemError

BUDGET = 3_000_000  # parts at positions, each up to 20 us and 160 B: 40 parts at 74 280 took 44 s and 536 MB
SEARCHED = 720  # positions more: the range, the strokes and the trajectories are found on a grid of their own
EACH = 8  # positions more for each link: what is searched for in each group computes all links before it
LINK, POINT, LOAD = 6, 1, 2  # parts that each of them counts for: so are their measured times and tables
SHEET = 1_250  # positions that a sheet of drawings counts for: 25 ms a part
SHEETS = 6  # that are drawn beside those in detail
LAID_OUT = 6  # positions in detail from which laying large sheets out takes longer than drawing: as their square
PLANS = 0.25  # sheets that the plans of motion of a position count for on large sheets
CENTRES = 0.1  # positions that a sheet of centres counts for besides, times the square of the number of links
JUDGED = 0.4  # positions that a part counts for in each that is judged: against all data, so it grows with the square
FIRST, LONG = 20, 720  # positions more that are judged for what was searched for; the most that are


def parts(linkage: Linkage) -> int:
    """The size of a linkage: links with their pairs, points on them, loads and springs."""
    links, points, loads = _counted(linkage)
    return LINK * links + POINT * points + LOAD * loads


def refuse_work(linkage: Linkage, request: Request) -> None:
    """Refuse what no stage could do within the budget. Raises ProblemError, not yet located."""
    size, count = parts(linkage), len(request.places) or request.count
    most = BUDGET // size - _searched(linkage)
    if most < 1:
        whole = BUDGET // (_searched(linkage) + 1)
        raise ProblemError(
            _("this linkage is too large"),
            path=("links",),
            found=_told(linkage),
            allowed=_("6 a link, 1 a point, 2 a load: at most {most} in all").format(most=whole),
            key=True,
        )
    if count > most:
        raise ProblemError(
            _("too many positions for so many links, points and loads"),
            path=("positions", "count"),
            found=_("{count} positions; {linkage}").format(count=count, linkage=_told(linkage)),
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
    """Refuse what the options of a command add to the work at so many positions, before it starts.

    detail: positions that are drawn in detail; None where nothing is drawn. large: on large sheets, which are drawn
    again and again until they are full; plans: positions whose plans of motion alone are on them. centres: positions
    whose instantaneous centres are found and drawn.
    Raises ProblemError, not yet located.
    """
    size = parts(linkage)
    left = BUDGET / size - _searched(linkage) - count
    if digits:
        each = JUDGED * size
        left -= each * (FIRST + min(count, LONG))
        if left < 0:
            few = (left + count + each * min(count, LONG)) / (1 + each)
            most = int(few if few < LONG else left + count)
            raise ProblemError(
                _("too many positions and too large a linkage for all digits to be judged"),
                path=("--digits",),
                found=_("{count} positions; {linkage}").format(count=count, linkage=_told(linkage)),
                allowed=_("without --digits")
                if most < 1
                else _("at most {most} positions, or without --digits").format(most=most),
            )
    each = SHEET + CENTRES * len(linkage.moving) ** 2
    if each * centres > left:
        most = int(left // each)
        raise ProblemError(
            _("these are too many instantaneous centres for so many links and positions"),
            path=("--centres",),
            found=_("{count} positions in detail; {linkage}").format(count=centres, linkage=_told(linkage)),
            allowed=_("without centres")
            if most < 1
            else _("at most {most} in detail, or without centres").format(most=most),
        )
    if detail is not None and SHEET * (_sheets(detail, large) + PLANS * plans) > left >= SHEET * _sheets(detail, large):
        raise ProblemError(
            _("these are too many drawings for so many links, points and positions"),
            path=("--positions",),
            found=_("{count} positions; {linkage}").format(count=plans, linkage=_told(linkage)),
            allowed=_("plans of at most {most}, or --positions detail").format(
                most=int((left / SHEET - _sheets(detail, large)) / PLANS)
            ),
        )
    if detail is not None and SHEET * _sheets(detail, large) > left:
        most = max((few for few in range(detail) if SHEET * _sheets(few, large) <= left), default=-1)
        raise ProblemError(
            _("these are too many drawings for so many links, points and positions"),
            path=("positions", "detail"),
            found=_("{count} positions in detail; {linkage}").format(count=detail, linkage=_told(linkage)),
            allowed=_("without drawings")
            if most < 0
            else _("at most {most} in detail, or without drawings").format(most=most),
        )


def _sheets(detail: int, large: bool) -> float:
    """Sheets of positions that drawings count for."""
    return SHEETS + detail * (1 + large * detail / LAID_OUT)


def _searched(linkage: Linkage) -> int:
    return SEARCHED + EACH * len(linkage.moving)


def _told(linkage: Linkage) -> str:
    links, points, loads = _counted(linkage)
    return _("{links} links, {points} points, {loads} loads").format(links=links, points=points, loads=loads)


def _counted(linkage: Linkage) -> tuple[int, int, int]:
    """Moving links, points on them, loads and springs."""
    points = sum(len(linkage.links[name].points) for name in linkage.moving)
    return len(linkage.moving), points, len(linkage.acting)
