"""Measurements of the product against other ways to compute the same; nothing else needs them."""

from .accuracy import (
    TARGETS as TARGETS,
    Accuracy as Accuracy,
    AccuracyRow as AccuracyRow,
    measure_accuracy as measure_accuracy,
    places as places,
)
from .by_hand import MECHANISMS as MECHANISMS
from .chart_accuracy import accuracy_charts as accuracy_charts, draw_accuracy as draw_accuracy
from .chart_axes import png_bytes as png_bytes
from .chart_stability import stability_charts as stability_charts
from .grading import (
    Figure as Figure,
    Grades as Grades,
    grading_task_text as grading_task_text,
    measure_grading as measure_grading,
)
from .measured import Measured as Measured
from .methods.case import (
    QUANTITIES as QUANTITIES,
    Answers as Answers,
    Case as Case,
    Method as Method,
    Unable as Unable,
    errors as errors,
)
from .methods.constraint_equations import LoopEquations as LoopEquations, close_positions as close_positions
from .methods.product import recast as recast
from .methods.registry import CLOSED_FORM as CLOSED_FORM, FEWER as FEWER, METHODS as METHODS
from .references import (
    KEYS as KEYS,
    REFERENCE_NAMES as REFERENCE_NAMES,
    known_scenes as known_scenes,
    reference as reference,
    seeds as seeds,
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
from .scenes import BY_NAME as BY_NAME, FAMILIES as FAMILIES, chain as chain, shape as shape, triad as triad
from .searches import (
    PER_SECOND as PER_SECOND,
    PROBLEMS as PROBLEMS,
    REDUCED_PATHS as REDUCED_PATHS,
    SEARCH_NAMES as SEARCH_NAMES,
    SEARCHED as SEARCHED,
    Found as Found,
    PathFound as PathFound,
    Searches as Searches,
    SearchRate as SearchRate,
    best_known as best_known,
    measure_searches as measure_searches,
    prepared as prepared,
    search_problem_text as search_problem_text,
)
from .speed import (
    Growth as Growth,
    Race as Race,
    Rival as Rival,
    Speed as Speed,
    exponent as exponent,
    measure_speed as measure_speed,
)
from .speed_of_iterated import Iterated as Iterated
from .speed_of_sweeps import Sweeping as Sweeping
from .stability import (
    PRODUCT as PRODUCT,
    RIVALS as RIVALS,
    WRONG as WRONG,
    limit as limit,
    measure_stability as measure_stability,
    ours as ours,
)
from .time_charts import savings_charts as savings_charts, search_charts as search_charts, speed_charts as speed_charts
