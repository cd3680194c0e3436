"""Many linkages of one kind at once: a batch at places of the driver, or variants whose numbers come later."""

from .family import Family as Family, families as families, named_strokes as named_strokes, together as together
from .prepare import (
    CHECKS as CHECKS,
    SURE as SURE,
    Batch as Batch,
    everything as everything,
    prepare_batch as prepare_batch,
    reactions_of as reactions_of,
    solved as solved,
)
from .task import (
    MOST as MOST,
    NUMBER_WITH_UNIT as NUMBER_WITH_UNIT,
    SAME as SAME,
    Asked as Asked,
    Blocks as Blocks,
    Chosen as Chosen,
    Range as Range,
    Task as Task,
    Two as Two,
    choice_values as choice_values,
    read_choices as read_choices,
    read_task as read_task,
    two as two,
    with_vary as with_vary,
)
from .trace_program import CHUNK as CHUNK, Program as Program
from .traced_arrays import DependsOnData as DependsOnData, TracedNumber as TracedNumber, record as record
from .traced_variants import OneByOne as OneByOne, Taped as Taped, variants_of as variants_of
from .variant import (
    WANTED as WANTED,
    Make as Make,
    NotAlikeError as NotAlikeError,
    NoTapeError as NoTapeError,
    Places as Places,
    Variant as Variant,
    alike as alike,
    changed as changed,
    each as each,
    numbers as numbers,
    sketch_of as sketch_of,
    stands as stands,
    stood_for as stood_for,
    varying as varying,
)
from .workers import (
    Way as Way,
    begin as begin,
    cluster as cluster,
    here as here,
    processes as processes,
    program_digest as program_digest,
)
