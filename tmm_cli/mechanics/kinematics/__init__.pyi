"""Motion, range of the driver, strokes, pressure angles."""

from . import driver_range as driver_range, motion as motion, pressure as pressure, strokes as strokes
from .centres import Centre as Centre, Line as Line, Links as Links, find_centres as find_centres
from .driver_range import (
    SCAN as SCAN,
    DeadPosition as DeadPosition,
    DriverRange as DriverRange,
    Excess as Excess,
    cycle_of as cycle_of,
    find_dead as find_dead,
    find_range as find_range,
    find_slots as find_slots,
)
from .motion import (
    FIXED as FIXED,
    Motion as Motion,
    Point as Point,
    Sliding as Sliding,
    Turning as Turning,
    move as move,
    moving_parts as moving_parts,
    spliced as spliced,
    with_limits as with_limits,
)
from .pressure import (
    Lead as Lead,
    Pressure as Pressure,
    angle as angle,
    find_pressure as find_pressure,
    followers as followers,
    named as named,
    pressure_at as pressure_at,
    sides as sides,
)
from .strokes import (
    Curve as Curve,
    OutputCurve as OutputCurve,
    Stroke as Stroke,
    Strokes as Strokes,
    Travel as Travel,
    find_strokes as find_strokes,
    find_travel as find_travel,
    moving_slope as moving_slope,
    output_place as output_place,
    output_run as output_run,
    output_slope as output_slope,
    places as places,
    resisted as resisted,
    runs_of as runs_of,
)
