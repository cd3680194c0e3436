"""Measurements of speed and accuracy against other methods of computation; used only by `tmm bench`."""

from .accuracy import (
    TARGETS as TARGETS,
    Accuracy as Accuracy,
    AccuracyRow as AccuracyRow,
    measure_accuracy as measure_accuracy,
    sample_coordinates as sample_coordinates,
)
from .by_hand import MECHANISMS as MECHANISMS
from .chart_axes import png_bytes as png_bytes
from .error_charts import (
    accuracy_charts as accuracy_charts,
    draw_accuracy as draw_accuracy,
    stability_charts as stability_charts,
)
from .grading import (
    GradingFigure as GradingFigure,
    GradingMeasurement as GradingMeasurement,
    grading_task_text as grading_task_text,
    measure_grading as measure_grading,
)
from .linkage_families import (
    FAMILIES as FAMILIES,
    FAMILIES_BY_NAME as FAMILIES_BY_NAME,
    dyad_chain as dyad_chain,
    transmission_sine as transmission_sine,
    triad_linkage as triad_linkage,
)
from .measured import Measurement as Measurement
from .methods.case import (
    QUANTITIES as QUANTITIES,
    Case as Case,
    Method as Method,
    MethodAnswers as MethodAnswers,
    UnsupportedLinkageError as UnsupportedLinkageError,
    relative_errors as relative_errors,
)
from .methods.constraint_equations import LoopEquations as LoopEquations, close_positions as close_positions
from .methods.product import convert_precision as convert_precision
from .methods.registry import CLOSED_FORM as CLOSED_FORM, FEWER as FEWER, METHODS as METHODS
from .references import (
    KEYS as KEYS,
    REFERENCE_NAMES as REFERENCE_NAMES,
    load_family_members as load_family_members,
    load_known_scenes as load_known_scenes,
    load_reference as load_reference,
)
from .savings import (
    SAVING_TITLES as SAVING_TITLES,
    Saving as Saving,
    Savings as Savings,
    count_solutions as count_solutions,
    measure_savings as measure_savings,
    with_all_orders as with_all_orders,
    without_closed_forms as without_closed_forms,
)
from .searches import (
    PER_SECOND as PER_SECOND,
    PROBLEMS as PROBLEMS,
    REDUCED_PATHS as REDUCED_PATHS,
    SEARCH_NAMES as SEARCH_NAMES,
    SEARCHED as SEARCHED,
    PathOutcome as PathOutcome,
    Searches as Searches,
    SearchOutcome as SearchOutcome,
    SearchRate as SearchRate,
    load_best_known as load_best_known,
    load_candidates as load_candidates,
    measure_searches as measure_searches,
    search_problem_text as search_problem_text,
)
from .speed import (
    Growth as Growth,
    IteratedRace as IteratedRace,
    Race as Race,
    RivalRace as RivalRace,
    SpeedMeasurement as SpeedMeasurement,
    SweepRate as SweepRate,
    fit_exponent as fit_exponent,
    measure_speed as measure_speed,
)
from .stability import (
    PRODUCT as PRODUCT,
    RIVALS as RIVALS,
    WRONG as WRONG,
    error_limit as error_limit,
    judge_product as judge_product,
    measure_stability as measure_stability,
)
from .time_charts import savings_charts as savings_charts, search_charts as search_charts, speed_charts as speed_charts
