"""Assur groups that can be solved, a module a type, and the pairs of which they are made."""

from . import sequence as sequence
from .base import (
    Closed as Closed,
    HingeEnd as HingeEnd,
    Kernel as Kernel,
    SliderEnd as SliderEnd,
    Wrapped as Wrapped,
    line as line,
    meet as meet,
    reach as reach,
    slider_end as slider_end,
    spread as spread,
)
from .branch import BranchTrace as BranchTrace, SmoothWay as SmoothWay, Winding as Winding
from .closed_forms import CLOSED as CLOSED
from .dyads import DYADS as DYADS
from .newton import Newton as Newton
from .pairs import PAIRS as PAIRS
from .pairs.higher import SHAPES as SHAPES, CamLaw as CamLaw, Gear as Gear, Piece as Piece, Rack as Rack
from .pairs.lower import Constraint as Constraint, Driven as Driven, Guided as Guided, Sliding as Sliding, axis as axis
from .sequence import (
    DriverMotion as DriverMotion,
    LawOfMotion as LawOfMotion,
    LinkStates as LinkStates,
    NotComputed as NotComputed,
    driven_state as driven_state,
    drives_at as drives_at,
    frame_state as frame_state,
    link_states as link_states,
    towards as towards,
)
from .state import (
    Accel as Accel,
    Accels as Accels,
    Drive as Drive,
    Drives as Drives,
    GroupReactions as GroupReactions,
    PairReaction as PairReaction,
    Placement as Placement,
    Pose as Pose,
    Poses as Poses,
    Rate as Rate,
    Rates as Rates,
    State as State,
    Wrench as Wrench,
)
from .telescope import Telescope as Telescope, TelescopeParts as TelescopeParts
from .unrolled import NotUnrolledError as NotUnrolledError, Unrolled as Unrolled
