"""Symbols of a mechanism in one position: links, pairs, supports, gears, cams, cylinders, load elements."""

from .actuators import (
    BARREL_HALF_WIDTH as BARREL_HALF_WIDTH,
    ELEMENT_BODY as ELEMENT_BODY,
    Cylinder as Cylinder,
    cylinder_drivers as cylinder_drivers,
    draw_elements as draw_elements,
)
from .higher_pair_symbols import draw_higher_pair as draw_higher_pair
from .higher_pairs import (
    CIRCLE_ANGLES as CIRCLE_ANGLES,
    contact_point as contact_point,
    higher_pair_outline as higher_pair_outline,
    outline_extent as outline_extent,
    replacement_link as replacement_link,
)
from .link_forms import (
    LinkForm as LinkForm,
    Segment as Segment,
    form_by_pairs as form_by_pairs,
    form_by_points as form_by_points,
)
from .link_symbols import (
    FREE_COLOUR as FREE_COLOUR,
    MEASURED as MEASURED,
    MOVING as MOVING,
    PART_COLOURS as PART_COLOURS,
    PLATE_COLOUR as PLATE_COLOUR,
    STRUCTURAL as STRUCTURAL,
    WELD_LEG as WELD_LEG,
    SymbolStyle as SymbolStyle,
    draw_box as draw_box,
    draw_guide as draw_guide,
    draw_link_numbers as draw_link_numbers,
    draw_mass_centre as draw_mass_centre,
    draw_rails as draw_rails,
    draw_support as draw_support,
    free_runs as free_runs,
    quiet_direction as quiet_direction,
    support_side as support_side,
    symbol_scale as symbol_scale,
    tint_colour as tint_colour,
)
from .render import (
    BOX_BODY as BOX_BODY,
    RenderedLinks as RenderedLinks,
    draw_driver_arrows as draw_driver_arrows,
    draw_names as draw_names,
    draw_slider as draw_slider,
    name_anchor as name_anchor,
    render_scene as render_scene,
)
from .scene import (
    GUIDE_EXTENSION as GUIDE_EXTENSION,
    ON_LINE as ON_LINE,
    MechanismScene as MechanismScene,
    fit_links as fit_links,
    fit_points as fit_points,
    frame_pivots as frame_pivots,
    points_to_scale as points_to_scale,
    scale_to_fit as scale_to_fit,
)
