"""DXF files for CAD programs, in millimetres, with a layer for each kind of line. Requires ezdxf (extra `cad`)."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING, get_args

from tmm_cli.drawing.paper import DASHES, AreaMark, CircleMark, Drawing, Layer, LineMark, Style, TextMark

if TYPE_CHECKING:
    from ezdxf.layouts import Modelspace


CAPITAL_HEIGHT = 0.729  # of the font size: height of capital letters in DejaVu Sans, which DXF uses as text height
LINE_TYPES: dict[Style, str] = {"-": "CONTINUOUS", "--": "TMM_DASHED", ":": "TMM_DOTTED", "-.": "TMM_DASHDOT"}
TEXT_STYLES = {  # bold, italic: style and file
    (False, False): ("TMM", "DejaVuSans.ttf"),
    (True, False): ("TMM_BOLD", "DejaVuSans-Bold.ttf"),
    (False, True): ("TMM_ITALIC", "DejaVuSans-Oblique.ttf"),
    (True, True): ("TMM_BOLD_ITALIC", "DejaVuSans-BoldOblique.ttf"),
}
FOREGROUND = 7  # black on paper, white on a dark screen
BLACK_BELOW = 0x30  # every channel of a colour that is drawn as black
LINE_WEIGHTS = (0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211)
UNIT_MILLIMETRES = 4
CODE_BREAKER = "\N{HAIR SPACE}"


def write_dxf(drawing: Drawing) -> bytes:
    """Write a drawing as DXF R2010.

    The file has no date and no random numbers: the same drawing gives the same bytes.
    """
    import ezdxf
    from ezdxf.enums import TextEntityAlignment

    ezdxf.options.write_fixed_meta_data_for_testing = True
    document = ezdxf.new("R2010", units=UNIT_MILLIMETRES)
    document.header["$LIMMAX"] = drawing.paper
    for layer in get_args(Layer):
        document.layers.add(layer)
    for style, dashes in DASHES.items():
        if dashes:
            signed = [length if n % 2 == 0 else -length for n, length in enumerate(dashes)]
            document.linetypes.add(LINE_TYPES[style], [sum(dashes), *signed])
    for name, font in TEXT_STYLES.values():
        document.styles.add(name, font=font)
    aligned = {
        "left": TextEntityAlignment.MIDDLE_LEFT,
        "center": TextEntityAlignment.MIDDLE_CENTER,
        "right": TextEntityAlignment.MIDDLE_RIGHT,
    }
    space = document.modelspace()
    for mark in drawing.marks:
        if isinstance(mark, TextMark):
            about = {
                "layer": mark.layer,
                **_colour_attributes(mark.colour),
                "style": TEXT_STYLES[mark.bold, mark.italic][0],
                "rotation": mark.turn,
            }
            text = space.add_text(escape_codes(mark.text), height=CAPITAL_HEIGHT * mark.size, dxfattribs=about)
            text.set_placement(_xy(mark.at), align=aligned[mark.align])
        else:
            _add_shape(space, mark)
    document.set_modelspace_vport(height=drawing.paper[1], center=(drawing.paper[0] / 2, drawing.paper[1] / 2))
    for kind in sorted(document.entitydb.dxf_types_in_use()):  # ezdxf would take them in arbitrary order
        document.classes.add_class(kind)
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode("utf-8", "replace")


def escape_codes(text: str) -> str:
    r"""Make DXF control codes in a text (%%c, ^I, \U+0416 and the like) harmless, so that they are shown as written."""
    text = "".join(letter if letter.isprintable() else " " for letter in text)
    return re.sub(r"%(?=%)|\\(?=[UM]\+)", lambda match: match[0] + CODE_BREAKER, text).replace("^", "^ ")


def _add_shape(space: Modelspace, mark: LineMark | AreaMark | CircleMark) -> None:
    """Add a line, or a filled figure with its outline, to the model space."""
    about = {"layer": mark.layer}
    if isinstance(mark, LineMark):
        pen = about | _pen_attributes(mark.colour, mark.width)
        if mark.dashes:
            pen |= {"linetype": LINE_TYPES[mark.style], "ltscale": mark.width}
        if len(mark.places) == 2:
            space.add_line(_xy(mark.places[0]), _xy(mark.places[1]), dxfattribs=pen)
        else:
            space.add_lwpolyline([_xy(place) for place in mark.places], dxfattribs=pen)
        return
    fill = space.add_hatch(dxfattribs=about | _colour_attributes(mark.face))
    if isinstance(mark, AreaMark):
        corners = [_xy(corner) for corner in mark.corners]
        fill.paths.add_polyline_path(corners, is_closed=True)
        if mark.edge:
            space.add_lwpolyline(corners, close=True, dxfattribs=about | _pen_attributes(mark.edge, mark.width))
    else:
        left, right = mark.centre - mark.radius, mark.centre + mark.radius
        fill.paths.add_polyline_path([(*_xy(left), 1.0), (*_xy(right), 1.0)], is_closed=True)
        space.add_circle(_xy(mark.centre), mark.radius, dxfattribs=about | _pen_attributes(mark.edge, mark.width))


def _pen_attributes(colour: str, width: float) -> dict[str, object]:
    return {
        **_colour_attributes(colour),
        "lineweight": min(LINE_WEIGHTS, key=lambda standard: abs(standard - 100 * width)),
    }


def _colour_attributes(colour: str) -> dict[str, object]:
    value = int(colour[1:], 16) if colour.startswith("#") else 0xFFFFFF
    if max(value >> 16, value >> 8 & 0xFF, value & 0xFF) < BLACK_BELOW:
        return {"color": FOREGROUND}
    return {"color": FOREGROUND, "true_color": value}


def _xy(place: complex) -> tuple[float, float]:
    return place.real, place.imag
