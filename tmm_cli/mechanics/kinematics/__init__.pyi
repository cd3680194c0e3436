"""Motion of links and points, range of the driver, strokes, pressure angles, instantaneous centres."""

from . import driver_range as driver_range, motion as motion, pressure_angles as pressure_angles, strokes as strokes
from .driver_range import (
    SCAN as SCAN,
    DeadPosition as DeadPosition,
    DriverRange as DriverRange,
    SlotExcess as SlotExcess,
    cycle_turns as cycle_turns,
    find_dead_positions as find_dead_positions,
    find_range as find_range,
    find_slot_excess as find_slot_excess,
)
from .instantaneous_centres import (
    CentreLine as CentreLine,
    InstantCentre as InstantCentre,
    LinkPair as LinkPair,
    find_centres as find_centres,
)
from .motion import (
    FIELDS_WITHOUT_POSITIONS as FIELDS_WITHOUT_POSITIONS,
    ForwardMotion as ForwardMotion,
    LinkMotion as LinkMotion,
    Motion as Motion,
    PointMotion as PointMotion,
    SlidingMotion as SlidingMotion,
    compute_motion as compute_motion,
    splice_positions as splice_positions,
    zero_at_rest as zero_at_rest,
)
from .pressure_angles import (
    DrivenLink as DrivenLink,
    PressureAngle as PressureAngle,
    driven_links as driven_links,
    driving_pair_names as driving_pair_names,
    find_pressure as find_pressure,
    pressure_angle as pressure_angle,
    pressure_at as pressure_at,
    pressure_sine_and_cosine as pressure_sine_and_cosine,
)
from .smooth_limits import fill_in_limits as fill_in_limits
from .strokes import (
    OutputCurve as OutputCurve,
    OutputTravel as OutputTravel,
    Stroke as Stroke,
    StrokeCurve as StrokeCurve,
    Strokes as Strokes,
    driver_positions as driver_positions,
    find_strokes as find_strokes,
    find_travel as find_travel,
    measure_runs as measure_runs,
    moving_slope as moving_slope,
    output_coordinate as output_coordinate,
    output_run as output_run,
    output_slope as output_slope,
    resisted_direction as resisted_direction,
)
