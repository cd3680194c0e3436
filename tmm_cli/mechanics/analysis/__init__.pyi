"""Stages of the analysis of a mechanism, and their results."""

from . import mechanism as mechanism, pipeline as pipeline
from .checks import Check as Check, run_checks as run_checks
from .details_on_request import (
    balancing_magnitude as balancing_magnitude,
    detail_chosen_by_program as detail_chosen_by_program,
    detailed_positions as detailed_positions,
    with_assemblies as with_assemblies,
    with_centres as with_centres,
)
from .extremes import with_extremes as with_extremes
from .intermittent import (
    MOST_CYCLES as MOST_CYCLES,
    IntermittentMotion as IntermittentMotion,
    WheelMotion as WheelMotion,
    WheelSetting as WheelSetting,
    WheelTask as WheelTask,
)
from .mechanism import Inputs as Inputs, Mechanism as Mechanism, with_driver as with_driver
from .named_quantities import (
    STAGES as STAGES,
    NamedQuantity as NamedQuantity,
    SolvedState as SolvedState,
    SolvedVariants as SolvedVariants,
    list_quantities as list_quantities,
    relative_angles as relative_angles,
    wheel_quantities as wheel_quantities,
)
from .optional_stages import driver_motion as driver_motion
from .pipeline import (
    CYCLE_SAMPLES as CYCLE_SAMPLES,
    Results as Results,
    Stage as Stage,
    cycle_losses as cycle_losses,
    is_near_dead as is_near_dead,
    motion_at_positions as motion_at_positions,
    refine_near_dead as refine_near_dead,
    results_at as results_at,
    solve as solve,
    with_forces as with_forces,
)
from .selection import (
    leading_values as leading_values,
    mass_centres as mass_centres,
    moving_centres as moving_centres,
    moving_points as moving_points,
    select_links as select_links,
)
