"""What goes on paper: the record of a drawing, texts, labels, blocks, charts, dimension lines. Knows no mechanism."""

from .blocks import (
    NOTE_SIZE as NOTE_SIZE,
    FigureExtent as FigureExtent,
    NoteBlock as NoteBlock,
    PaperLayout as PaperLayout,
    TableRow as TableRow,
    choose_scale as choose_scale,
    scaleless_layout as scaleless_layout,
)
from .boxes import (
    box_distances as box_distances,
    convex_hull as convex_hull,
    distance_to_segment as distance_to_segment,
)
from .chart import (
    GRID_COLOUR as GRID_COLOUR,
    LEAST_PANEL_HEIGHT as LEAST_PANEL_HEIGHT,
    LEFT_MARGIN as LEFT_MARGIN,
    LEGEND_SAMPLE as LEGEND_SAMPLE,
    PLAIN_TEXT as PLAIN_TEXT,
    RIGHT_MARGIN as RIGHT_MARGIN,
    SMALL_TEXT as SMALL_TEXT,
    TEXT_ROW as TEXT_ROW,
    TICK_STEPS as TICK_STEPS,
    ChartAxis as ChartAxis,
    ChartCurve as ChartCurve,
    CommonAxis as CommonAxis,
    CurveJump as CurveJump,
    Panel as Panel,
    PlotContent as PlotContent,
    axis_extent as axis_extent,
    count_fitting as count_fitting,
    draw_chart as draw_chart,
    equal_scales as equal_scales,
    filling_axis as filling_axis,
    finite_limits as finite_limits,
    logarithmic_axis as logarithmic_axis,
    round_axis as round_axis,
    round_up as round_up,
    vertical_axis as vertical_axis,
)
from .contours import (
    contour_lines as contour_lines,
    hatch_polygons as hatch_polygons,
    region_borders as region_borders,
    region_polygons as region_polygons,
)
from .dimensions import (
    TICK_LENGTH as TICK_LENGTH,
    Ruler as Ruler,
    RulerNumber as RulerNumber,
    count_beside as count_beside,
    draw_angle as draw_angle,
    draw_dimension as draw_dimension,
    draw_ruler as draw_ruler,
    fit_ruler as fit_ruler,
    gather_numbers as gather_numbers,
    least_crowded_ruler as least_crowded_ruler,
    ruler_reach as ruler_reach,
    spread_intervals as spread_intervals,
)
from .fonts import (
    BASELINE_SHARE as BASELINE_SHARE,
    FONT_FAMILY as FONT_FAMILY,
    FONT_UNITS as FONT_UNITS,
    baseline as baseline,
    font_file as font_file,
    glyph_outline as glyph_outline,
    letter_advance as letter_advance,
    load_font as load_font,
    missing_characters as missing_characters,
    replace_missing as replace_missing,
    text_corners as text_corners,
    text_width as text_width,
)
from .ground import SAMPLE_STEP as SAMPLE_STEP, OccupiedArea as OccupiedArea
from .labels import (
    Label as Label,
    gather_coincident as gather_coincident,
    place_labels as place_labels,
    text_extent as text_extent,
)
from .picture import (
    LEAST_PAPER as LEAST_PAPER,
    PictureSpace as PictureSpace,
    SheetPicture as SheetPicture,
    drawing_within as drawing_within,
    excess_factor as excess_factor,
    fits_sheet as fits_sheet,
    longest_for as longest_for,
    mark_corners as mark_corners,
    on_large_sheet as on_large_sheet,
    render_picture as render_picture,
    writes_equations as writes_equations,
)
from .record import (
    DASHES as DASHES,
    POINT as POINT,
    AreaMark as AreaMark,
    CircleMark as CircleMark,
    Drawing as Drawing,
    Layer as Layer,
    LineMark as LineMark,
    Mark as Mark,
    Style as Style,
    TextMark as TextMark,
)
from .script import (
    Words as Words,
    placed_pieces as placed_pieces,
    plain_text as plain_text,
    script_width as script_width,
    wrap_symbols as wrap_symbols,
)
from .sheet import (
    GREY_COLOUR as GREY_COLOUR,
    GREY_TEXT as GREY_TEXT,
    INERTIA_COLOUR as INERTIA_COLOUR,
    LOAD_COLOUR as LOAD_COLOUR,
    NAME_COLOUR as NAME_COLOUR,
    REACTION_COLOUR as REACTION_COLOUR,
    THIN_COLOUR as THIN_COLOUR,
    VECTOR_COLOURS as VECTOR_COLOURS,
    DrawingSheet as DrawingSheet,
    divide_into_cells as divide_into_cells,
    draw_hatching as draw_hatching,
    file_safe_name as file_safe_name,
    leave_field as leave_field,
    scale_words as scale_words,
    with_unit as with_unit,
)
from .writing import DARK_COLOUR as DARK_COLOUR, cell_text as cell_text, cut_text as cut_text, wrap_text as wrap_text
