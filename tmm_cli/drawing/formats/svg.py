"""SVG files in millimetres for browsers and vector editors. Texts can be edited and searched."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape

from tmm_cli.drawing.paper import BASELINE_SHARE, FONT_FAMILY, AreaMark, CircleMark, Drawing, LineMark, Mark, TextMark

ANCHOR = {"left": "start", "center": "middle", "right": "end"}
COLLAPSED_SPACES = re.compile(
    r"^ +| +$| {2,}"
)  # browsers would drop these spaces, although the text after them is placed behind them
NOT_XML = dict.fromkeys((*range(9), 11, 12, *range(14, 32), 65534, 65535), "�")


def write_svg(drawing: Drawing) -> bytes:
    """Write a drawing as SVG; coordinates are rounded to 0.001 mm."""
    across, up = (f"{side:g}" for side in drawing.paper)
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{across}mm" height="{up}mm" viewBox="0 0 {across} {up}" '
        f'font-family="\'{FONT_FAMILY}\', Verdana, sans-serif" stroke-linejoin="round" xml:space="preserve">',
        '<rect width="100%" height="100%" fill="white"/>',
        *(svg_element(mark, drawing.paper[1]) for mark in drawing.marks),
        "</svg>\n",
    ]
    return "\n".join(lines).encode("utf-8", "replace")


def svg_element(mark: Mark, height: float) -> str:
    """Return the SVG element of a mark. height: height of the paper (mm), needed because y points down in SVG."""
    match mark:
        case LineMark():
            dashes = f' stroke-dasharray="{" ".join(f"{d:.3g}" for d in mark.dashes)}"' if mark.dashes else ""
            return (
                f'<polyline points="{_format_points(mark.places, height)}" fill="none" stroke="{mark.colour}" '
                f'stroke-width="{mark.width:.3g}" stroke-linecap="round"{dashes}/>'
            )
        case AreaMark():
            fill = _fill_attributes(mark.face, mark.edge, mark.width)
            return f'<polygon points="{_format_points(mark.corners, height)}" {fill}/>'
        case CircleMark():
            x, y = _format_point(mark.centre, height).split(",")
            fill = _fill_attributes(mark.face, mark.edge, mark.width)
            return f'<circle cx="{x}" cy="{y}" r="{mark.radius:.3g}" {fill}/>'
        case TextMark():
            x, y = _format_point(mark.at, height).split(",")
            turn = f' transform="rotate({-mark.turn:.4g} {x} {y})"' if mark.turn else ""
            bold = ' font-weight="bold"' if mark.bold else ""
            italic = ' font-style="italic"' if mark.italic else ""
            text = COLLAPSED_SPACES.sub(lambda gap: "\N{NO-BREAK SPACE}" * len(gap[0]), mark.text)
            escaped = escape(text.translate(NOT_XML), quote=False)
            return (
                f'<text x="{x}" y="{y}" dy="{BASELINE_SHARE:g}em" font-size="{mark.size:.4g}" fill="{mark.colour}" '
                f'text-anchor="{ANCHOR[mark.align]}"{bold}{italic}{turn}>{escaped}</text>'
            )


def _fill_attributes(face: str, edge: str | None, width: float) -> str:
    outline = f' stroke="{edge}" stroke-width="{width:.3g}"' if edge else ""
    return f'fill="{face}"{outline}'


def _format_points(points: Iterable[complex], height: float) -> str:
    return " ".join(_format_point(place, height) for place in points)


def _format_point(place: complex, height: float) -> str:
    return f"{_format_number(place.real)},{_format_number(height - place.imag)}"


def _format_number(value: float) -> str:
    return f"{value:.3f}".rstrip("0").rstrip(".")
