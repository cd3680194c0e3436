"""The sheets, one a file; `draw/__init__.py` lists those of a run."""

from . import (
    assemblies as assemblies,
    centres as centres,
    group_table as group_table,
    hodographs as hodographs,
    law_of_motion as law_of_motion,
    synthesis as synthesis,
)
from .acting import ARM_COLOUR as ARM_COLOUR, ForceArrows as ForceArrows
from .beneath import CaptionTable as CaptionTable, DrawingCaption as DrawingCaption
from .centres import draw_centres as draw_centres
from .construction import (
    CONSTRUCTION_PAD as CONSTRUCTION_PAD,
    MOST_REDUCTION as MOST_REDUCTION,
    draw_construction as draw_construction,
    pieces_inside as pieces_inside,
    points_on_sheet as points_on_sheet,
    use_problem_names as use_problem_names,
)
from .diagrams import (
    CURVE_COLOURS as CURVE_COLOURS,
    dense_coordinates as dense_coordinates,
    draw_diagrams as draw_diagrams,
)
from .force_plans import (
    draw_force_plans as draw_force_plans,
    force_plan_rows as force_plan_rows,
    lane_offsets as lane_offsets,
)
from .group_loads import (
    draw_group_loads as draw_group_loads,
    equation_lines as equation_lines,
    forces_table as forces_table,
    format_figures as format_figures,
    split_equations as split_equations,
)
from .group_table import GROUP_EXAMPLES as GROUP_EXAMPLES
from .hodographs import (
    draw_reaction_hodographs as draw_reaction_hodographs,
    draw_shaking_hodograph as draw_shaking_hodograph,
)
from .intermittent import draw_intermittent as draw_intermittent
from .law_of_motion import draw_law_of_motion as draw_law_of_motion, visible_stretches as visible_stretches
from .lever import draw_lever as draw_lever
from .mechanism import (
    Position as Position,
    detailed_drawings as detailed_drawings,
    draw_position as draw_position,
    driver_caption as driver_caption,
)
from .motion_plans import (
    MotionPlanKind as MotionPlanKind,
    draw_motion_plans as draw_motion_plans,
    motion_plan_kinds as motion_plan_kinds,
    motion_plan_rows as motion_plan_rows,
)
from .over_cycle import QuantityPlot as QuantityPlot, balancing_plots as balancing_plots, output_plots as output_plots
from .positions import (
    draw_all_positions as draw_all_positions,
    extreme_states as extreme_states,
    output_extremes as output_extremes,
    output_path as output_path,
    scale_ratio as scale_ratio,
)
from .single_run import draw_single_run as draw_single_run
from .structure import (
    Legend as Legend,
    count_pair_letters as count_pair_letters,
    draw_all_groups as draw_all_groups,
    draw_groups as draw_groups,
    draw_scheme as draw_scheme,
    groups_sheet as groups_sheet,
    mechanism_parts as mechanism_parts,
    scheme_sheet as scheme_sheet,
    sketch_scene as sketch_scene,
)
from .synthesis import (
    draw_problem_synthesis as draw_problem_synthesis,
    draw_synthesis as draw_synthesis,
    synthesis_diagram as synthesis_diagram,
)
from .task import task_picture as task_picture
