"""Solvers of Assur groups, one module for each type, and the constraint equations of pairs."""

from . import sequence as sequence
from .branch_trace import (
    AccumulatedAngles as AccumulatedAngles,
    BranchTrace as BranchTrace,
    ChangePoints as ChangePoints,
)
from .closed_forms import CLOSED_FORM_SOLVERS as CLOSED_FORM_SOLVERS
from .dyads import DYAD_SOLVERS as DYAD_SOLVERS
from .group_solver import (
    ClosedFormSolver as ClosedFormSolver,
    GroupSolver as GroupSolver,
    HingeEnd as HingeEnd,
    SliderEnd as SliderEnd,
    WrappedSolver as WrappedSolver,
    guide_line as guide_line,
    intersect_lines as intersect_lines,
    link_extent as link_extent,
    slider_end as slider_end,
    slider_search_range as slider_search_range,
)
from .newton import NewtonSolver as NewtonSolver
from .pairs import PAIR_CONSTRAINTS as PAIR_CONSTRAINTS
from .pairs.higher import (
    RISE_LAWS as RISE_LAWS,
    CamLaw as CamLaw,
    CamLawPiece as CamLawPiece,
    GearConstraint as GearConstraint,
    RackConstraint as RackConstraint,
)
from .pairs.lower import (
    DriverConstraint as DriverConstraint,
    GuideGeometry as GuideGeometry,
    PairConstraint as PairConstraint,
    SlideConstraint as SlideConstraint,
    carrier_axis as carrier_axis,
)
from .sequence import (
    DriverMotion as DriverMotion,
    LawOfMotion as LawOfMotion,
    LinkStates as LinkStates,
    NotComputed as NotComputed,
    driven_state as driven_state,
    drives_at as drives_at,
    drives_in_time as drives_in_time,
    frame_state as frame_state,
    link_states as link_states,
    solvers_towards as solvers_towards,
)
from .state import (
    Accel as Accel,
    Accels as Accels,
    DriverState as DriverState,
    DriverStates as DriverStates,
    GroupReactions as GroupReactions,
    GroupState as GroupState,
    PairReaction as PairReaction,
    Placement as Placement,
    Pose as Pose,
    Poses as Poses,
    Rate as Rate,
    Rates as Rates,
    Wrench as Wrench,
)
from .telescope import Telescope as Telescope, TelescopeParts as TelescopeParts
from .unrolled import NotUnrolledError as NotUnrolledError, UnrolledNewton as UnrolledNewton
