"""Velocity, acceleration and force plans and the lever, as named vectors with scale factors; nothing is drawn here."""

from .force_polygons import ForcePlan as ForcePlan, force_plans as force_plans
from .lever_drawing import (
    LEVER_POLE as LEVER_POLE,
    LeverPlan as LeverPlan,
    Pair as Pair,
    Scales as Scales,
    drawn_check as drawn_check,
    lever_plan as lever_plan,
    sheets as sheets,
)
from .motion_plans import (
    ACCELERATION_POLE as ACCELERATION_POLE,
    Reading as Reading,
    acceleration_plan as acceleration_plan,
    letters as letters,
    massive as massive,
    readings as readings,
    turns as turns,
    velocity_plan as velocity_plan,
)
from .named_vectors import (
    LANDSCAPE as LANDSCAPE,
    MARGIN as MARGIN,
    PAD as PAD,
    PORTRAIT as PORTRAIT,
    ROUND as ROUND,
    STRIP as STRIP,
    NamedVector as NamedVector,
    Plan as Plan,
    extent as extent,
    ground_of as ground_of,
    in_letters as in_letters,
    round_scale as round_scale,
    sheet_scale as sheet_scale,
)
from .vector_equations import (
    About as About,
    Along as Along,
    OnGuide as OnGuide,
    Ratio as Ratio,
    Spot as Spot,
    Step as Step,
    VectorEquation as VectorEquation,
    steps as steps,
)
