"""Problem files: text to a linkage, with every message at its line and column."""

from . import schema as schema
from .arithmetic import (
    Parser as Parser,
    check_parameter as check_parameter,
    evaluate as evaluate,
    evaluate_quantity as evaluate_quantity,
    resolve_parameters as resolve_parameters,
)
from .blocks.loads import stroke_dimension as stroke_dimension
from .build import (
    build_chain as build_chain,
    build_problem as build_problem,
    build_shape as build_shape,
    checked_shape as checked_shape,
    early_parameters as early_parameters,
    is_chain as is_chain,
    parameters as parameters,
    problem_of as problem_of,
    refuse_law as refuse_law,
    unit_system as unit_system,
    validated as validated,
)
from .error_messages import in_words_of as in_words_of, mobility as mobility, refusal as refusal
from .errors import (
    Mark as Mark,
    Path as Path,
    ProblemError as ProblemError,
    Tree as Tree,
    WrittenNumber as WrittenNumber,
    chosen_names as chosen_names,
    clean as clean,
    latin as latin,
    nearest as nearest,
    no_position as no_position,
    path_text as path_text,
    placed_in as placed_in,
    quote as quote,
    under as under,
    unknown_name as unknown_name,
    visible as visible,
)
from .formats import foreign_of as foreign_of
from .formats.imported_mechanism import written as written
from .formats.pmks_link import DIGITS as DIGITS
from .problems import (
    ChainProblem as ChainProblem,
    Problem as Problem,
    Synthesised as Synthesised,
    TaskProblem as TaskProblem,
)
from .reader import (
    MAX_BYTES as MAX_BYTES,
    Composer as Composer,
    decimal_comma_hint as decimal_comma_hint,
    decoded as decoded,
    file_bytes as file_bytes,
    file_text as file_text,
    language_in as language_in,
    read_file as read_file,
    read_text as read_text,
    unused as unused,
    with_settings as with_settings,
)
from .scalars import finite_float as finite_float, plain_value as plain_value
from .schema import (
    File as File,
    SheetTexts as SheetTexts,
    Shown as Shown,
    SpatialFile as SpatialFile,
    file_schema as file_schema,
)
from .schema_errors import FOREIGN as FOREIGN, shape_error as shape_error
from .schema_types import (
    VALUE as VALUE,
    FileHead as FileHead,
    Name as Name,
    Strict as Strict,
    Value as Value,
    Vector as Vector,
    checked_value as checked_value,
)
from .templates import list_templates as list_templates, template_text as template_text, translations as translations
from .units import (
    SYMBOLS as SYMBOLS,
    ExtendedUnits as ExtendedUnits,
    PhysicalValue as PhysicalValue,
    Unit as Unit,
    UnitError as UnitError,
    UnitSystem as UnitSystem,
    VariedUnits as VariedUnits,
    dotted_unit as dotted_unit,
    on_paper as on_paper,
    parse_unit as parse_unit,
    plain_text as plain_text,
)
from .values import ValueReader as ValueReader, planar as planar
from .work_limits import (
    BUDGET as BUDGET,
    parts as parts,
    refuse_options as refuse_options,
    refuse_work as refuse_work,
)
