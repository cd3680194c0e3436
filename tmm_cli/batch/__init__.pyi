"""Many linkages of one kind at once: batches of linkages, variants whose numbers are given later, and parallel
jobs.
"""

from .family import (
    VariantFamily as VariantFamily,
    build_family as build_family,
    split_families as split_families,
    working_and_idle_strokes as working_and_idle_strokes,
)
from .prepare import (
    CHECKS as CHECKS,
    CONVERGED as CONVERGED,
    Batch as Batch,
    prepare_batch as prepare_batch,
    read_all as read_all,
    solve_forces as solve_forces,
    solve_stages as solve_stages,
)
from .task import (
    MOST_VALUES as MOST_VALUES,
    NUMBER_WITH_UNIT as NUMBER_WITH_UNIT,
    STEP_TOLERANCE as STEP_TOLERANCE,
    Blocks as Blocks,
    Chosen as Chosen,
    Question as Question,
    Range as Range,
    Task as Task,
    Two as Two,
    bounds_text as bounds_text,
    parameter_values as parameter_values,
    read_free_parameters as read_free_parameters,
    read_task as read_task,
    with_vary as with_vary,
)
from .trace_program import CHUNK as CHUNK, TraceProgram as TraceProgram
from .traced_arrays import (
    DependsOnData as DependsOnData,
    TracedNumber as TracedNumber,
    trace_function as trace_function,
)
from .traced_variants import (
    SequentialVariants as SequentialVariants,
    TracedVariants as TracedVariants,
    make_variants as make_variants,
)
from .variant import (
    WANTED as WANTED,
    DriverSamples as DriverSamples,
    IncompatibleLinkagesError as IncompatibleLinkagesError,
    Make as Make,
    NotTraceableError as NotTraceableError,
    Variant as Variant,
    compute_sketch as compute_sketch,
    numeric_leaves as numeric_leaves,
    placeholder_linkage as placeholder_linkage,
    resolve_traced as resolve_traced,
    same_assembly as same_assembly,
    split_columns as split_columns,
    varying_numbers as varying_numbers,
    with_numbers as with_numbers,
)
from .workers import (
    JobRunner as JobRunner,
    in_processes as in_processes,
    initialize_worker as initialize_worker,
    on_cluster as on_cluster,
    program_digest as program_digest,
    run_here as run_here,
)
