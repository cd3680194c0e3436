"""How much work a problem may ask for: so much that any command ends within a minute and a gigabyte on one core."""

from __future__ import annotations

from tmm_cli.errors import _
from tmm_cli.linkage import Linkage, Request
from tmm_cli.problem.errors import ProblemError

BUDGET = 3_000_000  # parts times positions; a million of them takes some 10 s and 200 MB
SEARCHED = 720  # positions more: the range, the strokes and the trajectories are found on a grid of their own
LINK, POINT, LOAD = 6, 1, 2  # parts that each of them counts for: so are their measured times and tables
DRAWN = 2_000  # parts times positions in detail, and SHEETS more for the rest: each of 40 parts takes a second
JUDGED = 250  # parts: every number is judged against every datum, so this grows with the square
SHEETS = 6


def parts(linkage: Linkage) -> int:
    """The size of a linkage: links with their pairs, points on them, loads and springs."""
    points = sum(len(linkage.links[name].points) for name in linkage.moving)
    return LINK * len(linkage.moving) + POINT * points + LOAD * (len(linkage.loads) + len(linkage.springs))


def refuse_work(linkage: Linkage, request: Request) -> None:
    """Refuse what no stage could do within the budget. Raises ProblemError, not yet located."""
    size, count = parts(linkage), len(request.places) or request.count
    most = BUDGET // size - SEARCHED
    if most < 1:
        raise ProblemError(
            _("this linkage is too large"), path=("links",), found=_told(linkage),
            allowed=_("6 a link, 1 a point, 2 a load: at most {most} in all").format(most=BUDGET // (SEARCHED + 1)),
            key=True,
        )  # fmt: skip
    if count > most:
        raise ProblemError(
            _("too many positions for so many links, points and loads"), path=("positions", "count"),
            found=_("{count} positions; {linkage}").format(count=count, linkage=_told(linkage)),
            allowed=_("at most {most}").format(most=most),
        )  # fmt: skip


def refuse_digits(linkage: Linkage) -> None:
    """Refuse to judge every number of a large linkage. Raises ProblemError."""
    if parts(linkage) > JUDGED:
        raise ProblemError(
            _("the linkage is too large for its digits to be judged"), path=("--digits",), found=_told(linkage),
            allowed=_("6 a link, 1 a point, 2 a load: at most {most} in all").format(most=JUDGED),
        )  # fmt: skip


def refuse_drawings(linkage: Linkage, request: Request) -> None:
    """Refuse to draw too much. Raises ProblemError."""
    most = DRAWN // parts(linkage) - SHEETS
    if len(request.detail) > most or most < 0:
        raise ProblemError(
            _("these are too many drawings for so many links and points"), path=("positions", "detail"),
            found=_("{count} positions in detail; {linkage}").format(
                count=len(request.detail), linkage=_told(linkage)
            ),
            allowed="--no-drawings" if most < 0
            else _("at most {most} in detail, or --no-drawings").format(most=most),
        )  # fmt: skip


def _told(linkage: Linkage) -> str:
    points = sum(len(linkage.links[name].points) for name in linkage.moving)
    loads = len(linkage.loads) + len(linkage.springs)
    text = _("{links} links, {points} points, {loads} loads")
    return text.format(links=len(linkage.moving), points=points, loads=loads)
