"""Synthesis of mechanisms: dimensions from required strokes, positions or functions; enumeration of schemes."""

from . import measures as measures, solving as solving
from .construction import (
    CHAIN_LETTERS as CHAIN_LETTERS,
    Arc as Arc,
    Chain as Chain,
    CircleCentre as CircleCentre,
    Diagram as Diagram,
    DiagramLine as DiagramLine,
    DimensionLine as DimensionLine,
    GeometricConstruction as GeometricConstruction,
    LetteredPoint as LetteredPoint,
)
from .coupler_positions.burmester import (
    CouplerPoses as CouplerPoses,
    CouplerPositionsTask as CouplerPositionsTask,
    DyadData as DyadData,
    Dyads as Dyads,
    circle_centre as circle_centre,
    dyads_by_rotation as dyads_by_rotation,
    point_at_distance as point_at_distance,
    rate_guidance as rate_guidance,
)
from .coupler_positions.curve import burmester_curve as burmester_curve, sheet_extent as sheet_extent
from .coupler_positions.dyads import find_dyads as find_dyads
from .crank_slider import (
    CrankSliderTask as CrankSliderTask,
    find_crank_slider as find_crank_slider,
    largest_theta as largest_theta,
    shortest_rod as shortest_rod,
    smallest_pressure as smallest_pressure,
)
from .four_bar import (
    FOUR_BAR_TYPES as FOUR_BAR_TYPES,
    LEAST_USABLE as LEAST_USABLE,
    FourBarLinks as FourBarLinks,
    classify_four_bar as classify_four_bar,
)
from .four_bar_by_angles.angle_pairs import (
    AnglePairsTask as AnglePairsTask,
    are_real as are_real,
    choose_four_bar as choose_four_bar,
    four_bars_through as four_bars_through,
    rate_four_bars as rate_four_bars,
)
from .four_bar_by_angles.freudenstein import (
    FourBarRatios as FourBarRatios,
    output_angles as output_angles,
    solve_exact_pairs as solve_exact_pairs,
    solve_pqs as solve_pqs,
)
from .four_bar_by_angles.least_squares import fitted_lengths as fitted_lengths
from .four_bar_by_k.arcs import (
    SHORTEST_ARC as SHORTEST_ARC,
    FourBarByKSolution as FourBarByKSolution,
    FourBarByKTask as FourBarByKTask,
    admissible_arcs as admissible_arcs,
    four_bar_at as four_bar_at,
    largest_beta as largest_beta,
    largest_w as largest_w,
    sample_arc as sample_arc,
)
from .four_bar_by_k.task import choose_pivot as choose_pivot
from .grashof import (
    CRANK_SLIDER_TYPES as CRANK_SLIDER_TYPES,
    SLOTTED_LEVER_TYPES as SLOTTED_LEVER_TYPES,
    CrankSlider as CrankSlider,
    SlottedLever as SlottedLever,
    classify_crank_slider as classify_crank_slider,
    classify_slotted_lever as classify_slotted_lever,
)
from .measures import (
    MeasuredDemand as MeasuredDemand,
    k_of as k_of,
    measure_demands as measure_demands,
    measure_problem as measure_problem,
    quality_of as quality_of,
    theta_of as theta_of,
    time_ratio_of_curve as time_ratio_of_curve,
    time_ratio_uncertainty as time_ratio_uncertainty,
)
from .optimal.candidates import Candidates as Candidates
from .optimal.evolution import EvolutionResult as EvolutionResult, evolve as evolve
from .optimal.many_starts import (
    IndependentEnds as IndependentEnds,
    LinearParameters as LinearParameters,
    ResidualRows as ResidualRows,
    damped_step as damped_step,
    minimize_squares as minimize_squares,
    residual_function as residual_function,
)
from .optimal.outcome import draw_history as draw_history, outcome_of as outcome_of
from .optimal.quantities import QUANTITIES as QUANTITIES
from .optimal.quantities.strokes import longest_stroke as longest_stroke
from .optimal.refinement import (
    OBJECTIVE_TOLERANCE as OBJECTIVE_TOLERANCE,
    LocalValues as LocalValues,
    evaluate_exactly as evaluate_exactly,
    minimize_locally as minimize_locally,
)
from .optimal.solver import find_best as find_best
from .reading import (
    TaskFile as TaskFile,
    build_synthesised as build_synthesised,
    read_task as read_task,
    round_to_side as round_to_side,
    solve_alone as solve_alone,
)
from .record import (
    Infeasible as Infeasible,
    Kind as Kind,
    Listing as Listing,
    NamedValue as NamedValue,
    SolutionQuality as SolutionQuality,
    SynthesisOutcome as SynthesisOutcome,
    refuse_nonfinite as refuse_nonfinite,
)
from .schemes.chains import (
    MOST_LINKS_OF_CHAIN as MOST_LINKS_OF_CHAIN,
    KinematicChain as KinematicChain,
    canonical_form as canonical_form,
    enumerate_chains as enumerate_chains,
)
from .schemes.layout import find_layouts as find_layouts
from .schemes.problem_file import problem_text as problem_text
from .schemes.schemes import (
    GROUP_CLASSES as GROUP_CLASSES,
    GROUP_TYPES as GROUP_TYPES,
    MOST_CRANKS as MOST_CRANKS,
    MOST_LINKS_OF_SCHEME as MOST_LINKS_OF_SCHEME,
    MOST_SCHEMES as MOST_SCHEMES,
    Scheme as Scheme,
    TooManySchemes as TooManySchemes,
    enumerate_schemes as enumerate_schemes,
)
from .shaper import ShaperTask as ShaperTask
from .slotted_lever import SlottedLeverTask as SlottedLeverTask
from .solving import (
    count as count,
    inputs_of as inputs_of,
    load as load,
    prepare as prepare,
    redrive as redrive,
    solve as solve,
    structure_of as structure_of,
)
from .tasks import TASKS as TASKS, block_module as block_module
