"""Which stage needs which, and what they found."""

from . import mechanism as mechanism, pipeline as pipeline
from .checks import Check as Check, run_checks as run_checks
from .details_on_request import (
    balancing as balancing,
    chosen_here as chosen_here,
    detailed_positions as detailed_positions,
    with_assemblies as with_assemblies,
    with_centres as with_centres,
)
from .extremes import with_extremes as with_extremes
from .intermittent import (
    MOST_CYCLES as MOST_CYCLES,
    Intermittent as Intermittent,
    Part as Part,
    Setting as Setting,
    WheelTask as WheelTask,
)
from .mechanism import Inputs as Inputs, Mechanism as Mechanism, redriven as redriven
from .named_quantities import (
    STAGES as STAGES,
    Quantity as Quantity,
    Solved as Solved,
    of_wheels as of_wheels,
    quantities as quantities,
    relative_angles as relative_angles,
)
from .optional_stages import driver_motion as driver_motion
from .pipeline import (
    CYCLE as CYCLE,
    Results as Results,
    Stage as Stage,
    at_places as at_places,
    at_positions as at_positions,
    cycle_losses as cycle_losses,
    near_dead as near_dead,
    refined as refined,
    solve as solve,
    with_forces as with_forces,
)
from .selection import (
    links as links,
    mass_centres as mass_centres,
    moving_centres as moving_centres,
    moving_points as moving_points,
    values as values,
)
