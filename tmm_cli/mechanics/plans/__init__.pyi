"""Velocity, acceleration and force plans and the Zhukovsky lever as named vectors with scale factors; nothing
is drawn here.
"""

from .force_polygons import ForcePlan as ForcePlan, force_plans as force_plans
from .lever_drawing import (
    LEVER_POLE as LEVER_POLE,
    CoupleAsForces as CoupleAsForces,
    DrawingScales as DrawingScales,
    LeverPlan as LeverPlan,
    balance_drawings as balance_drawings,
    drawn_check as drawn_check,
    lever_plan as lever_plan,
)
from .motion_plans import (
    ACCELERATION_POLE as ACCELERATION_POLE,
    PlanReading as PlanReading,
    acceleration_plan as acceleration_plan,
    angular_values as angular_values,
    links_with_mass as links_with_mass,
    plan_letters as plan_letters,
    plan_readings as plan_readings,
    velocity_plan as velocity_plan,
)
from .named_vectors import (
    LANDSCAPE as LANDSCAPE,
    MARGIN as MARGIN,
    PAD as PAD,
    PORTRAIT as PORTRAIT,
    ROUND_SCALES as ROUND_SCALES,
    STRIP as STRIP,
    NamedVector as NamedVector,
    Plan as Plan,
    drawing_area as drawing_area,
    extent as extent,
    round_scale as round_scale,
    sheet_scale as sheet_scale,
    with_subscripts as with_subscripts,
)
from .vector_equations import (
    FixedGuideEquation as FixedGuideEquation,
    HigherPairRatio as HigherPairRatio,
    MovingGuideEquation as MovingGuideEquation,
    PlanPoint as PlanPoint,
    SameLinkEquation as SameLinkEquation,
    SolutionStep as SolutionStep,
    VectorEquation as VectorEquation,
    solution_steps as solution_steps,
)
