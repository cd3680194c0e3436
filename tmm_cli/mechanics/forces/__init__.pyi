"""Loads, reactions of the Assur groups, friction, and the Zhukovsky lever that checks the balancing moment."""

from .energy import (
    Energy as Energy,
    compute_energy as compute_energy,
    reduced_inertias as reduced_inertias,
    reduced_moment as reduced_moment,
)
from .equilibrium import (
    EquationUnknown as EquationUnknown,
    ForceSum as ForceSum,
    FreeBody as FreeBody,
    GuideComponent as GuideComponent,
    MomentEquation as MomentEquation,
    MomentTerm as MomentTerm,
    distinct_letter as distinct_letter,
    list_free_bodies as list_free_bodies,
    moment_terms as moment_terms,
    number_arms as number_arms,
)
from .free_bodies import (
    DRIVE as DRIVE,
    SUBSCRIPTS as SUBSCRIPTS,
    CourseSymbol as CourseSymbol,
    ExternalPair as ExternalPair,
    ForceOrCouple as ForceOrCouple,
    LoadedPosition as LoadedPosition,
    Symbol as Symbol,
    VectorKind as VectorKind,
    balance_symbol as balance_symbol,
    component_across as component_across,
    course_symbol as course_symbol,
    drop_negligible as drop_negligible,
    external_pairs as external_pairs,
    load_names as load_names,
    load_symbols as load_symbols,
    reaction_symbol as reaction_symbol,
    subscript as subscript,
    symbol_of_name as symbol_of_name,
    vector_kind as vector_kind,
)
from .friction import (
    FrictionLosses as FrictionLosses,
    FrictionSolution as FrictionSolution,
    LockedRange as LockedRange,
    compute_losses as compute_losses,
    find_locked_ranges as find_locked_ranges,
    solve_friction as solve_friction,
)
from .load_discontinuities import find_load_jumps as find_load_jumps, find_table_jumps as find_table_jumps
from .loads import (
    AppliedLoad as AppliedLoad,
    always_acts as always_acts,
    collect_loads as collect_loads,
    ends_with_stroke as ends_with_stroke,
    is_acting as is_acting,
    problem_loads as problem_loads,
    table_argument as table_argument,
    table_lengths as table_lengths,
)
from .reactions import (
    Balance as Balance,
    GroupForces as GroupForces,
    Reaction as Reaction,
    Reactions as Reactions,
    find_transmitted_forces as find_transmitted_forces,
    reduced_driving_moment as reduced_driving_moment,
    solve_reactions as solve_reactions,
)
from .zhukovsky_lever import LeverItem as LeverItem, ZhukovskyLever as ZhukovskyLever, compute_lever as compute_lever
