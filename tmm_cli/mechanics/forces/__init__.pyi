"""Loads, the force plan group by group, and the Zhukovsky lever that checks it."""

from .energy import (
    Energy as Energy,
    compute_energy as compute_energy,
    inertias as inertias,
    reduced_moment as reduced_moment,
)
from .equilibrium import (
    ForceSum as ForceSum,
    LoadedPart as LoadedPart,
    MomentEquation as MomentEquation,
    Part as Part,
    Sought as Sought,
    Term as Term,
    loaded_parts as loaded_parts,
    numbered as numbered,
    other_than as other_than,
    terms as terms,
)
from .free_bodies import (
    BELOW as BELOW,
    DRIVE as DRIVE,
    Acting as Acting,
    Kind as Kind,
    Lead as Lead,
    Lettered as Lettered,
    Loaded as Loaded,
    Symbol as Symbol,
    balance_symbol as balance_symbol,
    kind_of as kind_of,
    leads_of as leads_of,
    lettered as lettered,
    load_names as load_names,
    load_symbols as load_symbols,
    named as named,
    part_across as part_across,
    reaction_symbol as reaction_symbol,
    subscript as subscript,
    there as there,
)
from .friction import (
    FrictionSolution as FrictionSolution,
    LockedRange as LockedRange,
    Losses as Losses,
    find_locked_ranges as find_locked_ranges,
    losses as losses,
    solve_friction as solve_friction,
)
from .load_discontinuities import find_load_jumps as find_load_jumps, table_jumps as table_jumps
from .loads import (
    Applied as Applied,
    acts as acts,
    acts_always as acts_always,
    applied as applied,
    ends_with_stroke as ends_with_stroke,
    given_loads as given_loads,
    reach_of_tables as reach_of_tables,
    table_argument as table_argument,
    twisted as twisted,
)
from .reactions import (
    Balance as Balance,
    GroupForces as GroupForces,
    Reaction as Reaction,
    Reactions as Reactions,
    find_transmitted_forces as find_transmitted_forces,
    power as power,
    react as react,
)
from .zhukovsky_lever import Item as Item, Lever as Lever, compute_lever as compute_lever
