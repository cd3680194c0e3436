"""Accuracy of results: bounds of rounding errors, and sensitivity to the lengths in the file."""

from .length_sensitivity import (
    as_double_doubles as as_double_doubles,
    change_length as change_length,
    list_lengths as list_lengths,
)
from .rounding_bounds import (
    PAPER_CHANGE as PAPER_CHANGE,
    SIX_FIGURES as SIX_FIGURES,
    Digits as Digits,
    bound_values as bound_values,
    exact_linkage as exact_linkage,
    is_angle as is_angle,
    judge_values as judge_values,
    largest_values as largest_values,
    list_values as list_values,
    relative_bound as relative_bound,
    results_with_linkage as results_with_linkage,
    solve_bare_linkage as solve_bare_linkage,
)
from .search_bounds import (
    PreciseLinkage as PreciseLinkage,
    choose_precision as choose_precision,
    judge_searched as judge_searched,
    start_uncertainty as start_uncertainty,
)
