"""Sheets of a project, one subject in each module; `drawing/run.py` lists those of a run."""

from .assemblies import draw_assemblies as draw_assemblies
from .captions import CaptionTable as CaptionTable, DrawingCaption as DrawingCaption
from .centres import draw_centres as draw_centres
from .diagrams import (
    CURVE_COLOURS as CURVE_COLOURS,
    QuantityPlot as QuantityPlot,
    balancing_plots as balancing_plots,
    dense_coordinates as dense_coordinates,
    draw_diagrams as draw_diagrams,
    output_plots as output_plots,
)
from .dynamics import (
    draw_energy_mass as draw_energy_mass,
    draw_law_curves as draw_law_curves,
    draw_law_of_motion as draw_law_of_motion,
    draw_single_run as draw_single_run,
    visible_stretches as visible_stretches,
)
from .force_arrows import ARM_COLOUR as ARM_COLOUR, ForceArrows as ForceArrows
from .group_table import GROUP_EXAMPLES as GROUP_EXAMPLES, draw_group_table as draw_group_table
from .hodographs import (
    draw_reaction_hodographs as draw_reaction_hodographs,
    draw_shaking_hodograph as draw_shaking_hodograph,
)
from .intermittent import draw_intermittent as draw_intermittent
from .mechanism import (
    Position as Position,
    detailed_drawings as detailed_drawings,
    draw_position as draw_position,
    driver_caption as driver_caption,
    sketch_scene as sketch_scene,
    task_picture as task_picture,
)
from .moment_equations import (
    draw_group_loads as draw_group_loads,
    draw_lever as draw_lever,
    equation_lines as equation_lines,
    forces_table as forces_table,
    format_figures as format_figures,
    split_equations as split_equations,
)
from .positions import (
    draw_all_positions as draw_all_positions,
    extreme_states as extreme_states,
    output_extremes as output_extremes,
    output_path as output_path,
    scale_ratio as scale_ratio,
)
from .structure import (
    Legend as Legend,
    count_pair_letters as count_pair_letters,
    draw_all_groups as draw_all_groups,
    draw_groups as draw_groups,
    draw_scheme as draw_scheme,
    groups_sheet as groups_sheet,
    mechanism_parts as mechanism_parts,
    scheme_sheet as scheme_sheet,
)
from .synthesis import (
    CONSTRUCTION_PAD as CONSTRUCTION_PAD,
    MOST_REDUCTION as MOST_REDUCTION,
    draw_construction as draw_construction,
    draw_problem_synthesis as draw_problem_synthesis,
    draw_synthesis as draw_synthesis,
    pieces_inside as pieces_inside,
    points_on_sheet as points_on_sheet,
    synthesis_diagram as synthesis_diagram,
    use_problem_names as use_problem_names,
)
from .vector_plans import (
    MotionPlanKind as MotionPlanKind,
    draw_force_plans as draw_force_plans,
    draw_motion_plans as draw_motion_plans,
    force_plan_rows as force_plan_rows,
    lane_offsets as lane_offsets,
    motion_plan_kinds as motion_plan_kinds,
    motion_plan_rows as motion_plan_rows,
)
