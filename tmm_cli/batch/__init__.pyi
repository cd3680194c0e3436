"""Many linkages of one kind at once: a batch at places of the driver, or variants whose numbers come later."""

from .choices import (
    NUMBER as NUMBER,
    choice_values as choice_values,
    read_choices as read_choices,
    with_vary as with_vary,
)
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
from .tape import record as record
from .tape.program import CHUNK as CHUNK, Program as Program
from .tape.traced import DependsOnData as DependsOnData, TracedNumber as TracedNumber
from .taped import OneByOne as OneByOne, Taped as Taped, variants_of as variants_of
from .task import (
    MOST as MOST,
    SAME as SAME,
    Asked as Asked,
    Blocks as Blocks,
    Chosen as Chosen,
    Range as Range,
    Task as Task,
    Two as Two,
    read_task as read_task,
    two as two,
)
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
