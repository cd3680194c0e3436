"""The sheets, one a file; `draw/__init__.py` lists those of a run."""

from . import (
    assemblies as assemblies,
    centres as centres,
    group_table as group_table,
    hodographs as hodographs,
    law_of_motion as law_of_motion,
    synthesis as synthesis,
)
from .acting import ARM as ARM, Forces as Forces
from .beneath import Beneath as Beneath, Table as Table
from .centres import draw_centres as draw_centres
from .construction import (
    PAD as PAD,
    SMALLER as SMALLER,
    draw_construction as draw_construction,
    granted as granted,
    inside as inside,
    rename as rename,
)
from .diagrams import LINES as LINES, closely as closely, draw_diagrams as draw_diagrams
from .force_plans import force_plan_rows as force_plan_rows, forces as forces, lanes as lanes
from .group_loads import (
    draw_group_loads as draw_group_loads,
    figure as figure,
    sheetfuls as sheetfuls,
    table_of_forces as table_of_forces,
    written as written,
)
from .group_table import EXAMPLES as EXAMPLES
from .hodographs import balancing as balancing, reactions as reactions
from .intermittent import draw_intermittent as draw_intermittent
from .law_of_motion import draw_law_of_motion as draw_law_of_motion, stretches_on_paper as stretches_on_paper
from .lever import draw_lever as draw_lever
from .mechanism import (
    Position as Position,
    detailed as detailed,
    place_of_driver as place_of_driver,
    position as position,
)
from .motion_plans import (
    Sort as Sort,
    draw_motion_plans as draw_motion_plans,
    motion_plan_rows as motion_plan_rows,
    sorts as sorts,
)
from .over_cycle import Quantities as Quantities, balances as balances, output as output
from .positions import (
    all_positions as all_positions,
    extreme_states as extreme_states,
    extremes as extremes,
    output_track as output_track,
    ratio as ratio,
)
from .single_run import draw_single_run as draw_single_run
from .structure import (
    Legend as Legend,
    all_groups as all_groups,
    at_sketch as at_sketch,
    counted as counted,
    groups as groups,
    parts as parts,
    scheme as scheme,
    side_by_side as side_by_side,
    whole_scheme as whole_scheme,
)
from .synthesis import diagram as diagram, draw_synthesis as draw_synthesis, synthesised as synthesised
from .task import task_picture as task_picture
