"""Slips that leave something of a file without use: links joined to nothing, idle guides, points named once only."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from tmm_cli.errors import _
from tmm_cli.linkage import FRAME, Hinge, Link, Slide
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError, nearest, quote
from tmm_cli.problem.tree import Path


def nothing_stray(
    shape: schema.File,
    data: dict[str, Any],
    links: dict[str, Link],
    hinges: tuple[Hinge, ...],
    slides: tuple[Slide, ...],
) -> None:
    """Refuse links joined to nothing, guides that nothing uses and points named once only: they are slips."""
    joined = {name for h in hinges for name in h.links} | {n for s in slides for n in (s.carrier, s.runner)}
    for name in links:
        if name not in joined and name != FRAME:
            raise ProblemError(
                _("this link is joined to nothing"), path=("links", name), found=", ".join(links[name].points),
                allowed=_("a point that another link or the frame has too, or slides"), key=True,
            )  # fmt: skip
    used = {s.on for link in shape.links.values() for s in link.sliding}
    for guide in shape.guides:
        if guide not in used:
            raise ProblemError(_("nothing slides on this guide"), path=("guides", guide), found=quote(guide), key=True)
    _named_twice(shape, data, links, hinges, slides)


def _named_twice(
    shape: schema.File,
    data: dict[str, Any],
    links: dict[str, Link],
    hinges: tuple[Hinge, ...],
    slides: tuple[Slide, ...],
) -> None:
    shared = {h.point for h in hinges}
    everything = list(dict.fromkeys(p for link in links.values() for p in link.points))
    pairs = {a + b: (a, b) for a in everything for b in everything}
    elsewhere: set[str] = set()
    for word in _words({**data, "parameters": {}, "title": "", "description": ""}):
        elsewhere |= {word, *pairs.get(re.sub(r"[-–, ]", "", word), ())}
    for slide in (s for link in shape.links.values() for s in link.sliding):
        if slide.on in links and slide.along is None and slide.through is None and slide.angle is None:
            elsewhere |= set(links[slide.on].points)  # its two points are the guide
    for name, link in links.items():
        given = list(link.points) if name == FRAME else shape.links[name].points
        running = {s.at for s in slides if s.runner == name}
        for number, point in enumerate(given if isinstance(given, list) else ()):
            if point in shared or point in elsewhere or link.points[point] in running:
                continue
            path: Path = ("points", point) if name == FRAME else ("links", name, "points", number)
            raise ProblemError(
                _("this point is named nowhere else"), path=path, found=quote(point),
                allowed=_("a point of another link; a point that is only watched has coordinates (see also:)"),
                near=nearest(point, [p for p in everything if p != point and p not in link.points]),
                key=name == FRAME,
            )  # fmt: skip


def _words(part: Any) -> Iterator[str]:
    """Every text of a file that may name a point, the links' own lists of points left out."""
    if isinstance(part, dict):
        yield from part
        for key, value in part.items():
            if key != "points":
                yield from _words(value)
    elif isinstance(part, list):
        for value in part:
            yield from _words(value)
    elif isinstance(part, str):
        yield part
