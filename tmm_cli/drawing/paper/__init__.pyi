"""What goes on paper: the record of a drawing, texts, labels, blocks, charts, dimension lines. Knows no mechanism."""

from .blocks import (
    NOTE as NOTE,
    Block as Block,
    Figure as Figure,
    Room as Room,
    Row as Row,
    choose_scale as choose_scale,
    snug as snug,
)
from .boxes import aside as aside, convex_hull as convex_hull, gaps as gaps
from .chart import (
    FINE as FINE,
    LEFT as LEFT,
    LOWEST as LOWEST,
    PLAIN as PLAIN,
    RIGHT as RIGHT,
    ROW as ROW,
    SAMPLE as SAMPLE,
    SMALL as SMALL,
    TICKS as TICKS,
    Across as Across,
    Axis as Axis,
    Curve as Curve,
    Jump as Jump,
    Panel as Panel,
    Plot as Plot,
    across as across,
    axis_room as axis_room,
    count_fitting as count_fitting,
    decades as decades,
    draw_chart as draw_chart,
    equal as equal,
    filling as filling,
    limits as limits,
    round_up as round_up,
    upwards as upwards,
)
from .contours import borders as borders, contour as contour, hatching as hatching, region as region
from .dimensions import (
    TICK as TICK,
    Number as Number,
    Ruler as Ruler,
    angle_mark as angle_mark,
    beside as beside,
    dimension as dimension,
    draw_ruler as draw_ruler,
    gather_numbers as gather_numbers,
    roomiest as roomiest,
    ruler_of as ruler_of,
    ruler_reach as ruler_reach,
    spread as spread,
)
from .fonts import (
    FAMILY as FAMILY,
    HALF as HALF,
    UNITS as UNITS,
    advance as advance,
    corners as corners,
    drawable as drawable,
    font as font,
    font_file as font_file,
    foot as foot,
    glyph_outline as glyph_outline,
    lacking as lacking,
    width as width,
)
from .ground import STEP as STEP, Ground as Ground
from .labels import Label as Label, extent as extent, gather_labels as gather_labels, place as place
from .picture import (
    LEAST_PAPER as LEAST_PAPER,
    Picture as Picture,
    Space as Space,
    excess as excess,
    fits as fits,
    longest_for as longest_for,
    mark_corners as mark_corners,
    on_large_sheet as on_large_sheet,
    render_picture as render_picture,
    within as within,
    written_here as written_here,
)
from .record import (
    DASHES as DASHES,
    POINT as POINT,
    Area as Area,
    Circle as Circle,
    Drawing as Drawing,
    Layer as Layer,
    Line as Line,
    Mark as Mark,
    Style as Style,
    Text as Text,
)
from .script import Words as Words, pieces as pieces, plain as plain, script_width as script_width, wrapped as wrapped
from .sheet import (
    COLOURS as COLOURS,
    GREY as GREY,
    GREY_TEXT as GREY_TEXT,
    INERTIA as INERTIA,
    LOAD as LOAD,
    NAMES as NAMES,
    REACTION as REACTION,
    THIN as THIN,
    Sheet as Sheet,
    border as border,
    cells as cells,
    hatch as hatch,
    safe as safe,
    scale_words as scale_words,
    with_unit as with_unit,
)
from .writing import DARK as DARK, cut as cut, wrap as wrap, written as written
